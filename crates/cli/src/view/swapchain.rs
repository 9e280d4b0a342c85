//! The window's pictures: a swapchain, a depth buffer, commands of the frames in flight.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::vulkan::{Vulkan, vulkan};
use ash::{khr, vk};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use revmap::error::{Error, Result, Stage};
use revmap::frame::Picture;
use std::rc::Rc;

pub const FRAMES: usize = 2;
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// What one frame in flight needs.
struct Slot {
    commands: vk::CommandBuffer,
    acquired: vk::Semaphore,
    done: vk::Fence,
}

pub struct Swapchain {
    functions: khr::swapchain::Device,
    chain: vk::SwapchainKHR,
    images: Vec<(vk::Image, vk::ImageView, vk::Semaphore)>,
    depth: (vk::Image, vk::ImageView, Option<Allocation>),
    pub extent: vk::Extent2D,
    pub format: vk::SurfaceFormatKHR,
    pool: vk::CommandPool,
    slots: Vec<Slot>,
    timers: vk::QueryPool,
    /// Whether a slot's timers were written.
    timed: [bool; FRAMES],
    next: usize,
    host: Rc<Vulkan>,
}

/// A frame that is being recorded.
#[derive(Clone, Copy)]
pub struct Recording {
    pub commands: vk::CommandBuffer,
    pub slot: usize,
    image: usize,
}

/// What a frame needs before it can go on.
pub enum Begun {
    Frame(Recording),
    /// The window has another size, or its pictures are lost: [`Swapchain::resize`].
    Stale,
}

impl Swapchain {
    pub fn new(host: &Rc<Vulkan>, size: (u32, u32)) -> Result<Self> {
        let device = &host.device;
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let formats = host
                .surfaces
                .get_physical_device_surface_formats(host.physical, host.surface);
            let formats = vulkan(formats, "vkGetPhysicalDeviceSurfaceFormatsKHR")?;
            let srgb = |f: &&vk::SurfaceFormatKHR| {
                [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB].contains(&f.format)
            };
            let none = || Error::new(Stage::Device, "the window takes no sRGB pictures of 8 bits");
            let format = *formats.iter().find(srgb).ok_or_else(none)?;
            let pool = vk::CommandPoolCreateInfo::default()
                .queue_family_index(host.family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = vulkan(
                device.create_command_pool(&pool, None),
                "vkCreateCommandPool",
            )?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES as u32);
            let mut slots = Vec::new();
            for commands in vulkan(
                device.allocate_command_buffers(&info),
                "vkAllocateCommandBuffers",
            )? {
                let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
                let acquired = device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
                slots.push(Slot {
                    commands,
                    acquired: vulkan(acquired, "vkCreateSemaphore")?,
                    done: vulkan(device.create_fence(&signaled, None), "vkCreateFence")?,
                });
            }
            let timers = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2 * FRAMES as u32);
            let timers = vulkan(device.create_query_pool(&timers, None), "vkCreateQueryPool")?;
            let mut made = Self {
                functions: khr::swapchain::Device::new(&host.instance, device),
                chain: vk::SwapchainKHR::null(),
                images: Vec::new(),
                depth: (vk::Image::null(), vk::ImageView::null(), None),
                extent: vk::Extent2D::default(),
                format,
                pool,
                slots,
                timers,
                timed: [false; FRAMES],
                next: 0,
                host: host.clone(),
            };
            made.resize(size)?;
            Ok(made)
        }
    }

    /// Makes pictures of another size, for a window that is not minimised.
    pub fn resize(&mut self, (width, height): (u32, u32)) -> Result<()> {
        let host = self.host.clone();
        host.wait();
        // SAFETY: the device is idle; the old chain is retired by the new one, and destroyed.
        unsafe {
            let can = host
                .surfaces
                .get_physical_device_surface_capabilities(host.physical, host.surface);
            let can = vulkan(can, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")?;
            let (low, high) = (can.min_image_extent, can.max_image_extent);
            self.extent = if can.current_extent.width == u32::MAX {
                vk::Extent2D {
                    width: width.clamp(low.width, high.width),
                    height: height.clamp(low.height, high.height),
                }
            } else {
                can.current_extent
            };
            let most = if can.max_image_count == 0 {
                u32::MAX
            } else {
                can.max_image_count
            };
            let info = vk::SwapchainCreateInfoKHR::default()
                .surface(host.surface)
                .min_image_count((can.min_image_count + 1).min(most))
                .image_format(self.format.format)
                .image_color_space(self.format.color_space)
                .image_extent(self.extent)
                .image_array_layers(1)
                .image_usage(
                    vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
                )
                .pre_transform(can.current_transform)
                .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
                .present_mode(vk::PresentModeKHR::FIFO)
                .clipped(true)
                .old_swapchain(self.chain);
            let chain = vulkan(
                self.functions.create_swapchain(&info, None),
                "vkCreateSwapchainKHR",
            )?;
            self.destroy_images();
            self.chain = chain;
            for image in vulkan(
                self.functions.get_swapchain_images(chain),
                "vkGetSwapchainImagesKHR",
            )? {
                let view = self.view(image, self.format.format, vk::ImageAspectFlags::COLOR)?;
                let drawn = host
                    .device
                    .create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
                self.images
                    .push((image, view, vulkan(drawn, "vkCreateSemaphore")?));
            }
            self.make_depth()
        }
    }

    unsafe fn view(
        &self,
        image: vk::Image,
        format: vk::Format,
        aspect: vk::ImageAspectFlags,
    ) -> Result<vk::ImageView> {
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range(aspect));
        // SAFETY: a live image of this format.
        vulkan(
            unsafe { self.host.device.create_image_view(&info, None) },
            "vkCreateImageView",
        )
    }

    unsafe fn make_depth(&mut self) -> Result<()> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(DEPTH)
            .extent(self.extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT);
        // SAFETY: plain creations, bound once.
        unsafe {
            let device = &self.host.device;
            let image = vulkan(device.create_image(&info, None), "vkCreateImage")?;
            let needs = device.get_image_memory_requirements(image);
            let memory = self.allocate("depth buffer", needs, MemoryLocation::GpuOnly)?;
            vulkan(
                device.bind_image_memory(image, memory.memory(), memory.offset()),
                "vkBindImageMemory",
            )?;
            let view = self.view(image, DEPTH, vk::ImageAspectFlags::DEPTH)?;
            self.depth = (image, view, Some(memory));
        }
        Ok(())
    }

    fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
    ) -> Result<Allocation> {
        let gone = || Error::new(Stage::Draw, "the device's allocator is gone after a panic");
        let allocator = self.host.shared()?.allocator()?;
        let mut allocator = allocator.lock().map_err(|_| gone())?;
        let made = allocator.allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear: location != MemoryLocation::GpuOnly,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        made.map_err(|e| {
            Error::new(
                Stage::Draw,
                format!("{name}: no device memory ({e}); make the window smaller"),
            )
        })
    }

    fn free(&self, memory: Option<Allocation>) {
        let allocator = self.host.shared().and_then(|shared| shared.allocator());
        if let (Some(memory), Ok(allocator)) = (memory, allocator)
            && let Ok(mut allocator) = allocator.lock()
        {
            let _ = allocator.free(memory);
        }
    }

    /// Waits for a free slot and begins its commands.
    pub fn begin(&mut self) -> Result<Begun> {
        let device = &self.host.device;
        let slot = self.next;
        let Slot {
            commands,
            acquired,
            done,
        } = self.slots[slot];
        // SAFETY: the fence tells that the slot's commands have run.
        unsafe {
            vulkan(
                device.wait_for_fences(&[done], true, u64::MAX),
                "vkWaitForFences",
            )?;
            let image = match self.functions.acquire_next_image(
                self.chain,
                u64::MAX,
                acquired,
                vk::Fence::null(),
            ) {
                Ok((image, _)) => image as usize,
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => return Ok(Begun::Stale),
                Err(code) => return vulkan(Err(code), "vkAcquireNextImageKHR"),
            };
            let info = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            vulkan(
                device.begin_command_buffer(commands, &info),
                "vkBeginCommandBuffer",
            )?;
            if self.host.timestamp_ns > 0.0 {
                let first = 2 * slot as u32;
                device.cmd_reset_query_pool(commands, self.timers, first, 2);
                device.cmd_write_timestamp(
                    commands,
                    vk::PipelineStageFlags::TOP_OF_PIPE,
                    self.timers,
                    first,
                );
            }
            Ok(Begun::Frame(Recording {
                commands,
                slot,
                image,
            }))
        }
    }

    /// Milliseconds that the device took for the frame before in this slot.
    pub fn device_ms(&self, slot: usize) -> Option<f64> {
        let mut ticks = [0u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64;
        // SAFETY: the slot's fence was waited for.
        let read = unsafe {
            self.host
                .device
                .get_query_pool_results(self.timers, 2 * slot as u32, &mut ticks, flags)
        };
        let timed = self.timed[slot] && read.is_ok();
        timed.then(|| ticks[1].saturating_sub(ticks[0]) as f64 * self.host.timestamp_ns * 1e-6)
    }

    /// Begins the pass, cleared to `background`, with viewport and scissor set.
    pub fn begin_pass(&self, frame: Recording, background: [f32; 4]) {
        use vk::{AccessFlags as A, ImageLayout as L, PipelineStageFlags as S};
        let device = &self.host.device;
        let (image, view, _) = self.images[frame.image];
        let tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
        let output = S::COLOR_ATTACHMENT_OUTPUT;
        let [r, g, b, _] = background;
        let attachment = |view, layout, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(view)
                .image_layout(layout)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let cleared = vk::ClearValue {
            color: vk::ClearColorValue {
                float32: [r, g, b, 1.0],
            },
        };
        let far = vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: 1.0,
                stencil: 0,
            },
        };
        let colors = [attachment(view, L::COLOR_ATTACHMENT_OPTIMAL, cleared)];
        let depth = attachment(self.depth.1, L::DEPTH_ATTACHMENT_OPTIMAL, far);
        let area = vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: self.extent,
        };
        let info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let viewport = vk::Viewport {
            width: self.extent.width as f32,
            height: self.extent.height as f32,
            max_depth: 1.0,
            ..Default::default()
        };
        // SAFETY: `commands` is recording outside of a pass; the images live as long as `self`.
        unsafe {
            let cmd = frame.commands;
            let (color, wide) = (vk::ImageAspectFlags::COLOR, vk::ImageAspectFlags::DEPTH);
            let drawn = A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE;
            let tested = A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE;
            self.change(
                cmd,
                image,
                color,
                [L::UNDEFINED, L::COLOR_ATTACHMENT_OPTIMAL],
                [output, output],
                [A::empty(), drawn],
            );
            // The frame before may still test.
            let before = A::DEPTH_STENCIL_ATTACHMENT_WRITE;
            self.change(
                cmd,
                self.depth.0,
                wide,
                [L::UNDEFINED, L::DEPTH_ATTACHMENT_OPTIMAL],
                [tests, tests],
                [before, tested],
            );
            device.cmd_begin_rendering(cmd, &info);
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    unsafe fn change(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        aspect: vk::ImageAspectFlags,
        [from, to]: [vk::ImageLayout; 2],
        [before, after]: [vk::PipelineStageFlags; 2],
        [written, read]: [vk::AccessFlags; 2],
    ) {
        let barrier = vk::ImageMemoryBarrier::default()
            .image(image)
            .subresource_range(range(aspect))
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .src_access_mask(written)
            .dst_access_mask(read);
        let none = vk::DependencyFlags::empty();
        // SAFETY: `cmd` is recording outside of a pass.
        unsafe {
            self.host
                .device
                .cmd_pipeline_barrier(cmd, before, after, none, &[], &[], &[barrier])
        };
    }

    /// Ends the pass, submits and presents; with `keep` the picture is read, too. Gives whether the
    /// chain still fits the window.
    pub fn finish(&mut self, frame: Recording, keep: bool) -> Result<(bool, Option<Picture>)> {
        use vk::{AccessFlags as A, ImageLayout as L, PipelineStageFlags as S};
        let device = &self.host.device;
        let (image, _, drawn) = self.images[frame.image];
        let Slot {
            commands: cmd,
            acquired,
            done,
        } = self.slots[frame.slot];
        // SAFETY: `cmd` is recording within the pass; what is submitted lives until the fence says
        // that it is done.
        unsafe {
            device.cmd_end_rendering(cmd);
            let color = vk::ImageAspectFlags::COLOR;
            let mut from = (
                L::COLOR_ATTACHMENT_OPTIMAL,
                S::COLOR_ATTACHMENT_OUTPUT,
                A::COLOR_ATTACHMENT_WRITE,
            );
            let copy = if keep {
                let to = (L::TRANSFER_SRC_OPTIMAL, S::TRANSFER, A::TRANSFER_READ);
                self.change(
                    cmd,
                    image,
                    color,
                    [from.0, to.0],
                    [from.1, to.1],
                    [from.2, to.2],
                );
                from = (to.0, to.1, A::empty());
                Some(self.copy(cmd, image)?)
            } else {
                None
            };
            self.change(
                cmd,
                image,
                color,
                [from.0, L::PRESENT_SRC_KHR],
                [from.1, S::BOTTOM_OF_PIPE],
                [from.2, A::empty()],
            );
            if self.host.timestamp_ns > 0.0 {
                device.cmd_write_timestamp(
                    cmd,
                    S::BOTTOM_OF_PIPE,
                    self.timers,
                    2 * frame.slot as u32 + 1,
                );
                self.timed[frame.slot] = true;
            }
            vulkan(device.end_command_buffer(cmd), "vkEndCommandBuffer")?;
            vulkan(device.reset_fences(&[done]), "vkResetFences")?;
            let (commands, waits, signals) = ([cmd], [acquired], [drawn]);
            let submit = [vk::SubmitInfo::default()
                .wait_semaphores(&waits)
                .wait_dst_stage_mask(&[S::COLOR_ATTACHMENT_OUTPUT])
                .command_buffers(&commands)
                .signal_semaphores(&signals)];
            vulkan(
                device.queue_submit(self.host.queue, &submit, done),
                "vkQueueSubmit",
            )?;
            self.next = (frame.slot + 1) % FRAMES;
            let (chains, indices) = ([self.chain], [frame.image as u32]);
            let info = vk::PresentInfoKHR::default()
                .wait_semaphores(&signals)
                .swapchains(&chains)
                .image_indices(&indices);
            let fits = match self.functions.queue_present(self.host.queue, &info) {
                Ok(suboptimal) => !suboptimal,
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => false,
                Err(code) => return vulkan(Err(code), "vkQueuePresentKHR"),
            };
            let picture = match copy {
                Some((buffer, memory)) => {
                    vulkan(
                        device.wait_for_fences(&[done], true, u64::MAX),
                        "vkWaitForFences",
                    )?;
                    let picture = self.picture(&memory);
                    device.destroy_buffer(buffer, None);
                    self.free(Some(memory));
                    Some(picture)
                }
                None => None,
            };
            Ok((fits, picture))
        }
    }

    unsafe fn copy(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
    ) -> Result<(vk::Buffer, Allocation)> {
        let device = &self.host.device;
        let bytes = 4 * u64::from(self.extent.width) * u64::from(self.extent.height);
        let info = vk::BufferCreateInfo::default()
            .size(bytes)
            .usage(vk::BufferUsageFlags::TRANSFER_DST);
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .layer_count(1);
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(self.extent.into());
        let read = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        let (copied, host) = (
            vk::PipelineStageFlags::TRANSFER,
            vk::PipelineStageFlags::HOST,
        );
        // SAFETY: `cmd` is recording outside of a pass; the buffer holds the image.
        unsafe {
            let buffer = vulkan(device.create_buffer(&info, None), "vkCreateBuffer")?;
            let needs = device.get_buffer_memory_requirements(buffer);
            let memory = self.allocate("screenshot", needs, MemoryLocation::GpuToCpu)?;
            vulkan(
                device.bind_buffer_memory(buffer, memory.memory(), memory.offset()),
                "vkBindBufferMemory",
            )?;
            let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            device.cmd_copy_image_to_buffer(cmd, image, layout, buffer, &[region]);
            device.cmd_pipeline_barrier(
                cmd,
                copied,
                host,
                vk::DependencyFlags::empty(),
                &[read],
                &[],
                &[],
            );
            Ok((buffer, memory))
        }
    }

    fn picture(&self, memory: &Allocation) -> Picture {
        let bytes = memory.mapped_slice().unwrap_or_default();
        let swapped = self.format.format == vk::Format::B8G8R8A8_SRGB;
        let (width, height) = (self.extent.width, self.extent.height);
        let pixel = |p: &[u8]| {
            if swapped {
                [p[2], p[1], p[0], 255]
            } else {
                [p[0], p[1], p[2], 255]
            }
        };
        let count = width as usize * height as usize;
        Picture {
            width,
            height,
            rgba: bytes.chunks_exact(4).take(count).map(pixel).collect(),
        }
    }

    /// The pool, for what egui copies.
    pub fn pool(&self) -> vk::CommandPool {
        self.pool
    }

    fn destroy_images(&mut self) {
        let (image, view, memory) = std::mem::replace(
            &mut self.depth,
            (vk::Image::null(), vk::ImageView::null(), None),
        );
        // SAFETY: the device is idle; null handles may be destroyed.
        unsafe {
            let device = &self.host.device;
            for (_, view, drawn) in self.images.drain(..) {
                device.destroy_image_view(view, None);
                device.destroy_semaphore(drawn, None);
            }
            device.destroy_image_view(view, None);
            device.destroy_image(image, None);
            self.functions.destroy_swapchain(self.chain, None);
        }
        self.free(memory);
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        self.host.wait();
        self.destroy_images();
        // SAFETY: the device is idle.
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

fn range(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default()
        .aspect_mask(aspect)
        .level_count(1)
        .layer_count(1)
}
