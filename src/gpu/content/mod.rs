//! The content of a renderer: objects and lights, the resources that are derived from them, and the
//! plan of the last view. It records no commands.
//!
//! `objects.rs` adds, removes and changes objects, `entry.rs` is the record of one. `refresh.rs`
//! derives resources from new values. `view_plan.rs` plans a view's frame.

pub(super) mod entry;
pub(super) mod objects;
pub(super) mod refresh;
pub(super) mod view_plan;

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::resources::textures::{ObjectImages, Textures};
use crate::gpu::vk::output::{ComputeTarget, Output};
use crate::scene::{Lighting, Object, Shadow};
use crate::settings::{Planes, SearchSettings, Solver};
use crate::shader::{HostLook, InstanceBlock, Technique};
use objects::Objects;
use refresh::{Common, Wanted};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};
use view_plan::{Casters, ViewPlan};

/// Objects, lights, and all that is derived from them.
pub(super) struct Content {
    pub objects: Objects,
    pub textures: Textures,
    pub geometry: Arc<Mutex<Geometry>>,
    pub lighting: Lighting,
    /// Values that were set since the last refresh.
    pub wanted: Wanted,
    /// True if an object was removed since the last refresh, and with it a reason for common facts.
    pub removed: bool,
    pub common: Common,
    /// Numbers of objects that are new or were changed since the last frame, if motion is drawn.
    pub moved: BTreeSet<u32>,
    /// Counts changes.
    pub version: u64,
    /// The plan of the last view.
    pub plan: Option<Arc<ViewPlan>>,
    /// The copies that may cast shadows, as of the last frame with shadows.
    casters: Option<Casters>,
    /// The memory that shaders write to, in compute or for all planes.
    pub target: Option<ComputeTarget>,
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
            textures: Textures::new(device, settings.map_format, host_shades)?,
            geometry,
            lighting: Lighting::default(),
            wanted: Wanted::new(),
            removed: false,
            common: Common::default(),
            moved: BTreeSet::new(),
            version: 1,
            plan: None,
            casters: None,
            target: None,
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

    /// The technique that draws an object with these images by this search.
    pub fn technique(&self, solver: Solver, object: &Object, images: &ObjectImages) -> Technique {
        let host = HostLook {
            shading: self.host_shades,
            colors: images.color.is_some(),
            relief: images.relief.is_some(),
            heights: images.relief.is_some() && images.heights,
        };
        Technique::new(
            &self.settings,
            self.output.planes(),
            solver,
            &self.lighting,
            object,
            self.common.casters,
            host,
        )
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
