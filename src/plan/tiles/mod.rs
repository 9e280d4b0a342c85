//! Tiles of the screen and the copies that each may show, nearest first: one list for all objects
//! and copies of a frame.
//!
//! 1. Clusters of copies that stand near each other are found in the picture ([`cluster_bounds`])
//!    and sorted, the nearest first ([`candidates`]).
//! 2. From the nearest to the farthest they are opened, but for those that are hidden as a whole
//!    ([`strip`]): of each copy a rectangle of pixels and the nearest depth are found ([`bounds`]);
//!    copies that no pixel's ray can meet are left out, and the others sorted, the nearest first.
//! 3. In this order they are listed in the tiles in which they may show ([`outer`]). What a copy is
//!    sure to hide is marked there ([`cover`]), and later copies are not listed for pixels in which
//!    all of them lies behind it.
//! 4. What is listed is dealt out to records ([`deal`], [`quads`]).
//!
//! A copy is left out only where its solid is proven not to be, or solids that it lies behind are
//! proven to be: pictures are those of unculled copies to the last bit, or but for roundings where
//! patches are listed. Nothing is taken from an earlier frame. Strips of the picture are filled in
//! parallel, columns of tiles from top to bottom: on a field they are all alike, where rows near
//! the horizon hold most copies. Records are made in parallel in bands of rows.

mod bounds;
mod candidates;
mod cluster_bounds;
mod cover;
mod deal;
mod outer;
mod quads;
mod strip;

pub(crate) use bounds::{Cylinder, Projector};

use super::view::View;
use crate::scene::{Copies, Placement};
use crate::solid::offset_surface::OffsetSurface;
use crate::surface::{InnerCylinders, OuterCylinders};
use candidates::{Candidates, CopyFacts};
use cover::{SIDE, within};
use deal::{BandLists, Dealer};
use rayon::prelude::*;
use std::ops::Range;
use strip::Strip;

/// Copies of one object.
pub(crate) struct Batch<'a> {
    pub placements: Placements<'a>,
    /// The number of the first among all instances.
    pub first: u32,
    pub shape: Cylinder,
    /// What each is sure to hide; none where that is not known.
    pub inner: Option<&'a InnerCylinders>,
    /// Where each can show, and by how many object units more; none where its cylinder alone is
    /// known.
    pub outer: Option<(&'a OuterCylinders, f64)>,
    /// The surface, where patches of it are searched and there are no replicas.
    pub surface: Option<&'a OffsetSurface>,
    /// Half of the box's side.
    pub half_side: f64,
    /// Whether patches may be listed for its tiles.
    pub lists: bool,
}

/// Where the copies of an object stand.
#[derive(Clone, Copy)]
pub(crate) enum Placements<'a> {
    One(&'a Placement),
    Many(&'a Copies),
}

/// A copy that some pixel may show. They are sorted by these values, in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Item {
    /// Bits of the nearest depth: not negative, so they order as it does.
    near: u32,
    batch: u32,
    copy: u32,
    pixels: [u16; 4],
    /// Among the batch's clusters.
    place: u32,
}

/// Rows of tiles in a band, and columns in a block: the records of a block follow each other.
const BLOCK: u32 = 8;

/// What a view shows of batches, tile by tile.
pub(crate) struct Visible<'a> {
    batches: &'a [Batch<'a>],
    strips: Vec<Strip<'a>>,
    facts: Vec<CopyFacts>,
    /// Tiles across and down.
    size: [u32; 2],
    picture: [u32; 4],
}

/// What draws tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Drawer {
    /// Fragments, drawn for quads of a few pixels.
    Fragments,
    /// Work groups; `lists`: patches may be listed for tiles of one copy.
    Groups { lists: bool },
}

/// Records of all tiles and their lists, as the shaders' one buffer of words holds them
/// (`tile_words.glsl`).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TileWords {
    pub words: Vec<u32>,
    pub layers: Vec<LayerTiles>,
}

/// The records of objects that are drawn by one pipeline and one set of textures; numbers of four
/// words each.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct LayerTiles {
    /// Fragments: quads of one copy each.
    pub quads: Range<u32>,
    /// Compute: tiles of one copy each, for which patches are listed. No two of all layers' tiles
    /// of one copy share pixels; they are drawn before those of several.
    pub listed: Range<u32>,
    /// Likewise, without lists.
    pub single: Range<u32>,
    /// Compute: tiles of several copies.
    pub several: Range<u32>,
}

impl<'a> Visible<'a> {
    /// What of these batches a view of perspective shows.
    pub fn new(view: &View, projector: &'a Projector, batches: &'a [Batch<'a>]) -> Self {
        debug_assert!(!view.parallel);
        Self::of(&Candidates::new(projector, batches), |strip, candidates| {
            strip.fill(candidates);
        })
    }

    /// What `fill` lists in the strips of the picture.
    fn of(
        candidates: &Candidates<'a>,
        fill: impl Fn(&mut Strip<'a>, &Candidates<'a>) + Sync,
    ) -> Self {
        let projector = candidates.projector;
        let tiles = |pixels: f64| ((pixels + 0.5) / f64::from(SIDE)).ceil() as u32;
        let size = [tiles(projector.high.x), tiles(projector.high.y)];
        // Several for each thread, as some take longer.
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

    /// Whether the eye is outside of all copies of a batch.
    pub fn is_apart(&self, batch: usize) -> bool {
        self.facts[batch].apart
    }

    /// Whether patches may be listed for a batch's tiles.
    pub fn takes_lists(&self, batch: usize) -> bool {
        let facts = &self.facts[batch];
        self.batches[batch].lists && facts.apart && facts.even
    }

    /// The copies of each batch that may show, in order.
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

    /// Deals what is shown out to records. `layer_of`: the layer of each batch, below `layers`.
    pub fn deal(&self, drawer: Drawer, layer_of: &[u32], layers: usize) -> TileWords {
        let [across, down] = self.size;
        let lists: Vec<bool> = (0..self.batches.len())
            .map(|b| drawer == Drawer::Groups { lists: true } && self.takes_lists(b))
            .collect();
        let single: Vec<bool> = self
            .batches
            .iter()
            .map(|b| b.placements.len() == 1)
            .collect();
        let of_band = |band: u32| {
            let corner = |tile: u32| {
                let [block, place] = [tile / (BLOCK * BLOCK), tile % (BLOCK * BLOCK)];
                [block * BLOCK + place % BLOCK, band * BLOCK + place / BLOCK]
            };
            let listed = self.strips.iter().map(|s| &s.listed[band as usize][..]);
            let dealer = Dealer {
                drawer,
                layer_of,
                lists: &lists,
                single: &single,
                picture: self.picture,
            };
            let tiles = across.next_multiple_of(BLOCK) * BLOCK;
            dealer.deal(&listed.collect::<Vec<_>>().concat(), tiles, layers, corner)
        };
        let bands: Vec<Vec<BandLists>> = (0..down.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_band)
            .collect();
        join(&bands, layers)
    }
}

/// One buffer of all bands' records and lists.
fn join(bands: &[Vec<BandLists>], layers: usize) -> TileWords {
    let mut records: Vec<[u32; 4]> = Vec::new();
    let mut lists = 0;
    let mut all = Vec::with_capacity(layers);
    for layer in 0..layers {
        let mut put = |of: for<'b> fn(&'b BandLists) -> &'b [[u32; 4]]| {
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
            records.extend(band[layer].several.iter().map(of));
            lists += band[layer].words.len();
        }
        all.push(LayerTiles {
            quads,
            listed,
            single,
            several: first..records.len() as u32,
        });
    }
    // Lists stand behind all records.
    let behind = 4 * records.len() as u32;
    for layer in &all {
        for record in &mut records[layer.several.start as usize..layer.several.end as usize] {
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

/// The bits of a tile's pixels that the picture has.
fn in_picture(tile: [u32; 2], picture: [u32; 4]) -> u64 {
    within(tile, picture)
}
