//! A descriptor set with one uniform buffer, as a host has for its lights.

use super::memory::HostBuffer;
use super::{Fallible, Host};
use ash::vk;

/// A set whose binding 0 is a uniform buffer, for fragments and compute.
pub struct UniformSet<'a> {
    pub layout: vk::DescriptorSetLayout,
    pub raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    _buffer: HostBuffer<'a>,
    host: &'a Host,
}

impl<'a> UniformSet<'a> {
    pub fn of<T: bytemuck::Pod>(host: &'a Host, values: &[T]) -> Fallible<Self> {
        let buffer = HostBuffer::of(host, values, vk::BufferUsageFlags::UNIFORM_BUFFER)?;
        let device = &host.device;
        let kind = vk::DescriptorType::UNIFORM_BUFFER;
        let stages = vk::ShaderStageFlags::FRAGMENT | vk::ShaderStageFlags::COMPUTE;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(stages)];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let sizes = [vk::DescriptorPoolSize::default()
            .ty(kind)
            .descriptor_count(1)];
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
            let whole = [vk::DescriptorBufferInfo::default()
                .buffer(buffer.raw)
                .range(vk::WHOLE_SIZE)];
            let write = vk::WriteDescriptorSet::default()
                .dst_set(raw)
                .descriptor_type(kind)
                .buffer_info(&whole);
            device.update_descriptor_sets(&[write], &[]);
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
