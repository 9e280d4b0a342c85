//! Shadows between ten thousand copies, and between more objects and shapes than a search on maps
//! can draw.

use crate::common::prelude::*;
use crate::shadows::{otherwise_lit, table};

/// A plate of 10 x 10 under one low light.
fn plate() -> Scene {
    let camera = Camera::new(DVec3::new(4.2, 2.6, 2.4), DVec3::new(2.6, 1.2, 0.0));
    table(camera, DVec3::new(-0.6, 0.45, -0.35), [15.0, 15.0, 0.1])
}

/// Placements in a square of `side` x `side`, turned and scaled by their number.
fn field(side: u32) -> Vec<Placement> {
    let step = 10.0 / f64::from(side);
    let of = |n: u32| {
        let part = |step: f64| (f64::from(n) * step).fract();
        let at = |k: u32, turn: f64| (f64::from(k) + 0.3 * turn) * step - 5.0;
        Placement {
            position: DVec3::new(at(n % side, part(0.618)), at(n / side, part(0.755)), 0.0),
            rotation: DQuat::from_rotation_x(0.6 * part(0.57) - 0.3),
            scale: DVec3::splat(step * (0.5 + 0.9 * part(0.41))),
        }
    };
    (0..side * side).map(of).collect()
}

#[test]
fn ten_thousand_copies_shade_each_other() {
    let mut scene = plate();
    let mut copies = Object::new("copies", Arc::new(shapes::jewel()));
    copies.specular.strength = 0.0;
    copies.instances = field(100).into();
    scene.objects.push(copies);
    let settings = sized(160, 120);
    let truth = reference(&scene, &settings);
    let mut fewer = scene.clone();
    let some = field(100).into_iter().enumerate();
    let kept = some.filter(|(n, _)| n % 5 != 0).map(|(_, copy)| copy);
    fewer.objects[1].instances = kept.collect();
    for stage in STAGES {
        let settings = Settings { stage, ..settings };
        let frame = draw(&scene, &settings);
        assert_sound(&frame, "copies");
        let [off, dark, all] = otherwise_lit(&truth, &frame);
        let [planted, ..] = otherwise_lit(&truth, &draw(&fewer, &settings));
        println!("{stage:?}: {off} of {all} lit otherwise, {dark} dark; planted {planted}");
        assert!(dark > 3000 && 200 * off <= all, "{stage:?}: {off} of {all}");
        assert!(planted > 10 * off && planted > 200, "{stage:?}: {planted}");
    }
}

/// Eighty objects of forty shapes. Searches on patches draw them; searches on maps refuse so many
/// maps (`tests/gpu/refusals.rs`).
#[test]
fn shadows_have_no_limit_on_objects_and_shapes() {
    let mut scene = plate();
    let places = field(9);
    for (n, copy) in places.iter().take(80).enumerate() {
        let radius = 0.2 + 0.005 * (n % 40) as f64;
        let points = [[0.0, 0.0], [radius, 0.4], [0.5 * radius, 0.9], [0.0, 1.0]];
        let profile = Profile::polygon(&points, 0.5).unwrap();
        let mut object = Object::new(format!("{n}"), Arc::new(profile));
        object.placement = *copy;
        object.specular.strength = 0.0;
        scene.objects.push(object);
    }
    let settings = sized(120, 90);
    let truth = reference(&scene, &settings);
    for stage in STAGES {
        let settings = settings.with(|s| (s.stage, s.solver) = (stage, Solver::Quadric));
        let [off, dark, all] = otherwise_lit(&truth, &draw(&scene, &settings));
        println!("{stage:?}: {off} of {all} lit otherwise, {dark} dark");
        assert!(dark > 500 && 200 * off <= all, "{stage:?}: {off} of {all}");
    }
}
