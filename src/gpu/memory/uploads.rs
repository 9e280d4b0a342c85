//! Uploads to the device: bytes are written to staging buffers at once, and copied by the next
//! commands that are prepared.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::buffers::upload;
use crate::gpu::memory::{Buffer, Image, ImageKind};
use crate::gpu::vk::usage::{Usage, image_barrier};
use ash::vk;
use std::sync::Arc;

/// Copies that wait for a renderer's commands.
pub(crate) struct Uploads {
    waiting: Vec<Upload>,
    owner: u32,
}

/// The copy of one image.
pub(crate) struct Upload {
    staging: Buffer,
    image: Arc<Image>,
    regions: Vec<vk::BufferImageCopy>,
}

impl Uploads {
    /// No copies yet, for the renderer of this identity.
    pub fn of(owner: u32) -> Self {
        Self {
            waiting: Vec::new(),
            owner,
        }
    }

    /// The renderer's identity.
    pub fn owner(&self) -> u32 {
        self.owner
    }

    /// Makes a sampled image of `levels`: the bytes of each mip level, the largest first.
    pub fn image(
        &mut self,
        device: &Arc<Shared>,
        name: &str,
        format: vk::Format,
        (width, height): (u32, u32),
        levels: &[&[u8]],
    ) -> Result<Arc<Image>> {
        let limit = device.limits.max_image_dimension2_d;
        if width > limit || height > limit {
            return Err(Error::new(
                ErrorKind::TooLarge,
                format!(
                    "{name}: {width} x {height} texels, and the device takes {limit} a side; use fewer map rows"
                ),
            ));
        }
        let kind = ImageKind {
            format,
            width,
            height,
            mips: u32::try_from(levels.len()).unwrap_or(1),
            samples: vk::SampleCountFlags::TYPE_1,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
        };
        let image = Arc::new(Image::new(device, name, kind)?);
        let total: usize = levels.iter().map(|l| l.len().next_multiple_of(16)).sum();
        let mut staging = upload(device, "staging", total as u64)?;
        let mut regions = Vec::new();
        let mut at = 0;
        for (level, bytes) in (0u32..).zip(levels) {
            staging.mapped()?[at..at + bytes.len()].copy_from_slice(bytes);
            let layers = vk::ImageSubresourceLayers::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .mip_level(level)
                .layer_count(1);
            regions.push(
                vk::BufferImageCopy::default()
                    .buffer_offset(at as u64)
                    .image_subresource(layers)
                    .image_extent(vk::Extent3D {
                        width: (width >> level).max(1),
                        height: (height >> level).max(1),
                        depth: 1,
                    }),
            );
            at += bytes.len().next_multiple_of(16);
        }
        self.waiting.push(Upload {
            staging,
            image: image.clone(),
            regions,
        });
        Ok(image)
    }

    /// Records all copies. The returned values must live until the copies have run.
    #[must_use]
    pub fn record(&mut self, device: &Shared, cmd: vk::CommandBuffer) -> Vec<Upload> {
        for upload in &self.waiting {
            let image = &upload.image;
            image_barrier(device, cmd, image, Usage::Nothing, Usage::TransferWrite);
            // SAFETY: `cmd` is recording, outside a render pass; the regions are within buffer and
            // image.
            unsafe {
                device.raw.cmd_copy_buffer_to_image(
                    cmd,
                    upload.staging.raw,
                    image.raw,
                    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                    &upload.regions,
                );
            }
            image_barrier(device, cmd, image, Usage::TransferWrite, Usage::Sampled);
        }
        std::mem::take(&mut self.waiting)
    }
}
