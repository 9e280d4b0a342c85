//! The target of the compute stage, and its transfer to the window by copies on the device.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::barriers::{Use, change, layers};
use super::memory::{Buffer, Image};
use super::vulkan::Vulkan;
use ash::vk;
use gpu_allocator::MemoryLocation;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::ComputeTarget;
use std::rc::Rc;

/// Two words per pixel, depths then colours, and an image of the colours. All frames in flight
/// share one buffer and one image, like the depth buffer in the fragment stage: frames follow each
/// other on the device.
pub struct Traced {
    words: Buffer,
    picture: Image,
    extent: vk::Extent2D,
    host: Rc<Vulkan>,
}

/// Uses of the words, in order.
#[derive(Clone, Copy)]
enum Words {
    Cleared,
    Traced,
    Copied,
}

impl Words {
    fn stage(self) -> vk::PipelineStageFlags {
        match self {
            Self::Traced => vk::PipelineStageFlags::COMPUTE_SHADER,
            Self::Cleared | Self::Copied => vk::PipelineStageFlags::TRANSFER,
        }
    }

    fn access(self) -> vk::AccessFlags {
        match self {
            Self::Cleared => vk::AccessFlags::TRANSFER_WRITE,
            Self::Traced => vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE,
            Self::Copied => vk::AccessFlags::TRANSFER_READ,
        }
    }
}

impl Traced {
    pub fn new(host: &Rc<Vulkan>, extent: vk::Extent2D) -> Result<Self> {
        let bytes = 8 * u64::from(extent.width) * u64::from(extent.height);
        // SAFETY: a plain query.
        let properties = unsafe { host.instance.get_physical_device_properties(host.physical) };
        let most = u64::from(properties.limits.max_storage_buffer_range);
        if bytes > most {
            let message = format!(
                "the compute stage takes {} pixels on this device; make the window smaller",
                most / 8
            );
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        use vk::{BufferUsageFlags as B, ImageUsageFlags as I};
        let usage = B::STORAGE_BUFFER | B::TRANSFER_DST | B::TRANSFER_SRC;
        let (format, copied) = (vk::Format::R8G8B8A8_SRGB, I::TRANSFER_DST | I::TRANSFER_SRC);
        Ok(Self {
            words: Buffer::new(host, "pixel words", bytes, usage, MemoryLocation::GpuOnly)?,
            picture: Image::new(host, "traced picture", format, extent, copied)?,
            extent,
            host: host.clone(),
        })
    }

    /// The target for the renderer.
    pub fn target(&self) -> ComputeTarget {
        ComputeTarget {
            words: self.words.raw,
            images: Vec::new(),
            depths: true,
        }
    }

    /// Records the clearing of the former frame's content.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; `self` lives until it has run.
    pub unsafe fn clear(&self, cmd: vk::CommandBuffer, [r, g, b, _]: [f32; 4]) {
        let half = 4 * u64::from(self.extent.width) * u64::from(self.extent.height);
        let background = ComputeTarget::color_word([r, g, b, 1.0]);
        let device = &self.host.device;
        // SAFETY: as the caller promised; both ranges lie within the buffer.
        unsafe {
            self.pass_on(cmd, Words::Copied, Words::Cleared);
            device.cmd_fill_buffer(cmd, self.words.raw, 0, half, 1f32.to_bits());
            device.cmd_fill_buffer(cmd, self.words.raw, half, half, background);
            self.pass_on(cmd, Words::Cleared, Words::Traced);
        }
    }

    /// Records the copy of the traced colours into a picture of the window, which can be drawn into
    /// afterwards.
    ///
    /// # Safety
    /// The conditions of [`Traced::clear`]; the frame was traced. The window's picture has the same
    /// extent, and nothing has used it since it was acquired.
    pub unsafe fn show(&self, cmd: vk::CommandBuffer, window: vk::Image) {
        let (extent, picture) = (self.extent, self.picture.raw);
        let color = vk::ImageAspectFlags::COLOR;
        let colors = vk::BufferImageCopy::default()
            .buffer_offset(4 * u64::from(extent.width) * u64::from(extent.height))
            .image_subresource(layers(color))
            .image_extent(extent.into());
        let corners = [
            vk::Offset3D::default(),
            vk::Offset3D {
                x: extent.width as i32,
                y: extent.height as i32,
                z: 1,
            },
        ];
        // The channels' order may differ; the blit converts it.
        let all = vk::ImageBlit::default()
            .src_subresource(layers(color))
            .src_offsets(corners)
            .dst_subresource(layers(color))
            .dst_offsets(corners);
        let (host, device) = (&*self.host, &self.host.device);
        let (from, to) = (
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        );
        // SAFETY: as the caller promised; the buffer holds the image.
        unsafe {
            self.pass_on(cmd, Words::Traced, Words::Copied);
            let own = (picture, color);
            change(host, cmd, own, Use::COPIED_FROM.discarded(), Use::COPIED_TO);
            device.cmd_copy_buffer_to_image(cmd, self.words.raw, picture, to, &[colors]);
            change(host, cmd, own, Use::COPIED_TO, Use::COPIED_FROM);
            let shown = (window, color);
            change(host, cmd, shown, Use::COPIED_TO.discarded(), Use::COPIED_TO);
            let nearest = vk::Filter::NEAREST;
            device.cmd_blit_image(cmd, picture, from, window, to, &[all], nearest);
            change(host, cmd, shown, Use::COPIED_TO, Use::COLOR);
        }
    }

    /// Records the barrier between two uses of the words.
    unsafe fn pass_on(&self, cmd: vk::CommandBuffer, from: Words, to: Words) {
        let barrier = vk::BufferMemoryBarrier::default()
            .src_access_mask(from.access())
            .dst_access_mask(to.access())
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .buffer(self.words.raw)
            .size(vk::WHOLE_SIZE);
        let (device, none) = (&self.host.device, vk::DependencyFlags::empty());
        let stages = [from.stage(), to.stage()];
        // SAFETY: as the callers promised.
        unsafe {
            device.cmd_pipeline_barrier(cmd, stages[0], stages[1], none, &[], &[barrier], &[]);
        }
    }
}
