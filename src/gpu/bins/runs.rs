//! Rectangles that fragments of bins are drawn for.

use super::cover::SIDE;

/// Part of a row of bins, in pixels.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// Number of its first bin.
    number: u32,
    /// The end of its last bin.
    end: u32,
    x: [u32; 2],
    y: [u32; 2],
    near: u32,
}

/// Blocks of pixels that a rectangle may hold more than two do that it is drawn in place of: what
/// two triangles cost.
const SPARE_BLOCKS: u32 = 4;

impl Run {
    /// Of the pixels of a bin that show something.
    pub fn new(number: u32, [corner, _, _, near]: [u32; 4], mask: u64) -> Self {
        let [left, top] = [corner & 0xffff, corner >> 16];
        let columns = (0..8).fold(0u64, |all, row| all | mask >> (8 * row) & 0xff);
        let ends = |bits: u64| [bits.trailing_zeros(), u64::BITS - bits.leading_zeros()];
        let [y0, y1] = ends(mask);
        Self {
            number,
            end: left + SIDE,
            x: ends(columns).map(|x| left + x),
            y: [top + y0 / SIDE, top + y1.div_ceil(SIDE)],
            near,
        }
    }

    /// Both as one, if they lie side by side and little is drawn besides.
    pub fn joined(self, next: Self) -> Option<Self> {
        if self.end + SIDE != next.end || self.y[0] / SIDE != next.y[0] / SIDE {
            return None;
        }
        let both = Self {
            end: next.end,
            x: [self.x[0], next.x[1]],
            y: [self.y[0].min(next.y[0]), self.y[1].max(next.y[1])],
            near: self.near.min(next.near),
            ..self
        };
        let most = self.blocks() + next.blocks() + SPARE_BLOCKS;
        (both.blocks() <= most).then_some(both)
    }

    /// Blocks of 4x2 pixels that it touches.
    fn blocks(&self) -> u32 {
        let count = |[from, to]: [u32; 2], side: u32| to.div_ceil(side) - from / side;
        count(self.x, 4) * count(self.y, 2)
    }

    /// As `bin_words.glsl` has it.
    pub fn words(self) -> [u32; 4] {
        let [from, to] = [0, 1].map(|k| self.x[k] | self.y[k] << 16);
        [from, self.number, to, self.near]
    }
}
