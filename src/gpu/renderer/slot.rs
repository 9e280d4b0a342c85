//! The resources that only one prepared frame reads: blocks, instances, tiles, draws, and the sets
//! that bind them. The slot also keeps alive all else that its commands read.

use crate::error::Result;
use crate::gpu::content::view_plan::ViewPlan;
use crate::gpu::device::Shared;
use crate::gpu::memory::Buffer;
use crate::gpu::memory::buffers::{Use, write, write_slice};
use crate::gpu::memory::images::{RecordedUploads, Uploads};
use crate::gpu::resources::geometry::TableBuffers;
use crate::gpu::resources::textures::TextureSet;
use crate::gpu::vk::descriptors::{self, FRAME_SET, Resource, TARGET_SET};
use crate::gpu::vk::output::ComputeTarget;
use crate::gpu::vk::usage::Usage;
use crate::plan::FramePlan;
use crate::plan::walk::Walks;
use crate::shader::{
    BinTile, FrameBlock, InstanceBlock, Kind, OBJECT_STRIDE, ObjectBlock, Variant, WalkNode,
};
use ash::vk;
use bytemuck::Zeroable;
use rayon::prelude::*;
use std::sync::Arc;

#[derive(Clone, Copy)]
pub(crate) enum SlotBuffer {
    Frame,
    Objects,
    Instances,
    /// The instances as the device places them.
    Placed,
    Nodes,
    OpenPixels,
    Bins,
    Draws,
    /// The lower word of the number of the last frame with uploads that has run.
    Mark,
}

/// The use, the name and the least bytes of each [`SlotBuffer`], in order.
const BUFFERS: [(Use, &str, usize); 9] = [
    (Use::Uniform, "frame block", size_of::<FrameBlock>()),
    (Use::Storage, "objects", OBJECT_STRIDE as usize),
    (Use::Storage, "instances", size_of::<InstanceBlock>()),
    (Use::Placed, "placed instances", 0),
    (Use::Storage, "hierarchies", size_of::<WalkNode>()),
    (Use::Storage, "open pixels", size_of::<u32>()),
    (Use::Bins, "bins of tiles", 0),
    (Use::Draws, "draws", 0),
    (Use::Mark, "mark of uploads", 4),
];

/// Buffers that are this many times as large as their contents are made anew, with less memory.
const SPARE: u64 = 8;
/// Copies of which one core writes the blocks.
const FEW: usize = 2048;
/// Bytes of contents below which buffers keep their memory.
const LEAST_SPARE: u64 = 1 << 12;

/// The buffers and descriptor sets of one prepared frame.
pub(crate) struct FrameSlot {
    pub frame_set: vk::DescriptorSet,
    pub target_set: vk::DescriptorSet,
    buffers: Vec<Buffer>,
    /// The plan and bindings to record; `None` before the slot is prepared.
    pub bound: Option<BoundPlan>,
    /// The number of the slot's frame. A token of an earlier frame records nothing.
    pub serial: u64,
    /// The hierarchies in [`SlotBuffer::Nodes`]. The copies that rays from the eye walk to, which
    /// have the same blocks in each view, are in [`SlotBuffer::Instances`].
    pub walks: Option<Arc<Walks>>,
    /// Number of instances that the device places or copies; 0 if none is placed.
    pub placed: u32,
    /// True once commands that place copies were recorded, outside of a frame's own commands. They
    /// may be in the same command buffer as the next preparation, and read all that they name.
    is_read: bool,
    retired: Vec<Retired>,
    uploads: RecordedUploads,
    /// The buffer of tables that the sets name; `None` if they must be written.
    pub named: Option<Arc<Buffer>>,
    /// The buffer of tables that recorded commands may read.
    tables: Option<Arc<Buffer>>,
    pool: vk::DescriptorPool,
    device: Arc<Shared>,
}

/// A plan with all objects that its commands bind.
pub(crate) struct BoundPlan {
    pub plan: Arc<ViewPlan>,
    pub steps: Vec<BoundStep>,
    /// Pipelines that would be faster than those of the steps, or that are missing altogether.
    pub faster: Vec<(Variant, Kind)>,
    /// The number of pipelines on the device before those of the steps were found.
    pub compiled: u64,
    pub buffers: TableBuffers,
}

impl BoundPlan {
    /// The number of steps, groups of draws of one pipeline, whose pipelines are not compiled yet.
    pub fn hidden(&self) -> usize {
        let missing = |step: &&BoundStep| step.pipeline.is_none();
        self.steps.iter().filter(missing).count()
    }
}

pub(crate) struct BoundStep {
    pub pipeline: Option<vk::Pipeline>,
    pub compares_depths: bool,
    pub textures: Arc<TextureSet>,
    /// Dynamic offsets of a step with one object, in bytes: begin of its tables, begin of its
    /// block.
    pub offsets: [u32; 2],
}

impl FrameSlot {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let buffer = |&(to, name, bytes): &_| Buffer::for_use(device, to, name, bytes as u64);
        let mut buffers: Vec<_> = BUFFERS.iter().map(buffer).collect::<Result<_>>()?;
        // No frame has run yet.
        write(&mut buffers[SlotBuffer::Mark as usize], 0, &0u32)?;
        let instance = InstanceBlock::zeroed();
        write(&mut buffers[SlotBuffer::Instances as usize], 0, &instance)?;
        let (pool, [frame_set, target_set]) = sets(device)?;
        Ok(Self {
            frame_set,
            target_set,
            buffers,
            bound: None,
            serial: 0,
            walks: None,
            placed: 0,
            is_read: false,
            retired: Vec::new(),
            uploads: RecordedUploads::default(),
            named: None,
            tables: None,
            pool,
            device: device.clone(),
        })
    }

    pub fn buffer(&self, buffer: SlotBuffer) -> &Buffer {
        &self.buffers[buffer as usize]
    }

    fn buffer_mut(&mut self, buffer: SlotBuffer) -> &mut Buffer {
        &mut self.buffers[buffer as usize]
    }

    /// Makes room for this many bytes, and gives back memory that is needed no more. The
    /// buffer may be another one then, without contents. The caller must ensure that no frame reads
    /// it.
    pub fn fit(&mut self, buffer: SlotBuffer, bytes: u64) -> Result<()> {
        let room = self.buffer(buffer).bytes;
        if room >= bytes && room <= SPARE * bytes.max(LEAST_SPARE) {
            return Ok(());
        }
        // Half as much again to spare, because moving objects grow buffers in small steps.
        let limit = u64::from(self.device.limits().max_storage_buffer_range);
        let bytes = bytes.max((bytes + bytes / 2).min(limit));
        let (to, name, _) = BUFFERS[buffer as usize];
        let new = Buffer::for_use(&self.device, to, name, bytes)?;
        let old = std::mem::replace(self.buffer_mut(buffer), new);
        self.retire(|retired| retired.buffer = Some(old));
        self.named = None;
        if matches!(buffer, SlotBuffer::Instances) {
            // Pipelines that are warmed up read an instance, though they draw no pixel.
            self.write(buffer, 0, &InstanceBlock::zeroed())?;
        }
        Ok(())
    }

    /// Keeps what earlier commands may read until those have run; else drops it.
    fn retire(&mut self, put: impl FnOnce(&mut Retired)) {
        let mut retired = Retired {
            buffer: None,
            tables: None,
            pool: vk::DescriptorPool::null(),
            frame: u64::MAX,
            device: self.device.clone(),
        };
        put(&mut retired);
        if self.is_read {
            self.retired.push(retired);
        }
    }

    /// Drops uploads whose commands have run, by the mark that those commands left, and what was
    /// retired before them.
    pub fn end_uploads(&mut self) -> Result<()> {
        if self.uploads.is_empty() && self.retired.is_empty() {
            return Ok(());
        }
        let serial = self.serial;
        let mark: u32 =
            bytemuck::pod_read_unaligned(&self.buffer_mut(SlotBuffer::Mark).mapped()?[..4]);
        let behind = (serial as u32).wrapping_sub(mark);
        let last = serial.saturating_sub(u64::from(behind));
        self.uploads.run(last);
        self.retired.retain(|retired| retired.frame > last);
        Ok(())
    }

    /// Records the uploads that wait, and a mark after them, into the commands of frame `serial`.
    pub fn record_uploads(&mut self, cmd: vk::CommandBuffer, waiting: &mut Uploads) {
        waiting.record(cmd, &mut self.uploads, self.serial);
        if self.uploads.is_empty() && self.retired.is_empty() {
            return;
        }
        for retired in &mut self.retired {
            retired.frame = retired.frame.min(self.serial);
        }
        let mark = self.buffer(SlotBuffer::Mark);
        mark.barrier(cmd, Usage::ComputeWrite, Usage::TransferWrite);
        // An earlier frame of these commands may have written the mark.
        mark.barrier(cmd, Usage::TransferWrite, Usage::TransferWrite);
        let word = self.serial as u32;
        // SAFETY: `cmd` is recording outside of a pass, and the buffer holds the word.
        unsafe { self.device.raw.cmd_fill_buffer(cmd, mark.raw, 0, 4, word) };
        mark.barrier(cmd, Usage::TransferWrite, Usage::HostRead);
    }

    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(|buffer| buffer.bytes).sum()
    }

    /// True if the frame compares depths of a compute target.
    pub fn compares_depths(&self) -> bool {
        let steps = self.bound.iter().flat_map(|bound| &bound.steps);
        steps.into_iter().any(|step| step.compares_depths)
    }

    pub fn write<T: bytemuck::Pod>(
        &mut self,
        buffer: SlotBuffer,
        at: usize,
        block: &T,
    ) -> Result<()> {
        write(self.buffer_mut(buffer), at, block)
    }

    /// Writes the instances of so many copies, on all cores. `first`: number of the instance of
    /// copy 0.
    pub fn write_instances<Block: bytemuck::Pod>(
        &mut self,
        first: u32,
        copies: usize,
        block: impl Fn(usize) -> Block + Sync,
    ) -> Result<()> {
        const { assert!(size_of::<Block>() == size_of::<InstanceBlock>()) };
        let from = first as usize * size_of::<InstanceBlock>();
        let instances = self.buffer_mut(SlotBuffer::Instances).mapped()?;
        let blocks = &mut instances[from..]
            .as_chunks_mut::<{ size_of::<InstanceBlock>() }>()
            .0[..copies];
        let blocks = blocks.par_iter_mut().with_min_len(FEW).enumerate();
        blocks.for_each(|(copy, to)| to.copy_from_slice(bytemuck::bytes_of(&block(copy))));
        Ok(())
    }

    /// Writes the hierarchies that rays walk, and makes room for the bytes of all instances.
    /// Returns true if the copies that rays from the eye walk to are written already.
    pub fn write_walks(&mut self, walks: &Arc<Walks>, instances: u64) -> Result<bool> {
        let known = self.walks.take();
        let before = self.buffer(SlotBuffer::Instances).raw;
        self.fit(SlotBuffer::Instances, instances)?;
        let keeps = before == self.buffer(SlotBuffer::Instances).raw;
        if known.is_some_and(|known| Arc::ptr_eq(&known, walks)) {
            return Ok(keeps);
        }
        let nodes = walks.nodes.as_slice();
        self.fit(SlotBuffer::Nodes, size_of_val(nodes) as u64)?;
        write_slice(self.buffer_mut(SlotBuffer::Nodes), nodes)?;
        Ok(false)
    }

    /// Notes that commands were recorded that read the slot's buffers and its first set.
    pub fn keep(&mut self) {
        self.is_read = true;
        self.tables = self.named.clone();
    }

    /// Makes room for instances that the device places, none if it places none.
    pub fn place(&mut self, count: u32) -> Result<()> {
        let changes = (count == 0) != (self.placed == 0);
        self.placed = count;
        let bytes = u64::from(count) * size_of::<InstanceBlock>() as u64;
        self.fit(SlotBuffer::Placed, bytes)?;
        if changes {
            self.named = None;
        }
        Ok(())
    }

    /// Writes a plan's open pixels and draws, and makes room for its bins.
    pub fn write_plan(&mut self, plan: &FramePlan) -> Result<()> {
        let open = plan.open_pixels.as_slice();
        self.fit(SlotBuffer::OpenPixels, size_of_val(open) as u64)?;
        let bins = size_of::<BinTile>() as u64 * u64::from(plan.bin_vectors);
        self.fit(SlotBuffer::Bins, bins)?;
        self.fit(SlotBuffer::Draws, size_of_val(plan.draws.as_slice()) as u64)?;
        write_slice(self.buffer_mut(SlotBuffer::OpenPixels), open)?;
        write_slice(self.buffer_mut(SlotBuffer::Draws), &plan.draws)
    }

    /// Points the sets to their buffers, if those have changed.
    pub fn name(&mut self, tables: &Arc<Buffer>, target: Option<&ComputeTarget>) -> Result<()> {
        let known = self.named.as_ref();
        if known.is_some_and(|known| Arc::ptr_eq(known, tables)) {
            return Ok(());
        }
        if self.is_read {
            let (pool, [frame_set, target_set]) = sets(&self.device)?;
            let old = std::mem::replace(&mut self.pool, pool);
            (self.frame_set, self.target_set) = (frame_set, target_set);
            let tables = self.tables.take();
            self.retire(|retired| (retired.pool, retired.tables) = (old, tables));
        }
        let whole = |buffer: &Buffer| Resource::Buffer(buffer.raw, vk::WHOLE_SIZE);
        let instances = match self.placed {
            0 => SlotBuffer::Instances,
            _ => SlotBuffer::Placed,
        };
        let own = |buffer| whole(self.buffer(buffer));
        let texels = |buffer| Resource::Texels(self.buffer(buffer).texels);
        let window = 16 * u64::from(self.device.chosen.constants().own_vectors);
        let object = size_of::<ObjectBlock>() as u64;
        let frame = [
            own(SlotBuffer::Frame),
            own(SlotBuffer::Objects),
            own(instances),
            own(SlotBuffer::Nodes),
            whole(tables),
            Resource::Buffer(tables.raw, window),
            Resource::Buffer(self.buffer(SlotBuffer::Objects).raw, object),
            texels(SlotBuffer::Objects),
            texels(instances),
            texels(SlotBuffer::Nodes),
            Resource::Texels(tables.texels),
            own(SlotBuffer::Instances),
        ];
        let frame: Vec<_> = (0u32..).zip(frame).collect();
        let mut of_target = vec![(1, own(SlotBuffer::OpenPixels)), (6, own(SlotBuffer::Bins))];
        if let Some(target) = target {
            of_target.push((0, Resource::Buffer(target.words, vk::WHOLE_SIZE)));
            let images = target.images.iter().map(|view| Resource::Image(*view));
            of_target.extend((2u32..).zip(images));
        }
        let raw = self.device.raw.clone();
        // SAFETY: the previous frame that used the sets is done; the objects that they name live as
        // long as the slot, or as long as the host promised.
        unsafe {
            descriptors::write(&raw, self.frame_set, FRAME_SET, &frame);
            descriptors::write(&raw, self.target_set, TARGET_SET, &of_target);
        }
        self.named = Some(tables.clone());
        Ok(())
    }
}

/// Makes a pool of the two sets of a slot, and the sets.
fn sets(device: &Shared) -> Result<(vk::DescriptorPool, [vk::DescriptorSet; 2])> {
    let layouts = &device.pipelines.set_layouts;
    let (pool, sets) = descriptors::allocate(&device.raw, layouts, &[FRAME_SET, TARGET_SET], 1)?;
    let set = |n| sets.get(n).copied().unwrap_or_default();
    Ok((pool, [set(0), set(1)]))
}

/// What earlier commands of a slot may read.
struct Retired {
    buffer: Option<Buffer>,
    tables: Option<Arc<Buffer>>,
    pool: vk::DescriptorPool,
    /// Number of the frame whose mark says that those commands have run.
    frame: u64,
    device: Arc<Shared>,
}

impl Drop for Retired {
    fn drop(&mut self) {
        // SAFETY: the commands that read the sets have run; a null pool may be destroyed.
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        // SAFETY: the slot's last frame is done; the pool frees its sets, and a null pool may be
        // destroyed.
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
