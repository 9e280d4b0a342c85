//! Drawing on a Vulkan device. The only module with `unsafe`.
//!
//! A [`Device`] is opened, or borrowed from a host. A [`Renderer`] on a device holds objects and
//! records them into any command buffer. [`Offscreen`] does so for a whole scene, submits, waits
//! and reads the frame back.
//!
//! Modules import from those before them: `vk` (raw handles), `device`, `memory`, `resources`,
//! `content` (objects and the plan of a view), `renderer`, `offscreen`.
#![allow(unsafe_code)]

#[cfg(feature = "other-shaders")]
#[doc(hidden)]
pub mod compiler;
mod content;
mod device;
mod memory;
mod offscreen;
mod open;
mod renderer;
mod resources;
pub(crate) mod vk;

pub use crate::plan::{DepthOrder, DrawPath, View, Viewport};
pub use content::objects::ObjectId;
pub use device::budget::MemoryUse;
pub use device::instance::VALIDATION_VARIABLE;
pub use device::report::{DEVICE_VARIABLE, DeviceReport, devices};
pub use memory::Buffer;
pub use offscreen::{Guest, Offscreen, OffscreenOptions, Times};
pub use open::{Device, HostDevice, Requirements};
pub use renderer::Renderer;
pub use renderer::costs::{INSTANCE_BYTES, ObjectCost};
pub use renderer::prepare::{FrameStatistics, PreparedFrame};
pub use renderer::prewarm::Prewarm;
pub use resources::textures::HostImage;
pub use vk::call::{allocation_error, vulkan_error};
pub use vk::output::{
    ComputeTarget, DepthTest, HostShading, Output, PassFormats, PassKind, SlopeBias,
};
#[cfg(feature = "other-shaders")]
pub use vk::pipelines::ShaderSource;

use crate::error::Result;
use crate::frame::Frame;
use crate::scene::Scene;
use crate::settings::Settings;

/// A drawn frame and its cost.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture.
    pub frame: Frame,
    /// The times of a second frame; the first frame waits for the driver's compiler.
    pub times: Times,
    /// [`Renderer::map_bytes`].
    pub map_bytes: [u64; 2],
    /// [`Renderer::notes`].
    pub notes: Vec<String>,
    /// [`Renderer::draw_paths`].
    pub draw_paths: Vec<DrawPath>,
}

/// Draws a scene once: bakes its maps, uploads, draws, reads back.
///
/// # Errors
/// Errors of any stage.
pub fn draw(device: &Device, scene: &Scene, settings: &Settings) -> Result<Drawn> {
    let mut offscreen = Offscreen::new(device, scene, settings)?;
    offscreen.draw()?;
    let times = offscreen.draw()?;
    let drawn = Drawn {
        frame: offscreen.read()?,
        times,
        map_bytes: offscreen.map_bytes(),
        notes: offscreen.notes().to_vec(),
        draw_paths: offscreen.draw_paths(),
    };
    drop(offscreen);
    device.check()?;
    Ok(drawn)
}
