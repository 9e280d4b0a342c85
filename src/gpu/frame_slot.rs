//! What one frame in flight reads and no other: its blocks, instances and lists, and the sets that
//! bind them.

use super::blocks::{FrameBlock, InstanceBlock, ShadowBlock, SolidBlock};
use super::buffers::{storage, uniform, write, write_slice};
use super::call::Call;
use super::device::Shared;
use super::memory::Buffer;
use super::target::ComputeTarget;
use crate::error::Result;
use ash::vk;
use std::sync::Arc;

/// The buffers and descriptor sets of one frame in flight.
pub(crate) struct FrameSlot {
    /// Set 0: buffers of the frame.
    pub set: vk::DescriptorSet,
    /// Set 2: the words of bins; the target of a compute pass.
    pub target_set: vk::DescriptorSet,
    frame: Buffer,
    blocks: Buffer,
    instances: Buffer,
    shadows: Buffer,
    pub lists: Buffer,
    /// Bytes from block to block, as dynamic offsets need it.
    pub stride: u32,
    /// Objects whose blocks or instances are older here than in the renderer.
    pub stale: Vec<u32>,
    /// Whether everything is older: buffers are new.
    pub empty: bool,
    /// Generations of the arena and of the target that the sets name.
    named: Option<[u64; 2]>,
    pool: vk::DescriptorPool,
    device: Arc<Shared>,
}

impl FrameSlot {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let align = device.limits.min_uniform_buffer_offset_alignment.max(1);
        let stride = (size_of::<SolidBlock>() as u64).next_multiple_of(align);
        use vk::DescriptorType as T;
        let sizes = [
            (T::UNIFORM_BUFFER, 2),
            (T::UNIFORM_BUFFER_DYNAMIC, 2),
            (T::STORAGE_BUFFER, 4),
            (T::STORAGE_IMAGE, 4),
        ]
        .map(|(kind, count)| {
            vk::DescriptorPoolSize::default()
                .ty(kind)
                .descriptor_count(count)
        });
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(2)
            .pool_sizes(&sizes);
        let mut slot = Self {
            set: vk::DescriptorSet::null(),
            target_set: vk::DescriptorSet::null(),
            frame: uniform(device, "frame block", size_of::<FrameBlock>() as u64)?,
            blocks: uniform(device, "object blocks", stride)?,
            instances: storage(device, "instances", 0)?,
            shadows: uniform(device, "shadow block", size_of::<ShadowBlock>() as u64)?,
            lists: storage(device, "lists", 0)?,
            stride: u32::try_from(stride).unwrap_or(u32::MAX),
            stale: Vec::new(),
            empty: true,
            named: None,
            pool: vk::DescriptorPool::null(),
            device: device.clone(),
        };
        let layouts = device.pipelines()?.set_layouts;
        let layouts = [layouts[0], layouts[2]];
        // SAFETY: plain creations, destroyed in Drop; the pool was sized for these sets.
        unsafe {
            slot.pool = device
                .raw
                .create_descriptor_pool(&info, None)
                .call("vkCreateDescriptorPool")?;
            let info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(slot.pool)
                .set_layouts(&layouts);
            let sets = device
                .raw
                .allocate_descriptor_sets(&info)
                .call("vkAllocateDescriptorSets")?;
            slot.set = sets.first().copied().unwrap_or_default();
            slot.target_set = sets.get(1).copied().unwrap_or_default();
        }
        Ok(slot)
    }

    /// Sees to it that so many blocks and instances fit. Whoever calls this knows that no frame
    /// reads the buffers.
    pub fn fit(&mut self, blocks: u32, instances: u32) -> Result<()> {
        let blocks = u64::from(blocks) * u64::from(self.stride);
        let instances = u64::from(instances) * size_of::<InstanceBlock>() as u64;
        if self.blocks.bytes < blocks {
            self.blocks = uniform(&self.device, "object blocks", blocks.next_power_of_two())?;
            self.outgrown();
        }
        if self.instances.bytes < instances {
            self.instances = roomy(&self.device, "instances", instances)?;
            self.outgrown();
        }
        Ok(())
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        [
            &self.frame,
            &self.blocks,
            &self.instances,
            &self.shadows,
            &self.lists,
        ]
        .iter()
        .map(|buffer| buffer.bytes)
        .sum()
    }

    fn outgrown(&mut self) {
        self.empty = true;
        self.named = None;
    }

    pub fn write_frame(&mut self, block: &FrameBlock) -> Result<()> {
        write(&mut self.frame, 0, block)
    }

    pub fn write_block(&mut self, number: u32, block: &SolidBlock) -> Result<()> {
        write(&mut self.blocks, (number * self.stride) as usize, block)
    }

    pub fn write_instance(&mut self, number: u32, instance: &InstanceBlock) -> Result<()> {
        let at = number as usize * size_of::<InstanceBlock>();
        write(&mut self.instances, at, instance)
    }

    pub fn write_shadows(&mut self, blocks: &[SolidBlock]) -> Result<()> {
        let mut all: ShadowBlock = bytemuck::Zeroable::zeroed();
        all.shadow_batches[0] = u32::try_from(blocks.len()).unwrap_or(0);
        for (to, block) in all.shadow_solids.iter_mut().zip(blocks) {
            *to = *block;
        }
        write(&mut self.shadows, 0, &all)
    }

    /// Takes over bins and their lists, with room behind them up to `all` words: lists that the
    /// device makes.
    pub fn write_lists(&mut self, words: &[u32], all: usize) -> Result<()> {
        let bytes = 4 * all.max(words.len()) as u64;
        if self.lists.bytes < bytes {
            self.lists = roomy(&self.device, "lists", bytes)?;
            self.named = None;
        }
        write_slice(&mut self.lists, words)
    }

    /// Points the sets to their buffers, where those have changed.
    pub fn name(&mut self, tables: (&Buffer, u64), target: Option<(&ComputeTarget, u64)>) {
        let generations = [tables.1, target.map_or(0, |t| t.1)];
        if self.named == Some(generations) {
            return;
        }
        use vk::DescriptorType as T;
        let block = size_of::<SolidBlock>() as u64;
        let window = 16 * u64::from(self.device.constants.own_vectors);
        for (binding, (kind, buffer, range)) in (0u32..).zip([
            (T::UNIFORM_BUFFER, self.frame.raw, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER_DYNAMIC, self.blocks.raw, block),
            (T::STORAGE_BUFFER, self.instances.raw, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER, self.shadows.raw, vk::WHOLE_SIZE),
            (T::STORAGE_BUFFER, tables.0.raw, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER_DYNAMIC, tables.0.raw, window),
        ]) {
            self.buffer(self.set, binding, kind, buffer, range);
        }
        let whole = vk::WHOLE_SIZE;
        self.buffer(self.target_set, 1, T::STORAGE_BUFFER, self.lists.raw, whole);
        if let Some((target, _)) = target {
            self.buffer(self.target_set, 0, T::STORAGE_BUFFER, target.words, whole);
            for (binding, view) in (2u32..).zip(&target.images) {
                let info = [vk::DescriptorImageInfo::default()
                    .image_view(*view)
                    .image_layout(vk::ImageLayout::GENERAL)];
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(self.target_set)
                    .dst_binding(binding)
                    .descriptor_type(T::STORAGE_IMAGE)
                    .image_info(&info);
                // SAFETY: as for buffers.
                unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) };
            }
        }
        self.named = Some(generations);
    }

    fn buffer(
        &self,
        set: vk::DescriptorSet,
        binding: u32,
        kind: vk::DescriptorType,
        buffer: vk::Buffer,
        range: u64,
    ) {
        let info = [vk::DescriptorBufferInfo::default()
            .buffer(buffer)
            .range(range)];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding)
            .descriptor_type(kind)
            .buffer_info(&info);
        // SAFETY: the frame that used the set before is done.
        unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) };
    }
}

/// A storage buffer with half as much again to spare: what moves grows in small steps.
fn roomy(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let limit = u64::from(device.limits.max_storage_buffer_range);
    storage(device, name, bytes.max((bytes + bytes / 2).min(limit)))
}

impl Drop for FrameSlot {
    fn drop(&mut self) {
        // SAFETY: the slot's last frame is done; the sets go with their pool, and a null pool may
        // be destroyed.
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
