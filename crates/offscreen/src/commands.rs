//! One command buffer: recording, submitting, waiting, and two timestamps.

use ash::vk;
use revmap::error::{Error, Result};
use revmap::gpu::{Device, vulkan_error};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The times of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds that the CPU took to apply changes and to record.
    pub prepare_ms: f64,
    /// Milliseconds between GPU timestamps around the work; `None` if the device has no timestamps.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission to completion by the wall clock.
    pub frame_ms: f64,
    /// Submissions of the frame, each of some rows
    /// ([`OffscreenOptions::submission_ms`](crate::OffscreenOptions::submission_ms)). The times are
    /// sums.
    pub submissions: u32,
}

impl Times {
    /// Adds those of another frame.
    pub fn add(&mut self, other: Self) {
        self.gpu_ms = match (self.submissions, other.submissions) {
            (0, _) => other.gpu_ms,
            (_, 0) => self.gpu_ms,
            _ => self.gpu_ms.zip(other.gpu_ms).map(|(a, b)| a + b),
        };
        self.prepare_ms += other.prepare_ms;
        self.frame_ms += other.frame_ms;
        self.submissions += other.submissions;
    }
}

/// A command buffer, the fence that signals its end, and the queries of its timestamps.
pub(crate) struct Commands {
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    /// True from a submission until a wait for its end has succeeded.
    pending: AtomicBool,
    /// Null on a queue without timestamps.
    queries: vk::QueryPool,
    /// Bits of a timestamp that are valid.
    bits: u32,
    /// Nanoseconds of a tick.
    period: f32,
    device: Device,
}

/// Adds the name of the failed call to Vulkan's result.
pub(crate) fn failed(name: &str) -> impl FnOnce(vk::Result) -> Error {
    move |code| vulkan_error(name, code)
}

impl Commands {
    pub fn new(device: &Device) -> Result<Self> {
        let (instance, raw, family) = (device.instance(), device.raw(), device.queue_family());
        // SAFETY: plain queries of the device's own physical device.
        let (limits, families) = unsafe {
            let physical = device.physical();
            (
                instance.get_physical_device_properties(physical).limits,
                instance.get_physical_device_queue_family_properties(physical),
            )
        };
        let family_of = families.get(family as usize);
        let mut commands = Self {
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            pending: AtomicBool::new(false),
            queries: vk::QueryPool::null(),
            bits: family_of.map_or(0, |family| family.timestamp_valid_bits),
            period: limits.timestamp_period,
            device: device.clone(),
        };
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        let queries = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::TIMESTAMP)
            .query_count(2);
        // SAFETY: plain creations, destroyed in Drop; a half-made value drops its null handles.
        unsafe {
            commands.pool =
                (raw.create_command_pool(&pool, None)).map_err(failed("vkCreateCommandPool"))?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(commands.pool)
                .command_buffer_count(1);
            let buffers = raw.allocate_command_buffers(&info);
            let buffers = buffers.map_err(failed("vkAllocateCommandBuffers"))?;
            commands.buffer = buffers.first().copied().unwrap_or_default();
            let fence = vk::FenceCreateInfo::default();
            commands.fence = raw
                .create_fence(&fence, None)
                .map_err(failed("vkCreateFence"))?;
            if commands.bits > 0 {
                commands.queries =
                    (raw.create_query_pool(&queries, None)).map_err(failed("vkCreateQueryPool"))?;
            }
        }
        Ok(commands)
    }

    /// Records by `record`, submits, and waits until the device is done. Returns the times but for
    /// that of the device. After a wait that failed, the next call waits again before it records.
    pub fn run(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<Times> {
        self.wait()?;
        // SAFETY: no submission with the fence is pending.
        unsafe { self.device.raw().reset_fences(&[self.fence]) }
            .map_err(failed("vkResetFences"))?;
        let start = Instant::now();
        self.record(record)?;
        let prepare_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        // SAFETY: the buffer is recorded and not pending, and the fence is not signaled.
        unsafe { self.device.submit(self.buffer, self.fence) }?;
        self.pending.store(true, Ordering::Relaxed);
        self.wait()?;
        Ok(Times {
            prepare_ms,
            gpu_ms: None,
            frame_ms: start.elapsed().as_secs_f64() * 1e3,
            submissions: 1,
        })
    }

    /// Waits for the last submission. Before this succeeds, nothing that it uses may be changed or
    /// destroyed, unless the device is lost.
    pub fn wait(&self) -> Result<()> {
        if self.pending.load(Ordering::Relaxed) {
            let raw = self.device.raw();
            // SAFETY: the fence was submitted.
            unsafe { raw.wait_for_fences(&[self.fence], true, u64::MAX) }
                .map_err(failed("vkWaitForFences"))?;
            self.pending.store(false, Ordering::Relaxed);
        }
        Ok(())
    }

    fn record(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<()> {
        let raw = self.device.raw();
        // SAFETY: the last submission was waited for, so the buffer is free to record; a recording
        // that failed half way is reset, and its pool allows that.
        unsafe {
            raw.begin_command_buffer(self.buffer, &vk::CommandBufferBeginInfo::default())
                .map_err(failed("vkBeginCommandBuffer"))?;
            let recorded = record(self.buffer).and_then(|()| {
                raw.end_command_buffer(self.buffer)
                    .map_err(failed("vkEndCommandBuffer"))
            });
            if recorded.is_err() {
                raw.reset_command_buffer(self.buffer, vk::CommandBufferResetFlags::empty())
                    .map_err(failed("vkResetCommandBuffer"))?;
            }
            recorded
        }
    }

    /// Records the first timestamp, outside any render pass.
    pub fn start_clock(&self, cmd: vk::CommandBuffer) {
        if self.bits > 0 {
            let stage = vk::PipelineStageFlags::TOP_OF_PIPE;
            let raw = self.device.raw();
            // SAFETY: `cmd` is recording and the pool is live until it has run.
            unsafe {
                raw.cmd_reset_query_pool(cmd, self.queries, 0, 2);
                raw.cmd_write_timestamp(cmd, stage, self.queries, 0);
            }
        }
    }

    /// Records the second timestamp, after all work before it.
    pub fn stop_clock(&self, cmd: vk::CommandBuffer) {
        if self.bits > 0 {
            let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
            // SAFETY: as in `start_clock`.
            unsafe { (self.device.raw()).cmd_write_timestamp(cmd, stage, self.queries, 1) };
        }
    }

    /// Milliseconds between the two timestamps, once they were waited for; `None` on a queue without
    /// timestamps.
    pub fn gpu_ms(&self) -> Result<Option<f64>> {
        if self.bits == 0 {
            return Ok(None);
        }
        let mut stamps = [0u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        let raw = self.device.raw();
        // SAFETY: the work was waited for.
        unsafe { raw.get_query_pool_results(self.queries, 0, &mut stamps, flags) }
            .map_err(failed("vkGetQueryPoolResults"))?;
        #[allow(clippy::cast_precision_loss)] // frames are shorter than 2^52 ns
        let ns = elapsed(stamps, self.bits) as f64 * f64::from(self.period);
        Ok(Some(ns * 1e-6))
    }
}

/// The ticks between two timestamps, of which only the low `bits` count. A counter that began again
/// between them is right, unless it ran through all its values.
fn elapsed([start, end]: [u64; 2], bits: u32) -> u64 {
    let mask = match bits {
        64.. => u64::MAX,
        _ => (1 << bits) - 1,
    };
    end.wrapping_sub(start) & mask
}

impl Drop for Commands {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the owner has waited for the last submission; null handles may be destroyed.
        unsafe {
            raw.destroy_query_pool(self.queries, None);
            raw.destroy_fence(self.fence, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::elapsed;

    /// Vulkan allows 36 to 64 valid bits. Bits above them may be anything here.
    #[test]
    fn a_counter_that_begins_again_is_right() {
        for bits in [36, 48, 63, 64] {
            let end = u64::MAX >> (64 - bits);
            assert_eq!(elapsed([7, 1007], bits), 1000, "{bits} bits");
            assert_eq!(elapsed([end - 9, 990], bits), 1000, "{bits} bits");
            assert_eq!(elapsed([end, 0], bits), 1, "{bits} bits");
            assert_eq!(elapsed([end, end], bits), 0, "{bits} bits");
        }
        let above = 0xabc << 36;
        assert_eq!(elapsed([5 | above, 12], 36), 7);
        assert_eq!(elapsed([5, 12 | above], 36), 7);
        // One bit too many reads the start of the counter as an age.
        assert!(elapsed([(1 << 36) - 1, 0], 37) > 1 << 35);
    }
}
