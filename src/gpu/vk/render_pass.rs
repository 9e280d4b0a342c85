//! The render pass that pipelines of one subpass are compiled for.

use crate::error::Result;
use crate::gpu::vk::call::Call;
use ash::vk;

/// A render pass of one subpass, which only compiling a pipeline reads. The host begins another one,
/// which is compatible: load and store operations, layouts and resolves may differ.
pub(crate) struct CompatiblePass<'a> {
    pub raw: vk::RenderPass,
    device: &'a ash::Device,
}

impl<'a> CompatiblePass<'a> {
    pub fn new(
        device: &'a ash::Device,
        color: &[vk::Format],
        depth: vk::Format,
        samples: u32,
    ) -> Result<Self> {
        let formats = color.iter().chain([&depth]);
        let attachment = |format: &vk::Format| {
            vk::AttachmentDescription::default()
                .format(*format)
                .samples(vk::SampleCountFlags::from_raw(samples))
                .initial_layout(vk::ImageLayout::GENERAL)
                .final_layout(vk::ImageLayout::GENERAL)
        };
        let attachments: Vec<_> = formats.map(attachment).collect();
        let refer = |number| {
            vk::AttachmentReference::default()
                .attachment(number)
                .layout(vk::ImageLayout::GENERAL)
        };
        let all: Vec<_> = (0..attachments.len() as u32).map(refer).collect();
        let subpasses = [vk::SubpassDescription::default()
            .color_attachments(&all[..color.len()])
            .depth_stencil_attachment(&all[color.len()])];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses);
        // SAFETY: `info` and all it points to live until the call returns; Drop destroys the pass.
        let raw = unsafe { device.create_render_pass(&info, None) }.call("vkCreateRenderPass")?;
        Ok(Self { raw, device })
    }
}

impl Drop for CompatiblePass<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines do not need the pass once they are made.
        unsafe { self.device.destroy_render_pass(self.raw, None) };
    }
}
