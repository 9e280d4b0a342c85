//! Drawing on a Vulkan device. The only module with `unsafe`.
//!
//! A [`Device`] is opened, or borrowed from a host. On it a [`Renderer`] holds objects and records
//! them into any command buffer; [`Offscreen`] does so for a whole scene, submits, waits and reads
//! the frame back.
#![allow(unsafe_code)]

mod arena;
mod block;
pub(crate) mod blocks;
mod buffers;
mod call;
mod clock;
mod commands;
#[cfg(feature = "other-shaders")]
#[doc(hidden)]
pub mod compiler;
mod costs;
pub(crate) mod descriptors;
mod device;
mod entry;
mod frame_slot;
mod geometry;
mod instance;
mod kept;
mod map_key;
mod memory;
mod memory_budget;
mod messages;
mod object_id;
mod objects;
mod offscreen;
pub(crate) mod offset_surface;
pub(crate) mod outline_cache;
mod output;
mod pipelines;
mod planned;
mod prepare;
mod prewarm;
mod proxy_hull;
mod reach;
mod read_back;
mod record;
mod refresh;
mod render_pass;
mod renderer;
mod report;
mod requirements;
mod sampler;
mod shape_texture;
pub(crate) mod solid;
mod srgb;
mod table_slot;
mod tables;
mod target;
mod textures;
mod uploads;
mod usage;

pub use crate::plan::{DepthOrder, DrawPath, View, Viewport};
pub use call::{allocation_error, vulkan_error};
pub use costs::{INSTANCE_BYTES, ObjectCost};
pub use device::{Device, HostDevice};
pub use instance::VALIDATION_VARIABLE;
pub use memory::Buffer;
pub use memory_budget::MemoryUse;
pub use object_id::ObjectId;
pub use offscreen::{Guest, Offscreen, Times};
pub use output::{Output, PassFormats, PassKind};
#[cfg(feature = "other-shaders")]
pub use pipelines::ShaderSource;
pub use prepare::PreparedFrame;
pub use prewarm::Prewarm;
pub use renderer::Renderer;
pub use report::{DEVICE_VARIABLE, DeviceReport, devices};
pub use requirements::Requirements;
pub use target::ComputeTarget;

use crate::error::Result;
use crate::frame::Frame;
use crate::scene::Scene;
use crate::settings::Settings;

/// A drawn frame and what it cost.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture.
    pub frame: Frame,
    /// What drawing it took, of a second frame: the first waits for the driver's compiler.
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
/// Any stage's.
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
