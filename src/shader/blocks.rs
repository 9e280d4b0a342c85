//! Data that the CPU passes to the GPU: the structures of `include/core/structures.glsl`.

pub use super::generated::{
    Appearance as AppearanceBlock, BinTile, CasterRoot, Frame as FrameView,
    FrameData as FrameBlock, Instance as InstanceBlock, LastCopy, LevelTables, Light as LightBlock,
    Object as ObjectBlock, PlacedEye, Pushed, Shape as ShapeBlock, WalkNode,
};

use super::generated::{INSTANCE_WORDS, OBJECT_STRIDE_WORDS, OBJECT_WORDS};

/// Bytes from one object to the next.
pub const OBJECT_STRIDE: u32 = 4 * OBJECT_STRIDE_WORDS;

const _: () = assert!(size_of::<InstanceBlock>() == 4 * INSTANCE_WORDS as usize);
const _: () = assert!(size_of::<LastCopy>() == size_of::<InstanceBlock>());
const _: () = assert!(size_of::<ObjectBlock>() == 4 * OBJECT_WORDS as usize);
