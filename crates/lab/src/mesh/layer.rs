//! A scene drawn as meshes in an off-screen frame.

use super::blocks::FrameBlock;
use super::drawer::{DrawnPass, MeshDrawer, MeshPipelines};
use super::placed::SceneMeshes;
use crate::method::{Method, MethodSettings};
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Guest, Offscreen, View};
use revmap::scene::{CameraFrame, Scene};
use revmap::settings::DrawStage;
use std::sync::Arc;

/// The meshes of a scene on a device, a guest of an [`Offscreen`] for guests.
pub(crate) struct MeshLayer {
    drawer: MeshDrawer,
    meshes: SceneMeshes,
    size: (u32, u32),
}

impl MeshLayer {
    /// No meshes yet, for the pass of `offscreen`, which has so many samples.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a search, for a mesh that [`Method::mesh`] refuses, and for the
    /// compute stage; of Vulkan.
    pub fn new(
        pipelines: &Arc<MeshPipelines>,
        offscreen: &Offscreen,
        settings: &MethodSettings,
        samples: u32,
    ) -> Result<Self> {
        let method = settings.method;
        let refused = |why| Err(Error::new(ErrorKind::Usage, why).at_key("solver"));
        let levels = match method {
            Method::Mesh { segments, rings } => {
                // Settings are plain values: the numbers may not have come through the check.
                Method::mesh(segments, rings)?;
                vec![(segments, rings, 0.0)]
            }
            Method::MeshLevels => Method::MESH_LEVELS.to_vec(),
            Method::Search(_) | Method::Floor => {
                return refused(format!("{method} is no mesh; give a mesh as mesh:64x128"));
            }
        };
        if settings.stage == DrawStage::Compute {
            return refused(format!(
                "{method} is rasterised, which a compute shader does not; give the stage fragment"
            ));
        }
        let pass = DrawnPass {
            raw: offscreen.render_pass(),
            samples: vk::SampleCountFlags::from_raw(samples),
            planes: settings.planes,
        };
        let size = (settings.width, settings.height);
        Ok(Self {
            drawer: MeshDrawer::new(pipelines, pass)?,
            meshes: SceneMeshes::new(levels, size),
            size,
        })
    }

    /// Takes over a scene. Meshes are made anew where a profile or an offset differs. `view` is
    /// called once it is sure that meshes draw the scene.
    ///
    /// # Errors
    /// Of the scene, of what meshes do not draw, of profiles; of `view`; of Vulkan.
    pub fn update(&mut self, scene: &Scene, view: impl FnOnce() -> Result<View>) -> Result<()> {
        scene.check()?;
        let camera = CameraFrame::new(&scene.camera, self.size.0, self.size.1)?;
        let placed = self.meshes.place(scene, &camera)?;
        let lighting = scene.lighting();
        let frame = FrameBlock::new(&view()?, &camera, &lighting);
        self.drawer.update(&frame, lighting.lights.len(), &placed)
    }

    /// What is drawn in a pass.
    pub fn guest(&self) -> &dyn Guest {
        &self.drawer
    }

    /// Drops what meshes were copied from, once a frame was drawn.
    pub fn drop_staging(&mut self) {
        self.drawer.drop_staging();
    }

    /// How many meshes were made so far.
    pub fn made_count(&self) -> u64 {
        self.meshes.made_count
    }

    /// Bytes of vertices and indices on the device.
    pub fn bytes(&self) -> u64 {
        self.drawer.mesh_bytes()
    }
}
