//! Copies dealt out to bins: to squares of the screen, or to single pixels of them.

use super::cover::SIDE;
use crate::shader::generated::BIN_SPLIT;

/// A copy in a square.
#[derive(Clone, Copy)]
pub(super) struct Listed {
    pub square: u32,
    /// Number of the instance.
    pub copy: u32,
    pub near: u32,
    /// Those that it may show in, one bit each.
    pub pixels: u64,
}

/// What goes through a batch's bins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Visitor {
    /// Fragments, drawn for squares of a few pixels.
    Fragments,
    /// Work groups: pixels with lists of their own leave their squares.
    Groups,
    /// The same, and of each square one copy may have a bin alone, for which patches are listed.
    GroupsAndLists,
}

/// Bins and lists of one batch in one band, as `bin_words.glsl` has them. Lists count from the
/// band's first.
#[derive(Default)]
pub(super) struct BandLists {
    pub bins: Vec<[u32; 4]>,
    /// Bins of one copy each, no two of one square. What they show has to be drawn before the bins.
    pub alone: Vec<[u32; 4]>,
    /// For fragments: squares of one copy each, which hold its number in place of a list.
    pub spots: Vec<[u32; 4]>,
    pub words: Vec<u32>,
    /// Pixels that wait for others to fill a bin: where they are, where their list begins, how many
    /// copies it holds.
    waiting: Vec<[u32; 3]>,
}

/// Pixels of a bin.
const PIXELS: usize = (SIDE * SIDE) as usize;
/// One list serves a square if its copies cover at least three quarters of it on average.
const LEAST_PART: [u32; 2] = [3, 4];
/// A copy that covers so many of a square's pixels has a bin alone.
const ALONE_PIXELS: u32 = 24;
/// Most copies a pixel, on average, of the lists of a square's pixels: where many copies lie behind
/// each other these would take too much memory.
const MOST_COPIES: u32 = 8;

impl BandLists {
    /// Deals copies, nearest first, out to so many squares. Of a square, `corner`: where it is, in
    /// squares; `inside`: those of its pixels that the picture has.
    pub fn new(
        listed: &[Listed],
        squares: u32,
        visitor: Visitor,
        corner: impl Fn(u32) -> [u32; 2],
        inside: impl Fn([u32; 2]) -> u64,
    ) -> Self {
        let mut ends = vec![0u32; squares as usize + 1];
        for one in listed {
            ends[one.square as usize + 1] += 1;
        }
        for square in 1..ends.len() {
            ends[square] += ends[square - 1];
        }
        let mut next = ends.clone();
        let mut sorted = vec![0u32; listed.len()];
        for (n, one) in (0u32..).zip(listed) {
            let place = &mut next[one.square as usize];
            sorted[*place as usize] = n;
            *place += 1;
        }
        let mut lists = Self::default();
        for square in 0..squares {
            let [begin, end] = [square, square + 1].map(|s| ends[s as usize] as usize);
            let mut here = &mut sorted[begin..end];
            if visitor == Visitor::GroupsAndLists {
                let is_large = |n: &u32| listed[*n as usize].pixels.count_ones() >= ALONE_PIXELS;
                if let Some(place) = here.iter().position(is_large) {
                    here[..=place].rotate_right(1);
                    lists.add_alone(&listed[here[0] as usize], corner(square));
                    here = &mut here[1..];
                }
            }
            if !here.is_empty() {
                let here = here.iter().map(|n| &listed[*n as usize]);
                let place = corner(square);
                if visitor == Visitor::Fragments {
                    lists.add_squares(here, place.map(|k| k * SIDE), inside(place));
                } else {
                    lists.add(here, place);
                }
            }
        }
        lists.gather();
        lists
    }

    /// The one copy of a bin.
    fn add_alone(&mut self, one: &Listed, [x, y]: [u32; 2]) {
        let first = self.words.len() as u32;
        self.words.extend([one.copy, one.near]);
        let corner = (x * SIDE) | ((y * SIDE) << 16);
        self.alone.push([corner, first, 1, one.near]);
    }

    /// The copies of a square.
    fn add<'a>(
        &mut self,
        here: impl ExactSizeIterator<Item = &'a Listed> + Clone,
        [x, y]: [u32; 2],
    ) {
        let at = |x: u32, y: u32| x | (y << 16);
        let corner = at(x * SIDE, y * SIDE);
        let count = here.len() as u32;
        let pixels: u32 = here.clone().map(|one| one.pixels.count_ones()).sum();
        if Self::splits(count, pixels, PIXELS as u32) {
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
        self.bins.push([corner, first, count, near]);
    }

    /// Whether each pixel of a square has a list of its own: of so many copies that have so many of
    /// its `area` pixels together.
    pub(super) fn splits(count: u32, pixels: u32, area: u32) -> bool {
        let [part, whole] = LEAST_PART;
        pixels * whole < area * count * part && pixels < area * MOST_COPIES
    }

    /// Lists of each of a square's pixels: where it begins, and how many copies it holds.
    pub(super) fn split(
        &mut self,
        here: impl Iterator<Item = Listed> + Clone,
    ) -> [[u32; 2]; PIXELS] {
        let mut lists = [[0u32; 2]; PIXELS];
        let each = |one: Listed, visit: &mut dyn FnMut(usize)| {
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

    /// A bin of the pixels that wait, and of some that are nowhere.
    fn gather(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        let first = self.words.len() as u32;
        self.waiting.resize(PIXELS, [u32::MAX, first, 0]);
        let lists = self.waiting.drain(..);
        let words = lists.flat_map(|[place, begin, n]| [place, begin.wrapping_sub(first), n]);
        self.words.extend(words);
        self.bins.push([0, first, BIN_SPLIT, 0]);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};

    pub const ACROSS: u32 = 5;
    pub const SQUARES: u32 = 3 * ACROSS;

    /// What is looked at in each pixel, and whether its list is its own.
    type Found = BTreeMap<(u32, u32), (Vec<u32>, bool)>;

    /// Copies of many sizes, from whole squares to single pixels, nearest first.
    pub fn copies() -> Vec<Listed> {
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
                Listed {
                    square: (next() % u64::from(SQUARES)) as u32,
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

    /// What each pixel may show.
    pub fn shown() -> BTreeMap<(u32, u32), Vec<u32>> {
        let mut all = BTreeMap::<_, Vec<u32>>::new();
        for one in copies() {
            for k in (0..64).filter(|k| one.pixels >> k & 1 == 1) {
                let (x, y) = (one.square % ACROSS, one.square / ACROSS);
                let pixel = (SIDE * x + k % SIDE, SIDE * y + k / SIDE);
                all.entry(pixel).or_default().push(one.copy);
            }
        }
        all
    }

    pub fn list(words: &[u32], begin: u32, count: u32) -> Vec<u32> {
        let words = &words[begin as usize..][..2 * count as usize];
        let copies = words.chunks_exact(2);
        assert!(copies.clone().all(|w| w[1] == 100 + w[0]));
        copies.map(|w| w[0]).collect()
    }

    fn lists(visitor: Visitor) -> BandLists {
        let corner = |square| [square % ACROSS, square / ACROSS];
        BandLists::new(&copies(), SQUARES, visitor, corner, |_| u64::MAX)
    }

    /// Lists hold what a pixel may show, in order; those of whole squares maybe more.
    fn check(found: &Found) {
        for (pixel, wanted) in shown() {
            let (list, own) = &found[&pixel];
            assert!(list.is_sorted() && (!own || *list == wanted));
            assert!(wanted.iter().all(|copy| list.contains(copy)));
        }
    }

    #[test]
    fn gathered_pixels_list_what_they_show_and_none_is_idle() {
        let lists = lists(Visitor::Groups);
        let (found, idle) = visited(&lists);
        check(&found);
        // In the last bin alone.
        assert!(idle < 64);
        assert_eq!(lists.alone, [[0; 4]; 0]);
    }

    /// What work groups look at, and how many invocations are idle.
    fn visited(lists: &BandLists) -> (Found, u32) {
        let mut found = BTreeMap::new();
        let mut idle = 0;
        for &[corner, first, count, _] in &lists.bins {
            let split = count == BIN_SPLIT;
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
    fn a_large_copy_of_each_square_has_a_bin_alone() {
        let lists = lists(Visitor::GroupsAndLists);
        let (mut found, _) = visited(&lists);
        let mut squares = BTreeMap::new();
        for &[corner, first, count, near] in &lists.alone {
            let [copy, kept] = [0, 1].map(|n| lists.words[first as usize + n]);
            assert_eq!((count, kept), (1, near));
            let square = (corner & 0xffff) / SIDE + (corner >> 16) / SIDE * ACROSS;
            assert_eq!(squares.insert(square, copy), None);
            let here = copies().into_iter().filter(|one| one.square == square);
            let large = here.filter(|one| one.pixels.count_ones() >= ALONE_PIXELS);
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
            .filter(|one| one.pixels.count_ones() >= ALONE_PIXELS);
        let with_one: BTreeSet<u32> = large.map(|one| one.square).collect();
        assert!(squares.keys().eq(&with_one) && with_one.len() > SQUARES as usize / 2);
        check(&found);
    }

    #[test]
    fn deep_squares_keep_one_list() {
        let deep: Vec<Listed> = (0..100)
            .map(|copy| Listed {
                square: 0,
                copy,
                near: 100 + copy,
                pixels: 0xff << (copy % 7),
            })
            .collect();
        let of = |copies: &[Listed]| {
            BandLists::new(copies, 1, Visitor::Groups, |_| [0, 0], |_| u64::MAX)
        };
        let lists = of(&deep);
        assert_eq!(lists.words.len(), 2 * deep.len());
        assert_eq!(lists.bins, [[0, 0, 100, 100]]);
        assert_eq!(of(&deep[..10]).bins[0][2], BIN_SPLIT);
    }
}
