//! A renderer with the shown scene.

use super::frames::FRAMES;
use super::screen::DEPTH;
use ash::vk;
use revmap::error::Result;
use revmap::gpu::{DepthOrder, Device, ObjectId, Output, PassFormats, PassKind, Renderer};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings};

/// A scene's objects in a renderer.
pub struct SceneRenderer {
    pub renderer: Renderer,
    ids: Vec<ObjectId>,
    /// The stage and settings of the renderer.
    pub by: (DrawStage, SearchSettings),
}

impl SceneRenderer {
    /// A renderer without objects, for pictures of this format.
    pub fn new(
        device: &Device,
        format: vk::Format,
        by: (DrawStage, SearchSettings),
    ) -> Result<Self> {
        let output = match by.0 {
            DrawStage::Compute => Output::Compute(Planes::Color),
            _ => Output::Pass(PassFormats {
                begun: PassKind::Dynamic {
                    color: vec![format],
                    depth: DEPTH,
                    stencil: vk::Format::UNDEFINED,
                },
                samples: 1,
                depth: DepthOrder::Normal,
                planes: Planes::Color,
            }),
        };
        Ok(Self {
            renderer: Renderer::new(device, output, &by.1, FRAMES)?,
            ids: Vec::new(),
            by,
        })
    }

    /// Updates the renderer to a scene's lights and objects. A failing part leaves the rest
    /// unchanged.
    pub fn set(&mut self, scene: &Scene) -> Result<()> {
        self.renderer.set_lighting(&scene.lighting())?;
        let objects = &scene.objects;
        while self.ids.len() > objects.len() {
            if let Some(id) = self.ids.pop() {
                self.renderer.remove(id)?;
            }
        }
        for (n, object) in objects.iter().enumerate() {
            match self.ids.get(n) {
                Some(&id) => self.renderer.set(id, object.clone())?,
                None => self.ids.push(self.renderer.add(object.clone())?),
            }
        }
        Ok(())
    }
}
