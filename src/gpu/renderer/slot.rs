//! The resources that only one prepared frame reads: blocks, instances, tiles, draws, and the sets
//! that bind them. The slot also keeps alive all else that its commands read.

use super::prepare::FrameStatistics;
use crate::error::Result;
use crate::gpu::content::view_plan::ViewPlan;
use crate::gpu::device::Shared;
use crate::gpu::memory::Buffer;
use crate::gpu::memory::buffers::{Use, write, write_slice};
use crate::gpu::memory::images::Upload;
use crate::gpu::resources::geometry::TableBuffers;
use crate::gpu::resources::textures::TextureSet;
use crate::gpu::vk::descriptors::{self, FRAME_SET, Resource, TARGET_SET};
use crate::gpu::vk::output::ComputeTarget;
use crate::plan::casters::Hierarchy;
use crate::plan::crowd::{Crowds, placement_words};
use crate::plan::{Call, DrawPath, FramePlan, View};
use crate::scene::Placement;
use crate::shader::{
    CasterNode, CrowdBlock, FrameBlock, InstanceBlock, OBJECT_STRIDE, ObjectBlock,
};
use ash::vk;
use std::sync::Arc;

/// The buffers and descriptor sets of one prepared frame.
pub(crate) struct FrameSlot {
    pub frame_set: vk::DescriptorSet,
    pub target_set: vk::DescriptorSet,
    frame: Buffer,
    objects: Buffer,
    instances: Buffer,
    casters: Buffer,
    tiles: Buffer,
    pub bins: Buffer,
    pub draws: Buffer,
    /// Placements of the copies of crowds.
    placements: Buffer,
    crowds: Buffer,
    /// The objects in `placements`, each with the version of its values.
    placed: Vec<(u32, u64)>,
    /// The plan and bindings to record; `None` before the slot is derived.
    pub bound: Option<BoundPlan>,
    /// Counts the slot's frames. A token of an earlier frame records nothing.
    pub serial: u64,
    /// The view and the renderer's version that objects and instances were written for. `None` if
    /// all must be written.
    pub written: Option<(View, u64)>,
    /// First of the records of the last frame's placements, when they were written.
    pub last_record: u32,
    /// The copies in `casters`.
    pub hierarchy: Option<Arc<Hierarchy>>,
    /// Copies that the frame's commands make.
    pub staging: Vec<Upload>,
    /// The buffer of tables that the sets name, and how often the target was set.
    named: Option<(vk::Buffer, u64)>,
    pool: vk::DescriptorPool,
    device: Arc<Shared>,
}

/// A plan with all objects that its commands bind.
pub(crate) struct BoundPlan {
    pub plan: Arc<ViewPlan>,
    /// One per step.
    pub steps: Vec<BoundStep>,
    /// Pipelines of the steps that list crowds.
    pub crowd_pipelines: Vec<vk::Pipeline>,
    pub buffers: TableBuffers,
}

impl BoundPlan {
    /// The number of steps, groups of draws of one pipeline, whose pipelines are not compiled yet.
    pub fn hidden(&self) -> usize {
        let missing = |step: &&BoundStep| step.pipeline.is_none();
        self.steps.iter().filter(missing).count()
    }
}

/// The bindings of a step.
pub(crate) struct BoundStep {
    /// `None` if it is not compiled yet.
    pub pipeline: Option<vk::Pipeline>,
    pub textures: Arc<TextureSet>,
    /// Dynamic offsets of a step with one object, in bytes: begin of its tables, begin of its
    /// solid.
    pub offsets: [u32; 2],
}

impl FrameSlot {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let buffer = |to, name, bytes| Buffer::for_use(device, to, name, bytes);
        let mut slot = Self {
            frame_set: vk::DescriptorSet::null(),
            target_set: vk::DescriptorSet::null(),
            frame: buffer(Use::Uniform, "frame block", size_of::<FrameBlock>() as u64)?,
            objects: buffer(Use::Storage, "objects", u64::from(OBJECT_STRIDE))?,
            instances: buffer(Use::Storage, "instances", 0)?,
            casters: buffer(Use::Storage, "casters", size_of::<CasterNode>() as u64)?,
            tiles: buffer(Use::Storage, "tiles", 0)?,
            bins: buffer(Use::Bins, "bins of tiles", 0)?,
            draws: buffer(Use::Draws, "draws", 0)?,
            placements: buffer(Use::Storage, "placements of crowds", 0)?,
            crowds: buffer(Use::Storage, "crowds", 0)?,
            placed: Vec::new(),
            bound: None,
            serial: 0,
            written: None,
            last_record: 0,
            hierarchy: None,
            staging: Vec::new(),
            named: None,
            pool: vk::DescriptorPool::null(),
            device: device.clone(),
        };
        let layouts = &device.pipelines.set_layouts;
        let sets = [FRAME_SET, TARGET_SET];
        let (pool, sets) = descriptors::allocate(&device.raw, layouts, &sets, 1)?;
        slot.pool = pool;
        slot.frame_set = sets.first().copied().unwrap_or_default();
        slot.target_set = sets.get(1).copied().unwrap_or_default();
        Ok(slot)
    }

    /// Makes room for this many objects and instances. The caller must ensure that no frame reads
    /// the buffers.
    pub fn fit(&mut self, objects: usize, instances: u64) -> Result<()> {
        let objects = objects as u64 * u64::from(OBJECT_STRIDE);
        let instances = instances * size_of::<InstanceBlock>() as u64;
        for (buffer, bytes, name) in [
            (&mut self.objects, objects, "objects"),
            (&mut self.instances, instances, "instances"),
        ] {
            if buffer.bytes < bytes {
                *buffer = roomy(&self.device, name, bytes)?;
                self.written = None;
                self.named = None;
            }
        }
        Ok(())
    }

    /// Bytes of all buffers of the slot.
    pub fn bytes(&self) -> u64 {
        let all = [
            &self.frame,
            &self.objects,
            &self.instances,
            &self.casters,
            &self.tiles,
            &self.bins,
            &self.draws,
            &self.placements,
            &self.crowds,
        ];
        all.iter().map(|buffer| buffer.bytes).sum()
    }

    /// The number of commands and bytes of the slot's frame.
    pub fn statistics(&self) -> FrameStatistics {
        let Some(bound) = &self.bound else {
            return FrameStatistics::default();
        };
        let frame = &bound.plan.frame;
        let mut all = FrameStatistics {
            objects: frame
                .paths
                .iter()
                .filter(|p| **p != DrawPath::Nothing)
                .count() as u32,
            hidden: bound.hidden() as u32,
            slot_bytes: self.bytes(),
            ..FrameStatistics::default()
        };
        let steps = frame.steps.iter().zip(&bound.steps);
        for (step, _) in steps.filter(|(_, bound)| bound.pipeline.is_some()) {
            match &step.call {
                Call::Draws(range) => all.draws += range.end - range.start,
                Call::Quads(range) | Call::Tiles(range) => {
                    all.draws += 1;
                    all.tiles += range.end - range.start;
                }
                Call::Dispatch(groups, _) => {
                    all.dispatches += 1;
                    all.tiles += groups;
                }
                Call::Indirect(..) | Call::Groups(..) => all.dispatches += 1,
                Call::IndirectTiles(_) => all.draws += 1,
            }
        }
        all.dispatches += frame.crowds.as_ref().map_or(0, |c| c.steps.len() as u32);
        all
    }

    pub fn write_frame(&mut self, block: &FrameBlock) -> Result<()> {
        write(&mut self.frame, 0, block)
    }

    pub fn write_object(&mut self, number: u32, block: &ObjectBlock) -> Result<()> {
        let at = number as usize * OBJECT_STRIDE as usize;
        write(&mut self.objects, at, block)
    }

    /// Writes the instances of these copies, in ascending order, on all cores. `first`: number of the
    /// instance of copy 0.
    pub fn write_instances(
        &mut self,
        first: u32,
        copies: &[u32],
        block: impl Fn(u32) -> InstanceBlock + Sync,
    ) -> Result<()> {
        let from = first as usize * size_of::<InstanceBlock>();
        let (blocks, _) = self.instances.mapped()?[from..].as_chunks_mut();
        fill(blocks, 0, copies, &block);
        Ok(())
    }

    /// Writes the copies that may cast shadows.
    pub fn write_casters(&mut self, hierarchy: &Arc<Hierarchy>) -> Result<()> {
        let known = self.hierarchy.as_ref();
        if known.is_some_and(|known| Arc::ptr_eq(known, hierarchy)) {
            return Ok(());
        }
        let bytes = size_of_val(hierarchy.nodes.as_slice()) as u64;
        if self.casters.bytes < bytes {
            self.casters = roomy(&self.device, "casters", bytes)?;
            self.named = None;
        }
        self.hierarchy = Some(hierarchy.clone());
        write_slice(&mut self.casters, &hierarchy.nodes)
    }

    /// Writes a plan's tiles and draws, and makes room for its bins.
    pub fn write_plan(&mut self, plan: &FramePlan) -> Result<()> {
        let crowds = plan.crowds.as_ref();
        let [tiles, bins] = crowds.map_or([0; 2], |c| [c.tile_words, c.bin_words]);
        let words = 4 * u64::from(tiles.max(plan.words.len() as u32));
        if self.tiles.bytes < words {
            self.tiles = roomy(&self.device, "tiles", words)?;
            self.named = None;
        }
        let bins_bytes = 4 * u64::from(bins.max(plan.bin_words));
        if self.bins.bytes < bins_bytes {
            let bytes = bins_bytes + bins_bytes / 2;
            self.bins = Buffer::for_use(&self.device, Use::Bins, "bins of tiles", bytes)?;
            self.named = None;
        }
        let draws = size_of_val(plan.draws.as_slice()) as u64;
        if self.draws.bytes < draws {
            let bytes = draws.next_power_of_two();
            self.draws = Buffer::for_use(&self.device, Use::Draws, "draws", bytes)?;
        }
        write_slice(&mut self.tiles, &plan.words)?;
        write_slice(&mut self.draws, &plan.draws)
    }

    /// Writes the blocks of a plan's crowds, and the placements of their copies unless they are
    /// those of `placed`: an object and the version of its values each.
    pub fn write_crowds<'a>(
        &mut self,
        crowds: &Crowds,
        placed: Vec<(u32, u64)>,
        placements: impl Iterator<Item = &'a Placement>,
    ) -> Result<()> {
        let objects = size_of_val(crowds.objects.as_slice()) as u64;
        let bytes = size_of::<CrowdBlock>() as u64 + objects;
        if self.crowds.bytes < bytes {
            self.crowds = roomy(&self.device, "crowds", bytes)?;
            self.named = None;
        }
        write(&mut self.crowds, 0, &crowds.block)?;
        let (_, rest) = self.crowds.mapped()?.split_at_mut(size_of::<CrowdBlock>());
        rest[..objects as usize].copy_from_slice(bytemuck::cast_slice(&crowds.objects));
        if self.placed == placed {
            return Ok(());
        }
        let bytes = u64::from(crowds.block.counts[0]) * size_of::<[[u32; 2]; 10]>() as u64;
        if self.placements.bytes < bytes {
            self.placements = roomy(&self.device, "placements of crowds", bytes)?;
            self.named = None;
        }
        let to = self
            .placements
            .mapped()?
            .chunks_exact_mut(size_of::<[[u32; 2]; 10]>());
        for (to, placement) in to.zip(placements) {
            to.copy_from_slice(bytemuck::cast_slice(&placement_words(placement)));
        }
        self.placed = placed;
        Ok(())
    }

    /// Points the sets to their buffers, if those have changed.
    pub fn name(&mut self, tables: &Buffer, target: Option<(&ComputeTarget, u64)>) {
        let now = (tables.raw, target.map_or(0, |t| t.1));
        if self.named == Some(now) {
            return;
        }
        let whole = |buffer: &Buffer| Resource::Buffer(buffer.raw, vk::WHOLE_SIZE);
        let window = 16 * u64::from(self.device.chosen.constants().own_vectors);
        let frame = [
            whole(&self.frame),
            whole(&self.objects),
            whole(&self.instances),
            whole(&self.casters),
            whole(tables),
            Resource::Buffer(tables.raw, window),
            Resource::Buffer(self.objects.raw, size_of::<ObjectBlock>() as u64),
        ];
        let frame: Vec<_> = (0u32..).zip(frame).collect();
        let mut of_target = vec![
            (1, whole(&self.tiles)),
            (6, whole(&self.bins)),
            (7, whole(&self.placements)),
            (8, whole(&self.crowds)),
        ];
        if let Some((target, _)) = target {
            of_target.push((0, Resource::Buffer(target.words, vk::WHOLE_SIZE)));
            let images = target.images.iter().map(|view| Resource::Image(*view));
            of_target.extend((2u32..).zip(images));
        }
        let raw = &self.device.raw;
        // SAFETY: the previous frame that used the sets is done; the objects that they name live as
        // long as the slot, or as long as the host promised.
        unsafe {
            descriptors::write(raw, self.frame_set, FRAME_SET, &frame);
            descriptors::write(raw, self.target_set, TARGET_SET, &of_target);
        }
        self.named = Some(now);
    }
}

/// Fills `blocks`, of which the first belongs to copy `first`.
fn fill(
    blocks: &mut [[u8; size_of::<InstanceBlock>()]],
    first: u32,
    copies: &[u32],
    block: &(impl Fn(u32) -> InstanceBlock + Sync),
) {
    const FEW: usize = 4096;
    if copies.len() <= FEW {
        for copy in copies {
            blocks[(copy - first) as usize].copy_from_slice(bytemuck::bytes_of(&block(*copy)));
        }
        return;
    }
    let (near, far) = copies.split_at(copies.len() / 2);
    let (a, b) = blocks.split_at_mut((far[0] - first) as usize);
    rayon::join(
        || fill(a, first, near, block),
        || fill(b, far[0], far, block),
    );
}

/// Makes a storage buffer with half as much again to spare, because moving objects grow it in small
/// steps.
fn roomy(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let limit = u64::from(device.limits().max_storage_buffer_range);
    let bytes = bytes.max((bytes + bytes / 2).min(limit));
    Buffer::for_use(device, Use::Storage, name, bytes)
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        // SAFETY: the slot's last frame is done; the pool frees its sets, and a null pool may be
        // destroyed.
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
