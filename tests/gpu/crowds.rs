//! Crowds: the copies that a list leaves out are not missed.

use crate::common::prelude::*;
use crate::common::ways::apart;
use std::f64::consts::TAU;

/// Positions that are irregular but evenly distributed.
fn spots(count: u32, seed: u32) -> impl Iterator<Item = [f64; 4]> {
    (0..count).map(move |k| {
        let part = |step: f64| (f64::from(k + 1000 * seed) * step).fract();
        [0.754_877_666, 0.569_840_291, 0.618_034, 0.414_214].map(part)
    })
}

pub fn crowd(profiles: Vec<Profile>, count: u32) -> Scene {
    let mut scene = Scene::new(Camera::new(
        DVec3::new(0.0, 0.0, 1.4),
        DVec3::new(6.0, 6.0, 0.4),
    ));
    scene.lights.push(Light {
        direction: DVec3::new(0.7, 0.5, -0.4),
        color: [0.8, 0.7, 0.6],
        ..Light::default()
    });
    for (seed, profile) in (0u32..).zip(profiles) {
        let mut object = Object::new("test", Arc::new(profile));
        object.color = [0.3 + 0.3 * seed as f32, 0.7, 0.9 - 0.3 * seed as f32];
        let place = |[x, y, turn, size]: [f64; 4]| Placement {
            position: DVec3::new(12.0 * x - 1.0, 12.0 * y - 1.0, 0.0),
            rotation: DQuat::from_rotation_z(TAU * turn)
                * DQuat::from_rotation_x(0.4 * (size - 0.5)),
            scale: DVec3::new(0.7, 0.8, 0.6 + 0.6 * size),
        };
        object.instances = spots(count, seed).map(place).collect();
        scene.objects.push(object);
    }
    scene
}

pub fn army(count: u32) -> Scene {
    let profiles = vec![shapes::sphere(), shapes::vase(), shapes::cone()];
    crowd(profiles, count)
}

fn settings(stage: DrawStage) -> Settings {
    Settings {
        width: 233,
        height: 131,
        stage,
        // Compute lists patches in pictures as small as these, too.
        proxy_min_pixels: match stage {
            DrawStage::Fragment => Settings::exact().proxy_min_pixels,
            DrawStage::Compute => 0,
        },
        planes: Planes::All,
        ..Settings::exact()
    }
}

/// The same settings without lists of patches.
fn by_tree(stage: DrawStage) -> Settings {
    settings(stage).with(|s| s.solver = Solver::Quadric)
}

pub fn draw(scene: &Scene, settings: &Settings) -> Frame {
    let mut offscreen = Offscreen::new(device(), scene, settings).unwrap();
    offscreen.draw().unwrap();
    offscreen.read().unwrap()
}

#[track_caller]
pub fn assert_same_bits(a: &Frame, b: &Frame, what: &str) {
    let differs = (0..a.pixels()).filter(|&i| {
        let bits = |f: &Frame| f.pixel(i).map(f32::to_bits);
        // Look-ups include those of hidden copies.
        let count = bits(a).len() - 1;
        bits(a)[..count] != bits(b)[..count]
    });
    let first = a.first_difference(b);
    assert_eq!(differs.count(), 0, "{what}: {first:?}");
}

/// Lists of patches give the hits of the tree up to rounding. Compute uses them for copies that are
/// large in a square.
#[track_caller]
fn assert_near(a: &Frame, b: &Frame, what: &str) {
    let (hits, edge, far) = apart(a, b);
    let colors = a.color.iter().zip(&b.color);
    let shaded = colors.filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 0.01));
    let shaded = shaded.count();

    assert!(
        edge + far + shaded <= 1,
        "{what}: of {hits} pixels {edge} hit by one alone, {far} seen elsewhere, {shaded} of other colours"
    );
}

/// Views from within, from above, from straight above and from afar, where most copies are smaller
/// than a pixel.
pub const VIEWS: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("within", [0.0, 0.0, 0.9], [6.0, 6.0, 0.4]),
    ("above", [-5.0, -4.0, 7.0], [5.0, 5.0, 0.0]),
    ("straight down", [5.0, 5.0, 9.0], [5.0, 5.01, 0.0]),
    ("afar", [-70.0, -50.0, 30.0], [5.0, 5.0, 0.0]),
];

/// A scene from each of these views.
pub fn seen(scene: &Scene) -> impl Iterator<Item = (&'static str, Scene)> {
    VIEWS.into_iter().map(|(name, eye, target)| {
        let mut scene = scene.clone();
        (scene.camera.eye, scene.camera.target) = (eye.into(), target.into());
        (name, scene)
    })
}

/// A solid behind the eye takes no part in the range of depths, so hits keep their order.
#[test]
fn a_solid_behind_the_eye_changes_no_pixel() {
    for (name, scene) in seen(&army(700)).take(1) {
        let (eye, target) = (scene.camera.eye, scene.camera.target);
        let mut behind = scene.clone();
        let mut object = Object::new("behind", Arc::new(shapes::vase()));
        object.placement.position = eye + 10.0 * (eye - target);
        behind.objects.push(object);
        for stage in STAGES {
            let drawn = |scene: &Scene| {
                let settings = by_tree(stage);
                next_frame(&mut Offscreen::new(device(), scene, &settings).unwrap())
            };
            let what = format!("{name}: {stage:?}");
            assert_same_bits(&drawn(&behind), &drawn(&scene), &what);
        }
    }
    device().check().unwrap();
}

/// Pictures of both stages, and by lists of patches, are near to each other. Of the 60 copies of the
/// smaller army fragments draw boxes, and compute lists patches.
#[test]
fn no_copy_is_missed() {
    for count in [20, 700] {
        for (name, scene) in seen(&army(count)) {
            let frames = STAGES.map(|stage| draw(&scene, &by_tree(stage)));
            let hit = frames[0].distance.iter().filter(|d| d.is_finite()).count();
            assert!(hit > 50, "{name}: {hit} pixels");
            assert_near(&frames[0], &frames[1], &format!("{name}: both stages"));
            let listed = draw(&scene, &settings(DrawStage::Compute));
            assert_near(&frames[1], &listed, &format!("{name}: lists"));
        }
    }
    device().check().unwrap();
}

/// The same copies as separate objects, which the host places.
pub fn separate(scene: &Scene) -> Scene {
    let alone = |object: &Object| {
        let object = object.clone().with(|o| o.instances = Copies::default());
        move |placement: &Placement| object.clone().with(|o| o.placement = *placement)
    };
    let objects = scene.objects.iter();
    let separate = objects.flat_map(|o| o.placements().iter().map(alone(o)));
    scene.clone().with(|s| s.objects = separate.collect())
}

/// The picture is that of the same copies as separate objects.
#[test]
fn a_crowd_is_as_many_single_objects() {
    for stage in STAGES {
        let settings = by_tree(stage);
        for count in [20, 40] {
            let crowd = army(count);
            let [one, apart] = [&crowd, &separate(&crowd)].map(|scene| draw(scene, &settings));
            match count {
                20 => assert_same_bits(&one, &apart, "placed by the host"),
                _ => assert_near(&one, &apart, "placed by the device"),
            }
        }
    }
    device().check().unwrap();
}

/// Copies hidden from the eye may still cast a shadow. Copies that come into view are visible in
/// the first frame.
#[test]
fn hidden_copies_throw_shadows_and_come_back() {
    for stage in STAGES {
        let mut scene = army(70);
        scene.shadow = Shadow::Hard;
        let by_tree = draw(&scene, &by_tree(stage));
        let listed = draw(&scene, &settings(stage));
        assert_near(&by_tree, &listed, &format!("{stage:?}, shadows"));
        scene.shadow = Shadow::Off;
        let mut offscreen = Offscreen::new(device(), &scene, &settings(stage)).unwrap();
        for (name, scene) in seen(&scene) {
            let moved = updated(&mut offscreen, &scene);
            let fresh = draw(&scene, &settings(stage));
            assert_same_bits(&moved, &fresh, &format!("{stage:?}, {name}"));
        }
        // One object changes, and so does the part of the others that it hides.
        scene.objects[1].instances.truncate(3);
        (scene.camera.eye, scene.camera.target) = (VIEWS[3].1.into(), VIEWS[3].2.into());
        let fewer = updated(&mut offscreen, &scene);
        let fresh = draw(&scene, &settings(stage));
        assert_same_bits(&fewer, &fresh, &format!("{stage:?}, fewer"));
    }
    device().check().unwrap();
}
