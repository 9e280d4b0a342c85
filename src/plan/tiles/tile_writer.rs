//! Distribution of copies to tiles: those of one copy, queues, and pixels gathered from several tiles.

use super::bounds::SIDE;
use crate::shader::generated::{QUAD_BITS, QUEUE_BLOCK, TILE_BITS};
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
    /// Tiles of one copy each, with lists of patches here and without in `single`. No tile
    /// has two such copies.
    pub listed: Vec<CopyTile>,
    pub single: Vec<CopyTile>,
    pub queued: Vec<QueueTile>,
    /// Tiles of which only these pixels are searched.
    pub gathered: Vec<QueueTile>,
    pub pixels: Vec<GatheredPixel>,
    pub blocks: Vec<QueueBlock>,
}

/// Pixels of a tile, and invocations of a work group.
pub(crate) const TILE_PIXELS: u32 = SIDE * SIDE;
/// Least number of a tile's pixels for which a copy gets a tile of its own.
const SINGLE_PIXELS: u32 = 24;

/// Distributes the copies of a band.
pub(super) struct TileWriter<'a> {
    /// Number of layers.
    pub layers: usize,
    /// The layer of each batch.
    pub layer_of: &'a [u32],
    /// True if patches may be listed for a batch's tiles.
    pub lists: &'a [bool],
    /// True if a batch has one copy.
    pub single: &'a [bool],
}

impl TileWriter<'_> {
    /// Distributes the copies of tiles, nearest first, and returns the tiles of each layer. A tile is
    /// given by its position, in tiles.
    pub fn write<Copies: Iterator<Item = TileCopy>>(
        &self,
        tiles: impl Iterator<Item = ([u32; 2], Copies)>,
    ) -> Vec<BandTiles> {
        let mut layers: Vec<BandTiles> = Vec::new();
        layers.resize_with(self.layers, BandTiles::default);
        let mut left = Vec::new();
        for (place, copies) in tiles {
            left.clear();
            left.extend(copies);
            if let Some(n) = self.single_of(&left) {
                let copy = left.remove(n);
                let layer = &mut layers[self.layer_of[copy.batch as usize] as usize];
                layer.add_single(&copy, place, self.lists[copy.batch as usize]);
            }
            while let Some(first) = left.first() {
                let number = self.layer_of[first.batch as usize];
                let is_of = |copy: &TileCopy| self.layer_of[copy.batch as usize] == number;
                let copies = left.iter().filter(|copy| is_of(copy));
                layers[number as usize].add_queue(copies, place);
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

/// A tile of a copy. `place`: in tiles.
fn copy_tile(copy: &TileCopy, place: [u32; 2]) -> CopyTile {
    let [x, y] = place.map(|at| at * SIDE);
    CopyTile {
        square: x | y << QUAD_BITS,
        instance: copy.copy,
        unused: [0; 2],
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
        tiles.push(copy_tile(copy, place));
    }

    /// Adds a tile with a queue. If some pixels of the tile show no copy, its other pixels share work
    /// groups with those of other tiles.
    fn add_queue<'a>(&mut self, copies: impl Iterator<Item = &'a TileCopy>, [x, y]: [u32; 2]) {
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
        tile.place = x | y << TILE_BITS;
        if pixels == u64::MAX {
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
}

/// Visits the bits that are set.
fn each_bit(mut bits: u64, mut visit: impl FnMut(u32)) {
    while bits != 0 {
        visit(bits.trailing_zeros());
        bits &= bits - 1;
    }
}

#[cfg(test)]
mod tests;
