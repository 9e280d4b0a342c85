//! A frame's plan and the surfaces that it draws.

use super::Content;
use super::entry::{Derived, Entry};
use crate::error::Result;
use crate::plan::levels::{
    self, COPY_LEVELS, CopyLevels, GRAZING, LevelledCopies, coarsest, pixels_per_unit,
};
use crate::plan::{Conditions, FramePlan, MOST_PROXIES, Parts, PlanObject, View, plan, shape_of};
use crate::settings::{Solver, Tolerance};
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::reach::largest_width;
use crate::solid::table_slot::Part;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// The plan of one view, for one version of a renderer's objects.
pub(crate) struct ViewPlan {
    pub view: View,
    pub version: u64,
    pub frame: FramePlan,
    /// One per drawn object, in order.
    pub objects: Vec<PlannedObject>,
    /// Number of blocks: those of all objects, then those of coarser levels.
    pub blocks: u32,
}

/// An object in a plan.
pub(crate) struct PlannedObject {
    pub number: u32,
    pub level: u8,
    /// The surface that the search walks; `None` for searches on the map.
    pub surface: Option<Arc<OffsetSurface>>,
    /// Its copies, if they have levels of their own.
    pub levelled: Option<LevelledCopies>,
}

impl PlannedObject {
    /// The surfaces of all its levels, from the finest on.
    pub fn surfaces(&self) -> impl Iterator<Item = &Arc<OffsetSurface>> {
        let coarser = self.levelled.iter().flat_map(|copies| &copies.coarser);
        self.surface.iter().chain(coarser)
    }

    /// The vectors that hold the tables of all its levels, and other tables between them.
    pub fn window(&self, parts: &Parts) -> Range<u32> {
        let kinds = [(parts.tables, Part::Tables), (parts.patches, Part::Patches)];
        let stored = self.surfaces().flat_map(|surface| {
            let read = kinds.into_iter().filter(|(reads, _)| *reads);
            read.filter_map(|(_, part)| Some((surface.slot(part)?.begin(), surface.vectors(part))))
        });
        stored
            .map(|(begin, vectors)| begin..begin + vectors.len() as u32)
            .reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
            .unwrap_or_default()
    }
}

impl Content {
    /// Returns the plan of a view. Makes a new plan if neither the last one nor `known`, the one of
    /// the view's slot, is of this view and version.
    pub fn plan(&mut self, view: &View, known: Option<&Arc<ViewPlan>>) -> Result<Arc<ViewPlan>> {
        self.refresh()?;
        let same = |p: &&Arc<ViewPlan>| p.version == self.version && p.view == *view;
        let mut plans = self.plan.iter().chain(known);
        if let Some(plan) = plans.find(same).cloned() {
            self.plan = Some(plan.clone());
            return Ok(plan);
        }
        let mut objects = self.with_surfaces(Some(view))?;
        let mut blocks = self.objects.number_count() as u32;
        for copies in objects.iter_mut().filter_map(|of| of.levelled.as_mut()) {
            copies.first_block = blocks;
            blocks += copies.coarser.len() as u32;
        }
        let with = self.conditions();
        let read: Vec<PlanObject> = objects
            .iter()
            .filter_map(|planned| {
                let entry = self.objects.at(planned.number)?;
                entry.plan_object(planned, &self.settings)
            })
            .collect();
        let made = Arc::new(ViewPlan {
            view: *view,
            version: self.version,
            frame: plan(view, &read, &with),
            objects,
            blocks,
        });
        self.plan = Some(made.clone());
        Ok(made)
    }

    /// The inputs of a plan other than view and objects.
    pub fn conditions(&self) -> Conditions {
        let limits = self.device.limits();
        Conditions {
            compute: self.is_compute(),
            passes_cells: limits.max_fragment_input_components
                >= crate::solid::proxy_hull::COMPONENTS
                && limits.max_vertex_output_components >= crate::solid::proxy_hull::OUTPUTS,
            software: self.device.chosen.report.kind == "cpu",
            subgroup_size: self.device.chosen.subgroup_size,
            most_storage: limits.max_storage_buffer_range,
            own_vectors: self.device.chosen.constants().own_vectors as usize,
            least_pixels: self.settings.proxy_min_pixels,
            occlusion_culling: self.settings.occlusion_culling,
            ray_spread: self.output.ray_spread(),
            level_pixels: self.settings.tolerance.pixels() / GRAZING,
            casts: self.casts(),
            lists_crowds: self.lists_crowds(),
            host_depths: self.is_compute() && self.target_has_depths,
        }
    }

    /// True if the device lists the tiles of crowds: it has doubles, and no plane needs where copies
    /// were.
    fn lists_crowds(&self) -> bool {
        self.settings.device_lists
            && self.device.chosen.lists_crowds()
            && !self.output.planes().has_motion()
    }

    /// Returns all objects with surfaces of the levels that the view allows. Makes the surfaces that
    /// are new.
    pub fn with_surfaces(&mut self, view: Option<&View>) -> Result<Vec<PlannedObject>> {
        let mut found = self.levels(view);
        let mut new = Vec::new();
        for one in &mut found {
            let Some(entry) = self.objects.at_mut(one.number) else {
                continue;
            };
            one.surface = entry.surface(one.level, &mut new)?;
            if let Some(copies) = &mut one.levelled {
                for level in &COPY_LEVELS[copies.levels.first + 1..] {
                    copies.coarser.extend(entry.surface(*level, &mut new)?);
                }
            }
        }
        self.make_surfaces(&new);
        Ok(found)
    }

    /// The level of each object: the coarsest that the view allows, or the exact one if there is no
    /// view. Objects with many copies have a level for each. With shadows, all objects take the
    /// finest level that one of them needs. The reason is that a shadow may fall nearer to the eye
    /// than its caster.
    fn levels(&self, view: Option<&View>) -> Vec<PlannedObject> {
        let casts = self.casts();
        let tolerance = self.settings.tolerance;
        let level_of = |entry: &Entry, derived: &Derived| match view {
            Some(view) if tolerance != Tolerance::EXACT && derived.solver.follows_tolerance() => {
                let pixels = entry.pixels_per_unit(view, casts);
                // An object that does not show takes a level that is already made.
                let made = derived.levels.first().filter(|_| pixels <= 0.0 && !casts);
                made.map_or_else(|| coarsest(tolerance, pixels), |(level, _)| *level)
            }
            _ => 0,
        };
        let planned = |(number, entry): (u32, &Entry)| {
            let derived = entry.derived.as_ref()?;
            let levelled = self.levels_copies(entry, derived);
            let levels = view.filter(|_| levelled).map(|view| {
                let height = entry.growth().height();
                CopyLevels::new(entry.drawn(), height, view, tolerance, self.lists_crowds())
            });
            let finest = levels.as_ref().map(|levels| COPY_LEVELS[levels.first]);
            Some(PlannedObject {
                number,
                level: finest.unwrap_or_else(|| level_of(entry, derived)),
                surface: None,
                levelled: levels.map(|levels| LevelledCopies {
                    levels,
                    ..LevelledCopies::default()
                }),
            })
        };
        let mask = view.map_or(u32::MAX, |view| view.mask);
        let shown = |(_, entry): &(u32, &Entry)| entry.mask & mask != 0;
        let objects = self.objects.ordered().filter(shown);
        let mut found: Vec<_> = objects.filter_map(planned).collect();
        if casts {
            let finest = found.iter().map(|f| f.level).min().unwrap_or(0);
            found.iter_mut().for_each(|f| f.level = finest);
        }
        found
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
    pub fn make_surfaces(&mut self, surfaces: &[Arc<OffsetSurface>]) {
        let mut new: Vec<_> = surfaces.iter().filter(|s| !s.is_made()).collect();
        new.sort_unstable_by_key(|s| Arc::as_ptr(s));
        new.dedup_by_key(|s| Arc::as_ptr(s));
        let part = match (self.settings.solver, self.is_compute()) {
            (Solver::Exact, false) => Part::Frusta,
            (Solver::Exact, true) => Part::Patches,
            _ => Part::Tables,
        };
        new.par_iter().for_each(|surface| {
            surface.make();
            surface.vectors(part);
        });
        self.rebuilds += new.len() as u64;
    }
}

impl Entry {
    /// The surface of a level; none for a search on the map. Adds it to `new` if it is.
    fn surface(
        &mut self,
        level: u8,
        new: &mut Vec<Arc<OffsetSurface>>,
    ) -> Result<Option<Arc<OffsetSurface>>> {
        let (growth, offset) = (self.growth(), self.drawn().offset);
        let Some(derived) = &mut self.derived else {
            return Ok(None);
        };
        let known = derived.levels.iter().find(|(known, _)| *known == level);
        if known.is_some() || !derived.solver.follows_tolerance() {
            return Ok(known.map(|(_, surface)| surface.clone()));
        }
        let surface = derived.solid.patches(&offset, &growth, level)?;
        derived.levels.push((level, surface.clone()));
        new.push(surface.clone());
        Ok(Some(surface))
    }

    /// The largest number of pixels that one unit of the profile takes in a view. `all` includes
    /// copies outside the picture.
    pub fn pixels_per_unit(&self, view: &View, all: bool) -> f64 {
        let height = self.growth().height();
        pixels_per_unit(self.drawn(), height, view, all)
    }

    /// Upper bound on the shift of the silhouette by patches of a level in a view, in pixels.
    pub fn error_pixels(&self, level: u8, view: &View) -> f64 {
        levels::bound(level) * self.pixels_per_unit(view, false)
    }

    /// The object in the form that a plan reads; `None` before it is derived.
    pub fn plan_object<'a>(
        &'a self,
        planned: &'a PlannedObject,
        settings: &crate::settings::SearchSettings,
    ) -> Option<PlanObject<'a>> {
        let derived = self.derived.as_ref()?;
        let surface = planned.surface.as_ref();
        let block = self.block(surface.map(Arc::as_ref), 0, settings)?;
        let texels = 2.0 / f64::from(block.map[1]);
        let away = largest_width(&self.drawn().offset).max(0.0) + texels;
        Some(PlanObject {
            object: self.drawn(),
            number: planned.number,
            first_instance: self.instances.start,
            variant: derived.variant,
            textures: Arc::as_ptr(&derived.textures) as usize,
            surface,
            takes_patches: derived.takes_patches && surface.is_some(),
            levelled: planned.levelled.as_ref(),
            shape: shape_of(self.drawn(), block.bounds.map(f64::from)),
            outline: Some((derived.solid.outline.as_ref(), away)),
        })
    }
}
