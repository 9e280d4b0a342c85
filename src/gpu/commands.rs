//! Recording, submitting, waiting; and uploads through a staging buffer.

use super::call::Call;
use super::device::Shared;
use super::memory::{Buffer, Image};
use super::usage::{Usage, buffer_barrier, image_barrier};
use crate::error::{Error, Result, Stage};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::sync::Arc;

/// One command buffer and the fence that tells when it has run.
pub(crate) struct Commands {
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    device: Arc<Shared>,
}

impl Commands {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let mut commands = Self {
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            device: device.clone(),
        };
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(device.family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: plain creations, destroyed in Drop; a half-made value drops its null handles.
        unsafe {
            commands.pool = device
                .raw
                .create_command_pool(&pool, None)
                .call("vkCreateCommandPool")?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(commands.pool)
                .command_buffer_count(1);
            commands.buffer = device
                .raw
                .allocate_command_buffers(&info)
                .call("vkAllocateCommandBuffers")?
                .into_iter()
                .next()
                .unwrap_or_default();
            commands.fence = device
                .raw
                .create_fence(&vk::FenceCreateInfo::default(), None)
                .call("vkCreateFence")?;
        }
        Ok(commands)
    }

    /// Records by `record`, submits, and waits until the GPU is done.
    pub fn run(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<()> {
        self.record(record)?;
        self.submit_and_wait()
    }

    /// Records by `record`; [`Commands::submit_and_wait`] runs it, as often as wanted.
    pub fn record(&self, record: impl FnOnce(vk::CommandBuffer)) -> Result<()> {
        let raw = &self.device.raw;
        // SAFETY: the last submission was waited for, so the buffer is free to record.
        unsafe {
            raw.begin_command_buffer(self.buffer, &vk::CommandBufferBeginInfo::default())
                .call("vkBeginCommandBuffer")?;
            record(self.buffer);
            raw.end_command_buffer(self.buffer)
                .call("vkEndCommandBuffer")
        }
    }

    /// Runs what was recorded last and waits for it.
    pub fn submit_and_wait(&self) -> Result<()> {
        let raw = &self.device.raw;
        let buffers = [self.buffer];
        let submit = vk::SubmitInfo::default().command_buffers(&buffers);
        let queue = self
            .device
            .queue
            .lock()
            .map_err(|_| Error::new(Stage::Draw, "the queue's lock is poisoned"))?;
        // SAFETY: the buffer is recorded and not pending; queue access is serialised by the lock.
        unsafe {
            raw.queue_submit(*queue, &[submit], self.fence)
                .call("vkQueueSubmit")?;
        }
        drop(queue);
        // SAFETY: the fence is live and was just submitted.
        unsafe {
            raw.wait_for_fences(&[self.fence], true, u64::MAX)
                .call("vkWaitForFences")?;
            raw.reset_fences(&[self.fence]).call("vkResetFences")
        }
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for; null handles may be destroyed.
        unsafe {
            self.device.raw.destroy_fence(self.fence, None);
            self.device.raw.destroy_command_pool(self.pool, None);
        }
    }
}

/// Makes a sampled image of `levels`, the bytes of each mip level from the largest.
pub(crate) fn upload_texture(
    device: &Arc<Shared>,
    commands: &Commands,
    name: &str,
    format: vk::Format,
    size: (u32, u32),
    levels: &[&[u8]],
) -> Result<Image> {
    let (width, height) = size;
    let limit = device.limits.max_image_dimension2_d;
    if width > limit || height > limit {
        return Err(Error::new(
            Stage::Draw,
            format!(
                "{name}: {width} x {height} texels, and the device takes {limit} a side; use fewer map rows"
            ),
        ));
    }
    let kind = super::memory::ImageKind {
        format,
        width,
        height,
        mips: u32::try_from(levels.len()).unwrap_or(1),
        usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
    };
    let image = Image::new(device, name, kind)?;
    let total: usize = levels.iter().map(|l| l.len().next_multiple_of(16)).sum();
    let mut staging = Buffer::new(
        device,
        "staging",
        total as u64,
        vk::BufferUsageFlags::TRANSFER_SRC,
        MemoryLocation::CpuToGpu,
    )?;
    let mut regions = Vec::new();
    let mut at = 0;
    for (level, bytes) in (0u32..).zip(levels) {
        staging.mapped()?[at..at + bytes.len()].copy_from_slice(bytes);
        regions.push(
            vk::BufferImageCopy::default()
                .buffer_offset(at as u64)
                .image_subresource(
                    vk::ImageSubresourceLayers::default()
                        .aspect_mask(vk::ImageAspectFlags::COLOR)
                        .mip_level(level)
                        .layer_count(1),
                )
                .image_extent(vk::Extent3D {
                    width: (width >> level).max(1),
                    height: (height >> level).max(1),
                    depth: 1,
                }),
        );
        at += bytes.len().next_multiple_of(16);
    }
    commands.run(|cmd| {
        image_barrier(device, cmd, &image, Usage::Nothing, Usage::TransferWrite);
        // SAFETY: the regions lie within buffer and image, both alive until `run` returns.
        unsafe {
            device.raw.cmd_copy_buffer_to_image(
                cmd,
                staging.raw,
                image.raw,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &regions,
            );
        }
        image_barrier(device, cmd, &image, Usage::TransferWrite, Usage::Sampled);
    })?;
    Ok(image)
}

/// Makes a buffer of vertices or indices in the device's own memory.
pub(crate) fn upload_buffer(
    device: &Arc<Shared>,
    commands: &Commands,
    name: &str,
    usage: vk::BufferUsageFlags,
    bytes: &[u8],
) -> Result<Buffer> {
    let size = bytes.len() as u64;
    let buffer = |name, usage, location| Buffer::new(device, name, size, usage, location);
    let mut staging = buffer(
        "staging",
        vk::BufferUsageFlags::TRANSFER_SRC,
        MemoryLocation::CpuToGpu,
    )?;
    staging.mapped()?[..bytes.len()].copy_from_slice(bytes);
    let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
    let made = buffer(name, usage, MemoryLocation::GpuOnly)?;
    if size > 0 {
        commands.run(|cmd| {
            let region = vk::BufferCopy::default().size(size);
            // SAFETY: the region lies within both buffers, alive until `run` returns.
            unsafe {
                device
                    .raw
                    .cmd_copy_buffer(cmd, staging.raw, made.raw, &[region]);
            }
            let (from, to) = (Usage::TransferWrite, Usage::VertexInput);
            buffer_barrier(device, cmd, &made, from, to);
        })?;
    }
    Ok(made)
}
