//! Scenes of one solid, and the errors of their pictures.

pub use super::shapes::offset;
use glam::{DQuat, DVec3, EulerRot};
use revmap::frame::Frame;
use revmap::profile::Profile;
use revmap::scene::{Camera, Light, Object, Placement, Scene};
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_lab::compare::{CompareOptions, Comparison, compare};
use std::sync::Arc;

/// Errors of a frame without FLIP; depths in texels of a map of `rows` rows.
pub fn errors(truth: &Frame, frame: &Frame, rows: u32) -> Comparison {
    let options = CompareOptions {
        texel: 1.0 / f64::from(rows),
        pixels_per_degree: None,
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

/// The position of a camera that looks at the middle of a box of height 1 from `distance`,
/// `elevation` degrees up.
pub fn eye(elevation: f64, distance: f64) -> DVec3 {
    let (s, c) = elevation.to_radians().sin_cos();
    DVec3::new(0.93 * c, 0.37 * c, s) * distance + DVec3::new(0.0, 0.0, 0.5)
}

/// Exact settings of a picture of this size.
pub fn sized(width: u32, height: u32) -> Settings {
    Settings {
        width,
        height,
        ..Settings::exact()
    }
}

/// Exact settings of a picture of this size, drawn in a stage by a search.
pub fn drawn_by((width, height): (u32, u32), stage: DrawStage, solver: Solver) -> Settings {
    Settings {
        stage,
        solver,
        ..sized(width, height)
    }
}

/// The same settings in compute.
pub fn in_compute(settings: Settings) -> Settings {
    Settings {
        stage: DrawStage::Compute,
        ..settings
    }
}

/// The same settings without cells, which change where rays start, and without culling, after which
/// tiles count no steps.
pub fn from_boxes(settings: Settings) -> Settings {
    Settings {
        proxy_min_pixels: u32::MAX,
        occlusion_culling: false,
        ..settings
    }
}

/// The number of pixels with a hit.
pub fn hits(frame: &Frame) -> usize {
    (0..frame.pixels()).filter(|&i| frame.hits(i)).count()
}

pub fn placement(position: [f64; 3], euler: [f64; 3], scale: [f64; 3]) -> Placement {
    Placement {
        position: position.into(),
        rotation: DQuat::from_euler(EulerRot::XYZ, euler[0], euler[1], euler[2]),
        scale: scale.into(),
    }
}
