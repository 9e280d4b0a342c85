//! Scenes of one solid, and the errors of their pictures.

use glam::{DQuat, DVec3, EulerRot};
use revmap::frame::Frame;
use revmap::maps::{ColorMap, DisplacementMap, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::{Camera, Light, Object, Placement, Scene};
use revmap_compare::{CompareOptions, Comparison, compare};
use std::sync::Arc;

/// Errors of a frame without FLIP; depths in texels of a map of `rows` rows.
pub fn errors(truth: &Frame, frame: &Frame, rows: u32) -> Comparison {
    let options = CompareOptions {
        texel: 1.0 / f64::from(rows),
        flip: false,
    };
    compare(truth, frame, &options).unwrap()
}

/// A scene with one object, seen from `eye`.
pub fn scene_of(profile: Profile, eye: DVec3) -> Scene {
    let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.0, 0.0, 0.5)));
    scene.lights.push(Light {
        direction: DVec3::new(0.7, 0.5, -0.2),
        color: [0.3, 0.3, 0.4],
        ..Light::default()
    });
    scene.objects.push(Object::new("test", Arc::new(profile)));
    scene
}

/// All shapes in a circle, turned and stretched, some within others.
#[allow(dead_code)] // each crate of tests takes what it needs
pub fn circle_of_shapes(all: impl IntoIterator<Item = (&'static str, Profile)>) -> Scene {
    let camera = Camera::new(DVec3::new(2.6, 1.9, 1.7), DVec3::new(0.0, 0.0, 0.3));
    let mut scene = Scene::new(camera);
    for (n, (name, profile)) in all.into_iter().enumerate() {
        let turn = n as f64 * 0.8;
        let at = [0.45 * turn.cos(), 0.45 * turn.sin(), 0.1 * turn];
        let mut object = Object::new(name, Arc::new(profile));
        object.placement = placement(at, [0.2 * turn, 0.1, turn], [0.8, 1.1, 0.7]);
        scene.objects.push(object);
    }
    scene
}

/// The position of a camera that looks at the middle of a box of height 1 from `distance`,
/// `elevation` degrees up.
pub fn eye(elevation: f64, distance: f64) -> DVec3 {
    let (s, c) = elevation.to_radians().sin_cos();
    DVec3::new(0.93 * c, 0.37 * c, s) * distance + DVec3::new(0.0, 0.0, 0.5)
}

pub fn placement(position: [f64; 3], euler: [f64; 3], scale: [f64; 3]) -> Placement {
    Placement {
        position: position.into(),
        rotation: DQuat::from_euler(EulerRot::XYZ, euler[0], euler[1], euler[2]),
        scale: scale.into(),
    }
}

/// A map of colours by column and row.
#[allow(dead_code)] // each crate of tests takes what it needs
pub fn color_map(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Arc<ColorMap> {
    let texels = (0..width * height).map(|n| texel(n % width, n / width));
    Arc::new(ColorMap::from_texels(width, height, texels.collect()).unwrap())
}

/// The slopes of a square of heights, by column and row.
#[allow(dead_code)] // each crate of tests takes what it needs
pub fn slope_map(side: u32, height: impl Fn(u32, u32) -> f32) -> Arc<DisplacementMap> {
    let heights: Vec<f32> = (0..side * side)
        .map(|n| height(n % side, n / side))
        .collect();
    let map = DisplacementMap::from_heights(side, side, &heights, SlopeFilter::Scharr);
    Arc::new(map.unwrap())
}
