//! Pixels that solids are proven to cover, and how deep: squares of 8 x 8 pixels, a bit for each,
//! with one depth.

use super::inner::{Inner, Piece};
use super::seen::{MARGIN, SLACK, Spread};
use glam::{DVec2, DVec3};

/// Pixels along a square's side.
pub(super) const SIDE: u32 = 8;

/// Some rows of squares.
pub(super) struct Cover {
    squares: Vec<Square>,
    across: u32,
    /// In pixels.
    pub top: u32,
    pub bottom: u32,
}

#[derive(Clone, Copy)]
struct Square {
    covered: u64,
    /// Of all that covers.
    depth: f32,
}

/// Bits from column `low` to `high` in every row from `top` to `bottom`, all included.
pub(super) fn block([low, top, high, bottom]: [u32; 4]) -> u64 {
    let row = (0xffu64 >> (7 - (high - low))) << low;
    let rows = (u64::MAX >> (8 * (7 - (bottom - top)))) << (8 * top);
    (row * 0x0101_0101_0101_0101) & rows
}

/// The bits of a square, `x` and `y` in squares, that a rectangle of pixels holds.
pub(super) fn within([x, y]: [u32; 2], [x0, y0, x1, y1]: [u32; 4]) -> u64 {
    let inside = |pixel: u32, square: u32| pixel.clamp(square * SIDE, square * SIDE + 7) % SIDE;
    block([inside(x0, x), inside(y0, y), inside(x1, x), inside(y1, y)])
}

impl Cover {
    /// Of squares across the picture, in rows of squares from `first` to below `end`.
    pub fn new(across: u32, first: u32, end: u32) -> Self {
        let none = Square {
            covered: 0,
            depth: 0.0,
        };
        Self {
            squares: vec![none; (across * (end - first)) as usize],
            across,
            top: first * SIDE,
            bottom: end * SIDE,
        }
    }

    /// Whether some of these pixels may show what is not nearer than `near`.
    pub fn is_open(&self, pixels: [u16; 4], near: f32) -> bool {
        let [x0, y0, x1, y1] = pixels.map(u32::from);
        let (y0, y1) = (y0.max(self.top), y1.min(self.bottom - 1));
        let open = |x: u32, y: u32| {
            let square = self.squares[((y - self.top / SIDE) * self.across + x) as usize];
            near <= square.depth || within([x, y], [x0, y0, x1, y1]) & !square.covered != 0
        };
        (y0 / SIDE..=y1 / SIDE).any(|y| (x0 / SIDE..=x1 / SIDE).any(|x| open(x, y)))
    }

    /// Visits the squares in which some of these pixels may show what is not nearer than `near`:
    /// the square's number and the pixels. `rows`: of each row of pixels that is here the ends of
    /// what may show, where they are known.
    pub fn open(
        &self,
        pixels: [u16; 4],
        rows: Option<&[[f64; 2]]>,
        near: f32,
        mut visit: impl FnMut(u32, u64),
    ) {
        let [x0, y0, x1, y1] = pixels.map(u32::from);
        let (y0, y1) = (y0.max(self.top), y1.min(self.bottom - 1));
        for y in y0 / SIDE..=y1 / SIDE {
            let (top, bottom) = (y0.max(y * SIDE) - y * SIDE, y1.min(y * SIDE + 7) - y * SIDE);
            let (mut from, mut to) = (x0, x1);
            let mut spans = [[1u32, 0]; SIDE as usize];
            if let Some(rows) = rows {
                (from, to) = (u32::MAX, 0);
                for k in top..=bottom {
                    let [low, high] = rows[(y * SIDE + k - y0) as usize];
                    let low = (low - 0.5).ceil().max(f64::from(x0));
                    let high = (high - 0.5).floor().min(f64::from(x1));
                    if low <= high {
                        spans[k as usize] = [low as u32, high as u32];
                        (from, to) = (from.min(low as u32), to.max(high as u32));
                    }
                }
                if from > to {
                    continue;
                }
            }
            for x in from / SIDE..=to / SIDE {
                let number = (y - self.top / SIDE) * self.across + x;
                let square = self.squares[number as usize];
                let mut bits = if rows.is_some() {
                    (0u32..).zip(&spans).fold(0, |all, (k, &[low, high])| {
                        let (left, right) = (low.max(x * SIDE), high.min(x * SIDE + 7));
                        if left > right {
                            return all;
                        }
                        all | block([left - x * SIDE, k, right - x * SIDE, k])
                    })
                } else {
                    within([x, y], [x0, y0, x1, y1])
                };
                if near > square.depth {
                    bits &= !square.covered;
                }
                if bits != 0 {
                    visit(number, bits);
                }
            }
        }
    }

    /// Adds what a copy hides, which is wholly in front of the eye.
    pub fn add(&mut self, spread: &Spread, inner: &Inner, pixels: [u16; 4]) {
        let high = pixels[3] - pixels[1];
        // The section through the axis that faces the eye.
        let beside = spread.eye.truncate();
        let across = beside.perp().normalize_or(DVec2::X);
        let across = spread.along[0] * across.x + spread.along[1] * across.y;
        for piece in inner.of(u32::from(high)) {
            let [low, top] = [piece.low, piece.high].map(|z| spread.middle + spread.along[2] * z);
            let out = across * piece.radius;
            self.polygon(&[low - out, low + out, top + out, top - out]);
            if high >= 6 {
                self.disc(spread, piece, beside.length());
            }
        }
    }

    /// The end of a piece that the eye looks down upon, where it looks steeply.
    fn disc(&mut self, spread: &Spread, piece: &Piece, beside: f64) {
        let z = spread.eye.z.clamp(piece.low, piece.high);
        if (spread.eye.z - z).abs() < 0.3 * beside {
            return;
        }
        let middle = spread.middle + spread.along[2] * z;
        let [x, y] = [0, 1].map(|k| spread.along[k] * piece.radius);
        let d = std::f64::consts::FRAC_1_SQRT_2;
        let corners = [
            (1.0, 0.0),
            (d, d),
            (0.0, 1.0),
            (-d, d),
            (-1.0, 0.0),
            (-d, -d),
            (0.0, -1.0),
            (d, -d),
        ];
        self.polygon(&corners.map(|(a, b)| middle + x * a + y * b));
    }

    /// Marks the pixels whose centres a flat convex polygon in the solid covers.
    fn polygon<const N: usize>(&mut self, corners: &[DVec3; N]) {
        let flat = corners.map(|c| c.truncate() / c.z);
        let depth = corners.iter().fold(0.0f64, |m, c| m.max(c.z)) * (1.0 + SLACK);
        let (mut top, mut bottom, mut area) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for (k, p) in flat.iter().enumerate() {
            (top, bottom) = (top.min(p.y), bottom.max(p.y));
            area += p.perp_dot(flat[(k + 1) % N]);
        }
        let first = (top - 0.5 + MARGIN).ceil().max(f64::from(self.top));
        let last = (bottom - 0.5 - MARGIN)
            .floor()
            .min(f64::from(self.bottom) - 1.0);
        if first > last || area == 0.0 || !area.is_finite() {
            return;
        }
        let sense = area.signum();
        // Of each edge x >= at + step y, or x <= that, or a bound on y alone.
        let width = f64::from(self.across * SIDE);
        let edges: [(DVec2, f64, f64); N] = std::array::from_fn(|k| {
            let (p, q) = (flat[k], flat[(k + 1) % N]);
            let n = (q - p).perp() * sense;
            (n, n.dot(p) + MARGIN * (n.x.abs() + n.y.abs()), 1.0 / n.x)
        });
        for y in first as u32..=last as u32 {
            let row = f64::from(y) + 0.5;
            let (mut low, mut high) = (0.5f64, width - 0.5);
            for (n, least, inverse) in &edges {
                let rest = least - n.y * row;
                if n.x.abs() > 1e-9 * n.y.abs() {
                    let x = rest * inverse;
                    if n.x > 0.0 {
                        low = low.max(x);
                    } else {
                        high = high.min(x);
                    }
                } else if rest > 0.0 {
                    high = -1.0;
                }
            }
            let (low, high) = ((low - 0.5).ceil(), (high - 0.5).floor());
            if low <= high {
                self.span(y, low as u32, high as u32, depth as f32);
            }
        }
    }

    fn span(&mut self, y: u32, low: u32, high: u32, depth: f32) {
        let line = (y - self.top) / SIDE * self.across;
        for x in low / SIDE..=high / SIDE {
            let left = low.max(x * SIDE) - x * SIDE;
            let right = high.min(x * SIDE + 7) - x * SIDE;
            let bits = block([left, y % SIDE, right, y % SIDE]);
            let square = &mut self.squares[(line + x) as usize];
            if bits & !square.covered != 0 {
                square.covered |= bits;
                square.depth = square.depth.max(depth);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_rectangles_of_bits() {
        assert_eq!(block([0, 0, 7, 7]), u64::MAX);
        assert_eq!(block([0, 0, 0, 0]), 1);
        assert_eq!(block([7, 7, 7, 7]), 1 << 63);
        assert_eq!(block([1, 2, 3, 2]), 0b1110 << 16);
        assert_eq!(block([1, 2, 3, 3]), 0b1110 << 16 | 0b1110 << 24);
    }

    #[test]
    fn a_polygon_covers_the_pixels_within_and_hides_what_is_behind() {
        let mut cover = Cover::new(4, 0, 4);
        let at = |x: f64, y: f64| DVec3::new(2.0 * x, 2.0 * y, 2.0);
        cover.polygon(&[at(3.0, 4.0), at(21.0, 4.0), at(21.0, 20.0), at(3.0, 20.0)]);
        let open = |cover: &Cover, near| {
            let mut all = 0;
            cover.open([0, 0, 31, 31], None, near, |_, bits| {
                all += bits.count_ones()
            });
            all
        };
        assert_eq!(open(&cover, 1.9), 1024);
        assert_eq!(open(&cover, 2.1), 1024 - 18 * 16);
        let mut hidden = true;
        cover.open([3, 4, 20, 19], None, 2.1, |_, _| hidden = false);
        assert!(hidden);
        // Any way round, at a slant: nothing without.
        cover.polygon(&[
            at(31.0, 31.0),
            at(20.0, 31.0),
            at(31.0, 20.0),
            at(31.0, 30.0),
        ]);
        cover.open([0, 0, 31, 31], None, 2.1, |number, bits| {
            for bit in (0..64).filter(|bit| bits & (1 << bit) == 0) {
                let (x, y) = (number % 4 * 8 + bit % 8, number / 4 * 8 + bit / 8);
                let first = (3..21).contains(&x) && (4..20).contains(&y);
                assert!(first || x + y >= 50, "{x} {y}");
            }
        });
    }
}
