//! Squares of pixels that fragments are drawn for.

use super::cover::{SIDE, block};
use super::lists::{BandLists, Listed};
use crate::shader::generated::{BIN_SPLIT, SQUARE_BITS};

/// Where at most so many copies may show in a quarter of 4 x 4 pixels, each has squares of its own:
/// fragments that know their copy beforehand take half as long as those that look it up in a list.
const MOST_SPOTS: usize = 3;

/// The pixels of each quarter of a square.
const QUARTERS: [u64; 4] = [
    0x0f0f_0f0f,
    0xf0f0_f0f0,
    0x0f0f_0f0f << 32,
    0xf0f0_f0f0 << 32,
];

/// A square within one of 8 x 8 pixels.
#[derive(Clone, Copy)]
struct Square {
    corner: [u32; 2],
    side: u32,
}

impl Square {
    const WHOLE: Self = Self {
        corner: [0, 0],
        side: SIDE,
    };

    fn pixels(&self) -> u64 {
        let ([x, y], last) = (self.corner, self.side - 1);
        block([x, y, x + last, y + last])
    }

    fn quarters(&self) -> [Self; 4] {
        let ([x, y], side) = (self.corner, self.side / 2);
        [[x, y], [x + side, y], [x, y + side], [x + side, y + side]]
            .map(|corner| Self { corner, side })
    }

    /// Visits squares that hold these pixels and none outside of the picture. Drivers search blocks
    /// of 4 x 4 pixels as one, so smaller squares are taken at the picture's edges alone, and larger
    /// ones where no block would be empty.
    fn cut(&self, pixels: u64, inside: u64, visit: &mut impl FnMut(&Self)) {
        if pixels & self.pixels() == 0 {
            return;
        }
        let fits = self.pixels() & !inside == 0;
        let full = || self.quarters().iter().all(|q| pixels & q.pixels() != 0);
        if fits && (self.side < SIDE || full()) {
            visit(self);
        } else {
            for quarter in self.quarters() {
                quarter.cut(pixels, inside, visit);
            }
        }
    }

    /// As `bin_words.glsl` has its place; `corner`: of the square that it is in, pixels.
    fn place(&self, corner: [u32; 2]) -> u32 {
        let [x, y] = [0, 1].map(|k| corner[k] + self.corner[k]);
        x | y << SQUARE_BITS | self.side.ilog2() << (2 * SQUARE_BITS)
    }
}

impl BandLists {
    /// The copies of a square of 8 x 8 pixels; `inside`: those of its pixels that the picture has.
    pub(super) fn add_squares<'a>(
        &mut self,
        here: impl Iterator<Item = &'a Listed> + Clone,
        corner: [u32; 2],
        inside: u64,
    ) {
        let crowded = |quarter: &u64| {
            let shows = here.clone().filter(|one| one.pixels & quarter != 0);
            shows.count() > MOST_SPOTS
        };
        let several: u64 = QUARTERS.into_iter().filter(crowded).sum();
        let mut all = 0;
        for one in here.clone() {
            all |= one.pixels & inside;
            Square::WHOLE.cut(one.pixels & inside & !several, inside, &mut |square| {
                self.spots
                    .push([square.place(corner), one.copy, 0, one.near]);
            });
        }
        Square::WHOLE.cut(all & several, inside, &mut |square| {
            let pixels = square.pixels();
            let here = here.clone().map(|one| Listed {
                pixels: one.pixels & pixels,
                ..*one
            });
            self.add_several(
                here.filter(|one| one.pixels != 0),
                square,
                square.place(corner),
            );
        });
    }

    /// A square in which several copies may show.
    fn add_several(
        &mut self,
        here: impl Iterator<Item = Listed> + Clone,
        square: &Square,
        place: u32,
    ) {
        let near = here.clone().next().map_or(0, |one| one.near);
        let count = here.clone().count() as u32;
        let entries: u32 = here.clone().map(|one| one.pixels.count_ones()).sum();
        if !Self::splits(count, entries, square.side * square.side) {
            let first = self.words.len() as u32;
            self.words.extend(here.flat_map(|one| [one.copy, one.near]));
            self.bins.push([place, first, count, near]);
            return;
        }
        let lists = self.split(here);
        let first = self.words.len() as u32;
        let pixels = square.pixels();
        for (pixel, [begin, count]) in lists.into_iter().enumerate() {
            if pixels >> pixel & 1 == 1 {
                self.words.extend([begin.wrapping_sub(first), count]);
            }
        }
        self.bins
            .push([place, first, BIN_SPLIT | square.side, near]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::lists::Visitor;
    use super::super::lists::tests::{ACROSS, SQUARES, copies, list, shown};
    use super::*;
    use std::collections::BTreeMap;

    /// What is searched for each pixel: copies of spots, and the list of a square of several.
    #[derive(Default)]
    struct Found {
        spots: Vec<u32>,
        list: Option<Vec<u32>>,
    }

    fn place_of(word: u32) -> (std::ops::Range<u32>, std::ops::Range<u32>) {
        let mask = (1 << SQUARE_BITS) - 1;
        let side = 1 << (word >> (2 * SQUARE_BITS));
        let (x, y) = (word & mask, word >> SQUARE_BITS & mask);
        (x..x + side, y..y + side)
    }

    fn found(lists: &BandLists, inside: impl Fn(u32, u32) -> bool) -> BTreeMap<(u32, u32), Found> {
        let mut all = BTreeMap::<_, Found>::new();
        let mut each = |place: u32, visit: &mut dyn FnMut(&mut Found, u32)| {
            let (across, down) = place_of(place);
            let pixels = down.flat_map(|y| across.clone().map(move |x| (x, y)));
            for (n, (x, y)) in (0..).zip(pixels) {
                assert!(inside(x, y), "{x} {y}");
                visit(all.entry((x, y)).or_default(), n);
            }
        };
        for &[place, copy, none, near] in &lists.spots {
            assert_eq!((none, near), (0, 100 + copy));
            each(place, &mut |pixel, _| {
                assert!(!pixel.spots.contains(&copy));
                pixel.spots.push(copy);
            });
        }
        for &[place, first, count, _] in &lists.bins {
            let split = count & BIN_SPLIT != 0;
            let (across, _) = place_of(place);
            assert!(!split || count ^ BIN_SPLIT == across.end - across.start);
            each(place, &mut |pixel, n| {
                let (begin, count) = if split {
                    let at = (first + 2 * n) as usize;
                    (first.wrapping_add(lists.words[at]), lists.words[at + 1])
                } else {
                    (first, count)
                };
                assert!(
                    pixel
                        .list
                        .replace(list(&lists.words, begin, count))
                        .is_none()
                );
            });
        }
        all
    }

    #[test]
    fn squares_hold_what_their_pixels_show() {
        // The picture ends within squares, on either side.
        let inside = |x: u32, y: u32| (3..8 * ACROSS - 1).contains(&x) && (2..21).contains(&y);
        let own = |[x, y]: [u32; 2]| {
            let is_inside = |k: &u32| inside(SIDE * x + k % SIDE, SIDE * y + k / SIDE);
            (0..64).filter(is_inside).map(|k| 1u64 << k).sum::<u64>()
        };
        let corner = |square| [square % ACROSS, square / ACROSS];
        let mut copies = copies();
        for one in &mut copies {
            one.pixels &= own(corner(one.square));
        }
        let lists = BandLists::new(&copies, SQUARES, Visitor::Fragments, corner, own);
        let found = found(&lists, inside);
        for ((x, y), wanted) in shown() {
            if !inside(x, y) {
                continue;
            }
            let all = &found[&(x, y)];
            match &all.list {
                Some(list) => {
                    assert!(list.is_sorted() && all.spots.is_empty());
                    assert!(wanted.iter().all(|copy| list.contains(copy)));
                }
                None => {
                    assert!(all.spots.len() <= MOST_SPOTS);
                    assert!(wanted.iter().all(|copy| all.spots.contains(copy)));
                }
            }
        }
        assert!(found.values().any(|one| one.list.is_some()));
        assert!(found.values().any(|one| one.spots.len() > 1));
    }
}
