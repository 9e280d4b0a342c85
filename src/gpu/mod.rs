//! Drawing on a Vulkan device. The only module with `unsafe`.
//!
//! A [`Device`] is opened, or borrowed from a host. On it a [`Renderer`] holds objects and records
//! them into any command buffer; [`Offscreen`] does so for a whole scene, submits, waits and reads
//! the frame back.
#![allow(unsafe_code)]

mod arena;
mod bins;
mod block;
pub(crate) mod blocks;
mod buffers;
mod call;
mod choose_levels;
mod clock;
mod commands;
mod compiler;
mod costs;
mod device;
mod entry;
mod frame_plan;
mod frame_slot;
mod hulls;
mod instance;
mod kept;
mod levels;
mod map_key;
mod memory;
mod memory_budget;
mod messages;
mod objects;
mod offscreen;
mod offset_surface;
mod outlined;
mod output;
mod pipelines;
mod plan;
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
mod solid;
mod srgb;
mod table_slot;
mod tables;
mod target;
mod textures;
mod uploads;
mod usage;
mod view;

pub use compiler::{CompiledShader, compiled_shaders};
pub use costs::{INSTANCE_BYTES, ObjectCost};
pub use device::{Device, HostDevice};
pub use entry::ObjectId;
pub use instance::VALIDATION_VARIABLE;
pub use memory::Buffer;
pub use offscreen::{Guest, Offscreen, Times};
pub use output::{DepthOrder, Output, PassFormats, PassKind};
#[cfg(feature = "other-shaders")]
pub use pipelines::ShaderSource;
pub use plan::DrawPath;
pub use prewarm::Prewarm;
pub use renderer::Renderer;
pub use report::{DEVICE_VARIABLE, DeviceReport, devices};
pub use requirements::Requirements;
pub use target::ComputeTarget;
pub use view::{View, Viewport};

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
