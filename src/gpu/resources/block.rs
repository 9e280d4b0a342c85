//! Conversion of scene values to the blocks that shaders read.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::resources::shape_texture::MapFacts;
use crate::maps::MapFormat;
use crate::plan::{DepthOrder, View};
use crate::scene::{Growth, Lighting, Object, Placement};
use crate::settings::{SearchSettings, Solver};
use crate::shader::generated::MAX_LIGHTS;
use crate::shader::is_beveled;
use crate::shader::{FrameBlock, InstanceBlock, LightBlock, SolidBlock};
use crate::solid::reach::{farthest_corner, largest_width};
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

/// The object's block. `instances` is the range of its copies, `shadow_map` the index of its map
/// among the maps that shadows read.
pub(crate) fn solid_block(
    object: &Object,
    map: &MapFacts,
    arc_length: f64,
    instances: &std::ops::Range<u32>,
    shadow_map: u32,
    solver: Solver,
    settings: &SearchSettings,
) -> SolidBlock {
    let texel = 1.0 / f64::from(map.rows);
    let width = largest_width(&object.offset);
    let grow = width.max(0.0) + texel;
    let [x, y] = object.axis_offset();
    // The map gives no values beyond its last column.
    let reach = if solver.reads_map() {
        f64::from(map.columns) * texel
    } else {
        f64::INFINITY
    };
    let clip = (map.bounds.r_max + grow)
        .min(farthest_corner(object) + texel)
        .min(reach);
    #[allow(clippy::cast_possible_truncation)]
    let f = |v: f64| v as f32;
    let look = &object.texturing;
    let beveled = is_beveled(object);
    let steps = settings
        .max_steps
        .unwrap_or_else(|| solver.default_steps(beveled))
        .max(1);
    let mirrored = (0..3).map(|i| u32::from(object.mirror[i]) << i).sum();
    SolidBlock {
        #[allow(clippy::cast_precision_loss)] // at most 16384
        map: [map.columns as f32, map.rows as f32, f(texel), map.scale],
        bounds: [
            f(object.profile.radius),
            f(clip),
            f((map.bounds.z_min - grow).max(0.0)),
            f((map.bounds.z_max + grow).min(1.0)),
        ],
        offset: [
            f(object.offset.extend),
            if beveled { f(object.offset.bevel) } else { 0.0 },
            f(object.offset.chamfer),
            #[allow(clippy::cast_precision_loss)] // at most 65536
            {
                steps as f32
            },
        ],
        axis: [f(x), f(y), f(1.0 / arc_length), 0.0],
        albedo: [object.color[0], object.color[1], object.color[2], 1.0],
        specular: [
            object.specular.strength,
            object.specular.shininess,
            1.0,
            0.0,
        ],
        texturing: [
            f(look.repeat[0]),
            f(look.repeat[1]),
            f(look.bump),
            f(2.0 * object.profile.radius),
        ],
        cells: [
            object.repeat[0],
            object.repeat[1],
            object.repeat[2],
            mirrored,
        ],
        instances: [
            instances.start,
            instances.end - instances.start,
            shadow_map,
            0,
        ],
        patches: [0; 4],
        hull: [0; 4],
    }
}

/// Adds the values by which textures find the profile's box in a larger box, whose radius is
/// `radius`.
#[allow(clippy::cast_possible_truncation)]
pub(crate) fn note_growth(block: &mut SolidBlock, growth: &Growth, radius: f64) {
    block.specular[2] = growth.height() as f32;
    block.specular[3] = growth.low as f32;
    block.texturing[3] = (2.0 * (radius * growth.height() - growth.side)) as f32;
}

/// The block of one copy of `object` in a view. World coordinates are subtracted here, in double
/// precision.
#[allow(clippy::cast_possible_truncation)]
pub(crate) fn instance_block(
    object: &Object,
    placement: &Placement,
    solid: u32,
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
    let radius = object.profile.radius;
    let reach = (placement.scale * DVec3::new(radius, radius, 1.0)).length() as f32;
    InstanceBlock {
        position_sx: [p.x, p.y, p.z, s.x],
        rotation: q.to_array(),
        scale_depth: [s.y, s.z, depth as f32, clip.x as f32],
        origin: [o.x, o.y, o.z, clip.y as f32],
        solid: [solid, reach.to_bits(), 0, 0],
    }
}

/// The frame's block: eye, rays, lights, depths.
pub(crate) fn frame_block(view: &View, lighting: &Lighting) -> FrameBlock {
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
            0,
        ],
        #[allow(clippy::cast_possible_truncation)]
        pixels: [
            (2.0 / v.width) as f32,
            (-2.0 * v.x / v.width - 1.0) as f32,
            (2.0 / v.height) as f32,
            (-2.0 * v.y / v.height - 1.0) as f32,
        ],
        lights,
    }
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
