//! A frame's plan, the surfaces that it draws, and the hierarchy of copies that cast shadows.

use super::Content;
use super::entry::PreparedObject;
use super::refresh::{Snapshot, distinct};
use crate::error::Result;
use crate::plan::casters::{Hierarchy, Leaf};
use crate::plan::levels::{self, COPY_LEVELS, CopyLevels, GRAZING, coarsest, pixels_per_unit};
use crate::plan::{Conditions, FramePlan, MOST_PROXIES, PlanObject, View, plan, shape_of};
use crate::settings::{Planes, Solver, Tolerance};
use crate::shader::InstanceBlock;
use crate::solid::offset_surface::{OffsetSurface, Part};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The plan of one view of a snapshot.
pub(crate) struct ViewPlan {
    pub view: View,
    pub snapshot: Arc<Snapshot>,
    with: Conditions,
    pub frame: FramePlan,
    /// Objects that the view's mask shows, in order.
    pub objects: Vec<PlannedObject>,
    /// Their copies that cast shadows; `None` if nothing is shaded in shadow.
    pub hierarchy: Option<Arc<Hierarchy>>,
}

/// An object in a plan.
pub(crate) struct PlannedObject {
    pub object: Arc<PreparedObject>,
    pub level: u8,
    /// The surfaces that the search walks, from the finest level on; none for searches on the map.
    pub surfaces: Vec<Arc<OffsetSurface>>,
    /// The choice of each copy's level, if copies have levels of their own.
    pub levels: Option<CopyLevels>,
}

impl PlannedObject {
    /// The vectors that hold a part of all its levels, and others between them.
    pub fn window(&self, part: Part) -> Range<u32> {
        let stored = self.surfaces.iter().filter_map(|surface| {
            let begin = surface.slot(part)?.begin();
            Some(begin..begin + surface.vectors(part).len() as u32)
        });
        stored
            .reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
            .unwrap_or_default()
    }

    /// The number of a copy's surface among all.
    pub fn surface_of(&self, copy: &InstanceBlock) -> usize {
        let coarser = |levels: &CopyLevels| levels.of_block(copy) - levels.first;
        self.levels.as_ref().map_or(0, coarser)
    }

    /// The object in the form that a plan reads.
    fn input(&self) -> PlanObject<'_> {
        let (prepared, derived) = (&*self.object, &self.object.derived);
        let object = prepared.drawn();
        let bounds = prepared.bounds(&self.surfaces[..self.surfaces.len().min(1)]);
        let texels = 2.0 / f64::from(derived.facts.rows);
        let away = object.offset.largest_width().max(0.0) + texels;
        PlanObject {
            object,
            number: prepared.number,
            first_instance: prepared.instances.start,
            technique: derived.technique,
            textures: Arc::as_ptr(&derived.textures) as usize,
            surfaces: &self.surfaces,
            levels: self.levels.as_ref(),
            shape: shape_of(object, bounds.map(f64::from)),
            outline: Some((prepared.boundary.solid.as_ref(), away)),
        }
    }
}

impl Content {
    /// Returns the plan of a view. Makes a new plan if neither the last one nor `known`, the one of
    /// the view's slot, is of this view and of all objects as set.
    pub fn plan(&mut self, view: &View, known: Option<&Arc<ViewPlan>>) -> Result<Arc<ViewPlan>> {
        let snapshot = self.refresh()?;
        let with = self.conditions();
        let is_same = |p: &&Arc<ViewPlan>| {
            Arc::ptr_eq(&p.snapshot, &snapshot) && (p.view, p.with) == (*view, with)
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
        let objects = self.with_surfaces(view, &snapshot)?;
        let inputs: Vec<_> = objects.iter().map(PlannedObject::input).collect();
        let frame = plan(view, &inputs, &with);
        let shadowed = self.casts() && !matches!(self.output.planes(), Planes::Depth { .. });
        // Without shadows levels differ, and with them all objects have one level.
        let level = |objects: &[PlannedObject]| objects.first().map(|object| object.level);
        let known = self.plan.as_ref().filter(|known| {
            Arc::ptr_eq(&known.snapshot, &snapshot)
                && known.view.mask == view.mask
                && level(&known.objects) == level(&objects)
        });
        let known = known.and_then(|known| known.hierarchy.clone());
        let hierarchy = || known.unwrap_or_else(|| Arc::new(hierarchy(&objects, &inputs)));
        let hierarchy = shadowed.then(hierarchy);
        Ok(ViewPlan {
            view: *view,
            snapshot,
            with,
            frame,
            hierarchy,
            objects,
        })
    }

    /// The inputs of a plan other than view and objects.
    pub fn conditions(&self) -> Conditions {
        let (limits, chosen) = (self.device.limits(), &self.device.chosen);
        Conditions {
            compute: self.is_compute(),
            passes_cells: limits.max_fragment_input_components
                >= crate::solid::proxy_hull::COMPONENTS
                && limits.max_vertex_output_components >= crate::solid::proxy_hull::OUTPUTS,
            software: chosen.report.kind == "cpu",
            subgroup_size: chosen.subgroup_size,
            most_storage: limits.max_storage_buffer_range,
            least_pixels: self.settings.proxy_min_pixels,
            occlusion_culling: self.settings.occlusion_culling,
            ray_spread: self.output.ray_spread(),
            level_pixels: self.settings.tolerance.pixels() / GRAZING,
            takes_patches: self.settings.takes_patches(),
            lights: match self.lighting.lights.len() {
                _ if self.casts() || self.host_shades => 3,
                count => count.clamp(1, 3) as u32,
            },
            casts: self.casts(),
            single_copy: self.has_single_copy(),
            host_depths: self.is_compute() && self.target.as_ref().is_none_or(|t| t.depths),
        }
    }

    fn has_single_copy(&self) -> bool {
        match self.snapshot.objects.as_slice() {
            [object] => object.drawn().placements().len() == 1,
            _ => false,
        }
    }

    /// Returns the objects that a view shows, with surfaces of the levels that it allows. Makes the
    /// surfaces that are new. With shadows, all objects take the finest level that one of them
    /// needs, because a shadow may fall nearer to the eye than its caster.
    fn with_surfaces(&mut self, view: &View, snapshot: &Snapshot) -> Result<Vec<PlannedObject>> {
        let shown = snapshot.objects.iter().filter(|o| o.mask & view.mask != 0);
        let mut all = Vec::with_capacity(snapshot.objects.len());
        for object in shown {
            all.push(self.planned(object, view)?);
        }
        if self.casts() {
            let finest = all.iter().map(|f| f.level).min().unwrap_or(0);
            all.iter_mut().for_each(|f| f.level = finest);
        }
        let mut new = Vec::new();
        for one in &mut all {
            let coarser = one
                .levels
                .iter()
                .flat_map(|of| &COPY_LEVELS[of.first + 1..]);
            for level in [one.level].iter().chain(coarser) {
                one.surfaces.extend(one.object.surface(*level, &mut new)?);
            }
        }
        self.make_surfaces(&mut new);
        Ok(all)
    }

    /// An object at the coarsest level that the view allows, without surfaces. Objects with many
    /// copies have a level for each.
    fn planned(&self, object: &Arc<PreparedObject>, view: &View) -> Result<PlannedObject> {
        let tolerance = self.settings.tolerance;
        let mut planned = PlannedObject {
            object: object.clone(),
            level: 0,
            surfaces: Vec::new(),
            levels: None,
        };
        if self.levels_copies(object) {
            let height = object.growth().height();
            let levels = CopyLevels::new(object.drawn(), height, view, tolerance);
            planned.level = COPY_LEVELS[levels.first];
            planned.levels = Some(levels);
        } else if tolerance != Tolerance::EXACT && object.derived.solver.follows_tolerance() {
            let pixels = object.pixels_per_unit(view, self.casts());
            // An object that does not show takes a level that is already made.
            let hidden = pixels <= 0.0 && !self.casts();
            let made = if hidden { object.first_level()? } else { None };
            planned.level = made.unwrap_or_else(|| coarsest(tolerance, pixels));
        }
        Ok(planned)
    }

    /// True if each copy of an object has a level of its own. The view has no influence, so a moving
    /// camera needs no other pipelines.
    fn levels_copies(&self, object: &PreparedObject) -> bool {
        let follows = object.derived.solver.follows_tolerance();
        let follows = follows && !self.casts() && !self.is_parallel();
        let object = object.drawn();
        let many = object.instances.len() > MOST_PROXIES && object.repeat == [1; 3];
        follows && many && self.settings.tolerance != Tolerance::EXACT
    }

    /// Makes all surfaces that are not made yet, on all cores, with the part that the solver reads.
    pub fn make_surfaces(&mut self, surfaces: &mut Vec<Arc<OffsetSurface>>) {
        surfaces.retain(|surface| !surface.is_made());
        let part = match (self.settings.solver, self.is_compute()) {
            (Solver::Exact, false) => Part::Frusta,
            (Solver::Exact, true) => Part::Patches,
            _ => Part::Tables,
        };
        let new = distinct(surfaces);
        new.par_iter().for_each(|surface| {
            surface.make();
            surface.vectors(part);
        });
        self.rebuilds += new.len() as u64;
    }
}

/// The hierarchy over the copies of these objects.
fn hierarchy(objects: &[PlannedObject], inputs: &[PlanObject]) -> Hierarchy {
    let mut leaves = Vec::new();
    for (planned, input) in objects.iter().zip(inputs) {
        let map = planned.object.derived.shadow_map;
        let copies = input.object.placements().par_iter().enumerate();
        leaves.par_extend(copies.map(|(copy, placement)| {
            let instance = input.first_instance + copy as u32;
            Leaf::new(instance, map, placement, &input.shape)
        }));
    }
    Hierarchy::new(&mut leaves)
}

impl PreparedObject {
    /// The largest number of pixels that one unit of the profile takes in a view. `all` includes
    /// copies outside the picture.
    fn pixels_per_unit(&self, view: &View, all: bool) -> f64 {
        pixels_per_unit(self.drawn(), self.growth().height(), view, all)
    }

    /// Upper bound on the shift of the silhouette by patches of a level in a view, in pixels.
    pub fn error_pixels(&self, level: u8, view: &View) -> f64 {
        levels::bound(level) * self.pixels_per_unit(view, false)
    }
}
