//! Command buffers, and commands that are waited for.

use super::{Fallible, Host};
use ash::vk;

/// Command buffers, which may be recorded again, and their pool.
pub struct Commands<'a> {
    pub raw: Vec<vk::CommandBuffer>,
    pool: vk::CommandPool,
    host: &'a Host,
}

impl<'a> Commands<'a> {
    pub fn new(host: &'a Host, level: vk::CommandBufferLevel, count: usize) -> Fallible<Self> {
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(host.family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let pool = host.device.create_command_pool(&pool, None)?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .level(level)
                .command_buffer_count(count as u32);
            let raw = host.device.allocate_command_buffers(&info)?;
            Ok(Self { raw, pool, host })
        }
    }
}

impl Drop for Commands<'_> {
    fn drop(&mut self) {
        // SAFETY: the commands have run.
        unsafe { self.host.device.destroy_command_pool(self.pool, None) };
    }
}

/// Records commands. With `submits` submits them and waits.
pub fn commands<T>(
    host: &Host,
    submits: bool,
    record: impl FnOnce(vk::CommandBuffer) -> T,
) -> Fallible<T> {
    let device = &host.device;
    let own = Commands::new(host, vk::CommandBufferLevel::PRIMARY, 1)?;
    // SAFETY: the commands are recorded once, and waited for.
    unsafe {
        device.begin_command_buffer(own.raw[0], &vk::CommandBufferBeginInfo::default())?;
        let made = record(own.raw[0]);
        device.end_command_buffer(own.raw[0])?;
        if submits {
            let submit = [vk::SubmitInfo::default().command_buffers(&own.raw)];
            device.queue_submit(host.queue, &submit, vk::Fence::null())?;
            device.queue_wait_idle(host.queue)?;
        }
        Ok(made)
    }
}
