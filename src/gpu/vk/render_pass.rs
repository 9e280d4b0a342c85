//! The render pass of the fragment stage, and the formats that it draws into.

use crate::error::Result;
use crate::gpu::vk::call::Call;
use crate::settings::Planes;
use ash::vk;

/// Formats of the colour attachments of the fragment path, in order of location.
pub(crate) fn color_formats(planes: Planes) -> &'static [vk::Format] {
    match planes {
        Planes::Color => &[vk::Format::R8G8B8A8_SRGB],
        Planes::Depth { .. } => &[],
        Planes::All => &[vk::Format::R32G32B32A32_SFLOAT; 4],
    }
}

pub(crate) const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// Dependencies from the previous frame to this frame's clears, and from its writes to the copies
/// after it.
fn dependencies(keeps_depths: bool) -> [vk::SubpassDependency; 2] {
    use vk::AccessFlags as A;
    use vk::PipelineStageFlags as S;
    let fragment_tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
    let (left, written) = if keeps_depths {
        (fragment_tests, A::DEPTH_STENCIL_ATTACHMENT_WRITE)
    } else {
        (S::empty(), A::empty())
    };
    [
        // The last frame's copies and depth tests are over before this frame's clears.
        vk::SubpassDependency::default()
            .src_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(S::TRANSFER | fragment_tests | S::COLOR_ATTACHMENT_OUTPUT)
            .dst_stage_mask(S::COLOR_ATTACHMENT_OUTPUT | fragment_tests)
            .src_access_mask(
                A::TRANSFER_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE | A::COLOR_ATTACHMENT_WRITE,
            )
            .dst_access_mask(
                A::COLOR_ATTACHMENT_WRITE
                    | A::DEPTH_STENCIL_ATTACHMENT_READ
                    | A::DEPTH_STENCIL_ATTACHMENT_WRITE,
            ),
        // This frame's writes are over before they are copied.
        vk::SubpassDependency::default()
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(S::COLOR_ATTACHMENT_OUTPUT | left)
            .dst_stage_mask(S::TRANSFER)
            .src_access_mask(A::COLOR_ATTACHMENT_WRITE | written)
            .dst_access_mask(A::TRANSFER_READ),
    ]
}

/// Makes a render pass that clears its attachments at its start. At the end, colours and kept
/// depths are ready to be copied from.
pub(crate) fn render_pass(
    raw: &ash::Device,
    planes: Planes,
    keeps_depths: bool,
) -> Result<vk::RenderPass> {
    let mut attachments: Vec<_> = color_formats(planes)
        .iter()
        .map(|format| {
            vk::AttachmentDescription::default()
                .format(*format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .final_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)
        })
        .collect();
    let colors: Vec<_> = (0u32..)
        .take(attachments.len())
        .map(|n| {
            vk::AttachmentReference::default()
                .attachment(n)
                .layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
        })
        .collect();
    let depth = vk::AttachmentReference::default()
        .attachment(u32::try_from(colors.len()).unwrap_or(0))
        .layout(vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    let (store, layout) = if keeps_depths {
        (
            vk::AttachmentStoreOp::STORE,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        )
    } else {
        (
            vk::AttachmentStoreOp::DONT_CARE,
            vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        )
    };
    attachments.push(
        vk::AttachmentDescription::default()
            .format(DEPTH_FORMAT)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(store)
            .final_layout(layout),
    );
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colors)
        .depth_stencil_attachment(&depth)];
    let dependencies = dependencies(keeps_depths);
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: `info` and all it points to live until the call returns.
    unsafe { raw.create_render_pass(&info, None) }.call("vkCreateRenderPass")
}
