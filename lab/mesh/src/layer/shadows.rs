//! The shadow maps of a layer: one depth image, in it a square for each map.

use super::super::blocks::{CasterBlock, InstanceBlock, MapBlock};
use super::super::cascades::{CASCADES, Cascade, SHADOW_LIGHTS, SIDE};
use super::super::placed::PlacedMap;
use super::pipelines::{MeshPipelines, STAGES};
use super::{DeviceMesh, write, written};
use ash::vk;
use glam::{DMat4, DVec3};
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{Buffer, Image, ImageKind, vulkan_error as vulkan};
use std::ops::Range;
use std::sync::Arc;

/// A mesh that is drawn into a map.
struct Caster {
    mesh: Arc<DeviceMesh>,
    block: CasterBlock,
    instances: Range<u32>,
    viewport: vk::Rect2D,
}

pub(super) struct ShadowMaps {
    atlas: Image,
    framebuffer: vk::Framebuffer,
    block: Buffer,
    pub set: vk::DescriptorSet,
    casters: Vec<Caster>,
    pipelines: Arc<MeshPipelines>,
}

impl ShadowMaps {
    /// Maps for all lights, with a set of the pool.
    pub fn new(pipelines: &Arc<MeshPipelines>, pool: vk::DescriptorPool) -> Result<Self> {
        let device = pipelines.device();
        let (width, height) = (SIDE * CASCADES as u32, SIDE * SHADOW_LIGHTS as u32);
        // SAFETY: a query of the device's own limits.
        let facts = unsafe {
            let instance = device.instance();
            instance.get_physical_device_properties(device.physical())
        };
        if width > facts.limits.max_image_dimension2_d {
            let message = format!("the device has no images of {width} texels for shadow maps");
            return Err(Error::new(ErrorKind::Unsupported, message));
        }
        let kind = ImageKind {
            format: vk::Format::D32_SFLOAT,
            width,
            height,
            mips: 1,
            samples: vk::SampleCountFlags::TYPE_1,
            usage: vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
        };
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let mut maps = Self {
            atlas: device.image("shadow maps", kind)?,
            framebuffer: vk::Framebuffer::null(),
            block: written::<MapBlock>(device, SHADOW_LIGHTS * CASCADES, usage)?,
            set: vk::DescriptorSet::null(),
            casters: Vec::new(),
            pipelines: pipelines.clone(),
        };
        let raw = device.raw();
        let views = [maps.atlas.view];
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pipelines.shadow_pass)
            .attachments(&views)
            .width(width)
            .height(height)
            .layers(1);
        // SAFETY: pass and view are live; Drop destroys the framebuffer.
        maps.framebuffer = unsafe { raw.create_framebuffer(&info, None) }
            .map_err(|code| vulkan("vkCreateFramebuffer", code))?;
        let layouts = [pipelines.shadow_layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool)
            .set_layouts(&layouts);
        // SAFETY: the pool has room for a set of this layout.
        let sets = unsafe { raw.allocate_descriptor_sets(&info) }
            .map_err(|code| vulkan("vkAllocateDescriptorSets", code))?;
        maps.set = sets.first().copied().unwrap_or_default();
        let block = [vk::DescriptorBufferInfo::default()
            .buffer(maps.block.raw)
            .range(vk::WHOLE_SIZE)];
        let image = |sampler| {
            [vk::DescriptorImageInfo::default()
                .sampler(sampler)
                .image_view(maps.atlas.view)
                .image_layout(vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL)]
        };
        let images = pipelines.samplers.map(image);
        let write = |binding| {
            vk::WriteDescriptorSet::default()
                .dst_set(maps.set)
                .dst_binding(binding)
        };
        let sampled = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
        let writes = [
            write(0)
                .descriptor_type(vk::DescriptorType::UNIFORM_BUFFER)
                .buffer_info(&block),
            write(1).descriptor_type(sampled).image_info(&images[0]),
            write(2).descriptor_type(sampled).image_info(&images[1]),
        ];
        // SAFETY: set, buffer, view and samplers are live.
        unsafe { raw.update_descriptor_sets(&writes, &[]) };
        Ok(maps)
    }

    /// Takes over the maps of a frame, whose instances follow those that are there.
    pub fn take(
        &mut self,
        maps: &[Vec<PlacedMap>],
        instances: &mut Vec<InstanceBlock>,
        mut on_device: impl FnMut(&Arc<super::Mesh>) -> Result<Arc<DeviceMesh>>,
    ) -> Result<()> {
        let mut blocks = [MapBlock::default(); SHADOW_LIGHTS * CASCADES];
        let mut casters = Vec::new();
        for (light, of_light) in maps.iter().enumerate() {
            for (k, (map, placed)) in of_light.iter().enumerate() {
                let block = map_block(map, [k, light]);
                // Maps that are missing are never farther.
                blocks[CASCADES * light + k..CASCADES * (light + 1)].fill(block);
                let viewport = vk::Rect2D {
                    offset: vk::Offset2D {
                        x: k as i32 * SIDE as i32,
                        y: light as i32 * SIDE as i32,
                    },
                    extent: square(SIDE, SIDE),
                };
                for caster in placed {
                    let first = instances.len() as u32;
                    instances.extend(&caster.instances);
                    let [x, y] = caster.axis.map(|v| v as f32);
                    casters.push(Caster {
                        mesh: on_device(&caster.mesh)?,
                        block: CasterBlock {
                            clip_from_world: map.clip_from_world.as_mat4().to_cols_array_2d(),
                            axis: [x, y, 0.0, 0.0],
                        },
                        instances: first..instances.len() as u32,
                        viewport,
                    });
                }
            }
        }
        write(&mut self.block, bytemuck::cast_slice(&blocks))?;
        self.casters = casters;
        Ok(())
    }

    pub fn bytes(&self) -> u64 {
        self.atlas.bytes()
    }

    /// Records the pass that draws all maps.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; `set` holds the instances.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer, set: vk::DescriptorSet) {
        let (pipelines, kind) = (&self.pipelines, &self.atlas.kind);
        let raw = pipelines.device().raw();
        let point = vk::PipelineBindPoint::GRAPHICS;
        let layout = pipelines.layout;
        let clear = [vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: 1.0,
                stencil: 0,
            },
        }];
        let area = vk::Rect2D::default().extent(square(kind.width, kind.height));
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(pipelines.shadow_pass)
            .framebuffer(self.framebuffer)
            .render_area(area)
            .clear_values(&clear);
        // SAFETY: `cmd` is recording outside of a pass; all that is bound is live.
        unsafe {
            raw.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            raw.cmd_bind_pipeline(cmd, point, pipelines.caster);
            raw.cmd_bind_descriptor_sets(cmd, point, layout, 0, &[set], &[]);
            for one in &self.casters {
                let (mesh, at) = (&one.mesh, one.viewport);
                let viewport = vk::Viewport {
                    x: at.offset.x as f32,
                    y: at.offset.y as f32,
                    width: at.extent.width as f32,
                    height: at.extent.height as f32,
                    min_depth: 0.0,
                    max_depth: 1.0,
                };
                raw.cmd_set_viewport(cmd, 0, &[viewport]);
                raw.cmd_set_scissor(cmd, 0, &[at]);
                raw.cmd_push_constants(cmd, layout, STAGES, 0, bytemuck::bytes_of(&one.block));
                raw.cmd_bind_vertex_buffers(cmd, 0, &[mesh.vertices.raw], &[0]);
                raw.cmd_bind_index_buffer(cmd, mesh.indices.raw, 0, mesh.kind);
                let (first, copies) = (one.instances.start, one.instances.len() as u32);
                raw.cmd_draw_indexed(cmd, mesh.count, copies, 0, 0, first);
            }
            raw.cmd_end_render_pass(cmd);
        }
    }
}

impl Drop for ShadowMaps {
    fn drop(&mut self) {
        let raw = self.pipelines.device().raw();
        // SAFETY: every frame was waited for; null is allowed.
        unsafe { raw.destroy_framebuffer(self.framebuffer, None) };
    }
}

fn square(width: u32, height: u32) -> vk::Extent2D {
    vk::Extent2D { width, height }
}

/// The block of a map in a square of the atlas.
fn map_block(map: &Cascade, place: [usize; 2]) -> MapBlock {
    let parts = DVec3::new(CASCADES as f64, SHADOW_LIGHTS as f64, 1.0);
    let begin = DVec3::new(place[0] as f64, place[1] as f64, 0.0) / parts;
    let half = DVec3::new(0.5, 0.5, 1.0);
    let to_square = DMat4::from_translation(DVec3::new(0.5, 0.5, 0.0)) * DMat4::from_scale(half);
    let to_atlas = DMat4::from_translation(begin) * DMat4::from_scale(1.0 / parts);
    let inwards = 0.5 / f64::from(SIDE) / parts;
    let [low, high] = [begin + inwards, begin + 1.0 / parts - inwards];
    let atlas_from_world = to_atlas * to_square * map.clip_from_world;
    let rows = atlas_from_world.transpose();
    let per_unit = [rows.x_axis, rows.y_axis].map(|row| row.truncate().length() as f32);
    MapBlock {
        atlas_from_world: atlas_from_world.as_mat4().to_cols_array_2d(),
        square: [low.x, low.y, high.x, high.y].map(|v| v as f32),
        facts: [map.end, map.texel, map.range, 0.0].map(|v| v as f32),
        per_unit: [per_unit[0], per_unit[1], 0.0, 0.0],
    }
}
