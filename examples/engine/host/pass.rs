//! The pass that frames are drawn in, and the pipeline of the host's meshes.

use super::stage::MeshShaders;
use super::stage::Stage;
use super::{COLOR, DEPTH, Fallible};
use ash::vk;

impl Stage<'_> {
    pub(super) unsafe fn make_pass(&mut self) -> Fallible<()> {
        let device = &self.host.device;
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
        let (color, depth) = (self.color.drawn(), self.depth.drawn());
        let mut attachments = vec![
            attachment(COLOR, samples, color),
            attachment(DEPTH, samples, depth),
        ];
        let mut views = vec![self.color.view, self.depth.view];
        if let Some(several) = &self.multisampled {
            attachments.push(attachment(COLOR, vk::SampleCountFlags::TYPE_1, color));
            views = vec![several.view, self.depth.view, self.color.view];
        }
        let reference = |n, layout| {
            vk::AttachmentReference::default()
                .attachment(n)
                .layout(layout)
        };
        let (colors, depths) = ([reference(0, color)], reference(1, depth));
        let resolves = [reference(2, color)];
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

    pub(super) unsafe fn make_pipeline(&mut self, shaders: &MeshShaders<'_>) -> Fallible<()> {
        let device = &self.host.device;
        let words = |bytes: &[u8]| ash::util::read_spv(&mut std::io::Cursor::new(bytes));
        let codes = [words(shaders.vertex)?, words(shaders.fragment)?];
        // SAFETY: plain creations; modules are not needed once the pipeline is made.
        unsafe {
            let module = |code: &[u32]| {
                device.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(code), None)
            };
            let modules = [module(&codes[0])?, module(&codes[1])?];
            let stage = |stage, module| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage)
                    .module(module)
                    .name(c"main")
            };
            let stages = [
                stage(vk::ShaderStageFlags::VERTEX, modules[0]),
                stage(vk::ShaderStageFlags::FRAGMENT, modules[1]),
            ];
            let bindings = [vk::VertexInputBindingDescription::default().stride(24)];
            let attribute = |n| {
                vk::VertexInputAttributeDescription::default()
                    .location(n)
                    .format(vk::Format::R32G32B32_SFLOAT)
                    .offset(12 * n)
            };
            let attributes = [attribute(0), attribute(1)];
            let input = vk::PipelineVertexInputStateCreateInfo::default()
                .vertex_binding_descriptions(&bindings)
                .vertex_attribute_descriptions(&attributes);
            let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
                .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
            let viewport = vk::PipelineViewportStateCreateInfo::default()
                .viewport_count(1)
                .scissor_count(1);
            let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
            let samples = vk::PipelineMultisampleStateCreateInfo::default()
                .rasterization_samples(vk::SampleCountFlags::from_raw(self.options.samples));
            let nearer = match self.options.reversed {
                true => vk::CompareOp::GREATER,
                false => vk::CompareOp::LESS,
            };
            let depth = vk::PipelineDepthStencilStateCreateInfo::default()
                .depth_test_enable(true)
                .depth_write_enable(true)
                .depth_compare_op(nearer);
            let blends = [vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA)];
            let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
            let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
            let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
            let mut rendering = vk::PipelineRenderingCreateInfo::default()
                .color_attachment_formats(std::slice::from_ref(&COLOR))
                .depth_attachment_format(DEPTH);
            let mut info = vk::GraphicsPipelineCreateInfo::default()
                .stages(&stages)
                .vertex_input_state(&input)
                .input_assembly_state(&assembly)
                .viewport_state(&viewport)
                .rasterization_state(&raster)
                .multisample_state(&samples)
                .depth_stencil_state(&depth)
                .color_blend_state(&blend)
                .dynamic_state(&dynamic)
                .layout(self.layout)
                .render_pass(self.pass);
            if self.options.dynamic {
                info = info.push_next(&mut rendering);
            }
            let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
            self.pipeline = made.map_err(|(_, code)| code)?[0];
            for module in modules {
                device.destroy_shader_module(module, None);
            }
        }
        Ok(())
    }
}
