//! One renderer for every method: searches and meshes behind the same calls.

use crate::floor;
use crate::mesh::{MeshOffscreen, MeshPipelines, Multisampled};
use crate::method::{Method, MethodSettings};
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::{Device, ObjectCost, Offscreen, Times};
use revmap::scene::Scene;
use revmap::settings::Settings;
use std::sync::{Arc, OnceLock};

/// A device, and what drawing by any method shares on it.
pub struct MethodDevice {
    device: Device,
    /// With the floor's shaders, once they are wanted.
    floor: OnceLock<Device>,
    pipelines: Arc<MeshPipelines>,
}

/// A drawn frame and what it cost.
#[derive(Clone, Debug)]
pub struct MethodDrawn {
    /// The picture.
    pub frame: Frame,
    /// What drawing it took, of a second frame: the first waits for the driver's compiler.
    pub times: Times,
    /// As [`MethodRenderer::map_bytes`].
    pub map_bytes: [u64; 2],
    /// As [`Offscreen::notes`]; none of a mesh.
    pub notes: Vec<String>,
    /// As [`Offscreen::object_costs`]; none of a mesh.
    pub costs: Vec<ObjectCost>,
    /// As [`MethodRenderer::device_bytes`].
    pub device_bytes: u64,
}

impl MethodDevice {
    /// Draws on this device.
    ///
    /// # Errors
    /// Of Vulkan.
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
    /// As [`Offscreen::new`] or [`MeshOffscreen::new`].
    pub fn renderer(&self, scene: &Scene, settings: &MethodSettings) -> Result<MethodRenderer> {
        Ok(if settings.method.is_mesh() {
            let mesh = MeshOffscreen::new(&self.pipelines, scene, settings)?;
            MethodRenderer::Mesh(Box::new(mesh))
        } else {
            let own = Settings::from(settings);
            let device = self.device_of(scene, settings.method)?;
            MethodRenderer::Search(Box::new(Offscreen::new(device, scene, &own)?))
        })
    }

    /// Makes all ready for a picture of four samples a pixel.
    ///
    /// # Errors
    /// As [`Multisampled::new`].
    pub fn multisampled(&self, scene: &Scene, settings: &MethodSettings) -> Result<Multisampled> {
        Multisampled::new(&self.pipelines, scene, settings)
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

    /// Draws a scene once, as [`revmap::gpu::draw`].
    ///
    /// # Errors
    /// As [`MethodDevice::renderer`]; of drawing.
    pub fn draw(&self, scene: &Scene, settings: &MethodSettings) -> Result<MethodDrawn> {
        let mut renderer = self.renderer(scene, settings)?;
        renderer.draw()?;
        let times = renderer.draw()?;
        let drawn = MethodDrawn {
            frame: renderer.read()?,
            times,
            map_bytes: renderer.map_bytes(),
            notes: renderer.notes().to_vec(),
            costs: renderer.object_costs(),
            device_bytes: renderer.device_bytes(),
        };
        drop(renderer);
        self.device.check()?;
        Ok(drawn)
    }
}

/// A scene on a device and a picture that it is drawn into, by either kind of method.
pub enum MethodRenderer {
    /// By a search, or by the floor.
    Search(Box<Offscreen>),
    /// As meshes.
    Mesh(Box<MeshOffscreen>),
}

impl MethodRenderer {
    /// Takes over a scene.
    ///
    /// # Errors
    /// As [`Offscreen::update`] or [`MeshOffscreen::update`].
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        match self {
            Self::Search(offscreen) => offscreen.update(scene),
            Self::Mesh(mesh) => mesh.update(scene),
        }
    }

    /// As [`Offscreen::prewarm`]; of a mesh nothing.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn prewarm(&mut self) -> Result<()> {
        match self {
            Self::Search(offscreen) => offscreen.prewarm(),
            Self::Mesh(_) => Ok(()),
        }
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of drawing.
    pub fn draw(&mut self) -> Result<Times> {
        match self {
            Self::Search(offscreen) => offscreen.draw(),
            Self::Mesh(mesh) => mesh.draw(),
        }
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn read(&mut self) -> Result<Frame> {
        match self {
            Self::Search(offscreen) => offscreen.read(),
            Self::Mesh(mesh) => mesh.read(),
        }
    }

    /// As [`Offscreen::rebuild_count`], or how many meshes were made.
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        match self {
            Self::Search(offscreen) => offscreen.rebuild_count(),
            Self::Mesh(mesh) => mesh.rebuild_count(),
        }
    }

    /// Bytes on the device: of shape maps and tables, or of meshes; of colour and displacement
    /// maps.
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        match self {
            Self::Search(offscreen) => offscreen.map_bytes(),
            Self::Mesh(mesh) => [mesh.mesh_bytes(), 0],
        }
    }

    /// As [`Offscreen::object_costs`]; none of a mesh.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        match self {
            Self::Search(offscreen) => offscreen.object_costs(),
            Self::Mesh(_) => Vec::new(),
        }
    }

    /// As [`Offscreen::device_bytes`]; of a mesh its own bytes.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        match self {
            Self::Search(offscreen) => offscreen.device_bytes(),
            Self::Mesh(mesh) => mesh.mesh_bytes(),
        }
    }

    /// As [`Offscreen::notes`]; none of a mesh.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        match self {
            Self::Search(offscreen) => offscreen.notes(),
            Self::Mesh(_) => &[],
        }
    }
}
