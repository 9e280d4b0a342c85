//! Scenes drawn without a host: [`Offscreen`] makes a target, submits, waits and reads frames back.
//! [`antialias`] smooths the silhouettes of such a frame, [`samples`] takes several rays per pixel.
//!
//! The crate is a client of [`revmap::gpu`] and uses its public interface alone.
//!
//! ```no_run
//! use glam::DVec3;
//! use revmap::{gpu::Device, profile::Profile, scene::{Camera, Object, Scene}, settings::Settings};
//! use std::sync::Arc;
//!
//! let spindle = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5)?;
//! let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 0.5)));
//! scene.objects.push(Object::new("spindle", Arc::new(spindle)));
//!
//! let drawn = revmap_offscreen::draw(&Device::open(None)?, &scene, &Settings::default())?;
//! revmap_files::write_png(&drawn.frame, "spindle.png")?;
//! # Ok::<(), revmap::Error>(())
//! ```

pub mod adaptive;
pub mod antialias;
mod bands;
#[allow(unsafe_code)]
mod commands;
#[allow(unsafe_code)]
mod draw;
#[allow(unsafe_code)]
mod offscreen;
mod read_back;
pub mod samples;
#[allow(unsafe_code)]
mod target;

pub use commands::Times;
pub use draw::Guest;
pub use offscreen::{Offscreen, OffscreenOptions};

use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::{Device, DrawPath};
use revmap::scene::Scene;
use revmap::settings::Settings;

/// A drawn frame and its cost.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The picture.
    pub frame: Frame,
    /// The times of a second frame; the first frame waits for the driver's compiler.
    pub times: Times,
    /// [`Renderer::map_bytes`](revmap::gpu::Renderer::map_bytes).
    pub map_bytes: [u64; 2],
    /// [`Renderer::notes`](revmap::gpu::Renderer::notes).
    pub notes: Vec<String>,
    /// [`Renderer::draw_paths`](revmap::gpu::Renderer::draw_paths).
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
    let renderer = offscreen.renderer();
    let drawn = Drawn {
        map_bytes: renderer.map_bytes(),
        notes: renderer.notes().to_vec(),
        draw_paths: renderer.draw_paths(),
        times,
        frame: offscreen.read()?,
    };
    drop(offscreen);
    device.check()?;
    Ok(drawn)
}
