//! Preparation of a frame before it is recorded: plan, tables, pipelines, blocks. While a
//! slot's view and the content stand still, it writes the frame block alone. Any change plans all
//! objects anew.

use super::Renderer;
use super::blocks::{
    caster_root, frame_block, instance_block, last_copy, level_tables, object_block, placed_block,
    placed_eye,
};
use super::output_check::check_viewport;
use super::slot::{BoundPlan, BoundStep, SlotBuffer};
use super::statistics::FrameStatistics;
use crate::error::{Error, ErrorKind, Result, lock};
use crate::gpu::content::view_plan::{PlannedObject, ViewPlan};
use crate::plan::path::MOST_PROXIES;
use crate::plan::{DrawPath, View};
use crate::shader::{Drawn, InstanceBlock, Kind, OBJECT_STRIDE, ObjectBlock};
use crate::solid::offset_surface::{OffsetSurface, Part};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// A frame that was prepared in a slot; the argument of [`Renderer::record`]. Preparing the slot
/// again makes the frame invalid.
#[derive(Debug)]
#[must_use]
pub struct PreparedFrame {
    pub(super) renderer: u32,
    pub(super) slot: usize,
    pub(super) serial: u64,
    reads_depths: bool,
    statistics: FrameStatistics,
    /// Nanoseconds of the last recording.
    recorded: AtomicU64,
}

impl PreparedFrame {
    /// What the frame records, and what that cost.
    #[must_use]
    pub fn statistics(&self) -> FrameStatistics {
        FrameStatistics {
            record_ms: self.recorded.load(Ordering::Relaxed) as f64 * 1e-6,
            ..self.statistics
        }
    }

    /// Keeps the time of a recording that began at `start`.
    pub(super) fn end_recording(&self, start: Instant) {
        let spent = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.recorded.store(spent, Ordering::Relaxed);
    }

    /// Returns true if compute compares with the depths of its target and writes its own depths
    /// there. If false, the target's depths may hold anything.
    #[must_use]
    pub fn reads_depths(&self) -> bool {
        self.reads_depths
    }
}

impl Renderer {
    /// Applies the values that were set, and plans the frame of `view`. The next
    /// [`Renderer::prepare`] does this itself. Call `plan` to find errors early, or to learn how
    /// objects are drawn.
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`].
    pub fn plan(&mut self, view: &View) -> Result<()> {
        check_viewport(view, self.device.limits())?;
        self.content.plan(view, None).map(|_| ())
    }

    /// Prepares a frame of `view` in slot `slot`. Applies the values that were set, writes what
    /// changed, and records copies of new textures. Call it outside of a render pass.
    ///
    /// The frame may be recorded once, several times or never, and its commands may be dropped. The
    /// commands of `prepare` run before those of the frame.
    /// Copies of a texture are recorded in every prepared frame until one of these frames has run,
    /// which the slot reads from a word that its commands write. So no texture is lost with a frame
    /// that was never submitted. A frame in flight beside others repeats their copies.
    ///
    /// A failed call records nothing, and the values that were set stay set: the next call tries
    /// them again.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for content that cannot be drawn, with the key `object.N...`; N
    /// counts objects in order. The error repeats until that content is mended or removed.
    /// [`ErrorKind::Content`] also for a viewport that the device does not have.
    /// [`ErrorKind::Usage`] for a missing slot, a view of the other depth order, or a missing
    /// target. Errors of Vulkan calls.
    ///
    /// # Safety
    /// The call writes to memory that the previous frame in `slot` read. Image copies, a fill of one
    /// word that marks them, a dispatch that places the copies of crowds, and barriers of these are
    /// recorded into `cmd`; the dispatch binds a compute pipeline and set 0. Resources that only the
    /// previous frame held are dropped; those that commands of `prepare` read live until the slot is
    /// prepared again after these have run.
    ///
    /// The caller must ensure that
    /// * `cmd` is recording, outside of a render pass, for a queue of the device's family;
    /// * commands that [`Renderer::record`] or [`Renderer::record_compute`] recorded for earlier frames
    ///   of `slot` have run, or will never be submitted. Commands that earlier calls of `prepare`
    ///   recorded for `slot` have run, or are in `cmd`, or will never be submitted;
    /// * command buffers of prepared frames are submitted to one queue, in the order of their
    ///   `prepare`.
    pub unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: usize,
        view: &View,
    ) -> Result<PreparedFrame> {
        let start = Instant::now();
        self.check(slot, view)?;
        let to = &mut self.slots[slot];
        let known = to.bound.as_ref().map(|bound| &bound.plan);
        let plan = self.content.plan(view, known)?;
        to.end_uploads()?;
        let compiled = self.device.pipelines.compiled.load(Ordering::Relaxed);
        let hides = self.hides;
        let stale = |bound: &BoundPlan| {
            let may_be_faster = !bound.faster.is_empty() && bound.compiled != compiled;
            let may_show = !hides && bound.hidden() > 0;
            !Arc::ptr_eq(&bound.plan, &plan) || may_be_faster || may_show
        };
        if to.named.is_none() || to.bound.as_ref().is_none_or(stale) {
            // The tables of the slot's last frame make room for those of this one.
            let before = to.bound.take();
            let is_written = before.is_some_and(|bound| Arc::ptr_eq(&bound.plan, &plan));
            let bound = self.bind(&plan)?;
            if !is_written {
                self.write(slot, &plan)?;
            }
            let to = &mut self.slots[slot];
            to.name(&bound.buffers.tables, self.content.target.as_ref())?;
            to.bound = Some(bound);
        }
        let to = &mut self.slots[slot];
        let snapshot = &plan.snapshot;
        let (output, lighting) = (&self.content.output, &self.content.lighting);
        let mut block = frame_block(view, output, lighting, snapshot.instances);
        block.picture = plan.frame.picture;
        let maps = snapshot.facts.shadow_maps.len();
        block.casters = caster_root(&plan.walks, view.eye, maps);
        if !plan.walks.nodes.is_empty() {
            block.eye = placed_eye(view, &plan.walks.grid);
        }
        to.write(SlotBuffer::Frame, 0, &block)?;
        to.serial += 1;
        // Last, so that a failed call records nothing.
        if self.slots[slot].placed > 0 {
            self.record_places(cmd, &self.slots[slot])?;
            self.slots[slot].keep();
        }
        let to = &mut self.slots[slot];
        to.record_uploads(cmd, &mut self.content.textures.uploads);
        Ok(PreparedFrame {
            renderer: self.content.objects.renderer,
            slot,
            serial: to.serial,
            reads_depths: to.compares_depths(),
            statistics: FrameStatistics {
                prepare_ms: start.elapsed().as_secs_f64() * 1e3,
                ..to.statistics()
            },
            recorded: AtomicU64::new(0),
        })
    }

    fn check(&self, slot: usize, view: &View) -> Result<()> {
        let output = &self.content.output;
        let slots = self.slots.len();
        let message = if slot >= slots {
            format!("slot {slot}; there are {slots}")
        } else if view.order != output.depth_order() {
            "the view's depth order is not the output's; give both the same".into()
        } else if view.parallel != self.content.is_parallel() {
            "parallel views go with an output of parallel depths, and no others".into()
        } else {
            check_viewport(view, self.device.limits())?;
            return output.check_target(self.content.target.as_ref());
        };
        Err(Error::new(ErrorKind::Usage, message))
    }

    /// Stores the tables of a plan, and finds the bindings of its steps. A step takes the fastest form
    /// of its pipeline that is compiled. If none is, the host has not asked for pipelines
    /// beforehand, and the fastest form is compiled.
    fn bind(&self, plan: &Arc<ViewPlan>) -> Result<BoundPlan> {
        let frame = &plan.frame;
        let parts = plan.objects.iter().zip(&frame.parts);
        let read = parts
            .flat_map(|(object, parts)| object.surfaces.iter().map(|surface| (surface, *parts)));
        let buffers = lock(&self.content.geometry)?.store(read)?;
        let pipelines = &self.device.pipelines;
        let own_vectors = self.device.chosen.constants().own_vectors as usize;
        let compiled = pipelines.compiled.load(Ordering::Relaxed);
        let mut steps = Vec::with_capacity(frame.steps.len());
        let mut faster = Vec::new();
        for step in &frame.steps {
            let planned = &plan.objects[step.object as usize];
            let object = &planned.object;
            let part = match step.kind {
                Kind::TileLists | Kind::TilePatches(_) | Kind::CulledTiles => Part::Patches,
                _ => Part::Tables,
            };
            let (mut variant, kind) = (step.variant, step.kind);
            let mut begin = 0;
            if variant.speciality.drawn != Drawn::Objects {
                let window = planned.window(part);
                if window.len() > own_vectors {
                    variant.speciality.drawn = Drawn::Objects;
                }
                begin = window.start;
            }
            let forms = variant.forms(kind, pipelines.specialities);
            let (mut pipeline, mut taken) = (None, forms[0]);
            for form in forms {
                if pipeline.is_none() {
                    (pipeline, taken) = (pipelines.known(form, kind, &self.owner)?, form);
                }
            }
            if pipeline.is_none() && !self.hides {
                taken = forms[0];
                pipeline = Some(pipelines.get(taken, kind, &self.owner)?);
            }
            if (pipeline.is_none() || taken != forms[0]) && !faster.contains(&(forms[0], kind)) {
                faster.push((forms[0], kind));
            }
            steps.push(BoundStep {
                compares_depths: pipeline.is_some()
                    && kind.draws_in_compute()
                    && taken.speciality.depths,
                pipeline,
                textures: object.derived.textures.clone(),
                offsets: [16 * begin, object.number * OBJECT_STRIDE],
            });
        }
        Ok(BoundPlan {
            plan: plan.clone(),
            steps,
            faster,
            compiled,
            buffers,
        })
    }

    fn write(&mut self, slot: usize, plan: &ViewPlan) -> Result<()> {
        let (view, snapshot) = (&plan.view, &plan.snapshot);
        let motion = self.content.output.planes().has_motion();
        let to = &mut self.slots[slot];
        let records = u64::from(snapshot.instances) * if motion { 2 } else { 1 };
        let bytes = records * size_of::<InstanceBlock>() as u64;
        let are_placed = to.write_walks(&plan.walks, bytes)?;
        // The host places few copies in less time than a dispatch takes, single ones for less than the
        // device would need in each pixel, and what lags.
        let is_placed = |(planned, path): (&PlannedObject, &DrawPath)| {
            let copies = planned.object.drawn().placements().len();
            let many = copies > 1 && snapshot.looks[&planned.object.look()] > MOST_PROXIES;
            *path == DrawPath::Walk && many && plan.precedence.is_empty()
        };
        let mut places = plan.objects.iter().zip(&plan.frame.paths);
        let places = places.any(is_placed);
        to.place(if places { records as u32 } else { 0 })?;
        let bytes = snapshot.number_count as u64 * u64::from(OBJECT_STRIDE);
        to.fit(SlotBuffer::Objects, bytes)?;
        to.write_plan(&plan.frame)?;
        let facts = plan.frame.outside.iter().zip(&plan.frame.paths);
        for (planned, (outside, path)) in plan.objects.iter().zip(facts) {
            let (object, number) = (&planned.object, planned.object.number);
            let drawn = object.drawn();
            let placements = drawn.placements();
            let at = number as usize * OBJECT_STRIDE as usize;
            to.write(SlotBuffer::Objects, at, &object_block(planned, *outside))?;
            if *path == DrawPath::Walk {
                let at = at + size_of::<ObjectBlock>();
                to.write(SlotBuffer::Objects, at, &level_tables(planned))?;
            }
            let placed = is_placed((planned, path));
            if placed && are_placed && !motion {
                continue;
            }
            let (first, count) = (object.instances.start, placements.len());
            if placed && !are_placed {
                let block = |copy: usize| placed_block(&placements[copy], number);
                to.write_instances(first, count, block)?;
            } else if !placed {
                let starts =
                    |s: &Arc<OffsetSurface>| [Part::Patches, Part::Tables].map(|p| s.start(p));
                let starts: Vec<_> = planned.surfaces.iter().map(starts).collect();
                to.write_instances(first, count, |copy| {
                    let mut block = instance_block(drawn, &placements[copy], number, view);
                    block.lag = plan.precedence.lag(first + copy as u32, &block, view);
                    let levels = planned.levels.as_ref();
                    let starts = starts.get(levels.map_or(0, |levels| levels.of_block(&block)));
                    [block.listed, block.table] = *starts.unwrap_or(&[0; 2]);
                    block
                })?;
            }
            if motion {
                let last = |copy| last_copy(object, copy, view);
                to.write_instances(snapshot.instances + first, count, last)?;
            }
        }
        to.walks = Some(plan.walks.clone());
        Ok(())
    }
}
