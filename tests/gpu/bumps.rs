//! Bump mapping compared with the normal of the truly displaced surface, for every projection.

use crate::common::prelude::*;
use std::f64::consts::{PI, TAU};

/// Lower and upper rim of a cup's outside: the tested surface is exactly this cone.
const RIMS: [[f64; 2]; 2] = [[0.22, 0.08], [0.4, 0.92]];

fn cup() -> Profile {
    let [low, high] = RIMS;
    Profile::polygon(&[[0.0, low[1]], low, high, [0.0, high[1]]], 0.5).unwrap()
}

/// Low waves: the error of 16-bit slopes and of filtering stays far below the measured quantity.
fn height([u, v]: [f64; 2]) -> f64 {
    0.5 + 0.2 * (TAU * 2.0 * u + 0.4).sin() + 0.15 * (TAU * v).cos() * (TAU * u).cos()
}

fn coordinates(projection: Projection, arc: &ArcLength, p: DVec3) -> [f64; 2] {
    let r = p.x.hypot(p.y);
    let xi = (PI + p.y.atan2(p.x)) / TAU;
    match projection {
        Projection::Planar => [p.x + 0.5, p.y + 0.5],
        Projection::Cylindrical => [xi, p.z],
        Projection::Spherical => [xi, 1.0 - r.atan2(p.z - 0.5) / PI],
        Projection::Arc => [xi, arc.eta(r, p.z)],
    }
}

/// The normal of `q = p + a H N`, where `p` is the cone's point at azimuth `phi` and height `z`. It
/// is computed by finite differences of `q` itself.
fn displaced_normal(projection: Projection, arc: &ArcLength, a: f64, phi: f64, z: f64) -> DVec3 {
    let [low, high] = RIMS.map(DVec2::from);
    let side = high - low;
    let q = |phi: f64, z: f64| {
        let r = low.x + (z - low.y) / side.y * side.x;
        let around = DVec3::new(phi.cos(), phi.sin(), 0.0);
        let p = around * r + DVec3::Z * z;
        let n = (around * side.y - DVec3::Z * side.x) / side.length();
        p + a * height(coordinates(projection, arc, p)) * n
    };
    let step = 1e-5;
    let around = q(phi + step, z) - q(phi - step, z);
    let up = q(phi, z + step) - q(phi, z - step);
    around.cross(up).normalize()
}

/// Rms angle in radians between the shading normal and the displaced surface's normal, the rms
/// angle by which bumps turn normals, and the number of pixels.
fn remainder(scene: &Scene, frame: &Frame, arc: &ArcLength) -> (f64, f64, usize) {
    let object = &scene.objects[0];
    let place = object.placement;
    let camera = CameraFrame::new(&scene.camera, frame.width, frame.height).unwrap();
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let (mut off, mut turned, mut count) = (0.0, 0.0, 0);
    for index in (0..frame.pixels()).filter(|&i| frame.hits(i)) {
        let (x, y) = (index as u32 % frame.width, index as u32 / frame.width);
        let world = camera.eye + camera.pixel(x, y).normalize() * f64::from(frame.distance[index]);
        let p = place.rotation.conjugate() * (world - place.position) / place.scale;
        let on_side = (RIMS[0][1] + 0.03..RIMS[1][1] - 0.03).contains(&p.z);
        // A pixel at a rim covers much of a wave, so its correct normal is the mean.
        let view = (camera.eye - world).normalize();
        let faces = vector(frame.normal[index]).dot(view) > 0.3;
        if !(on_side && faces) {
            continue;
        }
        let (texturing, phi) = (&object.texturing, p.y.atan2(p.x));
        let n = displaced_normal(texturing.projection, arc, texturing.bump, phi, p.z);
        let n = (place.rotation * (n / place.scale)).normalize();
        off += n.distance_squared(vector(frame.shading_normal[index]));
        turned += n.distance_squared(vector(frame.normal[index]));
        count += 1;
    }
    let rms = |sum: f64| (sum / f64::from(count)).sqrt();
    (rms(off), rms(turned), count as usize)
}

/// Half the depth gives a quarter of the remainder.
#[test]
fn the_shading_normal_is_the_displaced_surfaces_to_first_order() {
    let part = |n: u32| (f64::from(n) + 0.5) / 128.0;
    let slopes = slope_map(128, |x, y| height([part(x), 1.0 - part(y)]) as f32);
    let plain = placement([0.0; 3], [0.0; 3], [1.0; 3]);
    let turned = placement([0.1, -0.05, 0.1], [0.2, -0.3, 0.5], [1.3, 0.8, 0.9]);
    for (_, projection) in Projection::NAMES {
        for (name, placement) in [("upright", plain), ("turned and stretched", turned)] {
            let mut scene = scene_of(cup(), eye(-5.0, 2.0));
            let arc = ArcLength::new(&scene.objects[0].profile).unwrap();
            scene.objects[0].placement = placement;
            scene.objects[0].texturing.projection = projection;
            scene.objects[0].texturing.displacement_map = Some(slopes.clone());
            let settings = sized(160, 120).with(|s| s.map_format = MapFormat::R32);
            let depths = [0.08, 0.04, 0.02];
            let errors = depths.map(|a| {
                scene.objects[0].texturing.bump = a;
                let (off, turned, count) = remainder(&scene, &draw(&scene, &settings), &arc);
                println!("{projection:?}, {name}, a = {a}: turned by {turned:.5}, off by {off:.6}, {count} pixels");
                assert!(count > 1500 && turned > 0.4 * a, "bumps are seen");
                off
            });
            for pair in errors.windows(2) {
                let ratio = pair[0] / pair[1];
                let quarter = (3.4..4.6).contains(&ratio);
                assert!(quarter, "{projection:?}, {name}: {ratio}");
            }
        }
    }
}
