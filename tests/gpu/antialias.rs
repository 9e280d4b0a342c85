//! Adaptive rays come to the colours of 64. Silhouette smoothing on a device equals smoothing a frame
//! afterwards: in both stages, for one object and several, with colour only and with all planes.

use crate::common::prelude::*;
use revmap_offscreen::adaptive::{Adaptive, Refined};
use revmap_offscreen::antialias::silhouettes;
use revmap_offscreen::samples::averaged;

fn settings(stage: DrawStage, planes: Planes, antialias: bool) -> Settings {
    Settings {
        planes,
        antialias,
        ..drawn_by((200, 150), stage, Solver::DEFAULT)
    }
}

/// Pixels with a channel that differs by more than the rounding to 8 bits.
fn different(a: &Frame, b: &Frame) -> usize {
    different_by(2.5, a, b)
}

/// Pixels with a colour that differs by more than so many of 255, or with another alpha.
fn different_by(most: f32, a: &Frame, b: &Frame) -> usize {
    let code = |v: f32| revmap::frame::srgb_from_linear(f64::from(v)) * 255.0;
    let differ = |a: &[f32; 4], b: &[f32; 4]| {
        let color = (0..3).any(|c| (code(a[c]) - code(b[c])).abs() > f64::from(most));
        color || (a[3] - b[3]).abs() > 0.01
    };
    let pairs = a.color.iter().zip(&b.color);
    pairs.filter(|(a, b)| differ(a, b)).count()
}

#[test]
fn every_stage_smooths_the_same_silhouettes() {
    let one = scene_of(shapes::vase(), eye(25.0, 2.2));
    let mut two = one.clone();
    let mut second = two.objects[0].clone();
    second.placement.position += DVec3::new(0.3, 0.25, 0.1);
    second.color = [0.1, 0.5, 0.2];
    two.objects.push(second);
    for (name, scene) in [("one", &one), ("two", &two)] {
        for stage in STAGES {
            check(&format!("{name}, {stage:?}"), scene, stage);
        }
    }
}

fn check(name: &str, scene: &Scene, stage: DrawStage) {
    let plain = draw(scene, &settings(stage, Planes::All, false));
    let mut expected = plain.clone();
    silhouettes(scene, &mut expected).unwrap();
    let changed = different(&plain, &expected);
    assert!(changed > 200, "{name}: {changed} pixels are smoothed");
    let all = draw(scene, &settings(stage, Planes::All, true));
    assert!(all.first_difference(&expected).is_none(), "{name}");
    // Depths come from the depth buffer: rounding may hide a line.
    let color = draw(scene, &settings(stage, Planes::Color, true));
    let off = different(&color, &expected);
    assert!(off * 50 <= changed, "{name}: {off} of {changed} differ");
    let color = draw(scene, &settings(stage, Planes::Color, false));
    assert_eq!(
        different_by(1.01, &color, &plain),
        0,
        "{name}: not asked for"
    );
}

/// A frame of a stage with adaptive rays.
fn refined(scene: &Scene, stage: DrawStage) -> (Frame, Refined) {
    let settings = settings(stage, Planes::Color, false);
    let mut frame = draw(scene, &settings);
    let mut adaptive = Adaptive::new(device(), scene, &settings).unwrap();
    let refined = adaptive.refine(scene, &mut frame).unwrap();
    drop(adaptive);
    device().check().unwrap();
    (frame, refined)
}

/// Solids that shade each other, and a rim thinner than a pixel.
#[test]
fn adaptive_rays_come_to_the_colours_of_many() {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 2.6));
    let thin = Profile::polygon(&[[0.0, 0.3], [0.49, 0.3], [0.49, 0.302], [0.0, 0.302]], 0.5);
    scene
        .objects
        .push(Object::new("thin", Arc::new(thin.unwrap())));
    scene.lights = vec![Light {
        direction: DVec3::new(0.6, 1.0, -0.8),
        radius: 3.0,
        ..Light::default()
    }];
    scene.shadow = Shadow::Soft;
    for stage in STAGES {
        let settings = settings(stage, Planes::Color, false);
        let mut offscreen = Offscreen::new(device(), &scene, &settings).unwrap();
        let truth = averaged(64, &scene, |scene| {
            offscreen.update(scene)?;
            offscreen.draw()?;
            offscreen.read()
        });
        let truth = truth.unwrap();
        drop(offscreen);
        let (frame, rays) = refined(&scene, stage);
        let one = draw(&scene, &settings);
        let count = frame.pixels();
        let [off, before] = [&frame, &one].map(|of| different(of, &truth));
        assert!(off * 500 <= count, "{stage:?}: {off} of {count}");
        assert!(
            before > 20 * off.max(20),
            "{stage:?}: {before} with one ray"
        );
        assert!(rays.mean() < 16.0, "{stage:?}: {} rays", rays.mean());
        let is_known = |rays: &u8| [0, 4, 16, 64].contains(rays);
        assert!(rays.rays.iter().all(is_known) && rays.rays.contains(&0));
    }
}

/// A pixel of an inner corner is covered little more or less when the camera moves by a tenth of it.
#[test]
fn corners_do_not_crawl() {
    let points = [
        [0.0, 0.0],
        [0.35, 0.0],
        [0.1, 0.2],
        [0.1, 0.5],
        [0.3, 0.7],
        [0.08, 0.72],
        [0.2, 0.95],
        [0.0, 1.0],
    ];
    let solid = Object::new("solid", Arc::new(Profile::polygon(&points, 0.5).unwrap()));
    let at = |d: f64| {
        let mut scene = Scene::new(Camera::new(
            DVec3::new(3.0, d, 0.8),
            DVec3::new(0.0, d, 0.5),
        ));
        scene.objects.push(solid.clone());
        scene
    };
    let settings = settings(DrawStage::Fragment, Planes::Color, false);
    let mut adaptive = Adaptive::new(device(), &at(0.0), &settings).unwrap();
    let frame = |adaptive: Option<&mut Adaptive>, step: u32| {
        let scene = at(0.001456 * f64::from(step));
        let mut frame = draw(&scene, &settings);
        if let Some(adaptive) = adaptive {
            adaptive.refine(&scene, &mut frame).unwrap();
        }
        frame
    };
    let largest = |a: &Frame, b: &Frame| {
        let pairs = a.color.iter().zip(&b.color);
        pairs.map(|(a, b)| (a[3] - b[3]).abs()).fold(0.0, f32::max)
    };
    let (mut plain, mut smooth) = (frame(None, 0), frame(Some(&mut adaptive), 0));
    let (mut jumps, mut steps) = (0.0f32, 0.0f32);
    for step in 1..=8 {
        let next = [frame(None, step), frame(Some(&mut adaptive), step)];
        (jumps, steps) = (
            jumps.max(largest(&plain, &next[0])),
            steps.max(largest(&smooth, &next[1])),
        );
        [plain, smooth] = next;
    }
    assert!(steps <= 0.3, "{steps}");
    assert!(jumps > 0.9, "{jumps}");
}
