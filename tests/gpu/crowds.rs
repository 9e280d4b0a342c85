//! Crowds: copies proven hidden are left out, and no pixel changes.

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

fn settings(stage: DrawStage, occlusion_culling: bool) -> Settings {
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
        occlusion_culling,
        planning: Planning::Host,
        ..Settings::exact()
    }
}

/// The same settings without lists of patches.
pub fn by_tree(stage: DrawStage, occlusion_culling: bool) -> Settings {
    settings(stage, occlusion_culling).with(|s| s.solver = Solver::Quadric)
}

pub fn draw(scene: &Scene, settings: &Settings) -> Frame {
    let mut offscreen = Offscreen::new(device(), scene, settings).unwrap();
    offscreen.draw().unwrap();
    let paths = offscreen.renderer().draw_paths();
    let tiles = paths.iter().filter(|path| **path == DrawPath::Tiles);
    let wanted = match settings.stage {
        DrawStage::Fragment => 0,
        DrawStage::Compute => paths.len(),
    };
    assert_eq!(tiles.count(), wanted, "{paths:?}");
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
                let settings = by_tree(stage, true);
                next_frame(&mut Offscreen::new(device(), scene, &settings).unwrap())
            };
            let what = format!("{name}: {stage:?}");
            assert_same_bits(&drawn(&behind), &drawn(&scene), &what);
        }
    }
    device().check().unwrap();
}

/// Pictures are equal bit for bit, with and without culling, and near to those of the other stage,
/// where the host places the copies.
#[test]
fn culled_copies_are_not_missed() {
    for (name, scene) in seen(&army(700)) {
        let frames: Vec<Frame> = STAGES
            .into_iter()
            .flat_map(|stage| [true, false].map(|cull| draw(&scene, &by_tree(stage, cull))))
            .collect();
        let hit = frames[0].distance.iter().filter(|d| d.is_finite()).count();
        assert!(hit > 50, "{name}: {hit} pixels");
        assert_same_bits(&frames[0], &frames[1], &format!("{name}: fragment, all"));
        assert_same_bits(&frames[2], &frames[3], &format!("{name}: compute, all"));
        assert_near(&frames[0], &frames[2], &format!("{name}: both stages"));
        for cull in [true, false] {
            let listed = draw(&scene, &settings(DrawStage::Compute, cull));
            assert_near(&frames[2], &listed, &format!("{name}: lists, {cull}"));
        }
        // The nearest hits in compute end the search of later copies, and copies proven hidden are
        // not even listed.
        let steps = |frame: &Frame| frame.steps.iter().map(|s| f64::from(*s)).sum::<f64>();
        assert!(steps(&frames[2]) <= steps(&frames[3]), "{name}");
    }
    device().check().unwrap();
}

/// The picture is that of the same copies as separate objects. Fragments walk to both, and the device
/// places only the copies.
#[test]
fn a_crowd_is_as_many_single_objects() {
    let scene = army(40);
    let mut single = scene.clone();
    let alone = |object: &Object| {
        let object = object.clone().with(|o| o.instances = Copies::default());
        move |placement: &Placement| object.clone().with(|o| o.placement = *placement)
    };
    let objects = scene.objects.iter();
    single.objects = objects
        .flat_map(|o| o.instances.iter().map(alone(o)))
        .collect();
    for stage in STAGES {
        let settings = by_tree(stage, true);
        let one = draw(&scene, &settings);
        let apart = next_frame(&mut Offscreen::new(device(), &single, &settings).unwrap());
        match stage {
            DrawStage::Fragment => assert_near(&one, &apart, "fragment"),
            DrawStage::Compute => assert_same_bits(&one, &apart, "compute"),
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
        let culled = draw(&scene, &by_tree(stage, true));
        let all = draw(&scene, &by_tree(stage, false));
        assert_same_bits(&culled, &all, &format!("{stage:?}, shadows"));
        let listed = draw(&scene, &settings(stage, true));
        assert_near(&culled, &listed, &format!("{stage:?}, shadows"));
        scene.shadow = Shadow::Off;
        let mut offscreen = Offscreen::new(device(), &scene, &settings(stage, true)).unwrap();
        for (name, scene) in seen(&scene) {
            let moved = updated(&mut offscreen, &scene);
            let fresh = draw(&scene, &settings(stage, true));
            assert_same_bits(&moved, &fresh, &format!("{stage:?}, {name}"));
        }
        // One object changes, and so does the part of the others that it hides.
        scene.objects[1].instances.truncate(3);
        (scene.camera.eye, scene.camera.target) = (VIEWS[3].1.into(), VIEWS[3].2.into());
        let fewer = updated(&mut offscreen, &scene);
        let fresh = draw(&scene, &settings(stage, true));
        assert_same_bits(&fewer, &fresh, &format!("{stage:?}, fewer"));
    }
    device().check().unwrap();
}
