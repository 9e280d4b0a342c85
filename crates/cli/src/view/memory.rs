//! The window's own images and buffers, with their memory.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::barriers::range;
use super::vulkan::{Vulkan, vulkan};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::allocation_error;
use std::rc::Rc;

/// An image of one level. The device must have finished its use before it is dropped.
pub struct Image {
    pub raw: vk::Image,
    pub view: vk::ImageView,
    pub aspect: vk::ImageAspectFlags,
    memory: Option<Allocation>,
    host: Rc<Vulkan>,
}

impl Image {
    /// An image named `name` in messages.
    pub fn new(
        host: &Rc<Vulkan>,
        name: &str,
        format: vk::Format,
        extent: vk::Extent2D,
        usage: vk::ImageUsageFlags,
    ) -> Result<Self> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        let aspect = if usage.contains(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT) {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        };
        let device = &host.device;
        // SAFETY: plain creations, bound once, destroyed in Drop.
        unsafe {
            let raw = vulkan(device.create_image(&info, None), "vkCreateImage")?;
            let mut image = Self {
                raw,
                view: vk::ImageView::null(),
                aspect,
                memory: None,
                host: host.clone(),
            };
            let needs = device.get_image_memory_requirements(raw);
            let memory = image
                .memory
                .insert(allocate(host, name, needs, MemoryLocation::GpuOnly)?);
            let bound = device.bind_image_memory(raw, memory.memory(), memory.offset());
            vulkan(bound, "vkBindImageMemory")?;
            let viewed = vk::ImageUsageFlags::COLOR_ATTACHMENT
                | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
            if usage.intersects(viewed) {
                image.view = view(host, raw, format, aspect)?;
            }
            Ok(image)
        }
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: the device is done with it; a null view may be destroyed.
        unsafe {
            self.host.device.destroy_image_view(self.view, None);
            self.host.device.destroy_image(self.raw, None);
        }
        free(&self.host, self.memory.take());
    }
}

/// A buffer. The device must have finished its use before it is dropped.
pub struct Buffer {
    pub raw: vk::Buffer,
    memory: Option<Allocation>,
    host: Rc<Vulkan>,
}

impl Buffer {
    /// A buffer named `name` in messages.
    pub fn new(
        host: &Rc<Vulkan>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        let device = &host.device;
        // SAFETY: plain creations, bound once, destroyed in Drop.
        unsafe {
            let raw = vulkan(device.create_buffer(&info, None), "vkCreateBuffer")?;
            let mut buffer = Self {
                raw,
                memory: None,
                host: host.clone(),
            };
            let needs = device.get_buffer_memory_requirements(raw);
            let memory = buffer.memory.insert(allocate(host, name, needs, location)?);
            let bound = device.bind_buffer_memory(raw, memory.memory(), memory.offset());
            vulkan(bound, "vkBindBufferMemory")?;
            Ok(buffer)
        }
    }

    /// The buffer's bytes, if they are mapped for the CPU.
    pub fn bytes(&self) -> &[u8] {
        let memory = self.memory.as_ref();
        memory
            .and_then(Allocation::mapped_slice)
            .unwrap_or_default()
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe { self.host.device.destroy_buffer(self.raw, None) };
        free(&self.host, self.memory.take());
    }
}

/// A view of a whole image.
///
/// # Safety
/// The image is live and of this format.
pub unsafe fn view(
    host: &Vulkan,
    image: vk::Image,
    format: vk::Format,
    aspect: vk::ImageAspectFlags,
) -> Result<vk::ImageView> {
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(vk::ImageViewType::TYPE_2D)
        .format(format)
        .subresource_range(range(aspect));
    // SAFETY: as the caller promised.
    let made = unsafe { host.device.create_image_view(&info, None) };
    vulkan(made, "vkCreateImageView")
}

fn allocate(
    host: &Vulkan,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
) -> Result<Allocation> {
    let gone = || {
        Error::new(
            ErrorKind::Other,
            "the device's allocator is gone after a panic",
        )
    };
    let allocator = host.allocator()?;
    let mut allocator = allocator.lock().map_err(|_| gone())?;
    let made = allocator.allocate(&AllocationCreateDesc {
        name,
        requirements,
        location,
        linear: location != MemoryLocation::GpuOnly,
        allocation_scheme: AllocationScheme::GpuAllocatorManaged,
    });
    made.map_err(|e| allocation_error(name, requirements.size, &e))
}

fn free(host: &Vulkan, memory: Option<Allocation>) {
    if let (Some(memory), Ok(allocator)) = (memory, host.allocator())
        && let Ok(mut allocator) = allocator.lock()
    {
        // Freeing fails only for memory of another allocator.
        let _ = allocator.free(memory);
    }
}
