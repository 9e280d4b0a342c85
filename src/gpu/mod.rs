//! Drawing on a Vulkan device. The only module with `unsafe`.
//!
//! A [`Device`] is opened, or borrowed from a host. A [`Renderer`] on a device holds objects and
//! records them into any command buffer.
//!
//! Modules import from those before them: `vk` (raw handles), `device`, `memory`, `resources`,
//! `content` (objects and the plan of a view), `renderer`.
#![allow(unsafe_code)]

#[cfg(feature = "other-shaders")]
#[doc(hidden)]
pub mod compiler;
mod content;
mod device;
mod memory;
mod open;
mod renderer;
mod resources;
pub(crate) mod vk;

pub use crate::plan::{DepthOrder, DrawPath, OpenPixels, View, Viewport};
pub use content::objects::ObjectId;
pub use device::budget::MemoryUse;
pub use device::instance::VALIDATION_VARIABLE;
pub use device::report::{DEVICE_VARIABLE, DeviceReport, devices};
#[doc(hidden)]
pub use memory::{Buffer, Image, ImageKind};
pub use open::{Device, HostDevice, Requirements};
pub use renderer::Renderer;
pub use renderer::costs::{INSTANCE_BYTES, ObjectCost};
pub use renderer::prepare::PreparedFrame;
pub use renderer::prewarm::Prewarm;
pub use renderer::statistics::FrameStatistics;
pub use resources::textures::HostImage;
#[doc(hidden)]
pub use vk::call::allocation_error;
pub use vk::call::vulkan_error;
pub use vk::output::{
    ComputeTarget, DepthTest, HostPass, HostShading, Output, PassFormats, PassKind, SlopeBias,
};
#[cfg(feature = "other-shaders")]
pub use vk::pipelines::ShaderSource;
