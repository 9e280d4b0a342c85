//! Pipelines of the mesh baseline: one per variant, made when first wanted and kept.

use super::super::blocks::ObjectBlock;
use super::super::tessellation::Vertex;
use super::multisampled;
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Device, vulkan_error as vulkan};
use revmap::maps::Projection;
use revmap::settings::Planes;
use std::collections::HashMap;
use std::mem::offset_of;
use std::sync::{Arc, Mutex};

/// SPIR-V of `shaders/`; a test compares it with the sources.
const VERTEX: &[u8] = include_bytes!("../../../shaders/spirv/mesh.vert.spv");
const COLOR: &[u8] = include_bytes!("../../../shaders/spirv/mesh_color.frag.spv");
const PLANES: &[u8] = include_bytes!("../../../shaders/spirv/mesh_planes.frag.spv");

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in super::super) struct PipelineKey {
    pub pass: vk::RenderPass,
    pub samples: vk::SampleCountFlags,
    pub planes: Planes,
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
    made: Mutex<HashMap<PipelineKey, vk::Pipeline>>,
    /// Multisampled passes, by the format of their colours.
    passes: Mutex<HashMap<vk::Format, vk::RenderPass>>,
    device: Device,
}

impl MeshPipelines {
    /// Pipelines on this device; none is compiled yet.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn new(device: &Device) -> Result<Arc<Self>> {
        let mut all = Self {
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            made: Mutex::default(),
            passes: Mutex::default(),
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
        Ok(Arc::new(all))
    }

    /// The device.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The pipeline of a key, compiled now if it is new.
    pub(super) fn get(&self, key: PipelineKey) -> Result<vk::Pipeline> {
        let mut made = self.made.lock().map_err(|_| gone())?;
        if let Some(pipeline) = made.get(&key) {
            return Ok(*pipeline);
        }
        let pipeline = self.make(key)?;
        made.insert(key, pipeline);
        Ok(pipeline)
    }

    /// The pass of four samples for colours in a format.
    pub(super) fn multisampled_pass(&self, format: vk::Format) -> Result<vk::RenderPass> {
        let mut passes = self.passes.lock().map_err(|_| gone())?;
        if let Some(pass) = passes.get(&format) {
            return Ok(*pass);
        }
        let pass = multisampled::pass(&self.device, format)?;
        passes.insert(format, pass);
        Ok(pass)
    }

    fn make(&self, key: PipelineKey) -> Result<vk::Pipeline> {
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
        let (fragment, attachments) = match key.planes {
            Planes::All => (PLANES, 4),
            // An off-screen frame has at least colour.
            Planes::Color | Planes::Depth { .. } => (COLOR, 1),
        };
        let (vertex, fragment) = (self.module(VERTEX)?, self.module(fragment)?);
        let stages = [
            vertex.stage(vk::ShaderStageFlags::VERTEX, &constants),
            fragment.stage(vk::ShaderStageFlags::FRAGMENT, &constants),
        ];
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
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(key.samples);
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
            .render_pass(key.pass);
        let none = vk::PipelineCache::null();
        // SAFETY: `info` and all it points to live until the call returns; the pass lives as long
        // as the device, which `self` holds.
        let made = unsafe { (self.device.raw()).create_graphics_pipelines(none, &[info], None) };
        made.map(|all| all.first().copied().unwrap_or_default())
            .map_err(|(_, code)| vulkan("vkCreateGraphicsPipelines", code))
    }

    fn module(&self, spirv: &[u8]) -> Result<Module<'_>> {
        let broken = |e| {
            Error::new(
                ErrorKind::Other,
                format!("the mesh shaders are broken: {e}"),
            )
        };
        let words = ash::util::read_spv(&mut std::io::Cursor::new(spirv)).map_err(broken)?;
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: the words are SPIR-V that the repository keeps.
        let raw = unsafe { self.device.raw().create_shader_module(&info, None) }
            .map_err(|code| vulkan("vkCreateShaderModule", code))?;
        Ok(Module {
            raw,
            device: &self.device,
        })
    }
}

impl Drop for MeshPipelines {
    fn drop(&mut self) {
        let raw = self.device.raw();
        let made = self.made.get_mut().map(std::mem::take).unwrap_or_default();
        let passes = (self.passes.get_mut()).map_or_else(|_| HashMap::new(), std::mem::take);
        // SAFETY: all that draws with them holds `self` and waits for its frames; null handles may
        // be destroyed.
        unsafe {
            for pipeline in made.values() {
                raw.destroy_pipeline(*pipeline, None);
            }
            for pass in passes.values() {
                raw.destroy_render_pass(*pass, None);
            }
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

fn gone() -> Error {
    Error::new(
        ErrorKind::Other,
        "the mesh pipelines are gone after a panic",
    )
}

struct Module<'a> {
    raw: vk::ShaderModule,
    device: &'a Device,
}

impl Module<'_> {
    fn stage<'i>(
        &self,
        stage: vk::ShaderStageFlags,
        constants: &'i vk::SpecializationInfo<'i>,
    ) -> vk::PipelineShaderStageCreateInfo<'i> {
        vk::PipelineShaderStageCreateInfo::default()
            .stage(stage)
            .module(self.raw)
            .name(c"main")
            .specialization_info(constants)
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines made of a module do not need it afterwards.
        unsafe { self.device.raw().destroy_shader_module(self.raw, None) };
    }
}
