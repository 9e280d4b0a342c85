//! Buffers with their memory.

use super::vulkan;
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};
use revmap::error::{Error, Result, Stage};
use revmap::gpu::Device;
use std::sync::{Arc, Mutex};

/// A buffer; destroyed when dropped.
pub(super) struct Buffer {
    pub raw: vk::Buffer,
    pub bytes: u64,
    allocation: Option<Allocation>,
    allocator: Arc<Mutex<Allocator>>,
    device: Device,
}

impl Buffer {
    pub fn new(
        device: &Device,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self> {
        let allocator = device.allocator()?;
        let bytes = bytes.max(16);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        // SAFETY: a plain creation; Drop destroys the handle.
        let made = unsafe { device.raw().create_buffer(&info, None) };
        let mut buffer = Self {
            raw: made.map_err(|code| vulkan("vkCreateBuffer", code))?,
            bytes,
            allocation: None,
            allocator,
            device: device.clone(),
        };
        // SAFETY: the buffer is live.
        let requirements = unsafe { device.raw().get_buffer_memory_requirements(buffer.raw) };
        let allocation = lock(&buffer.allocator)?
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|e| {
                let mib = bytes >> 20;
                let message =
                    format!("{name}: no device memory for {mib} MiB ({e}); take a coarser mesh");
                Error::new(Stage::Draw, message)
            })?;
        // SAFETY: the handle is used to bind this buffer, and for nothing else.
        let (memory, offset) = (unsafe { allocation.memory() }, allocation.offset());
        buffer.allocation = Some(allocation);
        // SAFETY: the allocation meets the buffer's requirements and is bound once.
        unsafe { device.raw().bind_buffer_memory(buffer.raw, memory, offset) }
            .map_err(|code| vulkan("vkBindBufferMemory", code))?;
        Ok(buffer)
    }

    /// Writes to the beginning of a buffer in host memory, which the allocator makes coherent.
    pub fn write(&mut self, bytes: &[u8]) -> Result<()> {
        let mapped = self
            .allocation
            .as_mut()
            .and_then(Allocation::mapped_slice_mut)
            .and_then(|all| all.get_mut(..bytes.len()));
        let Some(mapped) = mapped else {
            return Err(Error::new(Stage::Draw, "a host buffer is not mapped"));
        };
        mapped.copy_from_slice(bytes);
        Ok(())
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: users wait for the GPU before they drop a buffer.
        unsafe { self.device.raw().destroy_buffer(self.raw, None) };
        if let (Some(allocation), Ok(mut allocator)) =
            (self.allocation.take(), lock(&self.allocator))
        {
            // An error here can only be reported, and nobody is left to report it to.
            let _ = allocator.free(allocation);
        }
    }
}

fn lock(allocator: &Mutex<Allocator>) -> Result<std::sync::MutexGuard<'_, Allocator>> {
    let gone = |_| Error::new(Stage::Draw, "the device's allocator is gone after a panic");
    allocator.lock().map_err(gone)
}
