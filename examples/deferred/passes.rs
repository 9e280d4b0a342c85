//! The host's passes: meshes and solids into the G-buffer, light, temporal anti-aliasing.

use super::host::memory::{HostBuffer, HostImage, barrier};
use super::host::{
    Attachments, Fallible, Host, Mesh, MeshPipeline, MeshShaders, Options, commands, module,
};
use ash::vk;
use glam::{DMat4, Mat4, Vec2, Vec3, Vec4};
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
    sets: [vk::DescriptorSet; 2],
    sampler: vk::Sampler,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    descriptors: vk::DescriptorPool,
    mesh: MeshPipeline<'a>,
    light: vk::Pipeline,
    resolve: vk::Pipeline,
    frames: usize,
    host: &'a Host,
}

impl<'a> Passes<'a> {
    pub fn new(host: &'a Host, options: Options) -> Fallible<Self> {
        use vk::ImageUsageFlags as U;
        let stored = || HostImage::new(host, &options, PICTURE, U::STORAGE);
        let formats = PLANES.map(|(_, format)| format);
        let bytes = 16 * (options.width * options.height) as usize;
        let null = vk::Pipeline::null();
        let shaders = MeshShaders {
            vertex: include_bytes!("mesh.vert.spv"),
            fragment: include_bytes!("mesh.frag.spv"),
            sets: &[],
        };
        let mut passes = Self {
            drawn: Attachments::new(host, options, &formats)?,
            lit: stored()?,
            pictures: [stored()?, stored()?],
            read: HostBuffer::new(host, bytes, vk::BufferUsageFlags::TRANSFER_DST)?,
            options,
            sets: [vk::DescriptorSet::null(); 2],
            sampler: vk::Sampler::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            descriptors: vk::DescriptorPool::null(),
            mesh: MeshPipeline::new(host, &shaders, &options, vk::RenderPass::null(), &formats)?,
            light: null,
            resolve: null,
            frames: 0,
            host,
        };
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            passes.make_sets()?;
            passes.light = passes.compute(include_bytes!("light.comp.spv"))?;
            passes.resolve = passes.compute(include_bytes!("resolve.comp.spv"))?;
        }
        Ok(passes)
    }

    unsafe fn make_sets(&mut self) -> Fallible<()> {
        use vk::DescriptorType as T;
        let kind = |n: u32| match n {
            0..=5 => T::COMBINED_IMAGE_SAMPLER,
            _ => T::STORAGE_IMAGE,
        };
        let bindings: Vec<_> = (0..9)
            .map(|n| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(n)
                    .descriptor_type(kind(n))
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let raw = &self.host.device;
        // SAFETY: plain creations; the images live as long as the sets.
        unsafe {
            self.sampler = raw.create_sampler(&vk::SamplerCreateInfo::default(), None)?;
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            self.set_layout = raw.create_descriptor_set_layout(&info, None)?;
            let size = |ty, count| {
                vk::DescriptorPoolSize::default()
                    .ty(ty)
                    .descriptor_count(count)
            };
            let sizes = [
                size(T::COMBINED_IMAGE_SAMPLER, 12),
                size(T::STORAGE_IMAGE, 6),
            ];
            let info = vk::DescriptorPoolCreateInfo::default()
                .max_sets(2)
                .pool_sizes(&sizes);
            self.descriptors = raw.create_descriptor_pool(&info, None)?;
            let layouts = [self.set_layout; 2];
            let info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.descriptors)
                .set_layouts(&layouts);
            let sets = raw.allocate_descriptor_sets(&info)?;
            for (turn, &set) in sets.iter().enumerate() {
                let storage = [&self.lit, &self.pictures[turn], &self.pictures[1 - turn]];
                let images = self.drawn.images().chain(storage);
                for (image, n) in images.zip(0u32..) {
                    let layout = match n {
                        0..=5 => Layout::SHADER_READ_ONLY_OPTIMAL,
                        _ => Layout::GENERAL,
                    };
                    let named = [vk::DescriptorImageInfo::default()
                        .image_view(image.view)
                        .sampler(self.sampler)
                        .image_layout(layout)];
                    let write = vk::WriteDescriptorSet::default()
                        .dst_set(set)
                        .dst_binding(n)
                        .descriptor_type(kind(n))
                        .image_info(&named);
                    raw.update_descriptor_sets(&[write], &[]);
                }
            }
            self.sets = [sets[0], sets[1]];
            let pushed = [vk::PushConstantRange::default()
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
                .size(size_of::<Pushed>() as u32)];
            let info = vk::PipelineLayoutCreateInfo::default()
                .set_layouts(&layouts[..1])
                .push_constant_ranges(&pushed);
            self.layout = raw.create_pipeline_layout(&info, None)?;
        }
        Ok(())
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

    /// Draws a frame and waits for it. `before` records outside of the pass; `within` draws into the
    /// G-buffer what `before` returned.
    pub fn frame<T>(
        &mut self,
        clip_from_world: DMat4,
        meshes: &[Mesh<'_>],
        before: impl FnOnce(vk::CommandBuffer) -> Fallible<T>,
        within: impl FnOnce(vk::CommandBuffer, &T) -> Fallible<()>,
        lights: &Lights,
        resolve: &Resolve,
    ) -> Fallible<()> {
        let (raw, turn) = (&self.host.device, self.frames % 2);
        self.frames += 1;
        let Blend {
            weight,
            follows,
            clips,
        } = resolve.blend;
        let number = |yes: bool| f32::from(u8::from(yes));
        let lit = Pushed {
            matrix: lights.world_from_clip.to_cols_array_2d(),
            first: lights.eye.extend(1.0).to_array(),
            second: lights.towards_sun.extend(0.0).to_array(),
        };
        let [x, y] = resolve.jitter.to_array();
        let blended = Pushed {
            matrix: resolve.last_from_clip.to_cols_array_2d(),
            first: [x, y, weight, number(follows)],
            second: [number(clips), 0.0, 0.0, 0.0],
        };
        // SAFETY: the last frame was waited for; everything named lives as long as `self`.
        commands(self.host, true, |cmd| unsafe {
            let prepared = before(cmd)?;
            self.drawn.draw(cmd, &self.drawn.clears(), false, || {
                self.mesh.draw(cmd, clip_from_world, Vec3::Z, meshes);
                within(cmd, &prepared)
            })?;
            let drawn = self.drawn.images();
            let read = drawn.map(|i| i.barrier(i.drawn(), Layout::SHADER_READ_ONLY_OPTIMAL));
            let mut barriers: Vec<_> = read.collect();
            barriers.push(self.lit.barrier(Layout::UNDEFINED, Layout::GENERAL));
            let (last, now) = (&self.pictures[turn], &self.pictures[1 - turn]);
            // The first frame gives the last picture no weight.
            let known = if self.frames == 1 {
                Layout::UNDEFINED
            } else {
                Layout::GENERAL
            };
            barriers.push(last.barrier(known, Layout::GENERAL));
            barriers.push(now.barrier(Layout::UNDEFINED, Layout::GENERAL));
            barrier(self.host, cmd, &barriers);
            let point = vk::PipelineBindPoint::COMPUTE;
            raw.cmd_bind_descriptor_sets(cmd, point, self.layout, 0, &[self.sets[turn]], &[]);
            for (pipeline, pushed) in [(self.light, &lit), (self.resolve, &blended)] {
                raw.cmd_bind_pipeline(cmd, point, pipeline);
                self.push(cmd, pushed);
                let groups = |pixels: u32| pixels.div_ceil(8);
                raw.cmd_dispatch(
                    cmd,
                    groups(self.options.width),
                    groups(self.options.height),
                    1,
                );
                barrier(self.host, cmd, &[]);
            }
            Ok(())
        })?
    }

    unsafe fn push(&self, cmd: vk::CommandBuffer, pushed: &Pushed) {
        let stages = vk::ShaderStageFlags::COMPUTE;
        let bytes = bytemuck::bytes_of(pushed);
        // SAFETY: `cmd` is recording; the range is the layout's.
        unsafe {
            self.host
                .device
                .cmd_push_constants(cmd, self.layout, stages, 0, bytes)
        };
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
            raw.destroy_descriptor_pool(self.descriptors, None);
            raw.destroy_descriptor_set_layout(self.set_layout, None);
            raw.destroy_sampler(self.sampler, None);
        }
    }
}
