//! Recording, submitting, waiting; GPU timestamps around a piece of work.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use ash::vk;
use std::sync::Arc;

/// One command buffer and the fence that signals its end.
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
            .queue_family_index(device.chosen.family)
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
        self.record(|cmd| {
            record(cmd);
            Ok(())
        })?;
        self.submit_and_wait()
    }

    /// Records by `record`. [`Commands::submit_and_wait`] runs the commands, any number of times.
    pub fn record(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<()> {
        let raw = &self.device.raw;
        // SAFETY: the last submission was waited for, so the buffer is free to record; a recording
        // that failed half way is reset, and its pool allows that.
        unsafe {
            raw.begin_command_buffer(self.buffer, &vk::CommandBufferBeginInfo::default())
                .call("vkBeginCommandBuffer")?;
            let recorded = record(self.buffer).and_then(|()| {
                raw.end_command_buffer(self.buffer)
                    .call("vkEndCommandBuffer")
            });
            if recorded.is_err() {
                raw.reset_command_buffer(self.buffer, vk::CommandBufferResetFlags::empty())
                    .call("vkResetCommandBuffer")?;
            }
            recorded
        }
    }

    /// Runs the commands that were recorded last, and waits for them.
    pub fn submit_and_wait(&self) -> Result<()> {
        let raw = &self.device.raw;
        let buffers = [self.buffer];
        let submit = vk::SubmitInfo::default().command_buffers(&buffers);
        let queue = self
            .device
            .queue
            .as_ref()
            .and_then(|queue| queue.lock().ok())
            .ok_or_else(|| {
                Error::new(
                    ErrorKind::Usage,
                    "the device has no queue to submit to; borrow it with one",
                )
            })?;
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

/// Two timestamps. Times are `None` on a queue without timestamps.
pub(crate) struct Clock {
    pool: Option<vk::QueryPool>,
    device: Arc<Shared>,
}

impl Clock {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let pool = if device.chosen.timestamp_bits > 0 {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2);
            // SAFETY: a plain creation, destroyed in Drop.
            Some(unsafe { device.raw.create_query_pool(&info, None) }.call("vkCreateQueryPool")?)
        } else {
            None
        };
        Ok(Self {
            pool,
            device: device.clone(),
        })
    }

    /// Records the first timestamp, outside any render pass.
    pub fn start(&self, cmd: vk::CommandBuffer) {
        if let Some(pool) = self.pool {
            // SAFETY: `cmd` is recording and the pool is live until it has run.
            unsafe {
                self.device.raw.cmd_reset_query_pool(cmd, pool, 0, 2);
                self.device.raw.cmd_write_timestamp(
                    cmd,
                    vk::PipelineStageFlags::TOP_OF_PIPE,
                    pool,
                    0,
                );
            }
        }
    }

    /// Records the second timestamp, after all work before it.
    pub fn stop(&self, cmd: vk::CommandBuffer) {
        if let Some(pool) = self.pool {
            // SAFETY: as in `start`.
            unsafe {
                self.device.raw.cmd_write_timestamp(
                    cmd,
                    vk::PipelineStageFlags::BOTTOM_OF_PIPE,
                    pool,
                    1,
                );
            }
        }
    }

    /// Milliseconds between the two timestamps, once the work is done.
    pub fn milliseconds(&self) -> Result<Option<f64>> {
        let Some(pool) = self.pool else {
            return Ok(None);
        };
        let mut stamps = [0u64; 2];
        // SAFETY: the work was waited for.
        unsafe {
            self.device.raw.get_query_pool_results(
                pool,
                0,
                &mut stamps,
                vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT,
            )
        }
        .call("vkGetQueryPoolResults")?;
        let ticks = elapsed(stamps, self.device.chosen.timestamp_bits);
        #[allow(clippy::cast_precision_loss)] // frames are shorter than 2^52 ns
        let ns = ticks as f64 * f64::from(self.device.limits().timestamp_period);
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

impl Drop for Clock {
    fn drop(&mut self) {
        if let Some(pool) = self.pool {
            // SAFETY: every submission was waited for.
            unsafe { self.device.raw.destroy_query_pool(pool, None) };
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
