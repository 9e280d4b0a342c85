//! What a frame needs before it can be recorded: plans, blocks, lists, copies. The cost follows
//! what has changed.

use super::bins::{Batch, Bins, Cylinder};
use super::block::{frame_block, instance_block, note_growth, solid_block};
use super::blocks::SolidBlock;
use super::buffers::{indices, write_slice};
use super::hulls;
use super::offset_surface::OffsetSurface;
use super::output::Output;
use super::plan::{Lists, Planner, Work};
use super::proxy_hull;
use super::renderer::{Entry, Renderer};
use super::table_slot::Part;
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::scene::Shadow;
use crate::settings::{Planes, SearchSettings};
use crate::shader::generated::PATCH_VECTORS;
use crate::shader::{Dispatch, Kind, Variant};
use ash::vk;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::SQRT_2;
use std::sync::Arc;

/// From so many objects on they are planned on all cores.
const MANY: usize = 256;

impl Renderer {
    /// Prepares the frame of slot `slot`, seen by `view`: takes over what was set, writes what
    /// changed, records copies of new textures. To be called outside of a render pass, before
    /// [`Renderer::record`].
    ///
    /// # Errors
    /// [`Stage::Scene`] or [`Stage::Profile`](crate::error::Stage) for what cannot be drawn, with
    /// the key `object.N...`, N counted in order: everything stays as it was before it was set.
    /// [`Stage::Usage`] for a slot that is not there or a view of the other depth order.
    /// [`Stage::Draw`] of Vulkan.
    ///
    /// # Safety
    /// This call writes to memory that the frame before in `slot` read; records image copies and
    /// their barriers into `cmd`; drops what no frame in flight reads any more.
    ///
    /// The caller must see to it that
    /// * `cmd` is recording, outside of a render pass, for a queue of the device's family;
    /// * the commands recorded for `slot` before have run, or were never submitted;
    /// * commands of other slots that were recorded before are submitted before these.
    pub unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: usize,
        view: &View,
    ) -> Result<()> {
        self.check(slot, view)?;
        self.frame += 1;
        let done = |r: &(u64, _)| r.0 < self.frame;
        let count = self.retired.iter().take_while(|r| done(r)).count();
        self.retired.drain(..count);
        self.refresh(Some(view))?;
        self.plan(view)?;
        let staging = self.uploads.record(&self.device, cmd);
        if !staging.is_empty() {
            self.retire(staging);
        }
        self.write(slot, view)
    }

    fn check(&self, slot: usize, view: &View) -> Result<()> {
        let usage = |message: String| Err(Error::new(Stage::Usage, message));
        if slot >= self.frames.len() {
            return usage(format!(
                "frame slot {slot}; there are {}",
                self.frames.len()
            ));
        }
        if view.order != self.output.depth_order() {
            return usage("the view's depth order is not the output's; give both the same".into());
        }
        let parallel = self.output.planes() == Planes::Depth { parallel: true };
        if view.parallel != parallel {
            return usage(
                "parallel views go with an output of parallel depths, and no others".into(),
            );
        }
        if matches!(self.output, Output::Compute(_)) && self.target.is_none() {
            return usage("compute has no target yet; give one to set_compute_target".into());
        }
        Ok(())
    }

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
            binned |= self.has_bins(number);
            self.apply(number, work)?;
            binned |= self.has_bins(number);
        }
        if binned || !self.draws_hulls() {
            self.place_bins(view);
        }
        Ok(())
    }

    fn has_bins(&self, number: u32) -> bool {
        let entry = self.entries[number as usize].as_ref();
        entry.is_some_and(|e| matches!(e.draw.work, Some(Work::Bins(_))))
    }

    /// Finds the bins of all objects that are drawn from them; lists of tiles stand behind these.
    fn place_bins(&mut self, view: &View) {
        let numbers: Vec<u32> = self
            .order
            .iter()
            .copied()
            .filter(|&n| self.has_bins(n))
            .collect();
        let batches: Vec<Batch> = numbers
            .iter()
            .filter_map(|&number| {
                self.entries[number as usize]
                    .as_ref()?
                    .batch(&self.settings)
            })
            .collect();
        let bins = Bins::new(view, &batches, self.draws_hulls());
        drop(batches);
        for (number, shown) in numbers.into_iter().zip(bins.shown) {
            if let Some(entry) = &mut self.entries[number as usize] {
                entry.draw.work = Some(Work::Bins(shown));
            }
            self.mark(number);
        }
        let begin = u32::try_from(bins.words.len()).unwrap_or(u32::MAX);
        self.lists.0 = bins.words;
        for entry in self.entries.iter_mut().flatten() {
            if let Some(Work::Beams(copies)) = &mut entry.draw.work {
                for tiles in copies {
                    tiles.at += begin;
                }
            }
        }
    }

    fn plan_fragment(&self, view: &View, numbers: &[u32]) -> Vec<Work> {
        let planner = Planner {
            view,
            limits: &self.device.limits,
            subgroup_size: self.device.subgroup_size,
            least_pixels: self.settings.proxy_min_pixels,
        };
        let entries = &self.entries;
        let plan = |number: &u32| {
            let entry = entries[*number as usize].as_ref();
            entry.map_or(Work::Nothing, |entry| {
                let wrapped = entry.prepared.as_ref().and_then(|p| p.wrapped.as_deref());
                let binned = entry
                    .prepared
                    .as_ref()
                    .is_some_and(|p| p.variant.takes_bins());
                planner.fragment(entry.drawn(), wrapped, binned)
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
        let planner = Planner {
            view,
            limits: &self.device.limits,
            subgroup_size: self.device.subgroup_size,
            least_pixels: self.settings.proxy_min_pixels,
        };
        let mut lists = Lists::default();
        let mut planned: Vec<Work> = numbers
            .iter()
            .map(|number| {
                let entry = self.entries[*number as usize].as_ref();
                entry.map_or(Work::Nothing, |entry| {
                    let wrapped = entry.prepared.as_ref().and_then(|p| p.wrapped.as_deref());
                    planner.compute(entry.drawn(), wrapped, &mut lists)
                })
            })
            .collect();
        // Blocks of copies stand behind those of all objects.
        let blocks = u32::try_from(self.entries.len()).unwrap_or(u32::MAX);
        for work in &mut planned {
            if let Work::Beams(copies) = work {
                for tiles in copies {
                    tiles.block = tiles.block.map(|n| blocks + n);
                }
            }
        }
        self.lists = (Vec::new(), lists.tiles, lists.copies);
        planned
    }

    /// Gives an entry the pipeline and the tables that its work asks for.
    fn apply(&mut self, number: u32, work: Work) -> Result<()> {
        let several = self.order.len() > 1;
        let in_pass = self.draws_hulls();
        let casts = self.lighting.shadow != Shadow::Off;
        let Some(entry) = &mut self.entries[number as usize] else {
            return Ok(());
        };
        let Some(prepared) = &entry.prepared else {
            entry.draw.work = None;
            return Ok(());
        };
        let variant = prepared.variant;
        let (mut frusta, mut tables) = (None, prepared.surface.as_ref());
        let large = |surface: Option<&Arc<OffsetSurface>>| {
            surface.is_some_and(|s| s.tables().own > PATCH_VECTORS as usize)
        };
        let (kind, variant) = match &work {
            Work::Hull(_) => {
                frusta = prepared.wrapped.as_ref();
                if frusta.is_some_and(|s| s.is_boundary()) {
                    // A hull's own fragments read none of the tree; shadows' rays do.
                    tables = tables.filter(|_| casts);
                    (Kind::Hull, variant.in_shell())
                } else {
                    (Kind::ConvexHull, variant)
                }
            }
            Work::Box => (Kind::Box, variant.with_tables(!large(tables))),
            Work::Beams(copies) => {
                let variant = variant.with_tables(!large(tables));
                // Of an envelope beams alone read something.
                tables = tables.or(prepared.wrapped.as_ref());
                let several = several || copies.len() > 1;
                (Kind::Compute, variant.dispatched(Dispatch::Beams, several))
            }
            Work::Bins(_) if in_pass => (Kind::Bins, variant.with_tables(!large(tables))),
            Work::Bins(_) | Work::Nothing if entry.drawn().placements().len() > 1 => {
                let variant = variant.with_tables(!large(tables));
                (Kind::Compute, variant.dispatched(Dispatch::Bins, several))
            }
            Work::Rectangle(_) | Work::Bins(_) | Work::Nothing => {
                let variant = variant.with_tables(!large(tables));
                (
                    Kind::Compute,
                    variant.dispatched(Dispatch::Rectangle, several),
                )
            }
        };
        let mut replaced = Vec::new();
        let mut put = |surface: Option<&_>, part| match surface {
            Some(surface) => self.arena.place(surface, part).map(|(begin, old)| {
                replaced.extend(old);
                Some(begin)
            }),
            None => Ok(None),
        };
        let bands_at = put(frusta, Part::Frusta)?;
        let tables_at = put(tables, Part::Tables)?;
        let listed = matches!(&work, Work::Beams(copies) if copies.iter().any(|c| c.listed));
        let patches_at = put(prepared.wrapped.as_ref().filter(|_| listed), Part::Patches)?;
        let most = frusta.map_or(0, |s| s.hull().hull.frusta.len());
        if entry.draw.key != Some((variant, kind)) {
            let pipelines = self.device.pipelines()?;
            entry.draw.pipeline = pipelines.get(variant, kind, &self.output, self.owner)?;
            entry.draw.key = Some((variant, kind));
        }
        if matches!(work, Work::Beams(_)) {
            let pipelines = self.device.pipelines()?;
            let get = |variant, kind| pipelines.get(variant, kind, &self.output, self.owner);
            let kind = if listed { Kind::List } else { Kind::Beam };
            entry.draw.list = get(Variant::BEAM, kind)?;
            if listed {
                let lists = variant.listed(variant.depth_keep != 0);
                for (to, variant) in entry.draw.listed.iter_mut().zip(lists) {
                    *to = get(variant, Kind::Listed)?;
                }
            }
        }
        entry.draw.frusta = bands_at.unwrap_or(0);
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

    /// Writes what of a slot is older than the renderer.
    fn write(&mut self, slot: usize, view: &View) -> Result<()> {
        let frame = frame_block(view, &self.lighting);
        let blocks = u32::try_from(self.entries.len()).unwrap_or(u32::MAX) + self.lists.2;
        let instances = self.instances.initial_range().end;
        let slots = &mut self.frames;
        let to = &mut slots[slot];
        to.fit(blocks, instances)?;
        to.write_frame(&frame)?;
        let bit = 1u32 << slot;
        let casts = self.lighting.shadow != Shadow::Off;
        let mut stale = std::mem::take(&mut to.stale);
        if std::mem::take(&mut to.empty) {
            stale.clone_from(&self.order);
        }
        for number in stale {
            let Some(entry) = &mut self.entries[number as usize] else {
                continue;
            };
            entry.stale &= !bit;
            let Some(mut block) = entry.block(&self.settings) else {
                continue;
            };
            if let Some(copy) = entry.drawn().placements().first() {
                block.single = instance_block(entry.drawn(), copy, view);
            }
            to.write_block(number, &block)?;
            let placements = entry.drawn().placements();
            let mut write = |copy: u32| {
                let block = instance_block(entry.drawn(), &placements[copy as usize], view);
                to.write_instance(entry.instances.start + copy, &block)
            };
            match &entry.draw.work {
                // Nothing reads the others, unless they may throw a shadow.
                Some(Work::Bins(shown)) if !casts => {
                    shown.copies.iter().try_for_each(|&copy| write(copy))?
                }
                _ => (0..entry.instances.end - entry.instances.start).try_for_each(write)?,
            }
        }
        if self.listed[slot] != self.version {
            if casts {
                let all: Vec<SolidBlock> = self
                    .order
                    .iter()
                    .filter_map(|&n| self.entries[n as usize].as_ref()?.block(&self.settings))
                    .collect();
                to.write_shadows(&all)?;
            }
            let (words, tiles, _) = &self.lists;
            to.write_lists(words, words.len() + tiles)?;
            if matches!(self.output, Output::Compute(_)) {
                for &number in &self.order {
                    let Some(entry) = &self.entries[number as usize] else {
                        continue;
                    };
                    if let (Some(Work::Beams(copies)), Some(mut block)) =
                        (&entry.draw.work, entry.block(&self.settings))
                    {
                        for tiles in copies {
                            let Some(number) = tiles.block else { continue };
                            let copy = &entry.drawn().placements()[tiles.instance];
                            block.single = instance_block(entry.drawn(), copy, view);
                            to.write_block(number, &block)?;
                        }
                    }
                }
            }
            self.listed[slot] = self.version;
        }
        let target = self.target.as_ref().map(|(t, n)| (t, *n));
        to.name((&self.arena.buffer, self.arena.generation), target);
        Ok(())
    }
}

impl Entry {
    /// Its copies, as bins are found for them.
    fn batch(&self, settings: &SearchSettings) -> Option<Batch<'_>> {
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
        let surface = prepared
            .surface
            .as_ref()
            .filter(|_| settings.occlusion_culling);
        Some(Batch {
            placements: object.placements(),
            first: self.instances.start,
            shape,
            inner: surface
                .filter(|s| hulls::is_whole(object, s))
                .and_then(|s| s.inner()),
        })
    }

    /// What shaders read of it; none before it is prepared.
    fn block(&self, settings: &SearchSettings) -> Option<SolidBlock> {
        let p = self.prepared.as_ref()?;
        let length = p.arc.as_ref().map_or(1.0, |a| a.length);
        let (instances, map) = (&self.instances, p.shadow_map);
        let mut block = solid_block(
            self.drawn(),
            &p.facts,
            length,
            instances,
            map,
            p.solver,
            settings,
        );
        if let Some(grown) = &self.grown {
            note_growth(&mut block, &grown.growth, grown.object.profile.radius);
        }
        #[allow(clippy::cast_possible_truncation)]
        if let Some(surface) = p.fitted() {
            block.bounds[1] += surface.slack() as f32;
        }
        block.hull[0] = self.draw.frusta;
        block.hull[2] = self.draw.patches;
        let walked = p.surface.as_ref().or(p.wrapped.as_ref());
        if let Some(surface) = walked.filter(|s| s.slot(Part::Tables).is_some()) {
            block.patches = surface.tables().block(self.draw.tables);
            block.hull[1] = surface.tables().beams(self.draw.tables);
        }
        Some(block)
    }
}
