//! A scene on a device: baked, uploaded, compiled; then drawn as often as wanted.

use super::batch::{check_format, frame_block, instance_block, solid_block};
use super::bins::{Bins, Rectangle, rectangle};
use super::blocks::{FrameBlock, ShadowBlock, SolidBlock};
use super::clock::Clock;
use super::commands::Commands;
use super::contours::Contours;
use super::descriptors::Descriptors;
use super::device::{Device, Shared};
use super::memory::Buffer;
use super::meshes::Meshes;
use super::pipelines::{Pipelines, Use};
use super::target::Target;
use super::textures::Textures;
use crate::error::{Error, Result, Stage};
use crate::frame::Frame;
use crate::scene::{CameraFrame, Scene, Shadow};
use crate::settings::{DrawStage, Settings, Solver};
use crate::shader::Variant;
use crate::shader::generated::{BIN_PIXELS, GROUP_PIXELS, MAX_SHADOW_BATCHES, PIECE_VECTORS};
use ash::vk;
use gpu_allocator::MemoryLocation;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// What one frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds between GPU timestamps around the work; `None` where the device has none.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission to completion by the wall clock.
    pub frame_ms: f64,
}

/// A scene ready to be drawn on a device.
pub struct Renderer {
    // Vulkan objects in order of destruction; `device` last.
    pipelines: Pipelines,
    target: Target,
    descriptors: Descriptors,
    batches: Vec<Batch>,
    textures: Textures,
    /// What the quadric search's tables, or meshes, are built from, one an object; empty for other searches.
    contours: Vec<Contours>,
    /// None where there is a search.
    meshes: Option<Meshes>,
    frame_buffer: Buffer,
    batch_buffer: Buffer,
    instance_buffer: Buffer,
    shadow_buffer: Buffer,
    bin_buffer: Buffer,
    piece_buffer: Buffer,
    commands: Commands,
    clock: Clock,
    settings: Settings,
    background: [f32; 4],
    device: Arc<Shared>,
}

/// One draw or dispatch: instances that share shape, look and variant.
struct Batch {
    pipeline: vk::Pipeline,
    textures: vk::DescriptorSet,
    block_offset: u32,
    tables_offset: u32,
    instances: Range<u32>,
    bins: Range<u32>,
    /// Of a single instance: its work groups.
    groups: Option<Rectangle>,
}

impl Renderer {
    /// Bakes and uploads the scene's maps, compiles its pipelines, and makes a target of the settings' size.
    ///
    /// # Errors
    /// Of baking ([`Stage::Map`]), of the scene's values ([`Stage::Scene`]), of Vulkan ([`Stage::Draw`]).
    pub fn new(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        let device = device.shared.clone();
        let meshes = Meshes::new(&device, scene, settings)?;
        let commands = Commands::new(&device)?;
        let size = (settings.width, settings.height);
        let pipelines = Pipelines::new(&device, settings.planes)?;
        let target = Target::new(&device, &pipelines, settings.stage, settings.planes, size)?;

        let textures = Textures::new(&device, &commands, scene, settings)?;
        let stride = block_stride(&device);
        let mut batches = Vec::new();
        let mut instances = 0u32;
        for (number, object) in scene.objects.iter().enumerate() {
            let end = u32::try_from(object.placements().len())
                .ok()
                .and_then(|n| instances.checked_add(n))
                .ok_or_else(|| Error::new(Stage::Draw, "more than 2^32 instances"))?;
            batches.push(Batch {
                pipeline: vk::Pipeline::null(),
                textures: vk::DescriptorSet::null(),
                block_offset: u32::try_from(number).unwrap_or(u32::MAX) * stride,
                tables_offset: 0,
                instances: instances..end,
                bins: 0..0,
                groups: None,
            });
            instances = end;
        }

        let contours = if settings.solver == Solver::Quadric || meshes.is_some() {
            Contours::of(scene)?
        } else {
            Vec::new()
        };
        let uniform = |name, bytes| {
            Buffer::new(
                &device,
                name,
                bytes,
                vk::BufferUsageFlags::UNIFORM_BUFFER,
                MemoryLocation::CpuToGpu,
            )
        };
        let frame_buffer = uniform("frame block", size_of::<FrameBlock>() as u64)?;
        let batch_bytes = u64::from(stride) * batches.len() as u64;
        let batch_buffer = uniform("batch blocks", batch_bytes)?;
        let instance_buffer = storage(&device, "instances", 48 * u64::from(instances))?;
        let shadow_buffer = uniform("shadow block", size_of::<ShadowBlock>() as u64)?;
        let mut renderer = Self {
            bin_buffer: storage(&device, "bins", 0)?,
            piece_buffer: storage(&device, "pieces", 16 * u64::from(PIECE_VECTORS))?,
            descriptors: Descriptors::new(&device, &pipelines, batches.len())?,
            pipelines,
            target,
            batches,
            textures,
            contours,
            meshes,
            frame_buffer,
            batch_buffer,
            instance_buffer,
            shadow_buffer,
            clock: Clock::new(&device)?,
            commands,
            settings: *settings,
            background: scene.background,
            device,
        };
        renderer.update(scene)?;
        Ok(renderer)
    }

    /// Takes over camera, lights, placements and parameters of `scene`, whose objects must be those the renderer was made with.
    /// No map is computed again.
    ///
    /// # Errors
    /// Of the scene's values ([`Stage::Scene`]), of Vulkan ([`Stage::Draw`]).
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        if scene.objects.len() != self.batches.len() {
            return Err(Error::new(
                Stage::Draw,
                "the scene has other objects than the renderer was made with; make a new one",
            ));
        }
        scene.check()?;
        self.background = scene.background;
        let size = (self.settings.width, self.settings.height);
        let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
        let frame = frame_block(scene, &camera, size)?;
        write(&mut self.frame_buffer, 0, &frame)?;
        let mut bins = Bins::default();
        let mut pieces: Vec<[f32; 4]> = Vec::new();
        let mut shadows: ShadowBlock = bytemuck::Zeroable::zeroed();
        let casts = scene.shadow != Shadow::Off;
        if casts {
            self.check_shadows()?;
            shadows.shadow_batches[0] = u32::try_from(self.batches.len()).unwrap_or(0);
        }
        for (number, (batch, object)) in self.batches.iter_mut().zip(&scene.objects).enumerate() {
            check_format(number, object, &self.settings)?;
            let mut variant = Variant::new(&self.settings, scene, object);
            variant.single = u32::from(batch.instances.len() == 1);
            let (shape, facts) = self.textures.shape(object, &self.settings)?;
            let bound = self.textures.of(object, shape);
            batch.textures = self.descriptors.textures(number, &bound);
            let mut block = solid_block(
                object,
                &facts,
                &batch.instances,
                shape,
                self.settings.solver,
            );
            if self.settings.solver == Solver::Quadric {
                let align = self.device.limits.min_uniform_buffer_offset_alignment;
                let align = usize::try_from(align).unwrap_or(256).max(16) / 16;
                block.pieces = self.contours[number].append(&object.offset, align, &mut pieces)?;
                let own = pieces.len() - block.pieces[0] as usize;
                variant.own_tables = u32::from(own <= PIECE_VECTORS as usize);
                batch.tables_offset = 16 * block.pieces[0];
            }
            let mut near_first = Vec::new();
            if let Some(meshes) = &mut self.meshes {
                let contours = &self.contours[number];
                let both_sides;
                (near_first, both_sides) =
                    meshes.update(number, scene, contours, &camera, &self.commands)?;
                let mesh = Use::Mesh { both_sides };
                batch.pipeline = self.pipelines.get_for(variant, mesh)?;
            } else {
                batch.pipeline = self.pipelines.get(variant, self.settings.stage)?;
            }
            write(&mut self.batch_buffer, batch.block_offset as usize, &block)?;
            if casts {
                shadows.shadow_solids[number] = block;
            }
            let all = match near_first.as_slice() {
                [] => object.placements(),
                sorted => sorted,
            };
            if all.len() != batch.instances.len() {
                return Err(Error::new(
                    Stage::Draw,
                    format!(
                        "{} has other instances than the renderer was made with; make a new one",
                        object.name
                    ),
                ));
            }
            let at = 48 * batch.instances.start as usize;
            let bytes = self.instance_buffer.mapped()?;
            for (target, placement) in bytes[at..].chunks_exact_mut(48).zip(all) {
                target.copy_from_slice(bytemuck::bytes_of(&instance_block(placement)));
            }
            if self.settings.stage == DrawStage::Compute {
                let radius = object.profile.radius;
                if let [one] = all {
                    batch.groups = rectangle(&camera, size, GROUP_PIXELS, radius, one);
                } else {
                    batch.bins = bins.add(&camera, size, radius, batch.instances.start, all);
                }
            }
        }
        if self.settings.stage == DrawStage::Compute {
            let words = bins.words();
            fit(&self.device, &mut self.bin_buffer, "bins", 4 * words.len())?;
            write_slice(&mut self.bin_buffer, &words)?;
        }
        if !pieces.is_empty() {
            // The window on the last tables is as long as on all others.
            pieces.resize(pieces.len() + PIECE_VECTORS as usize, [0.0; 4]);
            fit(
                &self.device,
                &mut self.piece_buffer,
                "pieces",
                size_of_val(pieces.as_slice()),
            )?;
            write_slice(&mut self.piece_buffer, &pieces)?;
        }
        write(&mut self.shadow_buffer, 0, &shadows)?;
        self.descriptors.frame(
            &self.frame_buffer,
            (&self.batch_buffer, size_of::<SolidBlock>() as u64),
            &self.instance_buffer,
            &self.shadow_buffer,
            &self.piece_buffer,
        );
        self.descriptors.target(&self.target, &self.bin_buffer);
        let recorded = &self.commands;
        recorded.record(|cmd| self.record(cmd))
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan ([`Stage::Draw`]).
    pub fn draw(&mut self) -> Result<Times> {
        // What was read back in between has recorded something else.
        self.commands.record(|cmd| self.record(cmd))?;
        let start = Instant::now();
        self.commands.submit_and_wait()?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Times {
            gpu_ms: self.clock.milliseconds()?,
            frame_ms,
        })
    }

    /// Bytes that the scene's maps take on the device: shape maps (or meshes), and colour and displacement maps.
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        let [shapes, surfaces] = self.textures.bytes();
        let meshes = self.meshes.as_ref().map_or(0, Meshes::bytes);
        [shapes + meshes, surfaces]
    }

    fn check_shadows(&self) -> Result<()> {
        let (count, most) = (self.batches.len(), MAX_SHADOW_BATCHES as usize);
        if count > most {
            return Err(Error::new(
                Stage::Scene,
                format!("shadows between {count} objects; at most {most} are drawn: use instances, or set \"off\""),
            )
            .at_key("shadow"));
        }
        self.textures.check_shadows()
    }

    /// Reads the last drawn frame back.
    ///
    /// # Errors
    /// Of Vulkan ([`Stage::Draw`]).
    pub fn read(&self) -> Result<Frame> {
        let planes = self.target.read(&self.commands)?;
        super::read_back::frame(&self.settings, self.background, &planes)
    }

    fn record(&self, cmd: vk::CommandBuffer) {
        self.clock.start(cmd);
        self.target.clear(cmd, self.background);
        if self.settings.stage == DrawStage::Compute {
            self.record_compute(cmd);
        } else {
            self.target
                .begin(cmd, self.pipelines.render_pass, self.background);
            self.record_fragment(cmd);
            // SAFETY: the render pass was begun above.
            unsafe { self.device.raw.cmd_end_render_pass(cmd) };
        }
        self.clock.stop(cmd);
    }

    /// Draws every batch's boxes or meshes, within a render pass.
    fn record_fragment(&self, cmd: vk::CommandBuffer) {
        if let Some(meshes) = &self.meshes {
            for &number in meshes.order() {
                let batch = &self.batches[number];
                self.bind(cmd, batch, vk::PipelineBindPoint::GRAPHICS);
                meshes.draw(cmd, number, &batch.instances);
            }
            return;
        }
        for batch in &self.batches {
            self.bind(cmd, batch, vk::PipelineBindPoint::GRAPHICS);
            let count = batch.instances.end - batch.instances.start;
            // SAFETY: `cmd` is recording within a render pass; all that is bound lives as long as `self`.
            unsafe {
                self.device
                    .raw
                    .cmd_draw(cmd, 14, count, 0, batch.instances.start)
            };
        }
    }

    /// Traces every batch's bins.
    fn record_compute(&self, cmd: vk::CommandBuffer) {
        let raw = &self.device.raw;
        let groups = BIN_PIXELS / GROUP_PIXELS;
        let most = self.device.limits.max_compute_work_group_count[1];
        let mut first = true;
        let seen = |b: &&Batch| b.groups.is_some() || !b.bins.is_empty();
        for batch in self.batches.iter().filter(seen) {
            if !first {
                // The next batch reads the depths that this one wrote.
                let access = vk::AccessFlags::SHADER_READ | vk::AccessFlags::SHADER_WRITE;
                let barrier = vk::MemoryBarrier::default()
                    .src_access_mask(vk::AccessFlags::SHADER_WRITE)
                    .dst_access_mask(access);
                let stage = vk::PipelineStageFlags::COMPUTE_SHADER;
                let none = vk::DependencyFlags::empty();
                // SAFETY: `cmd` is recording, outside a render pass.
                unsafe { raw.cmd_pipeline_barrier(cmd, stage, stage, none, &[barrier], &[], &[]) };
            }
            first = false;
            self.bind(cmd, batch, vk::PipelineBindPoint::COMPUTE);
            if let Some(Rectangle { low, high }) = batch.groups {
                self.dispatch(
                    cmd,
                    [0, low.0 | low.1 << 16],
                    [high.0 - low.0 + 1, high.1 - low.1 + 1],
                );
            }
            let mut start = batch.bins.start;
            while start < batch.bins.end {
                let count = (batch.bins.end - start).min(most);
                self.dispatch(cmd, [start, 0], [groups * groups, count]);
                start += count;
            }
        }
    }

    /// `pushed` as in `bins.glsl`.
    fn dispatch(&self, cmd: vk::CommandBuffer, pushed: [u32; 2], groups: [u32; 2]) {
        let raw = &self.device.raw;
        // SAFETY: `cmd` is recording, outside a render pass; all that is bound lives as long as `self`.
        unsafe {
            let stage = vk::ShaderStageFlags::COMPUTE;
            let bytes = bytemuck::bytes_of(&pushed);
            raw.cmd_push_constants(cmd, self.pipelines.layout, stage, 0, bytes);
            raw.cmd_dispatch(cmd, groups[0], groups[1], 1);
        }
    }

    fn bind(&self, cmd: vk::CommandBuffer, batch: &Batch, point: vk::PipelineBindPoint) {
        let sets = [
            self.descriptors.frame,
            batch.textures,
            self.descriptors.target,
        ];
        // SAFETY: the sets fit the layout, and all they name lives as long as `self`.
        unsafe {
            self.device
                .raw
                .cmd_bind_pipeline(cmd, point, batch.pipeline);
            self.device.raw.cmd_bind_descriptor_sets(
                cmd,
                point,
                self.pipelines.layout,
                0,
                &sets,
                &[batch.block_offset, batch.tables_offset],
            );
        }
    }
}

fn storage(device: &Arc<Shared>, name: &str, bytes: u64) -> Result<Buffer> {
    let limit = u64::from(device.limits.max_storage_buffer_range);
    if bytes > limit {
        return Err(Error::new(
            Stage::Draw,
            format!(
                "the {name} take {bytes} bytes, and {} takes {limit}; draw fewer",
                device.report.name
            ),
        ));
    }
    // Pieces are read both ways.
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::UNIFORM_BUFFER;
    Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

/// Makes `buffer` anew where it is too small.
fn fit(device: &Arc<Shared>, buffer: &mut Buffer, name: &str, bytes: usize) -> Result<()> {
    if buffer.bytes < bytes as u64 {
        *buffer = storage(device, name, bytes as u64)?;
    }
    Ok(())
}

/// Bytes from batch block to batch block, as dynamic offsets need it.
fn block_stride(device: &Shared) -> u32 {
    let align = device.limits.min_uniform_buffer_offset_alignment.max(1);
    (size_of::<SolidBlock>() as u64).next_multiple_of(align) as u32
}

fn write<T: bytemuck::Pod>(buffer: &mut Buffer, at: usize, value: &T) -> Result<()> {
    buffer.mapped()?[at..at + size_of::<T>()].copy_from_slice(bytemuck::bytes_of(value));
    Ok(())
}

fn write_slice<T: bytemuck::Pod>(buffer: &mut Buffer, values: &[T]) -> Result<()> {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    buffer.mapped()?[..bytes.len()].copy_from_slice(bytes);
    Ok(())
}
