//! The buffers that a renderer fills from update to update.

use super::blocks::{FrameBlock, InstanceBlock, ShadowBlock, SolidBlock};
use super::device::Shared;
use super::hulls;
use super::memory::Buffer;
use super::parts::Parts;
use crate::error::{Error, Result, Stage};
use crate::shader::generated::PIECE_VECTORS;
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// All of them, in host memory that the device reads.
pub(crate) struct Buffers {
    pub frame: Buffer,
    /// A block each [`Buffers::stride`] bytes.
    pub batches: Buffer,
    pub instances: Buffer,
    pub shadows: Buffer,
    /// Bins and lists of tiles.
    pub bins: Buffer,
    /// Tables of the searches, and bands of hulls.
    pub pieces: Buffer,
    /// Corners of a hull's triangles, the same for every hull.
    pub corners: Buffer,
    /// Bytes from batch block to batch block, as dynamic offsets need it.
    pub stride: u32,
    /// What stands in `pieces`.
    written: Parts,
    device: Arc<Shared>,
}

impl Buffers {
    pub fn new(device: &Arc<Shared>, batches: usize, instances: u32) -> Result<Self> {
        let uniform = |name, bytes| {
            let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
            Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
        };
        let align = device.limits.min_uniform_buffer_offset_alignment.max(1);
        let stride = (size_of::<SolidBlock>() as u64).next_multiple_of(align) as u32;
        let instance_bytes = size_of::<InstanceBlock>() as u64 * u64::from(instances);
        Ok(Self {
            frame: uniform("frame block", size_of::<FrameBlock>() as u64)?,
            batches: uniform("batch blocks", u64::from(stride) * batches as u64)?,
            instances: storage(device, "instances", instance_bytes)?,
            shadows: uniform("shadow block", size_of::<ShadowBlock>() as u64)?,
            bins: storage(device, "bins", 0)?,
            pieces: storage(device, "pieces", 16 * u64::from(PIECE_VECTORS))?,
            corners: indices(device, 0)?,
            stride,
            written: Parts::default(),
            device: device.clone(),
        })
    }

    /// Vectors of 16 bytes to which the beginning of a table is aligned.
    pub fn table_align(&self) -> usize {
        let align = self.device.limits.min_uniform_buffer_offset_alignment;
        usize::try_from(align).unwrap_or(256).max(16) / 16
    }

    /// Takes over bins and the lists they point to, with room behind them up to `all` words: lists that the device makes.
    pub fn write_bins(&mut self, words: &[u32], all: usize) -> Result<()> {
        fit(
            &self.device,
            &mut self.bins,
            "bins",
            4 * all.max(words.len()),
        )?;
        write_slice(&mut self.bins, words)
    }

    /// Takes over tables and bands, if they are others than before. The window on the last tables is as long as on all others; what is
    /// behind them is not read.
    pub fn write_pieces(&mut self, parts: Parts) -> Result<()> {
        if parts.same(&self.written) {
            return Ok(());
        }
        self.written = Parts::default();
        let bytes = 16 * (parts.end() + PIECE_VECTORS as usize);
        fit(&self.device, &mut self.pieces, "pieces", bytes)?;
        let mapped = self.pieces.mapped()?;
        for (begin, vectors) in parts.vectors() {
            let bytes: &[u8] = bytemuck::cast_slice(vectors);
            mapped[16 * begin..][..bytes.len()].copy_from_slice(bytes);
        }
        self.written = parts;
        Ok(())
    }

    /// Sees to it that there are corners for hulls of so many bands.
    pub fn fit_corners(&mut self, bands: usize) -> Result<()> {
        let bytes = 4 * hulls::corners(bands as u32) as usize;
        if self.corners.bytes < bytes as u64 {
            let mut corners = indices(&self.device, bytes)?;
            write_slice(&mut corners, &hulls::indices(bands))?;
            self.corners = corners;
        }
        Ok(())
    }
}

fn storage(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
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
    // Pieces are read both ways; lists of tiles are made and counted on the device.
    use vk::BufferUsageFlags as B;
    let usage = B::STORAGE_BUFFER | B::UNIFORM_BUFFER | B::INDIRECT_BUFFER | B::TRANSFER_DST;
    Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

fn indices(device: &Arc<Shared>, bytes: usize) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::INDEX_BUFFER;
    let location = MemoryLocation::CpuToGpu;
    Buffer::new(device, "corners of hulls", bytes as u64, usage, location)
}

/// Makes `buffer` anew where it is too small, with half as much again to spare: what moves grows in small steps.
fn fit(device: &Arc<Shared>, buffer: &mut Buffer, name: &str, bytes: usize) -> Result<()> {
    let bytes = bytes as u64;
    if buffer.bytes < bytes {
        let limit = u64::from(device.limits.max_storage_buffer_range);
        let spare = if buffer.bytes > 16 { bytes / 2 } else { 0 };
        *buffer = storage(device, name, bytes.max((bytes + spare).min(limit)))?;
    }
    Ok(())
}

/// Writes a value `at` bytes into a buffer.
pub(crate) fn write<T: bytemuck::Pod>(buffer: &mut Buffer, at: usize, value: &T) -> Result<()> {
    buffer.mapped()?[at..at + size_of::<T>()].copy_from_slice(bytemuck::bytes_of(value));
    Ok(())
}

fn write_slice<T: bytemuck::Pod>(buffer: &mut Buffer, values: &[T]) -> Result<()> {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    buffer.mapped()?[..bytes.len()].copy_from_slice(bytes);
    Ok(())
}
