//! Batches: from a scene's objects to what one draw or dispatch needs.

use super::blocks::{FrameBlock, InstanceBlock, LightBlock, SolidBlock};
use crate::error::{Error, Result, Stage};
use crate::maps::envelope::Envelope;
use crate::maps::{Bounds, MapFormat, MapSource};
use crate::profile::Profile;
use crate::scene::{CameraFrame, Object, Offset, Placement, Scene};
use crate::settings::{Settings, Solver};
use crate::shader::generated::MAX_LIGHTS;
use glam::{DMat4, DVec3, DVec4};
use std::sync::Arc;

/// What a shape map is baked from; equal keys share a map.
#[derive(Clone)]
pub(crate) struct MapKey {
    pub profile: Arc<Profile>,
    pub rows: u32,
    pub source: MapSource,
    pub reach: f64,
}

impl PartialEq for MapKey {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.profile, &other.profile)
            && self.rows == other.rows
            && self.source == other.source
            && self.reach.to_bits() == other.reach.to_bits()
    }
}

impl MapKey {
    pub fn new(object: &Object, settings: &Settings) -> Self {
        let source = settings.map_source.unwrap_or_default();
        let rows = settings.map_rows.unwrap_or(object.map_rows);
        Self {
            profile: object.profile.clone(),
            rows,
            source,
            reach: reach(object, 2.0 / f64::from(rows.max(1))),
        }
    }

    /// Whether a map of this key serves `object`. One that reaches less far does: the solid is cut where the map ends.
    pub fn fits(&self, object: &Object, settings: &Settings) -> bool {
        let wanted = Self::new(object, settings);
        self.rows == wanted.rows && self.source == wanted.source
    }
}

/// The largest offset that the surface takes in the box.
pub(crate) fn largest_width(offset: &Offset) -> f64 {
    offset.extend + (offset.bevel * offset.chamfer.clamp(0.0, 1.0)).max(0.0)
}

/// How far from the axis the map must reach: to the solid's own radius where that stays within the box's inscribed
/// cylinder about a centred axis, else to what of the solid the box can hold.
fn reach(object: &Object, margin: f64) -> f64 {
    let radius = object.profile.radius;
    let widest = object.profile.outline.bounds().map_or(0.0, |b| b.r_max);
    let solid = widest + largest_width(&object.offset);
    if solid <= radius && axis_offset(object) == [0.0; 2] {
        return radius;
    }
    (solid + margin).min(farthest_corner(object)).max(radius)
}

/// Fails where a map's format cannot show what the object asks for.
pub(crate) fn check_format(number: usize, object: &Object, settings: &Settings) -> Result<()> {
    if settings.solver.reads_map()
        && settings.map_format == MapFormat::Rgba8
        && object.offset.extend < 0.0
    {
        return Err(Error::new(
            Stage::Scene,
            "is negative, and maps in rgba8 hold no distances within a solid; take r16, r32 or the solver quadric",
        )
        .at_key(format!("object.{number}.extend")));
    }
    Ok(())
}

/// Where the axis stands, object units from the middle of the box.
pub(crate) fn axis_offset(object: &Object) -> [f64; 2] {
    object.axis.map(|o| (2.0 * o - 1.0) * object.profile.radius)
}

/// Distance from the axis to the farthest vertical edge of the box.
fn farthest_corner(object: &Object) -> f64 {
    let [x, y] = axis_offset(object).map(f64::abs);
    (x + object.profile.radius).hypot(y + object.profile.radius)
}

/// A shape map on the device, as far as a batch must know it.
#[derive(Clone, Debug)]
pub(crate) struct MapFacts {
    pub columns: u32,
    pub rows: u32,
    pub scale: f32,
    pub bounds: Bounds,
    pub arc_length: f64,
    /// Of a map that is there, and holds the whole solid.
    pub envelope: Option<Arc<Envelope>>,
}

/// The batch's block; `instances` are its range, `shadow_map` its map's index among those that shadows read.
pub(crate) fn solid_block(
    object: &Object,
    map: &MapFacts,
    instances: &std::ops::Range<u32>,
    shadow_map: usize,
    solver: Solver,
) -> SolidBlock {
    let texel = 1.0 / f64::from(map.rows);
    let width = largest_width(&object.offset);
    let grow = width.max(0.0) + texel;
    let [x, y] = axis_offset(object);
    // Where the map ends, what is read from it ends.
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
            f(object.offset.bevel),
            f(object.offset.chamfer),
            f(width),
        ],
        axis: [f(x), f(y), f(1.0 / map.arc_length), 0.0],
        albedo: [object.color[0], object.color[1], object.color[2], 1.0],
        specular: [
            object.specular.strength,
            object.specular.shininess,
            0.0,
            0.0,
        ],
        texturing: [f(look.repeat[0]), f(look.repeat[1]), f(look.bump), 0.0],
        cells: [
            object.repeat[0],
            object.repeat[1],
            object.repeat[2],
            mirrored,
        ],
        instances: [
            instances.start,
            instances.end - instances.start,
            u32::try_from(shadow_map).unwrap_or(0),
            0,
        ],
        pieces: [0; 4],
        hull: [0; 4],
        single: object.placements().first().map(instance_block).unwrap_or_default(),
    }
}

#[allow(clippy::cast_possible_truncation)]
pub(crate) fn instance_block(placement: &Placement) -> InstanceBlock {
    let p = placement.position.as_vec3();
    let q = placement.rotation.normalize();
    let s = placement.scale.as_vec3();
    InstanceBlock {
        position_sx: [p.x, p.y, p.z, s.x],
        rotation: [q.x as f32, q.y as f32, q.z as f32, q.w as f32],
        scale_yz: [s.y, s.z, 0.0, 0.0],
    }
}

/// The frame's block: camera, lights, depth range.
pub(crate) fn frame_block(
    scene: &Scene,
    camera: &CameraFrame,
    size: (u32, u32),
) -> Result<FrameBlock> {
    if scene.lights.len() > MAX_LIGHTS as usize {
        return Err(Error::new(
            Stage::Scene,
            format!(
                "{} lights; at most {MAX_LIGHTS} are drawn",
                scene.lights.len()
            ),
        )
        .at_key("light"));
    }
    let (near, far) = depth_range(scene, camera);
    // depth = constant + factor / t
    let constant = far / (far - near);
    let factor = -far * near / (far - near);

    let pixel = camera.right.length();
    let right = camera.right / (pixel * pixel * camera.middle[0]);
    let down = -camera.up / (pixel * pixel * camera.middle[1]);
    let row = |v: DVec3| DVec4::new(v.x, v.y, v.z, -v.dot(camera.eye));
    let depth_row = row(camera.forward);
    let clip_from_world = DMat4::from_cols(
        row(right),
        row(down),
        depth_row * constant + DVec4::W * factor,
        depth_row,
    )
    .transpose()
    .as_mat4();

    let mut lights = [LightBlock::default(); MAX_LIGHTS as usize];
    for (block, light) in lights.iter_mut().zip(&scene.lights) {
        let towards = -light.direction.normalize_or_zero().as_vec3();
        block.towards = towards.extend(0.0).to_array();
        block.color = [light.color[0], light.color[1], light.color[2], 0.0];
    }
    #[allow(clippy::cast_possible_truncation)]
    let vector = |v: DVec3, w: f64| v.as_vec3().extend(w as f32).to_array();
    Ok(FrameBlock {
        clip_from_world: clip_from_world.to_cols_array_2d(),
        eye: vector(camera.eye, near),
        dir_00: vector(camera.pixel(0, 0), pixel),
        dir_x: vector(camera.right, constant),
        dir_y: vector(-camera.up, factor),
        forward: vector(camera.forward, 0.0),
        ambient: [scene.ambient[0], scene.ambient[1], scene.ambient[2], 0.0],
        size: [
            size.0,
            size.1,
            u32::try_from(scene.lights.len()).unwrap_or(MAX_LIGHTS),
            0,
        ],
        lights,
    })
}

/// Depths between which every box lies; near is never closer than a ten-thousandth of far.
fn depth_range(scene: &Scene, camera: &CameraFrame) -> (f64, f64) {
    let mut low = f64::INFINITY;
    let mut high: f64 = 0.0;
    for object in &scene.objects {
        // Corners of hulls stand out a little, those of convex ones by some texels more.
        let radius = 1.04 * object.profile.radius + 0.02;
        let half = DVec3::new(radius, radius, 0.502);
        for p in object.placements() {
            let middle = p.position + p.rotation * (p.scale * DVec3::new(0.0, 0.0, 0.5));
            let depth = (middle - camera.eye).dot(camera.forward);
            let reach = (p.rotation.conjugate() * camera.forward * p.scale)
                .abs()
                .dot(half);
            low = low.min(depth - reach);
            high = high.max(depth + reach);
        }
    }
    if high <= 0.0 {
        return (1.0, 2.0);
    }
    let far = high * 1.001;
    ((low * 0.999).max(far * 1e-4), far)
}
