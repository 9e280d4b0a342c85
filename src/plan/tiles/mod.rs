//! Tiles of the screen and the copies that each may show, nearest first, for all objects and copies
//! of a frame.
//!
//! 1. Clusters of neighbouring copies are projected to the picture ([`bounds`]) and sorted, nearest
//!    first.
//! 2. Clusters are opened in rounds, from the nearest to the farthest, except for wholly hidden
//!    ones. A copy of an opened cluster gets a rectangle of pixels and a nearest depth. Copies that
//!    no pixel's ray can meet are dropped. The others are sorted, nearest first.
//! 3. In this order, copies are listed in the tiles that may show them ([`strip`], [`outer`]). The
//!    pixels that a copy is sure to hide are marked there ([`cover`]). Later copies are not listed
//!    for pixels where they are wholly behind that copy.
//! 4. The listed copies are distributed to tiles and queues ([`tile_writer`]), in one buffer ([`layers`]).
//!
//! A copy is dropped only where its solid is proven absent, or where solids in front of it are
//! proven present. Pictures are identical to unculled ones to the last bit, except for roundings
//! where patches are listed. No data comes from an earlier frame. Strips of the picture, which are
//! columns of tiles from top to bottom, are filled in parallel. Strips have similar loads on a
//! field, where rows near the horizon hold most copies. Tiles are written in parallel, in bands of
//! rows.

mod bounds;
mod cover;
mod layers;
mod open_pixels;
mod outer;
mod strip;
mod tile_writer;

pub(crate) use bounds::{Cylinder, MOST_PIXELS, Projector};
pub(crate) use layers::LayerTiles;
pub use open_pixels::OpenPixels;
pub(crate) use tile_writer::TILE_PIXELS;

use super::view::View;
use crate::scene::{Cluster, Object};
use crate::solid::offset_surface::OffsetSurface;
use crate::surface::Cylinders;
use bounds::ScreenBounds;
use layers::{LayeredTiles, join};
use rayon::prelude::*;
use std::ops::Range;
use strip::{Item, Opened, Strip};
use tile_writer::{TileCopy, TileWriter};

/// Copies of one object.
pub(crate) struct Batch<'a> {
    pub object: &'a Object,
    /// The number of its first copy among all instances.
    pub first: u32,
    pub shape: Cylinder,
    /// Cylinders inside the solid, which hide everything behind them; none if unknown.
    pub inner: Option<&'a Cylinders>,
    /// Cylinders around the solid, and a margin in object units; none if only its bounding cylinder
    /// is known.
    pub outer: Option<(&'a Cylinders, f64)>,
    /// The surface; none unless its patches are searched and there are no replicas.
    pub surface: Option<&'a OffsetSurface>,
    /// True if patches may be listed for its tiles in some views.
    pub permits_lists: bool,
}

/// A cluster that may be in the picture.
struct Candidate {
    /// A rectangle that contains the pixels of its copies, and a depth that none is nearer than.
    bounds: ScreenBounds,
    batch: u32,
    /// Its copies' ranks.
    ranks: Range<u32>,
}

/// Rows of tiles in a band, and columns in a block. The tiles of a block are contiguous.
const BLOCK: u32 = 8;

/// Clusters of the first round; each round has as many as all before it. Few are opened in vain
/// where a near solid hides most of the others.
const FIRST_ROUND: usize = 64;

/// The visible copies of batches in a view, tile by tile.
pub(crate) struct Visible<'a> {
    batches: &'a [Batch<'a>],
    strips: Vec<Strip<'a>>,
    /// Columns of tiles in a strip.
    wide: u32,
    /// Number of tiles across and down.
    size: [u32; 2],
}

impl<'a> Visible<'a> {
    /// The visible copies of these batches in a perspective view.
    pub fn new(view: &View, projector: &'a Projector, batches: &'a [Batch<'a>]) -> Self {
        debug_assert!(!view.parallel);
        Self::in_rounds(projector, batches, FIRST_ROUND).0
    }

    /// Opens clusters in rounds, the first of this many clusters. Returns the number of opened
    /// clusters too.
    fn in_rounds(
        projector: &'a Projector,
        batches: &'a [Batch<'a>],
        first_round: usize,
    ) -> (Self, usize) {
        let mut all = Self::empty(projector, batches);
        let item = |number: u32, rank: u32| Item::new(projector, batches, number, rank);
        let mut clusters = Vec::new();
        let mut single = Vec::new();
        for (number, batch) in (0..).zip(batches) {
            let candidate = |cluster: &Cluster| {
                Some(Candidate {
                    bounds: projector.cluster_bounds(cluster, &batch.shape)?,
                    batch: number,
                    ranks: cluster.range.clone(),
                })
            };
            let copies = &batch.object.instances;
            if copies.is_empty() {
                single.extend(item(number, 0));
            } else {
                clusters.par_extend(copies.clusters().all().par_iter().filter_map(candidate));
            }
        }
        clusters.par_sort_unstable_by_key(|c| c.bounds.near.to_bits());
        let mut opened = vec![Opened {
            pixels: [0, 0, u16::MAX, u16::MAX],
            items: single,
        }];
        let (mut first, mut count) = (0, 0);
        loop {
            // Copies of later clusters may be nearer than the remaining ones.
            let next = clusters.get(first);
            let limit = next.map_or(u32::MAX, |c| c.bounds.near.to_bits());
            all.strips
                .par_iter_mut()
                .for_each(|strip| strip.fill(&opened, limit));
            if first == clusters.len() {
                break;
            }
            let end = first.saturating_add(first.max(first_round));
            let end = end.min(clusters.len());
            let shows = |c: &&Candidate| all.strips.iter().any(|s| s.may_show(&c.bounds));
            let open = |c: &Candidate| Opened {
                pixels: c.bounds.pixels,
                items: c.ranks.clone().filter_map(|k| item(c.batch, k)).collect(),
            };
            let round = clusters[first..end].par_iter();
            opened = round.filter(shows).map(open).collect();
            count += opened.len();
            first = end;
        }
        (all, count)
    }

    /// Empty strips of the picture.
    fn empty(projector: &'a Projector, batches: &'a [Batch<'a>]) -> Self {
        let size = projector.tiles();
        // Several strips per thread, as some take longer.
        let wide = size[0].div_ceil(4 * rayon::current_num_threads() as u32);
        let wide = wide.max(1).next_multiple_of(BLOCK);
        let strip = |left: u32| {
            let columns = left..size[0].min(left + wide);
            Strip::new(projector, batches, columns, size[1])
        };
        Self {
            batches,
            strips: (0..size[0]).step_by(wide as usize).map(strip).collect(),
            wide,
            size,
        }
    }

    /// True if rays begin outside of all copies of a batch that may show.
    pub fn is_apart(&self, batch: usize) -> bool {
        self.batches[batch].surface.is_some() && self.strips.iter().all(|s| s.apart[batch])
    }

    /// True if patches are listed for a batch's tiles in this view.
    pub fn lists_patches(&self, batch: usize) -> bool {
        self.batches[batch].permits_lists && self.is_apart(batch)
    }

    /// The copies of each batch that may show, in ascending order.
    pub fn copies(&self) -> Vec<Vec<u32>> {
        let mut all: Vec<u32> = self
            .strips
            .iter()
            .flat_map(|s| &s.copies)
            .copied()
            .collect();
        all.par_sort_unstable();
        all.dedup();
        let of = |batch: &Batch| {
            let end = batch.first + batch.object.placements().len() as u32;
            let [from, to] = [batch.first, end].map(|n| all.partition_point(|copy| *copy < n));
            all[from..to]
                .iter()
                .map(|copy| copy - batch.first)
                .collect()
        };
        self.batches.iter().map(of).collect()
    }

    /// Distributes the visible copies to tiles. `layer_of`: the layer of each batch. `open`: the
    /// pixels that are drawn; all if none.
    pub fn write(
        &self,
        open: Option<&OpenPixels>,
        layer_of: &[u32],
        layers: usize,
    ) -> LayeredTiles {
        let lists: Vec<bool> = (0..self.batches.len())
            .map(|b| self.lists_patches(b))
            .collect();
        // Open pixels of a single copy, too, share work groups with those of other tiles.
        let single = |batch: &Batch| open.is_none() && batch.object.placements().len() == 1;
        let single: Vec<bool> = self.batches.iter().map(single).collect();
        let writer = TileWriter {
            layers,
            layer_of,
            lists: &lists,
            single: &single,
        };
        let [across, down] = self.size;
        let of_band = |top: u32| {
            let rows = top..down.min(top + BLOCK);
            let blocks = (0..across).step_by(BLOCK as usize);
            let tiles = blocks.flat_map(|left| {
                let columns = left..across.min(left + BLOCK);
                let row = move |y| columns.clone().map(move |x| [x, y]);
                rows.clone().flat_map(row)
            });
            let copies = |at: [u32; 2]| {
                let pixels = open.map_or(u64::MAX, |open| open.of(at));
                let opened = move |copy: TileCopy| TileCopy {
                    pixels: copy.pixels & pixels,
                    ..copy
                };
                let all = self.strips[(at[0] / self.wide) as usize].tile(at[0], at[1]);
                all.map(opened).filter(|copy| copy.pixels != 0)
            };
            writer.write(tiles.map(|at| (at, copies(at))))
        };
        let bands: Vec<u32> = (0..down).step_by(BLOCK as usize).collect();
        let bands: Vec<_> = bands.into_par_iter().map(of_band).collect();
        join(&bands, layers)
    }
}
