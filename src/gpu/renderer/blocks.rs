//! Conversion of scene values to the blocks that shaders read.

use crate::gpu::content::entry::{Last, PreparedObject};
use crate::gpu::content::view_plan::PlannedObject;
use crate::gpu::vk::output::Output;
use crate::plan::View;
use crate::plan::precedence::lag_depth;
use crate::plan::walk::{Grid, Walks};
use crate::scene::{Lighting, Object, Placement};
use crate::shader::generated::{MAX_LIGHTS, OUTSIDE_BIT, PLACED};
use crate::shader::{
    AppearanceBlock, CasterRoot, FrameBlock, FrameView, InstanceBlock, LastCopy, LevelTables,
    LightBlock, ObjectBlock, PlacedEye, ShapeBlock, is_beveled,
};
use crate::solid::offset_surface::{OffsetSurface, Part};
use glam::{DVec2, DVec3, DVec4, Vec3};
use std::sync::Arc;

/// The block of one copy of `object` in a view. World coordinates are subtracted here, in double
/// precision.
pub(super) fn instance_block(
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
    let [position, scale, origin] = [p, placement.scale, origin].map(|v| v.as_vec3().to_array());
    InstanceBlock {
        position,
        depth: depth as f32,
        scale,
        clip_x: clip.x as f32,
        rotation: rotation.as_quat().to_array(),
        origin,
        clip_y: clip.y as f32,
        object: number,
        ..InstanceBlock::default()
    }
}

/// The parts of a number whose sum it is, to the last bit, but for numbers that 32 bits cannot hold.
/// `digits` leaves the first bits of each.
fn parts(vector: DVec3, digits: impl Fn(f32) -> f32) -> [[f32; 3]; 3] {
    let mut rest = vector;
    std::array::from_fn(|_| {
        let part = rest.as_vec3().to_array().map(&digits);
        rest -= Vec3::from(part).as_dvec3();
        part
    })
}

/// The block of one copy that the device places (`place.comp`), which depends on no view.
pub(super) fn placed_block(placement: &Placement, number: u32) -> InstanceBlock {
    let [position, origin, [depth, clip_x, clip_y]] = parts(placement.position, |part| part);
    InstanceBlock {
        position,
        depth,
        scale: placement.scale.as_vec3().to_array(),
        clip_x,
        rotation: placement.rotation.normalize().as_quat().to_array(),
        origin,
        clip_y,
        object: number,
        table: PLACED,
        ..InstanceBlock::default()
    }
}

/// The eye for copies that the device places. `grid`: that of the hierarchies that rays walk.
pub(super) fn placed_eye(view: &View, grid: &Grid) -> PlacedEye {
    let [high, middle, low] = parts(view.eye, |part| part);
    let cut = |part: f32| f32::from_bits(part.to_bits() & 0xffff_f000);
    let [dir_high, dir_middle, _] = parts(view.dir_00, cut);
    let [high_part, middle_part] = [dir_high, dir_middle].map(|part| Vec3::from(part).as_dvec3());
    let at = (view.eye - grid.low) / grid.unit;
    // Roundings of the eye's position, and of directions from a far eye.
    let margin = DVec3::splat(1.0) + 1e-6 * at.abs();
    let vector = |v: DVec3| v.as_vec3().to_array();
    PlacedEye {
        high,
        middle,
        low,
        dir_high,
        dir_middle,
        dir_low: vector(view.dir_00 - high_part - middle_part),
        grid_unit: vector(grid.unit),
        grid_low: vector(at + margin),
        grid_high: vector(at - margin),
        ..PlacedEye::default()
    }
}

/// The tables of the levels of an object's copies.
pub(super) fn level_tables(planned: &PlannedObject) -> LevelTables {
    let start = |surface: &Arc<OffsetSurface>| surface.start(Part::Tables);
    let limits = planned.levels.as_ref().map(|levels| levels.limits);
    let at = |level: usize| {
        let surface = planned.surfaces.get(level);
        surface.or(planned.surfaces.last()).map_or(0, start)
    };
    let finest = planned.surfaces.first();
    LevelTables {
        limits: limits.unwrap_or([f32::INFINITY; 4]),
        tables: std::array::from_fn(at),
        last_table: at(4),
        listed: finest.map_or(0, |surface| surface.start(Part::Patches)),
        ..LevelTables::default()
    }
}

/// The block of an object. `outside`: as in
/// [`FramePlan::outside`](crate::plan::FramePlan::outside).
pub(super) fn object_block(planned: &PlannedObject, outside: bool) -> ObjectBlock {
    let prepared = &*planned.object;
    let derived = &prepared.derived;
    let (object, map) = (prepared.drawn(), &derived.facts);
    let f = |v: f64| v as f32;
    let (look, offset) = (&object.texturing, &object.offset);
    let [half_side, clip_radius, clip_low, clip_high] = prepared.bounds(&planned.surfaces);
    // Textures find the profile's box in a box that has grown.
    let growth = prepared.growth();
    let profile_radius = object.profile.radius * growth.height() - growth.side;
    let mirrored: u32 = (0..3).map(|i| u32::from(object.mirror[i]) << i).sum();
    let finest = planned.surfaces.first();
    let start = |part| finest.map_or(0, |s| s.start(part));
    let stored = finest.filter(|s| s.slot(Part::Tables).is_some());
    let [table_fact_0, table_fact_1, table_fact_2] = stored.map_or([0; 3], |s| s.tables().facts);
    let shape = ShapeBlock {
        map_size: [map.columns, map.rows].map(|n| n as f32),
        texel: f(1.0 / f64::from(map.rows)),
        map_scale: map.scale,
        half_side,
        clip_radius,
        clip_low,
        clip_high,
        extend: f(offset.extend),
        bevel: if is_beveled(object) {
            f(offset.bevel)
        } else {
            0.0
        },
        chamfer: f(offset.chamfer),
        most_steps: derived.steps as f32,
        axis: object.axis_offset().map(f),
        shadow_map: derived.shadow_map,
        first_frustum: start(Part::Frusta),
        replicas: object.repeat,
        flags: mirrored | if outside { OUTSIDE_BIT } else { 0 },
        table_fact_0,
        table_fact_1,
        table_fact_2,
        listed_window: planned.window(Part::Patches).start,
        table_window: planned.window(Part::Tables).start,
        ..ShapeBlock::default()
    };
    let appearance = AppearanceBlock {
        color: object.color,
        material: object.material().bits(),
        specular: object.specular.strength,
        shininess: object.specular.shininess,
        box_height: f(growth.height()),
        box_low: f(growth.low),
        texture_repeat: look.repeat.map(f),
        bump: f(look.bump),
        profile_width: f(2.0 * profile_radius),
        arc_rate: f(1.0 / derived.arc.as_ref().map_or(1.0, |arc| arc.length)),
        first_instance: prepared.instances.start,
        // Textures repeat around the axis: whole ones are left out, for the sake of digits.
        texture_offset: [f((-look.offset[0]).rem_euclid(1.0)), f(look.offset[1])],
    };
    ObjectBlock { shape, appearance }
}

/// The structure from which `motion_of` of `stage/outputs.glsl` projects a point of a copy into the
/// last frame.
///
/// The map is exact. A point moves along its normal if the extension changes, which is exact where
/// the surface keeps its distance to the profile. Motion leaves out a change of bevel or chamfer.
pub(super) fn last_copy(of: &PreparedObject, copy: usize, view: &View) -> LastCopy {
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
    LastCopy {
        row_x,
        row_y,
        row_w,
        jitter: (0.5 - view.jitter).as_vec2().to_array(),
        farther: farther as f32,
        ..LastCopy::default()
    }
}

/// The frame's block: eye, rays, lights, depths. `last_copies`: index of the first [`last_copy`]
/// among instances.
pub(super) fn frame_block(
    view: &View,
    output: &Output,
    lighting: &Lighting,
    last_copies: u32,
) -> FrameBlock {
    let vector = |v: DVec3| v.as_vec3().to_array();
    let mut lights = [LightBlock::default(); MAX_LIGHTS as usize];
    for (block, light) in lights.iter_mut().zip(&lighting.lights) {
        *block = LightBlock {
            towards: vector(-light.direction.normalize_or_zero()),
            cap: light.cap() as f32,
            color: light.color,
            unused: 0.0,
        };
    }
    let sky = lighting.environment.map(|e| [e.up, e.down]);
    let [sky_up, sky_down] = sky.unwrap_or_default().map(|[r, g, b]| [r, g, b, 0.0]);
    let [constant, factor] = view.clip_depth();
    let [least, most] = view.depth_range;
    let [near_depth, sense] = view.order.near_and_sense().map(|value| value as f32);
    let [clip_x, clip_y] = view.clip_rows();
    let v = &view.viewport;
    let [width, height] = [v.width, v.height.abs()].map(|side| side as u32);
    let sides = DVec2::new(v.width, v.height);
    let frame = FrameView {
        clip_x: vector(clip_x),
        parallel: f32::from(u8::from(view.parallel)),
        clip_y: vector(clip_y),
        near: view.near as f32,
        dir_00: vector(view.dir_00),
        pixel_size: view.pixel_size() as f32,
        dir_x: vector(view.dir_x),
        depth_constant: constant as f32,
        dir_y: vector(view.dir_y),
        depth_factor: factor as f32,
        forward: vector(view.forward),
        depth_sense: sense,
        ambient: lighting.ambient,
        near_depth,
        size: [width, height],
        light_count: u32::try_from(lighting.lights.len()).unwrap_or(MAX_LIGHTS),
        last_copies,
        clip_scale: (2.0 / sides).as_vec2().to_array(),
        clip_shift: (-2.0 * DVec2::new(v.x, v.y) / sides - 1.0)
            .as_vec2()
            .to_array(),
    };
    FrameBlock {
        frame,
        first_depth: least as f32,
        depth_range: (most - least) as f32,
        far_depth: 1.0 - near_depth,
        ray_width: (view.ray_width * output.ray_width()) as f32,
        ray_start: view.start as f32,
        lag_depth: lag_depth(view).map(|part| part as f32),
        lights,
        sky_up,
        sky_down,
        ..FrameBlock::default()
    }
}

/// The root of the hierarchy of copies that cast shadows; without copies a box that no ray meets.
/// `maps`: number of shape maps.
pub(super) fn caster_root(walks: &Walks, eye: DVec3, maps: usize) -> CasterRoot {
    let Some(root) = walks.casters else {
        return CasterRoot {
            half_size: [-1e30; 3],
            ..CasterRoot::default()
        };
    };
    let (heap, grid) = (&walks.nodes[root as usize..], &walks.grid);
    let [low, high] = [0, 16].map(|shift| {
        let steps = heap[1].bounds.map(|ends| f64::from(ends >> shift & 0xffff));
        grid.unit * DVec3::from(steps)
    });
    let vector = |v: DVec3| v.as_vec3().to_array();
    CasterRoot {
        eye: vector(eye - grid.low),
        map_count: maps as u32,
        middle: vector(0.5 * (low + high)),
        root,
        half_size: vector(0.5 * (high - low)),
        only_copy: heap[1].index,
    }
}
