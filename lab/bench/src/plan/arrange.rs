//! Copies of the program's own solids: on a field, seen from far above, along an avenue, in the
//! distance, as an army. And a thousand different solids.

use super::suite::{self, Extent};
use crate::plan::view::View;
use glam::{DQuat, DVec3};
use revmap::error::Result;
use revmap::profile::Profile;
use revmap::scene::{Camera, Light, Object, Placement};
use std::sync::Arc;

/// Two solids that the suite has not: a column and a baluster, radii at heights.
const COLUMN: ([f64; 8], [f64; 8]) = (
    [0.0, 0.16, 0.16, 0.11, 0.09, 0.16, 0.16, 0.0],
    [0.0, 0.0, 0.06, 0.1, 0.9, 0.94, 1.0, 1.0],
);
const BALUSTER: ([f64; 10], [f64; 10]) = (
    [0.0, 0.14, 0.14, 0.06, 0.15, 0.05, 0.09, 0.05, 0.12, 0.0],
    [0.0, 0.0, 0.08, 0.14, 0.34, 0.66, 0.7, 0.74, 0.94, 1.0],
);
/// From one solid of an army to the next, in heights of a solid.
const APART: f64 = 1.1;
/// Copies of each of three solids in the distance.
const DISTANT: u32 = 200;
/// The golden ratio less 1: its multiples are spread evenly over the fractions.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// `count` copies on a square field one unit wide, seen whole.
pub(super) fn field(one: &View, count: u32) -> View {
    let mut view = one.clone();
    let side = f64::from(count).sqrt().ceil();
    for object in &mut view.scene.objects {
        let scale = 1.0 / (2.0 * object.profile.radius * side);
        let place = |k: u32| {
            let (x, y) = (f64::from(k) % side, (f64::from(k) / side).floor());
            Placement {
                position: DVec3::new((x + 0.5) / side, (y + 0.5) / side, 0.0),
                scale: DVec3::splat(scale),
                ..Placement::default()
            }
        };
        object.instances = (0..count).map(place).collect();
    }
    view.name = format!("{}-x{count}", one.name);
    view.framed(50.0)
}

/// `count` small copies spread over a square, seen from straight above, each 0.6 to 1.3 in size and
/// turned. The square is 1.2 units wide for each row of copies; the eye is 150 units above ten
/// thousand.
pub(super) fn sparse(one: &View, count: u32) -> View {
    let mut view = one.clone();
    let side = 1.2 * f64::from(count).sqrt();
    let part = |k: u32, step: f64| (f64::from(k) * step).fract();
    // Multiples of the plastic number's first two powers cover a square evenly.
    let place = |k: u32| Placement {
        position: DVec3::new(
            side * (part(k, 0.754_877_666_246_693) - 0.5),
            side * (part(k, 0.569_840_290_998_053) - 0.5),
            0.0,
        ),
        rotation: DQuat::from_rotation_z(f64::from(k)),
        scale: DVec3::splat(0.6 + 0.7 * part(k, GOLDEN)),
    };
    for object in &mut view.scene.objects {
        object.instances = (0..count).map(place).collect();
    }
    view.name = format!("{}-sparse-{count}", one.name);
    let camera = &mut view.scene.camera;
    *camera = Camera::new(DVec3::new(0.0, 0.0, 1.25 * side), DVec3::ZERO);
    (camera.up, camera.fov_y) = (DVec3::Y, 45.0);
    view
}

/// A thousand different solids of nine points on a square, seen whole.
pub(super) fn thousand() -> Result<View> {
    let mut scene = suite::views(&Extent::First(1), &[25.0])?
        .swap_remove(0)
        .scene;
    let solid = |k: u32| {
        let part = |n: u32| (f64::from(n) * GOLDEN).fract();
        // Of squares, or three points of an outline would be in line.
        let point = |n: u32| [0.1 + 0.3 * part((7 * k + n).pow(2)), f64::from(n) / 8.0];
        let mut points = vec![[0.0, 0.0]];
        points.extend((1..8).map(point));
        points.push([0.0, 1.0]);
        let profile = Profile::polygon(&points, 0.5)?;
        let mut object = Object::new(format!("solid {k}"), Arc::new(profile));
        object.color = [0, 1, 2].map(|n| 0.2 + 0.6 * part(3 * k + n) as f32);
        object.placement.position = DVec3::new(f64::from(k % 32), f64::from(k / 32), 0.0);
        Ok(object)
    };
    scene.objects = (0..1000).map(solid).collect::<Result<_>>()?;
    Ok(View::new("thousand", scene).framed(50.0))
}

/// Two lines of twelve objects that go into the distance: 300 pixels high to 10 at 800x600.
pub(super) fn avenue(one: &View) -> View {
    let mut view = one.clone();
    view.name = format!("{}-avenue", one.name);
    let Some(solid) = view.scene.objects.first().cloned() else {
        return view;
    };
    let place = |k: i32| {
        let mut object = solid.clone();
        let away = 2.75 * 1.36f64.powi(k / 2);
        let side = if k % 2 == 0 { -1.0 } else { 1.0 };
        object.placement.position = DVec3::new(-away, side * 0.32 * away.sqrt(), 0.0);
        object
    };
    view.scene.objects = (0..24).map(place).collect();
    view.scene.camera = Camera::new(DVec3::new(0.0, 0.0, 1.3), DVec3::new(-8.0, 0.0, 0.4));
    view
}

/// Copies of a pawn, a rook and a king between 41 and 412 units away: 20 to 2 pixels high at 800x600.
pub(super) fn distant() -> Result<View> {
    let mut objects = Vec::new();
    let mut scene = None;
    for name in ["pawn", "rook", "king"] {
        for view in suite::views(&Extent::Named(vec![name.to_owned()]), &[25.0])? {
            objects.extend(view.scene.objects.clone());
            scene.get_or_insert(view.scene);
        }
    }
    let mut scene = scene.unwrap_or_else(|| revmap::scene::Scene::new(flight_camera(0.0)));
    let kinds = objects.len() as u32;
    for (kind, object) in (0u32..).zip(&mut objects) {
        // Evenly over the depths, and to either side by the golden ratio.
        let place = |k: u32| {
            let n = f64::from(k * kinds + kind);
            let away = 41.0 * 10f64.powf(n / f64::from(kinds * DISTANT));
            let side = 0.9 * ((n * GOLDEN).fract() - 0.5);
            Placement {
                position: DVec3::new(-away, side * away, 0.0),
                ..Placement::default()
            }
        };
        object.instances = (0..DISTANT).map(place).collect();
    }
    scene.objects = objects;
    scene.camera = Camera::new(DVec3::new(0.0, 0.0, 14.0), DVec3::new(-70.0, 0.0, 0.0));
    Ok(View::new("distant", scene))
}

/// `count` copies of ten solids in turn, each turned; seen from within, over the first heads.
pub fn army(count: u32) -> Result<View> {
    let views = suite::views(&Extent::UPRIGHT, &[25.0])?;
    let mut scene = views[0].scene.clone();
    let mut kinds: Vec<Object> = Vec::new();
    kinds.extend(views.into_iter().flat_map(|view| view.scene.objects));
    let both = [
        ("column", &COLUMN.0[..], &COLUMN.1[..]),
        ("baluster", &BALUSTER.0, &BALUSTER.1),
    ];
    for (name, radii, heights) in both {
        let points: Vec<_> = radii.iter().zip(heights).map(|(r, z)| [*r, *z]).collect();
        let mut object = Object::new(name, Arc::new(Profile::polygon(&points, 0.2)?));
        object.color = [0.7, 0.68, 0.62];
        kinds.push(object);
    }
    let side = f64::from(count).sqrt().ceil();
    let number = kinds.len() as u32;
    let row_of = |k: u32| (f64::from(k) / side).floor();
    let place = |k: u32| {
        let (row, column) = (row_of(k), f64::from(k) % side);
        let across = column - 0.5 * side + 0.37 * (row % 3.0);
        Placement {
            position: DVec3::new(-APART * row, APART * across, 0.0),
            rotation: DQuat::from_rotation_z(f64::from(k) * 2.399_963),
            ..Placement::default()
        }
    };
    for (kind, object) in (0u32..).zip(&mut kinds) {
        // Each row begins with another kind, or kinds would stand in files.
        let own = |k: &u32| (k + 3 * row_of(*k) as u32) % number == kind;
        object.instances = (0..count).filter(own).map(place).collect();
    }
    kinds.retain(|object| !object.instances.is_empty());
    scene.objects = kinds;
    scene.camera = flight_camera(0.0);
    let light = |direction: [f64; 3], color| Light {
        direction: direction.into(),
        color,
        ..Light::default()
    };
    scene.lights = vec![
        light([-0.6, 0.5, -0.7], [0.95, 0.9, 0.8]),
        light([-0.3, -0.9, -0.3], [0.16, 0.2, 0.28]),
    ];
    Ok(View::new(format!("army-{count}"), scene))
}

/// The camera of a flight over an army, `at` from 0 to 1: to the left and down, then up again.
pub fn flight_camera(at: f64) -> Camera {
    let turn = std::f64::consts::TAU * at;
    let eye = DVec3::new(1.2 - 30.0 * at, 3.0 * turn.sin(), 1.7 + 0.5 * turn.cos());
    let ahead = DVec3::new(-6.0, 1.5 * turn.cos(), -1.9);
    Camera::new(eye, eye + ahead)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn an_army_has_ten_kinds_and_stands_apart() {
        for count in [100, 10_000] {
            let view = army(count).unwrap();
            view.scene.check().unwrap();
            assert_eq!(view.solids(), count as usize);
            assert_eq!(view.scene.objects.len(), 10);
            for object in &view.scene.objects {
                assert!(object.profile.radius < 0.5 * APART, "{}", object.name);
            }
        }
        assert_eq!(army(1).unwrap().solids(), 1);
    }

    #[test]
    fn a_field_holds_its_copies_side_by_side() {
        let one = &suite::views(&Extent::First(1), &[25.0]).unwrap()[0];
        for count in [1, 10, 100, 1000, 10_000] {
            let view = field(one, count);
            view.scene.check().unwrap();
            assert_eq!(view.solids(), count as usize);
            let all = view.scene.objects[0].placements();
            let width = 2.0 * view.scene.objects[0].profile.radius * all[0].scale.x;
            for (k, a) in all.iter().enumerate().take(40) {
                let apart =
                    |b: &Placement| (a.position - b.position).abs().max_element() > width * 0.999;
                assert!(all[..k].iter().all(apart));
            }
            let within = |p: &Placement| p.position.max_element() <= 1.0 - width / 2.0 + 1e-9;
            assert!(all.iter().all(within));
        }
    }

    #[test]
    fn small_copies_are_spread_and_a_thousand_solids_differ() {
        let one = &suite::views(&Extent::Named(vec!["pawn".into()]), &[25.0]).unwrap()[0];
        let view = sparse(one, 2500);
        view.scene.check().unwrap();
        assert_eq!(
            (view.name.as_str(), view.solids()),
            ("pawn-sparse-2500", 2500)
        );
        // As many in each quarter, all within the square below the eye.
        let all = view.scene.objects[0].placements();
        let quarter = |p: &&Placement| p.position.x > 0.0 && p.position.y > 0.0;
        assert!(all.iter().filter(quarter).count().abs_diff(625) < 20);
        assert!(all.iter().all(|p| p.position.abs().max_element() <= 30.0));
        assert_eq!(view.scene.camera.eye, DVec3::new(0.0, 0.0, 75.0));
        let view = thousand().unwrap();
        view.scene.check().unwrap();
        assert_eq!(view.solids(), 1000);
        let outlines = view
            .scene
            .objects
            .iter()
            .map(|o| &o.profile.outline.loops[0]);
        let outlines: Vec<_> = outlines.collect();
        assert!(outlines.iter().all(|points| points.len() == 9));
        let differs = |k: usize| outlines[..k].iter().all(|other| *other != outlines[k]);
        assert!((0..1000).all(differs));
    }
}
