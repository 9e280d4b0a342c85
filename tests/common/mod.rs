//! What GPU tests share: one validated device, scenes, and drawing with any message of the layers a
//! failure.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod host;
pub mod passing;
pub mod shapes;
pub mod ways;

use glam::{DQuat, DVec3, EulerRot};
use revmap::frame::Frame;
use revmap::gpu::{self, Device};
use revmap::profile::Profile;
use revmap::scene::{Camera, Light, Object, Placement, Scene};
use revmap::settings::Settings;
use revmap_lab::compare::{CompareOptions, Comparison, compare};
use std::sync::{Arc, OnceLock};

/// The device of this process's tests. Without a device or without the layers, tests fail.
pub fn device() -> &'static Device {
    static DEVICE: OnceLock<Device> = OnceLock::new();
    DEVICE.get_or_init(|| Device::open_validated(None).unwrap())
}

/// Draws in a GPU stage.
pub fn draw(scene: &Scene, settings: &Settings) -> Frame {
    gpu::draw(device(), scene, settings)
        .unwrap_or_else(|e| panic!("{e}"))
        .frame
}

/// Draws the reference.
pub fn reference(scene: &Scene, settings: &Settings) -> Frame {
    revmap_reference::draw(scene, settings, &|_, _| {}).unwrap()
}

/// How far a frame is from the truth, FLIP aside; depths in texels of a map of so many rows.
pub fn errors(truth: &Frame, frame: &Frame, rows: u32) -> Comparison {
    let options = CompareOptions {
        texel: 1.0 / f64::from(rows),
        pixels_per_degree: None,
    };
    compare(truth, frame, &options).unwrap()
}

/// One object of a polygon, seen from `eye`.
pub fn scene_of(profile: Profile, eye: DVec3) -> Scene {
    let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.0, 0.0, 0.5)));
    scene.lights.push(Light {
        direction: DVec3::new(0.7, 0.5, -0.2),
        color: [0.3, 0.3, 0.4],
    });
    scene.objects.push(Object::new("test", Arc::new(profile)));
    scene
}

/// Where a camera stands that looks at the middle of a box of height 1 from `distance`, `elevation`
/// degrees up.
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

/// No NaN in any channel, and no infinity but the distance of what is not hit.
pub fn assert_sound(frame: &Frame, what: &str) {
    for i in 0..frame.pixels() {
        let values = frame.pixel(i);
        let names = revmap::frame::CHANNELS;
        for (name, value) in names.iter().zip(values) {
            let fine = value.is_finite() || (*name == "Z" && value == f32::INFINITY);
            assert!(fine, "{what}: {name} of pixel {i} is {value}");
        }
    }
}
