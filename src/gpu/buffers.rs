//! Buffers in host memory that the device reads.

use super::device::Shared;
use super::memory::Buffer;
use crate::error::{Error, Result, Stage};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// A buffer of uniform blocks.
pub(crate) fn uniform(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
    Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

pub(crate) fn storage(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let limit = u64::from(device.limits.max_storage_buffer_range);
    if bytes > limit {
        return Err(Error::new(
            Stage::Draw,
            format!(
                "the {name} take {bytes} bytes, and {} takes {limit}; draw fewer",
                device.report.name
            ),
        ));
    }
    // Patches are read both ways; lists of tiles are made and counted on the device.
    use vk::BufferUsageFlags as B;
    let usage = B::STORAGE_BUFFER | B::UNIFORM_BUFFER | B::INDIRECT_BUFFER | B::TRANSFER_DST;
    Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

pub(crate) fn indices(device: &Arc<Shared>, bytes: usize) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::INDEX_BUFFER;
    let location = MemoryLocation::CpuToGpu;
    Buffer::new(device, "corners of hulls", bytes as u64, usage, location)
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
