//! The pass that frames are drawn in.

use super::memory::HostImage;
use super::{COLOR, DEPTH, Fallible, Host, Options};
use ash::vk;

/// A render pass and its framebuffer; `multisampled` is drawn into and resolved into `color`.
///
/// # Safety
/// The caller destroys both, before the images.
pub(super) unsafe fn make_pass(
    host: &Host,
    options: &Options,
    [color, depth]: [&HostImage; 2],
    multisampled: Option<&HostImage>,
) -> Fallible<(vk::RenderPass, vk::Framebuffer)> {
    let device = &host.device;
    let samples = vk::SampleCountFlags::from_raw(options.samples);
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
    if let Some(several) = multisampled {
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
    if multisampled.is_some() {
        subpass = subpass.resolve_attachments(&resolves);
    }
    let subpasses = [subpass];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses);
    // SAFETY: plain creations, destroyed by the caller.
    unsafe {
        let pass = device.create_render_pass(&info, None)?;
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views)
            .width(options.width)
            .height(options.height)
            .layers(1);
        Ok((pass, device.create_framebuffer(&info, None)?))
    }
}
