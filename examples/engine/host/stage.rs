//! A frame's images, its pass, and commands for the frames in flight.

use super::memory::{HostBuffer, HostImage};
use super::mesh::Mesh;
use super::mesh_pipeline::{MeshPipeline, MeshShaders};
use super::pass::make_pass;
use super::{COLOR, DEPTH, FRAMES, Fallible, Host, Options};
use ash::vk;
use glam::{DMat4, Vec3};

/// The commands of a frame in flight, and what tells that they have run.
type InFlight = (vk::CommandBuffer, vk::Fence);

/// The images of a frame, the pass that draws into them, and commands for the frames in flight.
pub struct Stage<'a> {
    pub options: Options,
    pub pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// What is read back: of one sample.
    color: HostImage<'a>,
    /// Of several samples, where there are.
    multisampled: Option<HostImage<'a>>,
    depth: HostImage<'a>,
    pub meshes: MeshPipeline<'a>,
    pool: vk::CommandPool,
    frames: Vec<InFlight>,
    next: usize,
    read: [HostBuffer<'a>; 2],
    host: &'a Host,
}

impl<'a> Stage<'a> {
    pub fn new(host: &'a Host, options: Options) -> Fallible<Self> {
        Self::with_shaders(host, options, &MeshShaders::default())
    }

    pub fn with_shaders(
        host: &'a Host,
        options: Options,
        shaders: &MeshShaders<'_>,
    ) -> Fallible<Self> {
        let device = &host.device;
        let pixels = (options.width * options.height) as usize;
        let color = HostImage::new(host, &options, COLOR, 1)?;
        let several = || HostImage::new(host, &options, COLOR, options.samples);
        let multisampled = (options.samples > 1).then(several).transpose()?;
        let depth = HostImage::new(host, &options, DEPTH, options.samples)?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let read = [
            HostBuffer::new(host, 4 * pixels, usage)?,
            HostBuffer::new(host, 4 * pixels, usage)?,
        ];
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let pool = vk::CommandPoolCreateInfo::default()
                .queue_family_index(host.family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&pool, None)?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES as u32);
            let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            let mut frames = Vec::new();
            for commands in device.allocate_command_buffers(&info)? {
                let fence = device.create_fence(&signaled, None)?;
                frames.push((commands, fence));
            }
            let (mut pass, mut framebuffer) = Default::default();
            if !options.dynamic {
                let images = [&color, &depth];
                (pass, framebuffer) = make_pass(host, &options, images, multisampled.as_ref())?;
            }
            Ok(Self {
                meshes: MeshPipeline::new(host, shaders, &options, pass, &[COLOR])?,
                options,
                pass,
                framebuffer,
                color,
                multisampled,
                depth,
                pool,
                frames,
                next: 0,
                read,
                host,
            })
        }
    }

    /// Draws one frame: `before` records outside of the pass, `within` after the host's meshes, with
    /// what `before` returned. Waits for the frame before the last alone.
    pub fn frame<T>(
        &mut self,
        clip_from_world: DMat4,
        towards_light: Vec3,
        meshes: &[Mesh<'_>],
        before: impl FnOnce(vk::CommandBuffer, usize) -> Fallible<T>,
        within: impl FnOnce(vk::CommandBuffer, &T) -> Fallible<()>,
    ) -> Fallible<()> {
        let device = &self.host.device;
        let slot = self.next;
        self.next = (slot + 1) % FRAMES;
        let (cmd, fence) = self.frames[slot];
        // SAFETY: the fence tells that the commands have run; the rest is plain recording.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            let prepared = before(cmd, slot)?;
            self.begin_pass(cmd);
            self.meshes
                .draw(cmd, clip_from_world, towards_light, meshes);
            within(cmd, &prepared)?;
            if self.options.dynamic {
                device.cmd_end_rendering(cmd);
            } else {
                device.cmd_end_render_pass(cmd);
            }
            self.submit((cmd, fence))
        }
    }

    /// Ends commands and submits them.
    unsafe fn submit(&self, (cmd, fence): InFlight) -> Fallible<()> {
        let device = &self.host.device;
        let buffers = [cmd];
        let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the commands are recording, outside of a pass.
        unsafe {
            device.end_command_buffer(cmd)?;
            device.reset_fences(&[fence])?;
            device.queue_submit(self.host.queue, &submits, fence)?;
        }
        Ok(())
    }

    unsafe fn begin_pass(&self, cmd: vk::CommandBuffer) {
        let device = &self.host.device;
        let area = vk::Rect2D::default().extent(self.options.extent());
        let color = vk::ClearValue {
            color: vk::ClearColorValue {
                float32: [0.2, 0.25, 0.3, 1.0],
            },
        };
        let far = if self.options.reversed { 0.0 } else { 1.0 };
        let depth = vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: far,
                stencil: 0,
            },
        };
        // SAFETY: `cmd` is recording; the images live as long as `self`.
        unsafe {
            // The frame before is over with the images: its writes, and the copies that read them.
            let images = [&self.color, &self.depth];
            let images = images.into_iter().chain(&self.multisampled);
            let barriers = images.map(|i| i.barrier(vk::ImageLayout::UNDEFINED, i.drawn()));
            self.barrier(cmd, &barriers.collect::<Vec<_>>());
            if self.options.dynamic {
                let attachment = |image: &HostImage, clear| {
                    vk::RenderingAttachmentInfo::default()
                        .image_view(image.view)
                        .image_layout(image.drawn())
                        .load_op(vk::AttachmentLoadOp::CLEAR)
                        .store_op(vk::AttachmentStoreOp::STORE)
                        .clear_value(clear)
                };
                let mut drawn = attachment(&self.color, color);
                if let Some(several) = &self.multisampled {
                    drawn = attachment(several, color)
                        .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                        .resolve_image_view(self.color.view)
                        .resolve_image_layout(self.color.drawn());
                }
                let (colors, depths) = ([drawn], attachment(&self.depth, depth));
                let info = vk::RenderingInfo::default()
                    .render_area(area)
                    .layer_count(1)
                    .color_attachments(&colors)
                    .depth_attachment(&depths);
                device.cmd_begin_rendering(cmd, &info);
            } else {
                let clears = [color, depth, color];
                let info = vk::RenderPassBeginInfo::default()
                    .render_pass(self.pass)
                    .framebuffer(self.framebuffer)
                    .render_area(area)
                    .clear_values(&clears);
                device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            }
            let viewport = vk::Viewport {
                width: area.extent.width as f32,
                height: area.extent.height as f32,
                max_depth: 1.0,
                ..Default::default()
            };
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Records barriers of images, between all stages.
    unsafe fn barrier(&self, cmd: vk::CommandBuffer, images: &[vk::ImageMemoryBarrier]) {
        let (all, none) = (
            vk::PipelineStageFlags::ALL_COMMANDS,
            vk::DependencyFlags::empty(),
        );
        let device = &self.host.device;
        // SAFETY: `cmd` is recording, outside of a pass.
        unsafe { device.cmd_pipeline_barrier(cmd, all, all, none, &[], &[], images) };
    }

    /// Waits for all frames and reads the last: sRGB bytes; of one sample, depths, too.
    pub fn read(&self) -> Fallible<(Vec<u8>, Vec<f32>)> {
        let device = &self.host.device;
        let (cmd, fence) = self.frames[self.next];
        let copied = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let has_depths = self.options.samples == 1;
        let images = [Some(&self.color), has_depths.then_some(&self.depth)];
        // SAFETY: all frames are waited for; the copies are waited for, too.
        unsafe {
            device.device_wait_idle()?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            for (image, to) in images.into_iter().flatten().zip(&self.read) {
                self.barrier(cmd, &[image.barrier(image.drawn(), copied)]);
                let region = [image.region(&self.options)];
                device.cmd_copy_image_to_buffer(cmd, image.raw, copied, to.raw, &region);
            }
            let barrier = [vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                .dst_access_mask(vk::AccessFlags::HOST_READ)];
            let (transfer, host) = (
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::HOST,
            );
            let none = vk::DependencyFlags::empty();
            device.cmd_pipeline_barrier(cmd, transfer, host, none, &barrier, &[], &[]);
            self.submit((cmd, fence))?;
            device.wait_for_fences(&[fence], true, u64::MAX)?;
        }
        let [colors, depths] = self.read.each_ref().map(HostBuffer::bytes);
        let depths = if has_depths { &depths[..] } else { &[] };
        Ok((colors, bytemuck::pod_collect_to_vec(depths)))
    }

    /// Waits until the device is done with all frames.
    pub fn wait(&self) -> Fallible<()> {
        // SAFETY: plain call.
        Ok(unsafe { self.host.device.device_wait_idle() }?)
    }
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the device is waited for; null handles may be destroyed.
        unsafe {
            let _ = device.device_wait_idle();
            for (_, fence) in &self.frames {
                device.destroy_fence(*fence, None);
            }
            device.destroy_command_pool(self.pool, None);
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.pass, None);
        }
    }
}
