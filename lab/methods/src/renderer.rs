//! One renderer for every method: searches and meshes behind the same calls.

use crate::floor;
use crate::{Method, MethodSettings};
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::{Settings, Solver};
use revmap_mesh::{MeshLayer, MeshPipelines};
use revmap_offscreen::{Guest, Offscreen, OffscreenOptions, Times};
use revmap_searches::folder::{check_scene, name_of};
use revmap_searches::watchdog::watched;
use std::sync::{Arc, OnceLock};

/// A device, and what drawing by any method shares on it.
pub struct MethodDevice {
    device: Device,
    /// With the floor's shaders, once they are wanted.
    floor: OnceLock<Device>,
    pipelines: Arc<MeshPipelines>,
}

impl MethodDevice {
    /// Draws on this device.
    pub fn new(device: Device) -> Result<Self> {
        let pipelines = MeshPipelines::new(&device)?;
        Ok(Self {
            device,
            floor: OnceLock::new(),
            pipelines,
        })
    }

    /// Makes all ready to draw a scene.
    ///
    /// # Errors
    /// As [`Offscreen::new`]; [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) and
    /// [`ErrorKind::Content`](revmap::error::ErrorKind::Content) for what a mesh does not draw.
    pub fn renderer(&self, scene: &Scene, settings: &MethodSettings) -> Result<MethodRenderer> {
        let solver = settings.method.solver();
        solver.map_or(Ok(()), |s| check_scene(s, scene))?;
        let options = OffscreenOptions {
            guests_only: settings.method.is_mesh(),
            samples: settings.edges.samples(),
            ..OffscreenOptions::default()
        };
        let device = self.device_of(scene, settings.method)?;
        let own = Settings::from(settings);
        let offscreen = Box::new(Offscreen::with(device, scene, &own, options)?);
        let mut meshes = None;
        if options.guests_only {
            let (pipelines, samples) = (&self.pipelines, options.samples);
            let fineness = settings.mesh_fineness()?;
            let mut new = MeshLayer::new(pipelines, &offscreen, fineness, &own, samples)?;
            new.update(scene, || Ok(*offscreen.view()))?;
            meshes = Some(Box::new(new));
        }
        Ok(MethodRenderer {
            meshes,
            offscreen,
            solver,
        })
    }

    fn device_of(&self, scene: &Scene, method: Method) -> Result<&Device> {
        if method != Method::Floor {
            return Ok(&self.device);
        }
        floor::check(scene)?;
        match self.floor.get() {
            Some(made) => Ok(made),
            None => {
                let made = floor::device(&self.device)?;
                Ok(self.floor.get_or_init(|| made))
            }
        }
    }

    /// Draws a scene once.
    pub fn draw(&self, scene: &Scene, settings: &MethodSettings) -> Result<Frame> {
        let mut renderer = self.renderer(scene, settings)?;
        renderer.draw()?;
        let frame = renderer.read()?;
        drop(renderer);
        self.device.check()?;
        Ok(frame)
    }
}

/// A scene on a device and a picture that it is drawn into, by any method.
pub struct MethodRenderer {
    // Dropped first: its frames were waited for.
    meshes: Option<Box<MeshLayer>>,
    /// What draws a search, and tells of it; of meshes it has none of the scene's objects.
    pub offscreen: Box<Offscreen>,
    /// The search that draws; `None` for meshes and for the floor.
    solver: Option<Solver>,
}

impl MethodRenderer {
    /// Takes over a scene.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        self.solver.map_or(Ok(()), |s| check_scene(s, scene))?;
        match &mut self.meshes {
            None => self.offscreen.update(scene),
            Some(meshes) => meshes.update(scene, || {
                self.offscreen.update(scene)?;
                Ok(*self.offscreen.view())
            }),
        }
    }

    /// Draws one frame and waits for it.
    pub fn draw(&mut self) -> Result<Times> {
        let guest = self.meshes.as_deref().map(|meshes| meshes as &dyn Guest);
        let times = watched(self.solver.and_then(name_of), || {
            self.offscreen.draw_with(guest)
        })?;
        self.meshes.iter_mut().for_each(|m| m.drop_staging());
        Ok(times)
    }

    /// The frame that was drawn last.
    pub fn read(&mut self) -> Result<Frame> {
        self.offscreen.read()
    }

    /// As [`Renderer::rebuild_count`](revmap::gpu::Renderer::rebuild_count), or how many meshes were made.
    pub fn rebuild_count(&self) -> u64 {
        let meshes = self.meshes.as_ref().map(|meshes| meshes.made_count());
        meshes.unwrap_or_else(|| self.offscreen.renderer().rebuild_count())
    }

    /// Bytes on the device: of shape maps and tables, or of meshes; of colours and displacements.
    pub fn map_bytes(&self) -> [u64; 2] {
        let meshes = self.meshes.as_ref().map(|meshes| [meshes.bytes(), 0]);
        meshes.unwrap_or_else(|| self.offscreen.renderer().map_bytes())
    }

    /// As [`Renderer::device_bytes`](revmap::gpu::Renderer::device_bytes); of a mesh its own bytes.
    pub fn device_bytes(&self) -> u64 {
        let meshes = self.meshes.as_ref().map(|meshes| meshes.bytes());
        meshes.unwrap_or_else(|| self.offscreen.renderer().device_bytes())
    }
}
