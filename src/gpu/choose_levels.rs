//! Gives objects the levels that a view allows, and makes their surfaces.

use super::entry::{Entry, Prepared};
use super::levels::{coarsest, pixels_per_unit};
use super::offset_surface::OffsetSurface;
use super::renderer::Renderer;
use super::table_slot::Part;
use super::view::View;
use crate::error::Result;
use crate::scene::{Growth, Shadow};
use crate::settings::{Solver, Tolerance};
use rayon::prelude::*;
use std::sync::Arc;

impl Renderer {
    /// Whether objects are drawn by other levels than the exact one.
    pub(super) fn has_levels(&self) -> bool {
        self.settings.tolerance != Tolerance::EXACT && self.settings.solver.follows_tolerance()
    }

    /// Gives each of these entries the level that the view allows. With shadows all take the finest
    /// that one of them needs: a shadow may fall nearer to the eye than what casts it.
    pub(super) fn choose_levels(&mut self, view: &View, numbers: &[u32]) -> Result<()> {
        if !self.has_levels() {
            return Ok(());
        }
        let tolerance = self.settings.tolerance;
        let casts = self.lighting.shadow != Shadow::Off;
        let wanted = |&number: &u32| {
            let entry = self.entries[number as usize].as_ref()?;
            entry.prepared.as_ref()?.fitted()?;
            let pixels = entry.pixels_per_unit(view, casts);
            // What does not show keeps what it has.
            (casts || pixels > 0.0).then(|| (number, coarsest(tolerance, pixels)))
        };
        let asked = if casts { &self.order[..] } else { numbers };
        let mut chosen: Vec<(u32, u8)> = asked.iter().filter_map(wanted).collect();
        if casts {
            let finest = chosen.iter().map(|c| c.1).min().unwrap_or(0);
            chosen.iter_mut().for_each(|c| c.1 = finest);
        }
        let mut changed = Vec::new();
        for (number, level) in chosen {
            let Some(entry) = &self.entries[number as usize] else {
                continue;
            };
            if let Some(prepared) = entry.prepared.as_ref().filter(|p| p.level != level) {
                let growth = entry.growth();
                let offset = &entry.drawn().offset;
                let surface = prepared.solid.patches(offset, &growth, level)?;
                changed.push((number, level, surface));
            }
        }
        self.make_surfaces(changed.iter().map(|c| &c.2));
        for (number, level, surface) in changed {
            if let Some(entry) = &mut self.entries[number as usize]
                && let Some(prepared) = &mut entry.prepared
            {
                prepared.take_level(level, surface);
                self.unplanned.push(number);
            }
        }
        Ok(())
    }

    /// Makes those that are not made yet, on all cores, with the part that the solver reads.
    pub(super) fn make_surfaces<'a>(
        &mut self,
        surfaces: impl Iterator<Item = &'a Arc<OffsetSurface>>,
    ) {
        let mut new: Vec<_> = surfaces.filter(|s| !s.is_made()).collect();
        new.sort_unstable_by_key(|s| Arc::as_ptr(s));
        new.dedup_by_key(|s| Arc::as_ptr(s));
        let part = if self.settings.solver == Solver::Hull && self.draws_hulls() {
            Part::Frusta
        } else {
            Part::Tables
        };
        new.par_iter().for_each(|surface| {
            surface.make();
            surface.vectors(part);
        });
        self.rebuilds += new.len() as u64;
    }
}

impl Entry {
    /// By how much the box has grown with the offset.
    pub(super) fn growth(&self) -> Growth {
        self.grown.as_ref().map(|g| g.growth).unwrap_or_default()
    }

    /// The most pixels that one unit of the profile takes in a view; `all`: of copies that are
    /// beside the picture, too.
    pub(super) fn pixels_per_unit(&self, view: &View, all: bool) -> f64 {
        pixels_per_unit(self.drawn(), self.growth().height(), view, all)
    }
}

impl Prepared {
    /// The patches that it is drawn by, if it is.
    pub(super) fn fitted(&self) -> Option<&Arc<OffsetSurface>> {
        let surface = self.surface.as_ref();
        surface.filter(|_| self.solver.follows_tolerance())
    }

    /// Draws by another level from now on; those before are kept, as the view may come back to
    /// them.
    fn take_level(&mut self, level: u8, surface: Arc<OffsetSurface>) {
        self.level = level;
        if self.proxy.is_some() {
            self.proxy = Some(surface.clone());
        }
        if let Some(before) = self.surface.replace(surface)
            && !self.levels.iter().any(|known| Arc::ptr_eq(known, &before))
        {
            self.levels.push(before);
        }
    }
}
