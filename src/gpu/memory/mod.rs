//! Buffers and images with their memory.

pub(crate) mod budget;
pub(crate) mod buffers;
pub(crate) mod uploads;

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::{Call, allocation_error};
use ash::vk;
use gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};
use std::sync::{Arc, Mutex};

/// A buffer with its memory. The owner must wait for the device before dropping it.
pub struct Buffer {
    /// The buffer.
    pub raw: vk::Buffer,
    /// The size in bytes.
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
        Self::among(device, name, bytes, usage, location, u32::MAX)
    }

    /// Makes a buffer in memory of one of these types, if one of them fits, else of any type.
    pub(crate) fn among(
        device: &Arc<Shared>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
        types: u32,
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
        let mut requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        if requirements.memory_type_bits & types != 0 {
            requirements.memory_type_bits &= types;
        }
        let allocation = allocate(device, name, requirements, location, true)?;
        let (memory, offset) = bound(&mut buffer.allocation, allocation);
        // SAFETY: the allocation meets the buffer's requirements and is bound once.
        unsafe { device.raw.bind_buffer_memory(raw, memory, offset) }.call("vkBindBufferMemory")?;
        Ok(buffer)
    }

    /// The bytes of a buffer in host memory. Such memory is coherent here: the allocator takes no
    /// other.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for a buffer in other memory.
    pub fn mapped(&mut self) -> Result<&mut [u8]> {
        let bytes = usize::try_from(self.bytes).unwrap_or(usize::MAX);
        self.allocation
            .as_mut()
            .and_then(Allocation::mapped_slice_mut)
            .and_then(|all| all.get_mut(..bytes))
            .ok_or_else(|| Error::new(ErrorKind::Usage, "the buffer is not in host memory"))
    }

    /// Writes bytes of a buffer in host memory that may have other owners, too.
    ///
    /// # Safety
    /// The call writes from byte `at` on.
    ///
    /// The caller must ensure that nothing else reads or writes these bytes during the call, here
    /// or on the device.
    pub(crate) unsafe fn write_shared(&self, at: usize, bytes: &[u8]) -> Result<()> {
        let mapped = self.allocation.as_ref().and_then(Allocation::mapped_ptr);
        let fits = at
            .checked_add(bytes.len())
            .is_some_and(|end| end as u64 <= self.bytes);
        let Some(mapped) = mapped.filter(|_| fits) else {
            return Err(Error::new(ErrorKind::Other, "a host buffer is not mapped"));
        };
        // SAFETY: the allocation is mapped as long as it lives, and the bytes are within it; no
        // other access happens by the caller's promise.
        unsafe {
            let to = mapped.as_ptr().cast::<u8>().add(at);
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), to, bytes.len());
        }
        Ok(())
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: users wait for the GPU before they drop a buffer.
        unsafe { self.device.raw.destroy_buffer(self.raw, None) };
        free(&self.device, self.allocation.take());
    }
}

/// The parameters of an image; always 2D, one layer.
#[derive(Clone, Copy)]
pub(crate) struct ImageKind {
    pub format: vk::Format,
    pub width: u32,
    pub height: u32,
    pub mips: u32,
    pub samples: vk::SampleCountFlags,
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
            .samples(kind.samples)
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

    /// Bytes of memory that the image takes.
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
    let bytes = requirements.size;
    device.budget.take(name, bytes, || {
        let made = device.allocator()?.allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let made = made.map_err(|e| allocation_error(name, bytes, &e))?;
        let flags = made.memory_properties();
        Ok((made, flags))
    })
}

/// Moves an allocation to its owner, which frees it, before anything else can fail.
fn bound(owner: &mut Option<Allocation>, allocation: Allocation) -> (vk::DeviceMemory, u64) {
    // SAFETY: the handle is used only to bind the resource that owns the allocation.
    let place = (unsafe { allocation.memory() }, allocation.offset());
    *owner = Some(allocation);
    place
}

fn free(device: &Shared, allocation: Option<Allocation>) {
    let Some(allocation) = allocation else {
        return;
    };
    let (bytes, flags) = (allocation.size(), allocation.memory_properties());
    device.budget.give(bytes, flags);
    if let Ok(mut allocator) = device.allocator() {
        // An error here can only be reported, and no caller is left to receive it.
        let _ = allocator.free(allocation);
    }
}

/// Bits of the memory types that are host-visible and coherent, but not device-local.
pub(crate) fn host_types(instance: &ash::Instance, physical: vk::PhysicalDevice) -> u32 {
    use vk::MemoryPropertyFlags as Flags;
    // SAFETY: plain query of a live physical device.
    let all = unsafe { instance.get_physical_device_memory_properties(physical) };
    let seen = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
    let of_host = |flags: Flags| flags & (seen | Flags::DEVICE_LOCAL) == seen;
    (0u32..)
        .zip(all.memory_types_as_slice())
        .filter(|(_, kind)| of_host(kind.property_flags))
        .fold(0, |bits, (number, _)| bits | 1 << number)
}

/// An allocator for devices whose host gives none.
pub(crate) fn allocator(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: &ash::Device,
) -> Result<Arc<Mutex<Allocator>>> {
    const MIB: u64 = 1 << 20;
    Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: false,
        allocation_sizes: AllocationSizes::new(8 * MIB, 4 * MIB)
            .with_max_device_memblock_size(128 * MIB)
            .with_max_host_memblock_size(64 * MIB),
    })
    .map(|allocator| Arc::new(Mutex::new(allocator)))
    .map_err(|e| Error::new(ErrorKind::Other, format!("no memory allocator: {e}")))
}
