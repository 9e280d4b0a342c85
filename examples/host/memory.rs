//! Buffers and images, each with memory of its own.

use super::{DEPTH, Fallible, Host, Options};
use ash::vk;

/// Records a barrier between all stages, and of these images.
///
/// # Safety
/// `cmd` is recording, outside of a pass.
pub unsafe fn barrier(host: &Host, cmd: vk::CommandBuffer, images: &[vk::ImageMemoryBarrier]) {
    let memory = [vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
        .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)];
    let (all, none) = (
        vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::HOST,
        vk::DependencyFlags::empty(),
    );
    let device = &host.device;
    // SAFETY: as the caller promised.
    unsafe { device.cmd_pipeline_barrier(cmd, all, all, none, &memory, &[], images) };
}

/// A buffer in host memory, mapped for as long as it lives.
pub struct HostBuffer<'a> {
    pub raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut u8,
    pub size: usize,
    pub host: &'a Host,
}

impl<'a> HostBuffer<'a> {
    pub fn new(host: &'a Host, bytes: usize, usage: vk::BufferUsageFlags) -> Fallible<Self> {
        type Flags = vk::MemoryPropertyFlags;
        // SAFETY: plain creations; bound once, destroyed in Drop.
        unsafe {
            let info = vk::BufferCreateInfo::default()
                .size(bytes as u64)
                .usage(usage);
            let raw = host.device.create_buffer(&info, None)?;
            let needs = host.device.get_buffer_memory_requirements(raw);
            let memory = host.memory(needs, Flags::HOST_VISIBLE | Flags::HOST_COHERENT)?;
            host.device.bind_buffer_memory(raw, memory, 0)?;
            let (all, none) = (vk::WHOLE_SIZE, vk::MemoryMapFlags::empty());
            let mapped = host.device.map_memory(memory, 0, all, none)?;
            Ok(Self {
                raw,
                memory,
                mapped: mapped.cast(),
                size: bytes,
                host,
            })
        }
    }

    pub fn of<T: bytemuck::Pod>(
        host: &'a Host,
        values: &[T],
        usage: vk::BufferUsageFlags,
    ) -> Fallible<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let buffer = Self::new(host, bytes.len(), usage)?;
        let (from, to) = (bytes.as_ptr(), buffer.mapped);
        // SAFETY: the mapping is as long as the bytes, and the device does not read it yet.
        unsafe { to.copy_from_nonoverlapping(from, bytes.len()) };
        Ok(buffer)
    }

    pub fn bytes(&self) -> Vec<u8> {
        // SAFETY: the device has written it and is done.
        unsafe { std::slice::from_raw_parts(self.mapped, self.size).to_vec() }
    }
}

impl Drop for HostBuffer<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe {
            self.host.device.destroy_buffer(self.raw, None);
            self.host.device.free_memory(self.memory, None);
        }
    }
}

pub struct HostImage<'a> {
    pub raw: vk::Image,
    pub view: vk::ImageView,
    pub aspect: vk::ImageAspectFlags,
    memory: vk::DeviceMemory,
    host: &'a Host,
}

impl<'a> HostImage<'a> {
    /// An image, used in `more` ways than by a pass and, of one sample, for reading back.
    pub fn new(
        host: &'a Host,
        options: &Options,
        format: vk::Format,
        samples: u32,
        more: vk::ImageUsageFlags,
    ) -> Fallible<Self> {
        use vk::ImageUsageFlags as U;
        let (aspect, usage) = if format == DEPTH {
            (vk::ImageAspectFlags::DEPTH, U::DEPTH_STENCIL_ATTACHMENT)
        } else {
            (vk::ImageAspectFlags::COLOR, U::COLOR_ATTACHMENT)
        };
        // SAFETY: as for buffers.
        unsafe {
            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(format)
                .extent(options.extent().into())
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::from_raw(samples))
                .usage(if samples == 1 {
                    usage | more | U::TRANSFER_SRC
                } else {
                    usage | more
                });
            let raw = host.device.create_image(&info, None)?;
            let needs = host.device.get_image_memory_requirements(raw);
            let memory = host.memory(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            host.device.bind_image_memory(raw, memory, 0)?;
            let mut image = Self {
                raw,
                view: vk::ImageView::null(),
                aspect,
                memory,
                host,
            };
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(image.range());
            image.view = host.device.create_image_view(&info, None)?;
            Ok(image)
        }
    }

    /// All of it.
    fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(self.aspect)
            .level_count(1)
            .layer_count(1)
    }

    /// The layout of the image while it is drawn into.
    pub fn drawn(&self) -> vk::ImageLayout {
        match self.aspect {
            vk::ImageAspectFlags::DEPTH => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
            _ => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        }
    }

    /// A barrier between two layouts, for all accesses.
    pub fn barrier(
        &self,
        from: vk::ImageLayout,
        to: vk::ImageLayout,
    ) -> vk::ImageMemoryBarrier<'static> {
        vk::ImageMemoryBarrier::default()
            .image(self.raw)
            .subresource_range(self.range())
            .old_layout(from)
            .new_layout(to)
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
    }

    /// All of it, for a copy.
    pub fn region(&self, options: &Options) -> vk::BufferImageCopy {
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(self.aspect)
            .layer_count(1);
        vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(options.extent().into())
    }
}

impl Drop for HostImage<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe {
            self.host.device.destroy_image_view(self.view, None);
            self.host.device.destroy_image(self.raw, None);
            self.host.device.free_memory(self.memory, None);
        }
    }
}
