//! Pipelines, one per variant and use, made when first wanted and kept.

use super::call::Call;
use super::device::Shared;
use super::render_pass::{color_formats, render_pass};
use crate::error::Result;
use crate::mesh::Vertex;
use crate::settings::Planes;
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::shader::{Variant, generated as spirv};
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;

/// What a pipeline draws with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Kind {
    /// Shape boxes, rasterised.
    Box,
    /// Hulls of pieces, rasterised.
    Hull,
    /// Convex hulls, in which fragments search as in boxes.
    ConvexHull,
    /// Bins of pixels.
    Compute,
    /// Meshes, rasterised; `both_sides`: an eye may be inside.
    Mesh {
        /// Whether back faces show.
        both_sides: bool,
    },
}

/// Set layouts, the pipeline layout, the render pass of our own targets, and the pipelines made so far.
pub(crate) struct Pipelines {
    /// By frequency: 0 buffers of a frame, 1 textures of a batch, 2 the target of a compute pass.
    pub set_layouts: [vk::DescriptorSetLayout; 3],
    pub layout: vk::PipelineLayout,
    pub render_pass: vk::RenderPass,
    planes: Planes,
    cache: vk::PipelineCache,
    made: HashMap<(Variant, Kind), vk::Pipeline>,
    /// The list of tiles that a batch's rays may meet.
    beam: Option<vk::Pipeline>,
    device: Arc<Shared>,
}

impl Pipelines {
    pub fn new(device: &Arc<Shared>, planes: Planes) -> Result<Self> {
        let mut all = Self {
            set_layouts: [vk::DescriptorSetLayout::null(); 3],
            layout: vk::PipelineLayout::null(),
            render_pass: vk::RenderPass::null(),
            planes,
            cache: vk::PipelineCache::null(),
            made: HashMap::new(),
            beam: None,
            device: device.clone(),
        };
        let raw = &device.raw;
        use vk::DescriptorType as T;
        use vk::ShaderStageFlags as S;
        let every = S::VERTEX | S::FRAGMENT | S::COMPUTE;
        let pixel = S::FRAGMENT | S::COMPUTE;
        let sets: [&[(T, S)]; 3] = [
            &[
                (T::UNIFORM_BUFFER, every),
                (T::UNIFORM_BUFFER_DYNAMIC, every),
                (T::STORAGE_BUFFER, every),
                (T::UNIFORM_BUFFER, every),
                (T::STORAGE_BUFFER, every),
                (T::UNIFORM_BUFFER_DYNAMIC, pixel),
            ],
            &[(T::COMBINED_IMAGE_SAMPLER, pixel); 5],
            &[
                (T::STORAGE_BUFFER, pixel),
                (T::STORAGE_BUFFER, S::COMPUTE),
                (T::STORAGE_IMAGE, S::COMPUTE),
                (T::STORAGE_IMAGE, S::COMPUTE),
                (T::STORAGE_IMAGE, S::COMPUTE),
                (T::STORAGE_IMAGE, S::COMPUTE),
            ],
        ];
        for (set, (layout, bindings)) in all.set_layouts.iter_mut().zip(sets).enumerate() {
            let bindings: Vec<_> = (0u32..)
                .zip(bindings)
                .map(|(binding, (kind, stages))| {
                    let shadow_maps = set == 1 && binding == 4;
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(binding)
                        .descriptor_type(*kind)
                        .descriptor_count(if shadow_maps { MAX_SHADOW_MAPS } else { 1 })
                        .stage_flags(*stages)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: a plain creation, destroyed in Drop.
            *layout = unsafe { raw.create_descriptor_set_layout(&info, None) }
                .call("vkCreateDescriptorSetLayout")?;
        }
        let pushed = [vk::PushConstantRange::default()
            .stage_flags(S::COMPUTE)
            .size(8)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&all.set_layouts)
            .push_constant_ranges(&pushed);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            all.layout = raw
                .create_pipeline_layout(&info, None)
                .call("vkCreatePipelineLayout")?;
            all.cache = raw
                .create_pipeline_cache(&vk::PipelineCacheCreateInfo::default(), None)
                .call("vkCreatePipelineCache")?;
        }
        all.render_pass = render_pass(device, planes)?;
        Ok(all)
    }

    /// The pipeline of `variant` and `kind`, made now if it is new.
    pub fn get(&mut self, variant: Variant, kind: Kind) -> Result<vk::Pipeline> {
        let key = (variant, kind);
        if let Some(made) = self.made.get(&key) {
            return Ok(*made);
        }
        let entries: Vec<_> = variant
            .constants()
            .iter()
            .zip(0u32..)
            .map(|((id, _), n)| {
                vk::SpecializationMapEntry::default()
                    .constant_id(*id)
                    .offset(4 * n)
                    .size(4)
            })
            .collect();
        let values: Vec<u32> = variant
            .constants()
            .iter()
            .map(|(_, value)| *value)
            .collect();
        let specialization = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let pipeline = match kind {
            Kind::Compute => {
                let words = match self.planes {
                    Planes::Color => spirv::TRACE_COLOR_COMP,
                    Planes::All => spirv::TRACE_PLANES_COMP,
                };
                self.compute(words, &specialization)?
            }
            Kind::Box | Kind::Hull | Kind::ConvexHull | Kind::Mesh { .. } => {
                self.graphics(kind, &specialization)?
            }
        };
        self.made.insert(key, pipeline);
        Ok(pipeline)
    }

    /// The pipeline that lists tiles: one, as it reads none of a variant's constants.
    pub fn beam(&mut self) -> Result<vk::Pipeline> {
        if let Some(made) = self.beam {
            return Ok(made);
        }
        let made = self.compute(spirv::BEAM_COMP, &vk::SpecializationInfo::default())?;
        self.beam = Some(made);
        Ok(made)
    }

    fn module(&self, words: &[u32]) -> Result<Module<'_>> {
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: the words are SPIR-V made by build.rs.
        let raw = unsafe { self.device.raw.create_shader_module(&info, None) }
            .call("vkCreateShaderModule")?;
        Ok(Module {
            raw,
            device: &self.device,
        })
    }

    fn compute(
        &self,
        words: &[u32],
        specialization: &vk::SpecializationInfo<'_>,
    ) -> Result<vk::Pipeline> {
        let module = self.module(words)?;
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(module.stage(vk::ShaderStageFlags::COMPUTE, specialization))
            .layout(self.layout);
        // SAFETY: `info` and all it points to live until the call returns.
        let made = unsafe {
            self.device
                .raw
                .create_compute_pipelines(self.cache, &[info], None)
        };
        first(made, "vkCreateComputePipelines")
    }

    fn graphics(
        &self,
        kind: Kind,
        specialization: &vk::SpecializationInfo<'_>,
    ) -> Result<vk::Pipeline> {
        let mesh = matches!(kind, Kind::Mesh { .. });
        let (vertex, color, planes) = match kind {
            Kind::Mesh { .. } => (
                spirv::MESH_VERT,
                spirv::MESH_COLOR_FRAG,
                spirv::MESH_PLANES_FRAG,
            ),
            Kind::Hull => (
                spirv::HULL_VERT,
                spirv::HULL_COLOR_FRAG,
                spirv::HULL_PLANES_FRAG,
            ),
            Kind::ConvexHull => (
                spirv::CONVEX_HULL_VERT,
                spirv::SHAPE_BOX_COLOR_FRAG,
                spirv::SHAPE_BOX_PLANES_FRAG,
            ),
            _ => (
                spirv::SHAPE_BOX_VERT,
                spirv::SHAPE_BOX_COLOR_FRAG,
                spirv::SHAPE_BOX_PLANES_FRAG,
            ),
        };
        let vertex = self.module(vertex)?;
        let fragment = self.module(match self.planes {
            Planes::Color => color,
            Planes::All => planes,
        })?;
        let stages = [
            vertex.stage(vk::ShaderStageFlags::VERTEX, specialization),
            fragment.stage(vk::ShaderStageFlags::FRAGMENT, specialization),
        ];
        // Boxes and hulls have no vertices: their corners are made from numbers.
        let binding = [vk::VertexInputBindingDescription::default()
            .stride(const { size_of::<Vertex>() as u32 })];
        let attribute = |location, format, offset| {
            vk::VertexInputAttributeDescription::default()
                .location(location)
                .format(format)
                .offset(offset)
        };
        let attributes = [
            attribute(
                0,
                vk::Format::R32G32B32_SFLOAT,
                const { std::mem::offset_of!(Vertex, position) as u32 },
            ),
            attribute(
                1,
                vk::Format::R16G16_SNORM,
                const { std::mem::offset_of!(Vertex, normal) as u32 },
            ),
        ];
        let mut vertices = vk::PipelineVertexInputStateCreateInfo::default();
        if mesh {
            vertices = vertices
                .vertex_binding_descriptions(&binding)
                .vertex_attribute_descriptions(&attributes);
        }
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(if kind != Kind::Box {
                vk::PrimitiveTopology::TRIANGLE_LIST
            } else {
                vk::PrimitiveTopology::TRIANGLE_STRIP
            });
        let culled = if kind == (Kind::Mesh { both_sides: true }) {
            vk::CullModeFlags::NONE
        } else {
            vk::CullModeFlags::BACK
        };
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(culled)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::LESS);
        let blends = vec![
            vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA);
            color_formats(self.planes).len()
        ];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout)
            .render_pass(self.render_pass);
        // SAFETY: `info` and all it points to live until the call returns.
        let made = unsafe {
            self.device
                .raw
                .create_graphics_pipelines(self.cache, &[info], None)
        };
        first(made, "vkCreateGraphicsPipelines")
    }
}

impl Drop for Pipelines {
    fn drop(&mut self) {
        let raw = &self.device.raw;
        // SAFETY: every submission was waited for; null handles may be destroyed.
        unsafe {
            for pipeline in self.made.values().chain(&self.beam) {
                raw.destroy_pipeline(*pipeline, None);
            }
            raw.destroy_pipeline_cache(self.cache, None);
            raw.destroy_render_pass(self.render_pass, None);
            raw.destroy_pipeline_layout(self.layout, None);
            for layout in self.set_layouts {
                raw.destroy_descriptor_set_layout(layout, None);
            }
        }
    }
}

fn first(
    made: std::result::Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    name: &str,
) -> Result<vk::Pipeline> {
    made.map(|all| all.first().copied().unwrap_or_default())
        .map_err(|(_, code)| code)
        .call(name)
}

struct Module<'a> {
    raw: vk::ShaderModule,
    device: &'a Shared,
}

impl Module<'_> {
    fn stage<'i>(
        &self,
        stage: vk::ShaderStageFlags,
        specialization: &'i vk::SpecializationInfo<'i>,
    ) -> vk::PipelineShaderStageCreateInfo<'i> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
            .specialization_info(specialization)
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines made of a module do not need it afterwards.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}
