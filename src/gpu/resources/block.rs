//! Conversion of scene values to the blocks that shaders read.

use crate::error::{Error, ErrorKind, Result};
use crate::maps::MapFormat;
use crate::plan::casters::Hierarchy;
use crate::plan::{DepthOrder, View};
use crate::scene::{Lighting, Object, Placement};
use crate::settings::{SearchSettings, Solver};
use crate::shader::generated::MAX_LIGHTS;
use crate::shader::{FrameBlock, InstanceBlock, LightBlock};
use glam::DVec3;

/// Returns an error if a map's format cannot show the object's offset.
pub(crate) fn check_format(
    object: &Object,
    solver: Solver,
    settings: &SearchSettings,
) -> Result<()> {
    if solver.reads_map() && settings.map_format == MapFormat::Rgba8 && object.offset.extend < 0.0 {
        return Err(Error::new(
            ErrorKind::Content,
            "is negative, and maps in rgba8 hold no distances within a solid; take r16, r32 or the solver quadric",
        )
        .at_key("extend"));
    }
    Ok(())
}

/// The block of one copy of `object` in a view. World coordinates are subtracted here, in double
/// precision.
#[allow(clippy::cast_possible_truncation)]
pub(crate) fn instance_block(
    object: &Object,
    placement: &Placement,
    number: u32,
    view: &View,
) -> InstanceBlock {
    let rotation = placement.rotation.normalize();
    let [x, y] = object.axis_offset();
    let p = placement.position - view.eye;
    let middle = p + rotation * (placement.scale * DVec3::new(0.0, 0.0, 0.5));
    let depth = middle.dot(view.forward);
    let clip = view.clip_of(middle);
    let to_plane = view.dir_00 * depth.max(0.0);
    let origin = rotation.conjugate() * (to_plane - p) / placement.scale - DVec3::new(x, y, 0.0);
    let (p, s, q, o) = (
        p.as_vec3(),
        placement.scale.as_vec3(),
        rotation.as_quat(),
        origin.as_vec3(),
    );
    InstanceBlock {
        position_sx: [p.x, p.y, p.z, s.x],
        rotation: q.to_array(),
        scale_depth: [s.y, s.z, depth as f32, clip.x as f32],
        origin: [o.x, o.y, o.z, clip.y as f32],
        object: [number, 0, 0, 0],
    }
}

/// The frame's block: eye, rays, lights, depths. `last_record`: first of the records of
/// [`last_block`](super::motion::last_block) among instances.
pub(crate) fn frame_block(view: &View, lighting: &Lighting, last_record: u32) -> FrameBlock {
    let mut lights = [LightBlock::default(); MAX_LIGHTS as usize];
    for (block, light) in lights.iter_mut().zip(&lighting.lights) {
        let towards = -light.direction.normalize_or_zero().as_vec3();
        #[allow(clippy::cast_possible_truncation)]
        let cap = light.cap() as f32;
        block.towards = towards.extend(cap).to_array();
        block.color = [light.color[0], light.color[1], light.color[2], 0.0];
    }
    #[allow(clippy::cast_possible_truncation)]
    let vector = |v: DVec3, w: f64| v.as_vec3().extend(w as f32).to_array();
    let [constant, factor] = view.depth;
    let (sense, near_value) = match view.order {
        DepthOrder::Normal => (1.0, 0.0),
        DepthOrder::Reversed => (-1.0, 1.0),
    };
    let [clip_x, clip_y] = view.clip_rows();
    let [red, green, blue] = lighting.ambient;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // pixels
    let size = [view.viewport.width, view.viewport.height.abs()].map(|v| v as u32);
    let v = &view.viewport;
    FrameBlock {
        clip_x: vector(clip_x, f64::from(u8::from(view.parallel))),
        clip_y: vector(clip_y, view.near),
        dir_00: vector(view.dir_00, view.pixel_size()),
        dir_x: vector(view.dir_x, constant),
        dir_y: vector(view.dir_y, factor),
        forward: vector(view.forward, sense),
        ambient: [red, green, blue, near_value],
        size: [
            size[0],
            size[1],
            u32::try_from(lighting.lights.len()).unwrap_or(MAX_LIGHTS),
            last_record,
        ],
        #[allow(clippy::cast_possible_truncation)]
        pixels: [
            (2.0 / v.width) as f32,
            (-2.0 * v.x / v.width - 1.0) as f32,
            (2.0 / v.height) as f32,
            (-2.0 * v.y / v.height - 1.0) as f32,
        ],
        lights,
        ..bytemuck::Zeroable::zeroed()
    }
}

/// Adds the root of the hierarchy of copies that cast shadows. `maps`: number of shape maps.
pub(crate) fn add_casters(to: &mut FrameBlock, all: &Hierarchy, eye: DVec3, maps: usize) {
    let with = |[x, y, z]: [f32; 3], bits: u32| [x, y, z, f32::from_bits(bits)];
    let root = all.nodes.first().copied().unwrap_or(Hierarchy::EMPTY);
    let from_origin = (eye - all.origin).as_vec3().to_array();
    to.caster_eye = with(from_origin, maps as u32);
    to.caster_middle = with(root.middle, all.nodes.len() as u32);
    to.caster_half_size = with(root.half_size, root.instance);
}

/// Returns an error for more lights than shaders hold.
pub(crate) fn check_lights(lighting: &Lighting) -> Result<()> {
    let (count, most) = (lighting.lights.len(), MAX_LIGHTS);
    if count > most as usize {
        let message = format!("{count} lights; at most {most} are drawn");
        return Err(Error::new(ErrorKind::Content, message).at_key("light"));
    }
    Ok(())
}
