//! The content of a renderer: objects and lights as set, the snapshot of all objects with their
//! resources, and the plan of the last view. It records no commands.
//!
//! `objects.rs` adds, removes and changes objects, `entry.rs` is one object as set and as prepared.
//! `refresh.rs` makes the snapshot. `view_plan.rs` plans a view's frame from it.

pub(super) mod entry;
pub(super) mod objects;
pub(super) mod refresh;
pub(super) mod view_plan;

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::resources::textures::Textures;
use crate::gpu::vk::output::{ComputeTarget, Output};
use crate::scene::{Lighting, Shadow};
use crate::settings::{Planes, SearchSettings};
use crate::shader::InstanceBlock;
use objects::Objects;
use refresh::{Demands, Snapshot};
use std::sync::{Arc, Mutex};
use view_plan::ViewPlan;

/// Objects and lights as set, the last snapshot of all objects, and the last plan.
pub(super) struct Content {
    pub objects: Objects,
    pub lighting: Lighting,
    /// The memory that shaders write to, in compute or for all planes.
    pub target: Option<ComputeTarget>,
    pub snapshot: Arc<Snapshot>,
    /// The plan of the last view.
    pub plan: Option<Arc<ViewPlan>>,
    pub textures: Textures,
    pub geometry: Arc<Mutex<Geometry>>,
    pub rebuilds: u64,
    pub notes: Vec<String>,
    pub settings: SearchSettings,
    pub output: Output,
    /// True if a function of the host shades.
    pub host_shades: bool,
    device: Arc<Shared>,
}

impl Content {
    /// No objects, for a renderer with this output.
    pub fn new(
        device: &Arc<Shared>,
        geometry: Arc<Mutex<Geometry>>,
        output: Output,
        settings: &SearchSettings,
        host_shades: bool,
    ) -> Result<Self> {
        Ok(Self {
            objects: Objects::new(most_instances(device, &output)),
            lighting: Lighting::default(),
            target: None,
            snapshot: Arc::default(),
            plan: None,
            textures: Textures::new(device, settings.map_format, host_shades)?,
            geometry,
            rebuilds: 0,
            notes: Vec::new(),
            settings: *settings,
            output,
            host_shades,
            device: device.clone(),
        })
    }

    /// True if tiles are traced in compute.
    pub fn is_compute(&self) -> bool {
        matches!(self.output, Output::Compute(_))
    }

    /// True if objects cast shadows.
    pub fn casts(&self) -> bool {
        self.lighting.shadow != Shadow::Off
    }

    /// What techniques depend on beside the object.
    pub fn demands(&self) -> Demands<'_> {
        Demands {
            settings: &self.settings,
            planes: self.output.planes(),
            host_shades: self.host_shades,
            lighting: &self.lighting,
        }
    }

    /// True if the view has parallel rays.
    pub fn is_parallel(&self) -> bool {
        self.output.planes() == Planes::Depth { parallel: true }
    }
}

/// Upper limit on instances: their records are in one storage buffer, with those of the last frame
/// if motion is drawn.
fn most_instances(device: &Shared, output: &Output) -> u32 {
    let records = if output.planes().has_motion() { 2 } else { 1 };
    let bytes = records * size_of::<InstanceBlock>() as u32;
    device.limits().max_storage_buffer_range / bytes
}
