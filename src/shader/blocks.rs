//! Data that the CPU passes to the GPU: the structures of `include/core/structures.glsl`.

pub use super::generated::{
    Appearance as AppearanceBlock, CasterNode, CasterRoot, CopyTile, Frame as FrameView,
    FrameData as FrameBlock, GatheredPixel, Instance as InstanceBlock, LastCopy,
    Light as LightBlock, Object as ObjectBlock, Pushed, QueueBlock, QueueTile, QueuedCopy,
    Shape as ShapeBlock,
};

/// Bytes from one object to the next: the largest alignment of offsets in a uniform buffer that a
/// device may have.
pub const OBJECT_STRIDE: u32 = 256;

const _: () = assert!(size_of::<ObjectBlock>() <= OBJECT_STRIDE as usize);
