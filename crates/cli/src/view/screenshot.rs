//! A copy of the window's picture.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::barriers::layers;
use super::memory::Buffer;
use super::vulkan::Vulkan;
use ash::vk;
use gpu_allocator::MemoryLocation;
use revmap::error::Result;
use revmap_files::Picture;
use std::rc::Rc;

/// A copy made by the device.
pub struct Screenshot {
    buffer: Buffer,
    extent: vk::Extent2D,
    format: vk::Format,
}

impl Screenshot {
    /// Records the copy of an image.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass. The image has this extent, a format of four bytes, and
    /// a use that allows copies from it.
    pub unsafe fn record(
        host: &Rc<Vulkan>,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        extent: vk::Extent2D,
        format: vk::Format,
    ) -> Result<Self> {
        let bytes = 4 * u64::from(extent.width) * u64::from(extent.height);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(host, "screenshot", bytes, usage, MemoryLocation::GpuToCpu)?;
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers(vk::ImageAspectFlags::COLOR))
            .image_extent(extent.into());
        let read = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        let stages = [
            vk::PipelineStageFlags::TRANSFER,
            vk::PipelineStageFlags::HOST,
        ];
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let (device, none) = (&host.device, vk::DependencyFlags::empty());
        // SAFETY: as the caller promised; the buffer holds the image.
        unsafe {
            device.cmd_copy_image_to_buffer(cmd, image, layout, buffer.raw, &[region]);
            device.cmd_pipeline_barrier(cmd, stages[0], stages[1], none, &[read], &[], &[]);
        }
        Ok(Self {
            buffer,
            extent,
            format,
        })
    }

    /// The picture, opaque, after the device has finished.
    pub fn picture(&self) -> Picture {
        let swapped = self.format == vk::Format::B8G8R8A8_SRGB;
        let pixel = |p: &[u8]| match swapped {
            true => [p[2], p[1], p[0], 255],
            false => [p[0], p[1], p[2], 255],
        };
        let vk::Extent2D { width, height } = self.extent;
        let all = self.buffer.bytes().chunks_exact(4);
        Picture {
            width,
            height,
            rgba: all
                .take(width as usize * height as usize)
                .map(pixel)
                .collect(),
        }
    }
}
