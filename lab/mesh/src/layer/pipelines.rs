//! Pipelines of the mesh baseline: one per variant, made when first wanted and kept.

use super::super::blocks::ObjectBlock;
use super::super::tessellation::Vertex;
use super::PassKind;
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Device, vulkan_error as vulkan};
use revmap::maps::Projection;
use revmap::scene::Shadow;
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

/// The stages that read what is pushed.
pub(super) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);
/// Number of shaders.
const MODULES: usize = 6;
/// The vertex shader of shadow maps among them.
const CASTER: usize = 5;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in super::super) struct PipelineKey {
    pub pass: PassKind,
    pub lights: u32,
    /// Whether the object is one instance, which its block holds.
    pub single: bool,
    pub projection: Projection,
    /// Whether backs of triangles are drawn.
    pub both_sides: bool,
    pub shadow: Shadow,
    pub environment: bool,
}

/// The pipelines of one device, shared by all its mesh drawers.
pub struct MeshPipelines {
    pub(super) set_layout: vk::DescriptorSetLayout,
    pub(super) layout: vk::PipelineLayout,
    /// The pass, pipeline and sets of shadow maps.
    pub(super) shadow_pass: vk::RenderPass,
    pub(super) caster: vk::Pipeline,
    pub(super) shadow_layout: vk::DescriptorSetLayout,
    /// One that compares, and one that reads depths.
    pub(super) samplers: [vk::Sampler; 2],
    /// The shaders of `build.rs`, in its order.
    modules: [vk::ShaderModule; MODULES],
    made: Mutex<HashMap<PipelineKey, vk::Pipeline>>,
    device: Device,
}

impl MeshPipelines {
    /// Pipelines on this device; none is compiled yet.
    pub fn new(device: &Device) -> Result<Arc<Self>> {
        let mut all = Self {
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            shadow_pass: vk::RenderPass::null(),
            caster: vk::Pipeline::null(),
            shadow_layout: vk::DescriptorSetLayout::null(),
            samplers: [vk::Sampler::null(); 2],
            modules: [vk::ShaderModule::null(); MODULES],
            made: Mutex::default(),
            device: device.clone(),
        };
        let [uniform, storage, sampled] = [
            vk::DescriptorType::UNIFORM_BUFFER,
            vk::DescriptorType::STORAGE_BUFFER,
            vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        ];
        all.set_layout = set_layout(device, STAGES, &[uniform, storage])?;
        let fragment = vk::ShaderStageFlags::FRAGMENT;
        all.shadow_layout = set_layout(device, fragment, &[uniform, sampled, sampled])?;
        all.layout = layout(device, &[all.set_layout, all.shadow_layout])?;
        for (n, module) in all.modules.iter_mut().enumerate() {
            let broken = || Error::new(ErrorKind::Other, "the mesh shaders are broken");
            let words = shader(n).ok_or_else(broken)?;
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            // SAFETY: the words are SPIR-V made by build.rs.
            *module = unsafe { device.raw().create_shader_module(&info, None) }
                .map_err(|code| vulkan("vkCreateShaderModule", code))?;
        }
        all.make_shadows()?;
        Ok(Arc::new(all))
    }

    /// Makes what shadow maps are drawn and read with.
    fn make_shadows(&mut self) -> Result<()> {
        let raw = self.device.raw();
        self.shadow_pass = shadow_pass(&self.device)?;
        for (n, sampler) in self.samplers.iter_mut().enumerate() {
            let filter = [vk::Filter::LINEAR, vk::Filter::NEAREST][n];
            let info = vk::SamplerCreateInfo::default()
                .mag_filter(filter)
                .min_filter(filter)
                .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
                .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
                .compare_enable(n == 0)
                .compare_op(vk::CompareOp::LESS_OR_EQUAL);
            // SAFETY: a plain creation, destroyed in Drop.
            *sampler = unsafe { raw.create_sampler(&info, None) }
                .map_err(|code| vulkan("vkCreateSampler", code))?;
        }
        let stages = [vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::VERTEX)
            .module(self.modules[CASTER])
            .name(c"main")];
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .cull_mode(vk::CullModeFlags::BACK)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .depth_bias_enable(true)
            .depth_bias_slope_factor(1.0)
            .line_width(1.0);
        let one = vk::SampleCountFlags::TYPE_1;
        self.caster = self.compile((self.shadow_pass, one), &stages, &raster, (0, false))?;
        Ok(())
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
        let entries = [0, 1, 2, 3, 4].map(entry);
        let projection = match key.projection {
            Projection::Planar => 0,
            Projection::Spherical => 2,
            Projection::Cylindrical | Projection::Arc => 1,
        };
        let soft = u32::from(key.shadow == Shadow::Soft);
        let [single, environment] = [key.single, key.environment].map(u32::from);
        let values = [key.lights, single, projection, soft, environment];
        let constants = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let (fragment, attachments) = match key.pass.planes {
            Planes::All => (2, 4),
            // An off-screen frame has at least colour.
            Planes::Color | Planes::Depth { .. } | Planes::List(_) => (1, 1),
        };
        let fragment = fragment + if key.shadow == Shadow::Off { 0 } else { 2 };
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
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(if key.both_sides {
                vk::CullModeFlags::NONE
            } else {
                vk::CullModeFlags::BACK
            })
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let of = (pass, key.pass.samples);
        self.compile(of, &stages, &raster, (attachments, true))
    }

    fn compile(
        &self,
        (pass, samples): (vk::RenderPass, vk::SampleCountFlags),
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        raster: &vk::PipelineRasterizationStateCreateInfo<'_>,
        (attachments, normals): (usize, bool),
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
            .vertex_attribute_descriptions(&attributes[..1 + usize::from(normals)]);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default()
            .viewport_count(1)
            .scissor_count(1);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(samples);
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
            .rasterization_state(raster)
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
            for pipeline in made.values().chain([&self.caster]) {
                raw.destroy_pipeline(*pipeline, None);
            }
            for sampler in self.samplers {
                raw.destroy_sampler(sampler, None);
            }
            for module in self.modules {
                raw.destroy_shader_module(module, None);
            }
            raw.destroy_render_pass(self.shadow_pass, None);
            raw.destroy_pipeline_layout(self.layout, None);
            for layout in [self.set_layout, self.shadow_layout] {
                raw.destroy_descriptor_set_layout(layout, None);
            }
        }
    }
}

/// A layout of one descriptor of each kind.
fn set_layout(
    device: &Device,
    stages: vk::ShaderStageFlags,
    kinds: &[vk::DescriptorType],
) -> Result<vk::DescriptorSetLayout> {
    let binding = |(binding, kind): (u32, &vk::DescriptorType)| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(binding)
            .descriptor_type(*kind)
            .descriptor_count(1)
            .stage_flags(stages)
    };
    let bindings: Vec<_> = (0..).zip(kinds).map(binding).collect();
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: a plain creation, destroyed in Drop.
    unsafe { device.raw().create_descriptor_set_layout(&info, None) }
        .map_err(|code| vulkan("vkCreateDescriptorSetLayout", code))
}

/// The layout of all pipelines: those of shadow maps push a smaller block, and read one set.
fn layout(device: &Device, sets: &[vk::DescriptorSetLayout]) -> Result<vk::PipelineLayout> {
    let pushed = [vk::PushConstantRange::default()
        .stage_flags(STAGES)
        .size(const { size_of::<ObjectBlock>() as u32 })];
    let info = vk::PipelineLayoutCreateInfo::default()
        .set_layouts(sets)
        .push_constant_ranges(&pushed);
    // SAFETY: a plain creation, destroyed in Drop.
    unsafe { device.raw().create_pipeline_layout(&info, None) }
        .map_err(|code| vulkan("vkCreatePipelineLayout", code))
}

/// The pass of shadow maps: fragments read them afterwards, and may have before.
fn shadow_pass(device: &Device) -> Result<vk::RenderPass> {
    let attachments = [vk::AttachmentDescription::default()
        .format(vk::Format::D32_SFLOAT)
        .samples(vk::SampleCountFlags::TYPE_1)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)
        .final_layout(vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL)];
    let depth = vk::AttachmentReference::default()
        .layout(vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .depth_stencil_attachment(&depth)];
    let tests =
        vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS;
    let fragments = vk::PipelineStageFlags::FRAGMENT_SHADER;
    let written = vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let both = written | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ;
    let dependencies = [
        vk::SubpassDependency::default()
            .src_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(fragments | tests)
            .src_access_mask(written)
            .dst_stage_mask(tests)
            .dst_access_mask(both),
        vk::SubpassDependency::default()
            .dst_subpass(vk::SUBPASS_EXTERNAL)
            .src_stage_mask(tests)
            .src_access_mask(written)
            .dst_stage_mask(fragments)
            .dst_access_mask(vk::AccessFlags::SHADER_READ),
    ];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: a plain creation, destroyed in Drop.
    unsafe { device.raw().create_render_pass(&info, None) }
        .map_err(|code| vulkan("vkCreateRenderPass", code))
}
