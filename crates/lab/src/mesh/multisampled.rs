//! Pictures of four samples a pixel (MSAA): a mesh, or the default search as in a host's pass.

use super::drawer::{MeshPipelines, MultisampledTarget, SearchGuest, Within};
use super::offscreen::MeshOffscreen;
use crate::method::MethodSettings;
use ash::vk;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::{Guest, Offscreen, Times};
use revmap::scene::Scene;
use revmap::settings::{Planes, Settings};
use std::sync::Arc;

/// A scene and a multisampled picture of its colours. Of all planes these are floats, which can be
/// read.
pub struct Multisampled {
    guest: Drawn,
    target: MultisampledTarget,
    /// What submits: a frame of one pixel, drawn besides.
    submits: Offscreen,
    settings: MethodSettings,
}

enum Drawn {
    Mesh(Box<MeshOffscreen>),
    Search(Box<SearchGuest>),
}

impl Multisampled {
    /// Takes over the scene, in the fragment stage.
    ///
    /// # Errors
    /// As [`Offscreen::new`] and [`MeshOffscreen::new`].
    pub fn new(
        pipelines: &Arc<MeshPipelines>,
        scene: &Scene,
        settings: &MethodSettings,
    ) -> Result<Self> {
        let format = match settings.planes {
            Planes::All => vk::Format::R32G32B32A32_SFLOAT,
            _ => vk::Format::R8G8B8A8_SRGB,
        };
        let colors = MethodSettings {
            planes: Planes::Color,
            ..*settings
        };
        let size = (settings.width, settings.height);
        let target = MultisampledTarget::new(pipelines, format, size, scene.background)?;
        let pixel = Settings {
            width: 1,
            height: 1,
            ..Settings::from(&colors)
        };
        let guest = if settings.method.is_mesh() {
            let pass = Some(target.pass);
            let mesh = MeshOffscreen::for_pass(pipelines, scene, &colors, pass)?;
            Drawn::Mesh(Box::new(mesh))
        } else {
            let search = SearchGuest::new(pipelines, target.pass, scene, &colors)?;
            Drawn::Search(Box::new(search))
        };
        Ok(Self {
            guest,
            target,
            submits: Offscreen::for_guests(pipelines.device(), scene, &pixel)?,
            settings: *settings,
        })
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn draw(&mut self) -> Result<Times> {
        let guest: &dyn Guest = match &self.guest {
            Drawn::Mesh(mesh) => mesh.guest(),
            Drawn::Search(search) => search.as_ref(),
        };
        let target = &self.target;
        let times = self.submits.draw_with(Some(&Within { guest, target }))?;
        match &mut self.guest {
            Drawn::Mesh(mesh) => mesh.drop_staging(),
            Drawn::Search(search) => search.take_error()?,
        }
        Ok(times)
    }

    /// Draws one frame, whose planes are all, and reads its colours.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn picture(&mut self) -> Result<Frame> {
        self.target.copies.set(true);
        self.draw()?;
        self.target.copies.set(false);
        let MethodSettings { width, height, .. } = self.settings;
        let mut frame = Frame::new(width, height, self.target.background)?;
        let (colors, _) = self.target.bytes()?.as_chunks::<16>();
        for (color, bytes) in frame.color.iter_mut().zip(colors) {
            *color = bytemuck::pod_read_unaligned(bytes);
        }
        Ok(frame)
    }
}
