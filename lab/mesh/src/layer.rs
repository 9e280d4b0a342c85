//! A scene drawn as meshes in an off-screen frame, as its [`Guest`]. The only module with `unsafe`.
#![allow(unsafe_code)]

pub(super) mod pipelines;
pub(super) mod shadows;

pub use pipelines::MeshPipelines;

use super::blocks::{FrameBlock, InstanceBlock, MAX_LIGHTS, ObjectBlock};
use super::fineness::Fineness;
use super::placed::{Placed, SceneMeshes};
use super::tessellation::Mesh;
use ash::vk;
use gpu_allocator::MemoryLocation;
use pipelines::{PipelineKey, STAGES};
use revmap::error::Result;
use revmap::gpu::{Buffer, Device, View, vulkan_error as vulkan};
use revmap::scene::{CameraFrame, Lighting, Scene, Shadow};
use revmap::settings::{Planes, Settings};
use revmap_offscreen::{Guest, Offscreen};
use shadows::ShadowMaps;
use std::ops::Range;
use std::sync::Arc;

/// A scene's meshes on a device, a guest of an [`Offscreen`]. Every frame is waited for.
pub struct MeshLayer {
    meshes: SceneMeshes,
    size: (u32, u32),
    objects: Vec<DrawnObject>,
    /// Those of the meshes that are kept.
    on_device: Vec<Arc<DeviceMesh>>,
    /// Meshes that the next frame copies from buffers of vertices, then indices.
    staged: Vec<(Arc<DeviceMesh>, Buffer)>,
    frame: Buffer,
    instances: Buffer,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    /// Made with the first scene that has shadows.
    shadows: Option<ShadowMaps>,
    shadow: Shadow,
    pass: vk::RenderPass,
    kind: PassKind,
    pipelines: Arc<MeshPipelines>,
}

/// Passes that are compatible.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PassKind {
    pub samples: vk::SampleCountFlags,
    pub planes: Planes,
}

struct DrawnObject {
    mesh: Arc<DeviceMesh>,
    pipeline: vk::Pipeline,
    block: ObjectBlock,
    instances: Range<u32>,
    start: u32,
}

impl MeshLayer {
    /// No meshes yet, for the pass of `offscreen`, which draws by `settings` and has so many
    /// samples.
    pub fn new(
        pipelines: &Arc<MeshPipelines>,
        offscreen: &Offscreen,
        fineness: Fineness,
        settings: &Settings,
        samples: u32,
    ) -> Result<Self> {
        let size = (settings.width, settings.height);
        let device = pipelines.device();
        let mut layer = Self {
            meshes: SceneMeshes::new(fineness, size),
            size,
            objects: Vec::new(),
            on_device: Vec::new(),
            staged: Vec::new(),
            frame: written::<FrameBlock>(device, 1, vk::BufferUsageFlags::UNIFORM_BUFFER)?,
            instances: instance_buffer(device, 1)?,
            pool: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            shadows: None,
            shadow: Shadow::Off,
            pass: offscreen.render_pass(),
            kind: PassKind {
                samples: vk::SampleCountFlags::from_raw(samples),
                planes: settings.planes,
            },
            pipelines: pipelines.clone(),
        };
        let size = |kind, count| {
            vk::DescriptorPoolSize::default()
                .ty(kind)
                .descriptor_count(count)
        };
        let sizes = [
            size(vk::DescriptorType::UNIFORM_BUFFER, 2),
            size(vk::DescriptorType::STORAGE_BUFFER, 1),
            size(vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 2),
        ];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(2)
            .pool_sizes(&sizes);
        // SAFETY: a plain creation; Drop destroys the pool, and the set with it.
        layer.pool = unsafe { device.raw().create_descriptor_pool(&info, None) }
            .map_err(|code| vulkan("vkCreateDescriptorPool", code))?;
        let layouts = [pipelines.set_layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(layer.pool)
            .set_layouts(&layouts);
        // SAFETY: the pool holds a set of this layout.
        let sets = unsafe { device.raw().allocate_descriptor_sets(&info) }
            .map_err(|code| vulkan("vkAllocateDescriptorSets", code))?;
        layer.set = sets.first().copied().unwrap_or_default();
        layer.write_set();
        Ok(layer)
    }

    /// Takes over a scene. Meshes are made anew where a profile or an offset differs. `view` is
    /// called once it is sure that meshes draw the scene.
    pub fn update(&mut self, scene: &Scene, view: impl FnOnce() -> Result<View>) -> Result<()> {
        scene.check()?;
        let camera = CameraFrame::new(&scene.camera, self.size.0, self.size.1)?;
        let placed = self.meshes.place(scene, &camera)?;
        let lighting = scene.lighting();
        let frame = FrameBlock::new(&view()?, &camera, &lighting);
        if scene.shadow != Shadow::Off && self.shadows.is_none() {
            self.shadows = Some(ShadowMaps::new(&self.pipelines, self.pool)?);
        }
        self.take(&frame, &lighting, &placed)
    }

    /// Takes over a frame's block and its objects in order. Nothing changes where it fails.
    fn take(&mut self, frame: &FrameBlock, lighting: &Lighting, placed: &Placed) -> Result<()> {
        let device = self.pipelines.device().clone();
        let mut staged: Vec<(Arc<DeviceMesh>, Buffer)> = Vec::new();
        let mut objects = Vec::new();
        let mut instances: Vec<InstanceBlock> = Vec::new();
        // Those of meshes that are no longer kept go.
        let is_kept = |known: &Arc<DeviceMesh>| Arc::strong_count(&known.mesh) > 1;
        let mut on_device = self.on_device.clone();
        on_device.retain(is_kept);
        let mut of_mesh = |mesh: &Arc<Mesh>| -> Result<Arc<DeviceMesh>> {
            let mut known = on_device.iter();
            if let Some(known) = known.find(|known| Arc::ptr_eq(&known.mesh, mesh)) {
                return Ok(known.clone());
            }
            let (mesh, staging) = DeviceMesh::new(&device, mesh)?;
            let mesh = Arc::new(mesh);
            staged.push((mesh.clone(), staging));
            on_device.push(mesh.clone());
            Ok(mesh)
        };
        for one in &placed.meshes {
            let mesh = of_mesh(&one.mesh)?;
            let key = PipelineKey {
                pass: self.kind,
                lights: lighting.lights.len().min(MAX_LIGHTS) as u32,
                single: one.instances.len() == 1,
                projection: one.projection,
                both_sides: one.both_sides,
                shadow: lighting.shadow,
                environment: lighting.environment.is_some(),
            };
            let first = instances.len() as u32;
            instances.extend(&one.instances);
            objects.push(DrawnObject {
                mesh,
                pipeline: self.pipelines.get(key, self.pass)?,
                block: one.block,
                instances: first..instances.len() as u32,
                start: one.start,
            });
        }
        if let Some(shadows) = &mut self.shadows {
            shadows.take(&placed.maps, &mut instances, of_mesh)?;
        }
        self.shadow = lighting.shadow;
        let bytes: &[u8] = bytemuck::cast_slice(&instances);
        if bytes.len() as u64 > self.instances.bytes {
            let mut larger = instance_buffer(&device, instances.len())?;
            write(&mut larger, bytes)?;
            self.instances = larger;
            self.write_set();
        } else {
            write(&mut self.instances, bytes)?;
        }
        write(&mut self.frame, bytemuck::bytes_of(frame))?;
        (self.objects, self.on_device) = (objects, on_device);
        // Some may have been staged for a frame that was never drawn.
        self.staged.append(&mut staged);
        self.staged.retain(|(mesh, _)| Arc::strong_count(mesh) > 1);
        Ok(())
    }

    /// Drops what meshes were copied from, once a frame was drawn.
    pub fn drop_staging(&mut self) {
        self.staged.clear();
    }

    /// How many meshes were made so far.
    pub fn made_count(&self) -> u64 {
        self.meshes.made_count
    }

    /// Bytes of vertices and indices on the device.
    pub fn bytes(&self) -> u64 {
        let mut all: Vec<_> = self.objects.iter().map(|object| &object.mesh).collect();
        all.sort_by_key(|mesh| Arc::as_ptr(mesh));
        all.dedup_by_key(|mesh| Arc::as_ptr(mesh));
        let bytes = all
            .iter()
            .map(|mesh| mesh.vertices.bytes + mesh.indices.bytes);
        bytes.sum::<u64>() + self.shadows.as_ref().map_or(0, ShadowMaps::bytes)
    }

    /// Points the set to the buffers.
    fn write_set(&self) {
        let whole = |buffer: &Buffer| {
            [vk::DescriptorBufferInfo::default()
                .buffer(buffer.raw)
                .range(vk::WHOLE_SIZE)]
        };
        let (frame, instances) = (whole(&self.frame), whole(&self.instances));
        let write = |binding, kind, info| {
            vk::WriteDescriptorSet::default()
                .dst_set(self.set)
                .dst_binding(binding)
                .descriptor_type(kind)
                .buffer_info(info)
        };
        let writes = [
            write(0, vk::DescriptorType::UNIFORM_BUFFER, &frame),
            write(1, vk::DescriptorType::STORAGE_BUFFER, &instances),
        ];
        let raw = self.pipelines.device().raw();
        // SAFETY: set and buffers are live; the last frame was waited for.
        unsafe { raw.update_descriptor_sets(&writes, &[]) };
    }
}

impl Guest for MeshLayer {
    unsafe fn prepare(&self, cmd: vk::CommandBuffer) {
        let raw = self.pipelines.device().raw();
        for (mesh, staging) in &self.staged {
            let region = |from, size| [vk::BufferCopy::default().src_offset(from).size(size)];
            let (vertices, indices) = (mesh.vertices.bytes, mesh.indices.bytes);
            let (first, second) = (region(0, vertices), region(vertices, indices));
            // SAFETY: `cmd` is recording outside of a pass; the staging buffer holds both regions.
            unsafe {
                raw.cmd_copy_buffer(cmd, staging.raw, mesh.vertices.raw, &first);
                raw.cmd_copy_buffer(cmd, staging.raw, mesh.indices.raw, &second);
            }
        }
        if !self.staged.is_empty() {
            use vk::PipelineStageFlags as Stages;
            let read = vk::AccessFlags::VERTEX_ATTRIBUTE_READ | vk::AccessFlags::INDEX_READ;
            let barriers = [vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                .dst_access_mask(read)];
            let (from, to) = (Stages::TRANSFER, Stages::VERTEX_INPUT);
            let none = vk::DependencyFlags::empty();
            // SAFETY: as above.
            unsafe { raw.cmd_pipeline_barrier(cmd, from, to, none, &barriers, &[], &[]) };
        }
    }

    unsafe fn record_before(&self, cmd: vk::CommandBuffer) {
        if let Some(shadows) = self.shadows.as_ref().filter(|_| self.shadow != Shadow::Off) {
            // SAFETY: `cmd` is recording outside of a pass.
            unsafe { shadows.record(cmd, self.set) };
        }
    }

    unsafe fn record(&self, cmd: vk::CommandBuffer) {
        let raw = self.pipelines.device().raw();
        let layout = self.pipelines.layout;
        let point = vk::PipelineBindPoint::GRAPHICS;
        let shadows = self.shadows.as_ref().map(|shadows| shadows.set);
        let sets: Vec<_> = [self.set].into_iter().chain(shadows).collect();
        for object in &self.objects {
            let mesh = &object.mesh;
            let first = object.instances.start;
            let copies = object.instances.end - first;
            // SAFETY: `cmd` is recording in the pass that the pipeline was made for; what is bound
            // lives as long as `self`, and the buffers hold the indices and instances drawn.
            unsafe {
                raw.cmd_bind_pipeline(cmd, point, object.pipeline);
                raw.cmd_bind_descriptor_sets(cmd, point, layout, 0, &sets, &[]);
                let block = bytemuck::bytes_of(&object.block);
                raw.cmd_push_constants(cmd, layout, STAGES, 0, block);
                raw.cmd_bind_vertex_buffers(cmd, 0, &[mesh.vertices.raw], &[0]);
                raw.cmd_bind_index_buffer(cmd, mesh.indices.raw, 0, mesh.kind);
                for part in [object.start..mesh.count, 0..object.start] {
                    let count = part.end - part.start;
                    if count > 0 {
                        raw.cmd_draw_indexed(cmd, count, copies, part.start, 0, first);
                    }
                }
            }
        }
    }
}

impl Drop for MeshLayer {
    fn drop(&mut self) {
        let raw = self.pipelines.device().raw();
        // SAFETY: every frame was waited for; a null pool may be destroyed.
        unsafe { raw.destroy_descriptor_pool(self.pool, None) };
    }
}

struct DeviceMesh {
    mesh: Arc<Mesh>,
    vertices: Buffer,
    indices: Buffer,
    count: u32,
    kind: vk::IndexType,
}

impl DeviceMesh {
    /// Buffers for `mesh`, and one of vertices, then indices, from which the next frame copies.
    fn new(device: &Device, mesh: &Arc<Mesh>) -> Result<(Self, Buffer)> {
        let short: Option<Vec<u16>> = mesh.indices.iter().map(|i| (*i).try_into().ok()).collect();
        let (kind, indices): (_, &[u8]) = match &short {
            Some(short) => (vk::IndexType::UINT16, bytemuck::cast_slice(short)),
            None => (vk::IndexType::UINT32, bytemuck::cast_slice(&mesh.indices)),
        };
        let vertices: &[u8] = bytemuck::cast_slice(&mesh.vertices);
        let local = |name, bytes: &[u8], usage| {
            let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
            let bytes = bytes.len().next_multiple_of(16) as u64;
            device.buffer(name, bytes, usage, MemoryLocation::GpuOnly)
        };
        use vk::BufferUsageFlags as B;
        let vertex_buffer = local("mesh vertices", vertices, B::VERTEX_BUFFER)?;
        let index_buffer = local("mesh indices", indices, B::INDEX_BUFFER)?;
        let mut both = vertices.to_vec();
        both.resize(vertex_buffer.bytes as usize, 0);
        both.extend(indices);
        let bytes = vertex_buffer.bytes + index_buffer.bytes;
        let location = MemoryLocation::CpuToGpu;
        let mut staging = device.buffer("mesh staging", bytes, B::TRANSFER_SRC, location)?;
        write(&mut staging, &both)?;
        let mesh = Self {
            count: mesh.indices.len() as u32,
            kind,
            mesh: mesh.clone(),
            vertices: vertex_buffer,
            indices: index_buffer,
        };
        Ok((mesh, staging))
    }
}

fn instance_buffer(device: &Device, count: usize) -> Result<Buffer> {
    written::<InstanceBlock>(device, count, vk::BufferUsageFlags::STORAGE_BUFFER)
}

/// A buffer of so many values that the host writes.
fn written<T>(device: &Device, count: usize, usage: vk::BufferUsageFlags) -> Result<Buffer> {
    let bytes = (count * size_of::<T>()) as u64;
    device.buffer("mesh values", bytes, usage, MemoryLocation::CpuToGpu)
}

/// Writes to the beginning of a buffer in host memory.
fn write(buffer: &mut Buffer, bytes: &[u8]) -> Result<()> {
    buffer.mapped()?[..bytes.len()].copy_from_slice(bytes);
    Ok(())
}
