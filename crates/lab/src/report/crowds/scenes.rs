//! An army of ten solids on a square field, and one solid alone.

use crate::report::suite::{self, Extent};
use crate::report::view::{Framing, View};
use glam::{DQuat, DVec3};
use revmap::error::Result;
use revmap::profile::Profile;
use revmap::scene::{Camera, Light, Object, Placement};
use std::sync::Arc;

/// Two solids that the suite has not: a column and a baluster, `(r, z)`.
const COLUMN: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.16, 0.0],
    [0.16, 0.06],
    [0.11, 0.1],
    [0.09, 0.9],
    [0.16, 0.94],
    [0.16, 1.0],
    [0.0, 1.0],
];
const BALUSTER: [[f64; 2]; 10] = [
    [0.0, 0.0],
    [0.14, 0.0],
    [0.14, 0.08],
    [0.06, 0.14],
    [0.15, 0.34],
    [0.05, 0.66],
    [0.09, 0.7],
    [0.05, 0.74],
    [0.12, 0.94],
    [0.0, 1.0],
];
/// From one solid to the next on the field, in heights of a solid.
const APART: f64 = 1.1;

/// One solid seen close.
///
/// # Errors
/// Of the solids that the program carries.
pub(super) fn one() -> Result<View> {
    let mut view = suite::one()?.in_framing(Framing::Close);
    view.name = "one".into();
    Ok(view)
}

/// `count` copies of ten solids in turn, of equal height, each turned by another angle; seen from
/// within, over the heads of the first.
///
/// # Errors
/// Of the solids that the program carries.
pub fn army(count: u32) -> Result<View> {
    let views = suite::views(Extent::All, &[25.0])?;
    let mut scene = views[0].scene.clone();
    let mut kinds: Vec<Object> = Vec::new();
    kinds.extend(views.into_iter().flat_map(|view| view.scene.objects));
    for (name, points) in [("column", &COLUMN[..]), ("baluster", &BALUSTER[..])] {
        let mut object = Object::new(name, Arc::new(Profile::polygon(points, 0.2)?));
        object.color = [0.7, 0.68, 0.62];
        kinds.push(object);
    }
    let side = f64::from(count).sqrt().ceil();
    let number = kinds.len() as u32;
    for (kind, object) in (0u32..).zip(&mut kinds) {
        let row_of = |k: u32| (f64::from(k) / side).floor();
        object.instances = (0..count)
            // Each row begins with another kind, or kinds would stand in files.
            .filter(|&k| (k + 3 * row_of(k) as u32) % number == kind)
            .map(|k| {
                let (row, column) = (row_of(k), f64::from(k) % side);
                Placement {
                    position: DVec3::new(
                        -APART * row,
                        APART * (column - 0.5 * side + 0.37 * (row % 3.0)),
                        0.0,
                    ),
                    rotation: DQuat::from_rotation_z(f64::from(k) * 2.399_963),
                    ..Placement::default()
                }
            })
            .collect();
    }
    scene.objects = kinds
        .into_iter()
        .filter(|o| !o.instances.is_empty())
        .collect();
    scene.camera = along(0.0);
    scene.lights = vec![
        Light {
            direction: DVec3::new(-0.6, 0.5, -0.7),
            color: [0.95, 0.9, 0.8],
        },
        Light {
            direction: DVec3::new(-0.3, -0.9, -0.3),
            color: [0.16, 0.2, 0.28],
        },
    ];
    let mut view = View::new(format!("army-{count}"), scene);
    view.framing = Framing::Whole;
    Ok(view)
}

/// The camera of a flight over the field, `at` from 0 to 1: in a bow to the left and down among
/// the solids, then up again.
pub(super) fn along(at: f64) -> Camera {
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
}
