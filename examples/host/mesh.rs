//! Meshes, a floor and a sphere, and the pipeline that draws them in any pass.

use super::memory::HostBuffer;
use super::{DEPTH, Fallible, Host, Options};
use ash::vk;
use glam::{DMat4, Vec3, Vec4};

/// Triangles of the host's own.
pub struct Mesh<'a> {
    pub vertices: HostBuffer<'a>,
    pub count: u32,
    pub offset_scale: Vec4,
    pub color: Vec3,
}

impl<'a> Mesh<'a> {
    /// A square floor at `z`, of half side `half`.
    pub fn floor(host: &'a Host, half: f32, z: f32, color: Vec3) -> Fallible<Self> {
        let corner = |x: f32, y: f32| [[x, y, 0.0], [0.0, 0.0, 1.0]];
        let [a, c] = [corner(-1.0, -1.0), corner(1.0, 1.0)];
        let vertices = [a, corner(1.0, -1.0), c, a, c, corner(-1.0, 1.0)];
        Self::of(host, &vertices, Vec4::new(0.0, 0.0, z, half), color)
    }

    /// A sphere of `2 n` segments and `n` rings.
    pub fn sphere(
        host: &'a Host,
        n: u32,
        middle: Vec3,
        radius: f32,
        color: Vec3,
    ) -> Fallible<Self> {
        let point = |i: u32, j: u32| {
            let angle = |k: u32| (std::f32::consts::PI * k as f32 / n as f32).sin_cos();
            let ((ring, z), (y, x)) = (angle(j), angle(i));
            [[ring * x, ring * y, z]; 2]
        };
        let mut vertices = Vec::new();
        for j in 0..n {
            for i in 0..2 * n {
                let (a, c) = (point(i, j), point(i + 1, j + 1));
                vertices.extend([a, point(i, j + 1), c, a, c, point(i + 1, j)]);
            }
        }
        Self::of(host, &vertices, middle.extend(radius), color)
    }

    fn of(
        host: &'a Host,
        vertices: &[[[f32; 3]; 2]],
        offset_scale: Vec4,
        color: Vec3,
    ) -> Fallible<Self> {
        Ok(Self {
            count: vertices.len() as u32,
            vertices: HostBuffer::of(host, vertices, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            offset_scale,
            color,
        })
    }
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Pushed {
    clip_from_world: [[f32; 4]; 4],
    offset_scale: [f32; 4],
    color: [f32; 4],
    towards_light: [f32; 4],
}

/// The shaders of meshes, and the layouts of the sets that they read.
pub struct MeshShaders<'s> {
    pub vertex: &'s [u8],
    pub fragment: &'s [u8],
    pub sets: &'s [vk::DescriptorSetLayout],
}

impl Default for MeshShaders<'_> {
    /// One light.
    fn default() -> Self {
        Self {
            vertex: include_bytes!("mesh.vert.spv"),
            fragment: include_bytes!("mesh.frag.spv"),
            sets: &[],
        }
    }
}

/// A pipeline that draws meshes, and its layout.
pub struct MeshPipeline<'a> {
    raw: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    host: &'a Host,
}

impl<'a> MeshPipeline<'a> {
    /// A pipeline for a pass with colours of these formats and a depth; without a pass, for dynamic
    /// rendering. Without colours it has no fragment shader.
    pub fn new(
        host: &'a Host,
        shaders: &MeshShaders<'_>,
        options: &Options,
        pass: vk::RenderPass,
        colors: &[vk::Format],
    ) -> Fallible<Self> {
        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::VERTEX)
            .size(size_of::<Pushed>() as u32)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(shaders.sets)
            .push_constant_ranges(&push);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let layout = host.device.create_pipeline_layout(&info, None)?;
            let raw = make(host, layout, shaders, options, pass, colors)?;
            Ok(Self { raw, layout, host })
        }
    }

    /// Records draws of meshes.
    ///
    /// # Safety
    /// `cmd` is recording in the pipeline's pass, and the sets of its shaders are bound.
    pub unsafe fn draw(
        &self,
        cmd: vk::CommandBuffer,
        clip_from_world: DMat4,
        towards_light: Vec3,
        meshes: &[Mesh<'_>],
    ) {
        let device = &self.host.device;
        // SAFETY: as the caller promised.
        unsafe {
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, self.raw);
            for mesh in meshes {
                let pushed = Pushed {
                    clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
                    offset_scale: mesh.offset_scale.to_array(),
                    color: mesh.color.extend(1.0).to_array(),
                    towards_light: towards_light.normalize().extend(0.0).to_array(),
                };
                let bytes = bytemuck::bytes_of(&pushed);
                device.cmd_push_constants(cmd, self.layout, vk::ShaderStageFlags::VERTEX, 0, bytes);
                device.cmd_bind_vertex_buffers(cmd, 0, &[mesh.vertices.raw], &[0]);
                device.cmd_draw(cmd, mesh.count, 1, 0, 0);
            }
        }
    }
}

impl Drop for MeshPipeline<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the device is done with them.
        unsafe {
            device.destroy_pipeline(self.raw, None);
            device.destroy_pipeline_layout(self.layout, None);
        }
    }
}

/// A shader module of SPIR-V.
///
/// # Safety
/// The words are valid. The caller destroys the module.
pub unsafe fn module(host: &Host, bytes: &[u8]) -> Fallible<vk::ShaderModule> {
    let words = ash::util::read_spv(&mut std::io::Cursor::new(bytes))?;
    let info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: as the caller promised.
    Ok(unsafe { host.device.create_shader_module(&info, None) }?)
}

unsafe fn make(
    host: &Host,
    layout: vk::PipelineLayout,
    shaders: &MeshShaders<'_>,
    options: &Options,
    pass: vk::RenderPass,
    colors: &[vk::Format],
) -> Fallible<vk::Pipeline> {
    let device = &host.device;
    let stage = |stage, bytes| -> Fallible<_> {
        // SAFETY: the words are those of the shaders beside a host.
        let module = unsafe { module(host, bytes) }?;
        let info = vk::PipelineShaderStageCreateInfo::default().stage(stage);
        Ok(info.module(module).name(c"main"))
    };
    let stages = [
        stage(vk::ShaderStageFlags::VERTEX, shaders.vertex)?,
        stage(vk::ShaderStageFlags::FRAGMENT, shaders.fragment)?,
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
        .rasterization_samples(vk::SampleCountFlags::from_raw(options.samples));
    let nearer = match options.reversed {
        true => vk::CompareOp::GREATER,
        false => vk::CompareOp::LESS,
    };
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(nearer);
    let written = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(vk::ColorComponentFlags::RGBA);
    let blends = vec![written; colors.len()];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(colors)
        .depth_attachment_format(DEPTH);
    let mut info = vk::GraphicsPipelineCreateInfo::default()
        .stages(&stages[..1 + usize::from(!colors.is_empty())])
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .render_pass(pass);
    if options.dynamic {
        info = info.push_next(&mut rendering);
    }
    // SAFETY: plain creation; modules are not needed once the pipeline is made.
    unsafe {
        let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
        for stage in stages {
            device.destroy_shader_module(stage.module, None);
        }
        Ok(made.map_err(|(_, code)| code)?[0])
    }
}
