//! What the CPU tells the GPU; the layouts of `blocks.glsl`, compared by a test.

use crate::shader::generated::{MAX_LIGHTS, MAX_SHADOW_BATCHES};
use bytemuck::{Pod, Zeroable};

/// `Light` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct LightBlock {
    /// Unit vector from the surface to the light.
    pub towards: [f32; 4],
    /// Linear RGB.
    pub color: [f32; 4],
}

/// `FrameBlock` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FrameBlock {
    /// Clip x of a way in the world; w: 1 where rays are parallel.
    pub clip_x: [f32; 4],
    /// Clip y; w: depth of the near plane.
    pub clip_y: [f32; 4],
    /// Ray through the centre of pixel (0, 0), forward component 1; w: a pixel's size at unit
    /// depth.
    pub dir_00: [f32; 4],
    /// Its change from column to column; w: the constant of depth = w + `dir_y.w` / t.
    pub dir_x: [f32; 4],
    /// Its change from row to row; w: see `dir_x`.
    pub dir_y: [f32; 4],
    /// Unit; w: 1 where depth grows away from the eye, -1 where it falls.
    pub forward: [f32; 4],
    /// Linear RGB; w: depth value of the near plane.
    pub ambient: [f32; 4],
    /// Width, height, number of lights, unused.
    pub size: [u32; 4],
    /// Clip x is x of a pixel's corner times the first, plus the second; clip y likewise by the
    /// others.
    pub pixels: [f32; 4],
    /// The first `size[2]` count.
    pub lights: [LightBlock; MAX_LIGHTS as usize],
}

/// `Instance` of `blocks.glsl`: as the eye sees it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct InstanceBlock {
    /// Of the middle of the box's lower face, from the eye; scale along x.
    pub position_sx: [f32; 4],
    /// Unit quaternion, x y z w.
    pub rotation: [f32; 4],
    /// Scale along y and z; depth of the box's middle; its clip x.
    pub scale_depth: [f32; 4],
    /// Of the ray of pixel (0, 0), object space, from the axis at z = 0; clip y of the box's
    /// middle.
    pub origin: [f32; 4],
    /// First: number of its solid.
    pub solid: [u32; 4],
}

/// `Solid` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SolidBlock {
    /// Columns, rows, texel in object units, factor from stored to object units.
    pub map: [f32; 4],
    /// `R`, clip radius about the axis, clip z low and high.
    pub bounds: [f32; 4],
    /// `e`, `b`, `c`; bound of the search's steps.
    pub offset: [f32; 4],
    /// Where the axis stands, object units from the middle of the box; 1 / length of the outline.
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
    /// First, number, index of the shape map among those of shadows.
    pub instances: [u32; 4],
    /// Of the quadric search's tables: where they begin, first record, first range, bits of the
    /// unit of `r^2`; of another search's: where they begin, and its three facts.
    pub patches: [u32; 4],
    /// First frustum of its cells; unused; first vector of the patches that are listed; first row
    /// of the box's sides.
    pub hull: [u32; 4],
}

/// Bytes from one solid to the next: the largest alignment of places in a uniform buffer that a
/// device may have.
pub const SOLID_STRIDE: u32 = 256;

/// `ShadowBlock` of `blocks.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ShadowBlock {
    /// Their number.
    pub shadow_batches: [u32; 4],
    /// The first of them count.
    pub shadow_solids: [SolidBlock; MAX_SHADOW_BATCHES as usize],
}
