//! The commands of a frame. Recording neither fails nor changes anything.

use super::bins::{Rectangle, Shown};
use super::entry::Entry;
use super::frame_slot::FrameSlot;
use super::output::Output;
use super::pipelines::PUSHED;
use super::plan::{Tiles, Work, listed_tiles};
use super::proxy_hull::{self, SIDE_VERTICES};
use super::renderer::Renderer;
use super::usage::{Usage, buffer_barrier};
use crate::shader::generated::{GROUP_PIXELS, TILE_LISTS};
use ash::vk;
use std::ops::Range;

/// What is pushed for a dispatch: `Pushed` of `beams.glsl`.
type Pushed = [u32; PUSHED as usize];

impl Renderer {
    /// Records the draws of the frame that was prepared for `slot`, within a pass of the output's
    /// formats. A slot that is not there records nothing.
    ///
    /// # Safety
    /// This call binds pipelines, descriptor sets 0 to 2 and an index buffer, and draws. It sets
    /// neither viewport nor scissor, which are dynamic.
    ///
    /// The caller must see to it that
    /// * [`Renderer::prepare`] was called for `slot` since its last frame, and nothing was added or
    ///   removed in between;
    /// * `cmd` is recording, within a pass that is compatible with the output, with the view's
    ///   viewport and a scissor set;
    /// * the renderer lives, and `slot` is not prepared again, until the commands have run.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer, slot: usize) {
        let Some(slot) = self.frames.get(slot) else {
            return;
        };
        let raw = &self.device.raw;
        for (&number, entry) in self.order.iter().zip(self.ordered()) {
            let Some(work) = &entry.draw.work else {
                continue;
            };
            let first_drawn = match work {
                Work::Hull { cut: true, .. } => entry.draw.sides[0],
                _ => entry.draw.pipeline,
            };
            self.bind(cmd, slot, entry, first_drawn, number);
            let first = entry.instances.start;
            let count = entry.instances.end - first;
            // SAFETY: `cmd` is recording within a render pass; all that is bound lives as long as
            // the caller promised.
            unsafe {
                match work {
                    Work::Hull { frusta, cut } => {
                        if *cut {
                            let point = vk::PipelineBindPoint::GRAPHICS;
                            raw.cmd_draw(cmd, SIDE_VERTICES, count, 0, first);
                            raw.cmd_bind_pipeline(cmd, point, entry.draw.sides[1]);
                            // Beside what is solid, left and right of it.
                            raw.cmd_draw(cmd, 2 * SIDE_VERTICES, count, 0, first);
                            raw.cmd_bind_pipeline(cmd, point, entry.draw.pipeline);
                        }
                        let kind = vk::IndexType::UINT32;
                        raw.cmd_bind_index_buffer(cmd, self.corners.raw, 0, kind);
                        for run in frusta {
                            let corners = proxy_hull::corners(run.end - run.start);
                            let begin = proxy_hull::corners(run.start);
                            raw.cmd_draw_indexed(cmd, corners, count, begin, 0, first);
                        }
                    }
                    Work::Box => raw.cmd_draw(cmd, 14, count, 0, first),
                    Work::Bins(shown) => {
                        // Vertices of a square.
                        let n = if self.device.constants.large_points {
                            1
                        } else {
                            6
                        };
                        let draw = |squares: &Range<u32>| {
                            let count = squares.end - squares.start;
                            raw.cmd_draw(cmd, n * count, 1, n * squares.start, 0);
                        };
                        draw(&shown.spots);
                        if !shown.range.is_empty() {
                            let point = vk::PipelineBindPoint::GRAPHICS;
                            raw.cmd_bind_pipeline(cmd, point, entry.draw.bins);
                            draw(&shown.range);
                        }
                    }
                    _ => {}
                }
            }
        }
    }

    /// Records the dispatches of the frame that was prepared for `slot`, outside of a pass, into a
    /// target that was cleared.
    ///
    /// # Safety
    /// This call binds compute pipelines and sets, dispatches, and records barriers between its own
    /// dispatches. It records none before its first and after its last write.
    ///
    /// The caller must see to it that
    /// * `prepare` was called for `slot` since its last frame, and nothing was added or removed in
    ///   between;
    /// * `cmd` is recording, outside of a pass; writes to the target before are made available to
    ///   compute shaders;
    /// * the renderer lives, and `slot` is not prepared again, until the commands have run.
    pub unsafe fn record_compute(&self, cmd: vk::CommandBuffer, slot: usize) {
        let Some(slot) = self.frames.get(slot) else {
            return;
        };
        let most = self.device.limits.max_compute_work_group_count[1];
        self.list_alone(cmd, slot);
        let mut first = true;
        // What is next reads the depths that were written before.
        let mut after_the_last = || {
            if !std::mem::take(&mut first) {
                self.wait_for_writes(cmd);
            }
        };
        for (&number, entry) in self.order.iter().zip(self.ordered()) {
            match &entry.draw.work {
                Some(Work::Beams { copies, .. }) => {
                    for tiles in copies {
                        after_the_last();
                        self.record_beams(cmd, slot, entry, number, tiles);
                    }
                }
                Some(Work::Rectangle(Rectangle { low, high })) => {
                    after_the_last();
                    self.bind(cmd, slot, entry, entry.draw.pipeline, number);
                    let groups = [high.0 - low.0 + 1, high.1 - low.1 + 1];
                    self.dispatch(cmd, [0, low.0 | low.1 << 16, 0, 0], groups);
                }
                Some(Work::Bins(shown)) => {
                    if !shown.alone.is_empty() {
                        after_the_last();
                        self.record_alone(cmd, slot, entry, number, shown);
                    }
                    let range = &shown.range;
                    if !range.is_empty() {
                        after_the_last();
                        self.bind(cmd, slot, entry, entry.draw.pipeline, number);
                    }
                    for start in range.clone().step_by(most.max(1) as usize) {
                        let count = (range.end - start).min(most);
                        self.dispatch(cmd, [start, 0, 0, 0], [1, count]);
                    }
                }
                Some(Work::Nothing | Work::Box | Work::Hull { .. }) | None => {}
            }
        }
    }

    /// Whether compute compares depths: there is more than one dispatch, or they are read back.
    pub(crate) fn compares_depths(&self) -> bool {
        let several = |e: &Entry| match &e.draw.work {
            Some(Work::Beams { copies, .. }) => copies.len() > 1,
            Some(Work::Bins(shown)) => !shown.alone.is_empty(),
            _ => false,
        };
        self.keeps_depths || self.order.len() > 1 || self.ordered().any(several)
    }

    /// Lists the tiles that a single instance's rays may meet, then traces those.
    fn record_beams(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        entry: &Entry,
        number: u32,
        tiles: &Tiles,
    ) {
        let raw = &self.device.raw;
        let (words, draw) = (&slot.lists, &entry.draw);
        let number = tiles.block.unwrap_or(number);
        let (at, Rectangle { low, high }) = (tiles.at, tiles.rectangle);
        let groups = |a: u32, b: u32| (b - a + 1).div_ceil(GROUP_PIXELS);
        let none: [u32; 4] = [0, 1, 1, 0];
        let pushed = [at, low.0 | low.1 << 16, tiles.rectangle.padded(), 0];
        let barrier = |from, to| buffer_barrier(&self.device, cmd, words, from, to);
        barrier(Usage::TileRead, Usage::TransferWrite);
        // SAFETY: `cmd` is recording, outside a render pass; the lists' words lie within the
        // buffer; all that is bound lives as long as `self`, and all pipelines have one layout.
        unsafe {
            raw.cmd_update_buffer(cmd, words.raw, 4 * u64::from(at), bytemuck::bytes_of(&none));
            if tiles.listed {
                let heads = [none; TILE_LISTS as usize];
                let bytes = bytemuck::bytes_of(&heads);
                raw.cmd_update_buffer(cmd, words.raw, 4 * u64::from(tiles.heads()), bytes);
            }
            barrier(Usage::TransferWrite, Usage::ComputeWrite);
            let patches = if tiles.listed {
                draw.patches_offset
            } else {
                draw.tables_offset
            };
            self.bind_tables(cmd, slot, entry, draw.list, number, patches);
            self.dispatch(cmd, pushed, [groups(low.0, high.0), groups(low.1, high.1)]);
            barrier(Usage::ComputeWrite, Usage::TileRead);
            if tiles.listed {
                self.trace_listed(cmd, slot, entry, number, pushed);
            }
            self.bind(cmd, slot, entry, draw.pipeline, number);
            self.push(cmd, pushed);
            raw.cmd_dispatch_indirect(cmd, words.raw, 4 * u64::from(at));
        }
    }

    /// Lists the patches of all bins of one copy.
    fn list_alone(&self, cmd: vk::CommandBuffer, slot: &FrameSlot) {
        let binned = || {
            let entries = self.order.iter().zip(self.ordered());
            entries.filter_map(|(number, entry)| match &entry.draw.work {
                Some(Work::Bins(shown)) if !shown.alone.is_empty() => Some((*number, entry, shown)),
                _ => None,
            })
        };
        if binned().next().is_none() {
            return;
        }
        let words = &slot.lists;
        let barrier = |from, to| buffer_barrier(&self.device, cmd, words, from, to);
        barrier(Usage::TileRead, Usage::TransferWrite);
        for (bins, at) in binned().flat_map(|(_, _, shown)| shown.listed()) {
            // Bins are counted along y.
            let mut heads = [[0u32, 1, 1, 0]; 1 + TILE_LISTS as usize];
            heads[0] = [1, 0, 1, 0];
            let heads_at = at + 4 + 4 * listed_tiles(&bins);
            // SAFETY: `cmd` is recording, outside a render pass; the words lie within the buffer.
            unsafe {
                for (at, heads) in [(at, &heads[..1]), (heads_at, &heads[1..])] {
                    let bytes = bytemuck::cast_slice(heads);
                    let at = 4 * u64::from(at);
                    self.device.raw.cmd_update_buffer(cmd, words.raw, at, bytes);
                }
            }
        }
        barrier(Usage::TransferWrite, Usage::ComputeWrite);
        for (number, entry, shown) in binned() {
            let draw = &entry.draw;
            self.bind_tables(cmd, slot, entry, draw.list, number, draw.patches_offset);
            for (bins, at) in shown.listed() {
                let pushed = [at, bins.start, listed_tiles(&bins), bins.end - bins.start];
                let groups = (bins.end - bins.start).div_ceil(GROUP_PIXELS * GROUP_PIXELS);
                self.dispatch(cmd, pushed, [groups, 1]);
            }
        }
        barrier(Usage::ComputeWrite, Usage::TileRead);
    }

    /// Traces an entry's bins of one copy.
    fn record_alone(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        entry: &Entry,
        number: u32,
        shown: &Shown,
    ) {
        for (bins, at) in shown.listed() {
            let pushed = [at, 0, listed_tiles(&bins), 0];
            self.trace_listed(cmd, slot, entry, number, pushed);
            // Those whose lists would be too long.
            self.bind(cmd, slot, entry, entry.draw.pipeline, number);
            self.push(cmd, [at / 4 + 1, 0, 0, 0]);
            // SAFETY: as for beams.
            unsafe {
                let raw = &self.device.raw;
                raw.cmd_dispatch_indirect(cmd, slot.lists.raw, 4 * u64::from(at));
            }
        }
    }

    /// Traces tiles whose patches are listed, where `pushed` says.
    fn trace_listed(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        entry: &Entry,
        number: u32,
        mut pushed: Pushed,
    ) {
        let heads = pushed[0] + 4 + 4 * pushed[2];
        let draw = &entry.draw;
        for ((k, head), pipeline) in (0u32..).zip((heads..).step_by(4)).zip(draw.listed) {
            if pipeline == vk::Pipeline::null() {
                continue;
            }
            pushed[3] = k;
            self.bind_tables(cmd, slot, entry, pipeline, number, draw.patches_offset);
            self.push(cmd, pushed);
            // SAFETY: `cmd` is recording, outside a render pass; all that is bound lives as long as
            // `self`.
            unsafe {
                let raw = &self.device.raw;
                raw.cmd_dispatch_indirect(cmd, slot.lists.raw, 4 * u64::from(head));
            }
        }
    }

    /// Between two dispatches of which one reads, or writes again, what the other wrote.
    pub(super) fn wait_for_writes(&self, cmd: vk::CommandBuffer) {
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

    /// `pushed` as in `beams.glsl`.
    pub(super) fn dispatch(&self, cmd: vk::CommandBuffer, pushed: Pushed, groups: [u32; 2]) {
        self.push(cmd, pushed);
        // SAFETY: `cmd` is recording, outside a render pass; all that is bound lives as long as
        // `self`.
        unsafe { self.device.raw.cmd_dispatch(cmd, groups[0], groups[1], 1) };
    }

    fn push(&self, cmd: vk::CommandBuffer, pushed: Pushed) {
        let stage = vk::ShaderStageFlags::COMPUTE;
        let bytes = bytemuck::bytes_of(&pushed);
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording.
        unsafe { raw.cmd_push_constants(cmd, self.layout(), stage, 0, bytes) };
    }

    /// Binds a pipeline, an entry's sets, and the block of this number.
    pub(super) fn bind(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        entry: &Entry,
        pipeline: vk::Pipeline,
        block: u32,
    ) {
        self.bind_tables(cmd, slot, entry, pipeline, block, entry.draw.tables_offset);
    }

    /// The same, with the tables of the arena that begin at this byte for the entry's own.
    fn bind_tables(
        &self,
        cmd: vk::CommandBuffer,
        slot: &FrameSlot,
        entry: &Entry,
        pipeline: vk::Pipeline,
        block: u32,
        tables: u32,
    ) {
        let point = match self.output {
            Output::Pass(_) => vk::PipelineBindPoint::GRAPHICS,
            Output::Compute(_) => vk::PipelineBindPoint::COMPUTE,
        };
        let textures = entry.prepared.as_ref().map(|p| p.textures.set);
        let sets = [slot.set, textures.unwrap_or_default(), slot.target_set];
        let offsets = [block * slot.stride, tables];
        let raw = &self.device.raw;
        // SAFETY: the sets fit the layout, and all they name lives as long as the caller of
        // `record` promised.
        unsafe {
            raw.cmd_bind_pipeline(cmd, point, pipeline);
            raw.cmd_bind_descriptor_sets(cmd, point, self.layout(), 0, &sets, &offsets);
        }
    }

    fn layout(&self) -> vk::PipelineLayout {
        self.device
            .pipelines()
            .map_or(vk::PipelineLayout::null(), |p| p.layout)
    }
}
