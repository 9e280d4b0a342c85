//! The render pass of the fragment stage, and the formats that it draws into.

use crate::error::Result;
use crate::gpu::vk::call::Call;
use crate::settings::{Plane, Planes};
use ash::vk;

/// The number of colour attachments.
pub(crate) fn attachments(planes: Planes) -> usize {
    color_formats(planes).len()
}

/// Formats of the library's own colour attachments, in order of location.
pub(crate) fn color_formats(planes: Planes) -> Vec<vk::Format> {
    use vk::Format as F;
    match planes {
        Planes::Color => vec![F::R8G8B8A8_SRGB],
        Planes::Depth { .. } => Vec::new(),
        Planes::All => vec![F::R32G32B32A32_SFLOAT; 4],
        Planes::List(list) => {
            let format = |plane: &Plane| match plane {
                Plane::Color | Plane::BaseColor | Plane::Normal => F::R16G16B16A16_SFLOAT,
                Plane::OctahedralNormal | Plane::Material | Plane::Motion => F::R16G16_SFLOAT,
                Plane::Identity => F::R32G32_UINT,
            };
            list.planes().iter().map(format).collect()
        }
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

/// Makes a render pass of so many samples a pixel that clears its attachments at its start. At the
/// end, colours and kept depths are ready to be copied from. Several samples of a colour are
/// resolved into an attachment behind the others. `resumes`: pixels outside of the render area keep
/// what an earlier pass of the same attachments drew.
pub(crate) fn render_pass(
    raw: &ash::Device,
    planes: Planes,
    keeps_depths: bool,
    samples: vk::SampleCountFlags,
    resumes: bool,
) -> Result<vk::RenderPass> {
    use vk::AttachmentLoadOp as Load;
    use vk::AttachmentStoreOp as Store;
    use vk::ImageLayout as Layout;
    let attachment = |format, samples, load, store, layout| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(load)
            .store_op(store)
            .initial_layout(if resumes { layout } else { Layout::UNDEFINED })
            .final_layout(layout)
    };
    let one = vk::SampleCountFlags::TYPE_1;
    let resolves = samples != one;
    let (color, copied) = (
        Layout::COLOR_ATTACHMENT_OPTIMAL,
        Layout::TRANSFER_SRC_OPTIMAL,
    );
    let depth = Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    let written = |format| match resolves {
        true => attachment(format, samples, Load::CLEAR, Store::DONT_CARE, color),
        false => attachment(format, one, Load::CLEAR, Store::STORE, copied),
    };
    let formats = color_formats(planes);
    let mut attachments: Vec<_> = formats.iter().map(|format| written(*format)).collect();
    attachments.push(match keeps_depths {
        true => attachment(DEPTH_FORMAT, samples, Load::CLEAR, Store::STORE, copied),
        false => attachment(DEPTH_FORMAT, samples, Load::CLEAR, Store::DONT_CARE, depth),
    });
    let resolved = |format| attachment(format, one, Load::DONT_CARE, Store::STORE, copied);
    attachments.extend(formats.iter().map(|format| resolved(*format)));
    attachments.truncate(1 + formats.len() * if resolves { 2 } else { 1 });
    let refer = |number: usize, layout| {
        vk::AttachmentReference::default()
            .attachment(u32::try_from(number).unwrap_or(0))
            .layout(layout)
    };
    let count = formats.len();
    let colors: Vec<_> = (0..count).map(|n| refer(n, color)).collect();
    let means: Vec<_> = (0..count).map(|n| refer(count + 1 + n, color)).collect();
    let depth = refer(count, depth);
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colors)
        .depth_stencil_attachment(&depth);
    if resolves {
        subpass = subpass.resolve_attachments(&means);
    }
    let subpasses = [subpass];
    let dependencies = dependencies(keeps_depths);
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: `info` and all it points to live until the call returns.
    unsafe { raw.create_render_pass(&info, None) }.call("vkCreateRenderPass")
}
