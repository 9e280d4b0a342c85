//! The host's passes: meshes and solids into the G-buffer, light, temporal anti-aliasing.

use super::host::memory::{HostBuffer, HostImage, barrier};
use super::host::set::UniformSet;
use super::host::{
    Attachments, Fallible, Host, Mesh, MeshPipeline, MeshShaders, Options, commands, module,
};
use ash::vk;
use glam::{DMat4, Mat4, Vec2, Vec3, Vec4};
use revmap::gpu::{Renderer, View};
use revmap::settings::Plane;

/// The planes of the G-buffer, and their formats.
pub const PLANES: [(Plane, vk::Format); 5] = [
    (Plane::BaseColor, vk::Format::R8G8B8A8_SRGB),
    (Plane::OctahedralNormal, vk::Format::R16G16_SFLOAT),
    (Plane::Material, vk::Format::R8G8_UNORM),
    (Plane::Motion, vk::Format::R16G16_SFLOAT),
    (Plane::Identity, vk::Format::R32G32_UINT),
];
const PICTURE: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
type Layout = vk::ImageLayout;

/// Inputs of light.comp.
pub struct Lights {
    pub world_from_clip: Mat4,
    pub eye: Vec3,
    pub towards_sun: Vec3,
}

/// How a frame is blended with the last picture.
#[derive(Clone, Copy)]
pub struct Blend {
    pub weight: f32,
    /// True to follow motion.
    pub follows: bool,
    /// True to keep the range of the neighbours.
    pub clips: bool,
}

impl Blend {
    /// Of a frame without one before.
    pub const FIRST: Self = Self {
        weight: 1.0,
        follows: false,
        clips: false,
    };
}

/// Inputs of resolve.comp.
pub struct Resolve {
    pub last_from_clip: Mat4,
    pub jitter: Vec2,
    pub blend: Blend,
}

/// Push constants of the compute shaders.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Pushed {
    matrix: [[f32; 4]; 4],
    first: [f32; 4],
    second: [f32; 4],
}

pub struct Passes<'a> {
    options: Options,
    /// The G-buffer and its depth.
    drawn: Attachments<'a>,
    lit: HostImage<'a>,
    /// The last picture and this one, in turn.
    pictures: [HostImage<'a>; 2],
    read: HostBuffer<'a>,
    /// One for each order of the pictures.
    sets: [UniformSet<'a>; 2],
    sampler: vk::Sampler,
    layout: vk::PipelineLayout,
    mesh: MeshPipeline<'a>,
    light: vk::Pipeline,
    resolve: vk::Pipeline,
    frames: usize,
    host: &'a Host,
}

impl<'a> Passes<'a> {
    pub fn new(host: &'a Host, options: Options) -> Fallible<Self> {
        use vk::ImageUsageFlags as U;
        let stored = || HostImage::new(host, &options, PICTURE, 1, U::STORAGE);
        let formats = PLANES.map(|(_, format)| format);
        let bytes = 16 * (options.width * options.height) as usize;
        let null = vk::Pipeline::null();
        let shaders = MeshShaders {
            vertex: include_bytes!("mesh.vert.spv"),
            fragment: include_bytes!("mesh.frag.spv"),
            sets: &[],
        };
        let drawn = Attachments::new(host, options, &formats)?;
        let (lit, pictures) = (stored()?, [stored()?, stored()?]);
        let raw = &host.device;
        // SAFETY: a plain creation, destroyed in Drop.
        let sampler = unsafe { raw.create_sampler(&vk::SamplerCreateInfo::default(), None) }?;
        let set = |turn: usize| {
            use vk::DescriptorType as T;
            let of = |kind, image: &HostImage, layout| {
                let named = vk::DescriptorImageInfo::default().image_view(image.view);
                (kind, named.sampler(sampler).image_layout(layout))
            };
            let sampled = Layout::SHADER_READ_ONLY_OPTIMAL;
            let read = |image| of(T::COMBINED_IMAGE_SAMPLER, image, sampled);
            let written = [&lit, &pictures[turn], &pictures[1 - turn]];
            let written = written.map(|image| of(T::STORAGE_IMAGE, image, Layout::GENERAL));
            let images: Vec<_> = drawn.images().map(read).chain(written).collect();
            UniformSet::new(host, None, &images)
        };
        let sets = [set(0)?, set(1)?];
        let (layouts, stages) = ([sets[0].layout], vk::ShaderStageFlags::COMPUTE);
        let pushed = [vk::PushConstantRange::default()
            .stage_flags(stages)
            .size(size_of::<Pushed>() as u32)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&layouts)
            .push_constant_ranges(&pushed);
        let mut passes = Self {
            drawn,
            lit,
            pictures,
            read: HostBuffer::new(host, bytes, vk::BufferUsageFlags::TRANSFER_DST)?,
            options,
            sets,
            sampler,
            // SAFETY: as above.
            layout: unsafe { raw.create_pipeline_layout(&info, None) }?,
            mesh: MeshPipeline::new(host, &shaders, &options, vk::RenderPass::null(), &formats)?,
            light: null,
            resolve: null,
            frames: 0,
            host,
        };
        // SAFETY: as above.
        unsafe {
            passes.light = passes.compute(include_bytes!("light.comp.spv"))?;
            passes.resolve = passes.compute(include_bytes!("resolve.comp.spv"))?;
        }
        Ok(passes)
    }

    unsafe fn compute(&self, bytes: &[u8]) -> Fallible<vk::Pipeline> {
        let raw = &self.host.device;
        // SAFETY: plain creations; the module is not needed once the pipeline is made.
        unsafe {
            let module = module(self.host, bytes)?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main");
            let info = [vk::ComputePipelineCreateInfo::default()
                .stage(stage)
                .layout(self.layout)];
            let made = raw.create_compute_pipelines(vk::PipelineCache::null(), &info, None);
            raw.destroy_shader_module(module, None);
            Ok(made.map_err(|(_, code)| code)?[0])
        }
    }

    /// Draws a frame and waits for it: meshes, and what a renderer for the G-buffer sees.
    pub fn frame(
        &mut self,
        clip_from_world: DMat4,
        meshes: &[Mesh<'_>],
        (renderer, view): (&mut Renderer, &View),
        lights: &Lights,
        resolve: &Resolve,
    ) -> Fallible<()> {
        let (raw, turn) = (&self.host.device, self.frames % 2);
        self.frames += 1;
        let blend = resolve.blend;
        let number = |yes: bool| f32::from(u8::from(yes));
        let lit = Pushed {
            matrix: lights.world_from_clip.to_cols_array_2d(),
            first: lights.eye.extend(1.0).to_array(),
            second: lights.towards_sun.extend(0.0).to_array(),
        };
        let [x, y] = resolve.jitter.to_array();
        let blended = Pushed {
            matrix: resolve.last_from_clip.to_cols_array_2d(),
            first: [x, y, blend.weight, number(blend.follows)],
            second: [number(blend.clips), 0.0, 0.0, 0.0],
        };
        // SAFETY: the last frame was waited for; everything named lives as long as `self`; the
        // G-buffer has the formats of the renderer.
        commands(self.host, true, |cmd| unsafe {
            let prepared = renderer.prepare(cmd, 0, view)?;
            self.drawn.draw(cmd, &self.drawn.clears(), false, || {
                self.mesh.draw(cmd, clip_from_world, Vec3::Z, meshes);
                renderer.record(cmd, &prepared)
            })?;
            let drawn = self.drawn.images();
            let read = drawn.map(|i| i.barrier(i.drawn(), Layout::SHADER_READ_ONLY_OPTIMAL));
            let mut barriers: Vec<_> = read.collect();
            barriers.push(self.lit.barrier(Layout::UNDEFINED, Layout::GENERAL));
            let (last, now) = (&self.pictures[turn], &self.pictures[1 - turn]);
            // The first frame gives the last picture no weight.
            let known = match self.frames {
                1 => Layout::UNDEFINED,
                _ => Layout::GENERAL,
            };
            barriers.push(last.barrier(known, Layout::GENERAL));
            barriers.push(now.barrier(Layout::UNDEFINED, Layout::GENERAL));
            barrier(self.host, cmd, &barriers);
            let point = vk::PipelineBindPoint::COMPUTE;
            self.sets[turn].bind(cmd, point, self.layout, 0);
            for (pipeline, pushed) in [(self.light, &lit), (self.resolve, &blended)] {
                raw.cmd_bind_pipeline(cmd, point, pipeline);
                let bytes = bytemuck::bytes_of(pushed);
                let stage = vk::ShaderStageFlags::COMPUTE;
                raw.cmd_push_constants(cmd, self.layout, stage, 0, bytes);
                let size = [self.options.width, self.options.height];
                let [x, y] = size.map(|pixels| pixels.div_ceil(8));
                raw.cmd_dispatch(cmd, x, y, 1);
                barrier(self.host, cmd, &[]);
            }
            Ok(())
        })?
    }

    /// The last picture, linear.
    pub fn read(&self) -> Fallible<Vec<Vec4>> {
        let raw = &self.host.device;
        let image = &self.pictures[self.frames % 2];
        // SAFETY: the last frame was waited for.
        commands(self.host, true, |cmd| unsafe {
            let region = [image.region(&self.options)];
            let copied = Layout::TRANSFER_SRC_OPTIMAL;
            barrier(self.host, cmd, &[image.barrier(Layout::GENERAL, copied)]);
            raw.cmd_copy_image_to_buffer(cmd, image.raw, copied, self.read.raw, &region);
            barrier(self.host, cmd, &[image.barrier(copied, Layout::GENERAL)]);
        })?;
        let colors: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&self.read.bytes());
        Ok(colors.into_iter().map(Vec4::from).collect())
    }
}

impl Drop for Passes<'_> {
    fn drop(&mut self) {
        let raw = &self.host.device;
        // SAFETY: every submission was waited for; null handles may be destroyed.
        unsafe {
            for pipeline in [self.light, self.resolve] {
                raw.destroy_pipeline(pipeline, None);
            }
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_sampler(self.sampler, None);
        }
    }
}
