//! Data that the CPU passes to the GPU. The GLSL documents the members; a test compares the layouts.

use super::generated::MAX_LIGHTS;
use bytemuck::{Pod, Zeroable};

/// Structures of 32-bit words in the layout of the GLSL, with the offsets of their members.
macro_rules! blocks {
    ($(
        $(#[$about:meta])*
        $name:ident { $($member:ident: $kind:ty,)* }
    )*) => {$(
        $(#[$about])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        #[allow(missing_docs)]
        pub struct $name {
            $(pub $member: $kind,)*
        }

        #[cfg(test)]
        impl $name {
            /// The members and their offsets, bytes.
            pub const OFFSETS: &[(&str, usize)] =
                &[$((stringify!($member), std::mem::offset_of!($name, $member))),*];
        }
    )*};
}

blocks! {
    /// `Light` of `core/blocks.glsl`.
    LightBlock {
        towards: [f32; 4],
        color: [f32; 4],
    }

    /// `Frame` of `core/blocks.glsl`.
    FrameBlock {
        clip_x: [f32; 4],
        clip_y: [f32; 4],
        dir_00: [f32; 4],
        dir_x: [f32; 4],
        dir_y: [f32; 4],
        forward: [f32; 4],
        ambient: [f32; 4],
        size: [u32; 4],
        pixels: [f32; 4],
        caster_eye: [f32; 4],
        caster_middle: [f32; 4],
        caster_half_size: [f32; 4],
        view: [u32; 4],
        lights: [LightBlock; MAX_LIGHTS as usize],
    }

    /// `Instance` of `core/blocks.glsl`, as the eye sees it.
    InstanceBlock {
        position_sx: [f32; 4],
        rotation: [f32; 4],
        scale_depth: [f32; 4],
        origin: [f32; 4],
        object: [u32; 4],
    }

    /// `Object` of `core/blocks.glsl`.
    ObjectBlock {
        map: [f32; 4],
        bounds: [f32; 4],
        offset: [f32; 4],
        axis: [f32; 4],
        albedo: [f32; 4],
        specular: [f32; 4],
        texturing: [f32; 4],
        cells: [u32; 4],
        instances: [u32; 4],
        patches: [u32; 4],
        parts: [u32; 4],
        levels: [u32; 4],
    }

    /// `CasterNode` of `core/shadow.glsl`.
    CasterNode {
        middle: [f32; 3],
        next: u32,
        half_size: [f32; 3],
        instance: u32,
    }
}

/// Bytes from one object to the next: the largest alignment of offsets in a uniform buffer that a
/// device may have.
pub const OBJECT_STRIDE: u32 = 256;

/// `Pushed` of `stage/compute.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Pushed {
    /// Index of the first record.
    pub first: u32,
    /// Number of records.
    pub count: u32,
    /// First word of the heads of their bins.
    pub heads: u32,
    /// First word of the records of their bins.
    pub records: u32,
    /// Index of the bin that is read.
    pub bin: u32,
    /// Index of the only object.
    pub object: u32,
    /// Index of its only copy.
    pub instance: u32,
}
