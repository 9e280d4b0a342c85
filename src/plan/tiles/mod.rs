//! Tiles of the screen and the copies that each may show, nearest first, for all objects and copies
//! of a frame.
//!
//! 1. Clusters of neighbouring copies are projected to the picture ([`bounds`]) and sorted,
//!    nearest first ([`candidates`]).
//! 2. Clusters are opened from the nearest to the farthest, except for wholly hidden ones
//!    ([`strip`]). A copy of an opened cluster gets a rectangle of pixels and a nearest depth. Copies that no pixel's ray can meet are dropped. The others are sorted, nearest
//!    first.
//! 3. In this order, copies are listed in the tiles that may show them ([`outer`]). The pixels that
//!    a copy is sure to hide are marked there ([`cover`]). Later copies are not listed for pixels
//!    where they are wholly behind that copy.
//! 4. The listed copies are distributed to records and queues ([`deal`]).
//!
//! A copy is dropped only where its solid is proven absent, or where solids in front of it are
//! proven present. Pictures are identical to unculled ones to the last bit, except for roundings
//! where patches are listed. No data comes from an earlier frame. Strips of the picture, which are
//! columns of tiles from top to bottom, are filled in parallel. Strips have similar loads on a
//! field, where rows near the horizon hold most copies. Records are made in parallel, in bands of
//! rows.

mod bounds;
mod candidates;
mod cover;
mod deal;
mod outer;
mod quads;
mod strip;

pub(crate) use bounds::{Cylinder, Projector};
pub(crate) use deal::LEAST_QUEUE;

use super::view::View;
use crate::scene::{Copies, Placement};
use crate::solid::offset_surface::OffsetSurface;
use crate::surface::{InnerCylinders, OuterCylinders};
use candidates::{Candidates, CopyFacts};
use deal::{BandRecords, Dealer};
use rayon::prelude::*;
use std::ops::Range;
use strip::Strip;

/// Copies of one object.
pub(crate) struct Batch<'a> {
    pub placements: Placements<'a>,
    /// The number of its first copy among all instances.
    pub first: u32,
    pub shape: Cylinder,
    /// Cylinders inside the solid, which hide everything behind them; none if unknown.
    pub inner: Option<&'a InnerCylinders>,
    /// Cylinders around the solid, and a margin in object units; none if only its bounding cylinder
    /// is known.
    pub outer: Option<(&'a OuterCylinders, f64)>,
    /// The surface; none unless its patches are searched and there are no replicas.
    pub surface: Option<&'a OffsetSurface>,
    /// Half of the box's side.
    pub half_side: f64,
    /// True if patches may be listed for its tiles in some views.
    pub permits_lists: bool,
}

/// The placements of an object's copies.
#[derive(Clone, Copy)]
pub(crate) enum Placements<'a> {
    One(&'a Placement),
    Many(&'a Copies),
}

/// A copy that some pixel may show. Items are sorted by these values, in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Item {
    /// Bits of the nearest depth, which is not negative, so their order is the order of depths.
    near: u32,
    batch: u32,
    copy: u32,
    pixels: [u16; 4],
    /// Rank in the order of the batch's clusters.
    rank: u32,
}

/// Rows of tiles in a band, and columns in a block. The records of a block are contiguous.
const BLOCK: u32 = 8;

/// The visible copies of batches in a view, tile by tile.
pub(crate) struct Visible<'a> {
    batches: &'a [Batch<'a>],
    strips: Vec<Strip<'a>>,
    facts: Vec<CopyFacts>,
    /// Number of tiles across and down.
    size: [u32; 2],
    picture: [u32; 4],
}

/// The shader stage that draws tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drawer {
    /// Fragments of tiles.
    Fragments,
    /// Work groups.
    Groups,
}

/// Records of all tiles and queues of copies, in the layout of the shaders' single buffer of words
/// (`tile_words.glsl`).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TileWords {
    pub words: Vec<u32>,
    pub layers: Vec<LayerTiles>,
}

/// The records of objects that share a pipeline and a set of textures. Ranges count records of four
/// words each.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LayerTiles {
    /// Fragments: quads of one copy each.
    pub quads: Range<u32>,
    /// Compute: tiles of one copy each, with lists of patches. In all layers, no two tiles that
    /// have a single copy share pixels. The tiles are drawn before tiles of several copies.
    pub listed: Range<u32>,
    /// Compute: tiles of one copy each, without lists of patches.
    pub single: Range<u32>,
    /// Tiles with queues of copies, and in compute records of pixels.
    pub queued: Range<u32>,
}

impl LayerTiles {
    /// Turns tiles with lists of patches into tiles without. The two ranges are neighbours.
    pub fn unlist(&mut self) {
        self.single.start = self.listed.start;
        self.listed.end = self.listed.start;
    }
}

impl<'a> Visible<'a> {
    /// The visible copies of these batches in a perspective view.
    pub fn new(view: &View, projector: &'a Projector, batches: &'a [Batch<'a>]) -> Self {
        debug_assert!(!view.parallel);
        Self::of(&Candidates::new(projector, batches), |strip, candidates| {
            strip.fill(candidates);
        })
    }

    /// Collects the copies that `fill` lists in the strips of the picture.
    fn of(
        candidates: &Candidates<'a>,
        fill: impl Fn(&mut Strip<'a>, &Candidates<'a>) + Sync,
    ) -> Self {
        let projector = candidates.projector;
        let size = projector.tiles();
        // Several strips per thread, as some take longer.
        let strip = size[0].div_ceil(4 * rayon::current_num_threads() as u32);
        let strip = strip.next_multiple_of(BLOCK);
        let starts: Vec<u32> = (0..size[0]).step_by(strip as usize).collect();
        let filled = |&left: &u32| {
            let columns = left..(left + strip).min(size[0]);
            let mut strip = Strip::new(projector, candidates.batches, columns, size);
            fill(&mut strip, candidates);
            strip
        };
        let strips = starts.par_iter().map(filled).collect();
        Self {
            batches: candidates.batches,
            strips,
            facts: candidates.facts(),
            size,
            picture: projector.picture(),
        }
    }

    /// True if the eye is outside of all copies of a batch.
    pub fn is_apart(&self, batch: usize) -> bool {
        self.facts[batch].apart
    }

    /// True if patches are listed for a batch's tiles in this view.
    pub fn lists_patches(&self, batch: usize) -> bool {
        let facts = &self.facts[batch];
        self.batches[batch].permits_lists && facts.apart && facts.even
    }

    /// The copies of each batch that may show, in ascending order.
    pub fn copies(&self) -> Vec<Vec<u32>> {
        let mut all: Vec<_> = self.strips.iter().flat_map(|s| &s.copies).collect();
        all.par_sort_unstable();
        all.dedup();
        let mut copies = vec![Vec::new(); self.batches.len()];
        for (batch, copy) in all {
            copies[*batch as usize].push(*copy);
        }
        copies
    }

    /// Distributes the visible copies to records. `layer_of`: the layer of each batch. `queues`: for
    /// each layer, true if fragments may search queues.
    pub fn deal(&self, drawer: Drawer, layer_of: &[u32], queues: &[bool]) -> TileWords {
        let layers = queues.len();
        let [across, down] = self.size;
        let lists: Vec<bool> = (0..self.batches.len())
            .map(|b| drawer == Drawer::Groups && self.lists_patches(b))
            .collect();
        let single: Vec<bool> = self
            .batches
            .iter()
            .map(|b| b.placements.len() == 1)
            .collect();
        let of_band = |band: u32| {
            let corner = |tile: u32| {
                let [block, at] = [tile / (BLOCK * BLOCK), tile % (BLOCK * BLOCK)];
                [block * BLOCK + at % BLOCK, band * BLOCK + at / BLOCK]
            };
            let listed = self.strips.iter().map(|s| &s.listed[band as usize][..]);
            let dealer = Dealer {
                drawer,
                layer_of,
                lists: &lists,
                single: &single,
                queues,
                picture: self.picture,
            };
            let tiles = across.next_multiple_of(BLOCK) * BLOCK;
            dealer.deal(&listed.collect::<Vec<_>>().concat(), tiles, layers, corner)
        };
        let bands: Vec<Vec<BandRecords>> = (0..down.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_band)
            .collect();
        join(&bands, layers)
    }
}

/// Joins the records and queues of all bands to one buffer.
fn join(bands: &[Vec<BandRecords>], layers: usize) -> TileWords {
    let mut records: Vec<[u32; 4]> = Vec::new();
    let mut lists = 0;
    let mut all = Vec::with_capacity(layers);
    for layer in 0..layers {
        let mut put = |of: for<'b> fn(&'b BandRecords) -> &'b [[u32; 4]]| {
            let first = records.len() as u32;
            for band in bands {
                records.extend(of(&band[layer]));
            }
            first..records.len() as u32
        };
        let (quads, listed, single) = (put(|l| &l.quads), put(|l| &l.listed), put(|l| &l.single));
        let first = records.len() as u32;
        for band in bands {
            let of = |[corner, list, count, near]: &[u32; 4]| {
                [*corner, list + lists as u32, *count, *near]
            };
            records.extend(band[layer].queued.iter().map(of));
            lists += band[layer].words.len();
        }
        all.push(LayerTiles {
            quads,
            listed,
            single,
            queued: first..records.len() as u32,
        });
    }
    // Queues follow all records.
    let behind = 4 * records.len() as u32;
    for layer in &all {
        for record in &mut records[layer.queued.start as usize..layer.queued.end as usize] {
            record[1] += behind;
        }
    }
    let mut words = Vec::with_capacity(behind as usize + lists);
    words.extend(records.as_flattened());
    for layer in 0..layers {
        for band in bands {
            words.extend(&band[layer].words);
        }
    }
    TileWords { words, layers: all }
}
