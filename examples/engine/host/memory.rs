//! Buffers and images, each with memory of its own.

use super::{DEPTH, Fallible, Host, Options};
use ash::vk;

/// A buffer in host memory, mapped for as long as it lives.
pub struct HostBuffer<'a> {
    pub raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut u8,
    bytes: usize,
    host: &'a Host,
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
            let mapped =
                host.device
                    .map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            Ok(Self {
                raw,
                memory,
                mapped: mapped.cast(),
                bytes,
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
        // SAFETY: the mapping is as long as the bytes, and the device does not read it yet.
        unsafe {
            buffer
                .mapped
                .copy_from_nonoverlapping(bytes.as_ptr(), bytes.len())
        };
        Ok(buffer)
    }

    pub fn bytes(&self) -> Vec<u8> {
        // SAFETY: the device has written it and is done.
        unsafe { std::slice::from_raw_parts(self.mapped, self.bytes).to_vec() }
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
    memory: vk::DeviceMemory,
    host: &'a Host,
}

impl<'a> HostImage<'a> {
    pub fn new(
        host: &'a Host,
        options: &Options,
        format: vk::Format,
        samples: u32,
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
                .extent(vk::Extent3D {
                    width: options.width,
                    height: options.height,
                    depth: 1,
                })
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::from_raw(samples))
                .usage(
                    usage
                        | if samples == 1 {
                            U::TRANSFER_SRC
                        } else {
                            U::empty()
                        },
                );
            let raw = host.device.create_image(&info, None)?;
            let needs = host.device.get_image_memory_requirements(raw);
            let memory = host.memory(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            host.device.bind_image_memory(raw, memory, 0)?;
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(aspect)
                .level_count(1)
                .layer_count(1);
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range);
            let view = host.device.create_image_view(&info, None)?;
            Ok(Self {
                raw,
                view,
                memory,
                host,
            })
        }
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
