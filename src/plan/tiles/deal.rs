//! Distribution of copies to records of tiles, or of single pixels of tiles.

use super::Drawer;
use super::cover::{SIDE, within};
use crate::shader::generated::{
    QUEUE_BLOCK, QUEUE_WORDS, RECORD_HALVES_SHIFT, TILE_BITS, TILE_SPLIT,
};

/// A copy in a tile.
#[derive(Clone, Copy)]
pub(super) struct TileCopy {
    /// Number of the tile in the band.
    pub tile: u32,
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
    pub drawer: Drawer,
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
    /// Distributes copies, nearest first, to this many tiles and returns the lists of each layer.
    /// `corner`: position of a tile, in tiles.
    pub fn deal(
        &self,
        listed: &[TileCopy],
        tiles: u32,
        layers: usize,
        corner: impl Fn(u32) -> [u32; 2],
    ) -> Vec<BandRecords> {
        let mut lists: Vec<BandRecords> = (0..layers).map(|_| BandRecords::default()).collect();
        let (sorted, ends) = by_tile(listed, tiles);
        let mut rest = Vec::new();
        for tile in (0..tiles).filter(|t| ends[*t as usize] < ends[*t as usize + 1]) {
            let here = ends[tile as usize] as usize..ends[tile as usize + 1] as usize;
            let here = &sorted[here];
            let place = corner(tile);
            rest.clear();
            rest.extend_from_slice(here);
            let in_groups = self.drawer == Drawer::Groups;
            if in_groups && let Some(n) = self.single_of(here) {
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
                if !in_groups && (few || !self.queues[layer as usize]) {
                    let inside = within(place, self.picture);
                    let corner = place.map(|k| k * SIDE);
                    copies.for_each(|one| to.add_quads(one, corner, inside));
                } else {
                    to.add(copies, place, in_groups);
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

/// Copies sorted by tile, in their given order within a tile, and the start and end of each tile's
/// copies.
fn by_tile(listed: &[TileCopy], tiles: u32) -> (Vec<TileCopy>, Vec<u32>) {
    let mut ends = vec![0u32; tiles as usize + 1];
    for one in listed {
        ends[one.tile as usize + 1] += 1;
    }
    for tile in 1..ends.len() {
        ends[tile] += ends[tile - 1];
    }
    let mut next = ends.clone();
    let mut order = vec![0u32; listed.len()];
    for (n, one) in (0u32..).zip(listed) {
        let place = &mut next[one.tile as usize];
        order[*place as usize] = n;
        *place += 1;
    }
    (order.iter().map(|n| listed[*n as usize]).collect(), ends)
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
    use crate::shader::generated::QUAD_BITS;
    use std::collections::{BTreeMap, BTreeSet};

    const ACROSS: u32 = 5;
    const TILES: u32 = 3 * ACROSS;
    const PICTURE: [u32; 4] = [0, 0, 8 * ACROSS - 1, 23];

    /// The copies that are searched in each pixel.
    type Found = BTreeMap<(u32, u32), Vec<u32>>;

    /// Copies of many sizes, from whole tiles to single pixels, nearest first.
    fn copies() -> Vec<TileCopy> {
        let mut state = 7u64;
        let mut next = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            state >> 16
        };
        (0..90)
            .map(|copy| {
                let few = next() & next() >> 7 & next() << 3;
                TileCopy {
                    tile: (next() % u64::from(TILES)) as u32,
                    batch: 0,
                    copy,
                    near: 100 + copy,
                    pixels: if copy % 3 == 0 {
                        u64::MAX
                    } else {
                        1 << (copy % 60) | few
                    },
                }
            })
            .collect()
    }

    /// The copies that each pixel may show.
    fn shown() -> BTreeMap<(u32, u32), Vec<u32>> {
        let mut all = BTreeMap::<_, Vec<u32>>::new();
        for one in copies() {
            for k in (0..64).filter(|k| one.pixels >> k & 1 == 1) {
                let (x, y) = (one.tile % ACROSS, one.tile / ACROSS);
                let pixel = (SIDE * x + k % SIDE, SIDE * y + k / SIDE);
                all.entry(pixel).or_default().push(one.copy);
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

    fn dealt(copies: &[TileCopy], tiles: u32, lists: bool) -> BandRecords {
        let dealer = Dealer {
            drawer: Drawer::Groups,
            layer_of: &[0],
            lists: &[lists],
            single: &[false],
            queues: &[true],
            picture: PICTURE,
        };
        let corner = |tile| [tile % ACROSS, tile / ACROSS];
        dealer.deal(copies, tiles, 1, corner).remove(0)
    }

    /// Each pixel searches the copies that it may show, in order.
    fn check(found: &Found) {
        assert!(
            shown()
                .iter()
                .all(|(pixel, wanted)| found[pixel] == *wanted)
        );
    }

    #[test]
    fn gathered_pixels_list_what_they_show_and_none_is_idle() {
        let lists = dealt(&copies(), TILES, false);
        let (found, idle) = visited(&lists);
        check(&found);
        // Only the last record has idle invocations.
        assert!(idle < 64);
        assert_eq!(lists.listed.len() + lists.single.len(), 0);
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
    fn a_large_copy_of_each_tile_has_a_record_of_its_own() {
        let lists = dealt(&copies(), TILES, true);
        let (mut found, _) = visited(&lists);
        let mut tiles = BTreeMap::new();
        for &[corner, copy, none, near] in &lists.listed {
            assert_eq!((none, near), (0, 100 + copy));
            let tile = (corner & 0xffff) / SIDE + (corner >> 16) / SIDE * ACROSS;
            assert_eq!(tiles.insert(tile, copy), None);
            let here = copies().into_iter().filter(|one| one.tile == tile);
            let large = here.filter(|one| one.pixels.count_ones() >= SINGLE_PIXELS);
            let nearest = large.min_by_key(|one| one.near).unwrap();
            assert_eq!(nearest.copy, copy);
            for k in (0..64).filter(|k| nearest.pixels >> k & 1 == 1) {
                let pixel = ((corner & 0xffff) + k % SIDE, (corner >> 16) + k / SIDE);
                let list = found.entry(pixel).or_default();
                if let Err(place) = list.binary_search(&copy) {
                    list.insert(place, copy);
                }
            }
        }
        let large = copies()
            .into_iter()
            .filter(|one| one.pixels.count_ones() >= SINGLE_PIXELS);
        let with_one: BTreeSet<u32> = large.map(|one| one.tile).collect();
        assert!(tiles.keys().eq(&with_one) && with_one.len() > TILES as usize / 2);
        check(&found);
    }

    /// Quads of tiles with few copies, and queues of the others, hold what pixels show. Quads hold no
    /// pixel outside of the picture.
    #[test]
    fn fragments_have_quads_and_queues() {
        // The picture ends within tiles on all sides.
        let picture = [3, 2, 8 * ACROSS - 2, 20];
        let [left, top, right, bottom] = picture;
        let inside = |x: u32, y: u32| (left..=right).contains(&x) && (top..=bottom).contains(&y);
        let mut all = copies();
        for one in &mut all {
            one.pixels &= within([one.tile % ACROSS, one.tile / ACROSS], picture);
        }
        let deal = |queues: bool, copies: &[TileCopy]| {
            let dealer = Dealer {
                drawer: Drawer::Fragments,
                layer_of: &[0],
                lists: &[true],
                single: &[false],
                queues: &[queues],
                picture,
            };
            let corner = |tile| [tile % ACROSS, tile / ACROSS];
            dealer.deal(copies, TILES, 1, corner).remove(0)
        };
        for (queues, count) in [(true, 40), (true, 90), (false, 90)] {
            let lists = deal(queues, &all[..count]);
            assert!(lists.listed.is_empty() && lists.single.is_empty());
            assert!(!lists.quads.is_empty() || count == 90);
            assert_eq!(lists.queued.is_empty(), !queues);
            assert!(lists.queued.iter().all(|record| record[2] != TILE_SPLIT));
            let (mut found, _) = visited(&lists);
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
            for (pixel, wanted) in shown().into_iter().filter(|((x, y), _)| inside(*x, *y)) {
                let wanted = wanted.iter().filter(|copy| (**copy as usize) < count);
                assert!(wanted.into_iter().all(|copy| found[&pixel].contains(copy)));
            }
        }
    }

    /// Two layers have copies in one tile. A layer lists its own copies in order, and one copy of
    /// the two layers has a record of its own.
    #[test]
    fn layers_share_tiles() {
        let mut all = copies();
        for one in &mut all {
            one.batch = one.copy % 2;
        }
        let dealer = Dealer {
            drawer: Drawer::Groups,
            layer_of: &[1, 0],
            lists: &[true, false],
            single: &[false, false],
            queues: &[true, true],
            picture: PICTURE,
        };
        let lists = dealer.deal(&all, TILES, 2, |tile| [tile % ACROSS, tile / ACROSS]);
        assert!(lists[0].listed.is_empty() && !lists[1].listed.is_empty());
        let mut found = BTreeMap::<(u32, u32), BTreeSet<u32>>::new();
        for (layer, lists) in (0u32..).zip(&lists) {
            for (pixel, list) in visited(lists).0 {
                assert!(list.is_sorted() && list.iter().all(|copy| 1 - copy % 2 == layer));
                found.entry(pixel).or_default().extend(list);
            }
            for &[corner, copy, ..] in &lists.listed {
                for k in 0..SIDE * SIDE {
                    let pixel = ((corner & 0xffff) + k % SIDE, (corner >> 16) + k / SIDE);
                    found.entry(pixel).or_default().insert(copy);
                }
            }
        }
        for (pixel, wanted) in shown() {
            assert!(wanted.iter().all(|copy| found[&pixel].contains(copy)));
        }
    }
}
