//! GPU timestamps around a piece of work.

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::vk::call::Call;
use ash::vk;
use std::sync::Arc;

/// Two timestamps. Times are `None` on a queue without timestamps.
pub(crate) struct Clock {
    pool: Option<vk::QueryPool>,
    device: Arc<Shared>,
}

impl Clock {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let pool = if device.timestamp_bits > 0 {
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
        let bits = self.device.timestamp_bits;
        let mask = if bits >= 64 {
            u64::MAX
        } else {
            (1 << bits) - 1
        };
        let ticks = stamps[1].wrapping_sub(stamps[0]) & mask;
        #[allow(clippy::cast_precision_loss)] // frames are shorter than 2^52 ns
        let ns = ticks as f64 * f64::from(self.device.limits.timestamp_period);
        Ok(Some(ns * 1e-6))
    }
}

impl Drop for Clock {
    fn drop(&mut self) {
        if let Some(pool) = self.pool {
            // SAFETY: every submission was waited for.
            unsafe { self.device.raw.destroy_query_pool(pool, None) };
        }
    }
}
