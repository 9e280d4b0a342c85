//! The memory that is drawn into: images of the planes, the depth buffer, two words per pixel.
//! Copies of it to the host.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::buffers::{Buffer, Use};
use crate::gpu::memory::{Image, ImageKind};
use crate::gpu::offscreen::commands::Commands;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::output::ComputeTarget;
use crate::gpu::vk::render_pass::{DEPTH_FORMAT, color_formats};
use crate::gpu::vk::usage::Usage;
use crate::settings::{DrawStage, Planes};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The images of an off-screen frame.
pub(crate) struct Target {
    pub width: u32,
    pub height: u32,
    stage: DrawStage,
    planes: Planes,
    /// The fragment path's attachments, or the compute path's storage images. Empty if compute
    /// draws only colour.
    pub images: Vec<Image>,
    /// What fragments are drawn into before it is resolved into the images, if a pixel has several
    /// samples.
    sampled: Vec<Image>,
    depth: Option<Image>,
    framebuffer: vk::Framebuffer,
    /// The depths of all pixels, then their second words (see `pixel_words.glsl`). `None` if
    /// fragments draw only colour.
    pub words: Option<Buffer>,
    /// True if depths are read beside colours.
    keeps_depths: bool,
    /// Host memory that `read` copies to; made by the first call.
    host: Option<Buffer>,
    device: Arc<Shared>,
}

/// A source that is copied to the host as a whole.
enum Source<'a> {
    Image(&'a Image),
    /// Half of the words, from this byte on. Depths are the first half.
    Words(&'a Buffer, u64),
}

/// Returns an error for more pixels than the device draws, or than fit into a buffer at two words
/// per pixel.
fn check_size(device: &Shared, (width, height): (u32, u32), needs_words: bool) -> Result<()> {
    let limits = device.limits();
    let side = limits.max_image_dimension2_d;
    let most_x = limits.max_framebuffer_width.min(side);
    let most_y = limits.max_framebuffer_height.min(side);
    let most_words = limits.max_storage_buffer_range / 8;
    let words_fit = u64::from(width) * u64::from(height) <= u64::from(most_words);
    if width <= most_x && height <= most_y && (words_fit || !needs_words) {
        return Ok(());
    }
    let name = &device.chosen.report.name;
    let message = format!(
        "{width}x{height} pixels are more than {name} takes ({most_x}x{most_y}, and {most_words} in all for this kind of picture); make it smaller"
    );
    Err(Error::new(ErrorKind::TooLarge, message).at_key("size"))
}

impl Target {
    pub fn new(
        device: &Arc<Shared>,
        render_pass: vk::RenderPass,
        stage: DrawStage,
        planes: Planes,
        keeps_depths: bool,
        samples: u32,
        (width, height): (u32, u32),
    ) -> Result<Self> {
        let needs_words = stage == DrawStage::Compute || planes == Planes::All;
        check_size(device, (width, height), needs_words)?;
        let mut target = Self {
            width,
            height,
            stage,
            planes,
            images: Vec::new(),
            sampled: Vec::new(),
            depth: None,
            framebuffer: vk::Framebuffer::null(),
            words: None,
            keeps_depths,
            host: None,
            device: device.clone(),
        };
        let one = vk::SampleCountFlags::TYPE_1;
        let samples = vk::SampleCountFlags::from_raw(samples);
        let image = |name, format, samples, usage| {
            let kind = ImageKind {
                format,
                width,
                height,
                mips: 1,
                samples,
                usage,
            };
            Image::new(device, name, kind)
        };
        use vk::ImageUsageFlags as U;
        let usage = match stage {
            DrawStage::Compute => U::STORAGE | U::TRANSFER_DST | U::TRANSFER_SRC,
            _ => U::COLOR_ATTACHMENT | U::TRANSFER_SRC,
        };
        if stage != DrawStage::Compute || planes == Planes::All {
            for format in color_formats(planes) {
                target.images.push(image("plane", format, one, usage)?);
            }
        }
        if stage != DrawStage::Compute {
            let copied = if keeps_depths {
                U::TRANSFER_SRC
            } else {
                U::empty()
            };
            let usage = U::DEPTH_STENCIL_ATTACHMENT | copied;
            let depth = image("depth", DEPTH_FORMAT, samples, usage)?;
            if samples != one {
                for format in color_formats(planes) {
                    let samples = image("samples", format, samples, U::COLOR_ATTACHMENT)?;
                    target.sampled.push(samples);
                }
            }
            target.framebuffer = target.framebuffer(render_pass, &depth)?;
            target.depth = Some(depth);
        }
        if needs_words {
            let pixels = u64::from(width) * u64::from(height);
            target.words = Some(Buffer::for_use(
                device,
                Use::Pixels,
                "pixel words",
                8 * pixels,
            )?);
        }
        Ok(target)
    }

    /// The attachments of the fragment path, in the order of `render_pass`.
    fn framebuffer(&self, pass: vk::RenderPass, depth: &Image) -> Result<vk::Framebuffer> {
        let attached = self.sampled.iter().chain(&self.images);
        let mut views: Vec<_> = attached.map(|image| image.view).collect();
        views.insert(color_formats(self.planes).len(), depth.view);
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views)
            .width(self.width)
            .height(self.height)
            .layers(1);
        // SAFETY: the views live as long as the framebuffer.
        unsafe { self.device.raw.create_framebuffer(&info, None) }.call("vkCreateFramebuffer")
    }

    /// The memory that shaders write to besides attachments.
    pub fn for_shaders(&self) -> Option<ComputeTarget> {
        let storage = |i: &&Image| i.kind.usage.contains(vk::ImageUsageFlags::STORAGE);
        Some(ComputeTarget {
            words: self.words.as_ref()?.raw,
            images: self.images.iter().filter(storage).map(|i| i.view).collect(),
            depths: self.keeps_depths,
        })
    }

    /// Records clears of all memory that no render pass clears.
    pub fn clear(&self, cmd: vk::CommandBuffer, background: [f32; 4], depths: bool) {
        let raw = &self.device.raw;
        let next = self.shader_use();
        if let Some(words) = &self.words {
            let half = 4 * u64::from(self.width) * u64::from(self.height);
            let second = match self.planes {
                Planes::Color => ComputeTarget::color_word(background),
                _ => 0,
            };
            words.barrier(cmd, Usage::TransferRead, Usage::TransferWrite);
            // SAFETY: `cmd` is recording and both ranges are within the buffer.
            unsafe {
                if depths {
                    raw.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
                }
                raw.cmd_fill_buffer(cmd, words.raw, half, half, second);
            }
            words.barrier(cmd, Usage::TransferWrite, next);
        }
        if self.stage == DrawStage::Compute {
            for (image, value) in self
                .images
                .iter()
                .zip(clear_values(self.planes, background))
            {
                image.barrier(cmd, Usage::Nothing, Usage::TransferWrite);
                // SAFETY: as above; the image was made for transfers.
                unsafe {
                    raw.cmd_clear_color_image(
                        cmd,
                        image.raw,
                        vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                        &value,
                        &[image.kind.range()],
                    );
                }
                image.barrier(cmd, Usage::TransferWrite, next);
            }
        }
    }

    /// The use of images and words by shaders.
    fn shader_use(&self) -> Usage {
        if self.stage == DrawStage::Compute {
            Usage::ComputeWrite
        } else {
            Usage::FragmentAtomic
        }
    }

    /// Begins the render pass of the fragment path in some rows, cleared to `background`.
    pub fn begin(
        &self,
        cmd: vk::CommandBuffer,
        pass: vk::RenderPass,
        background: [f32; 4],
        rows: &Range<u32>,
    ) {
        #[allow(clippy::cast_possible_wrap)] // sizes are far below 2^31
        let area = vk::Rect2D {
            offset: vk::Offset2D {
                x: 0,
                y: rows.start as i32,
            },
            extent: vk::Extent2D {
                width: self.width,
                height: rows.end - rows.start,
            },
        };
        let mut clears: Vec<_> = clear_values(self.planes, background)
            .into_iter()
            .take(self.images.len())
            .map(|color| vk::ClearValue { color })
            .collect();
        clears.push(vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: 1.0,
                stencil: 0,
            },
        });
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(pass)
            .framebuffer(self.framebuffer)
            .render_area(area)
            .clear_values(&clears);
        #[allow(clippy::cast_precision_loss)] // sizes are far below 2^24
        let viewport = vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: self.width as f32,
            height: self.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: `cmd` is recording, outside a render pass; the framebuffer fits the pass.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            raw.cmd_set_viewport(cmd, 0, &[viewport]);
            raw.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// The sources to read, in order: images of the planes, or colours among the words; counts of
    /// look-ups, if all planes are drawn; depths, if kept.
    fn sources(&self) -> Vec<Source<'_>> {
        let mut sources: Vec<_> = self.images.iter().map(Source::Image).collect();
        if let Some(words) = &self.words {
            sources.push(Source::Words(words, words.bytes / 2));
        }
        if self.keeps_depths {
            sources.extend(match (&self.depth, &self.words) {
                (Some(depth), _) => Some(Source::Image(depth)),
                (None, Some(words)) => Some(Source::Words(words, 0)),
                (None, None) => None,
            });
        }
        sources
    }

    /// Copies the sources of [`Target::sources`] to the host, and returns the bytes of each.
    pub fn read(&mut self, commands: &Commands) -> Result<Vec<&[u8]>> {
        let pixels = u64::from(self.width) * u64::from(self.height);
        let bytes = |source: &Source| match source {
            Source::Image(image) if image.kind.format == vk::Format::R32G32B32A32_SFLOAT => 16,
            Source::Image(_) | Source::Words(..) => 4,
        } * pixels;
        let kept = self.host.take();
        let sources = self.sources();
        let sizes: Vec<u64> = sources.iter().map(bytes).collect();
        let host = match kept {
            Some(host) => host,
            None => Buffer::for_use(&self.device, Use::ReadBack, "read back", sizes.iter().sum())?,
        };
        commands.run(|cmd| {
            let mut at = 0;
            for (source, size) in sources.iter().zip(&sizes) {
                self.copy(cmd, source, &host, at);
                at += size;
            }
            let (from, to) = (Usage::TransferWrite, Usage::HostRead);
            host.barrier(cmd, from, to);
        })?;
        drop(sources);
        let mut rest: &[u8] = self.host.insert(host).mapped()?;
        let mut out = Vec::with_capacity(sizes.len());
        for size in sizes {
            let (plane, more) = rest.split_at(usize::try_from(size).unwrap_or(usize::MAX));
            out.push(plane);
            rest = more;
        }
        Ok(out)
    }

    /// Records the copy of one source to `host`, from its byte `at` on.
    fn copy(&self, cmd: vk::CommandBuffer, source: &Source, host: &Buffer, at: u64) {
        let raw = &self.device.raw;
        match source {
            Source::Image(image) => {
                let in_compute = self.stage == DrawStage::Compute;
                if in_compute {
                    let (from, to) = (Usage::ComputeWrite, Usage::TransferRead);
                    image.barrier(cmd, from, to);
                }
                let region = vk::BufferImageCopy::default()
                    .buffer_offset(at)
                    .image_subresource(
                        vk::ImageSubresourceLayers::default()
                            .aspect_mask(image.kind.aspect())
                            .layer_count(1),
                    )
                    .image_extent(vk::Extent3D {
                        width: self.width,
                        height: self.height,
                        depth: 1,
                    });
                // SAFETY: the region is the whole image, and the buffer holds it from byte `at` on.
                unsafe {
                    raw.cmd_copy_image_to_buffer(
                        cmd,
                        image.raw,
                        vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
                        host.raw,
                        &[region],
                    );
                }
                if in_compute {
                    let (from, to) = (Usage::TransferRead, Usage::ComputeWrite);
                    image.barrier(cmd, from, to);
                }
            }
            Source::Words(words, from) => {
                let (used, to) = (self.shader_use(), Usage::TransferRead);
                words.barrier(cmd, used, to);
                let region = vk::BufferCopy::default()
                    .src_offset(*from)
                    .dst_offset(at)
                    .size(words.bytes / 2);
                // SAFETY: both buffers hold the region.
                unsafe { raw.cmd_copy_buffer(cmd, words.raw, host.raw, &[region]) };
            }
        }
    }
}

/// Clear values of a pixel that hits nothing: the background; no normal, at infinity; zeros
/// elsewhere.
fn clear_values(planes: Planes, background: [f32; 4]) -> Vec<vk::ClearColorValue> {
    let color = |float32| vk::ClearColorValue { float32 };
    match planes {
        Planes::Color => vec![color(background)],
        Planes::Depth { .. } | Planes::List(_) => Vec::new(),
        Planes::All => vec![
            color(background),
            color([0.0, 0.0, 0.0, f32::INFINITY]),
            color([0.0; 4]),
            color([0.0; 4]),
        ],
    }
}

impl Drop for Target {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for; a null framebuffer may be destroyed.
        unsafe {
            self.device.raw.destroy_framebuffer(self.framebuffer, None);
        }
    }
}
