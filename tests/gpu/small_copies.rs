//! Copies smaller than a pixel: coverage and colour are right on average.

use crate::common::prelude::*;
use crate::common::random::Random;

const SIZE: (u32, u32) = (480, 360);
/// Pixels of the finer picture in a pixel, along each side.
const FINER: u32 = 4;
/// Pixels that a copy is high.
const HEIGHT: f64 = 0.9;

/// Copies at random in a picture of `SIZE`, all of one size.
fn field(count: u32) -> Scene {
    let distance = 1000.0;
    let mut scene = scene_of(shapes::vase(), DVec3::new(distance, 0.0, 0.0));
    scene.camera.target = DVec3::ZERO;
    scene.background = [0.0; 4];
    let half = distance * (0.5 * scene.camera.fov_y.to_radians()).tan();
    let pixel = 2.0 * half / f64::from(SIZE.1);
    let mut numbers = Random(11);
    let mut random = move || numbers.next() - 0.5;
    let (width, height) = (f64::from(SIZE.0) - 4.0, f64::from(SIZE.1) - 4.0);
    let mut place = |_| {
        let at = [0.0, width * pixel * random(), height * pixel * random()];
        placement(at, [0.0; 3], [HEIGHT * pixel; 3])
    };
    scene.objects[0].instances = (0..count).map(&mut place).collect();
    scene
}

/// Means over all pixels: coverage, then the three channels of the colour.
fn means(frame: &Frame) -> [f64; 4] {
    let count = frame.distance.len() as f64;
    let hits = frame.distance.iter().filter(|d| d.is_finite()).count();
    let channel = |k: usize| frame.color.iter().map(|c| f64::from(c[k])).sum::<f64>() / count;
    [hits as f64 / count, channel(0), channel(1), channel(2)]
}

fn drawn(scene: &Scene, stage: DrawStage, finer: u32, tolerance: f64) -> Frame {
    let settings = Settings {
        tolerance: Tolerance::new(tolerance).unwrap(),
        ..drawn_by((finer * SIZE.0, finer * SIZE.1), stage, Solver::DEFAULT)
    };
    next_frame(&mut Offscreen::new(device(), scene, &settings).unwrap())
}

#[test]
fn means_are_those_of_many_samples() {
    let scene = field(20_000);
    for stage in STAGES {
        let wanted = means(&drawn(&scene, stage, FINER, 0.0));
        // Each copy covers a sample or none: the variance of their number is below their number.
        let samples = wanted[0] * f64::from(SIZE.0 * SIZE.1);
        let most = 4.0 / samples.sqrt();
        assert!(samples > 4000.0, "{samples}");
        let apart = |found: [f64; 4]| {
            let ratios = found.iter().zip(wanted).map(|(f, w)| (f / w - 1.0).abs());
            ratios.fold(0.0, f64::max)
        };
        let found = means(&drawn(&scene, stage, 1, 0.25));
        println!("{stage:?}: {samples} samples, {wanted:?}, {found:?}");
        assert!(apart(found) < most, "{stage:?}: {wanted:?}, {found:?}");

        // A tenth of the copies is missed.
        let fewer = means(&drawn(&field(18_000), stage, 1, 0.25));
        assert!(apart(fewer) > most, "{stage:?}: {wanted:?}, {fewer:?}");
    }
    device().check().unwrap();
}
