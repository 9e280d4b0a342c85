//! Frames in several submissions, as on a GPU whose system limits the time of one.

use crate::common::{device, sized};
use crate::embedding::three;
use glam::DVec3;
use revmap::gpu::{Offscreen, OffscreenOptions};
use revmap::scene::{Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Planes, Settings};

/// Three solids, with copies of one, or in each other's shadows.
fn scenes() -> [(&'static str, Scene); 3] {
    let (mut copies, mut shadows) = (three(), three());
    let place = |n: u32| Placement {
        position: DVec3::new(f64::from(n / 10) * -0.4, f64::from(n % 10) * 0.3 - 1.5, 0.0),
        scale: DVec3::splat(0.4),
        ..Placement::default()
    };
    copies.objects[1].instances = (0..100).map(place).collect();
    shadows.shadow = Shadow::Hard;
    [("three", three()), ("copies", copies), ("shadows", shadows)]
}

/// Bands of rows, drawn one by one, are the whole frame to the last bit in every plane but look-ups.
#[test]
fn bands_are_the_whole_frame() {
    for (name, scene) in scenes() {
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            for (planes, antialias, samples) in [
                (Planes::All, false, 1),
                (Planes::Color, true, 1),
                (Planes::Color, false, 4),
            ] {
                if stage == DrawStage::Compute && samples > 1 {
                    continue;
                }
                let settings = Settings {
                    stage,
                    planes,
                    antialias,
                    ..sized(203, 150)
                };
                let options = OffscreenOptions {
                    samples,
                    submission_ms: Some(1e-6),
                    ..OffscreenOptions::default()
                };
                let mut drawn = Offscreen::with(device(), &scene, &settings, options).unwrap();
                // A first frame of few pixels is one submission; its time divides the second.
                assert_eq!(drawn.draw().unwrap().submissions, 1);
                let mut whole = drawn.read().unwrap();
                assert_eq!(drawn.draw().unwrap().submissions, 150u32.div_ceil(8));
                let mut bands = drawn.read().unwrap();
                // Tiles are left out by the rows that are drawn, so look-ups that hit nothing differ.
                whole.steps.fill(0.0);
                bands.steps.fill(0.0);
                if let Some(difference) = whole.first_difference(&bands) {
                    panic!("{name}, {stage:?}, {planes:?}, {samples} samples: {difference}");
                }
            }
        }
    }
}
