//! The content of a renderer: objects and lights as set, the snapshot of all objects with their
//! resources, and the plan of the last view. It records no commands.
//!
//! Modules import from those before them: `entry` (one object as set and as prepared), `objects`,
//! `snapshot`, `view_plan`.

pub(super) mod entry;
pub(super) mod objects;
pub(super) mod snapshot;
pub(super) mod view_plan;

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::resources::textures::Textures;
use crate::gpu::vk::output::{ComputeTarget, Output};
use crate::plan::walk::Walks;
use crate::plan::{Conditions, OpenPixels, View, missing_hulls, plan};
use crate::scene::{Lighting, Shadow};
use crate::settings::{Planes, SearchSettings};
use crate::shader::{Demands, InstanceBlock, Lights};
use crate::solid::offset_surface::OffsetSurface;
use entry::Stale;
use objects::Objects;
use rayon::prelude::*;
use snapshot::{Snapshot, distinct, find_boundaries};
use std::sync::{Arc, Mutex};
use view_plan::{PlannedObject, ViewPlan, planned, precedence};

/// Objects and lights as set, the last snapshot of all objects, and the last plan. One owner has them,
/// because a failed step must leave all of them as they were.
pub(super) struct Content {
    pub objects: Objects,
    pub lighting: Lighting,
    /// The memory that shaders write to, in compute or for all planes.
    pub target: Option<ComputeTarget>,
    pub snapshot: Arc<Snapshot>,
    pub plan: Option<Arc<ViewPlan>>,
    /// The pixels that compute draws; all if none.
    pub open: Option<Arc<OpenPixels>>,
    pub textures: Textures,
    pub geometry: Arc<Mutex<Geometry>>,
    pub rebuilds: u64,
    pub notes: Vec<String>,
    pub settings: SearchSettings,
    pub output: Output,
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
            objects: Objects::new(
                most_instances(device, &output),
                output.planes().has_motion(),
            ),
            lighting: Lighting::default(),
            target: None,
            snapshot: Arc::default(),
            plan: None,
            open: None,
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

    pub fn is_compute(&self) -> bool {
        matches!(self.output, Output::Compute(_))
    }

    pub fn casts(&self) -> bool {
        self.lighting.shadow != Shadow::Off
    }

    /// The snapshot of all objects as set. A failed call changes nothing, and the next one tries
    /// again.
    pub fn refresh(&mut self) -> Result<Arc<Snapshot>> {
        self.objects.shrink();
        if !self.objects.stale {
            return Ok(self.snapshot.clone());
        }
        let (failed, tables) = find_boundaries(&mut self.objects, &self.geometry, &self.settings)?;
        self.rebuilds += failed as u64;
        self.make_surfaces(tables.iter());
        let demands = Demands {
            settings: &self.settings,
            planes: self.output.planes(),
            host_shades: self.host_shades,
            lighting: &self.lighting,
        };
        let (textures, notes) = (&mut self.textures, &mut self.notes);
        let snapshot = Snapshot::new(&self.objects, &self.snapshot, demands, textures, notes)?;
        for object in &snapshot.objects {
            if let Some(entry) = self.objects.at_mut(object.number) {
                entry.prepared = Some(object.clone());
                entry.stale = Stale::Nothing;
            }
        }
        self.objects.stale = false;
        self.snapshot = Arc::new(snapshot);
        Ok(self.snapshot.clone())
    }

    /// Returns the plan of a view. Makes a new plan if neither the last one nor `known`, the one of
    /// the view's slot, is of this view and of all objects as set.
    pub fn plan(&mut self, view: &View, known: Option<&Arc<ViewPlan>>) -> Result<Arc<ViewPlan>> {
        let snapshot = self.refresh()?;
        let with = self.conditions(&snapshot);
        let is_same = |p: &&Arc<ViewPlan>| {
            let opens_same =
                p.open.as_ref().map(Arc::as_ptr) == self.open.as_ref().map(Arc::as_ptr);
            Arc::ptr_eq(&p.snapshot, &snapshot) && opens_same && (p.view, p.with) == (*view, with)
        };
        let mut plans = self.plan.iter().chain(known);
        let found = plans.find(is_same).cloned();
        let made = match found {
            Some(found) => found,
            None => Arc::new(self.new_plan(view, snapshot, with)?),
        };
        self.plan = Some(made.clone());
        Ok(made)
    }

    fn new_plan(
        &mut self,
        view: &View,
        snapshot: Arc<Snapshot>,
        with: Conditions,
    ) -> Result<ViewPlan> {
        let known = self.plan.as_ref().filter(|known| {
            Arc::ptr_eq(&known.snapshot, &snapshot) && known.view.mask == view.mask
        });
        let objects = planned(view, &snapshot, &with)?;
        let order = known.map(|known| known.precedence.clone());
        let precedence = order.unwrap_or_else(|| Arc::new(precedence(&objects)));
        let shadowed = self.casts() && !matches!(self.output.planes(), Planes::Depth { .. });
        let is_same = |known: &&Arc<ViewPlan>| {
            // Boxes are those of the levels of surfaces.
            let levels = known.objects.iter().map(|object| object.level);
            let shadows = known.walks.casters.is_some() == shadowed;
            shadows && levels.eq(objects.iter().map(|o| o.level))
        };
        let known = known.filter(is_same).map(|known| known.walks.clone());
        self.make_surfaces(objects.iter().flat_map(|object| &object.surfaces));
        let copies_of = |of: &PlannedObject| snapshot.looks[&of.object.look()];
        let inputs: Vec<_> = objects.iter().map(|of| of.input(copies_of(of))).collect();
        in_parallel(
            missing_hulls(view, &inputs, &with),
            OffsetSurface::make_hull,
        );
        let walks = known.unwrap_or_else(|| Arc::new(Walks::new(&inputs, &with, shadowed)));
        let frame = plan(view, &inputs, &with, self.open.as_deref(), &walks);
        Ok(ViewPlan {
            view: *view,
            snapshot,
            with,
            open: self.open.clone(),
            frame,
            precedence,
            walks,
            objects,
        })
    }

    /// The inputs of a plan of a snapshot, other than view and objects.
    pub fn conditions(&self, snapshot: &Snapshot) -> Conditions {
        let (limits, chosen) = (self.device.limits(), &self.device.chosen);
        Conditions {
            compute: self.is_compute(),
            passes_cells: limits.max_fragment_input_components
                >= crate::solid::proxy_hull::COMPONENTS
                && limits.max_vertex_output_components >= crate::solid::proxy_hull::OUTPUTS,
            software: chosen.report.kind == "cpu",
            subgroup_size: chosen.subgroup_size,
            group_invocations: limits.max_compute_work_group_invocations,
            most_storage: limits.max_storage_buffer_range,
            least_pixels: self.settings.proxy_min_pixels,
            ray_spread: self.output.ray_spread(),
            tolerance: self.settings.tolerance,
            parallel: self.is_parallel(),
            takes_patches: self.settings.takes_patches(),
            lights: match self.casts() || self.host_shades {
                true => Lights::Any,
                false => Lights::of(self.lighting.lights.len()),
            },
            casts: self.casts(),
            single_copy: match snapshot.objects.as_slice() {
                [object] => object.drawn().placements().len() == 1,
                _ => false,
            },
            host_depths: self.is_compute() && self.target.as_ref().is_none_or(|t| t.depths),
        }
    }

    /// Makes all of these surfaces that are not made yet, on all cores.
    fn make_surfaces<'a>(&mut self, surfaces: impl Iterator<Item = &'a Arc<OffsetSurface>>) {
        let new = surfaces.filter(|surface| !surface.is_made());
        self.rebuilds += in_parallel(new.cloned(), OffsetSurface::make) as u64;
    }

    pub fn is_parallel(&self) -> bool {
        self.output.planes() == Planes::Depth { parallel: true }
    }
}

/// Calls `make` once for each of these surfaces, on all cores. Returns their number.
fn in_parallel(
    surfaces: impl IntoIterator<Item = Arc<OffsetSurface>>,
    make: impl Fn(&OffsetSurface) + Sync,
) -> usize {
    let mut all: Vec<_> = surfaces.into_iter().collect();
    let all = distinct(&mut all);
    all.par_iter().for_each(|surface| make(surface));
    all.len()
}

/// Upper limit on instances: their records are in one storage buffer, with those of the last frame
/// if motion is drawn.
fn most_instances(device: &Shared, output: &Output) -> u32 {
    let records = if output.planes().has_motion() { 2 } else { 1 };
    let bytes = records * size_of::<InstanceBlock>() as u32;
    device.limits().max_storage_buffer_range / bytes
}
