//! Compares the coverage of smoothed silhouettes with 64 rays of the reference per pixel.

use crate::common::samples;
use glam::DVec3;
use revmap::frame::Frame;
use revmap::profile::{Outline, Profile};
use revmap::scene::{Camera, CameraFrame, Object, Placement, Scene};
use revmap_offscreen::antialias::{coverage, silhouettes};
use revmap_reference::{Ray, Reference};
use std::sync::Arc;

const SIZE: (u32, u32) = (120, 90);
const SIDE: u32 = 8;

fn scene(outline: Outline, eye: DVec3) -> Scene {
    let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.03, 0.0, 0.48)));
    let profile = Arc::new(Profile::new(outline, 0.6));
    scene.objects.push(Object::new("solid", profile));
    scene
}

/// Coverage of each pixel by 64 rays, and a picture with one ray per pixel: white solids on a
/// transparent background.
fn drawn(scene: &Scene) -> (Vec<f64>, Frame) {
    let reference = Reference::new(scene).unwrap();
    let camera = CameraFrame::new(&scene.camera, SIZE.0, SIZE.1).unwrap();
    let distance = |x: f64, y: f64| {
        let direction = camera.direction(x, y);
        let origin = camera.eye;
        let hit = reference.trace(Ray { origin, direction }).hit;
        hit.map_or(f64::INFINITY, |hit| hit.t * direction.length())
    };
    let mut frame = Frame::new(SIZE.0, SIZE.1, [0.0; 4]).unwrap();
    let place = |pixel: usize| (pixel as u32 % SIZE.0, pixel as u32 / SIZE.0);
    for pixel in 0..frame.pixels() {
        let (x, y) = place(pixel);
        frame.distance[pixel] = distance(f64::from(x) + 0.5, f64::from(y) + 0.5) as f32;
        if frame.hits(pixel) {
            frame.color[pixel] = [1.0; 4];
        }
    }
    let part = |k: u32| (f64::from(k) + 0.5) / f64::from(SIDE);
    let covered = (0..frame.pixels()).map(|pixel| {
        let (x, y) = place(pixel);
        let hits = |x: u32, y: u32| frame.hits((y * SIZE.0 + x) as usize);
        let beside = |x: u32, most: u32| x.saturating_sub(1)..(x + 2).min(most);
        let own = hits(x, y);
        let alike = |y| beside(x, SIZE.0).all(|x| hits(x, y) == own);
        // A pixel whose neighbours are like itself is not cut, except by something thinner than a
        // pixel.
        if beside(y, SIZE.1).all(alike) {
            return f64::from(u8::from(own));
        }
        let (x, y) = (f64::from(x), f64::from(y));
        let hits = (0..SIDE * SIDE)
            .filter(|k| distance(x + part(k % SIDE), y + part(k / SIDE)).is_finite())
            .count();
        hits as f64 / f64::from(SIDE * SIDE)
    });
    (covered.collect(), frame)
}

/// Mean error of coverage over the pixels that a silhouette cuts, and the 95th percentile.
fn error(covered: &[f64], frame: &Frame) -> [f64; 2] {
    let cut = |(a, _): &(&f64, _)| **a > 0.0 && **a < 1.0;
    let pixels = covered.iter().zip(&frame.color).filter(cut);
    let mut errors: Vec<f64> = pixels
        .map(|(a, color)| (a - f64::from(color[3])).abs())
        .collect();
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    [mean, errors[errors.len() * 95 / 100]]
}

fn cases() -> Vec<(String, Scene)> {
    let eyes = [[2.2, 0.4, 1.3], [-0.6, 1.9, 0.5], [0.3, -0.9, 2.1]].map(DVec3::from_array);
    let outlines = [
        ("ball", samples::ball(0.4, 400)),
        ("cylinder", samples::cylinder(0.3, 0.1, 0.9)),
        ("cone", samples::cone(0.4, 0.1, 0.9)),
        ("torus", samples::torus()),
        ("glass", samples::glass()),
        ("hollow", samples::hollow()),
        ("random 0", samples::random(0)),
        ("random 1", samples::random(1)),
        ("random 2", samples::random(2)),
    ];
    let mut all = Vec::new();
    for (name, outline) in outlines {
        for eye in eyes {
            all.push((format!("{name} from {eye}"), scene(outline.clone(), eye)));
        }
    }
    // These have another placement, an axis off the middle, or an offset that grows the box.
    let (_, scene) = &mut all[3];
    let object = &mut scene.objects[0];
    object.placement = Placement {
        scale: DVec3::new(1.4, 0.8, 0.7),
        rotation: glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.2, 1.0),
        position: DVec3::new(0.1, -0.1, 0.2),
    };
    all[1].1.objects[0].axis = [0.6, 0.45];
    all[8].1.objects[0].offset.extend = 0.15;
    all
}

#[test]
fn pixels_are_covered_as_64_rays_say() {
    let mut failures = Vec::new();
    let mut sums = [0.0; 3];
    let cases = cases();
    for (name, scene) in &cases {
        let (covered, one) = drawn(scene);
        let mut smoothed = one.clone();
        silhouettes(scene, &mut smoothed).unwrap();
        // Planted fault: lines half a pixel beside.
        let mut beside = one.clone();
        let mut moved = scene.clone();
        moved.camera.shift = [0.5, 0.0];
        silhouettes(&moved, &mut beside).unwrap();
        let [before, after, fault] = [&one, &smoothed, &beside].map(|f| error(&covered, f));
        println!("{name}: one ray {before:.3?}, smoothed {after:.3?}, planted {fault:.3?}");
        for (sum, value) in sums.iter_mut().zip([before, after, fault]) {
            *sum += value[0] / cases.len() as f64;
        }
        if after[0] > 0.05 || fault[0] < 0.1 {
            failures.push(format!("{name}: {after:.3?}, planted {fault:.3?}"));
        }
    }
    println!("means: {sums:.4?}");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(sums[1] < 0.02, "{sums:?}");
}

#[test]
fn what_is_hidden_smooths_nothing() {
    let mut scene = scene(samples::ball(0.4, 400), DVec3::new(2.2, 0.4, 1.3));
    let (_, one) = drawn(&scene);
    let smoothed = |scene: &Scene| {
        let mut frame = one.clone();
        // Every blend of two pixels is visible.
        for (pixel, color) in frame.color.iter_mut().enumerate() {
            color[0] = (pixel % 7) as f32 / 7.0;
        }
        silhouettes(scene, &mut frame).unwrap();
        frame.color
    };
    let alone = smoothed(&scene);
    let mut behind = scene.objects[0].clone();
    behind.placement.position = DVec3::new(-1.0, -0.2, -0.1);
    behind.placement.scale = DVec3::splat(0.6);
    scene.objects.push(behind);
    assert!(smoothed(&scene) == alone);
    // A solid in front of the other must change the picture.
    scene.objects[1].placement.position = DVec3::new(0.9, 0.2, 0.4);
    let (_, both) = drawn(&scene);
    assert!(both.distance != one.distance);
    let mut frame = both.clone();
    for (pixel, color) in frame.color.iter_mut().enumerate() {
        let nearer = both.distance[pixel] != one.distance[pixel];
        *color = [f32::from(u8::from(nearer)), 0.0, 0.0, 1.0];
    }
    silhouettes(&scene, &mut frame).unwrap();
    let inner = |(pixel, c): &(usize, &[f32; 4])| one.hits(*pixel) && c[0] > 0.05 && c[0] < 0.95;
    let blended = frame.color.iter().enumerate().filter(inner).count();
    // Pixels of the contour before a solid.
    assert!(blended > 20, "{blended} are smoothed");
}

#[test]
fn a_line_leaves_of_a_pixel_what_can_be_counted() {
    let n = 400;
    let at = |k: u32| (f64::from(k) + 0.5) / f64::from(n) - 0.5;
    for slope in [0.0, 0.3, -0.7, 1.0] {
        for distance in [0.0, 0.1, 0.35, 0.5, 0.8, 1.2] {
            let inside = |k: &u32| at(k % n) < distance + slope * at(k / n);
            let counted = (0..n * n).filter(inside).count() as f64 / f64::from(n * n);
            let found = coverage(distance, slope);
            let near = (found - counted).abs() < 0.003;
            assert!(near, "{distance}, {slope}: {found}, {counted}");
        }
    }
}
