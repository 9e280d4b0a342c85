//! Drawing on one validated device, and in the reference.

use revmap::frame::Frame;
use revmap::gpu::{self, Device, Offscreen};
use revmap::scene::Scene;
use revmap::settings::Settings;
use std::sync::OnceLock;

/// The device of this process's tests. Tests fail without a device or without the layers.
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
