//! Distribution of copies to records of tiles, or of single pixels of tiles.

use super::bounds::SIDE;
use super::cover::{block, within};
use crate::shader::generated::{
    QUAD_BITS, QUEUE_BLOCK, QUEUE_WORDS, RECORD_HALVES_SHIFT, TILE_BITS, TILE_SPLIT,
};

/// A copy in a tile.
#[derive(Clone, Copy)]
pub(super) struct TileCopy {
    pub batch: u32,
    /// Number of the instance.
    pub copy: u32,
    pub near: u32,
    /// Pixels of the tile that may show the copy, one bit each.
    pub pixels: u64,
}

/// Records and queues of one layer in one band, in the layout of `tile_words.glsl`. Queues count from
/// the band's first word.
#[derive(Default)]
pub(super) struct BandRecords {
    /// Tiles with queues of copies, and in compute records of pixels.
    pub queued: Vec<[u32; 4]>,
    /// Fragments: quads of one copy each.
    pub quads: Vec<[u32; 4]>,
    /// Compute: tiles of one copy each, with lists of patches here and without in `single`. No tile
    /// has two such records.
    pub listed: Vec<[u32; 4]>,
    pub single: Vec<[u32; 4]>,
    pub words: Vec<u32>,
    /// Pixels that wait until a record is full: their position, the start of their tile's queue and
    /// its number of copies.
    waiting: Vec<[u32; 3]>,
}

/// Words of a block of a queue.
const BLOCK_WORDS: usize = (QUEUE_WORDS * QUEUE_BLOCK) as usize;
/// Pixels of a tile.
const PIXELS: usize = (SIDE * SIDE) as usize;
/// Fragments: least copies of a tile for which it has a queue; those of other tiles are drawn as
/// quads. With queues from 3 copies on, sparse fields take 1.13 of the time on lavapipe 22; from 6
/// on, 10,000 copies take 0.86 and a million 0.57 of the time of quads alone.
pub(crate) const LEAST_QUEUE: usize = 6;
/// Least number of a tile's pixels for which a copy gets a record of its own.
const SINGLE_PIXELS: u32 = 24;
/// Parameters of the distribution of a band.
pub(super) struct Dealer<'a> {
    /// True for work groups, false for fragments.
    pub compute: bool,
    /// The layer of each batch.
    pub layer_of: &'a [u32],
    /// True if patches may be listed for a batch's tiles.
    pub lists: &'a [bool],
    /// True if a batch has one copy.
    pub single: &'a [bool],
    /// Fragments: true if a layer's tiles may have queues.
    pub queues: &'a [bool],
    /// Pixels: left, top, right, bottom.
    pub picture: [u32; 4],
}

impl Dealer<'_> {
    /// Distributes the copies of tiles, nearest first, and returns the lists of each layer. A tile is
    /// given by its position, in tiles.
    pub fn deal<Copies: Iterator<Item = TileCopy>>(
        &self,
        tiles: impl Iterator<Item = ([u32; 2], Copies)>,
    ) -> Vec<BandRecords> {
        let mut lists: Vec<BandRecords> = Vec::new();
        lists.resize_with(self.queues.len(), BandRecords::default);
        let mut rest = Vec::new();
        for (place, here) in tiles {
            rest.clear();
            rest.extend(here);
            if self.compute
                && let Some(n) = self.single_of(&rest)
            {
                let one = rest.remove(n);
                let to = &mut lists[self.layer_of[one.batch as usize] as usize];
                to.add_single(&one, place, self.lists[one.batch as usize]);
            }
            while let Some(first) = rest.first() {
                let layer = self.layer_of[first.batch as usize];
                let of = |one: &TileCopy| self.layer_of[one.batch as usize] == layer;
                let copies = rest.iter().filter(|one| of(one));
                let to = &mut lists[layer as usize];
                let few = copies.clone().nth(LEAST_QUEUE - 1).is_none();
                if !self.compute && (few || !self.queues[layer as usize]) {
                    let inside = within(place, self.picture);
                    copies.for_each(|one| to.add_quads(one, place, inside));
                } else {
                    to.add(copies, place, self.compute);
                }
                rest.retain(|one| !of(one));
            }
        }
        lists.iter_mut().for_each(BandRecords::gather);
        lists
    }

    /// Index of the tile's copy that gets a record of its own.
    fn single_of(&self, here: &[TileCopy]) -> Option<usize> {
        let is_large = |one: &TileCopy| one.pixels.count_ones() >= SINGLE_PIXELS;
        match here {
            [one] if is_large(one) || self.single[one.batch as usize] => Some(0),
            _ => (0..here.len()).find(|&n| {
                // Copies that coincide need the same search: the first of equal depths stays.
                let alike = |other: &TileCopy| other.near == here[n].near;
                let unique = here.iter().filter(|one| alike(one)).count() == 1;
                self.lists[here[n].batch as usize] && is_large(&here[n]) && unique
            }),
        }
    }
}

impl BandRecords {
    /// Adds a tile's only copy, or a copy with a record of its own.
    fn add_single(&mut self, one: &TileCopy, [x, y]: [u32; 2], lists: bool) {
        let corner = (x * SIDE) | ((y * SIDE) << 16);
        let to = if lists {
            &mut self.listed
        } else {
            &mut self.single
        };
        to.push([corner, one.copy, 0, one.near]);
    }

    /// Adds the queue of a tile, and its record. If `gathers`, and some pixels of the tile show no copy,
    /// its pixels share records with those of other tiles.
    fn add<'a>(
        &mut self,
        here: impl Iterator<Item = &'a TileCopy> + Clone,
        [x, y]: [u32; 2],
        gathers: bool,
    ) {
        let at = |x: u32, y: u32| x | (y << 16);
        let corner = at(x * SIDE, y * SIDE);
        let near = here.clone().next().map_or(0, |one| one.near);
        let first = self.words.len() as u32;
        let (mut count, mut pixels) = (0, 0);
        for one in here {
            let (block, slot) = (count / QUEUE_BLOCK, count % QUEUE_BLOCK);
            let begin = (first + QUEUE_WORDS * QUEUE_BLOCK * block) as usize;
            self.words.resize(begin + BLOCK_WORDS, 0);
            let (copies, marks) = self.words[begin..].split_at_mut(2 * QUEUE_BLOCK as usize);
            copies[2 * slot as usize..][..2].copy_from_slice(&[one.copy, one.near]);
            each_bit(one.pixels, |k| {
                let at = k * QUEUE_BLOCK as usize;
                marks[at / 32] |= 1 << (at as u32 % 32 + slot);
            });
            count += 1;
            pixels |= one.pixels;
        }
        if !gathers || pixels == u64::MAX {
            let halves = halves_of(pixels) << RECORD_HALVES_SHIFT;
            self.queued
                .push([x | y << TILE_BITS | halves, first, count, near]);
            return;
        }
        each_bit(pixels, |k| {
            let place = corner + at(k as u32 % SIDE, k as u32 / SIDE);
            self.waiting.push([place, first, count]);
            if self.waiting.len() == PIXELS {
                self.gather();
            }
        });
    }

    /// Adds the quads of a copy in a tile. `inside`: the tile's pixels that are in the picture.
    fn add_quads(&mut self, one: &TileCopy, [x, y]: [u32; 2], inside: u64) {
        let corner = (x * SIDE) | ((y * SIDE) << QUAD_BITS);
        cut([0, 0, SIDE], one.pixels & inside, inside, &mut |[
            x,
            y,
            side,
        ]| {
            let place = x | y << QUAD_BITS | side.ilog2() << (2 * QUAD_BITS);
            self.quads.push([corner + place, one.copy, 0, one.near]);
        });
    }

    /// Makes a record of the waiting pixels; empty entries fill it up.
    fn gather(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        let first = self.words.len() as u32;
        self.waiting.resize(PIXELS, [u32::MAX, first, 0]);
        let lists = self.waiting.drain(..);
        let words = lists.flat_map(|[place, begin, n]| [place, begin.wrapping_sub(first), n]);
        self.words.extend(words);
        self.queued.push([0, first, TILE_SPLIT, 0]);
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
fn each_bit(mut bits: u64, mut visit: impl FnMut(usize)) {
    while bits != 0 {
        visit(bits.trailing_zeros() as usize);
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
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    const ACROSS: u32 = 5;
    const TILES: usize = 3 * ACROSS as usize;
    const PICTURE: [u32; 4] = [0, 0, 8 * ACROSS - 1, 23];

    /// Positions of tiles, and their copies, nearest first.
    type Tiles = Vec<([u32; 2], Vec<TileCopy>)>;
    /// The copies that are searched in each pixel.
    type Found = BTreeMap<(u32, u32), Vec<u32>>;

    /// So many copies of many sizes, from whole tiles to single pixels.
    fn tiles(count: u32) -> Tiles {
        let place = |tile| [tile % ACROSS, tile / ACROSS];
        let mut all: Tiles = (0..TILES as u32).map(|t| (place(t), Vec::new())).collect();
        let mut state = 7u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            state >> 16
        };
        for copy in 0..count {
            let few = next() & next() >> 7 & next() << 3;
            let (_, here) = &mut all[next() as usize % TILES];
            here.push(TileCopy {
                batch: copy % 2,
                copy,
                near: 100 + copy,
                pixels: if copy % 3 == 0 {
                    u64::MAX
                } else {
                    1 << (copy % 60) | few
                },
            });
        }
        all
    }

    /// The pixels of a tile.
    fn pixels_of([x, y]: [u32; 2], bits: u64) -> impl Iterator<Item = (u32, u32)> {
        let bits = (0..64).filter(move |k| bits >> k & 1 == 1);
        bits.map(move |k| (SIDE * x + k % SIDE, SIDE * y + k / SIDE))
    }

    /// The copies that each pixel may show.
    fn shown(tiles: &Tiles) -> Found {
        let mut all = Found::new();
        for (place, here) in tiles {
            for one in here {
                for pixel in pixels_of(*place, one.pixels) {
                    all.entry(pixel).or_default().push(one.copy);
                }
            }
        }
        all
    }

    /// The copies of a queue that a pixel of the tile may show.
    fn list(words: &[u32], begin: u32, count: u32, bit: u32) -> Vec<u32> {
        let mut found = Vec::new();
        for k in 0..count.next_multiple_of(QUEUE_BLOCK) {
            let block = &words[begin as usize + (k / QUEUE_BLOCK) as usize * BLOCK_WORDS..];
            let (slot, at) = (k % QUEUE_BLOCK, bit * QUEUE_BLOCK);
            let marks = block[(2 * QUEUE_BLOCK + at / 32) as usize];
            if marks >> (at % 32 + slot) & 1 == 1 {
                let copy = &block[2 * slot as usize..][..2];
                assert!(k < count && copy[1] == 100 + copy[0]);
                found.push(copy[0]);
            }
        }
        found
    }

    /// Two batches in one layer, with queues.
    const DEALER: Dealer = Dealer {
        compute: true,
        layer_of: &[0, 0],
        lists: &[false; 2],
        single: &[false; 2],
        queues: &[true],
        picture: PICTURE,
    };

    fn dealt(tiles: &Tiles, dealer: &Dealer) -> Vec<BandRecords> {
        dealer.deal(
            tiles
                .iter()
                .map(|(place, here)| (*place, here.iter().copied())),
        )
    }

    /// The lists that work groups search, and the number of idle invocations.
    fn visited(lists: &BandRecords) -> (Found, u32) {
        let mut found = BTreeMap::new();
        let mut idle = 0;
        for &[packed, first, count, _] in &lists.queued {
            let [x, y] = [packed, packed >> TILE_BITS].map(|at| at & ((1 << TILE_BITS) - 1));
            let corner = (SIDE * x) | (SIDE * y) << 16;
            let split = count == TILE_SPLIT;
            for k in 0..SIDE * SIDE {
                let at = (first + 3 * k) as usize;
                let [place, begin, count] = if split {
                    let [place, away, count] = [0, 1, 2].map(|n| lists.words[at + n]);
                    [place, first.wrapping_add(away), count]
                } else {
                    [corner + k % SIDE + ((k / SIDE) << 16), first, count]
                };
                if place == u32::MAX {
                    idle += 1;
                    continue;
                }
                let pixel = (place & 0xffff, place >> 16);
                let bit = pixel.0 % SIDE + pixel.1 % SIDE * SIDE;
                let list = list(&lists.words, begin, count, bit);
                assert!(found.insert(pixel, list).is_none());
            }
        }
        (found, idle)
    }

    #[test]
    fn gathered_pixels_list_what_they_show_and_none_is_idle() {
        let tiles = tiles(90);
        let lists = &dealt(&tiles, &DEALER)[0];
        let (found, idle) = visited(lists);
        // Each pixel searches the copies that it may show, in order.
        let shown = shown(&tiles);
        assert!(shown.iter().all(|(pixel, wanted)| found[pixel] == *wanted));
        // Only the last record has idle invocations.
        assert!(idle < 64);
        assert_eq!(lists.listed.len() + lists.single.len(), 0);
    }

    #[test]
    fn a_large_copy_of_each_tile_has_a_record_of_its_own() {
        let tiles = tiles(90);
        let lists = &[true; 2];
        let lists = &dealt(&tiles, &Dealer { lists, ..DEALER })[0];
        let (mut found, _) = visited(lists);
        let mut records = lists.listed.iter();
        for (place, here) in &tiles {
            let is_large = |one: &&TileCopy| one.pixels.count_ones() >= SINGLE_PIXELS;
            let Some(nearest) = here.iter().find(is_large) else {
                continue;
            };
            let corner = (place[0] * SIDE) | ((place[1] * SIDE) << 16);
            let wanted = [corner, nearest.copy, 0, nearest.near];
            assert_eq!(records.next(), Some(&wanted));
            for pixel in pixels_of(*place, nearest.pixels) {
                let list = found.entry(pixel).or_default();
                if let Err(at) = list.binary_search(&nearest.copy) {
                    list.insert(at, nearest.copy);
                }
            }
        }
        assert!(records.next().is_none() && lists.listed.len() > TILES / 2);
        let shown = shown(&tiles);
        assert!(shown.iter().all(|(pixel, wanted)| found[pixel] == *wanted));
    }

    /// Quads of tiles with few copies, and queues of the others, hold what pixels show. Quads hold no
    /// pixel outside of the picture.
    #[test]
    fn fragments_have_quads_and_queues() {
        // The picture ends within tiles on all sides.
        let picture = [3, 2, 8 * ACROSS - 2, 20];
        let [left, top, right, bottom] = picture;
        let inside = |x: u32, y: u32| (left..=right).contains(&x) && (top..=bottom).contains(&y);
        for (queues, count) in [(true, 40), (true, 90), (false, 90)] {
            let mut tiles = tiles(count);
            for (place, here) in &mut tiles {
                let inside = within(*place, picture);
                here.iter_mut().for_each(|one| one.pixels &= inside);
            }
            let dealer = Dealer {
                compute: false,
                lists: &[true; 2],
                queues: &[queues],
                picture,
                ..DEALER
            };
            let lists = &dealt(&tiles, &dealer)[0];
            assert!(lists.listed.is_empty() && lists.single.is_empty());
            assert!(!lists.quads.is_empty() || count == 90);
            assert_eq!(lists.queued.is_empty(), !queues);
            assert!(lists.queued.iter().all(|record| record[2] != TILE_SPLIT));
            let (mut found, _) = visited(lists);
            for &[place, copy, none, near] in &lists.quads {
                assert_eq!((none, near), (0, 100 + copy));
                let (mask, side) = ((1 << QUAD_BITS) - 1, 1 << (place >> (2 * QUAD_BITS)));
                let [x, y] = [place & mask, place >> QUAD_BITS & mask];
                for (x, y) in (y..y + side).flat_map(|y| (x..x + side).map(move |x| (x, y))) {
                    let list = found.entry((x, y)).or_default();
                    assert!(inside(x, y) && !list.contains(&copy), "{x} {y}");
                    list.push(copy);
                }
            }
            for ((x, y), wanted) in shown(&tiles) {
                assert!(inside(x, y) && wanted.iter().all(|copy| found[&(x, y)].contains(copy)));
            }
        }
    }

    /// Two layers have copies in one tile. A layer lists its own copies in order, and one copy of
    /// the two layers has a record of its own.
    #[test]
    fn layers_share_tiles() {
        let tiles = tiles(90);
        let dealer = Dealer {
            layer_of: &[1, 0],
            lists: &[true, false],
            queues: &[true; 2],
            ..DEALER
        };
        let lists = dealt(&tiles, &dealer);
        assert!(lists[0].listed.is_empty() && !lists[1].listed.is_empty());
        let mut found = Found::new();
        for (layer, lists) in (0u32..).zip(&lists) {
            for (pixel, list) in visited(lists).0 {
                assert!(list.is_sorted() && list.iter().all(|copy| 1 - copy % 2 == layer));
                found.entry(pixel).or_default().extend(list);
            }
            for &[corner, copy, ..] in &lists.listed {
                let place = [corner & 0xffff, corner >> 16].map(|at| at / SIDE);
                for pixel in pixels_of(place, u64::MAX) {
                    found.entry(pixel).or_default().push(copy);
                }
            }
        }
        for (pixel, wanted) in shown(&tiles) {
            assert!(wanted.iter().all(|copy| found[&pixel].contains(copy)));
        }
    }
}
