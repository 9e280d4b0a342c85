//! Descriptor sets and samplers.

use super::blocks::SolidBlock;
use super::buffers::Buffers;
use super::call::Call;
use super::device::Shared;
use super::memory::Buffer;
use super::pipelines::Pipelines;
use super::target::Target;
use crate::error::Result;
use crate::shader::generated::{MAX_SHADOW_MAPS, PIECE_VECTORS};
use ash::vk;
use std::sync::Arc;

/// A sampler that clamps to the edge.
pub(crate) struct Sampler {
    pub raw: vk::Sampler,
    device: Arc<Shared>,
}

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wrap {
    /// A map whose texels shaders gather and weigh themselves.
    MapNearest,
    /// The papers' map, filtered by the sampler.
    MapLinear,
    /// A surface's texture, repeated both ways.
    SurfaceRepeated,
    /// Repeated around the axis alone: the poles' rows do not run into each other.
    SurfaceAround,
}

impl Sampler {
    pub fn new(device: &Arc<Shared>, wrap: Wrap) -> Result<Self> {
        use vk::SamplerAddressMode as Address;
        let surface = matches!(wrap, Wrap::SurfaceRepeated | Wrap::SurfaceAround);
        let filter = if wrap == Wrap::MapNearest {
            vk::Filter::NEAREST
        } else {
            vk::Filter::LINEAR
        };
        let (around, along) = match wrap {
            Wrap::MapNearest | Wrap::MapLinear => (Address::CLAMP_TO_EDGE, Address::CLAMP_TO_EDGE),
            Wrap::SurfaceRepeated => (Address::REPEAT, Address::REPEAT),
            Wrap::SurfaceAround => (Address::REPEAT, Address::CLAMP_TO_EDGE),
        };
        let mut info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(around)
            .address_mode_v(along)
            .address_mode_w(Address::CLAMP_TO_EDGE);
        if surface {
            info = info
                .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
                .max_lod(vk::LOD_CLAMP_NONE);
            if let Some(most) = device.anisotropy {
                info = info.anisotropy_enable(true).max_anisotropy(most.min(8.0));
            }
        }
        // SAFETY: a plain creation, destroyed in Drop.
        let raw = unsafe { device.raw.create_sampler(&info, None) }.call("vkCreateSampler")?;
        Ok(Self {
            raw,
            device: device.clone(),
        })
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for.
        unsafe { self.device.raw.destroy_sampler(self.raw, None) };
    }
}

/// The sets of a renderer, by frequency.
pub(crate) struct Descriptors {
    pool: vk::DescriptorPool,
    /// Set 0.
    pub frame: vk::DescriptorSet,
    /// Set 1, one a batch.
    textures: Vec<vk::DescriptorSet>,
    /// Set 2.
    pub target: vk::DescriptorSet,
    device: Arc<Shared>,
}

impl Descriptors {
    pub fn new(device: &Arc<Shared>, pipelines: &Pipelines, batches: usize) -> Result<Self> {
        let count = u32::try_from(batches).unwrap_or(u32::MAX).max(1);
        use vk::DescriptorType as T;
        let size = |kind, count| {
            vk::DescriptorPoolSize::default()
                .ty(kind)
                .descriptor_count(count)
        };
        let sizes = [
            size(T::UNIFORM_BUFFER, 2),
            size(T::UNIFORM_BUFFER_DYNAMIC, 2),
            size(T::STORAGE_BUFFER, 4),
            size(T::STORAGE_IMAGE, 4),
            size(T::COMBINED_IMAGE_SAMPLER, count * (4 + MAX_SHADOW_MAPS)),
        ];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(2 + count)
            .pool_sizes(&sizes);
        // SAFETY: a plain creation, destroyed in Drop.
        let pool = unsafe { device.raw.create_descriptor_pool(&info, None) }
            .call("vkCreateDescriptorPool")?;
        let mut all = Self {
            pool,
            frame: vk::DescriptorSet::null(),
            textures: Vec::new(),
            target: vk::DescriptorSet::null(),
            device: device.clone(),
        };
        let [frame, texture, target] = pipelines.set_layouts;
        let mut layouts = vec![frame, target];
        layouts.resize(2 + batches, texture);
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool)
            .set_layouts(&layouts);
        // SAFETY: the pool was sized for these.
        let mut sets = unsafe { device.raw.allocate_descriptor_sets(&info) }
            .call("vkAllocateDescriptorSets")?
            .into_iter();
        all.frame = sets.next().unwrap_or_default();
        all.target = sets.next().unwrap_or_default();
        all.textures = sets.collect();
        Ok(all)
    }

    /// Points batch `number`'s set to its textures: four of its own, then those that shadows read; returns the set.
    pub fn textures(
        &self,
        number: usize,
        textures: &[(vk::ImageView, vk::Sampler)],
    ) -> vk::DescriptorSet {
        let set = self.textures[number];
        let infos: Vec<_> = textures
            .iter()
            .map(|(view, sampler)| {
                vk::DescriptorImageInfo::default()
                    .image_view(*view)
                    .sampler(*sampler)
                    .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
            })
            .collect();
        let (own, shadows) = infos.split_at(4);
        let mut writes: Vec<_> = (0u32..)
            .zip(own.chunks(1))
            .chain([(4, shadows)])
            .map(|(binding, infos)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding)
                    .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
                    .image_info(infos)
            })
            .collect();
        writes.retain(|w| w.descriptor_count > 0);
        // SAFETY: no submission that uses the set is pending.
        unsafe { self.device.raw.update_descriptor_sets(&writes, &[]) };
        set
    }

    /// Points set 0 to its buffers; of the batch blocks one is seen at a time, of the tables a window.
    pub fn frame(&self, buffers: &Buffers) {
        use vk::DescriptorType as T;
        let block = size_of::<SolidBlock>() as u64;
        let window = 16 * u64::from(PIECE_VECTORS);
        for (binding, (kind, buffer, range)) in (0u32..).zip([
            (T::UNIFORM_BUFFER, &buffers.frame, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER_DYNAMIC, &buffers.batches, block),
            (T::STORAGE_BUFFER, &buffers.instances, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER, &buffers.shadows, vk::WHOLE_SIZE),
            (T::STORAGE_BUFFER, &buffers.pieces, vk::WHOLE_SIZE),
            (T::UNIFORM_BUFFER_DYNAMIC, &buffers.pieces, window),
        ]) {
            self.buffer(self.frame, binding, kind, buffer.raw, range);
        }
    }

    /// Points set 2 to a target and the bins.
    pub fn target(&self, target: &Target, bins: &Buffer) {
        use vk::DescriptorType as T;
        if let Some(words) = &target.words {
            self.buffer(self.target, 0, T::STORAGE_BUFFER, words.raw, vk::WHOLE_SIZE);
        }
        self.buffer(self.target, 1, T::STORAGE_BUFFER, bins.raw, vk::WHOLE_SIZE);
        for (binding, image) in (2u32..).zip(&target.images) {
            if !image.kind.usage.contains(vk::ImageUsageFlags::STORAGE) {
                continue;
            }
            let info = [vk::DescriptorImageInfo::default()
                .image_view(image.view)
                .image_layout(vk::ImageLayout::GENERAL)];
            let write = vk::WriteDescriptorSet::default()
                .dst_set(self.target)
                .dst_binding(binding)
                .descriptor_type(T::STORAGE_IMAGE)
                .image_info(&info);
            // SAFETY: as for textures.
            unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) };
        }
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
        // SAFETY: no submission that uses the set is pending.
        unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) };
    }
}

impl Drop for Descriptors {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for; the sets go with their pool.
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
