//! A scene drawn as meshes in an off-screen frame.

use super::blocks::FrameBlock;
use super::drawer::{DrawnPass, MeshDrawer, MeshPipelines, SAMPLES};
use super::placed::SceneMeshes;
use crate::method::{Method, MethodSettings};
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::{Guest, Offscreen, Times};
use revmap::scene::{CameraFrame, Scene};
use revmap::settings::{DrawStage, Settings};
use std::sync::Arc;

/// A scene as meshes on a device, and a picture of it: what [`Offscreen`] is for searches.
pub struct MeshOffscreen {
    drawer: MeshDrawer,
    offscreen: Offscreen,
    meshes: SceneMeshes,
    size: (u32, u32),
}

impl MeshOffscreen {
    /// Tessellates the scene's objects and makes a target of the settings' size.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a search, for a mesh that [`Method::mesh`] refuses, and for the
    /// compute stage; of the scene, of profiles, and of Vulkan as [`Offscreen::new`].
    pub fn new(
        pipelines: &Arc<MeshPipelines>,
        scene: &Scene,
        settings: &MethodSettings,
    ) -> Result<Self> {
        Self::for_pass(pipelines, scene, settings, None)
    }

    /// The same; with a multisampled pass another frame draws it there as a guest.
    pub(super) fn for_pass(
        pipelines: &Arc<MeshPipelines>,
        scene: &Scene,
        settings: &MethodSettings,
        multisampled: Option<vk::RenderPass>,
    ) -> Result<Self> {
        let method = settings.method;
        let levels = match method {
            Method::Mesh { segments, rings } => {
                // Settings are plain values: the numbers may not have come through the check.
                Method::mesh(segments, rings)?;
                vec![(segments, rings, 0.0)]
            }
            Method::MeshLevels => Method::MESH_LEVELS.to_vec(),
            Method::Search(_) | Method::Floor => {
                let message = format!("{method} is no mesh; give a mesh as mesh:64x128");
                return Err(Error::new(ErrorKind::Usage, message).at_key("solver"));
            }
        };
        if settings.stage == DrawStage::Compute {
            let message = format!(
                "{method} is rasterised, which a compute shader does not; give the stage fragment"
            );
            return Err(Error::new(ErrorKind::Usage, message).at_key("solver"));
        }
        let own = Settings::from(settings);
        let offscreen = Offscreen::for_guests(pipelines.device(), scene, &own)?;
        let pass = DrawnPass {
            raw: multisampled.unwrap_or(offscreen.render_pass()),
            samples: multisampled.map_or(vk::SampleCountFlags::TYPE_1, |_| SAMPLES),
            planes: settings.planes,
        };
        let mut all = Self {
            drawer: MeshDrawer::new(pipelines, pass)?,
            offscreen,
            meshes: SceneMeshes::new(levels, (settings.width, settings.height)),
            size: (settings.width, settings.height),
        };
        all.update(scene)?;
        Ok(all)
    }

    /// Takes over a scene. Meshes are made anew where a profile or an offset differs.
    ///
    /// # Errors
    /// As [`MeshOffscreen::new`]. After those of the scene and of profiles, the frame before can
    /// still be drawn.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        scene.check()?;
        let camera = CameraFrame::new(&scene.camera, self.size.0, self.size.1)?;
        let placed = self.meshes.place(scene, &camera)?;
        self.offscreen.update(scene)?;
        let lighting = scene.lighting();
        let frame = FrameBlock::new(self.offscreen.view(), &camera, &lighting);
        self.drawer.update(&frame, lighting.lights.len(), &placed)
    }

    /// What is drawn in a pass.
    pub(super) fn guest(&self) -> &dyn Guest {
        &self.drawer
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn draw(&mut self) -> Result<Times> {
        let times = self.offscreen.draw_with(Some(&self.drawer))?;
        self.drop_staging();
        Ok(times)
    }

    /// Drops what meshes were copied from, once a frame was drawn.
    pub(super) fn drop_staging(&mut self) {
        self.drawer.drop_staging();
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn read(&mut self) -> Result<Frame> {
        self.offscreen.read()
    }

    /// How many meshes were made so far.
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        self.meshes.made_count()
    }

    /// Bytes of vertices and indices on the device.
    #[must_use]
    pub fn mesh_bytes(&self) -> u64 {
        self.drawer.mesh_bytes()
    }
}
