//! The images of a pass, and the pass: colours of any formats and a depth, drawn by dynamic rendering
//! or in a render pass, and read back.

use super::memory::{HostBuffer, HostImage, barrier};
use super::{COLOR, DEPTH, Fallible, Host, Options};
use ash::vk;

/// An image and the bytes that it is copied to.
struct Attachment<'a> {
    format: vk::Format,
    image: HostImage<'a>,
    read: HostBuffer<'a>,
}

/// Bytes of a pixel.
fn bytes_of(format: vk::Format) -> usize {
    use vk::Format as F;
    match format {
        F::R8G8_UNORM => 2,
        F::R16G16B16A16_SFLOAT | F::R32G32_SFLOAT | F::R32G32_UINT => 8,
        F::R32G32B32A32_SFLOAT => 16,
        _ => 4,
    }
}

/// Colour attachments and a depth.
pub struct Attachments<'a> {
    options: Options,
    /// Of one sample.
    colors: Vec<Attachment<'a>>,
    /// Of several samples, where there are: resolved into the first colour.
    multisampled: Option<HostImage<'a>>,
    depth: Attachment<'a>,
    /// Null with dynamic rendering.
    pub pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    host: &'a Host,
}

impl<'a> Attachments<'a> {
    /// Attachments of these formats. A render pass has one, of [`COLOR`].
    pub fn new(host: &'a Host, options: Options, formats: &[vk::Format]) -> Fallible<Self> {
        let pixels = (options.width * options.height) as usize;
        let of = |format, samples| {
            let more = match samples {
                1 => vk::ImageUsageFlags::SAMPLED,
                _ => vk::ImageUsageFlags::empty(),
            };
            Ok(Attachment {
                format,
                image: HostImage::new(host, &options, format, samples, more)?,
                read: HostBuffer::new(
                    host,
                    bytes_of(format) * pixels,
                    vk::BufferUsageFlags::TRANSFER_DST,
                )?,
            })
        };
        let several = || of(COLOR, options.samples).map(|color| color.image);
        let colors = formats.iter().map(|format| of(*format, 1));
        let mut made = Self {
            colors: colors.collect::<Fallible<_>>()?,
            multisampled: (options.samples > 1).then(several).transpose()?,
            depth: of(DEPTH, options.samples)?,
            options,
            pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
            host,
        };
        if !options.dynamic {
            made.make_pass()?;
        }
        Ok(made)
    }

    /// The colours and the depth.
    fn all(&self) -> impl Iterator<Item = &Attachment<'a>> {
        self.colors.iter().chain([&self.depth])
    }

    /// The images of the colours and of the depth.
    pub fn images(&self) -> impl Iterator<Item = &HostImage<'a>> {
        self.all().map(|attachment| &attachment.image)
    }

    /// What colours are cleared to: no object in identities, else nothing.
    pub fn clears(&self) -> Vec<vk::ClearColorValue> {
        let of = |color: &Attachment| match color.format {
            vk::Format::R32G32_UINT => vk::ClearColorValue {
                uint32: [u32::MAX; 4],
            },
            _ => vk::ClearColorValue { float32: [0.0; 4] },
        };
        self.colors.iter().map(of).collect()
    }

    /// Makes a render pass of one colour, and its framebuffer.
    fn make_pass(&mut self) -> Fallible<()> {
        let (color, depth) = (&self.colors[0].image, &self.depth.image);
        let samples = vk::SampleCountFlags::from_raw(self.options.samples);
        let attachment = |format, samples, layout| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(samples)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .initial_layout(vk::ImageLayout::UNDEFINED)
                .final_layout(layout)
        };
        let mut attachments = vec![
            attachment(COLOR, samples, color.drawn()),
            attachment(DEPTH, samples, depth.drawn()),
        ];
        let mut views = vec![color.view, depth.view];
        if let Some(several) = &self.multisampled {
            let one = vk::SampleCountFlags::TYPE_1;
            attachments.push(attachment(COLOR, one, color.drawn()));
            views = vec![several.view, depth.view, color.view];
        }
        let reference = |n, layout| {
            vk::AttachmentReference::default()
                .attachment(n)
                .layout(layout)
        };
        let (colors, depths) = ([reference(0, color.drawn())], reference(1, depth.drawn()));
        let resolves = [reference(2, color.drawn())];
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colors)
            .depth_stencil_attachment(&depths);
        if self.multisampled.is_some() {
            subpass = subpass.resolve_attachments(&resolves);
        }
        let subpasses = [subpass];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses);
        let device = &self.host.device;
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            self.pass = device.create_render_pass(&info, None)?;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(self.pass)
                .attachments(&views)
                .width(self.options.width)
                .height(self.options.height)
                .layers(1);
            self.framebuffer = device.create_framebuffer(&info, None)?;
        }
        Ok(())
    }

    /// Clears everything and records `draws` in a pass. `secondary`: all draws are secondary
    /// commands.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; the attachments live until it has run.
    pub unsafe fn draw<T>(
        &self,
        cmd: vk::CommandBuffer,
        clears: &[vk::ClearColorValue],
        secondary: bool,
        draws: impl FnOnce() -> T,
    ) -> T {
        let device = &self.host.device;
        // What was drawn before is over: its writes, and the copies that read them.
        let images = self.images().chain(&self.multisampled);
        let begun = images.map(|image| image.barrier(vk::ImageLayout::UNDEFINED, image.drawn()));
        // SAFETY: as the caller promised.
        unsafe {
            barrier(self.host, cmd, &begun.collect::<Vec<_>>());
            match self.options.dynamic {
                true => self.begin_rendering(cmd, clears, secondary),
                false => self.begin_pass(cmd, clears[0]),
            }
            if !secondary {
                set_viewport(self.host, cmd, &self.options);
            }
            let drawn = draws();
            match self.options.dynamic {
                true => device.cmd_end_rendering(cmd),
                false => device.cmd_end_render_pass(cmd),
            }
            drawn
        }
    }

    fn far(&self) -> vk::ClearValue {
        let depth_stencil = vk::ClearDepthStencilValue {
            depth: if self.options.reversed { 0.0 } else { 1.0 },
            stencil: 0,
        };
        vk::ClearValue { depth_stencil }
    }

    unsafe fn begin_rendering(
        &self,
        cmd: vk::CommandBuffer,
        clears: &[vk::ClearColorValue],
        secondary: bool,
    ) {
        let attachment = |image: &HostImage, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view)
                .image_layout(image.drawn())
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let color = |(of, &color): (&Attachment, &_)| {
            let (into, color) = (&of.image, vk::ClearValue { color });
            match &self.multisampled {
                None => attachment(into, color),
                Some(several) => attachment(several, color)
                    .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                    .resolve_image_view(into.view)
                    .resolve_image_layout(into.drawn()),
            }
        };
        let colors: Vec<_> = self.colors.iter().zip(clears).map(color).collect();
        let depth = attachment(&self.depth.image, self.far());
        let info = vk::RenderingInfo::default()
            .flags(match secondary {
                true => vk::RenderingFlags::CONTENTS_SECONDARY_COMMAND_BUFFERS,
                false => vk::RenderingFlags::empty(),
            })
            .render_area(vk::Rect2D::default().extent(self.options.extent()))
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        // SAFETY: `cmd` is recording; the images live as long as `self`.
        unsafe { self.host.device.cmd_begin_rendering(cmd, &info) };
    }

    unsafe fn begin_pass(&self, cmd: vk::CommandBuffer, color: vk::ClearColorValue) {
        let color = vk::ClearValue { color };
        let clears = [color, self.far(), color];
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass)
            .framebuffer(self.framebuffer)
            .render_area(vk::Rect2D::default().extent(self.options.extent()))
            .clear_values(&clears);
        let device = &self.host.device;
        // SAFETY: as above.
        unsafe { device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE) };
    }

    /// Records copies of everything of one sample, to be read once the commands have run.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass, after [`Attachments::draw`].
    pub unsafe fn copy(&self, cmd: vk::CommandBuffer) {
        let copied = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let depth = (self.options.samples == 1).then_some(&self.depth);
        let all = || self.colors.iter().chain(depth);
        let ended = all().map(|a| a.image.barrier(a.image.drawn(), copied));
        // SAFETY: as the caller promised.
        unsafe {
            barrier(self.host, cmd, &ended.collect::<Vec<_>>());
            for of in all() {
                let (region, to) = ([of.image.region(&self.options)], of.read.raw);
                let raw = &self.host.device;
                raw.cmd_copy_image_to_buffer(cmd, of.image.raw, copied, to, &region);
            }
            barrier(self.host, cmd, &[]);
        }
    }

    /// The bytes of each colour attachment, once the commands have run.
    pub fn colors(&self) -> impl Iterator<Item = Vec<u8>> {
        self.colors.iter().map(|color| color.read.bytes())
    }

    /// The depths, once the commands have run; none of several samples.
    pub fn depths(&self) -> Vec<f32> {
        match self.options.samples {
            1 => bytemuck::pod_collect_to_vec(&self.depth.read.bytes()),
            _ => Vec::new(),
        }
    }
}

impl Drop for Attachments<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the device is done with them; null handles may be destroyed.
        unsafe {
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.pass, None);
        }
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
