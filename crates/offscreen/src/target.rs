//! The memory that is drawn into: images of the planes, the depth buffer, two words per pixel.
//! Copies of it to the host.

use crate::commands::{Commands, failed};
use ash::vk;
use gpu_allocator::MemoryLocation;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Buffer, ComputeTarget, Device, Image, ImageKind};
use revmap::settings::{DrawStage, Planes, Settings};
use std::ops::Range;
use vk::ImageLayout as Layout;
use vk::ImageUsageFlags as U;

/// The format of depths.
pub(crate) const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// The formats of the planes, in the order of attachments.
pub(crate) fn color_formats(planes: Planes) -> Vec<vk::Format> {
    match planes {
        Planes::All => vec![vk::Format::R32G32B32A32_SFLOAT; 4],
        _ => vec![vk::Format::R8G8B8A8_SRGB],
    }
}

/// The images of a frame.
pub(crate) struct Target {
    size: [u32; 2],
    planes: Planes,
    /// The storage images of compute, or the attachments of the pass: colours, depths, and what colours
    /// of several samples are resolved into. Empty if compute draws only colour.
    images: Vec<Image>,
    /// Null in compute.
    pub pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// The depths of all pixels, then their second words (see [`ComputeTarget`]). `None` if
    /// fragments draw only colour.
    words: Option<Buffer>,
    /// True if depths are read beside colours.
    keeps_depths: bool,
    /// Host memory that `read` copies to; made by the first call.
    host: Option<Buffer>,
    device: Device,
}

/// Returns an error for more pixels than the device draws, or than fit into a buffer at two words
/// per pixel.
fn check_size(device: &Device, [width, height]: [u32; 2], needs_words: bool) -> Result<()> {
    // SAFETY: a plain query of the device's own physical device.
    let properties =
        unsafe { (device.instance()).get_physical_device_properties(device.physical()) };
    let limits = properties.limits;
    let side = limits.max_image_dimension2_d;
    let most_x = limits.max_framebuffer_width.min(side);
    let most_y = limits.max_framebuffer_height.min(side);
    let most_words = limits.max_storage_buffer_range / 8;
    let words_fit = u64::from(width) * u64::from(height) <= u64::from(most_words);
    if width <= most_x && height <= most_y && (words_fit || !needs_words) {
        return Ok(());
    }
    let name = &device.report().name;
    let message = format!(
        "{width}x{height} pixels are more than {name} takes ({most_x}x{most_y}, and {most_words} in all for this kind of picture); make it smaller"
    );
    Err(Error::new(ErrorKind::TooLarge, message).at_key("size"))
}

impl Target {
    pub fn new(device: &Device, settings: &Settings, samples: u32) -> Result<Self> {
        let size = [settings.width, settings.height];
        let planes = settings.planes;
        let compute = settings.stage == DrawStage::Compute;
        // All planes include distances.
        let keeps_depths = settings.antialias && planes == Planes::Color;
        let needs_words = compute || planes == Planes::All;
        check_size(device, size, needs_words)?;
        let mut target = Self {
            size,
            planes,
            images: Vec::new(),
            pass: vk::RenderPass::null(),
            framebuffer: vk::Framebuffer::null(),
            words: None,
            keeps_depths,
            host: None,
            device: device.clone(),
        };
        if !compute {
            target.add_attachments(vk::SampleCountFlags::from_raw(samples))?;
        } else if planes == Planes::All {
            let usage = U::STORAGE | U::TRANSFER_DST | U::TRANSFER_SRC;
            target.add_colors(usage, vk::SampleCountFlags::TYPE_1)?;
        }
        if needs_words {
            let bytes = 8 * target.pixels();
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::TRANSFER_DST
                | vk::BufferUsageFlags::TRANSFER_SRC;
            let words = device.buffer("pixel words", bytes, usage, MemoryLocation::GpuOnly)?;
            target.words = Some(words);
        }
        Ok(target)
    }

    fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }

    fn add(&mut self, format: vk::Format, usage: U, samples: vk::SampleCountFlags) -> Result<()> {
        let [width, height] = self.size;
        let kind = ImageKind {
            format,
            width,
            height,
            mips: 1,
            samples,
            usage,
        };
        self.images.push(self.device.image("plane", kind)?);
        Ok(())
    }

    fn add_colors(&mut self, usage: U, samples: vk::SampleCountFlags) -> Result<()> {
        let mut formats = color_formats(self.planes).into_iter();
        formats.try_for_each(|format| self.add(format, usage, samples))
    }

    /// Adds the attachments, the pass and the framebuffer.
    fn add_attachments(&mut self, samples: vk::SampleCountFlags) -> Result<()> {
        let resolves = samples != vk::SampleCountFlags::TYPE_1;
        let copied = |is_read| match is_read {
            true => U::TRANSFER_SRC,
            false => U::empty(),
        };
        self.add_colors(U::COLOR_ATTACHMENT | copied(!resolves), samples)?;
        let colors = self.images.len();
        let usage = U::DEPTH_STENCIL_ATTACHMENT | copied(self.keeps_depths);
        self.add(DEPTH, usage, samples)?;
        if resolves {
            let usage = U::COLOR_ATTACHMENT | copied(true);
            self.add_colors(usage, vk::SampleCountFlags::TYPE_1)?;
        }
        let raw = self.device.raw();
        self.pass = render_pass(raw, &self.images, colors)?;
        let views: Vec<_> = self.images.iter().map(|image| image.view).collect();
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(self.pass)
            .attachments(&views)
            .width(self.size[0])
            .height(self.size[1])
            .layers(1);
        // SAFETY: the views live as long as the framebuffer.
        self.framebuffer = unsafe { raw.create_framebuffer(&info, None) }
            .map_err(failed("vkCreateFramebuffer"))?;
        Ok(())
    }

    /// The memory that shaders write to besides attachments.
    pub fn for_shaders(&self) -> Option<ComputeTarget> {
        let storage = self.images.iter().filter(|_| self.is_compute());
        Some(ComputeTarget {
            words: self.words.as_ref()?.raw,
            images: storage.map(|image| image.view).collect(),
            depths: self.keeps_depths,
        })
    }

    /// True if the target has no pass.
    pub fn is_compute(&self) -> bool {
        self.pass == vk::RenderPass::null()
    }

    /// Records a barrier between all that was recorded before and all that comes after.
    pub fn wait(&self, cmd: vk::CommandBuffer) {
        self.change(cmd, [], |home| [home; 2]);
    }

    /// Same as [`Target::wait`]. Images change their layouts from the first to the second of `layouts`,
    /// which takes the layout for drawing.
    fn change<'a>(
        &self,
        cmd: vk::CommandBuffer,
        images: impl IntoIterator<Item = &'a Image>,
        layouts: impl Fn(Layout) -> [Layout; 2],
    ) {
        let (written, any) = (
            vk::AccessFlags::MEMORY_WRITE,
            vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE,
        );
        let all = [vk::MemoryBarrier::default()
            .src_access_mask(written)
            .dst_access_mask(any)];
        let change = |image: &Image| {
            let [from, to] = layouts(home(image));
            vk::ImageMemoryBarrier::default()
                .src_access_mask(written)
                .dst_access_mask(any)
                .old_layout(from)
                .new_layout(to)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .image(image.raw)
                .subresource_range(image.kind.range())
        };
        let images: Vec<_> = images.into_iter().map(change).collect();
        let from = vk::PipelineStageFlags::ALL_COMMANDS;
        let to = from | vk::PipelineStageFlags::HOST;
        let none = vk::DependencyFlags::empty();
        let raw = self.device.raw();
        // SAFETY: `cmd` is recording outside of a pass; the images live until it has run.
        unsafe { raw.cmd_pipeline_barrier(cmd, from, to, none, &all, &[], &images) };
    }

    /// Records the start of a frame: clears of all memory that the pass does not clear. `depths`:
    /// those of the words, too.
    pub fn clear(&self, cmd: vk::CommandBuffer, background: [f32; 4], depths: bool) {
        self.change(cmd, &self.images, |home| [Layout::UNDEFINED, home]);
        let Some(words) = &self.words else {
            return;
        };
        let raw = self.device.raw();
        let half = 4 * self.pixels();
        let second = match self.planes {
            Planes::Color => ComputeTarget::color_word(background),
            _ => 0,
        };
        // SAFETY: `cmd` is recording outside of a pass. Both ranges are within the buffer, and storage
        // images were made for transfers.
        unsafe {
            if depths {
                raw.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
            }
            raw.cmd_fill_buffer(cmd, words.raw, half, half, second);
            let storage = self.images.iter().filter(|_| self.is_compute());
            for (image, value) in storage.zip(clear_values(background)) {
                let range = [image.kind.range()];
                raw.cmd_clear_color_image(cmd, image.raw, Layout::GENERAL, &value, &range);
            }
        }
        self.wait(cmd);
    }

    /// Begins the render pass of the fragment path in some rows, cleared to `background`.
    pub fn begin(&self, cmd: vk::CommandBuffer, background: [f32; 4], rows: &Range<u32>) {
        let [width, height] = self.size;
        #[allow(clippy::cast_possible_wrap)] // sizes are far below 2^31
        let area = vk::Rect2D {
            offset: vk::Offset2D {
                x: 0,
                y: rows.start as i32,
            },
            extent: vk::Extent2D {
                width,
                height: rows.end - rows.start,
            },
        };
        let colors = clear_values(background).map(|color| vk::ClearValue { color });
        let depth = vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: 1.0,
                stencil: 0,
            },
        };
        let colors = colors.into_iter().take(self.planes.attachments());
        let clears: Vec<_> = colors.chain([depth]).collect();
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass)
            .framebuffer(self.framebuffer)
            .render_area(area)
            .clear_values(&clears);
        #[allow(clippy::cast_precision_loss)] // sizes are far below 2^24
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: `cmd` is recording, outside a render pass; the framebuffer fits the pass.
        unsafe {
            let raw = self.device.raw();
            raw.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            raw.cmd_set_viewport(cmd, 0, &[viewport]);
            raw.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Copies what was drawn to the host. Returns the bytes of each, in order: images of the planes,
    /// or colours among the words; counts of look-ups, if all planes are drawn; depths, if kept.
    pub fn read(&mut self, commands: &Commands) -> Result<Vec<&[u8]>> {
        let read = |image: &&Image| image.kind.usage.contains(U::TRANSFER_SRC);
        let images: Vec<&Image> = self.images.iter().filter(read).collect();
        let half = 4 * self.pixels();
        // Images of 32-bit floats have four channels.
        let bytes = |image: &&Image| match image.kind.format {
            vk::Format::R32G32B32A32_SFLOAT => 4 * half,
            _ => half,
        };
        // The second words come first.
        let halves: &[u64] = match (&self.words, self.keeps_depths) {
            (None, _) => &[],
            (Some(_), false) => &[half],
            (Some(_), true) => &[half, 0],
        };
        let of_halves = halves.iter().map(|_| half);
        let sizes: Vec<u64> = images.iter().map(bytes).chain(of_halves).collect();
        let host = match self.host.take() {
            Some(host) => host,
            None => {
                let usage = vk::BufferUsageFlags::TRANSFER_DST;
                let location = MemoryLocation::GpuToCpu;
                (self.device).buffer("read back", sizes.iter().sum(), usage, location)?
            }
        };
        let words = self.words.as_ref().map_or(vk::Buffer::null(), |w| w.raw);
        let layout = Layout::TRANSFER_SRC_OPTIMAL;
        commands.run(|cmd| {
            let (raw, mut at) = (self.device.raw(), 0);
            self.change(cmd, images.iter().copied(), |home| [home, layout]);
            for (image, size) in images.iter().zip(&sizes) {
                let region = [copy_of(image, at)];
                // SAFETY: the region is the whole image, and the buffer holds it from byte `at` on.
                unsafe { raw.cmd_copy_image_to_buffer(cmd, image.raw, layout, host.raw, &region) };
                at += size;
            }
            for from in halves {
                let region = vk::BufferCopy::default().src_offset(*from);
                let region = [region.dst_offset(at).size(half)];
                // SAFETY: both buffers hold the region.
                unsafe { raw.cmd_copy_buffer(cmd, words, host.raw, &region) };
                at += half;
            }
            self.change(cmd, images.iter().copied(), |home| [layout, home]);
            Ok(())
        })?;
        let mut rest: &[u8] = self.host.insert(host).mapped()?;
        let mut out = Vec::with_capacity(sizes.len());
        for size in sizes {
            let (plane, more) = rest.split_at(usize::try_from(size).unwrap_or(usize::MAX));
            out.push(plane);
            rest = more;
        }
        Ok(out)
    }
}

/// The copy of a whole image to byte `at` of a buffer.
fn copy_of(image: &Image, at: u64) -> vk::BufferImageCopy {
    let layers = vk::ImageSubresourceLayers::default()
        .aspect_mask(image.kind.aspect())
        .layer_count(1);
    vk::BufferImageCopy::default()
        .buffer_offset(at)
        .image_subresource(layers)
        .image_extent(vk::Extent3D {
            width: image.kind.width,
            height: image.kind.height,
            depth: 1,
        })
}

/// The layout of an image while it is drawn into.
fn home(image: &Image) -> Layout {
    let usage = image.kind.usage;
    if usage.contains(U::STORAGE) {
        Layout::GENERAL
    } else if usage.contains(U::DEPTH_STENCIL_ATTACHMENT) {
        Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL
    } else {
        Layout::COLOR_ATTACHMENT_OPTIMAL
    }
}

/// Clear values of a pixel that hits nothing: the background; no normal, at infinity; zeros
/// elsewhere. Colour has the first alone.
fn clear_values(background: [f32; 4]) -> [vk::ClearColorValue; 4] {
    let nowhere = [0.0, 0.0, 0.0, f32::INFINITY];
    [background, nowhere, [0.0; 4], [0.0; 4]].map(|float32| vk::ClearColorValue { float32 })
}

/// Makes the render pass of these attachments: `colors` of colours, depths, and those that colours are
/// resolved into. The pass clears the render area and changes no layout: pixels elsewhere keep what an
/// earlier pass drew.
fn render_pass(raw: &ash::Device, images: &[Image], colors: usize) -> Result<vk::RenderPass> {
    use vk::AttachmentLoadOp as Load;
    use vk::AttachmentStoreOp as Store;
    let describe = |(number, image): (usize, &Image)| {
        let is_read = image.kind.usage.contains(U::TRANSFER_SRC);
        vk::AttachmentDescription::default()
            .format(image.kind.format)
            .samples(image.kind.samples)
            .load_op(if number > colors {
                Load::DONT_CARE
            } else {
                Load::CLEAR
            })
            .store_op(if is_read {
                Store::STORE
            } else {
                Store::DONT_CARE
            })
            .initial_layout(home(image))
            .final_layout(home(image))
    };
    let attachments: Vec<_> = images.iter().enumerate().map(describe).collect();
    let refer = |(attachment, number): (&vk::AttachmentDescription, u32)| {
        vk::AttachmentReference::default()
            .attachment(number)
            .layout(attachment.final_layout)
    };
    let all: Vec<_> = attachments.iter().zip(0..).map(refer).collect();
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&all[..colors])
        .depth_stencil_attachment(&all[colors]);
    if all.len() > colors + 1 {
        subpass = subpass.resolve_attachments(&all[colors + 1..]);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses);
    // SAFETY: `info` and all it points to live until the call returns.
    unsafe { raw.create_render_pass(&info, None) }.map_err(failed("vkCreateRenderPass"))
}

impl Drop for Target {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: every submission was waited for; null handles may be destroyed.
        unsafe {
            raw.destroy_framebuffer(self.framebuffer, None);
            raw.destroy_render_pass(self.pass, None);
        }
    }
}
