//! One pipeline: its modules, constants and fixed state.

use super::{BoundShading, Owner, Pipelines};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::output::{Output, PassFormats, PassKind};
use crate::gpu::vk::render_pass::CompatiblePass;
use crate::plan::DepthOrder;
use crate::settings::{Plane, Planes};
use crate::shader::{
    Kind, Module, SearchCode, Variant, depth_less, frozen, with_constant_textures, with_locations,
    with_outputs_for, with_varying_textures, without_contraction, words,
};
use ash::vk;
use std::collections::HashMap;
use std::sync::PoisonError;

impl Pipelines {
    pub(super) fn compile(
        &self,
        variant: &Variant,
        kind: Kind,
        owner: &Owner,
    ) -> Result<vk::Pipeline> {
        let (output, host) = (&owner.output, owner.shading.as_ref());
        let own = variant.constants(kind).into_iter();
        let constants = own.chain(output.constants()).chain(self.constants.values());
        let constants = constants.collect();
        let module = variant.module(kind);
        match (variant.vertices(kind), output) {
            (None, _) => self.compute(variant, &module, host, &constants),
            (Some(vertices), Output::Pass(pass)) => {
                let modules = [&vertices, &module];
                self.graphics((variant, kind), pass, modules, host, &constants)
            }
            (Some(_), Output::Compute(_)) => {
                let message = "fragments are drawn in a pass, not in compute";
                Err(Error::new(ErrorKind::Other, message))
            }
        }
    }

    fn words(
        &self,
        variant: &Variant,
        module: &Module,
        host: Option<&BoundShading>,
    ) -> Result<Vec<u32>> {
        if let Some(host) = host.filter(|_| module.entry.shades()) {
            return Ok(host.shading.words(module)?.to_vec());
        }
        if let (Some(external), SearchCode::External) = (variant.technique.external, module.search)
            && module.entry.searches()
        {
            return external.words(module);
        }
        #[cfg(feature = "other-shaders")]
        if let Some(source) = &self.source
            && let Some(words) = source(module.entry.file(), &module.macros())?
        {
            return Ok(words);
        }
        let none = || Error::new(ErrorKind::Other, format!("no shader is {}", module.name()));
        words(module).ok_or_else(none)
    }

    /// The fragments of a pass: for its depth order, and with its attachments.
    fn fragments(&self, mut words: Vec<u32>, pass: &PassFormats) -> Vec<u32> {
        if pass.depth == DepthOrder::Reversed {
            words = depth_less(&words);
        }
        let planes = match &pass.planes {
            Planes::Color => &[Plane::Color],
            Planes::List(list) => list.planes(),
            Planes::All | Planes::Depth { .. } => return words,
        };
        let mut locations = [None; Plane::COUNT];
        for (plane, location) in planes.iter().zip(0..) {
            locations[plane.location() as usize] = Some(location);
        }
        with_locations(&words, &locations)
    }

    fn shader(&self, words: &[u32], constants: &HashMap<u32, u32>) -> Result<ShaderModule<'_>> {
        let words = frozen(words, constants);
        let words = match self.constants.indexes_textures {
            true => with_varying_textures(&words),
            false => with_constant_textures(&words),
        };
        let words = without_contraction(&words);
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are SPIR-V made by build.rs, or a search's or a shading's, or what the
        // host promised.
        let raw =
            unsafe { self.raw.create_shader_module(&info, None) }.call("vkCreateShaderModule")?;
        Ok(ShaderModule {
            raw,
            device: &self.raw,
        })
    }

    fn compute(
        &self,
        variant: &Variant,
        module: &Module,
        host: Option<&BoundShading>,
        constants: &HashMap<u32, u32>,
    ) -> Result<vk::Pipeline> {
        let words = self.words(variant, module, host)?;
        let module = self.shader(&words, constants)?;
        let info = vk::ComputePipelineCreateInfo::default()
            .flags(self.flags)
            .stage(module.stage(vk::ShaderStageFlags::COMPUTE))
            .layout(host.map_or(self.layout, |host| host.layout));
        let cache = self.cache.read().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `info` and all it points to live until the call returns.
        let made = unsafe { self.raw.create_compute_pipelines(*cache, &[info], None) };
        first(made, "vkCreateComputePipelines")
    }

    fn assembly(&self, kind: Kind) -> vk::PipelineInputAssemblyStateCreateInfo<'static> {
        let topology = match kind == Kind::Walk && self.constants.large_points {
            true => vk::PrimitiveTopology::POINT_LIST,
            false => vk::PrimitiveTopology::TRIANGLE_LIST,
        };
        vk::PipelineInputAssemblyStateCreateInfo::default().topology(topology)
    }

    fn graphics(
        &self,
        (variant, kind): (&Variant, Kind),
        pass: &PassFormats,
        modules: [&Module; 2],
        host: Option<&BoundShading>,
        constants: &HashMap<u32, u32>,
    ) -> Result<vk::Pipeline> {
        let [vertex, fragment] = modules;
        let fragments = self.words(variant, fragment, host)?;
        let vertices = with_outputs_for(&self.words(variant, vertex, None)?, &fragments);
        let vertex = self.shader(&vertices, constants)?;
        let fragment = self.shader(&self.fragments(fragments, pass), constants)?;
        let stages = [
            vertex.stage(vk::ShaderStageFlags::VERTEX),
            fragment.stage(vk::ShaderStageFlags::FRAGMENT),
        ];
        // Proxies, quads and tiles have no vertex input: shaders make their corners from numbers.
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let assembly = self.assembly(kind);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = rasterization(kind);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::from_raw(pass.samples))
            .sample_shading_enable(pass.sample_rays)
            .min_sample_shading(1.0);
        let depth = depth_state(pass);
        let written = vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        let blends = vec![written; pass.planes.attachments()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let mut rendering = vk::PipelineRenderingCreateInfo::default();
        let compatible;
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .flags(self.flags)
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(host.map_or(self.layout, |host| host.layout));
        match &pass.begun {
            PassKind::RenderPass { pass, subpass } => {
                info = info.render_pass(pass.raw()).subpass(*subpass);
            }
            PassKind::SingleSubpass { color, depth } => {
                compatible = CompatiblePass::new(&self.raw, color, *depth, pass.samples)?;
                info = info.render_pass(compatible.raw);
            }
            PassKind::Dynamic {
                color,
                depth,
                stencil,
            } => {
                rendering = rendering
                    .color_attachment_formats(color)
                    .depth_attachment_format(*depth)
                    .stencil_attachment_format(*stencil);
                info = info.push_next(&mut rendering);
            }
        }
        let cache = self.cache.read().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `info` and all it points to live until the call returns; a render pass lives as
        // the caller of HostPass::new promised.
        let made = unsafe { (self.raw).create_graphics_pipelines(*cache, &[info], None) };
        first(made, "vkCreateGraphicsPipelines")
    }
}

fn rasterization(kind: Kind) -> vk::PipelineRasterizationStateCreateInfo<'static> {
    vk::PipelineRasterizationStateCreateInfo::default()
        .cull_mode(match kind {
            // Points have no back.
            Kind::Walk => vk::CullModeFlags::NONE,
            _ => vk::CullModeFlags::BACK,
        })
        .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
        .line_width(1.0)
}

fn depth_state(pass: &PassFormats) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(pass.depth_test.write)
        .depth_compare_op(pass.depth_test.compare.unwrap_or(match pass.depth {
            DepthOrder::Normal => vk::CompareOp::LESS,
            DepthOrder::Reversed => vk::CompareOp::GREATER,
        }))
}

fn first(
    made: std::result::Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    name: &str,
) -> Result<vk::Pipeline> {
    made.map(|all| all.first().copied().unwrap_or_default())
        .map_err(|(_, code)| code)
        .call(name)
}

struct ShaderModule<'a> {
    raw: vk::ShaderModule,
    device: &'a ash::Device,
}

impl ShaderModule<'_> {
    fn stage(&self, stage: vk::ShaderStageFlags) -> vk::PipelineShaderStageCreateInfo<'static> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
    }
}

impl Drop for ShaderModule<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines do not need their module once they are made.
        unsafe { self.device.destroy_shader_module(self.raw, None) };
    }
}
