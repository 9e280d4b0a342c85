//! The pixels of a picture that are drawn.

use super::projector::{Rectangle, TILE_PIXELS};
use crate::shader::generated::{GROUP_PIXELS, NO_PIXEL};

/// Pixels of a picture that the compute stage draws; others may be left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpenPixels {
    /// Columns and rows, tile by tile.
    pixels: Vec<[u16; 2]>,
}

impl OpenPixels {
    /// The pixels of a picture of this width, row 0 on top.
    #[must_use]
    pub fn new(width: u32, pixels: &[bool]) -> Self {
        let wide = width.max(1) as usize;
        let side = GROUP_PIXELS as usize;
        let mut all = Vec::new();
        for (rows, top) in pixels.chunks(wide * side).zip((0..).step_by(side)) {
            for left in (0..wide).step_by(side) {
                for (row, y) in rows.chunks(wide).zip(top..) {
                    let of_tile =
                        (left..wide.min(left + side)).filter(|x| row.get(*x) == Some(&true));
                    all.extend(of_tile.map(|x| [x as u16, y as u16]));
                }
            }
        }
        Self { pixels: all }
    }

    /// Adds those in a rectangle to a buffer of open pixels: see `walk.comp`. They fill whole work
    /// groups.
    pub(super) fn add_within(&self, [left, top, right, bottom]: Rectangle, to: &mut Vec<u32>) {
        let words = self.pixels.iter().map(|at| at.map(u32::from));
        let within =
            words.filter(|[x, y]| (left..=right).contains(x) && (top..=bottom).contains(y));
        to.extend(within.map(|[x, y]| x | y << 16));
        to.resize(to.len().next_multiple_of(TILE_PIXELS as usize), NO_PIXEL);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_is_there_once_beside_those_of_its_tile() {
        let (width, height) = (21, 10);
        let is_open = |x: u32, y: u32| (x * 7 + y * 5).is_multiple_of(3);
        let pixels: Vec<bool> = (0..height)
            .flat_map(|y| (0..width).map(move |x| is_open(x, y)))
            .collect();
        let open = OpenPixels::new(width, &pixels);
        for [left, top, right, bottom] in [[0, 0, 20, 9], [3, 2, 8, 8], [30, 0, 40, 9]] {
            let mut words = vec![NO_PIXEL; 64];
            open.add_within([left, top, right, bottom], &mut words);
            assert!(words.len().is_multiple_of(64));
            let found: Vec<_> = (words.iter().filter(|word| **word != NO_PIXEL))
                .map(|word| [word & 0xffff, word >> 16])
                .collect();
            let mut wanted: Vec<_> = (0..height)
                .flat_map(|y| (0..width).map(move |x| [x, y]))
                .filter(|[x, y]| is_open(*x, *y))
                .filter(|[x, y]| (left..=right).contains(x) && (top..=bottom).contains(y))
                .collect();
            wanted.sort_by_key(|[x, y]| [y / 8, x / 8, *y, *x]);
            assert_eq!(found, wanted);
        }
    }
}
