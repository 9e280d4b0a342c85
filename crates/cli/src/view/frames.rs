//! Commands of the frames in flight, and their times on the device.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::vulkan::{Vulkan, vulkan};
use ash::vk;
use revmap::error::Result;
use std::rc::Rc;

/// Frames in flight.
pub const FRAMES: usize = 2;

/// The objects of one frame in flight.
#[derive(Clone, Copy, Default)]
struct Slot {
    commands: vk::CommandBuffer,
    acquired: vk::Semaphore,
    done: vk::Fence,
    /// True if its timers were written.
    timed: bool,
}

pub struct Frames {
    /// The pool, also for the copies of egui.
    pub pool: vk::CommandPool,
    slots: [Slot; FRAMES],
    timers: vk::QueryPool,
    /// The slot of the next frame.
    next: usize,
    host: Rc<Vulkan>,
}

impl Frames {
    pub fn new(host: &Rc<Vulkan>) -> Result<Self> {
        let device = &host.device;
        let mut made = Self {
            pool: vk::CommandPool::null(),
            slots: [Slot::default(); FRAMES],
            timers: vk::QueryPool::null(),
            next: 0,
            host: host.clone(),
        };
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let info = vk::CommandPoolCreateInfo::default()
                .queue_family_index(host.family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&info, None);
            made.pool = vulkan(pool, "vkCreateCommandPool")?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(made.pool)
                .command_buffer_count(FRAMES as u32);
            let all = device.allocate_command_buffers(&info);
            let all = vulkan(all, "vkAllocateCommandBuffers")?;
            for (slot, commands) in made.slots.iter_mut().zip(all) {
                slot.commands = commands;
                let acquired = device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
                slot.acquired = vulkan(acquired, "vkCreateSemaphore")?;
                let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
                slot.done = vulkan(device.create_fence(&signaled, None), "vkCreateFence")?;
            }
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2 * FRAMES as u32);
            made.timers = vulkan(device.create_query_pool(&info, None), "vkCreateQueryPool")?;
        }
        Ok(made)
    }

    /// Waits until the device is done with the next slot. Returns the slot and a semaphore that
    /// nothing waits for.
    pub fn wait(&self) -> Result<(usize, vk::Semaphore)> {
        self.wait_for(self.next)?;
        Ok((self.next, self.slots[self.next].acquired))
    }

    /// Waits until the device is done with a slot.
    pub fn wait_for(&self, slot: usize) -> Result<()> {
        // SAFETY: a live fence.
        let waited = unsafe {
            self.host
                .device
                .wait_for_fences(&[self.slots[slot].done], true, u64::MAX)
        };
        vulkan(waited, "vkWaitForFences")
    }

    /// Begins the commands of a slot that was waited for, and starts its timer.
    pub fn begin(&self, slot: usize) -> Result<vk::CommandBuffer> {
        let (device, commands) = (&self.host.device, self.slots[slot].commands);
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot's commands have run.
        unsafe {
            let begun = device.begin_command_buffer(commands, &info);
            vulkan(begun, "vkBeginCommandBuffer")?;
            if self.host.timestamp_ns > 0.0 {
                let (first, top) = (2 * slot as u32, vk::PipelineStageFlags::TOP_OF_PIPE);
                device.cmd_reset_query_pool(commands, self.timers, first, 2);
                device.cmd_write_timestamp(commands, top, self.timers, first);
            }
        }
        Ok(commands)
    }

    /// Milliseconds of device time of the former frame in this slot, which was waited for.
    pub fn device_ms(&self, slot: usize) -> Option<f64> {
        if !self.slots[slot].timed {
            return None;
        }
        let mut ticks = [0u64; 2];
        let (first, flags) = (2 * slot as u32, vk::QueryResultFlags::TYPE_64);
        let device = &self.host.device;
        // SAFETY: both timers were written.
        let read = unsafe { device.get_query_pool_results(self.timers, first, &mut ticks, flags) };
        let span = ticks[1].saturating_sub(ticks[0]) as f64;
        read.is_ok().then_some(span * self.host.timestamp_ns * 1e-6)
    }

    /// Ends the commands of a slot and submits them: `stages` wait for the slot's semaphore, and
    /// `drawn` is signalled at the end. The next frame uses the next slot.
    pub fn submit(
        &mut self,
        slot: usize,
        stages: vk::PipelineStageFlags,
        drawn: vk::Semaphore,
    ) -> Result<()> {
        let device = &self.host.device;
        let Slot {
            commands,
            acquired,
            done,
            timed,
        } = &mut self.slots[slot];
        // SAFETY: the commands are recording, outside of a pass; what they use lives until the
        // fence says that it is done.
        unsafe {
            if self.host.timestamp_ns > 0.0 {
                let (last, bottom) = (2 * slot as u32 + 1, vk::PipelineStageFlags::BOTTOM_OF_PIPE);
                device.cmd_write_timestamp(*commands, bottom, self.timers, last);
                *timed = true;
            }
            vulkan(device.end_command_buffer(*commands), "vkEndCommandBuffer")?;
            vulkan(device.reset_fences(&[*done]), "vkResetFences")?;
            let (commands, waits, signals) = ([*commands], [*acquired], [drawn]);
            let submit = [vk::SubmitInfo::default()
                .wait_semaphores(&waits)
                .wait_dst_stage_mask(std::slice::from_ref(&stages))
                .command_buffers(&commands)
                .signal_semaphores(&signals)];
            let submitted = device.queue_submit(self.host.queue, &submit, *done);
            vulkan(submitted, "vkQueueSubmit")?;
        }
        self.next = (slot + 1) % FRAMES;
        Ok(())
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
        self.host.wait();
        // SAFETY: the device is idle; null handles may be destroyed.
        unsafe {
            let device = &self.host.device;
            for slot in &self.slots {
                device.destroy_semaphore(slot.acquired, None);
                device.destroy_fence(slot.done, None);
            }
            device.destroy_query_pool(self.timers, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}
