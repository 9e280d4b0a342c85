//! Data that the CPU passes to the GPU. A test compares the layouts with `blocks.glsl`.

use super::generated::{CROWD_PIECES, MAX_LIGHTS};
use bytemuck::{Pod, Zeroable};

/// `Light` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct LightBlock {
    /// Unit vector from the surface to the light; w: 1 - cos of its angular radius.
    pub towards: [f32; 4],
    /// Linear RGB.
    pub color: [f32; 4],
}

/// `FrameBlock` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FrameBlock {
    /// Clip x of a displacement in the world; w: 1 if rays are parallel.
    pub clip_x: [f32; 4],
    /// Clip y; w: depth of the near plane.
    pub clip_y: [f32; 4],
    /// Ray through the centre of pixel (0, 0), forward component 1; w: a pixel's size at unit
    /// depth.
    pub dir_00: [f32; 4],
    /// Change of `dir_00` per column; w: the constant of depth = w + `dir_y.w` / t.
    pub dir_x: [f32; 4],
    /// Change of `dir_00` per row; w: see `dir_x`.
    pub dir_y: [f32; 4],
    /// Unit vector; w: 1 if depth grows away from the eye, -1 if it falls.
    pub forward: [f32; 4],
    /// Linear RGB; w: depth value of the near plane.
    pub ambient: [f32; 4],
    /// Width, height, number of lights, first record of the last frame's placements among instances.
    pub size: [u32; 4],
    /// Clip x is x of a pixel's corner times the first value, plus the second. Clip y is y times
    /// the third value, plus the fourth.
    pub pixels: [f32; 4],
    /// The eye, from the origin of the hierarchy of casters; bits of the number of shape maps.
    pub caster_eye: [f32; 4],
    /// Root of the hierarchy: the middle of its box; bits of the number of all nodes.
    pub caster_middle: [f32; 4],
    /// Root of the hierarchy: half of its box; bits of its member `instance`.
    pub caster_half_size: [f32; 4],
    /// First: index of the view among those of the pass.
    pub view: [u32; 4],
    /// Only the first `size[2]` lights count.
    pub lights: [LightBlock; MAX_LIGHTS as usize],
}

/// `Instance` of `blocks.glsl`, as the eye sees it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct InstanceBlock {
    /// Position of the middle of the box's lower face, from the eye; scale along x.
    pub position_sx: [f32; 4],
    /// Unit quaternion, x y z w.
    pub rotation: [f32; 4],
    /// Scale along y and z; depth of the box's middle; clip x of the box's middle.
    pub scale_depth: [f32; 4],
    /// Origin of the ray of pixel (0, 0), object space, from the axis at z = 0; clip y of the box's
    /// middle.
    pub origin: [f32; 4],
    /// Number of the instance's object.
    pub object: [u32; 4],
}

/// `Object` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ObjectBlock {
    /// Columns, rows, texel in object units, factor from stored to object units.
    pub map: [f32; 4],
    /// `R`, clip radius about the axis, clip z low and high.
    pub bounds: [f32; 4],
    /// `e`, `b`, `c`; upper limit on the search's steps.
    pub offset: [f32; 4],
    /// Position of the axis, object units from the middle of the box; 1 / length of the outline.
    pub axis: [f32; 4],
    /// Linear RGB.
    pub albedo: [f32; 4],
    /// Strength and shininess; height of the box, and of its part below `z = 0`, in units of the
    /// profile's box.
    pub specular: [f32; 4],
    /// Repetitions along xi and eta; bump depth `a`; `2 R` of the profile's box in its units.
    pub texturing: [f32; 4],
    /// Replicas along x, y, z; bits: reflected along x, y, z.
    pub cells: [u32; 4],
    /// First instance, number of instances, index of the shape map among the maps of shadows,
    /// first vector of all levels' tables.
    pub instances: [u32; 4],
    /// Tables of the quadric search: where they begin, first record, first range, bits of the unit
    /// of `r^2`. Tables of another search: where they begin, and the search's three facts.
    pub patches: [u32; 4],
    /// First frustum of the cells; roughness and metalness, 16 bits each; first vector of the patches
    /// that are listed.
    pub parts: [u32; 4],
}

/// Bytes from one object to the next: the largest alignment of offsets in a uniform buffer that a
/// device may have.
pub const OBJECT_STRIDE: u32 = 256;

/// `CasterNode` of `shadow.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterNode {
    /// The middle of its box, from the origin of the hierarchy.
    pub middle: [f32; 3],
    /// Index of the node after its subtree; of a copy, the index of its shape map.
    pub next: u32,
    pub half_size: [f32; 3],
    /// Index of the copy, or [`INNER_NODE`](super::generated::INNER_NODE).
    pub instance: u32,
}

/// `CrowdBlock` of `crowd.glsl`, before its objects.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CrowdBlock {
    /// Three doubles, and a fourth that is not used.
    pub eye: [u32; 8],
    /// Like `eye`.
    pub forward: [u32; 8],
    /// Like `eye`.
    pub dir_00: [u32; 8],
    /// Like `eye`.
    pub clip_x: [u32; 8],
    /// Like `eye`.
    pub clip_y: [u32; 8],
    /// A point over its depth gives its pixel; w: margin, pixels.
    pub row_x: [f32; 4],
    /// w: lowest pixel position on the x axis.
    pub row_y: [f32; 4],
    /// w: lowest pixel position on the y axis.
    pub row_z: [f32; 4],
    /// The highest pixel position on both axes.
    pub limits: [f32; 4],
    /// First and last pixel: left, top, right, bottom.
    pub picture: [u32; 4],
    /// Tiles across and down, layers, objects.
    pub size: [u32; 4],
    /// Copies, most entries, first words of the head and of the cover.
    pub counts: [u32; 4],
    /// First words of lists of tiles in the bins.
    pub lists: [u32; 4],
    /// First words of lists of copies and of entries in the bins.
    pub copies: [u32; 4],
    /// First words of lists in the tiles; 1 for compute.
    pub tiles: [u32; 4],
    /// First step of depth; rows of groups of a dispatch over pixels.
    pub steps: [u32; 4],
    /// The objects follow.
    pub objects_of: [CrowdObject; 0],
}

/// `CrowdObject` of `crowd.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct CrowdObject {
    /// Axis: two doubles.
    pub axis: [u32; 4],
    /// Axis, radius.
    pub shape: [f32; 4],
    /// Lowest and highest `z`.
    pub heights: [f32; 4],
    /// First copy and end, first instance, number of the object.
    pub copies: [u32; 4],
    /// Layer, number of outer and of inner cylinders.
    pub pieces: [u32; 4],
    /// Limits of the levels of copies.
    pub limits: [f32; 4],
    /// The finest level, number of the block of the next one.
    pub levels: [u32; 4],
    /// Radius, low, high.
    pub outer: [[f32; 4]; CROWD_PIECES as usize],
    /// Radius, low, high.
    pub inner: [[f32; 4]; CROWD_PIECES as usize],
}

/// `Pushed` of `compute.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Pushed {
    /// Number of the first record.
    pub first: u32,
    /// Number of records.
    pub count: u32,
    /// Word of the heads of their bins.
    pub heads: u32,
    /// Word at which the records of their bins begin.
    pub records: u32,
    /// Number of the bin that is read.
    pub bin: u32,
    /// Number of the only object.
    pub object: u32,
    /// Number of the only instance.
    pub instance: u32,
}
