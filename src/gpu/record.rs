//! The commands of a frame.

use super::bins::Rectangle;
use super::hulls;
use super::renderer::Renderer;
use super::usage::{Usage, buffer_barrier};
use super::work::{Batch, Tiles, Work};
use crate::settings::DrawStage;
use crate::shader::generated::{BIN_PIXELS, GROUP_PIXELS};
use ash::vk;

impl Renderer {
    /// Records a whole frame.
    pub(super) fn record(&self, cmd: vk::CommandBuffer) {
        self.clock.start(cmd);
        // Depths are compared where there is more than one draw or dispatch.
        let several = |b: &Batch| matches!(&b.work, Work::Beams { copies, .. } if copies.len() > 1);
        let compared = self.batches.len() > 1 || self.batches.iter().any(several);
        self.target.clear(cmd, self.background, compared);
        if self.settings.stage == DrawStage::Compute {
            self.record_compute(cmd);
        } else {
            self.target
                .begin(cmd, self.pipelines.render_pass, self.background);
            self.record_fragment(cmd);
            // SAFETY: the render pass was begun above.
            unsafe { self.device.raw.cmd_end_render_pass(cmd) };
        }
        self.clock.stop(cmd);
    }

    /// Draws every batch's boxes or meshes, within a render pass.
    fn record_fragment(&self, cmd: vk::CommandBuffer) {
        if let Some(meshes) = &self.meshes {
            for &number in meshes.order() {
                let batch = &self.batches[number];
                self.bind(
                    cmd,
                    batch,
                    vk::PipelineBindPoint::GRAPHICS,
                    batch.block_offset,
                );
                meshes.draw(cmd, number, &batch.instances);
            }
            return;
        }
        for batch in &self.batches {
            self.bind(
                cmd,
                batch,
                vk::PipelineBindPoint::GRAPHICS,
                batch.block_offset,
            );
            let count = batch.instances.end - batch.instances.start;
            let first = batch.instances.start;
            let raw = &self.device.raw;
            // SAFETY: `cmd` is recording within a render pass; all that is bound lives as long as `self`.
            unsafe {
                if let Work::Hull { bands } = &batch.work {
                    let kind = vk::IndexType::UINT32;
                    raw.cmd_bind_index_buffer(cmd, self.buffers.corners.raw, 0, kind);
                    for run in bands {
                        let (corners, begin) = (
                            hulls::corners(run.end - run.start),
                            hulls::corners(run.start),
                        );
                        raw.cmd_draw_indexed(cmd, corners, count, begin, 0, first);
                    }
                } else {
                    raw.cmd_draw(cmd, 14, count, 0, first);
                }
            };
        }
    }

    /// Traces every batch's bins.
    fn record_compute(&self, cmd: vk::CommandBuffer) {
        let raw = &self.device.raw;
        let groups = BIN_PIXELS / GROUP_PIXELS;
        let most = self.device.limits.max_compute_work_group_count[1];
        let mut first = true;
        // What is next reads the depths that were written before.
        let mut after_the_last = || {
            if !std::mem::take(&mut first) {
                let access = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
                let barrier = vk::MemoryBarrier::default()
                    .src_access_mask(vk::AccessFlags::SHADER_WRITE)
                    .dst_access_mask(access);
                let stage = vk::PipelineStageFlags::COMPUTE_SHADER;
                let none = vk::DependencyFlags::empty();
                // SAFETY: `cmd` is recording, outside a render pass.
                unsafe { raw.cmd_pipeline_barrier(cmd, stage, stage, none, &[barrier], &[], &[]) };
            }
        };
        for batch in &self.batches {
            let point = vk::PipelineBindPoint::COMPUTE;
            match &batch.work {
                Work::Beams { list, copies } => {
                    for tiles in copies {
                        after_the_last();
                        self.bind(cmd, batch, point, tiles.block_offset);
                        self.record_beams(cmd, batch, *list, tiles);
                    }
                }
                Work::Rectangle(Rectangle { low, high }) => {
                    after_the_last();
                    self.bind(cmd, batch, point, batch.block_offset);
                    let groups = [high.0 - low.0 + 1, high.1 - low.1 + 1];
                    self.dispatch(cmd, [0, low.0 | low.1 << 16], groups);
                }
                Work::Bins(bins) => {
                    after_the_last();
                    self.bind(cmd, batch, point, batch.block_offset);
                    for start in bins.clone().step_by(most.max(1) as usize) {
                        let count = (bins.end - start).min(most);
                        self.dispatch(cmd, [start, 0], [groups * groups, count]);
                    }
                }
                Work::Nothing | Work::Box | Work::Hull { .. } | Work::Mesh => {}
            }
        }
    }

    /// Lists the tiles that a single instance's rays may meet, then traces those.
    fn record_beams(
        &self,
        cmd: vk::CommandBuffer,
        batch: &Batch,
        list: vk::Pipeline,
        tiles: &Tiles,
    ) {
        let (at, Rectangle { low, high }) = (tiles.at, tiles.rectangle);
        let raw = &self.device.raw;
        let words = &self.buffers.bins;
        let none: [u32; 4] = [0, 1, 1, 0];
        let pushed = [at, low.0 | low.1 << 16];
        let groups = |a: u32, b: u32| (b - a + 1).div_ceil(GROUP_PIXELS);
        let (point, stage) = (
            vk::PipelineBindPoint::COMPUTE,
            vk::ShaderStageFlags::COMPUTE,
        );
        buffer_barrier(
            &self.device,
            cmd,
            words,
            Usage::TileRead,
            Usage::TransferWrite,
        );
        // SAFETY: `cmd` is recording, outside a render pass; the list's words lie within the buffer; all that is bound lives as
        // long as `self`, and both pipelines have one layout.
        unsafe {
            raw.cmd_update_buffer(cmd, words.raw, 4 * u64::from(at), bytemuck::bytes_of(&none));
            buffer_barrier(
                &self.device,
                cmd,
                words,
                Usage::TransferWrite,
                Usage::ComputeWrite,
            );
            raw.cmd_bind_pipeline(cmd, point, list);
            let bytes = bytemuck::bytes_of(&pushed);
            raw.cmd_push_constants(cmd, self.pipelines.layout, stage, 0, bytes);
            raw.cmd_dispatch(cmd, groups(low.0, high.0), groups(low.1, high.1), 1);
            buffer_barrier(
                &self.device,
                cmd,
                words,
                Usage::ComputeWrite,
                Usage::TileRead,
            );
            raw.cmd_bind_pipeline(cmd, point, batch.pipeline);
            raw.cmd_dispatch_indirect(cmd, words.raw, 4 * u64::from(at));
        }
    }

    /// `pushed` as in `bins.glsl`.
    fn dispatch(&self, cmd: vk::CommandBuffer, pushed: [u32; 2], groups: [u32; 2]) {
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording, outside a render pass; all that is bound lives as long as `self`.
        unsafe {
            let stage = vk::ShaderStageFlags::COMPUTE;
            let bytes = bytemuck::bytes_of(&pushed);
            raw.cmd_push_constants(cmd, self.pipelines.layout, stage, 0, bytes);
            raw.cmd_dispatch(cmd, groups[0], groups[1], 1);
        }
    }

    /// Binds a batch's pipeline and sets, and the block at `block_offset`.
    fn bind(
        &self,
        cmd: vk::CommandBuffer,
        batch: &Batch,
        point: vk::PipelineBindPoint,
        block_offset: u32,
    ) {
        let sets = [
            self.descriptors.frame,
            batch.textures,
            self.descriptors.target,
        ];
        // SAFETY: the sets fit the layout, and all they name lives as long as `self`.
        unsafe {
            self.device
                .raw
                .cmd_bind_pipeline(cmd, point, batch.pipeline);
            self.device.raw.cmd_bind_descriptor_sets(
                cmd,
                point,
                self.pipelines.layout,
                0,
                &sets,
                &[block_offset, batch.tables_offset],
            );
        }
    }
}
