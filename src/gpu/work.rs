//! What one object's draw or dispatch is.

use super::bins::Rectangle;
use ash::vk;
use std::ops::Range;

/// One draw or dispatch: instances that share shape, look and variant.
pub(crate) struct Batch {
    /// Among those of all batches.
    pub instances: Range<u32>,
    /// Bytes before its block.
    pub block_offset: u32,
    /// Bytes before its tables.
    pub tables_offset: u32,
    pub pipeline: vk::Pipeline,
    pub textures: vk::DescriptorSet,
    pub work: Work,
}

/// How a batch is drawn: the first three in the fragment stage, the others in compute.
#[derive(Clone, Debug)]
pub(crate) enum Work {
    /// Every instance's box.
    Box,
    /// Every instance's hull.
    Hull {
        /// How many corners its triangles have.
        corners: u32,
    },
    /// Every instance's mesh.
    Mesh,
    /// None of it shows.
    Nothing,
    /// Of a single instance: its work groups.
    Rectangle(Rectangle),
    /// Of several: those bins.
    Bins(Range<u32>),
    /// Of a single instance: the work groups that beams list.
    Beams {
        /// What they choose from.
        rectangle: Rectangle,
        /// The pipeline that lists them.
        list: vk::Pipeline,
        /// The word where their list begins.
        at: u32,
    },
}
