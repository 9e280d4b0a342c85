//! Quads of pixels for which fragments are drawn.

use super::cover::{SIDE, block};
use super::deal::{BandRecords, TileCopy};
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

    /// Visits quads that hold these pixels and no pixel outside of the picture. Drivers search
    /// blocks of 4 x 4 pixels as one. Smaller quads are therefore used only at the picture's edges,
    /// and larger ones only where no block would be empty.
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

    /// The quad's position in the layout of `tile_words.glsl`. `corner`: pixel of its tile's
    /// corner.
    fn packed(&self, corner: [u32; 2]) -> u32 {
        let [x, y] = [0, 1].map(|k| corner[k] + self.corner[k]);
        x | y << QUAD_BITS | self.side.ilog2() << (2 * QUAD_BITS)
    }
}

impl BandRecords {
    /// Adds the quads of a copy in a tile. `inside`: the tile's pixels that are in the picture.
    pub(super) fn add_quads(&mut self, one: &TileCopy, corner: [u32; 2], inside: u64) {
        Quad::WHOLE.cut(one.pixels & inside, inside, &mut |quad| {
            self.quads
                .push([quad.packed(corner), one.copy, 0, one.near]);
        });
    }
}
