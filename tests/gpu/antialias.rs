//! Silhouette smoothing on a device equals smoothing a frame afterwards: in both stages, for one
//! object and several, with colour only and with all planes.

use crate::common::prelude::*;
use revmap_offscreen::antialias::silhouettes;

fn settings(stage: DrawStage, planes: Planes, antialias: bool) -> Settings {
    Settings {
        planes,
        antialias,
        ..drawn_by((200, 150), stage, Solver::DEFAULT)
    }
}

/// Pixels with a channel that differs by more than the rounding to 8 bits.
fn different(a: &Frame, b: &Frame) -> usize {
    let code = |v: f32| revmap::frame::srgb_from_linear(f64::from(v)) * 255.0;
    let differ = |a: &[f32; 4], b: &[f32; 4]| {
        let color = (0..3).any(|c| (code(a[c]) - code(b[c])).abs() > 2.5);
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
    let off = different(&draw(scene, &settings(stage, Planes::Color, false)), &plain);
    assert_eq!(off, 0, "{name}: not asked for");
}
