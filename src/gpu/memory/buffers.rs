//! Buffers by their uses, which decide the kind of memory.
//!
//! | use | the host | the device | memory |
//! |---|---|---|---|
//! | [`Bins`](Use::Bins), [`Placed`](Use::Placed) | never touches it | writes and reads it | of the device |
//! | [`Upload`](Use::Upload) | writes it once | copies from it | of the host |
//! | [`Mark`](Use::Mark) | reads it every frame | writes it | of the host |
//! | others | writes it every frame | reads it | of the device, seen by the host |
//!
//! Device memory replaces host memory, and the reverse, on a device that has no other. Memory that
//! the host sees is coherent: the allocator takes no other, so nothing is flushed.

use super::{allocate, bound, free};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::usage::{self, Usage};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;
use std::sync::Arc;
use vk::BufferUsageFlags as B;

/// A buffer with its memory. The owner must wait for the device before dropping it.
pub struct Buffer {
    /// The buffer.
    pub raw: vk::Buffer,
    /// The size in bytes.
    pub bytes: u64,
    /// A view of its vectors of four words, as many as the device's views hold; null for buffers
    /// that shaders do not read so.
    pub texels: vk::BufferView,
    allocation: Option<Allocation>,
    device: Arc<Shared>,
}

impl Buffer {
    /// Makes a buffer for a use, called `name` in messages.
    pub(crate) fn for_use(device: &Arc<Shared>, to: Use, name: &str, bytes: u64) -> Result<Self> {
        let (limit, usage) = (device.limits().max_storage_buffer_range, to.usage());
        if usage.contains(B::STORAGE_BUFFER) && bytes > u64::from(limit) {
            let device = &device.chosen.report.name;
            let message =
                format!("the {name} take {bytes} bytes, and {device} takes {limit}; draw fewer");
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        let types = match to {
            Use::Upload => device.host_types,
            _ => u32::MAX,
        };
        Self::new(device, name, bytes, usage, to.location(), types)
    }

    /// Makes a buffer in memory of one of these types, if one of them fits, else of any type.
    pub(crate) fn new(
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
            texels: vk::BufferView::null(),
            allocation: None,
            device: device.clone(),
        };
        device.name(raw, name);
        // SAFETY: the buffer is live.
        let mut requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        if requirements.memory_type_bits & types != 0 {
            requirements.memory_type_bits &= types;
        }
        let allocation = allocate(device, name, requirements, location, true)?;
        let (memory, offset) = bound(&mut buffer.allocation, allocation);
        // SAFETY: the allocation meets the buffer's requirements and is bound once.
        unsafe { device.raw.bind_buffer_memory(raw, memory, offset) }.call("vkBindBufferMemory")?;
        if usage.contains(B::UNIFORM_TEXEL_BUFFER) {
            let most = 16 * u64::from(device.limits().max_texel_buffer_elements);
            let info = vk::BufferViewCreateInfo::default()
                .buffer(raw)
                .format(vk::Format::R32G32B32A32_UINT)
                .range((bytes - bytes % 16).min(most));
            // SAFETY: the buffer has memory; the view is destroyed before it.
            buffer.texels =
                unsafe { device.raw.create_buffer_view(&info, None) }.call("vkCreateBufferView")?;
        }
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

    /// Records a barrier between two uses of the buffer.
    pub(crate) fn barrier(&self, cmd: vk::CommandBuffer, from: Usage, to: Usage) {
        let barrier = vk::BufferMemoryBarrier::default()
            .src_access_mask(from.access())
            .dst_access_mask(to.access())
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .buffer(self.raw)
            .size(vk::WHOLE_SIZE);
        usage::wait(&self.device.raw, cmd, (from, to), &[barrier], &[]);
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: users wait for the GPU before they drop a buffer.
        unsafe {
            self.device.raw.destroy_buffer_view(self.texels, None);
            self.device.raw.destroy_buffer(self.raw, None);
        };
        free(&self.device, self.allocation.take());
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Use {
    /// A uniform block, written every frame.
    Uniform,
    /// Tables and instances, bound both as storage buffers and as uniform buffers.
    Storage,
    Draws,
    /// Corners of proxies.
    Indices,
    /// Bins of tiles, which the device fills and counts.
    Bins,
    /// Instances that the device places.
    Placed,
    /// Bytes that are copied to the device.
    Upload,
    /// A word that commands write, by which the host learns that they have run.
    Mark,
}

impl Use {
    fn usage(self) -> B {
        match self {
            Self::Uniform => B::UNIFORM_BUFFER,
            Self::Storage => B::STORAGE_BUFFER | B::UNIFORM_BUFFER | B::UNIFORM_TEXEL_BUFFER,
            Self::Draws => B::INDIRECT_BUFFER,
            Self::Indices => B::INDEX_BUFFER,
            Self::Placed => B::STORAGE_BUFFER | B::UNIFORM_TEXEL_BUFFER,
            Self::Bins => B::STORAGE_BUFFER | B::INDIRECT_BUFFER | B::TRANSFER_DST,
            Self::Upload => B::TRANSFER_SRC,
            Self::Mark => B::TRANSFER_DST,
        }
    }

    fn location(self) -> MemoryLocation {
        match self {
            Self::Bins | Self::Placed => MemoryLocation::GpuOnly,
            Self::Mark => MemoryLocation::GpuToCpu,
            _ => MemoryLocation::CpuToGpu,
        }
    }
}

/// Writes a value `at` bytes into a buffer.
pub(crate) fn write<T: bytemuck::Pod>(buffer: &mut Buffer, at: usize, value: &T) -> Result<()> {
    buffer.mapped()?[at..at + size_of::<T>()].copy_from_slice(bytemuck::bytes_of(value));
    Ok(())
}

pub(crate) fn write_slice<T: bytemuck::Pod>(buffer: &mut Buffer, values: &[T]) -> Result<()> {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    buffer.mapped()?[..bytes.len()].copy_from_slice(bytes);
    Ok(())
}
