//! The real thing: measuring on a Vulkan device, against the double-precision reference.

use super::measure::{Bench, Sample, Subject};
use super::view::View;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::{Device, Renderer};
use revmap::settings::Settings;
use revmap_reference as reference;

/// A Vulkan device to measure on.
pub struct DeviceBench {
    device: Device,
}

impl DeviceBench {
    /// Measures on this device.
    #[must_use]
    pub fn new(device: Device) -> Self {
        Self { device }
    }
}

struct Ready(Renderer);

impl Subject for Ready {
    fn sample(&mut self) -> Result<Sample> {
        // One stage per submission: timestamps around both in one lie on some drivers.
        let times = self.0.draw()?;
        Ok(Sample {
            gpu_ms: times.gpu_ms,
            frame_ms: times.frame_ms,
        })
    }
}

impl Bench for DeviceBench {
    fn subject(&mut self, view: &View, settings: &Settings) -> Result<Box<dyn Subject>> {
        Ok(Box::new(Ready(Renderer::new(
            &self.device,
            &view.scene,
            settings,
        )?)))
    }

    fn picture(&mut self, view: &View, settings: &Settings) -> Result<(Frame, u64)> {
        let mut renderer = Renderer::new(&self.device, &view.scene, settings)?;
        renderer.draw()?;
        Ok((renderer.read()?, renderer.map_bytes().iter().sum()))
    }

    fn truth(&mut self, view: &View, settings: &Settings) -> Result<Frame> {
        reference::draw(&view.scene, settings, &|_, _| {})
    }
}
