//! What ground truth and comparison cost: `cargo bench --bench reference`.
#![allow(missing_docs, clippy::unwrap_used)]

use divan::{Bencher, black_box};
use glam::{DVec2, DVec3};
use revmap::frame::Frame;
use revmap::profile::{Outline, Profile};
use revmap::scene::{Camera, Object, Offset, Scene};
use revmap::settings::Settings;
use revmap_lab::compare::{CompareOptions, compare, flip_map, silhouette_hausdorff};
use revmap_reference::{Analytic, Ray, Reference, draw};
use std::sync::Arc;

fn main() {
    divan::main();
}

/// A vase of `n` segments, seen from the side and a little above.
fn scene(n: usize, offset: Offset) -> Scene {
    let wall = (0..=n).map(|k| {
        let z = 0.05 + 0.9 * k as f64 / n as f64;
        DVec2::new(0.25 + 0.12 * (9.0 * z).sin() * (1.0 - 0.5 * z), z)
    });
    let points = [DVec2::new(0.0, 0.05)]
        .into_iter()
        .chain(wall)
        .chain([DVec2::new(0.0, 0.95)]);
    let outline = Outline {
        loops: vec![points.collect()],
    };
    let profile = Arc::new(Profile::new(outline, 0.45));
    let object = Object {
        offset,
        ..Object::new("vase", profile)
    };
    let camera = Camera::new(DVec3::new(1.6, 0.3, 1.1), DVec3::new(0.0, 0.0, 0.5));
    Scene {
        objects: vec![object],
        ..Scene::new(camera)
    }
}

const PLAIN: Offset = Offset {
    extend: 0.0,
    bevel: 0.0,
    chamfer: 1.0,
};
const CHAMFERED: Offset = Offset {
    extend: 0.02,
    bevel: 0.4,
    chamfer: 0.5,
};

fn frame(scene: &Scene) -> Frame {
    draw(scene, &Settings::exact(), &|_, _| {}).unwrap()
}

/// A whole picture of 800 x 600.
#[divan::bench(args = [16, 400, 10_000], sample_count = 5, sample_size = 1)]
fn draw_plain(bencher: Bencher, segments: usize) {
    let scene = scene(segments, PLAIN);
    bencher.bench(|| frame(black_box(&scene)));
}

#[divan::bench(args = [16, 400], sample_count = 5, sample_size = 1)]
fn draw_chamfered(bencher: Bencher, segments: usize) {
    let scene = scene(segments, CHAMFERED);
    bencher.bench(|| frame(black_box(&scene)));
}

fn ray(k: u32) -> Ray {
    let aim = DVec3::new(0.1, 0.05, (f64::from(k) * 0.618).fract());
    let origin = DVec3::new(2.0, (f64::from(k) * 0.7548).fract() - 0.5, 1.0);
    Ray {
        origin,
        direction: aim - origin,
    }
}

/// One ray by each method.
#[divan::bench(args = [16, 400])]
fn ray_bracketed(bencher: Bencher, segments: usize) {
    let reference = Reference::new(&scene(segments, CHAMFERED)).unwrap();
    let mut k = 0;
    bencher.bench_local(|| {
        k += 1;
        reference.trace(ray(k))
    });
}

#[divan::bench(args = [16, 400])]
fn ray_analytic(bencher: Bencher, segments: usize) {
    let analytic = Analytic::new(&scene(segments, CHAMFERED)).unwrap();
    let mut k = 0;
    bencher.bench_local(|| {
        k += 1;
        analytic.trace(ray(k))
    });
}

/// All figures of two frames of 800 x 600, and the two dear ones alone.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn compare_frames(bencher: Bencher) {
    let (a, b) = (frame(&scene(400, PLAIN)), frame(&scene(16, PLAIN)));
    bencher.bench(|| compare(black_box(&a), &b, &CompareOptions::default()).unwrap());
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn flip_frames(bencher: Bencher) {
    let (a, b) = (frame(&scene(400, PLAIN)), frame(&scene(16, PLAIN)));
    bencher.bench(|| flip_map(black_box(&a), &b, 67.0));
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn hausdorff_frames(bencher: Bencher) {
    let (a, b) = (frame(&scene(400, PLAIN)), frame(&scene(16, PLAIN)));
    bencher.bench(|| silhouette_hausdorff(black_box(&a), &b));
}
