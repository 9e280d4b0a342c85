//! What a multisampled picture (MSAA) is drawn into: a pass of four samples a pixel that is resolved.

use super::MeshPipelines;
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Buffer, Device, Guest, allocation_error, vulkan_error as vulkan};
use std::cell::Cell;
use std::sync::Arc;

/// Samples a pixel. Every device has them, of colours and of depths.
pub(in super::super) const SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// Images of four samples, what they are resolved to, and its bytes on the host.
pub(in super::super) struct MultisampledTarget {
    pub pass: vk::RenderPass,
    /// Whether the picture is copied to the host.
    pub copies: Cell<bool>,
    pub background: [f32; 4],
    size: (u32, u32),
    /// Colours, what they are resolved to, depths.
    images: Vec<Image>,
    framebuffer: vk::Framebuffer,
    host: Buffer,
    pipelines: Arc<MeshPipelines>,
}

/// A guest of an off-screen frame that draws another in a pass of its own, beforehand.
pub(in super::super) struct Within<'a> {
    pub guest: &'a dyn Guest,
    pub target: &'a MultisampledTarget,
}

impl Guest for Within<'_> {
    unsafe fn prepare(&self, cmd: vk::CommandBuffer) {
        // SAFETY: `cmd` is recording outside of a pass; between both calls it is in the target's.
        unsafe {
            self.guest.prepare(cmd);
            self.target.begin(cmd);
            self.guest.record(cmd);
            self.target.end(cmd);
        }
    }

    unsafe fn record(&self, _cmd: vk::CommandBuffer) {}
}

#[derive(Default)]
struct Image {
    raw: vk::Image,
    view: vk::ImageView,
    allocation: Option<Allocation>,
}

impl MultisampledTarget {
    /// Of colours in `format`, four channels.
    pub fn new(
        pipelines: &Arc<MeshPipelines>,
        format: vk::Format,
        size: (u32, u32),
        background: [f32; 4],
    ) -> Result<Self> {
        let bytes = 16 * u64::from(size.0) * u64::from(size.1);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let device = pipelines.device();
        let mut target = Self {
            pass: pipelines.multisampled_pass(format)?,
            copies: Cell::new(false),
            background,
            size,
            images: Vec::new(),
            framebuffer: vk::Framebuffer::null(),
            host: device.buffer("read back", bytes, usage, MemoryLocation::GpuToCpu)?,
            pipelines: pipelines.clone(),
        };
        use vk::ImageUsageFlags as U;
        let (color, depth) = (U::COLOR_ATTACHMENT, U::DEPTH_STENCIL_ATTACHMENT);
        for (format, samples, usage) in [
            (format, SAMPLES, color),
            (format, ONE, color | U::TRANSFER_SRC),
            (DEPTH, SAMPLES, depth),
        ] {
            let mut image = Image::default();
            let made = image.make(device, size, format, samples, usage);
            target.images.push(image);
            made?;
        }
        let views: Vec<_> = target.images.iter().map(|image| image.view).collect();
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(target.pass)
            .attachments(&views)
            .width(size.0)
            .height(size.1)
            .layers(1);
        // SAFETY: the views live as long as the framebuffer.
        target.framebuffer = unsafe { device.raw().create_framebuffer(&info, None) }
            .map_err(|code| vulkan("vkCreateFramebuffer", code))?;
        Ok(target)
    }

    /// The bytes of the last frame, which was copied.
    pub fn bytes(&mut self) -> Result<&[u8]> {
        self.host.mapped().map(|bytes| &*bytes)
    }

    /// Begins the pass.
    unsafe fn begin(&self, cmd: vk::CommandBuffer) {
        let raw = self.pipelines.device().raw();
        let (width, height) = self.size;
        let area = vk::Rect2D::default().extent(vk::Extent2D { width, height });
        let float32 = self.background;
        let color = vk::ClearValue {
            color: vk::ClearColorValue { float32 },
        };
        let depth_stencil = vk::ClearDepthStencilValue {
            depth: 1.0,
            stencil: 0,
        };
        let clears = [color, color, vk::ClearValue { depth_stencil }];
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass)
            .framebuffer(self.framebuffer)
            .render_area(area)
            .clear_values(&clears);
        let viewport = vk::Viewport {
            width: width as f32,
            height: height as f32,
            max_depth: 1.0,
            ..Default::default()
        };
        // SAFETY: `cmd` is recording outside of a pass; the framebuffer fits the pass.
        unsafe {
            raw.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            raw.cmd_set_viewport(cmd, 0, &[viewport]);
            raw.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Ends the pass, and copies what it has resolved.
    unsafe fn end(&self, cmd: vk::CommandBuffer) {
        let raw = self.pipelines.device().raw();
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .layer_count(1);
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D {
                width: self.size.0,
                height: self.size.1,
                depth: 1,
            });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let (image, host) = (self.images[1].raw, self.host.raw);
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        use vk::PipelineStageFlags as S;
        let none = vk::DependencyFlags::empty();
        // SAFETY: `cmd` is recording in the pass, which leaves the image in this layout; the buffer
        // holds it.
        unsafe {
            raw.cmd_end_render_pass(cmd);
            if self.copies.get() {
                raw.cmd_copy_image_to_buffer(cmd, image, layout, host, &[region]);
                raw.cmd_pipeline_barrier(cmd, S::TRANSFER, S::HOST, none, &[barrier], &[], &[]);
            }
        }
    }
}

impl Drop for MultisampledTarget {
    fn drop(&mut self) {
        let device = self.pipelines.device();
        let allocator = device.allocator();
        // SAFETY: every frame was waited for; null handles may be destroyed.
        unsafe {
            device.raw().destroy_framebuffer(self.framebuffer, None);
            for image in &mut self.images {
                device.raw().destroy_image_view(image.view, None);
                device.raw().destroy_image(image.raw, None);
            }
        }
        for image in &mut self.images {
            if let (Some(allocation), Ok(allocator)) = (image.allocation.take(), &allocator)
                && let Ok(mut allocator) = allocator.lock()
            {
                // What cannot be freed is freed with the device.
                let _ = allocator.free(allocation);
            }
        }
    }
}

impl Image {
    /// Fills in what is null.
    fn make(
        &mut self,
        device: &Device,
        (width, height): (u32, u32),
        format: vk::Format,
        samples: vk::SampleCountFlags,
        usage: vk::ImageUsageFlags,
    ) -> Result<()> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D {
                width,
                height,
                depth: 1,
            })
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        let raw = device.raw();
        // SAFETY: plain creations, destroyed with the target; memory is bound once.
        unsafe {
            self.raw = (raw.create_image(&info, None)).map_err(|c| vulkan("vkCreateImage", c))?;
            let made = AllocationCreateDesc {
                name: "samples",
                requirements: raw.get_image_memory_requirements(self.raw),
                location: MemoryLocation::GpuOnly,
                linear: false,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            };
            let allocator = device.allocator()?;
            let gone = |_| Error::new(ErrorKind::Other, "the allocator is gone after a panic");
            let made = (allocator.lock().map_err(gone)?.allocate(&made))
                .map_err(|e| allocation_error("samples", made.requirements.size, &e))?;
            let made = self.allocation.insert(made);
            raw.bind_image_memory(self.raw, made.memory(), made.offset())
                .map_err(|c| vulkan("vkBindImageMemory", c))?;
            let aspect = if format == DEPTH {
                vk::ImageAspectFlags::DEPTH
            } else {
                vk::ImageAspectFlags::COLOR
            };
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(aspect)
                .level_count(1)
                .layer_count(1);
            let info = vk::ImageViewCreateInfo::default()
                .image(self.raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range);
            self.view =
                (raw.create_image_view(&info, None)).map_err(|c| vulkan("vkCreateImageView", c))?;
        }
        Ok(())
    }
}

/// A pass of one colour in `format` and depths, of four samples; colours are resolved and left to be
/// copied from.
pub(super) fn pass(device: &Device, format: vk::Format) -> Result<vk::RenderPass> {
    use vk::ImageLayout as Layout;
    use vk::{AttachmentLoadOp as Load, AttachmentStoreOp as Store};
    let attachment = |format, samples, load, store, layout| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(load)
            .store_op(store)
            .final_layout(layout)
    };
    let color = Layout::COLOR_ATTACHMENT_OPTIMAL;
    let depth = Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    let copied = Layout::TRANSFER_SRC_OPTIMAL;
    let attachments = [
        attachment(format, SAMPLES, Load::CLEAR, Store::DONT_CARE, color),
        attachment(format, ONE, Load::DONT_CARE, Store::STORE, copied),
        attachment(DEPTH, SAMPLES, Load::CLEAR, Store::DONT_CARE, depth),
    ];
    let refer = |n, layout| {
        vk::AttachmentReference::default()
            .attachment(n)
            .layout(layout)
    };
    let (colors, resolved, depths) = ([refer(0, color)], [refer(1, color)], refer(2, depth));
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colors)
        .resolve_attachments(&resolved)
        .depth_stencil_attachment(&depths)];
    use vk::AccessFlags as A;
    use vk::PipelineStageFlags as S;
    let written = A::COLOR_ATTACHMENT_WRITE | A::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
    let dependencies = [
        vk::SubpassDependency::default()
            .src_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(S::TRANSFER | S::COLOR_ATTACHMENT_OUTPUT | tests)
            .src_access_mask(A::TRANSFER_READ | written)
            .dst_stage_mask(S::COLOR_ATTACHMENT_OUTPUT | tests)
            .dst_access_mask(written | A::DEPTH_STENCIL_ATTACHMENT_READ),
        vk::SubpassDependency::default()
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(S::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(A::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(S::TRANSFER)
            .dst_access_mask(A::TRANSFER_READ),
    ];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: `info` and all it points to live until the call returns.
    unsafe { device.raw().create_render_pass(&info, None) }
        .map_err(|code| vulkan("vkCreateRenderPass", code))
}
