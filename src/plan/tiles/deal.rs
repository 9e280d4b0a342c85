//! Distribution of copies to records of tiles, or of single pixels of tiles.

use super::Drawer;
use super::cover::SIDE;
use super::in_picture;
use crate::shader::generated::TILE_SPLIT;

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
    /// Compute: tiles of several copies.
    pub several: Vec<[u32; 4]>,
    /// Compute: tiles of one copy each, with lists of patches here and without in `single`. No tile
    /// has two such records.
    pub listed: Vec<[u32; 4]>,
    pub single: Vec<[u32; 4]>,
    /// Fragments: quads of one copy each.
    pub quads: Vec<[u32; 4]>,
    pub words: Vec<u32>,
    /// Pixels that wait until a record is full: their position, the start of their queue and its
    /// number of copies.
    waiting: Vec<[u32; 3]>,
}

/// Pixels of a tile.
const PIXELS: usize = (SIDE * SIDE) as usize;
/// A single queue serves a tile if its copies cover at least three quarters of it on average.
const LEAST_PART: [u32; 2] = [3, 4];
/// Least number of a tile's pixels for which a copy gets a record of its own.
const SINGLE_PIXELS: u32 = 24;
/// Most copies per pixel, on average, in the queues of a tile's pixels. Longer queues would take too
/// much memory where many copies are behind each other.
const MOST_COPIES: u32 = 8;

/// Parameters of the distribution of a band.
pub(super) struct Dealer<'a> {
    pub drawer: Drawer,
    /// The layer of each batch.
    pub layer_of: &'a [u32],
    /// True if patches may be listed for a batch's tiles.
    pub lists: &'a [bool],
    /// True if a batch has one copy.
    pub single: &'a [bool],
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
            if self.drawer == Drawer::Fragments {
                let inside = in_picture(place, self.picture);
                for one in here {
                    let layer = self.layer_of[one.batch as usize];
                    lists[layer as usize].add_quads(one, place.map(|k| k * SIDE), inside);
                }
                continue;
            }
            rest.clear();
            rest.extend_from_slice(here);
            if let Some(n) = self.single_of(here) {
                let one = rest.remove(n);
                let to = &mut lists[self.layer_of[one.batch as usize] as usize];
                to.add_single(&one, place, self.lists[one.batch as usize]);
            }
            while let Some(first) = rest.first() {
                let layer = self.layer_of[first.batch as usize];
                let of = |one: &TileCopy| self.layer_of[one.batch as usize] == layer;
                lists[layer as usize].add(rest.iter().filter(|one| of(one)), place);
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

    /// Adds the copies of a tile.
    fn add<'a>(&mut self, here: impl Iterator<Item = &'a TileCopy> + Clone, [x, y]: [u32; 2]) {
        let at = |x: u32, y: u32| x | (y << 16);
        let corner = at(x * SIDE, y * SIDE);
        let (mut count, mut pixels) = (0, 0);
        for one in here.clone() {
            count += 1;
            pixels += one.pixels.count_ones();
        }
        if splits(count, pixels) {
            let lists = self.split(here.copied());
            let place = |k: u32| corner + at(k % SIDE, k / SIDE);
            for (k, [begin, count]) in (0..).zip(lists).filter(|(_, [_, count])| *count > 0) {
                self.waiting.push([place(k), begin, count]);
                if self.waiting.len() == PIXELS {
                    self.gather();
                }
            }
            return;
        }
        let near = here.clone().next().map_or(0, |one| one.near);
        let first = self.words.len() as u32;
        self.words.extend(here.flat_map(|one| [one.copy, one.near]));
        self.several.push([corner, first, count, near]);
    }

    /// Makes a list for each of a tile's pixels: its start and its number of copies.
    fn split(&mut self, here: impl Iterator<Item = TileCopy> + Clone) -> [[u32; 2]; PIXELS] {
        let mut lists = [[0u32; 2]; PIXELS];
        let each = |one: TileCopy, visit: &mut dyn FnMut(usize)| {
            let mut pixels = one.pixels;
            while pixels != 0 {
                visit(pixels.trailing_zeros() as usize);
                pixels &= pixels - 1;
            }
        };
        for one in here.clone() {
            each(one, &mut |pixel| lists[pixel][1] += 1);
        }
        let mut next = [0usize; PIXELS];
        let mut at = self.words.len();
        for (next, list) in next.iter_mut().zip(&mut lists) {
            *next = at;
            list[0] = at as u32;
            at += 2 * list[1] as usize;
        }
        self.words.resize(at, 0);
        for one in here {
            each(one, &mut |pixel| {
                self.words[next[pixel]] = one.copy;
                self.words[next[pixel] + 1] = one.near;
                next[pixel] += 2;
            });
        }
        lists
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
        self.several.push([0, first, TILE_SPLIT, 0]);
    }
}

/// True if each pixel of a tile gets a list of its own. `count`: copies in the tile; `pixels`: sum
/// of the pixels that they cover.
fn splits(count: u32, pixels: u32) -> bool {
    let [part, whole] = LEAST_PART;
    let area = PIXELS as u32;
    pixels * whole < area * count * part && pixels < area * MOST_COPIES
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    const ACROSS: u32 = 5;
    const TILES: u32 = 3 * ACROSS;

    /// The copies that are searched in each pixel, and true if the pixel has a list of its own.
    type Found = BTreeMap<(u32, u32), (Vec<u32>, bool)>;

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

    fn list(words: &[u32], begin: u32, count: u32) -> Vec<u32> {
        let words = &words[begin as usize..][..2 * count as usize];
        let copies = words.chunks_exact(2);
        assert!(copies.clone().all(|w| w[1] == 100 + w[0]));
        copies.map(|w| w[0]).collect()
    }

    fn dealt(copies: &[TileCopy], tiles: u32, lists: bool) -> BandRecords {
        let dealer = Dealer {
            drawer: Drawer::Groups,
            layer_of: &[0],
            lists: &[lists],
            single: &[false],
            picture: [0, 0, 8 * ACROSS - 1, 23],
        };
        let corner = |tile| [tile % ACROSS, tile / ACROSS];
        dealer.deal(copies, tiles, 1, corner).remove(0)
    }

    /// Lists hold the copies that a pixel may show, in order. Lists of whole tiles may hold more.
    fn check(found: &Found) {
        for (pixel, wanted) in shown() {
            let (list, own) = &found[&pixel];
            assert!(list.is_sorted() && (!own || *list == wanted));
            assert!(wanted.iter().all(|copy| list.contains(copy)));
        }
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
        for &[corner, first, count, _] in &lists.several {
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
                let list = list(&lists.words, begin, count);
                assert!(
                    found
                        .insert((place & 0xffff, place >> 16), (list, split))
                        .is_none()
                );
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
                let (list, _) = found.entry(pixel).or_insert((Vec::new(), true));
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

    #[test]
    fn deep_tiles_keep_one_list() {
        let deep: Vec<TileCopy> = (0..100)
            .map(|copy| TileCopy {
                tile: 0,
                batch: 0,
                copy,
                near: 100 + copy,
                pixels: 0xff << (copy % 7),
            })
            .collect();
        let of = |copies: &[TileCopy]| dealt(copies, 1, false);
        let lists = of(&deep);
        assert_eq!(lists.words.len(), 2 * deep.len());
        assert_eq!(lists.several, [[0, 0, 100, 100]]);
        assert_eq!(of(&deep[..10]).several[0][2], TILE_SPLIT);
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
            picture: [0, 0, 8 * ACROSS - 1, 23],
        };
        let lists = dealer.deal(&all, TILES, 2, |tile| [tile % ACROSS, tile / ACROSS]);
        assert!(lists[0].listed.is_empty() && !lists[1].listed.is_empty());
        let mut found = BTreeMap::<(u32, u32), BTreeSet<u32>>::new();
        for (layer, lists) in (0u32..).zip(&lists) {
            for (pixel, (list, _)) in visited(lists).0 {
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

    /// Quads of a copy cover all its pixels once, and no pixel outside of the picture.
    #[test]
    fn quads_hold_what_their_copies_show() {
        use crate::shader::generated::QUAD_BITS;
        // The picture ends within tiles on all sides.
        let picture = [3, 2, 8 * ACROSS - 2, 20];
        let [left, top, right, bottom] = picture;
        let inside = |x: u32, y: u32| (left..=right).contains(&x) && (top..=bottom).contains(&y);
        let mut all = copies();
        for one in &mut all {
            let [x, y] = [one.tile % ACROSS, one.tile / ACROSS];
            let own = |k: &u32| inside(SIDE * x + k % SIDE, SIDE * y + k / SIDE);
            one.pixels &= (0..64).filter(own).map(|k| 1u64 << k).sum::<u64>();
        }
        let dealer = Dealer {
            drawer: Drawer::Fragments,
            layer_of: &[0],
            lists: &[false],
            single: &[false],
            picture,
        };
        let corner = |tile| [tile % ACROSS, tile / ACROSS];
        let lists = dealer.deal(&all, TILES, 1, corner).remove(0);
        let mut found = BTreeSet::new();
        for &[place, copy, none, near] in &lists.quads {
            assert_eq!((none, near), (0, 100 + copy));
            let (mask, side) = ((1 << QUAD_BITS) - 1, 1 << (place >> (2 * QUAD_BITS)));
            let [x, y] = [place & mask, place >> QUAD_BITS & mask];
            for (x, y) in (y..y + side).flat_map(|y| (x..x + side).map(move |x| (x, y))) {
                assert!(inside(x, y) && found.insert((x, y, copy)), "{x} {y}");
            }
        }
        for ((x, y), wanted) in shown().into_iter().filter(|((x, y), _)| inside(*x, *y)) {
            assert!(wanted.iter().all(|copy| found.contains(&(x, y, *copy))));
        }
    }
}
