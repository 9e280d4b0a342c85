//! Descriptor sets with a uniform buffer and images, as a host has for its lights and passes.

use super::memory::HostBuffer;
use super::{Fallible, Host};
use ash::vk;
use vk::DescriptorType as Kind;

/// A set for fragments and compute: a uniform buffer if there is one, then images.
pub struct UniformSet<'a> {
    pub layout: vk::DescriptorSetLayout,
    pub raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    _buffer: Option<HostBuffer<'a>>,
    host: &'a Host,
}

impl<'a> UniformSet<'a> {
    pub fn of<T: bytemuck::Pod>(host: &'a Host, values: &[T]) -> Fallible<Self> {
        Self::with_images(host, values, &[])
    }

    /// Images with samplers follow. They live as long as the set.
    pub fn with_images<V: bytemuck::Pod>(
        host: &'a Host,
        values: &[V],
        images: &[vk::DescriptorImageInfo],
    ) -> Fallible<Self> {
        let buffer = HostBuffer::of(host, values, vk::BufferUsageFlags::UNIFORM_BUFFER)?;
        let images = images
            .iter()
            .map(|image| (Kind::COMBINED_IMAGE_SAMPLER, *image));
        Self::new(host, Some(buffer), &images.collect::<Vec<_>>())
    }

    /// A set of images of any kind. They live as long as the set.
    pub fn new(
        host: &'a Host,
        buffer: Option<HostBuffer<'a>>,
        images: &[(Kind, vk::DescriptorImageInfo)],
    ) -> Fallible<Self> {
        let device = &host.device;
        let stages = vk::ShaderStageFlags::FRAGMENT | vk::ShaderStageFlags::COMPUTE;
        let first = buffer.iter().map(|_| Kind::UNIFORM_BUFFER);
        let kinds = first.chain(images.iter().map(|image| image.0));
        let binding = |(n, kind)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(n)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(stages)
        };
        let bindings: Vec<_> = (0..).zip(kinds.clone()).map(binding).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let size = |kind| {
            vk::DescriptorPoolSize::default()
                .ty(kind)
                .descriptor_count(1)
        };
        let sizes: Vec<_> = kinds.map(size).collect();
        let pool = vk::DescriptorPoolCreateInfo::default()
            .max_sets(1)
            .pool_sizes(&sizes);
        // SAFETY: plain creations, destroyed in Drop; the buffer lives as long as the set.
        unsafe {
            let layout = device.create_descriptor_set_layout(&info, None)?;
            let pool = device.create_descriptor_pool(&pool, None)?;
            let layouts = [layout];
            let info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(pool)
                .set_layouts(&layouts);
            let raw = device.allocate_descriptor_sets(&info)?[0];
            let write = |n, kind| {
                vk::WriteDescriptorSet::default()
                    .dst_set(raw)
                    .dst_binding(n)
                    .descriptor_type(kind)
            };
            let whole = buffer.iter().map(|buffer| {
                vk::DescriptorBufferInfo::default()
                    .buffer(buffer.raw)
                    .range(vk::WHOLE_SIZE)
            });
            let whole: Vec<_> = whole.collect();
            let values = whole.iter().map(|whole| {
                write(0, Kind::UNIFORM_BUFFER).buffer_info(std::slice::from_ref(whole))
            });
            let images = (whole.len() as u32..).zip(images);
            let images = images
                .map(|(n, (kind, image))| write(n, *kind).image_info(std::slice::from_ref(image)));
            device.update_descriptor_sets(&values.chain(images).collect::<Vec<_>>(), &[]);
            Ok(Self {
                layout,
                raw,
                pool,
                _buffer: buffer,
                host,
            })
        }
    }

    /// Binds the set at a number of a layout.
    ///
    /// # Safety
    /// `cmd` is recording; the layout has this set there; the set lives until `cmd` has run.
    pub unsafe fn bind(
        &self,
        cmd: vk::CommandBuffer,
        point: vk::PipelineBindPoint,
        layout: vk::PipelineLayout,
        number: u32,
    ) {
        let device = &self.host.device;
        // SAFETY: as the caller promised.
        unsafe { device.cmd_bind_descriptor_sets(cmd, point, layout, number, &[self.raw], &[]) };
    }
}

impl Drop for UniformSet<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with the set.
        unsafe {
            self.host.device.destroy_descriptor_pool(self.pool, None);
            let device = &self.host.device;
            device.destroy_descriptor_set_layout(self.layout, None);
        }
    }
}
