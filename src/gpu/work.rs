//! What one object's draw or dispatch is.

use super::bins::Rectangle;
use ash::vk;
use std::ops::Range;

/// Most copies of an object to which beams are sent one by one: each costs two dispatches.
pub(crate) const MOST_BEAMED: usize = 64;

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
        /// Runs of its bands that may be seen.
        bands: Vec<Range<u32>>,
    },
    /// Every instance's mesh.
    Mesh,
    /// None of it shows.
    Nothing,
    /// Of a single instance: its work groups.
    Rectangle(Rectangle),
    /// Of several: those bins.
    Bins(Range<u32>),
    /// Of one instance or a few: the work groups that beams list for each.
    Beams {
        /// The pipeline that lists them.
        list: vk::Pipeline,
        /// One an instance that shows.
        copies: Vec<Tiles>,
    },
}

/// The tiles of one instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiles {
    /// What beams choose from.
    pub rectangle: Rectangle,
    /// The word where their list begins.
    pub at: u32,
    /// Bytes before a block that holds this instance.
    pub block_offset: u32,
    /// Among the object's.
    pub instance: usize,
}

/// How an object was drawn, which is chosen anew with every update: [`Renderer::ways`](super::Renderer::ways).
///
/// A search and what it searches are two things: a box may be drawn by any of the searches, a rectangle or bins too; hulls and beams are
/// what [`Solver::Hull`](crate::settings::Solver::Hull) and [`Solver::Live`](crate::settings::Solver::Live) take where they can.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Way {
    /// Not at all: it is beside the picture, or behind the eye. In the fragment stage the rasteriser finds that out, and no object is
    /// `Nothing`.
    Nothing,
    /// Fragment stage: the fragments of its boxes are searched.
    Box,
    /// Fragment stage: by the shells of its pieces; of a search on the map the fragments of its convex hull are searched.
    Hull,
    /// Compute stage, a single copy: the pixels of its rectangle on the screen are searched.
    Rectangle,
    /// Compute stage, several copies: the squares of the screen that they cover are searched.
    Bins,
    /// Compute stage, one copy or a few large ones: the tiles of each rectangle that beams have found to be near the copy are searched.
    Beams,
    /// As triangles.
    Mesh,
}

impl From<&Work> for Way {
    fn from(work: &Work) -> Self {
        match work {
            Work::Nothing => Self::Nothing,
            Work::Box => Self::Box,
            Work::Hull { .. } => Self::Hull,
            Work::Rectangle(_) => Self::Rectangle,
            Work::Bins(_) => Self::Bins,
            Work::Beams { .. } => Self::Beams,
            Work::Mesh => Self::Mesh,
        }
    }
}
