//! Drawing on a Vulkan device. The only module with `unsafe`, next to the C ABI.
//!
//! A [`Device`] is opened once; a [`Renderer`] holds a scene's maps, blocks and pipelines on it, for one stage and size;
//! [`Renderer::update`] takes over changed parameters, [`Renderer::draw`] draws, [`Renderer::read`] fetches the frame.
#![allow(unsafe_code)]

mod batch;
mod bins;
pub mod blocks;
mod buffers;
mod call;
mod clock;
mod commands;
mod compute_work;
mod contours;
mod cuts;
mod descriptors;
mod device;
mod hulls;
mod instance;
mod memory;
mod meshes;
mod messages;
mod parts;
mod pipelines;
mod read_back;
mod record;
mod render_pass;
mod renderer;
mod report;
mod searches;
mod srgb;
mod tables;
mod target;
mod textures;
mod update;
mod usage;
mod work;

pub use device::Device;
pub use instance::VALIDATION_VARIABLE;
pub use renderer::{Renderer, Times};
pub use report::{DEVICE_VARIABLE, DeviceReport, devices};
pub use work::Way;

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
    /// Bytes on the device: of shape maps, of colour and displacement maps.
    pub map_bytes: [u64; 2],
    /// [`Renderer::notes`].
    pub notes: Vec<String>,
    /// [`Renderer::ways`].
    pub ways: Vec<Way>,
}

/// Draws a scene once: bakes its maps, uploads, draws, reads back.
///
/// # Errors
/// Any stage's.
pub fn draw(device: &Device, scene: &Scene, settings: &Settings) -> Result<Drawn> {
    let mut renderer = Renderer::new(device, scene, settings)?;
    renderer.draw()?;
    let times = renderer.draw()?;
    let drawn = Drawn {
        frame: renderer.read()?,
        times,
        map_bytes: renderer.map_bytes(),
        notes: renderer.notes().to_vec(),
        ways: renderer.ways(),
    };
    drop(renderer);
    device.check()?;
    Ok(drawn)
}
