//! Quads of pixels that fragments are drawn for.

use super::cover::{SIDE, block};
use super::deal::{BandLists, Listed};
use crate::shader::generated::QUAD_BITS;

/// A quad within a tile.
#[derive(Clone, Copy)]
struct Quad {
    corner: [u32; 2],
    side: u32,
}

impl Quad {
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

    /// Visits quads that hold these pixels and none outside of the picture. Drivers search blocks
    /// of 4 x 4 pixels as one, so smaller quads are taken at the picture's edges alone, and larger
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

    /// As `tile_words.glsl` has its place; `corner`: of the tile that it is in, pixels.
    fn place(&self, corner: [u32; 2]) -> u32 {
        let [x, y] = [0, 1].map(|k| corner[k] + self.corner[k]);
        x | y << QUAD_BITS | self.side.ilog2() << (2 * QUAD_BITS)
    }
}

impl BandLists {
    /// The quads of a copy in a tile; `inside`: those of its pixels that the picture has.
    pub(super) fn add_quads(&mut self, one: &Listed, corner: [u32; 2], inside: u64) {
        Quad::WHOLE.cut(one.pixels & inside, inside, &mut |quad| {
            self.quads.push([quad.place(corner), one.copy, 0, one.near]);
        });
    }
}
