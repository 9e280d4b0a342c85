//! Pipelines of the mesh baseline: one per variant, made when first wanted and kept.

use super::super::blocks::ObjectBlock;
use super::super::tessellation::Vertex;
use super::PassKind;
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Device, vulkan_error as vulkan};
use revmap::maps::Projection;
use revmap::search::unpacked;
use revmap::settings::Planes;
use std::collections::HashMap;
use std::mem::offset_of;
use std::sync::{Arc, Mutex};

/// The packed shaders and hashes, from `build.rs`.
#[allow(clippy::unreadable_literal, dead_code)]
pub(in super::super) mod generated {
    include!(concat!(env!("OUT_DIR"), "/mesh.rs"));
}

/// The words of shader `n` of `build.rs`.
pub(in super::super) fn shader(n: usize) -> Option<Vec<u32>> {
    unpacked(generated::MODULES.get(n)?)
}

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in super::super) struct PipelineKey {
    pub pass: PassKind,
    pub lights: u32,
    /// Whether the object is one instance, which its block holds.
    pub single: bool,
    pub projection: Projection,
    /// Whether backs of triangles are drawn.
    pub both_sides: bool,
}

/// The pipelines of one device, shared by all its mesh drawers.
pub struct MeshPipelines {
    pub(super) set_layout: vk::DescriptorSetLayout,
    pub(super) layout: vk::PipelineLayout,
    /// The shaders of `build.rs`: vertices, pixels of colour alone, pixels of all planes.
    modules: [vk::ShaderModule; 3],
    made: Mutex<HashMap<PipelineKey, vk::Pipeline>>,
    device: Device,
}

impl MeshPipelines {
    /// Pipelines on this device; none is compiled yet.
    pub fn new(device: &Device) -> Result<Arc<Self>> {
        let mut all = Self {
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            modules: [vk::ShaderModule::null(); 3],
            made: Mutex::default(),
            device: device.clone(),
        };
        let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let binding = |binding, kind| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(stages)
        };
        let bindings = [
            binding(0, vk::DescriptorType::UNIFORM_BUFFER),
            binding(1, vk::DescriptorType::STORAGE_BUFFER),
        ];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: a plain creation, destroyed in Drop.
        all.set_layout = unsafe { device.raw().create_descriptor_set_layout(&info, None) }
            .map_err(|code| vulkan("vkCreateDescriptorSetLayout", code))?;
        let set_layouts = [all.set_layout];
        let pushed = [vk::PushConstantRange::default()
            .stage_flags(stages)
            .size(const { size_of::<ObjectBlock>() as u32 })];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&set_layouts)
            .push_constant_ranges(&pushed);
        // SAFETY: as above.
        all.layout = unsafe { device.raw().create_pipeline_layout(&info, None) }
            .map_err(|code| vulkan("vkCreatePipelineLayout", code))?;
        for (n, module) in all.modules.iter_mut().enumerate() {
            let broken = || Error::new(ErrorKind::Other, "the mesh shaders are broken");
            let words = shader(n).ok_or_else(broken)?;
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            // SAFETY: the words are SPIR-V made by build.rs.
            *module = unsafe { device.raw().create_shader_module(&info, None) }
                .map_err(|code| vulkan("vkCreateShaderModule", code))?;
        }
        Ok(Arc::new(all))
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The pipeline of a key, compiled now for `pass` if it is new.
    pub(super) fn get(&self, key: PipelineKey, pass: vk::RenderPass) -> Result<vk::Pipeline> {
        let gone = |_| Error::new(ErrorKind::Other, "the mesh pipelines' lock is poisoned");
        let mut made = self.made.lock().map_err(gone)?;
        if let Some(pipeline) = made.get(&key) {
            return Ok(*pipeline);
        }
        let pipeline = self.make(key, pass)?;
        made.insert(key, pipeline);
        Ok(pipeline)
    }

    fn make(&self, key: PipelineKey, pass: vk::RenderPass) -> Result<vk::Pipeline> {
        let entry = |id: u32| {
            vk::SpecializationMapEntry::default()
                .constant_id(id)
                .offset(4 * id)
                .size(4)
        };
        let entries = [entry(0), entry(1), entry(2)];
        let projection = match key.projection {
            Projection::Planar => 0,
            Projection::Spherical => 2,
            Projection::Cylindrical | Projection::Arc => 1,
        };
        let values = [key.lights, u32::from(key.single), projection];
        let constants = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let (fragment, attachments) = match key.pass.planes {
            Planes::All => (2, 4),
            // An off-screen frame has at least colour.
            Planes::Color | Planes::Depth { .. } | Planes::List(_) => (1, 1),
        };
        let stage = |stage, module: usize| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage)
                .module(self.modules[module])
                .name(c"main")
                .specialization_info(&constants)
        };
        let stages = [
            stage(vk::ShaderStageFlags::VERTEX, 0),
            stage(vk::ShaderStageFlags::FRAGMENT, fragment),
        ];
        self.compile((key, pass), &stages, attachments)
    }

    fn compile(
        &self,
        (key, pass): (PipelineKey, vk::RenderPass),
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        attachments: usize,
    ) -> Result<vk::Pipeline> {
        let bindings = [vk::VertexInputBindingDescription::default()
            .stride(const { size_of::<Vertex>() as u32 })];
        let attribute = |location, format, offset| {
            vk::VertexInputAttributeDescription::default()
                .location(location)
                .format(format)
                .offset(offset)
        };
        let position = const { offset_of!(Vertex, position) as u32 };
        let normal = const { offset_of!(Vertex, normal) as u32 };
        let attributes = [
            attribute(0, vk::Format::R32G32B32_SFLOAT, position),
            attribute(1, vk::Format::R16G16_SNORM, normal),
        ];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(if key.both_sides {
                vk::CullModeFlags::NONE
            } else {
                vk::CullModeFlags::BACK
            })
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(key.pass.samples);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(true)
            .depth_write_enable(true)
            .depth_compare_op(vk::CompareOp::LESS);
        let written = vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        let blends = vec![written; attachments];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout)
            .render_pass(pass);
        let none = vk::PipelineCache::null();
        // SAFETY: what `info` points to lives until the call returns, and so does the pass.
        let made = unsafe { (self.device.raw()).create_graphics_pipelines(none, &[info], None) };
        made.map(|all| all.first().copied().unwrap_or_default())
            .map_err(|(_, code)| vulkan("vkCreateGraphicsPipelines", code))
    }
}

impl Drop for MeshPipelines {
    fn drop(&mut self) {
        let raw = self.device.raw();
        let made = self.made.get_mut().map(std::mem::take).unwrap_or_default();
        // SAFETY: all that draws holds `self` and waits for its frames; null handles are allowed.
        unsafe {
            for pipeline in made.values() {
                raw.destroy_pipeline(*pipeline, None);
            }
            for module in self.modules {
                raw.destroy_shader_module(module, None);
            }
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}
