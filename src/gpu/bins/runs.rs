//! Rectangles that fragments of bins are drawn for.

use super::cover::SIDE;

/// Part of a row of bins, in pixels.
struct Run {
    /// Number of its first bin.
    number: u32,
    /// The end of its last bin.
    end: u32,
    x: [u32; 2],
    y: [u32; 2],
    near: u32,
}

/// Two rectangles become one if that one holds at most so many blocks of pixels more than both: its
/// two triangles less cost about as much.
const SPARE_BLOCKS: u32 = 4;

/// Rectangles of bins, of which the first has this number; `masks`: the pixels of each that show
/// something. As `bin_words.glsl` has them.
pub(super) fn runs(first: u32, bins: &[[u32; 4]], masks: &[u64]) -> Vec<[u32; 4]> {
    let mut all: Vec<Run> = Vec::new();
    for (number, (&bin, &mask)) in (first..).zip(bins.iter().zip(masks)) {
        let run = Run::new(number, bin, mask);
        match all.last_mut() {
            Some(last) if last.takes(&run) => *last = last.with(&run),
            _ => all.push(run),
        }
    }
    all.into_iter().map(Run::words).collect()
}

impl Run {
    /// Of the pixels of a bin that show something.
    fn new(number: u32, [corner, _, _, near]: [u32; 4], mask: u64) -> Self {
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

    /// Whether both are drawn as one: they lie side by side, and little is drawn besides.
    fn takes(&self, next: &Self) -> bool {
        let beside = self.end + SIDE == next.end && self.y[0] / SIDE == next.y[0] / SIDE;
        beside && self.with(next).blocks() <= self.blocks() + next.blocks() + SPARE_BLOCKS
    }

    /// Both, the next to the right.
    fn with(&self, next: &Self) -> Self {
        Self {
            number: self.number,
            end: next.end,
            x: [self.x[0], next.x[1]],
            y: [self.y[0].min(next.y[0]), self.y[1].max(next.y[1])],
            near: self.near.min(next.near),
        }
    }

    /// Blocks of 4x2 pixels that it touches.
    fn blocks(&self) -> u32 {
        let count = |[from, to]: [u32; 2], side: u32| to.div_ceil(side) - from / side;
        count(self.x, 4) * count(self.y, 2)
    }

    /// As `bin_words.glsl` has it.
    fn words(self) -> [u32; 4] {
        let [from, to] = [0, 1].map(|k| self.x[k] | self.y[k] << 16);
        [from, self.number, to, self.near]
    }
}
