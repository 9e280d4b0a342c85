#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
//! Rays whose result is computed by hand.

mod analytic;
mod crowds;

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

fn shoot(object: &Object, origin: [f64; 3], direction: [f64; 3]) -> Trace {
    let ray = Ray::new(origin, direction);
    let reference = Reference::new(&scene(vec![object.clone()])).unwrap();
    reference.trace(ray)
}

/// Compares rays with what they must hit: lines of origin, direction, `t`, normal and surface
/// (`turned`, or the axis of a cut); or of origin and direction alone, for no hit.
#[track_caller]
fn assert_hits(object: &Object, rays: &str) {
    for line in rays.trim().lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |n: usize| words[n].parse::<f64>().unwrap();
        let vector = |n: usize| [n, n + 1, n + 2].map(number);
        let hit = shoot(object, vector(0), vector(3)).hit;
        let [.., surface] = words[..] else { continue };
        if words.len() == 6 {
            assert!(hit.is_none(), "{line}: {hit:?}");
            continue;
        }
        let (hit, normal) = (hit.expect("a hit"), DVec3::from(vector(7)));
        assert!((hit.t - number(6)).abs() < 1e-12, "{line}: {hit:?}");
        assert!((hit.normal - normal).length() < 1e-9, "{line}: {hit:?}");
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == surface);
        let surface = axis.map_or(Surface::Turned, Surface::Cut);
        assert_eq!(hit.surface, surface, "{line}");
    }
}

#[test]
fn a_cylinder_from_all_sides() {
    // The sixth ray comes from inside and hits the back of the surface, with its outward normal.
    let rays = "
        2.0 0.0  0.5   -1 0  0   1.75     1 0  0   turned
        2.0 0.0  0.5   -4 0  0   0.4375   1 0  0   turned
        0.1 0.1  3.0    0 0 -1   2.2      0 0  1   turned
        0.0 0.0  3.0    0 0 -1   2.2      0 0  1   turned
        0.0 0.1 -1.0    0 0  1   1.2      0 0 -1   turned
        0.0 0.0  0.5    0 1  0   0.25     0 1  0   turned
        2.0 0.0  0.5    1 0  0
        2.0 0.26 0.5   -1 0  0";
    assert_hits(&object(samples::cylinder(0.25, 0.2, 0.8), 0.5), rays);
}

#[test]
fn rays_that_are_none_hit_nothing() {
    let c = object(samples::cylinder(0.25, 0.2, 0.8), 0.5);
    let (nan, far) = (f64::NAN, f64::MAX);
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
        assert_eq!(shoot(&c, origin, direction), Trace::default());
        let reference = Reference::new(&scene(vec![c.clone()])).unwrap();
        let ray = Ray::new(origin, direction);
        for part in [[0.0, f64::INFINITY], [0.5, 0.5], [nan, nan]] {
            let least = reference.clearance_within(ray, part, 1e-6);
            assert_eq!(least, f64::INFINITY, "{ray:?}");
        }
        // The placement of the solid makes no difference.
        let mut turned = c.clone();
        turned.placement.scale = DVec3::new(1e-200, 1e200, 1.0);
        assert!(shoot(&turned, origin, direction).hit.is_none());
    }
    // Rays straight down the axis, and within a face's own plane, give finite numbers.
    let down = shoot(&c, [0.0, 0.0, 0.5], [0.0, 0.0, 1e-300]);
    assert!(down.hit.is_none_or(|h| h.t.is_finite()));
    assert_hits(&c, "2 0.5 0.5  -1 0 0");
}

#[test]
fn the_box_closes_what_it_cuts() {
    // A solid wider than its box, and through its floor and ceiling. The third ray comes from
    // inside and hits the face through which it leaves.
    let rays = "
        2.0 0 0.5   -1  0  0   1.6   1  0 0   x
        0.1 0.1 3    0  0 -1   2     0  0 1   z
        0.1 0 0.5    0 -1  0   0.4   0 -1 0   y";
    let c = object(samples::cylinder(0.45, -0.5, 1.5), 0.4);
    assert_hits(&c, rays);
    // The cylinder's own side is seen near the box's corner, beyond the face.
    let y = 0.35f64;
    let x = (0.45f64 * 0.45 - y * y).sqrt();
    let (t, nx, ny) = (2.0 - x, x / 0.45, y / 0.45);
    assert_hits(&c, &format!("2 {y} 0.5  -1 0 0  {t} {nx} {ny} 0 turned"));
}

#[test]
fn a_solid_that_ends_at_its_box_is_met_there() {
    let c = object(samples::cylinder(0.5, 0.0, 1.0), 0.5);
    for (origin, direction, t, normal) in [
        ([0.1, 0.2, 2.0], [0.0, 0.0, -1.0], 1.0, [0.0, 0.0, 1.0]),
        ([0.1, 0.2, -1.0], [0.0, 0.0, 1.0], 1.0, [0.0, 0.0, -1.0]),
        ([2.0, 0.0, 0.5], [-1.0, 0.0, 0.0], 1.5, [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.5], [0.0, 0.0, 1.0], 0.5, [0.0, 0.0, 1.0]),
    ] {
        let hit = shoot(&c, origin, direction).hit.expect("a hit");
        let apart = (hit.normal - DVec3::from(normal)).length();
        assert!((hit.t - t).abs() < 1e-9 && apart < 1e-9, "{hit:?}");
    }
}

#[test]
fn offsets_move_the_surface_as_the_formula_says() {
    // `r = 0.2 + e + b (1 - z)`: a cone whose normal climbs. Chamfered to depth 0.25: a cone above
    // z = 0.75, a cylinder of its foot's radius below.
    let up = DVec3::new(1.0, 0.0, 0.3).normalize().to_array();
    let level = [1.0, 0.0, 0.0];
    for (extend, bevel, chamfer, z, t, [x, y, nz]) in [
        (0.1, 0.0, 1.0, 0.5, 1.7, level),
        (-0.05, 0.0, 1.0, 0.5, 1.85, level),
        (0.1, 0.3, 1.0, 0.6, 2.0 - 0.3 - 0.12, up),
        (0.1, 0.3, 0.25, 0.8, 2.0 - 0.3 - 0.06, up),
        (0.1, 0.3, 0.25, 0.6, 2.0 - 0.3 - 0.075, level),
    ] {
        let mut o = object(samples::cylinder(0.2, -1.0, 2.0), 0.5);
        o.offset = Offset {
            extend,
            bevel,
            chamfer,
        };
        assert_hits(&o, &format!("2 0 {z}  -1 0 0  {t} {x} {y} {nz} turned"));
    }
}

#[test]
fn placement_scales_turns_and_moves() {
    let mut o = object(samples::cylinder(0.25, 0.2, 0.8), 0.5);
    o.placement = Placement {
        position: DVec3::new(10.0, 0.0, 1.0),
        rotation: DQuat::from_rotation_y(FRAC_PI_2),
        scale: DVec3::new(1.0, 3.0, 2.0),
    };
    // The solid's z is now along world x: the cap at 0.8 is at 10 + 1.6. The elliptic side extends
    // to 0.75 along y.
    let rays = "
        20 0.1 1.1   -1  0 0   8.4    1 0 0   turned
        11 5.0 1.0    0 -1 0   4.25   0 1 0   turned";
    assert_hits(&o, rays);
    // The normal of a squeezed ball by the inverse transpose, compared with the ellipsoid's own.
    let mut o = object(samples::ball(0.4, 4000), 0.5);
    let scale = DVec3::new(2.0, 0.5, 1.0);
    o.placement.scale = scale;
    let hit = shoot(&o, [3.0, 0.05, 0.7], [-1.0, 0.02, -0.1]).hit.unwrap();
    let p = DVec3::new(3.0, 0.05, 0.7) + DVec3::new(-1.0, 0.02, -0.1) * hit.t - DVec3::Z * 0.5;
    assert!(((p / scale).length() - 0.4).abs() < 1e-6);
    assert!((hit.normal - (p / (scale * scale)).normalize()).length() < 2e-3);
}

#[test]
fn the_axis_may_stand_anywhere() {
    let mut o = object(samples::cylinder(0.25, -1.0, 2.0), 0.5);
    // At (0.25, -0.25).
    o.axis = [0.75, 0.25];
    assert_hits(&o, "0.25 2 0.5  0 -1 0  2  0 1 0  turned");
    // With the axis on the corner itself, half of it is cut away.
    o.axis = [1.0, 0.5];
    assert_hits(&o, "2 0.1 0.5  -1 0 0  1.5  1 0 0  x");
}

#[test]
fn cavities_and_rings() {
    let o = object(samples::hollow(), 0.5);
    // Ring, gap, shell, cavity.
    assert_hits(&o, "2 0 0.5  -1 0 0  1.54  1 0 0  turned");
    let t = |x: f64| shoot(&o, [x, 0.0, 0.5], [-1.0, 0.0, 0.0]).hit.unwrap().t;
    assert!((t(0.43) - 0.03).abs() < 1e-12);
    assert!((t(0.38) - 0.03).abs() < 1e-12);
    // The cavity's wall is seen from its middle: the outward normal points back.
    let hit = shoot(&o, [0.0, 0.0, 0.5], [1.0, 0.0, 0.0]).hit.unwrap();
    assert!((hit.t - 0.25).abs() < 1e-12 && hit.normal.x < 0.0);
    assert_hits(&o, "0 0 0.5  0 0 1  0.2  0 0 -1  turned");
}

fn settings(width: u32, height: u32) -> Settings {
    Settings {
        width,
        height,
        ..Settings::exact()
    }
}

#[test]
fn a_picture_is_the_same_on_any_number_of_threads() {
    let mut o = object(samples::glass(), 0.4);
    o.offset.bevel = 0.1;
    let scene = scene(vec![o]);
    let settings = settings(64, 48);
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
    let mut numbers = one
        .color
        .as_flattened()
        .iter()
        .chain(one.normal.as_flattened());
    assert!(numbers.all(|v| v.is_finite()));
}

#[test]
fn progress_counts_rows_to_the_end() {
    let scene = scene(vec![object(samples::torus(), 0.5)]);
    let settings = settings(8, 20);
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
    let small = settings(8, 8);
    let draw = |o: Object| super::draw(&scene(vec![o]), &small, &|_, _| {}).unwrap_err();
    let mut flat = object(samples::torus(), 0.5);
    flat.placement.scale.y = 0.0;
    assert_eq!(draw(flat).key.as_deref(), Some("object.0"));
    assert_eq!(
        draw(object(Outline::default(), 0.5)).key.as_deref(),
        Some("object.0.profile")
    );
    let torus = scene(vec![object(samples::torus(), 0.5)]);
    let error = super::draw(&torus, &settings(100_000, 100_000), &|_, _| {}).unwrap_err();
    assert_eq!(error.kind, ErrorKind::TooLarge);
}
