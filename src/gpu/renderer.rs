//! A scene on a device: baked, uploaded, compiled; then drawn as often as wanted.

use super::batch::{check_format, frame_block, instance_block, solid_block};
use super::bins::{Bins, Rectangle, rectangle};
use super::blocks::{FrameBlock, ShadowBlock, SolidBlock};
use super::clock::Clock;
use super::commands::Commands;
use super::contours::{Contours, Searches, Table};
use super::descriptors::Descriptors;
use super::device::{Device, Shared};
use super::hulls;
use super::memory::Buffer;
use super::meshes::{Meshes, Planned};
use super::pipelines::{Kind, Pipelines};
use super::target::Target;
use super::textures::Textures;
use super::usage::{Usage, buffer_barrier};
use crate::error::{Error, Result, Stage};
use crate::frame::Frame;
use crate::scene::{CameraFrame, Scene, Shadow};
use crate::settings::{DrawStage, Settings, Solver};
use crate::shader::Variant;
use crate::shader::generated::{
    BIN_PIXELS, GROUP_PIXELS, HULL_SIDES, MAX_SHADOW_BATCHES, PIECE_VECTORS,
};
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
    /// What the searches' tables, or meshes, are built from, one an object; empty for other searches.
    contours: Vec<Contours>,
    /// None where there is a search.
    meshes: Option<Meshes>,
    notes: Vec<String>,
    frame_buffer: Buffer,
    batch_buffer: Buffer,
    instance_buffer: Buffer,
    shadow_buffer: Buffer,
    bin_buffer: Buffer,
    piece_buffer: Buffer,
    /// Corners of a hull's triangles, the same for every hull.
    index_buffer: Buffer,
    commands: Commands,
    clock: Clock,
    settings: Settings,
    background: [f32; 4],
    /// From the first thing that an update changes to the last: what one that failed in between has left must not be drawn.
    stale: bool,
    device: Arc<Shared>,
}

/// What an update needs and can find out without changing anything.
struct Plan {
    camera: CameraFrame,
    frame: FrameBlock,
    searches: Searches,
    /// One an object, where meshes are drawn.
    meshes: Vec<Planned>,
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
    /// Of a single instance whose tiles are listed by beams: their pipeline, and the word where the list begins.
    beam: Option<(vk::Pipeline, u32)>,
    /// Of a hull: how many corners its triangles have.
    hull_indices: Option<u32>,
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
                beam: None,
                hull_indices: None,
            });
            instances = end;
        }

        let contours = if settings.solver.reads_map() {
            Vec::new()
        } else {
            Contours::of(scene)?
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
            index_buffer: indices(&device, 0)?,
            piece_buffer: storage(&device, "pieces", 16 * u64::from(PIECE_VECTORS))?,
            descriptors: Descriptors::new(&device, &pipelines, batches.len())?,
            pipelines,
            target,
            batches,
            textures,
            contours,
            meshes,
            notes: Vec::new(),
            frame_buffer,
            batch_buffer,
            instance_buffer,
            shadow_buffer,
            clock: Clock::new(&device)?,
            commands,
            settings: *settings,
            background: scene.background,
            stale: true,
            device,
        };
        renderer.update(scene)?;
        Ok(renderer)
    }

    /// Takes over camera, lights, placements and parameters of `scene`, whose objects must be those the renderer was made with.
    /// No map is computed again, but for a solid whose contour no longer closes under its offset ([`Renderer::notes`]).
    ///
    /// # Errors
    /// Of the scene's values ([`Stage::Scene`]), and of objects or instances other than those the renderer was made with
    /// ([`Stage::Draw`]): what was drawn before can be drawn on. Of baking a map ([`Stage::Map`]) and of Vulkan ([`Stage::Draw`]):
    /// nothing is drawn before an update succeeds.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        let plan = self.plan(scene)?;
        self.stale = true;
        self.apply(scene, plan)?;
        self.stale = false;
        Ok(())
    }

    /// Finds all that can be found wrong with a scene before anything is changed for it.
    fn plan(&self, scene: &Scene) -> Result<Plan> {
        if scene.objects.len() != self.batches.len() {
            return Err(Error::new(
                Stage::Draw,
                "the scene has other objects than the renderer was made with; make a new one",
            ));
        }
        scene.check()?;
        let size = (self.settings.width, self.settings.height);
        let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
        let frame = frame_block(scene, &camera, size)?;
        if scene.shadow != Shadow::Off {
            self.check_shadows()?;
        }
        let searches = Searches::new(&self.contours, scene, &self.settings)?;
        for (number, (batch, object)) in self.batches.iter().zip(&scene.objects).enumerate() {
            let settings = Settings {
                solver: searches.solver(number),
                ..self.settings
            };
            check_format(number, object, &settings)?;
            self.textures.shape(object, &self.settings)?;
            if object.placements().len() != batch.instances.len() {
                return Err(Error::new(
                    Stage::Draw,
                    format!(
                        "{} has other instances than the renderer was made with; make a new one",
                        object.name
                    ),
                ));
            }
        }
        let meshes = match &self.meshes {
            Some(meshes) => meshes.plan(scene, &self.contours)?,
            None => Vec::new(),
        };
        Ok(Plan {
            camera,
            frame,
            searches,
            meshes,
        })
    }

    fn apply(&mut self, scene: &Scene, plan: Plan) -> Result<()> {
        let Plan {
            camera,
            frame,
            searches,
            meshes: planned,
        } = plan;
        let size = (self.settings.width, self.settings.height);
        self.background = scene.background;
        for note in searches.notes() {
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
        write(&mut self.frame_buffer, 0, &frame)?;
        let mut bins = Bins::default();
        let mut pieces: Vec<[u32; 4]> = Vec::new();
        let mut bands = 0;
        let view = hulls::View {
            camera: &camera,
            size,
            near: f64::from(frame.eye[3]),
            from: self.settings.hull_from,
        };
        let limits = &self.device.limits;
        let wraps = limits.max_fragment_input_components >= hulls::COMPONENTS
            && limits.max_vertex_output_components >= hulls::COMPONENTS + 4;
        let most_groups = self.device.limits.max_compute_work_group_count[0];
        let mut shadows: ShadowBlock = bytemuck::Zeroable::zeroed();
        let casts = scene.shadow != Shadow::Off;
        if casts {
            shadows.shadow_batches[0] = u32::try_from(self.batches.len()).unwrap_or(0);
        }
        let count = self.batches.len();
        let mut tiles = Vec::new();
        let asked = self.settings.solver;
        // All maps before the first set of textures is written: shadows read those of other objects.
        for (number, object) in scene.objects.iter().enumerate() {
            if searches.solver(number) != asked || scene.shadow == Shadow::Soft {
                let (device, commands) = (&self.device, &self.commands);
                self.textures
                    .demand_map(device, commands, object, &self.settings)?;
            }
        }
        for (number, (batch, object)) in self.batches.iter_mut().zip(&scene.objects).enumerate() {
            let solver = searches.solver(number);
            let settings = Settings {
                solver,
                ..self.settings
            };
            let mut variant = Variant::new(&settings, scene, object);
            variant.single = u32::from(batch.instances.len() == 1);
            let (shape, facts) = self.textures.shape(object, &self.settings)?;
            let bound = self.textures.of(object, shape);
            batch.textures = self.descriptors.textures(number, &bound);
            let mut block = solid_block(object, &facts, &batch.instances, shape, solver);
            let mut kind = match self.settings.stage {
                DrawStage::Compute => Kind::Compute,
                _ => Kind::Box,
            };
            batch.hull_indices = None;
            batch.beam = None;
            batch.groups = None;
            batch.bins = 0..0;
            if kind == Kind::Compute {
                variant.depth_test = u32::from(number > 0);
                variant.depth_keep = u32::from(number + 1 < count);
            }
            let table = searches.table(number);
            let wrapped = match solver {
                Solver::Hull => table.and_then(Table::pieces),
                _ => None,
            };
            if let Some(cut) = wrapped
                && kind == Kind::Box
                && wraps
                && let Some(hull) = hulls::of(object, cut, &view)
            {
                kind = Kind::Hull;
                block.hull[0] = hulls::append(&hull, cut, &mut pieces) as u32;
                batch.hull_indices = Some(6 * HULL_SIDES * hull.bands.len() as u32);
                bands = bands.max(hull.bands.len());
            }
            // A hull's own fragments read none of the tree; shadows' rays do.
            if let Some(table) = table
                && (kind != Kind::Hull || casts)
            {
                let align = self.device.limits.min_uniform_buffer_offset_alignment;
                let align = usize::try_from(align).unwrap_or(256).max(16) / 16;
                let placed = table.append(align, &mut pieces);
                block.pieces = placed.block;
                variant.own_tables = u32::from(placed.vectors <= PIECE_VECTORS as usize);
                batch.tables_offset = 16 * block.pieces[0];
            }
            if self.settings.stage == DrawStage::Compute {
                let radius = object.profile.radius;
                if let [one] = object.placements() {
                    batch.groups = rectangle(&camera, size, GROUP_PIXELS, radius, one);
                } else {
                    let first = batch.instances.start;
                    batch.bins = bins.add(&camera, size, radius, first, object.placements());
                }
            }
            if let (Some(rectangle), Some(cut)) = (batch.groups, wrapped)
                && hulls::takes_beams(object, cut, &camera)
                && rectangle.padded() <= most_groups
            {
                variant.beam = 1;
                batch.beam = Some((self.pipelines.get(variant, Kind::Beam)?, 0));
                tiles.push((number, rectangle.padded()));
            }
            let mut near_first = Vec::new();
            if let (Some(meshes), Some(planned)) = (&mut self.meshes, planned.get(number)) {
                let both_sides;
                (near_first, both_sides) =
                    meshes.update(number, object, planned, &camera, &self.commands)?;
                kind = Kind::Mesh { both_sides };
            }
            batch.pipeline = self.pipelines.get(variant, kind)?;
            write(&mut self.batch_buffer, batch.block_offset as usize, &block)?;
            if casts {
                shadows.shadow_solids[number] = block;
            }
            let all = match near_first.as_slice() {
                [] => object.placements(),
                sorted => sorted,
            };
            let at = 48 * batch.instances.start as usize;
            let bytes = self.instance_buffer.mapped()?;
            for (target, placement) in bytes[at..].chunks_exact_mut(48).zip(all) {
                target.copy_from_slice(bytemuck::bytes_of(&instance_block(placement)));
            }
        }
        if self.settings.stage == DrawStage::Compute {
            let mut words = bins.words();
            for (number, most) in tiles {
                let begin = words.len() as u32;
                if let Some((_, at)) = &mut self.batches[number].beam {
                    *at = begin;
                }
                words.extend([0, 1, 1, 0]);
                words.resize(words.len() + 4 * most as usize, 0);
            }
            fit(&self.device, &mut self.bin_buffer, "bins", 4 * words.len())?;
            write_slice(&mut self.bin_buffer, &words)?;
        }
        if !pieces.is_empty() {
            // The window on the last tables is as long as on all others.
            pieces.resize(pieces.len() + PIECE_VECTORS as usize, [0; 4]);
            fit(
                &self.device,
                &mut self.piece_buffer,
                "pieces",
                size_of_val(pieces.as_slice()),
            )?;
            write_slice(&mut self.piece_buffer, &pieces)?;
        }
        if bands > 0 {
            let corners = hulls::indices(bands);
            if self.index_buffer.bytes < size_of_val(corners.as_slice()) as u64 {
                self.index_buffer = indices(&self.device, size_of_val(corners.as_slice()))?;
                write_slice(&mut self.index_buffer, &corners)?;
            }
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
        Ok(())
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan ([`Stage::Draw`]); [`Stage::Draw`], too, after an update that has failed half way.
    pub fn draw(&mut self) -> Result<Times> {
        self.check_whole()?;
        // Buffers may have been replaced, and what was uploaded or read back has recorded something else.
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

    /// What was done in another way than asked for, and why; each thing once.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    fn check_whole(&self) -> Result<()> {
        if self.stale {
            return Err(Error::new(
                Stage::Draw,
                "the last update failed half way; update again with what can be drawn, or make a new renderer",
            ));
        }
        Ok(())
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
    /// As [`Renderer::draw`].
    pub fn read(&self) -> Result<Frame> {
        self.check_whole()?;
        let planes = self.target.read(&self.commands)?;
        super::read_back::frame(&self.settings, self.background, &planes)
    }

    fn record(&self, cmd: vk::CommandBuffer) {
        self.clock.start(cmd);
        self.target
            .clear(cmd, self.background, self.batches.len() > 1);
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
            let first = batch.instances.start;
            let raw = &self.device.raw;
            // SAFETY: `cmd` is recording within a render pass; all that is bound lives as long as `self`.
            unsafe {
                if let Some(corners) = batch.hull_indices {
                    let kind = vk::IndexType::UINT32;
                    raw.cmd_bind_index_buffer(cmd, self.index_buffer.raw, 0, kind);
                    raw.cmd_draw_indexed(cmd, corners, count, 0, 0, first);
                } else {
                    raw.cmd_draw(cmd, 14, count, 0, first);
                }
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
            if let (Some(rectangle), Some(beam)) = (batch.groups, batch.beam) {
                self.record_beams(cmd, batch, rectangle, beam);
            } else if let Some(Rectangle { low, high }) = batch.groups {
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

    /// Lists the tiles that a single instance's rays may meet, then traces those.
    fn record_beams(
        &self,
        cmd: vk::CommandBuffer,
        batch: &Batch,
        Rectangle { low, high }: Rectangle,
        (list, at): (vk::Pipeline, u32),
    ) {
        let raw = &self.device.raw;
        let words = &self.bin_buffer;
        let none: [u32; 4] = [0, 1, 1, 0];
        let pushed = [at, low.0 | low.1 << 16];
        let groups = |a: u32, b: u32| (b - a + 1).div_ceil(GROUP_PIXELS);
        let (point, stage) = (
            vk::PipelineBindPoint::COMPUTE,
            vk::ShaderStageFlags::COMPUTE,
        );
        buffer_barrier(
            &self.device,
            cmd,
            words,
            Usage::TileRead,
            Usage::TransferWrite,
        );
        // SAFETY: `cmd` is recording, outside a render pass; the list's words lie within the buffer; all that is bound lives as
        // long as `self`, and both pipelines have one layout.
        unsafe {
            raw.cmd_update_buffer(cmd, words.raw, 4 * u64::from(at), bytemuck::bytes_of(&none));
            buffer_barrier(
                &self.device,
                cmd,
                words,
                Usage::TransferWrite,
                Usage::ComputeWrite,
            );
            raw.cmd_bind_pipeline(cmd, point, list);
            let bytes = bytemuck::bytes_of(&pushed);
            raw.cmd_push_constants(cmd, self.pipelines.layout, stage, 0, bytes);
            raw.cmd_dispatch(cmd, groups(low.0, high.0), groups(low.1, high.1), 1);
            buffer_barrier(
                &self.device,
                cmd,
                words,
                Usage::ComputeWrite,
                Usage::TileRead,
            );
            raw.cmd_bind_pipeline(cmd, point, batch.pipeline);
            raw.cmd_dispatch_indirect(cmd, words.raw, 4 * u64::from(at));
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
    // Pieces are read both ways; lists of tiles are made and counted on the device.
    use vk::BufferUsageFlags as B;
    let usage = B::STORAGE_BUFFER | B::UNIFORM_BUFFER | B::INDIRECT_BUFFER | B::TRANSFER_DST;
    Buffer::new(device, name, bytes, usage, MemoryLocation::CpuToGpu)
}

fn indices(device: &Arc<Shared>, bytes: usize) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::INDEX_BUFFER;
    Buffer::new(
        device,
        "corners of hulls",
        bytes as u64,
        usage,
        MemoryLocation::CpuToGpu,
    )
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
