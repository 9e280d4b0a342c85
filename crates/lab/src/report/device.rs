//! The real thing: measuring on a Vulkan device, against the double-precision reference.

use super::measure::{Bench, TimedRenderer};
use super::row::Sample;
use super::view::View;
use crate::method::MethodSettings;
use crate::renderer::{MethodDevice, MethodRenderer};
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap_reference as reference;

/// A Vulkan device to measure on.
pub struct DeviceBench {
    device: MethodDevice,
}

impl DeviceBench {
    /// Measures on this device.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn new(device: Device) -> Result<Self> {
        let device = MethodDevice::new(device)?;
        Ok(Self { device })
    }
}

struct Ready(MethodRenderer);

impl TimedRenderer for Ready {
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
    fn timed_renderer(
        &mut self,
        view: &View,
        settings: &MethodSettings,
    ) -> Result<Box<dyn TimedRenderer>> {
        let renderer = self.device.renderer(&view.scene, settings)?;
        Ok(Box::new(Ready(renderer)))
    }

    fn picture(&mut self, view: &View, settings: &MethodSettings) -> Result<(Frame, u64)> {
        let mut renderer = self.device.renderer(&view.scene, settings)?;
        renderer.draw()?;
        Ok((renderer.read()?, renderer.map_bytes().iter().sum()))
    }

    fn truth(&mut self, view: &View, settings: &MethodSettings) -> Result<Frame> {
        reference::draw(&view.scene, &settings.into(), &|_, _| {})
    }
}
