//! The renderers of one picture, for every way to draw it.

use super::{MESH, Way};
use crate::mesh::Multisampled;
use crate::method::MethodSettings;
use crate::renderer::{MethodDevice, MethodRenderer};
use crate::samples::averaged;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes};
use std::time::Instant;

/// The renderers of one scene, planes and stage.
pub struct Drawers<'a> {
    scene: &'a Scene,
    plain: MethodRenderer,
    smoothed: MethodRenderer,
    /// In the fragment stage.
    rasterised: Option<Rasterised>,
}

struct Rasterised {
    mesh: MethodRenderer,
    /// Of the default search and of the mesh.
    multisampled: [Multisampled; 2],
}

impl<'a> Drawers<'a> {
    pub fn new(
        device: &MethodDevice,
        scene: &'a Scene,
        stage: DrawStage,
        planes: Planes,
    ) -> Result<Self> {
        let plain = MethodSettings {
            stage,
            planes,
            ..MethodSettings::default()
        };
        let smoothed = MethodSettings {
            antialias: true,
            ..plain
        };
        let mesh = MethodSettings {
            method: MESH,
            ..plain
        };
        let rasterised = || -> Result<_> {
            let multisampled = |settings| device.multisampled(scene, settings);
            Ok(Rasterised {
                mesh: device.renderer(scene, &mesh)?,
                multisampled: [multisampled(&plain)?, multisampled(&mesh)?],
            })
        };
        Ok(Self {
            scene,
            plain: device.renderer(scene, &plain)?,
            smoothed: device.renderer(scene, &smoothed)?,
            rasterised: match stage {
                DrawStage::Compute => None,
                _ => Some(rasterised()?),
            },
        })
    }

    fn multisampled(&mut self, way: Way) -> Option<&mut Multisampled> {
        let [search, mesh] = &mut self.rasterised.as_mut()?.multisampled;
        match way {
            Way::Msaa => Some(search),
            Way::MeshMsaa => Some(mesh),
            _ => None,
        }
    }

    fn renderer(&mut self, way: Way) -> &mut MethodRenderer {
        match (way, &mut self.rasterised) {
            (Way::Mesh, Some(rasterised)) => &mut rasterised.mesh,
            (Way::Silhouettes, _) => &mut self.smoothed,
            _ => &mut self.plain,
        }
    }

    pub fn picture(&mut self, way: Way) -> Result<Frame> {
        if let Some(multisampled) = self.multisampled(way) {
            return multisampled.picture();
        }
        self.rays(way, way.rays())
    }

    /// So many rays per pixel, by the way's renderer.
    pub fn rays(&mut self, way: Way, count: u32) -> Result<Frame> {
        let scene = self.scene;
        let renderer = self.renderer(way);
        averaged(count, scene, |scene| {
            renderer.update(scene)?;
            renderer.draw()?;
            renderer.read()
        })
    }

    /// Milliseconds of drawing and of reading back; the latter not of what is multisampled.
    pub fn time(&mut self, way: Way) -> Result<[f64; 2]> {
        if let Some(multisampled) = self.multisampled(way) {
            return Ok([multisampled.draw()?.frame_ms, 0.0]);
        }
        let renderer = self.renderer(way);
        let mut drawn = 0.0;
        for _ in 0..way.rays() {
            drawn += renderer.draw()?.frame_ms;
        }
        let start = Instant::now();
        renderer.read()?;
        Ok([drawn, start.elapsed().as_secs_f64() * 1e3])
    }
}
