//! Chooses how each object of a frame is drawn, and lists the copies that show.

use super::bins::{Batch, Bins, Cylinder};
use super::buffers::{indices, write_slice};
use super::entry::Entry;
use super::hulls;
use super::output::Output;
use super::plan::{Lists, Planner, Work, takes_lists};
use super::proxy_hull;
use super::renderer::Renderer;
use super::table_slot::Part;
use super::view::View;
use crate::error::Result;
use crate::scene::Shadow;
use crate::settings::SearchSettings;
use crate::shader::generated::FRUSTUM_VECTORS;
use crate::shader::{Dispatch, Kind, Variant};
use ash::vk;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::SQRT_2;

/// From so many objects on they are planned on all cores: to wake these takes as long as to plan a
/// thousand.
const MANY: usize = 4096;

impl Renderer {
    /// Whether the output shows hulls.
    pub(super) fn draws_hulls(&self) -> bool {
        matches!(self.output, Output::Pass(_))
    }

    /// Chooses how everything that changed is drawn, or everything, if the view did.
    pub(super) fn plan(&mut self, view: &View) -> Result<()> {
        let moved = self.view != Some(*view);
        if moved || (!self.draws_hulls() && !self.unplanned.is_empty()) {
            // In compute all objects' lists stand in one buffer.
            self.unplanned.clone_from(&self.order);
        }
        if self.unplanned.is_empty() {
            return Ok(());
        }
        let asked = self.unplanned.clone();
        self.choose_levels(view, &asked)?;
        let mut numbers = std::mem::take(&mut self.unplanned);
        if self.draws_hulls() {
            numbers.sort_unstable();
            numbers.dedup();
        } else {
            // All of them, in order.
            numbers.clone_from(&self.order);
        }
        self.view = Some(*view);
        self.version += 1;
        let planned = if self.draws_hulls() {
            self.plan_fragment(view, &numbers)
        } else {
            self.plan_compute(view, &numbers)
        };
        let mut binned = false;
        for (number, work) in numbers.into_iter().zip(planned) {
            binned |= self.has_bins(number) || matches!(work, Work::Bins(_));
            self.apply(number, work)?;
        }
        if binned || !self.draws_hulls() {
            self.place_bins(view)?;
        }
        Ok(())
    }

    fn has_bins(&self, number: u32) -> bool {
        let entry = self.entries[number as usize].as_ref();
        entry.is_some_and(|e| matches!(e.draw.work, Some(Work::Bins(_))))
    }

    /// Finds the bins of all objects that are drawn from them; lists of tiles stand behind these.
    fn place_bins(&mut self, view: &View) -> Result<()> {
        let numbers: Vec<u32> = self
            .order
            .iter()
            .copied()
            .filter(|&n| self.has_bins(n))
            .collect();
        let subgroup_size = self.device.subgroup_size;
        let batches: Vec<Batch> = numbers
            .iter()
            .filter_map(|&number| {
                self.entries[number as usize]
                    .as_ref()?
                    .batch(&self.settings, subgroup_size)
            })
            .collect();
        let room = (self.planner(view).room()).saturating_sub(self.lists.1 as u64);
        let mut bins = Bins::new(view, &batches, self.draws_hulls(), room);
        drop(batches);
        // Lists that hold bins begin where a bin could.
        bins.words.resize(bins.words.len().next_multiple_of(4), 0);
        let begin = u32::try_from(bins.words.len()).unwrap_or(u32::MAX);
        self.lists.1 = self.lists.1.next_multiple_of(4);
        self.lists.0 = bins.words;
        for (number, mut shown) in numbers.into_iter().zip(bins.shown) {
            shown.lists = begin + self.lists.1 as u32;
            self.lists.1 += shown.words() as usize;
            self.choose(number, Work::Bins(shown))?;
        }
        for entry in self.entries.iter_mut().flatten() {
            if let Some(Work::Beams { copies, .. }) = &mut entry.draw.work {
                for tiles in copies {
                    tiles.at += begin;
                }
            }
        }
        Ok(())
    }

    fn planner<'a>(&'a self, view: &'a View) -> Planner<'a> {
        Planner {
            view,
            limits: &self.device.limits,
            subgroup_size: self.device.subgroup_size,
            clips: self.device.clips,
            software: self.device.report.kind == "cpu",
            least_pixels: self.settings.proxy_min_pixels,
        }
    }

    fn plan_fragment(&self, view: &View, numbers: &[u32]) -> Vec<Work> {
        let planner = self.planner(view);
        let entries = &self.entries;
        let plan = |number: &u32| {
            let entry = entries[*number as usize].as_ref();
            entry.map_or(Work::Nothing, |entry| {
                let proxy = entry.prepared.as_ref().and_then(|p| p.proxy.as_deref());
                let binned = entry
                    .prepared
                    .as_ref()
                    .is_some_and(|p| p.variant.takes_bins());
                planner.fragment(entry.drawn(), proxy, binned)
            })
        };
        if numbers.len() < MANY {
            numbers.iter().map(plan).collect()
        } else {
            numbers.par_iter().with_min_len(64).map(plan).collect()
        }
    }

    /// Plans all objects; the lists that they share are kept for [`Renderer::write`].
    fn plan_compute(&mut self, view: &View, numbers: &[u32]) -> Vec<Work> {
        let planner = self.planner(view);
        let mut lists = Lists::default();
        let mut planned: Vec<Work> = numbers
            .iter()
            .map(|number| {
                let entry = self.entries[*number as usize].as_ref();
                entry.map_or(Work::Nothing, |entry| {
                    let proxy = entry.prepared.as_ref().and_then(|p| p.proxy.as_deref());
                    planner.compute(entry.drawn(), proxy, &mut lists)
                })
            })
            .collect();
        // Blocks of copies stand behind those of all objects.
        let blocks = u32::try_from(self.entries.len()).unwrap_or(u32::MAX);
        for work in &mut planned {
            if let Work::Beams { copies, .. } = work {
                for tiles in copies {
                    tiles.block = tiles.block.map(|n| blocks + n);
                }
            }
        }
        self.lists = (Vec::new(), lists.tiles, lists.copies);
        planned
    }

    /// Takes over what an entry is drawn by.
    fn apply(&mut self, number: u32, work: Work) -> Result<()> {
        match (&mut self.entries[number as usize], &work) {
            // What shows of it, which the pipeline depends on, is found with all others'.
            (Some(entry), Work::Bins(_)) if entry.prepared.is_some() => {
                entry.draw.work = Some(work);
                Ok(())
            }
            _ => self.choose(number, work),
        }
    }

    /// Gives an entry the pipeline and the tables that its work asks for.
    fn choose(&mut self, number: u32, work: Work) -> Result<()> {
        let (several, keeps) = (self.order.len() > 1, self.keeps_depths);
        let in_pass = self.draws_hulls();
        let casts = self.lighting.shadow != Shadow::Off;
        let Some(entry) = &mut self.entries[number as usize] else {
            return Ok(());
        };
        let Some(prepared) = &entry.prepared else {
            entry.draw.work = None;
            return Ok(());
        };
        let outside = match (&work, prepared.surface.as_deref(), &self.view) {
            (Work::Bins(shown), _, _) => shown.outside,
            (Work::Nothing, _, _) => true,
            // Hulls and tiles are told of cuts alone.
            (Work::Hull { .. } | Work::Beams { .. }, _, _) => false,
            (_, Some(surface), Some(view)) => {
                hulls::is_seen_from_outside(entry.drawn(), surface, view)
            }
            _ => false,
        };
        let variant = prepared.variant;
        let (mut frusta, mut tables) = (None, prepared.surface.as_ref());
        let most = self.device.constants.own_vectors as usize;
        let fit = tables.is_none_or(|s| s.tables().own <= most);
        let searched = variant.seen_from(outside).with_tables(fit);
        let (kind, variant) = match &work {
            Work::Hull { cut, .. } => {
                frusta = prepared.proxy.as_ref();
                if frusta.is_some_and(|s| s.is_boundary()) {
                    // A hull's own fragments read none of the tree; sides and shadows' rays do.
                    tables = tables.filter(|_| casts || *cut);
                    (Kind::Hull, variant.with_tables(true).cut_by_sides(*cut))
                } else {
                    (Kind::ConvexHull, variant)
                }
            }
            Work::Box => (Kind::Box, searched),
            Work::Beams { copies, cut } => {
                // Of an envelope beams alone read something.
                tables = tables.or(prepared.proxy.as_ref());
                let several = several || copies.len() > 1;
                (Kind::Compute, searched.tiled(*cut, several))
            }
            Work::Bins(shown) if in_pass => {
                let held = shown.beams && prepared.proxy.is_some();
                let spans = searched.in_spans().filter(|_| held);
                (Kind::Spots, spans.unwrap_or(searched))
            }
            Work::Bins(shown) if entry.drawn().placements().len() > 1 => {
                let several = several || !shown.alone.is_empty();
                (Kind::Compute, searched.dispatched(Dispatch::Bins, several))
            }
            Work::Nothing if entry.drawn().placements().len() > 1 => {
                (Kind::Compute, searched.dispatched(Dispatch::Bins, several))
            }
            Work::Rectangle(_) | Work::Bins(_) | Work::Nothing => {
                let variant = searched.dispatched(Dispatch::Rectangle, several);
                (Kind::Compute, variant)
            }
        };
        let variant = variant.keeping(keeps && kind == Kind::Compute);
        let mut replaced = Vec::new();
        let mut put = |surface: Option<&_>, part| match surface {
            Some(surface) => self.arena.place(surface, part).map(|(begin, old)| {
                replaced.extend(old);
                Some(begin)
            }),
            None => Ok(None),
        };
        let frusta_at = put(frusta, Part::Frusta)?;
        let tables_at = put(tables, Part::Tables)?;
        let listed = match &work {
            Work::Beams { copies, .. } => copies.iter().any(|c| c.listed),
            Work::Bins(shown) => !shown.alone.is_empty(),
            _ => false,
        };
        let patches_at = put(prepared.proxy.as_ref().filter(|_| listed), Part::Patches)?;
        let most = frusta.map_or(0, |s| s.hull().hull.frusta.len());
        if matches!(work, Work::Hull { cut: true, .. }) {
            let pipelines = self.device.pipelines()?;
            for (to, variant) in (entry.draw.sides.iter_mut()).zip([variant.into_solid(), searched])
            {
                *to = pipelines.get(variant, Kind::Sides, &self.output, self.owner)?;
            }
        }
        if kind == Kind::Spots {
            let pipelines = self.device.pipelines()?;
            entry.draw.bins = pipelines.get(searched, Kind::Bins, &self.output, self.owner)?;
        }
        if entry.draw.key != Some((variant, kind)) {
            let pipelines = self.device.pipelines()?;
            entry.draw.pipeline = pipelines.get(variant, kind, &self.output, self.owner)?;
            entry.draw.key = Some((variant, kind));
        }
        if let (Work::Beams { .. }, _) | (_, true) = (&work, listed) {
            let pipelines = self.device.pipelines()?;
            let get = |variant, kind| pipelines.get(variant, kind, &self.output, self.owner);
            let cut = matches!(work, Work::Beams { cut: true, .. });
            let bins = matches!(work, Work::Bins(_));
            entry.draw.list = match () {
                () if bins => get(Variant::BEAM, Kind::ListCopies)?,
                () if listed => get(Variant::BEAM.cut_by_sides(cut), Kind::List)?,
                () => get(Variant::BEAM, Kind::Beam)?,
            };
            if listed {
                let lists = variant.of_bins(bins).listed(cut, variant.depth_test != 0);
                for (to, list) in entry.draw.listed.iter_mut().zip(lists) {
                    *to = match list {
                        Some((variant, kind)) => get(variant.keeping(keeps), kind)?,
                        None => vk::Pipeline::null(),
                    };
                }
            }
        }
        entry.draw.frusta = frusta_at.unwrap_or(0);
        entry.draw.side_rows = most as u32 * FRUSTUM_VECTORS;
        entry.draw.tables = tables_at.unwrap_or(0);
        entry.draw.tables_offset = 16 * entry.draw.tables;
        entry.draw.patches = patches_at.unwrap_or(0);
        entry.draw.patches_offset = 16 * entry.draw.patches;
        entry.draw.work = Some(work);
        self.mark(number);
        for old in replaced {
            self.retire(old);
        }
        self.fit_corners(most)
    }

    /// Sees to it that there are corners for hulls of so many frusta.
    fn fit_corners(&mut self, frusta: usize) -> Result<()> {
        let bytes = 4 * proxy_hull::corners(u32::try_from(frusta).unwrap_or(u32::MAX)) as usize;
        if self.corners.bytes < bytes as u64 {
            let frusta = frusta.next_power_of_two();
            let all = proxy_hull::indices(frusta);
            let mut corners = indices(&self.device, 4 * all.len())?;
            write_slice(&mut corners, &all)?;
            let old = std::mem::replace(&mut self.corners, corners);
            self.retire(old);
        }
        Ok(())
    }
}

impl Entry {
    /// Its copies, as bins are found for them.
    fn batch(&self, settings: &SearchSettings, subgroup_size: u32) -> Option<Batch<'_>> {
        let (prepared, object) = (self.prepared.as_ref()?, self.drawn());
        let block = self.block(settings)?;
        let [side, radius, low, high] = block.bounds.map(f64::from);
        let replicas = object.repeat != [1; 3];
        let shape = Cylinder {
            axis: if replicas {
                DVec2::ZERO
            } else {
                DVec2::new(block.axis[0].into(), block.axis[1].into())
            },
            radius: if replicas { side * SQRT_2 } else { radius },
            low: if replicas { 0.0 } else { low },
            high: if replicas { 1.0 } else { high },
        };
        let held = prepared
            .surface
            .as_ref()
            .filter(|s| settings.occlusion_culling && hulls::is_whole(object, s));
        let whole = prepared
            .surface
            .as_deref()
            .filter(|s| s.is_boundary() && hulls::is_whole(object, s));
        let lists = prepared
            .proxy
            .as_deref()
            .is_some_and(|s| takes_lists(subgroup_size, s));
        Some(Batch {
            whole,
            half_side: object.profile.radius,
            lists,
            placements: &object.instances,
            first: self.instances.start,
            shape,
            inner: held.and_then(|s| s.inner()),
            outer: held.and_then(|s| s.outer()),
        })
    }
}
