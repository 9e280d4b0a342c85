//! The commands of a frame, translated from the steps of its plan. The number of commands follows
//! the pipelines and texture sets in use, and the size of the picture.

use super::Renderer;
use super::prepare::PreparedFrame;
use super::slot::{BoundPlan, BoundStep, FrameSlot};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::usage::Usage;
use crate::plan::{Call, IndexedDraw, Step};
use crate::shader::Pushed;
use ash::vk;

/// Bytes of one indirect draw.
const DRAW_BYTES: u32 = size_of::<IndexedDraw>() as u32;

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
    /// * `cmd` is recording, within a pass that is compatible with the output, with the view's
    ///   viewport and a scissor set;
    /// * the renderer lives until the commands have run, and the frame's slot is not prepared again
    ///   before that.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer, frame: &PreparedFrame) -> Result<()> {
        let (slot, bound) = self.frame(frame)?;
        let raw = &self.device.raw;
        let point = vk::PipelineBindPoint::GRAPHICS;
        let large_points = self.device.chosen.constants().large_points;
        let vertices = if large_points { 1 } else { 6 };
        // SAFETY: `cmd` is recording within a render pass; all bound objects live as long as the
        // caller promised.
        unsafe {
            let indices = bound.buffers.indices.raw;
            raw.cmd_bind_index_buffer(cmd, indices, 0, vk::IndexType::UINT32);
        }
        for (n, step) in bound.plan.frame.steps.iter().enumerate() {
            self.with_step(cmd, point, slot, bound, n, || match &step.call {
                // SAFETY: as the caller promised.
                Call::Draws(range) => unsafe {
                    self.draw(cmd, slot, bound, range.start, range.end);
                },
                Call::Quads(range) => {
                    let count = vertices * (range.end - range.start);
                    // SAFETY: as the caller promised.
                    unsafe { raw.cmd_draw(cmd, count, 1, vertices * range.start, 0) };
                }
                Call::Tiles(range) => {
                    let count = 6 * (range.end - range.start);
                    // SAFETY: as the caller promised.
                    unsafe { raw.cmd_draw(cmd, count, 1, 6 * range.start, 0) };
                }
                Call::IndirectTiles(word) => {
                    let at = 4 * u64::from(*word);
                    // SAFETY: as the caller promised; the draw is within the buffer.
                    unsafe { raw.cmd_draw_indirect(cmd, slot.bins.raw, at, 1, 0) };
                }
                Call::Dispatch(..) | Call::Indirect(..) | Call::Groups(..) => {}
            })?;
        }
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
        let (slot, bound) = self.frame(frame)?;
        let raw = &self.device.raw;
        let plan = &bound.plan.frame;
        let barrier = |from, to| slot.bins.barrier(cmd, from, to);
        if plan.bin_head_words > 0 {
            let bytes = 4 * u64::from(plan.bin_head_words);
            // SAFETY: `cmd` is recording outside of a pass, and the words are within the buffer.
            unsafe { raw.cmd_fill_buffer(cmd, slot.bins.raw, 0, bytes, 0) };
            barrier(Usage::TransferWrite, Usage::ComputeWrite);
        }
        let mut phase = plan.steps.first().map_or(0, |step| step.phase);
        for (n, step) in plan.steps.iter().enumerate() {
            if step.phase != phase {
                match phase {
                    0 => barrier(Usage::ComputeWrite, Usage::TileRead),
                    // The next phase reads the depths that were written before.
                    _ => self.wait_for_writes(cmd),
                }
                phase = step.phase;
            }
            self.with_step(cmd, vk::PipelineBindPoint::COMPUTE, slot, bound, n, || {
                // SAFETY: `cmd` is recording, outside a render pass; all bound objects live as long
                // as the caller promised.
                unsafe { self.dispatch(cmd, slot, step) };
            })?;
        }
        Ok(())
    }

    /// Records the dispatches that list the crowds of a prepared slot.
    ///
    /// # Safety
    /// As for [`Renderer::prepare`].
    pub(super) unsafe fn record_lists(&self, cmd: vk::CommandBuffer, slot: usize) -> Result<()> {
        let slot = &self.slots[slot];
        let Some(bound) = &slot.bound else {
            return Ok(());
        };
        let Some(crowds) = &bound.plan.frame.crowds else {
            return Ok(());
        };
        let [first, words] = crowds.zeroed.map(|words| 4 * u64::from(words));
        let raw = &self.device.raw;
        // The slot may have been prepared in the same commands before.
        self.wait_for_lists(cmd);
        // SAFETY: `cmd` is recording outside of a pass, and the words are within the buffer.
        unsafe { raw.cmd_fill_buffer(cmd, slot.bins.raw, first, words, 0) };
        self.wait_for_lists(cmd);
        let textures = bound.steps.last().map(|step| &step.textures);
        let textures = textures.map_or(vk::DescriptorSet::null(), |t| t.set);
        for (step, pipeline) in crowds.steps.iter().zip(&bound.crowd_pipelines) {
            self.device.labelled(cmd, step.kind.label(), || {
                let point = vk::PipelineBindPoint::COMPUTE;
                self.bind_sets(cmd, point, slot, *pipeline, textures, &[0; 2])?;
                // SAFETY: as the caller promised.
                unsafe { self.dispatch(cmd, slot, step) };
                self.wait_for_lists(cmd);
                Ok(())
            })?;
        }
        Ok(())
    }

    /// Records a barrier between two steps that list crowds, or between the last one and what draws
    /// them.
    fn wait_for_lists(&self, cmd: vk::CommandBuffer) {
        use vk::{AccessFlags as A, PipelineStageFlags as S};
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(A::SHADER_WRITE | A::TRANSFER_WRITE)
            .dst_access_mask(
                A::SHADER_READ | A::SHADER_WRITE | A::TRANSFER_WRITE | A::INDIRECT_COMMAND_READ,
            );
        let stages = S::COMPUTE_SHADER
            | S::TRANSFER
            | S::DRAW_INDIRECT
            | S::VERTEX_SHADER
            | S::FRAGMENT_SHADER;
        let none = vk::DependencyFlags::empty();
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording, outside a render pass.
        unsafe { raw.cmd_pipeline_barrier(cmd, stages, stages, none, &[barrier], &[], &[]) };
    }

    /// The slot of a frame, and its bindings.
    pub(in crate::gpu) fn frame(&self, frame: &PreparedFrame) -> Result<(&FrameSlot, &BoundPlan)> {
        let slot = self.slots.get(frame.slot);
        let own = |slot: &&FrameSlot| {
            frame.renderer == self.content.objects.renderer && slot.serial == frame.serial
        };
        slot.filter(own)
            .and_then(|slot| Some((slot, slot.bound.as_ref()?)))
            .ok_or_else(|| {
                Error::new(
                    ErrorKind::Usage,
                    "the frame is another renderer's, or its slot was prepared again; record what prepare returned last",
                )
            })
    }

    /// Records draws of a plan, many by one indirect command if the device supports that.
    unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        bound: &BoundPlan,
        first: u32,
        end: u32,
    ) {
        let raw = &self.device.raw;
        let most = self.device.chosen.most_draws();
        if most == 0 {
            let draws = &bound.plan.frame.draws[first as usize..end as usize];
            for &[indices, instances, first, _, instance] in draws {
                // SAFETY: as the caller promised.
                unsafe { raw.cmd_draw_indexed(cmd, indices, instances, first, 0, instance) };
            }
            return;
        }
        for start in (first..end).step_by(most as usize) {
            let count = most.min(end - start);
            let at = u64::from(start * DRAW_BYTES);
            // SAFETY: as the caller promised; the draws are within the buffer.
            unsafe {
                raw.cmd_draw_indexed_indirect(cmd, slot.draws.raw, at, count, DRAW_BYTES);
            }
        }
    }

    unsafe fn dispatch(&self, cmd: vk::CommandBuffer, slot: &FrameSlot, step: &Step) {
        let raw = &self.device.raw;
        // SAFETY: as the caller promised; heads are within the buffer.
        unsafe {
            match &step.call {
                Call::Dispatch(groups, pushed) => {
                    self.push(cmd, pushed);
                    raw.cmd_dispatch(cmd, *groups, 1, 1);
                }
                Call::Indirect(head, pushed) => {
                    self.push(cmd, pushed);
                    raw.cmd_dispatch_indirect(cmd, slot.bins.raw, 4 * u64::from(*head));
                }
                Call::Groups([x, y, z], pushed) => {
                    self.push(cmd, pushed);
                    raw.cmd_dispatch(cmd, *x, *y, *z);
                }
                Call::Draws(_) | Call::Quads(_) | Call::Tiles(_) | Call::IndirectTiles(_) => {}
            }
        }
    }

    /// Records a barrier between two dispatches. The second dispatch reads, or writes again, the
    /// results of the first.
    pub(in crate::gpu) fn wait_for_writes(&self, cmd: vk::CommandBuffer) {
        let access = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::SHADER_WRITE)
            .dst_access_mask(access);
        let stage = vk::PipelineStageFlags::COMPUTE_SHADER;
        let none = vk::DependencyFlags::empty();
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording, outside a render pass.
        unsafe { raw.cmd_pipeline_barrier(cmd, stage, stage, none, &[barrier], &[], &[]) };
    }

    pub(in crate::gpu) fn push(&self, cmd: vk::CommandBuffer, pushed: &Pushed) {
        let stage = vk::ShaderStageFlags::COMPUTE;
        let bytes = bytemuck::bytes_of(pushed);
        let raw = &self.device.raw;
        let layout = self.pipeline_layout().unwrap_or_default();
        // SAFETY: `cmd` is recording.
        unsafe { raw.cmd_push_constants(cmd, layout, stage, 0, bytes) };
    }

    /// Binds the pipeline and the sets of a step and records its commands under a label. A step
    /// whose pipeline is not compiled is left out.
    fn with_step(
        &self,
        cmd: vk::CommandBuffer,
        point: vk::PipelineBindPoint,
        slot: &FrameSlot,
        bound: &BoundPlan,
        step: usize,
        commands: impl FnOnce(),
    ) -> Result<()> {
        let BoundStep {
            pipeline: Some(pipeline),
            textures,
            offsets,
        } = &bound.steps[step]
        else {
            return Ok(());
        };
        let label = bound.plan.frame.steps[step].kind.label();
        self.device.labelled(cmd, label, || {
            self.bind_sets(cmd, point, slot, *pipeline, textures.set, offsets)?;
            commands();
            Ok(())
        })
    }

    pub(in crate::gpu) fn bind_sets(
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
