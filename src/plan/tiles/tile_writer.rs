//! Distribution of copies to tiles: those of one copy, queues, and pixels gathered from several tiles.

use super::bounds::SIDE;
use super::cover::{block, within};
use crate::shader::generated::{QUAD_BITS, QUEUE_BLOCK, TILE_BITS, TILE_HALVES};
use crate::shader::{CopyTile, GatheredPixel, QueueBlock, QueueTile, QueuedCopy};

/// A copy in a tile.
#[derive(Clone, Copy)]
pub(super) struct TileCopy {
    pub batch: u32,
    /// Number of the instance.
    pub copy: u32,
    pub near: f32,
    /// Pixels of the tile that may show the copy, one bit each.
    pub pixels: u64,
}

/// The tiles of one layer in one band. Blocks and gathered tiles count from the band's first.
#[derive(Default)]
pub(super) struct BandTiles {
    /// Fragments: squares of one copy each.
    pub quads: Vec<CopyTile>,
    /// Compute: tiles of one copy each, with lists of patches here and without in `single`. No tile
    /// has two such copies.
    pub listed: Vec<CopyTile>,
    pub single: Vec<CopyTile>,
    pub queued: Vec<QueueTile>,
    /// Compute: tiles of which only these pixels are searched.
    pub gathered: Vec<QueueTile>,
    pub pixels: Vec<GatheredPixel>,
    pub blocks: Vec<QueueBlock>,
}

/// Pixels of a tile, and invocations of a work group.
pub(crate) const TILE_PIXELS: u32 = SIDE * SIDE;
/// Fragments: least copies of a tile for which it has a queue, without and with shadows; those of
/// other tiles are drawn as quads. Without shadows queues from 3 copies on take 1.13 of the time of
/// sparse fields on lavapipe 22; from 6 on, 10,000 copies take 0.86 and a million 0.57 of the time
/// of quads alone. With shadows a queue spares the shading of what is hidden: 11 solids take 0.61 of
/// the time with queues from 2 copies on, and 0.66 from 1 on.
pub(crate) const LEAST_QUEUE: [usize; 2] = [6, 2];
/// Least number of a tile's pixels for which a copy gets a tile of its own.
const SINGLE_PIXELS: u32 = 24;

/// Distributes the copies of a band.
pub(super) struct TileWriter<'a> {
    /// True for work groups, false for fragments.
    pub compute: bool,
    /// The layer of each batch.
    pub layer_of: &'a [u32],
    /// True if patches may be listed for a batch's tiles.
    pub lists: &'a [bool],
    /// True if a batch has one copy.
    pub single: &'a [bool],
    /// Fragments: for each layer, the least copies of a tile that has a queue.
    pub queues: &'a [usize],
    /// Pixels: left, top, right, bottom.
    pub picture: [u32; 4],
}

impl TileWriter<'_> {
    /// Distributes the copies of tiles, nearest first, and returns the tiles of each layer. A tile is
    /// given by its position, in tiles.
    pub fn write<Copies: Iterator<Item = TileCopy>>(
        &self,
        tiles: impl Iterator<Item = ([u32; 2], Copies)>,
    ) -> Vec<BandTiles> {
        let mut layers: Vec<BandTiles> = Vec::new();
        layers.resize_with(self.queues.len(), BandTiles::default);
        let mut left = Vec::new();
        for (place, copies) in tiles {
            left.clear();
            left.extend(copies);
            if self.compute
                && let Some(n) = self.single_of(&left)
            {
                let copy = left.remove(n);
                let layer = &mut layers[self.layer_of[copy.batch as usize] as usize];
                layer.add_single(&copy, place, self.lists[copy.batch as usize]);
            }
            while let Some(first) = left.first() {
                let number = self.layer_of[first.batch as usize];
                let is_of = |copy: &TileCopy| self.layer_of[copy.batch as usize] == number;
                let copies = left.iter().filter(|copy| is_of(copy));
                let layer = &mut layers[number as usize];
                let least = self.queues[number as usize];
                if !self.compute && copies.clone().take(least).count() < least {
                    let inside = within(place, self.picture);
                    copies.for_each(|copy| layer.add_quads(copy, place, inside));
                } else {
                    layer.add_queue(copies, place, self.compute);
                }
                left.retain(|copy| !is_of(copy));
            }
        }
        layers
    }

    /// Index of the tile's copy that gets a tile of its own.
    fn single_of(&self, copies: &[TileCopy]) -> Option<usize> {
        let is_large = |copy: &TileCopy| copy.pixels.count_ones() >= SINGLE_PIXELS;
        match copies {
            [copy] if is_large(copy) || self.single[copy.batch as usize] => Some(0),
            _ => (0..copies.len()).find(|&n| {
                // Copies that coincide need the same search: the first of equal depths stays.
                let alike = |other: &&TileCopy| other.near == copies[n].near;
                let lists = self.lists[copies[n].batch as usize] && is_large(&copies[n]);
                lists && copies.iter().filter(alike).count() == 1
            }),
        }
    }
}

/// A square of pixels of a copy. `corner` and `side`: pixels.
fn copy_tile(copy: &TileCopy, [x, y]: [u32; 2], side: u32) -> CopyTile {
    CopyTile {
        square: x | y << QUAD_BITS | side.ilog2() << (2 * QUAD_BITS),
        instance: copy.copy,
        near: copy.near,
        unused: 0,
    }
}

impl BandTiles {
    /// Adds a tile's only copy, or a copy with a tile of its own.
    fn add_single(&mut self, copy: &TileCopy, place: [u32; 2], lists: bool) {
        let tiles = if lists {
            &mut self.listed
        } else {
            &mut self.single
        };
        tiles.push(copy_tile(copy, place.map(|at| at * SIDE), SIDE));
    }

    /// Adds a tile with a queue. If `gathers`, and some pixels of the tile show no copy, its other
    /// pixels share work groups with those of other tiles.
    fn add_queue<'a>(
        &mut self,
        copies: impl Iterator<Item = &'a TileCopy>,
        [x, y]: [u32; 2],
        gathers: bool,
    ) {
        let mut tile = QueueTile {
            first: self.blocks.len() as u32,
            ..QueueTile::default()
        };
        let mut pixels = 0;
        for copy in copies {
            let slot = tile.count % QUEUE_BLOCK;
            if slot == 0 {
                self.blocks.push(QueueBlock::default());
            }
            if tile.count == 0 {
                tile.near = copy.near;
            }
            tile.count += 1;
            pixels |= copy.pixels;
            if let Some(block) = self.blocks.last_mut() {
                block.copies[slot as usize] = QueuedCopy {
                    instance: copy.copy,
                    near: copy.near,
                };
                each_bit(copy.pixels, |k| {
                    let at = k * QUEUE_BLOCK;
                    block.marks[at as usize / 32] |= 1 << (at % 32 + slot);
                });
            }
        }
        tile.place = x | y << TILE_BITS | halves_of(pixels) << TILE_HALVES;
        if !gathers || pixels == u64::MAX {
            self.queued.push(tile);
            return;
        }
        let number = self.gathered.len() as u32;
        self.gathered.push(tile);
        each_bit(pixels, |k| {
            let [x, y] = [x * SIDE + k % SIDE, y * SIDE + k / SIDE];
            self.pixels.push(GatheredPixel {
                position: x | y << 16,
                tile: number,
            });
        });
    }

    /// Adds the quads of a copy in a tile. `inside`: the tile's pixels that are in the picture.
    fn add_quads(&mut self, copy: &TileCopy, [x, y]: [u32; 2], inside: u64) {
        let add = &mut |[left, top, side]: [u32; 3]| {
            let corner = [x * SIDE + left, y * SIDE + top];
            self.quads.push(copy_tile(copy, corner, side));
        };
        cut([0, 0, SIDE], copy.pixels & inside, inside, add);
    }
}

/// Visits quads (x, y, side) within this one that hold these pixels and no pixel outside of the
/// picture. Drivers search blocks of 4 x 4 pixels as one. Smaller quads are therefore used only at
/// the picture's edges, and a whole tile only where no block would be empty.
fn cut([x, y, side]: [u32; 3], pixels: u64, inside: u64, visit: &mut impl FnMut([u32; 3])) {
    let bits = |[x, y, side]: [u32; 3]| block([x, y, x + side - 1, y + side - 1]);
    let whole = bits([x, y, side]);
    if pixels & whole == 0 {
        return;
    }
    let half = side / 2;
    let quarters =
        [[x, y], [x + half, y], [x, y + half], [x + half, y + half]].map(|[x, y]| [x, y, half]);
    let full = side < SIDE || quarters.iter().all(|q| pixels & bits(*q) != 0);
    if full && whole & !inside == 0 {
        visit([x, y, side]);
    } else {
        for quarter in quarters {
            cut(quarter, pixels, inside, visit);
        }
    }
}

/// Visits the bits that are set.
fn each_bit(mut bits: u64, mut visit: impl FnMut(u32)) {
    while bits != 0 {
        visit(bits.trailing_zeros());
        bits &= bits - 1;
    }
}

/// The halves of a tile in which pixels are, one bit each: left, right, top, bottom.
fn halves_of(pixels: u64) -> u32 {
    const LEFT: u64 = 0x0f0f_0f0f_0f0f_0f0f;
    let [left, top] = [LEFT, 0xffff_ffff];
    let halves = [left, !left, top, !top];
    (0..)
        .zip(halves)
        .map(|(k, half)| u32::from(pixels & half != 0) << k)
        .sum()
}

#[cfg(test)]
mod tests;
