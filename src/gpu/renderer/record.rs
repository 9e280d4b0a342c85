//! The commands of a frame, translated from the steps of its plan. The number of commands follows
//! the pipelines and texture sets in use, and the size of the picture.

use super::Renderer;
use super::prepare::PreparedFrame;
use super::prewarm::PLACE;
use super::slot::{BoundPlan, BoundStep, FrameSlot, SlotBuffer};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::usage::Usage;
use crate::plan::{Call, IndexedDraw, Step};
use crate::shader::generated::{GROUP_PIXELS, MOST_GROUPS};
use crate::shader::{BinTile, Pushed};
use ash::vk;
use std::ops::Range;
use std::time::Instant;

const DRAW_BYTES: u32 = size_of::<IndexedDraw>() as u32;
/// Instances that a work group places.
const PLACES: u32 = GROUP_PIXELS * GROUP_PIXELS;
/// Bytes of the head of a bin, as of its tiles.
const HEAD_BYTES: u64 = size_of::<BinTile>() as u64;

/// A frame and the commands that it is recorded into.
#[derive(Clone, Copy)]
struct Recording<'a> {
    cmd: vk::CommandBuffer,
    slot: &'a FrameSlot,
    bound: &'a BoundPlan,
}

impl Renderer {
    /// Records the draws of a prepared frame, within a pass of the output's formats.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a frame of another renderer, or of a slot that was prepared again.
    /// Nothing is recorded then.
    ///
    /// # Safety
    /// The call binds pipelines, descriptor sets 0 to 2 and an index buffer, and draws. Viewport
    /// and scissor are dynamic and are not set.
    ///
    /// The caller must ensure that
    /// * `cmd` is recording, within a pass that is compatible with the output and has a view mask of
    ///   0, with the view's viewport and a scissor set;
    /// * the renderer lives until the commands have run, and the frame's slot is not prepared again
    ///   before that.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer, frame: &PreparedFrame) -> Result<()> {
        let start = Instant::now();
        let (slot, bound) = self.frame(frame)?;
        // SAFETY: `cmd` is recording within a render pass; the buffer lives as long as the caller
        // promised.
        unsafe {
            let indices = bound.buffers.indices.raw;
            (self.device.raw).cmd_bind_index_buffer(cmd, indices, 0, vk::IndexType::UINT32);
        }
        let to = Recording { cmd, slot, bound };
        for (step, own) in bound.plan.frame.steps.iter().zip(&bound.steps) {
            // SAFETY: as the caller promised.
            unsafe { self.step(to, step, own)? };
        }
        frame.end_recording(start);
        Ok(())
    }

    /// Records the dispatches of a prepared frame, outside of a pass, into a cleared target.
    ///
    /// # Errors
    /// Same as [`Renderer::record`].
    ///
    /// # Safety
    /// The call binds compute pipelines and sets, dispatches, and records barriers between its own
    /// dispatches. No barrier is recorded before the first write to the target, and none after the
    /// last.
    ///
    /// The caller must ensure that
    /// * `cmd` is recording, outside of a pass; earlier writes to the target are available to
    ///   compute shaders;
    /// * the renderer lives until the commands have run, and the frame's slot is not prepared again
    ///   before that.
    pub unsafe fn record_compute(
        &self,
        cmd: vk::CommandBuffer,
        frame: &PreparedFrame,
    ) -> Result<()> {
        let start = Instant::now();
        let (slot, bound) = self.frame(frame)?;
        let to = Recording { cmd, slot, bound };
        let plan = &bound.plan.frame;
        let bins = slot.buffer(SlotBuffer::Bins);
        if plan.bin_heads > 0 {
            let bytes = HEAD_BYTES * u64::from(plan.bin_heads);
            // The frame may have been recorded before.
            bins.barrier(cmd, Usage::TileRead, Usage::TransferWrite);
            // SAFETY: `cmd` is recording outside of a pass, and the words are within the buffer.
            unsafe { self.device.raw.cmd_fill_buffer(cmd, bins.raw, 0, bytes, 0) };
            bins.barrier(cmd, Usage::TransferWrite, Usage::ComputeWrite);
        }
        let mut phase = plan.steps.first().map_or(0, |step| step.phase);
        for (step, own) in plan.steps.iter().zip(&bound.steps) {
            if step.phase != phase {
                match phase {
                    0 => bins.barrier(cmd, Usage::ComputeWrite, Usage::TileRead),
                    // The next phase reads the depths that were written before.
                    _ => self.wait_for_writes(cmd),
                }
                phase = step.phase;
            }
            // SAFETY: as the caller promised.
            unsafe { self.step(to, step, own)? };
        }
        frame.end_recording(start);
        Ok(())
    }

    /// Records a barrier between two dispatches. The second dispatch reads, or writes again, the
    /// results of the first.
    pub(super) fn wait_for_writes(&self, cmd: vk::CommandBuffer) {
        let (read, write) = (vk::AccessFlags::SHADER_READ, vk::AccessFlags::SHADER_WRITE);
        let barrier = vk::MemoryBarrier::default();
        let barrier = [barrier.src_access_mask(write).dst_access_mask(read | write)];
        let stage = vk::PipelineStageFlags::COMPUTE_SHADER;
        let none = vk::DependencyFlags::empty();
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording, outside a render pass.
        unsafe { raw.cmd_pipeline_barrier(cmd, stage, stage, none, &barrier, &[], &[]) };
    }

    pub(super) fn frame(&self, frame: &PreparedFrame) -> Result<(&FrameSlot, &BoundPlan)> {
        let slot = self.slots.get(frame.slot).filter(|slot| {
            (frame.renderer, frame.serial) == (self.content.objects.renderer, slot.serial)
        });
        let message = match slot.map(|slot| (slot, &slot.bound)) {
            Some((slot, Some(bound))) => return Ok((slot, bound)),
            Some((_, None)) => {
                "a later preparation of the frame's slot failed after it had begun to write; prepare the slot again"
            }
            None => {
                "the frame is another renderer's, or its slot was prepared again; record what prepare returned last"
            }
        };
        Err(Error::new(ErrorKind::Usage, message))
    }

    /// Records the command of a step.
    ///
    /// # Safety
    /// As for [`Renderer::record`] or [`Renderer::record_compute`], whichever takes the call.
    unsafe fn call(&self, to: Recording, step: &Step) {
        let (raw, cmd) = (&self.device.raw, to.cmd);
        let bins = to.slot.buffer(SlotBuffer::Bins).raw;
        // SAFETY: as the caller promised; draws and heads are within their buffers.
        unsafe {
            match &step.call {
                Call::Draws(range) => self.draw(to, range.clone()),
                Call::Walk(points, root) => {
                    let large_points = self.device.chosen.constants().large_points;
                    // Without large points two triangles cover the picture.
                    let corners = if large_points { points.clone() } else { 0..6 };
                    raw.cmd_draw(cmd, corners.len() as u32, 1, corners.start, *root);
                }
                Call::Indirect(head, pushed) => {
                    self.push(cmd, pushed);
                    raw.cmd_dispatch_indirect(cmd, bins, HEAD_BYTES * u64::from(*head));
                }
                Call::Groups(groups, pushed) => {
                    self.push(cmd, pushed);
                    raw.cmd_dispatch(cmd, *groups, 1, 1);
                }
            }
        }
    }

    /// Records the dispatches that place a slot's copies in its view, before they are read.
    pub(super) fn record_places(&self, cmd: vk::CommandBuffer, slot: &FrameSlot) -> Result<()> {
        let (variant, kind) = PLACE;
        let pipeline = self.device.pipelines.get(variant, kind, &self.owner)?;
        let placed = slot.buffer(SlotBuffer::Placed);
        // An earlier preparation in these commands may have placed them.
        placed.barrier(cmd, Usage::ComputeWrite, Usage::ComputeWrite);
        self.device.labelled(cmd, kind.label(), || {
            let point = vk::PipelineBindPoint::COMPUTE;
            let layout = self.pipeline_layout()?;
            let raw = &self.device.raw;
            // SAFETY: `cmd` is recording; the set fits the layout, and the slot keeps it.
            unsafe {
                raw.cmd_bind_pipeline(cmd, point, pipeline);
                raw.cmd_bind_descriptor_sets(cmd, point, layout, 0, &[slot.frame_set], &[0; 2]);
            }
            for first in (0..slot.placed).step_by((MOST_GROUPS * PLACES) as usize) {
                let groups = (slot.placed - first).div_ceil(PLACES).min(MOST_GROUPS);
                let pushed = Pushed {
                    first,
                    placed: slot.placed,
                    ..Pushed::default()
                };
                self.push(cmd, &pushed);
                // SAFETY: `cmd` is recording, outside of a pass.
                unsafe { raw.cmd_dispatch(cmd, groups, 1, 1) };
            }
            Ok(())
        })?;
        placed.barrier(cmd, Usage::ComputeWrite, Usage::ShaderRead);
        Ok(())
    }

    /// Records draws of a plan, many by one indirect command if the device supports that.
    unsafe fn draw(&self, to: Recording, range: Range<u32>) {
        let (raw, cmd) = (&self.device.raw, to.cmd);
        let most = self.device.chosen.most_draws();
        if most == 0 {
            let draws = &to.bound.plan.frame.draws[range.start as usize..range.end as usize];
            for &[indices, instances, first, _, instance] in draws {
                // SAFETY: as the caller promised.
                unsafe { raw.cmd_draw_indexed(cmd, indices, instances, first, 0, instance) };
            }
            return;
        }
        let draws = to.slot.buffer(SlotBuffer::Draws).raw;
        for start in range.clone().step_by(most as usize) {
            let count = most.min(range.end - start);
            let at = u64::from(start * DRAW_BYTES);
            // SAFETY: as the caller promised; the draws are within the buffer.
            unsafe { raw.cmd_draw_indexed_indirect(cmd, draws, at, count, DRAW_BYTES) };
        }
    }

    pub(super) fn push(&self, cmd: vk::CommandBuffer, pushed: &Pushed) {
        let stage = vk::ShaderStageFlags::COMPUTE;
        let bytes = bytemuck::bytes_of(pushed);
        let raw = &self.device.raw;
        let layout = self.pipeline_layout().unwrap_or_default();
        // SAFETY: `cmd` is recording.
        unsafe { raw.cmd_push_constants(cmd, layout, stage, 0, bytes) };
    }

    /// Binds the pipeline and the sets of a step and records its command under a label. A step
    /// whose pipeline is not compiled is left out.
    ///
    /// # Safety
    /// As for [`Renderer::record`] or [`Renderer::record_compute`].
    unsafe fn step(&self, to: Recording, step: &Step, own: &BoundStep) -> Result<()> {
        let (cmd, textures) = (to.cmd, own.textures.set);
        let Some(pipeline) = own.pipeline else {
            return Ok(());
        };
        let point = match step.variant.vertices(step.kind) {
            Some(_) => vk::PipelineBindPoint::GRAPHICS,
            None => vk::PipelineBindPoint::COMPUTE,
        };
        self.device.labelled(cmd, step.kind.label(), || {
            self.bind_sets(cmd, point, to.slot, pipeline, textures, &own.offsets)?;
            // SAFETY: as the caller promised.
            unsafe { self.call(to, step) };
            Ok(())
        })
    }

    pub(super) fn bind_sets(
        &self,
        cmd: vk::CommandBuffer,
        point: vk::PipelineBindPoint,
        slot: &FrameSlot,
        pipeline: vk::Pipeline,
        textures: vk::DescriptorSet,
        offsets: &[u32; 2],
    ) -> Result<()> {
        let layout = self.pipeline_layout()?;
        let sets = [slot.frame_set, textures, slot.target_set];
        let raw = &self.device.raw;
        // SAFETY: the sets fit the layout, and all objects that they name live as long as the
        // caller of `record` promised.
        unsafe {
            raw.cmd_bind_pipeline(cmd, point, pipeline);
            raw.cmd_bind_descriptor_sets(cmd, point, layout, 0, &sets, offsets);
        }
        Ok(())
    }
}
