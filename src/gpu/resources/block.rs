//! Conversion of scene values to the blocks that shaders read.

use crate::error::{Result, content};
use crate::gpu::content::entry::{Last, PreparedObject};
use crate::maps::MapFormat;
use crate::plan::casters::Hierarchy;
use crate::plan::{DepthOrder, View};
use crate::scene::{Lighting, Object, Placement};
use crate::settings::{SearchSettings, Solver};
use crate::shader::generated::MAX_LIGHTS;
use crate::shader::{FrameBlock, InstanceBlock, LightBlock};
use glam::{DVec3, DVec4};

/// Returns an error if a map's format cannot show the object's offset.
pub(crate) fn check_format(
    object: &Object,
    solver: Solver,
    settings: &SearchSettings,
) -> Result<()> {
    if solver.reads_map() && settings.map_format == MapFormat::Rgba8 && object.offset.extend < 0.0 {
        let message = "is negative, and maps in rgba8 hold no distances within a solid; take r16, r32 or the solver quadric";
        return content("extend", message);
    }
    Ok(())
}

/// The block of one copy of `object` in a view. World coordinates are subtracted here, in double
/// precision.
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
    let [p, s, o] = [p, placement.scale, origin].map(|v| v.as_vec3());
    InstanceBlock {
        position_sx: [p.x, p.y, p.z, s.x],
        rotation: rotation.as_quat().to_array(),
        scale_depth: [s.y, s.z, depth as f32, clip.x as f32],
        origin: [o.x, o.y, o.z, clip.y as f32],
        object: [number, 0, 0, 0],
    }
}

/// The record from which `motion_of` of `stage/outputs.glsl` projects a point of a copy into the
/// last frame: three rows of the map from object space to `(x w, y w, w)`, then this frame's jitter
/// and the distance along the normal by which the surface was farther out.
///
/// The map is exact. A point moves along its normal if the extension changes, which is exact where
/// the surface keeps its distance to the profile. Motion leaves out a change of bevel or chamfer.
pub(crate) fn last_block(of: &PreparedObject, copy: usize, view: &View) -> InstanceBlock {
    let (object, growth) = (&of.object, of.growth());
    let all = object.placements();
    let last = match &of.last {
        Last::Was(last) => (last.placements(all.len())).map(|all| (&all[copy], last.extend)),
        Last::Same | Last::New => None,
    };
    let (placement, extend) = last.unwrap_or((&all[copy], object.offset.extend));
    let rows = view.last.unwrap_or_else(|| view.pixel_rows());
    // A point `p` of the drawn box is `height p + origin` in the object's own units.
    let height = growth.height();
    let [x, y] = object.axis_offset();
    let rotation = placement.rotation.normalize();
    let moved = |v: DVec3| rotation * (placement.scale * v);
    let origin = placement.position + moved(DVec3::new(x, y, -growth.low));
    let ways = DVec3::AXES.map(|axis| moved(axis * height));
    let [row_x, row_y, row_w] = rows.map(|row| {
        let [a, b, c] = ways.map(|way| row.truncate().dot(way));
        let at = row.dot(origin.extend(1.0));
        DVec4::new(a, b, c, at).as_vec4().to_array()
    });
    let farther = (extend - object.offset.extend) / height;
    // Positions of the shader count from the centre of pixel (0, 0).
    let [jitter_x, jitter_y] = (0.5 - view.jitter).to_array();
    InstanceBlock {
        position_sx: row_x,
        rotation: row_y,
        scale_depth: row_w,
        origin: [jitter_x as f32, jitter_y as f32, farther as f32, 0.0],
        object: [0; 4],
    }
}

/// The frame's block: eye, rays, lights, depths. `last_record`: first of the records of
/// [`last_block`] among instances.
pub(crate) fn frame_block(view: &View, lighting: &Lighting, last_record: u32) -> FrameBlock {
    let vector = |v: DVec3, w: f64| v.as_vec3().extend(w as f32).to_array();
    let mut lights = [LightBlock::default(); MAX_LIGHTS as usize];
    for (block, light) in lights.iter_mut().zip(&lighting.lights) {
        let [red, green, blue] = light.color;
        block.towards = vector(-light.direction.normalize_or_zero(), light.cap());
        block.color = [red, green, blue, 0.0];
    }
    let [constant, factor] = view.clip_depth();
    let [least, most] = view.depth_range;
    let (sense, near_value) = match view.order {
        DepthOrder::Normal => (1.0, 0.0),
        DepthOrder::Reversed => (-1.0, 1.0),
    };
    let [clip_x, clip_y] = view.clip_rows();
    let [red, green, blue] = lighting.ambient;
    let v = &view.viewport;
    let [width, height] = [v.width, v.height.abs()].map(|side| side as u32);
    let lit = u32::try_from(lighting.lights.len()).unwrap_or(MAX_LIGHTS);
    FrameBlock {
        clip_x: vector(clip_x, f64::from(u8::from(view.parallel))),
        clip_y: vector(clip_y, view.near),
        dir_00: vector(view.dir_00, view.pixel_size()),
        dir_x: vector(view.dir_x, constant),
        dir_y: vector(view.dir_y, factor),
        forward: vector(view.forward, sense),
        ambient: [red, green, blue, near_value],
        size: [width, height, lit, last_record],
        pixels: [
            2.0 / v.width,
            -2.0 * v.x / v.width - 1.0,
            2.0 / v.height,
            -2.0 * v.y / v.height - 1.0,
        ]
        .map(|side| side as f32),
        view: [
            0,
            (least as f32).to_bits(),
            ((most - least) as f32).to_bits(),
            (1.0 - near_value).to_bits(),
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
        return content("light", format!("{count} lights; at most {most} are drawn"));
    }
    Ok(())
}
