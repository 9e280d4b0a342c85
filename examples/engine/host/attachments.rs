//! Colour attachments of any formats and a depth, drawn by dynamic rendering and read back. They have
//! a layer for each view of a pass.

use super::memory::{HostBuffer, HostImage};
use super::{DEPTH, Fallible, Host, Options};
use ash::vk;

/// A colour attachment and the bytes that it is copied to.
struct Attachment<'a> {
    image: HostImage<'a>,
    read: HostBuffer<'a>,
}

/// Colour attachments and a depth of one sample.
pub struct Attachments<'a> {
    options: Options,
    colors: Vec<Attachment<'a>>,
    depth: Attachment<'a>,
    views: u32,
    host: &'a Host,
}

impl<'a> Attachments<'a> {
    /// Attachments of these formats, and how many bytes a pixel of each has.
    pub fn new(
        host: &'a Host,
        options: Options,
        formats: &[(vk::Format, usize)],
    ) -> Fallible<Self> {
        Self::of_views(host, options, formats, 1)
    }

    /// Attachments for a pass of several views, by multiview.
    pub fn of_views(
        host: &'a Host,
        options: Options,
        formats: &[(vk::Format, usize)],
        views: u32,
    ) -> Fallible<Self> {
        let pixels = (options.width * options.height * views) as usize;
        let of = |&(format, bytes): &(vk::Format, usize)| {
            Ok(Attachment {
                image: HostImage::layered(host, &options, format, views)?,
                read: HostBuffer::new(host, bytes * pixels, vk::BufferUsageFlags::TRANSFER_DST)?,
            })
        };
        Ok(Self {
            colors: formats.iter().map(of).collect::<Fallible<_>>()?,
            depth: of(&(DEPTH, 4))?,
            options,
            views,
            host,
        })
    }

    fn all(&self) -> impl Iterator<Item = &Attachment<'a>> {
        self.colors.iter().chain([&self.depth])
    }

    /// Clears everything and records `draws` in a pass. `secondary`: all draws are secondary
    /// commands.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; the attachments live until it has run.
    pub unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        clears: &[vk::ClearColorValue],
        secondary: bool,
        draws: impl FnOnce(),
    ) {
        let raw = &self.host.device;
        let area = vk::Rect2D::default().extent(self.options.extent());
        let far = if self.options.reversed { 0.0 } else { 1.0 };
        let depth_clear = vk::ClearDepthStencilValue {
            depth: far,
            stencil: 0,
        };
        let attachment = |of: &Attachment, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(of.image.view)
                .image_layout(of.image.drawn())
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let colors = self.colors.iter().zip(clears);
        let colors: Vec<_> = colors
            .map(|(of, &color)| attachment(of, vk::ClearValue { color }))
            .collect();
        let depth_stencil = depth_clear;
        let depth = attachment(&self.depth, vk::ClearValue { depth_stencil });
        let info = vk::RenderingInfo::default()
            .flags(match secondary {
                true => vk::RenderingFlags::CONTENTS_SECONDARY_COMMAND_BUFFERS,
                false => vk::RenderingFlags::empty(),
            })
            .render_area(area)
            .layer_count(1)
            .view_mask(match self.views {
                1 => 0,
                views => (1 << views) - 1,
            })
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let undefined = vk::ImageLayout::UNDEFINED;
        // SAFETY: as the caller promised.
        unsafe {
            let begun = self
                .all()
                .map(|a| a.image.barrier(undefined, a.image.drawn()));
            self.barrier(cmd, &begun.collect::<Vec<_>>());
            raw.cmd_begin_rendering(cmd, &info);
            if !secondary {
                set_viewport(self.host, cmd, &self.options);
            }
            draws();
            raw.cmd_end_rendering(cmd);
        }
    }

    /// Records copies of everything, to be read once the commands have run.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass, after [`Attachments::draw`].
    pub unsafe fn copy(&self, cmd: vk::CommandBuffer) {
        let copied = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: as the caller promised.
        unsafe {
            let ended = self.all().map(|a| a.image.barrier(a.image.drawn(), copied));
            self.barrier(cmd, &ended.collect::<Vec<_>>());
            for of in self.all() {
                let (region, to) = ([of.image.region(&self.options)], of.read.raw);
                let raw = &self.host.device;
                raw.cmd_copy_image_to_buffer(cmd, of.image.raw, copied, to, &region);
            }
            self.barrier(cmd, &[]);
        }
    }

    /// The bytes of a colour attachment, view after view, once the commands have run.
    pub fn color(&self, number: usize) -> Vec<u8> {
        self.colors[number].read.bytes()
    }

    /// The depths, view after view, once the commands have run.
    pub fn depths(&self) -> Vec<f32> {
        bytemuck::pod_collect_to_vec(&self.depth.read.bytes())
    }

    /// Records a barrier between all stages, and of these images.
    unsafe fn barrier(&self, cmd: vk::CommandBuffer, images: &[vk::ImageMemoryBarrier]) {
        let memory = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)];
        let (all, none) = (
            vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::HOST,
            vk::DependencyFlags::empty(),
        );
        let raw = &self.host.device;
        // SAFETY: `cmd` is recording, outside of a pass.
        unsafe { raw.cmd_pipeline_barrier(cmd, all, all, none, &memory, &[], images) };
    }
}

/// Sets viewport and scissor to the whole picture.
///
/// # Safety
/// `cmd` is recording.
pub unsafe fn set_viewport(host: &Host, cmd: vk::CommandBuffer, options: &Options) {
    let area = vk::Rect2D::default().extent(options.extent());
    let viewport = vk::Viewport {
        width: area.extent.width as f32,
        height: area.extent.height as f32,
        max_depth: 1.0,
        ..Default::default()
    };
    // SAFETY: as the caller promised.
    unsafe {
        host.device.cmd_set_viewport(cmd, 0, &[viewport]);
        host.device.cmd_set_scissor(cmd, 0, &[area]);
    }
}
