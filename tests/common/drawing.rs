//! Drawing on one validated device, and in the reference, and settings for it.

use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_offscreen::Offscreen;
use std::sync::OnceLock;

/// The device of this process's tests. Tests fail without a device or without the layers.
pub fn device() -> &'static Device {
    static DEVICE: OnceLock<Device> = OnceLock::new();
    DEVICE.get_or_init(|| Device::open_validated(None).unwrap())
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

/// The same settings without cells and lists of patches, which change where rays start.
pub fn from_boxes(settings: Settings) -> Settings {
    Settings {
        proxy_min_pixels: u32::MAX,
        ..settings
    }
}

/// The number of pixels with a hit.
pub fn hits(frame: &Frame) -> usize {
    (0..frame.pixels()).filter(|&i| frame.hits(i)).count()
}

/// Draws in a GPU stage.
pub fn draw(scene: &Scene, settings: &Settings) -> Frame {
    revmap_offscreen::draw(device(), scene, settings)
        .unwrap_or_else(|e| panic!("{e}"))
        .frame
}

/// The next frame of a renderer.
pub fn next_frame(renderer: &mut Offscreen) -> Frame {
    renderer.draw().unwrap();
    renderer.read().unwrap()
}

/// The first frame of a renderer for this scene, after an update to it.
pub fn updated(renderer: &mut Offscreen, scene: &Scene) -> Frame {
    renderer.update(scene).unwrap();
    next_frame(renderer)
}

/// Draws the reference.
pub fn reference(scene: &Scene, settings: &Settings) -> Frame {
    revmap_reference::draw(scene, settings, &|_, _| {}).unwrap()
}

/// Asserts that no channel has a NaN, and that only the distance of background pixels is infinite.
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
