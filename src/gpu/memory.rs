//! Buffers and images with their memory.

use super::call::Call;
use super::device::Shared;
use crate::error::{Error, Result, Stage};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};
use std::sync::Arc;

/// A buffer with its memory. Whoever drops it has waited for the device.
pub struct Buffer {
    /// The buffer.
    pub raw: vk::Buffer,
    /// How many bytes it holds.
    pub bytes: u64,
    allocation: Option<Allocation>,
    device: Arc<Shared>,
}

impl Buffer {
    pub(crate) fn new(
        device: &Arc<Shared>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self> {
        let bytes = bytes.max(16);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: a plain creation; the handle is destroyed in Drop.
        let raw = unsafe { device.raw.create_buffer(&info, None) }.call("vkCreateBuffer")?;
        let mut buffer = Self {
            raw,
            bytes,
            allocation: None,
            device: device.clone(),
        };
        // SAFETY: the buffer is live.
        let requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        let allocation = allocate(device, name, requirements, location, true)?;
        let (memory, offset) = bound(&mut buffer.allocation, allocation);
        // SAFETY: the allocation meets the buffer's requirements and is bound once.
        unsafe { device.raw.bind_buffer_memory(raw, memory, offset) }.call("vkBindBufferMemory")?;
        Ok(buffer)
    }

    /// The bytes of a buffer in host memory. Such memory is coherent here: the allocator asks for
    /// it.
    ///
    /// # Errors
    /// [`Stage::Draw`] of a buffer elsewhere.
    pub fn mapped(&mut self) -> Result<&mut [u8]> {
        let bytes = usize::try_from(self.bytes).unwrap_or(usize::MAX);
        self.allocation
            .as_mut()
            .and_then(Allocation::mapped_slice_mut)
            .and_then(|all| all.get_mut(..bytes))
            .ok_or_else(|| Error::new(Stage::Draw, "a host buffer is not mapped"))
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: users wait for the GPU before they drop a buffer.
        unsafe { self.device.raw.destroy_buffer(self.raw, None) };
        free(&self.device, self.allocation.take());
    }
}

/// What an image is made as; always 2D, one layer.
#[derive(Clone, Copy)]
pub(crate) struct ImageKind {
    pub format: vk::Format,
    pub width: u32,
    pub height: u32,
    pub mips: u32,
    pub usage: vk::ImageUsageFlags,
}

impl ImageKind {
    pub fn aspect(&self) -> vk::ImageAspectFlags {
        if self.format == vk::Format::D32_SFLOAT {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        }
    }

    pub fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(self.aspect())
            .level_count(self.mips)
            .layer_count(1)
    }
}

pub(crate) struct Image {
    pub raw: vk::Image,
    pub view: vk::ImageView,
    pub kind: ImageKind,
    allocation: Option<Allocation>,
    device: Arc<Shared>,
}

impl Image {
    pub fn new(device: &Arc<Shared>, name: &str, kind: ImageKind) -> Result<Self> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(kind.format)
            .extent(vk::Extent3D {
                width: kind.width,
                height: kind.height,
                depth: 1,
            })
            .mip_levels(kind.mips)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(kind.usage);
        // SAFETY: a plain creation; the handle is destroyed in Drop.
        let raw = unsafe { device.raw.create_image(&info, None) }.call("vkCreateImage")?;
        let mut image = Self {
            raw,
            view: vk::ImageView::null(),
            kind,
            allocation: None,
            device: device.clone(),
        };
        // SAFETY: the image is live.
        let requirements = unsafe { device.raw.get_image_memory_requirements(raw) };
        let allocation = allocate(device, name, requirements, MemoryLocation::GpuOnly, false)?;
        let (memory, offset) = bound(&mut image.allocation, allocation);
        // SAFETY: the allocation meets the image's requirements and is bound once.
        unsafe { device.raw.bind_image_memory(raw, memory, offset) }.call("vkBindImageMemory")?;
        let view = vk::ImageViewCreateInfo::default()
            .image(raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(kind.format)
            .subresource_range(kind.range());
        // SAFETY: the image has its memory.
        image.view =
            unsafe { device.raw.create_image_view(&view, None) }.call("vkCreateImageView")?;
        Ok(image)
    }

    /// Bytes of memory it takes.
    pub fn bytes(&self) -> u64 {
        self.allocation.as_ref().map_or(0, Allocation::size)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: users wait for the GPU before they drop an image; a null view may be destroyed.
        unsafe {
            self.device.raw.destroy_image_view(self.view, None);
            self.device.raw.destroy_image(self.raw, None);
        }
        free(&self.device, self.allocation.take());
    }
}

fn allocate(
    device: &Shared,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<Allocation> {
    device.budget.take(name, requirements.size)?;
    let made = device
        .allocator()
        .and_then(|mut allocator| allocated(&mut allocator, name, requirements, location, linear));
    // What was made is given back as large as it is.
    let bytes = made.as_ref().map_or(0, Allocation::size);
    device.budget.give(requirements.size.saturating_sub(bytes));
    made
}

fn allocated(
    allocator: &mut Allocator,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<Allocation> {
    allocator
        .allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })
        .map_err(|e| {
            let mib = requirements.size >> 20;
            Error::new(
                Stage::Draw,
                format!("{name}: no device memory for {mib} MiB ({e}); try a smaller size or fewer map rows"),
            )
        })
}

/// Hands an allocation to its owner before anything else can fail: whoever owns it frees it.
fn bound(owner: &mut Option<Allocation>, allocation: Allocation) -> (vk::DeviceMemory, u64) {
    // SAFETY: the handle is used to bind the resource that owns the allocation, and for nothing
    // else.
    let place = (unsafe { allocation.memory() }, allocation.offset());
    *owner = Some(allocation);
    place
}

fn free(device: &Shared, allocation: Option<Allocation>) {
    let Some(allocation) = allocation else {
        return;
    };
    device.budget.give(allocation.size());
    if let Ok(mut allocator) = device.allocator() {
        // An error here can only be reported, and nobody is left to report it to.
        let _ = allocator.free(allocation);
    }
}
