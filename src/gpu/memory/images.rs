//! Images with their memory, and uploads to them: bytes are written to staging buffers at once, and
//! copied by every frame that is prepared until one of these frames has run. A host may drop a
//! prepared frame, and the library does not see submissions.

use super::buffers::{Buffer, Use};
use super::{allocate, bound, free};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::usage::{self, Usage};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The parameters of an image; always 2D, one layer.
#[derive(Clone, Copy, Debug)]
pub struct ImageKind {
    /// Format of colours, or `D32_SFLOAT`.
    pub format: vk::Format,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// Samples of a texel.
    pub samples: vk::SampleCountFlags,
    /// Uses.
    pub usage: vk::ImageUsageFlags,
}

impl ImageKind {
    /// Colour or depth.
    pub fn aspect(&self) -> vk::ImageAspectFlags {
        match self.format {
            vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }

    /// The whole image.
    pub fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(self.aspect())
            .level_count(self.mips)
            .layer_count(1)
    }
}

/// An image with its memory. The owner must wait for the device before dropping it.
pub struct Image {
    /// The image.
    pub raw: vk::Image,
    /// A view of the whole image.
    pub view: vk::ImageView,
    /// The parameters that it was made with.
    pub kind: ImageKind,
    allocation: Option<Allocation>,
    device: Arc<Shared>,
}

impl Image {
    pub(crate) fn new(device: &Arc<Shared>, name: &str, kind: ImageKind) -> Result<Self> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(kind.format)
            .extent(extent(kind.width, kind.height))
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
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.allocation.as_ref().map_or(0, Allocation::size)
    }

    /// Records a barrier between two uses of the image.
    pub(crate) fn barrier(&self, cmd: vk::CommandBuffer, from: Usage, to: Usage) {
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(from.access())
            .dst_access_mask(to.access())
            .old_layout(from.layout())
            .new_layout(to.layout())
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.raw)
            .subresource_range(self.kind.range());
        usage::wait(&self.device.raw, cmd, (from, to), &[], &[barrier]);
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

fn extent(width: u32, height: u32) -> vk::Extent3D {
    vk::Extent3D {
        width,
        height,
        depth: 1,
    }
}

/// Copies of a renderer that no frame is known to have run.
pub(crate) struct Uploads {
    waiting: Vec<Arc<Upload>>,
    device: Arc<Shared>,
}

pub(crate) struct Upload {
    staging: Buffer,
    image: Arc<Image>,
    regions: Vec<vk::BufferImageCopy>,
    has_run: AtomicBool,
}

/// The copies in the commands of a slot's frames. They live until those commands have run.
#[derive(Default)]
pub(crate) struct RecordedUploads(Vec<RecordedUpload>);

struct RecordedUpload {
    upload: Arc<Upload>,
    /// Numbers of the first and last frame of the slot whose commands have the copy. All frames
    /// between have it too.
    frames: [u64; 2],
}

impl RecordedUploads {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Notes that frame `frame` of the slot has run. Earlier frames have run, too, or never will:
    /// frames are submitted in the order in which they were prepared.
    pub fn run(&mut self, frame: u64) {
        self.0.retain(|one| {
            let [first, last] = one.frames;
            if first <= frame && frame <= last {
                one.upload.has_run.store(true, Ordering::Relaxed);
            }
            frame < last
        });
    }

    fn add(&mut self, upload: &Arc<Upload>, frame: u64) {
        let same = |one: &&mut RecordedUpload| Arc::ptr_eq(&one.upload, upload);
        match self.0.iter_mut().find(same) {
            Some(one) => one.frames[1] = frame,
            None => self.0.push(RecordedUpload {
                upload: upload.clone(),
                frames: [frame; 2],
            }),
        }
    }
}

impl Uploads {
    pub fn new(device: &Arc<Shared>) -> Self {
        Self {
            waiting: Vec::new(),
            device: device.clone(),
        }
    }

    /// Makes a sampled image of `levels`: the bytes of each mip level, the largest first.
    pub fn image(
        &mut self,
        name: &str,
        format: vk::Format,
        (width, height): (u32, u32),
        levels: &[&[u8]],
    ) -> Result<Arc<Image>> {
        let device = &self.device;
        let limit = device.limits().max_image_dimension2_d;
        if width > limit || height > limit {
            let message = format!(
                "{name}: {width} x {height} texels, and the device takes {limit} a side; use fewer map rows"
            );
            return Err(Error::new(ErrorKind::TooLarge, message));
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
        let mut staging = Buffer::for_use(device, Use::Upload, "staging", total as u64)?;
        let mut regions = Vec::new();
        let mut at = 0;
        for (level, bytes) in (0u32..).zip(levels) {
            staging.mapped()?[at..at + bytes.len()].copy_from_slice(bytes);
            let layers = vk::ImageSubresourceLayers::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .mip_level(level)
                .layer_count(1);
            let region = vk::BufferImageCopy::default()
                .buffer_offset(at as u64)
                .image_subresource(layers)
                .image_extent(extent((width >> level).max(1), (height >> level).max(1)));
            regions.push(region);
            at += bytes.len().next_multiple_of(16);
        }
        self.waiting.push(Arc::new(Upload {
            staging,
            image: image.clone(),
            regions,
            has_run: AtomicBool::new(false),
        }));
        Ok(image)
    }

    /// Records all copies that no frame is known to have run, for frame `frame` of a slot.
    pub fn record(&mut self, cmd: vk::CommandBuffer, to: &mut RecordedUploads, frame: u64) {
        // Nothing reads an image that only its copy holds.
        let is_due = |upload: &Arc<Upload>| {
            !upload.has_run.load(Ordering::Relaxed) && Arc::strong_count(&upload.image) > 1
        };
        self.waiting.retain(is_due);
        for upload in &self.waiting {
            let image = &upload.image;
            // An earlier frame that has the copy too may still sample the image.
            image.barrier(cmd, Usage::Discarded, Usage::TransferWrite);
            // SAFETY: `cmd` is recording, outside a render pass; the regions are within buffer and
            // image.
            unsafe {
                self.device.raw.cmd_copy_buffer_to_image(
                    cmd,
                    upload.staging.raw,
                    image.raw,
                    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                    &upload.regions,
                );
            }
            image.barrier(cmd, Usage::TransferWrite, Usage::Sampled);
            to.add(upload, frame);
        }
    }
}
