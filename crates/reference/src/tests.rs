#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
//! Rays whose result is computed by hand.

use super::samples;
use super::*;
use glam::{DQuat, DVec3};
use revmap::profile::Outline;
use revmap::scene::{Camera, Object, Offset, Specular};
use revmap::settings::Settings;
use std::f64::consts::FRAC_PI_2;

pub(super) fn object(outline: Outline, radius: f64) -> Object {
    let profile = Arc::new(Profile::new(outline, radius));
    Object {
        color: [0.8, 0.6, 0.4],
        specular: Specular {
            strength: 0.3,
            shininess: 40.0,
        },
        ..Object::new("sample", profile)
    }
}

pub(super) fn scene(objects: Vec<Object>) -> Scene {
    let camera = Camera::new(DVec3::new(1.6, 0.3, 1.1), DVec3::new(0.0, 0.0, 0.5));
    Scene {
        objects,
        ..Scene::new(camera)
    }
}

fn shoot(object: Object, origin: [f64; 3], direction: [f64; 3]) -> Trace {
    let ray = Ray {
        origin: origin.into(),
        direction: direction.into(),
    };
    super::trace(&scene(vec![object]), ray).unwrap()
}

#[track_caller]
fn assert_hit(trace: Trace, t: f64, normal: [f64; 3], surface: Surface) {
    let hit = trace.hit.expect("a hit");
    assert!((hit.t - t).abs() < 1e-12, "t {} is not {t}", hit.t);
    assert!(
        (hit.normal - DVec3::from(normal)).length() < 1e-9,
        "normal {} is not {normal:?}",
        hit.normal
    );
    assert_eq!(hit.surface, surface);
}

#[test]
fn a_cylinder_from_all_sides() {
    let c = || object(samples::cylinder(0.25, 0.2, 0.8), 0.5);
    assert_hit(
        shoot(c(), [2.0, 0.0, 0.5], [-1.0, 0.0, 0.0]),
        1.75,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    assert_hit(
        shoot(c(), [2.0, 0.0, 0.5], [-4.0, 0.0, 0.0]),
        1.75 / 4.0,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    assert_hit(
        shoot(c(), [0.1, 0.1, 3.0], [0.0, 0.0, -1.0]),
        2.2,
        [0.0, 0.0, 1.0],
        Surface::Turned,
    );
    assert_hit(
        shoot(c(), [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]),
        2.2,
        [0.0, 0.0, 1.0],
        Surface::Turned,
    );
    assert_hit(
        shoot(c(), [0.0, 0.1, -1.0], [0.0, 0.0, 1.0]),
        1.2,
        [0.0, 0.0, -1.0],
        Surface::Turned,
    );
    // A ray from inside hits the back of the surface, with its outward normal.
    assert_hit(
        shoot(c(), [0.0, 0.0, 0.5], [0.0, 1.0, 0.0]),
        0.25,
        [0.0, 1.0, 0.0],
        Surface::Turned,
    );
    assert!(shoot(c(), [2.0, 0.0, 0.5], [1.0, 0.0, 0.0]).hit.is_none());
    assert!(shoot(c(), [2.0, 0.26, 0.5], [-1.0, 0.0, 0.0]).hit.is_none());
}

#[test]
fn rays_that_are_none_hit_nothing() {
    let c = || object(samples::cylinder(0.25, 0.2, 0.8), 0.5);
    let nan = f64::NAN;
    let far = f64::MAX;
    for (origin, direction) in [
        ([0.0, 0.0, 0.5], [0.0; 3]),
        ([0.0, 0.0, 0.5], [1e-200, 0.0, 0.0]),
        ([0.0, nan, 0.5], [1.0, 0.0, 0.0]),
        ([2.0, 0.0, 0.5], [-1.0, nan, 0.0]),
        ([2.0, 0.0, 0.5], [nan; 3]),
        ([2.0, 0.0, 0.5], [f64::NEG_INFINITY, 0.0, 0.0]),
        ([2.0, 0.0, 0.5], [-far, 0.0, 0.0]),
        ([f64::INFINITY, 0.0, 0.5], [-1.0, 0.0, 0.0]),
    ] {
        assert_eq!(shoot(c(), origin, direction), Trace::default());
        let ray = Ray {
            origin: origin.into(),
            direction: direction.into(),
        };
        let scene = scene(vec![c()]);
        assert_eq!(
            Analytic::new(&scene).unwrap().trace(ray),
            Trace::default(),
            "{ray:?}"
        );
        let reference = Reference::new(&scene).unwrap();
        for part in [[0.0, f64::INFINITY], [0.5, 0.5], [nan, nan]] {
            let least = reference.clearance_within(ray, part, 1e-6);
            assert_eq!(least, f64::INFINITY, "{ray:?}");
        }
        // The placement of the solid makes no difference.
        let mut turned = c();
        turned.placement.scale = DVec3::new(1e-200, 1e200, 1.0);
        assert!(shoot(turned, origin, direction).hit.is_none());
    }
    // Rays straight down the axis, and within a face's own plane, give finite numbers.
    assert!(
        shoot(c(), [0.0, 0.0, 0.5], [0.0, 0.0, 1e-300])
            .hit
            .is_none_or(|h| h.t.is_finite())
    );
    assert!(shoot(c(), [2.0, 0.5, 0.5], [-1.0, 0.0, 0.0]).hit.is_none());
}

#[test]
fn the_box_closes_what_it_cuts() {
    // A solid wider than its box, and through its floor and ceiling.
    let c = || object(samples::cylinder(0.45, -0.5, 1.5), 0.4);
    assert_hit(
        shoot(c(), [2.0, 0.0, 0.5], [-1.0, 0.0, 0.0]),
        1.6,
        [1.0, 0.0, 0.0],
        Surface::Cut(0),
    );
    assert_hit(
        shoot(c(), [0.1, 0.1, 3.0], [0.0, 0.0, -1.0]),
        2.0,
        [0.0, 0.0, 1.0],
        Surface::Cut(2),
    );
    // A ray from inside hits the face through which it leaves.
    assert_hit(
        shoot(c(), [0.1, 0.0, 0.5], [0.0, -1.0, 0.0]),
        0.4,
        [0.0, -1.0, 0.0],
        Surface::Cut(1),
    );
    // The cylinder's own side is seen near the box's corner, beyond the face.
    let y = 0.35f64;
    let x = (0.45f64 * 0.45 - y * y).sqrt();
    let found = shoot(c(), [2.0, y, 0.5], [-1.0, 0.0, 0.0]);
    assert_hit(found, 2.0 - x, [x / 0.45, y / 0.45, 0.0], Surface::Turned);
}

#[test]
fn a_solid_that_ends_at_its_box_is_met_there() {
    let c = || object(samples::cylinder(0.5, 0.0, 1.0), 0.5);
    for (origin, direction, t, normal) in [
        ([0.1, 0.2, 2.0], [0.0, 0.0, -1.0], 1.0, [0.0, 0.0, 1.0]),
        ([0.1, 0.2, -1.0], [0.0, 0.0, 1.0], 1.0, [0.0, 0.0, -1.0]),
        ([2.0, 0.0, 0.5], [-1.0, 0.0, 0.0], 1.5, [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.5], [0.0, 0.0, 1.0], 0.5, [0.0, 0.0, 1.0]),
    ] {
        let hit = shoot(c(), origin, direction).hit.expect("a hit");
        assert!(
            (hit.t - t).abs() < 1e-9 && (hit.normal - DVec3::from(normal)).length() < 1e-9,
            "{hit:?}"
        );
    }
}

#[test]
fn offsets_move_the_surface_as_the_formula_says() {
    let with = |extend, bevel, chamfer| {
        let mut o = object(samples::cylinder(0.2, -1.0, 2.0), 0.5);
        o.offset = Offset {
            extend,
            bevel,
            chamfer,
        };
        o
    };
    let side = |o, z| shoot(o, [2.0, 0.0, z], [-1.0, 0.0, 0.0]);
    assert_hit(
        side(with(0.1, 0.0, 1.0), 0.5),
        1.7,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    assert_hit(
        side(with(-0.05, 0.0, 1.0), 0.5),
        1.85,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    // r = 0.2 + 0.1 + 0.3 (1 - z): a cone whose normal climbs.
    let n = DVec3::new(1.0, 0.0, 0.3).normalize().to_array();
    assert_hit(
        side(with(0.1, 0.3, 1.0), 0.6),
        2.0 - 0.3 - 0.12,
        n,
        Surface::Turned,
    );
    // Chamfered to depth 0.25: a cone above z = 0.75, a cylinder of its foot's radius below.
    assert_hit(
        side(with(0.1, 0.3, 0.25), 0.8),
        2.0 - 0.3 - 0.06,
        n,
        Surface::Turned,
    );
    assert_hit(
        side(with(0.1, 0.3, 0.25), 0.6),
        2.0 - 0.3 - 0.075,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
}

#[test]
fn placement_scales_turns_and_moves() {
    let mut o = object(samples::cylinder(0.25, 0.2, 0.8), 0.5);
    o.placement = Placement {
        position: DVec3::new(10.0, 0.0, 1.0),
        rotation: DQuat::from_rotation_y(FRAC_PI_2),
        scale: DVec3::new(1.0, 3.0, 2.0),
    };
    // The solid's z is now along world x: the cap at 0.8 is at 10 + 1.6.
    assert_hit(
        shoot(o.clone(), [20.0, 0.1, 1.1], [-1.0, 0.0, 0.0]),
        8.4,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    // The elliptic side extends to 0.75 along y.
    assert_hit(
        shoot(o, [11.0, 5.0, 1.0], [0.0, -1.0, 0.0]),
        4.25,
        [0.0, 1.0, 0.0],
        Surface::Turned,
    );
    // The normal of a squeezed ball by the inverse transpose, compared with the ellipsoid's own.
    let mut o = object(samples::ball(0.4, 4000), 0.5);
    let scale = DVec3::new(2.0, 0.5, 1.0);
    o.placement.scale = scale;
    let hit = shoot(o, [3.0, 0.05, 0.7], [-1.0, 0.02, -0.1]).hit.unwrap();
    let p = DVec3::new(3.0, 0.05, 0.7) + DVec3::new(-1.0, 0.02, -0.1) * hit.t - DVec3::Z * 0.5;
    assert!(((p / scale).length() - 0.4).abs() < 1e-6);
    assert!((hit.normal - (p / (scale * scale)).normalize()).length() < 2e-3);
}

#[test]
fn the_axis_may_stand_anywhere() {
    let mut o = object(samples::cylinder(0.25, -1.0, 2.0), 0.5);
    o.axis = [0.75, 0.25];
    // At (0.25, -0.25).
    assert_hit(
        shoot(o.clone(), [0.25, 2.0, 0.5], [0.0, -1.0, 0.0]),
        2.0,
        [0.0, 1.0, 0.0],
        Surface::Turned,
    );
    // With the axis on the corner itself, half of it is cut away.
    o.axis = [1.0, 0.5];
    assert_hit(
        shoot(o, [2.0, 0.1, 0.5], [-1.0, 0.0, 0.0]),
        1.5,
        [1.0, 0.0, 0.0],
        Surface::Cut(0),
    );
}

#[test]
fn cavities_and_rings() {
    let o = || object(samples::hollow(), 0.5);
    // Ring, gap, shell, cavity.
    assert_hit(
        shoot(o(), [2.0, 0.0, 0.5], [-1.0, 0.0, 0.0]),
        1.54,
        [1.0, 0.0, 0.0],
        Surface::Turned,
    );
    assert!(
        (shoot(o(), [0.43, 0.0, 0.5], [-1.0, 0.0, 0.0])
            .hit
            .unwrap()
            .t
            - 0.03)
            .abs()
            < 1e-12
    );
    assert!(
        (shoot(o(), [0.38, 0.0, 0.5], [-1.0, 0.0, 0.0])
            .hit
            .unwrap()
            .t
            - 0.03)
            .abs()
            < 1e-12
    );
    // The cavity's wall is seen from its middle: the outward normal points back.
    let hit = shoot(o(), [0.0, 0.0, 0.5], [1.0, 0.0, 0.0]).hit.unwrap();
    assert!((hit.t - 0.25).abs() < 1e-12 && hit.normal.x < 0.0);
    assert_hit(
        shoot(o(), [0.0, 0.0, 0.5], [0.0, 0.0, 1.0]),
        0.2,
        [0.0, 0.0, -1.0],
        Surface::Turned,
    );
}

#[test]
fn a_picture_is_the_same_on_any_number_of_threads() {
    let mut o = object(samples::glass(), 0.4);
    o.offset.bevel = 0.1;
    let scene = scene(vec![o]);
    let settings = Settings {
        width: 64,
        height: 48,
        ..Settings::exact()
    };
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| super::draw(&scene, &settings, &|_, _| {}))
            .unwrap()
    };
    let one = draw(1);
    assert_eq!(one.first_difference(&draw(3)), None);
    let hits = (0..one.pixels()).filter(|&k| one.hits(k)).count();
    assert!(hits > 300 && hits < 1500, "{hits}");
    assert!(
        one.color
            .iter()
            .flatten()
            .chain(one.normal.iter().flatten())
            .all(|v| v.is_finite())
    );
}

#[test]
fn progress_counts_rows_to_the_end() {
    let scene = scene(vec![object(samples::torus(), 0.5)]);
    let settings = Settings {
        width: 8,
        height: 20,
        ..Settings::exact()
    };
    let seen = std::sync::Mutex::new(Vec::new());
    super::draw(&scene, &settings, &|done, total| {
        seen.lock().unwrap().push((done, total))
    })
    .unwrap();
    let mut seen = seen.into_inner().unwrap();
    seen.sort_unstable();
    assert_eq!(seen, (1..=20).map(|k| (k, 20)).collect::<Vec<_>>());
}

#[test]
fn impossible_scenes_are_refused() {
    let settings = Settings {
        width: 8,
        height: 8,
        ..Settings::exact()
    };
    let draw = |o: Object| super::draw(&scene(vec![o]), &settings, &|_, _| {}).unwrap_err();
    let mut flat = object(samples::torus(), 0.5);
    flat.placement.scale.y = 0.0;
    assert_eq!(draw(flat).key.as_deref(), Some("object.0"));
    assert_eq!(
        draw(object(Outline::default(), 0.5)).key.as_deref(),
        Some("object.0.profile")
    );
    let huge = Settings {
        width: 100_000,
        height: 100_000,
        ..Settings::exact()
    };
    let error = super::draw(
        &scene(vec![object(samples::torus(), 0.5)]),
        &huge,
        &|_, _| {},
    )
    .unwrap_err();
    assert_eq!(error.kind, ErrorKind::TooLarge);
}

mod crowds;
