//! A frame's plan, the surfaces that it draws, and the hierarchy of copies that cast shadows.

use super::Content;
use super::entry::{Boundary, Derived, Entry, Values};
use super::refresh::distinct;
use crate::error::Result;
use crate::plan::casters::{Hierarchy, Leaf};
use crate::plan::levels::{self, COPY_LEVELS, CopyLevels, GRAZING, coarsest, pixels_per_unit};
use crate::plan::{Conditions, FramePlan, MOST_PROXIES, PlanObject, View, plan, shape_of};
use crate::settings::{Solver, Tolerance};
use crate::shader::InstanceBlock;
use crate::solid::offset_surface::{OffsetSurface, Part, Recipe};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The copies that may cast shadows, with the values that their boxes depend on: version of the
/// content, mask of the view, level of all surfaces.
pub(super) type Casters = ((u64, u32, u8), Arc<Hierarchy>);

/// The plan of one view, for one version of a renderer's objects.
pub(crate) struct ViewPlan {
    pub view: View,
    pub version: u64,
    pub frame: FramePlan,
    /// One per drawn object, in order.
    pub objects: Vec<PlannedObject>,
    /// Number of instances, with free ones. The records of the last frame's placements are after
    /// them.
    pub instances: u32,
}

/// An object in a plan.
pub(crate) struct PlannedObject {
    pub number: u32,
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
}

impl Content {
    /// Returns the plan of a view. Makes a new plan if neither the last one nor `known`, the one of
    /// the view's slot, is of this view and version.
    pub fn plan(&mut self, view: &View, known: Option<&Arc<ViewPlan>>) -> Result<Arc<ViewPlan>> {
        self.refresh()?;
        if self.objects.shrink(self.version + 1) {
            self.version += 1;
        }
        let same = |p: &&Arc<ViewPlan>| p.version == self.version && p.view == *view;
        let mut plans = self.plan.iter().chain(known);
        if let Some(plan) = plans.find(same).cloned() {
            self.plan = Some(plan.clone());
            return Ok(plan);
        }
        let objects = self.with_surfaces(Some(view))?;
        let read = objects.iter().filter_map(|planned| {
            let entry = self.objects.at(planned.number)?;
            entry.plan_object(planned)
        });
        let made = Arc::new(ViewPlan {
            view: *view,
            version: self.version,
            frame: plan(view, &read.collect::<Vec<_>>(), &self.conditions()),
            objects,
            instances: self.objects.instances(),
        });
        self.plan = Some(made.clone());
        Ok(made)
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
            own_vectors: chosen.constants().own_vectors as usize,
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
        let copies = |(_, entry): (u32, &Entry)| entry.drawn().placements().len();
        self.objects.len() == 1 && self.objects.ordered().map(copies).eq([1])
    }

    /// Returns all objects that a view shows, with surfaces of the levels that it allows; of the
    /// exact levels if there is no view. Makes the surfaces that are new. With shadows, all objects
    /// take the finest level that one of them needs, because a shadow may fall nearer to the eye
    /// than its caster.
    pub fn with_surfaces(&mut self, view: Option<&View>) -> Result<Vec<PlannedObject>> {
        let mask = view.map_or(u32::MAX, |view| view.mask);
        let shown = |(_, entry): &(u32, &Entry)| entry.mask & mask != 0;
        let shown = self.objects.ordered().filter(shown);
        let planned = shown.filter_map(|(number, entry)| self.planned(number, entry, view));
        let mut found: Vec<_> = planned.collect();
        if self.casts() {
            let finest = found.iter().map(|f| f.level).min().unwrap_or(0);
            found.iter_mut().for_each(|f| f.level = finest);
        }
        let mut new = Vec::new();
        for one in &mut found {
            let Some(entry) = self.objects.at_mut(one.number) else {
                continue;
            };
            let coarser = one
                .levels
                .iter()
                .flat_map(|of| &COPY_LEVELS[of.first + 1..]);
            for level in [one.level].iter().chain(coarser) {
                one.surfaces.extend(entry.surface(*level, &mut new)?);
            }
        }
        self.make_surfaces(&mut new);
        Ok(found)
    }

    /// An object at the coarsest level that the view allows, without surfaces. Objects with many
    /// copies have a level for each.
    fn planned(&self, number: u32, entry: &Entry, view: Option<&View>) -> Option<PlannedObject> {
        let (boundary, derived) = entry.resources()?;
        let tolerance = self.settings.tolerance;
        let fitted = tolerance != Tolerance::EXACT && derived.solver.follows_tolerance();
        let mut planned = PlannedObject {
            number,
            level: 0,
            surfaces: Vec::new(),
            levels: None,
        };
        match view {
            Some(view) if self.levels_copies(entry, derived) => {
                let (object, height) = (entry.drawn(), entry.values.growth().height());
                let levels = CopyLevels::new(object, height, view, tolerance);
                planned.level = COPY_LEVELS[levels.first];
                planned.levels = Some(levels);
            }
            Some(view) if fitted => {
                let pixels = entry.pixels_per_unit(view, self.casts());
                // An object that does not show takes a level that is already made.
                let made = boundary.levels.first();
                let made = made.filter(|_| pixels <= 0.0 && !self.casts());
                planned.level = made.map_or_else(|| coarsest(tolerance, pixels), |made| made.0);
            }
            _ => {}
        }
        Some(planned)
    }

    /// True if each copy of an object has a level of its own. The view has no influence, so a moving
    /// camera needs no other pipelines.
    pub fn levels_copies(&self, entry: &Entry, derived: &Derived) -> bool {
        let follows = derived.solver.follows_tolerance() && !self.casts() && !self.is_parallel();
        let object = entry.drawn();
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

    /// The hierarchy over the copies of a plan's objects that cast shadows. Builds it if they have
    /// changed.
    pub fn hierarchy(&mut self, plan: &ViewPlan) -> Arc<Hierarchy> {
        // With shadows, all surfaces have one level.
        let level = plan.objects.iter().map(|object| object.level).min();
        let key = (plan.version, plan.view.mask, level.unwrap_or(0));
        if let Some((known, hierarchy)) = &self.casters
            && *known == key
        {
            return hierarchy.clone();
        }
        let mut leaves = Vec::new();
        for planned in &plan.objects {
            let entry = self.objects.at(planned.number);
            let object = entry.and_then(|entry| {
                let (_, derived) = entry.resources()?;
                Some((derived.shadow_map, entry.plan_object(planned)?))
            });
            let Some((map, object)) = object else {
                continue;
            };
            let copies = object.object.placements().par_iter().enumerate();
            leaves.par_extend(copies.map(|(copy, placement)| {
                let instance = object.first_instance + copy as u32;
                Leaf::new(instance, map, placement, &object.shape)
            }));
        }
        let made = Arc::new(Hierarchy::new(&mut leaves));
        self.casters = Some((key, made.clone()));
        made
    }
}

impl Entry {
    /// The surface of a level; none for a search on the map. Adds it to `new` if it is.
    fn surface(
        &mut self,
        level: u8,
        new: &mut Vec<Arc<OffsetSurface>>,
    ) -> Result<Option<Arc<OffsetSurface>>> {
        let (growth, offset) = (self.values.growth(), self.drawn().offset);
        let Values {
            boundary: Some(Boundary { solid, levels, .. }),
            derived: Some(derived),
            ..
        } = &mut self.values
        else {
            return Ok(None);
        };
        // Surfaces of another search may be left from before.
        if derived.solver.reads_map() {
            return Ok(None);
        }
        let known = levels.iter().find(|(known, _)| *known == level);
        if known.is_some() || !derived.solver.follows_tolerance() {
            return Ok(known.map(|(_, surface)| surface.clone()));
        }
        let tolerance = levels::bound(level) / growth.height().max(1.0);
        let surface = solid.surface(&offset, Recipe::Patches { level, tolerance })?;
        levels.push((level, surface.clone()));
        new.push(surface.clone());
        Ok(Some(surface))
    }

    /// The largest number of pixels that one unit of the profile takes in a view. `all` includes
    /// copies outside the picture.
    pub fn pixels_per_unit(&self, view: &View, all: bool) -> f64 {
        pixels_per_unit(self.drawn(), self.values.growth().height(), view, all)
    }

    /// Upper bound on the shift of the silhouette by patches of a level in a view, in pixels.
    pub fn error_pixels(&self, level: u8, view: &View) -> f64 {
        levels::bound(level) * self.pixels_per_unit(view, false)
    }

    /// The object in the form that a plan reads; `None` before it is derived.
    pub fn plan_object<'a>(&'a self, planned: &'a PlannedObject) -> Option<PlanObject<'a>> {
        let (boundary, derived) = self.resources()?;
        let object = self.drawn();
        let bounds = self.bounds(derived, &planned.surfaces[..planned.surfaces.len().min(1)]);
        let texels = 2.0 / f64::from(derived.facts.rows);
        let away = object.offset.largest_width().max(0.0) + texels;
        Some(PlanObject {
            object,
            number: planned.number,
            first_instance: self.instances.start,
            technique: derived.technique,
            textures: Arc::as_ptr(&derived.textures) as usize,
            surfaces: &planned.surfaces,
            levels: planned.levels.as_ref(),
            shape: shape_of(object, bounds.map(f64::from)),
            outline: Some((boundary.solid.as_ref(), away)),
        })
    }
}
