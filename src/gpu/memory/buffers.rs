//! Buffers by their users, which decide the kind of memory.
//!
//! | constructor | the host | the device | memory |
//! |---|---|---|---|
//! | [`device_local`] | never touches it | writes and reads it | of the device |
//! | [`upload`] | writes it once | copies from it once | of the host |
//! | [`per_frame`] | writes it every frame | reads it | of the device, seen by the host |
//! | [`read_back`] | reads it | copies into it | of the host, cached where there is such |
//!
//! Device memory replaces host memory, and the reverse, on a device that has no other. Memory that
//! the host sees is coherent: the allocator takes no other, so nothing is flushed.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::Buffer;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;
use vk::BufferUsageFlags as B;

/// A buffer that only the device writes and reads.
pub(crate) fn device_local(
    device: &Arc<Shared>,
    name: &str,
    bytes: u64,
    usage: B,
) -> Result<Buffer> {
    make(device, name, bytes, usage, MemoryLocation::GpuOnly)
}

/// A buffer of small data that the host writes every frame.
pub(crate) fn per_frame(device: &Arc<Shared>, name: &str, bytes: u64, usage: B) -> Result<Buffer> {
    make(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

/// A buffer that the host writes once, and that is copied from once.
pub(crate) fn upload(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let (usage, location) = (B::TRANSFER_SRC, MemoryLocation::CpuToGpu);
    Buffer::among(device, name, bytes, usage, location, device.host_types)
}

/// A buffer that the host reads.
pub(crate) fn read_back(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let (usage, location) = (B::TRANSFER_DST, MemoryLocation::GpuToCpu);
    make(device, name, bytes, usage, location)
}

/// A uniform block.
pub(crate) fn uniform(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    per_frame(device, name, bytes, B::UNIFORM_BUFFER)
}

/// Tables and instances, bound both as storage buffers and as uniform buffers.
pub(crate) fn storage(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    per_frame(device, name, bytes, B::STORAGE_BUFFER | B::UNIFORM_BUFFER)
}

/// Lists of tiles, which the device makes and counts.
pub(crate) fn lists(device: &Arc<Shared>, bytes: u64) -> Result<Buffer> {
    let usage = B::STORAGE_BUFFER | B::INDIRECT_BUFFER | B::TRANSFER_DST;
    device_local(device, "lists of tiles", bytes, usage)
}

/// Draws that the host writes.
pub(crate) fn indirect(device: &Arc<Shared>, bytes: u64) -> Result<Buffer> {
    per_frame(device, "draws", bytes, B::INDIRECT_BUFFER)
}

/// Corners of proxies.
pub(crate) fn indices(device: &Arc<Shared>, bytes: u64) -> Result<Buffer> {
    per_frame(device, "corners of proxies", bytes, B::INDEX_BUFFER)
}

fn make(
    device: &Arc<Shared>,
    name: &str,
    bytes: u64,
    usage: B,
    location: MemoryLocation,
) -> Result<Buffer> {
    let limit = u64::from(device.limits.max_storage_buffer_range);
    if usage.contains(B::STORAGE_BUFFER) && bytes > limit {
        let device = &device.report.name;
        let message =
            format!("the {name} take {bytes} bytes, and {device} takes {limit}; draw fewer");
        return Err(Error::new(ErrorKind::TooLarge, message));
    }
    Buffer::new(device, name, bytes, usage, location)
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
