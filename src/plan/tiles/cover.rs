//! Pixels that solids are proven to cover, and their depths. A square of 8 x 8 pixels has one bit
//! per pixel and one depth per row. One depth per row is enough because, on a field, the copies in
//! a row of pixels have similar depths.

use super::bounds::{ProjectedAxes, SIDE, SLACK, first_pixel, last_pixel};
use crate::surface::{CylinderPiece, Cylinders};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// A range of columns of squares.
pub(super) struct Cover {
    squares: Vec<Square>,
    /// Unit: squares.
    columns: Range<u32>,
    down: u32,
    /// Same value as the projector's.
    margin: f64,
}

#[derive(Clone, Copy, Default)]
struct Square {
    covered: u64,
    /// Largest depth of the covered pixels of each row.
    depths: [f32; SIDE as usize],
}

impl Square {
    /// The covered pixels whose cover is nearer than `near`.
    fn hidden(&self, near: f32) -> u64 {
        if self.covered == 0 {
            return 0;
        }
        let behind = self.depths.map(|depth| if near > depth { 0xff } else { 0 });
        self.covered & u64::from_le_bytes(behind)
    }
}

/// Bits from column `low` to `high` in every row from `top` to `bottom`, all inclusive.
pub(super) fn block([low, top, high, bottom]: [u32; 4]) -> u64 {
    let row = (0xffu64 >> (7 - (high - low))) << low;
    let rows = (u64::MAX >> (8 * (7 - (bottom - top)))) << (8 * top);
    (row * 0x0101_0101_0101_0101) & rows
}

/// The bits of a square that are in a rectangle of pixels. Unit of `x` and `y`: squares.
pub(super) fn within([x, y]: [u32; 2], [x0, y0, x1, y1]: [u32; 4]) -> u64 {
    let inside = |pixel: u32, square: u32| pixel.clamp(square * SIDE, square * SIDE + 7) % SIDE;
    block([inside(x0, x), inside(y0, y), inside(x1, x), inside(y1, y)])
}

/// The bits of a square in a span of each row: first pixel, end. `top`: row of the first span.
pub(super) fn within_rows([x, y]: [u32; 2], spans: &[[i32; 2]], top: u32) -> u64 {
    let left = (x * SIDE) as i32;
    let place = |pixel: i32| pixel.clamp(left, left + SIDE as i32) - left;
    u64::from_le_bytes(std::array::from_fn(|k| {
        let row = (y * SIDE + k as u32).checked_sub(top);
        let span = row.and_then(|row| spans.get(row as usize));
        span.map_or(0, |span| {
            let [low, end] = span.map(place);
            (0xffu32 << low & !(0xff << end)) as u8
        })
    }))
}

/// Least rows of pixels of half a disc that is added. All discs (0) take a third more of the CPU's time
/// for a new view of 10,000 copies, and whole frames of them 1.05 to 1.07 of the time.
const LEAST_DISC: f64 = 4.0;

impl Cover {
    /// An empty cover of these columns of squares and `down` rows.
    pub fn new(columns: Range<u32>, down: u32, margin: f64) -> Self {
        Self {
            squares: vec![Square::default(); columns.len() * down as usize],
            columns,
            down,
            margin,
        }
    }

    /// True if some of these pixels are in the columns.
    pub fn meets(&self, [x0, _, x1, _]: [u16; 4]) -> bool {
        u32::from(x0) < SIDE * self.columns.end && u32::from(x1) >= SIDE * self.columns.start
    }

    /// True if nothing at `near` or farther can ever show in these pixels. Later copies may cover
    /// other pixels of the same rows without changing this.
    pub fn hides(&self, pixels: [u16; 4], near: f32) -> bool {
        let [x0, y0, x1, y1] = self.squares_of(pixels);
        let [_, top, _, bottom] = pixels.map(u32::from);
        (y0..=y1).all(|y| {
            let rows = within([0, y], [0, top, SIDE - 1, bottom]);
            let row = &self.squares[self.at(x0, y)..=self.at(x1, y)];
            row.iter().all(|square| !square.hidden(near) & rows == 0)
        })
    }

    /// The squares of the cover that hold some of these pixels: left, top, right, bottom, all
    /// inclusive.
    fn squares_of(&self, pixels: [u16; 4]) -> [u32; 4] {
        let [x0, y0, x1, y1] = pixels.map(|pixel| u32::from(pixel) / SIDE);
        let Range { start, end } = self.columns;
        [x0.max(start), y0, x1.min(end - 1), y1.min(self.down - 1)]
    }

    /// The index of the square in this column and row.
    pub fn at(&self, x: u32, y: u32) -> usize {
        (y * (self.columns.end - self.columns.start) + x - self.columns.start) as usize
    }

    /// Finds the squares in which some of these pixels may show a copy at `near` or farther: the
    /// square's position in the picture, and the pixels.
    pub fn open(&self, pixels: [u16; 4], near: f32, found: &mut Vec<([u32; 2], u64)>) {
        let [x0, y0, x1, y1] = self.squares_of(pixels);
        let pixels = pixels.map(u32::from);
        found.clear();
        for y in y0..=y1 {
            for x in x0..=x1 {
                let hidden = self.squares[self.at(x, y)].hidden(near);
                let bits = within([x, y], pixels) & !hidden;
                if bits != 0 {
                    found.push(([x, y], bits));
                }
            }
        }
    }

    /// Adds the pixels that a copy hides. The copy must be wholly behind the
    /// near plane.
    pub fn add(&mut self, axes: &ProjectedAxes, inner: &Cylinders, pixels: [u16; 4]) {
        let high = pixels[3] - pixels[1];
        // The section through the axis that faces the eye.
        let beside = axes.eye.truncate();
        let across = beside.perp().normalize_or(DVec2::X);
        let across = axes.along[0] * across.x + axes.along[1] * across.y;
        for piece in inner.of(u32::from(high)) {
            let [low, top] = [piece.low, piece.high].map(|z| axes.middle + axes.along[2] * z);
            let out = across * piece.radius;
            self.polygon(&[low - out, low + out, top + out, top - out]);
            if high >= 6 {
                self.disc(axes, piece, beside.length());
            }
        }
    }

    /// Adds the end of a piece that faces the eye, if the eye sees it from a steep angle.
    fn disc(&mut self, axes: &ProjectedAxes, piece: &CylinderPiece, beside: f64) {
        let z = axes.eye.z.clamp(piece.low, piece.high);
        if (axes.eye.z - z).abs() < 0.3 * beside {
            return;
        }
        let middle = axes.middle + axes.along[2] * z;
        let [x, y] = [0, 1].map(|k| axes.along[k] * piece.radius);
        // A disc seen from the side covers few pixels that the section through the axis does not.
        let place = middle.y / middle.z;
        let [a, b] = [x, y].map(|way| way.y - way.z * place);
        if a.hypot(b) < LEAST_DISC * middle.z {
            return;
        }
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

    /// Marks the pixels whose rays all meet a flat convex polygon inside the solid.
    fn polygon<const N: usize>(&mut self, corners: &[DVec3; N]) {
        let mut flat = [DVec2::ZERO; N];
        let (mut low, mut high, mut depth) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0f64);
        for (at, corner) in flat.iter_mut().zip(corners) {
            *at = corner.truncate() * corner.z.recip();
            (low, high, depth) = (low.min(*at), high.max(*at), depth.max(corner.z));
        }
        let depth = (depth * (1.0 + SLACK)) as f32;
        // Many distant polygons contain the centre of no pixel.
        let ends = [self.columns.start, self.columns.end].map(|x| (x * SIDE) as i32);
        let left = first_pixel(low.x + self.margin).max(ends[0]);
        let right = last_pixel(high.x - self.margin).min(ends[1] - 1);
        let mut first = first_pixel(low.y + self.margin).max(0);
        let mut last = last_pixel(high.y - self.margin).min((self.down * SIDE) as i32 - 1);
        if first > last || left > right {
            return;
        }
        let area: f64 = (0..N).map(|k| flat[k].perp_dot(flat[(k + 1) % N])).sum();
        if area == 0.0 || !area.is_finite() {
            return;
        }
        // Lower and upper bounds on x from the edges: the value at the top of the picture, and the
        // change per row.
        let (mut bounds, mut counts) = ([[[0.0f64; 2]; N]; 2], [0; 2]);
        for k in 0..N {
            let (p, q) = (flat[k], flat[(k + 1) % N]);
            let n = (q - p).perp() * area.signum();
            let least = n.dot(p) + self.margin * (n.x.abs() + n.y.abs());
            if n.x.abs() > 1e-9 * n.y.abs() {
                let side = usize::from(n.x < 0.0);
                bounds[side][counts[side]] = [least / n.x, -n.y / n.x];
                counts[side] += 1;
            } else if n.y > 0.0 {
                first = first.max(first_pixel(least / n.y));
            } else if n.y < 0.0 {
                last = last.min(last_pixel(least / n.y));
            }
        }
        let [lows, highs] = [0, 1].map(|side| &bounds[side][..counts[side]]);
        for y in first..=last {
            let row = f64::from(y) + 0.5;
            let at = |[begin, step]: &[f64; 2]| begin + step * row;
            // Comparisons are one instruction; `f64::max` also looks for NaN, which none of these is.
            let larger = |a: f64, b: f64| if a > b { a } else { b };
            let smaller = |a: f64, b: f64| if a < b { a } else { b };
            let low = lows.iter().map(at).fold(f64::NEG_INFINITY, larger);
            let high = highs.iter().map(at).fold(f64::INFINITY, smaller);
            let (low, high) = (first_pixel(low).max(left), last_pixel(high).min(right));
            self.span(y as u32, low, high, depth);
        }
    }

    /// Marks the pixels of a row from `low` to `high`; none if `low > high`.
    fn span(&mut self, y: u32, low: i32, high: i32, depth: f32) {
        if low > high {
            return;
        }
        let (low, high) = (low as u32, high as u32);
        let (first, last, k) = (low / SIDE, high / SIDE, y % SIDE);
        let squares = self.at(first, y / SIDE)..=self.at(last, y / SIDE);
        for (square, x) in self.squares[squares].iter_mut().zip(first..) {
            let left = low.max(x * SIDE) - x * SIDE;
            let right = high.min(x * SIDE + 7) - x * SIDE;
            let bits = block([left, k, right, k]);
            if bits & !square.covered != 0 {
                square.covered |= bits;
                let row = &mut square.depths[k as usize];
                *row = row.max(depth);
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
        let mut cover = Cover::new(0..4, 4, 1.0 / 16.0);
        let at = |x: f64, y: f64| DVec3::new(2.0 * x, 2.0 * y, 2.0);
        cover.polygon(&[at(3.0, 4.0), at(21.0, 4.0), at(21.0, 20.0), at(3.0, 20.0)]);
        let open = |cover: &Cover, pixels, near| {
            let mut found = Vec::new();
            cover.open(pixels, near, &mut found);
            found
        };
        let count = |cover: &Cover, near| -> u32 {
            let all = open(cover, [0, 0, 31, 31], near).into_iter();
            all.map(|(_, bits)| bits.count_ones()).sum()
        };
        assert_eq!(count(&cover, 1.9), 1024);
        assert_eq!(count(&cover, 2.1), 1024 - 18 * 16);
        assert!(open(&cover, [3, 4, 20, 19], 2.1).is_empty());
        // Clockwise or counterclockwise, and slanted: no pixel outside is marked.
        cover.polygon(&[
            at(31.0, 31.0),
            at(20.0, 31.0),
            at(31.0, 20.0),
            at(31.0, 30.0),
        ]);
        for ([left, top], bits) in open(&cover, [0, 0, 31, 31], 2.1) {
            for bit in (0..64).filter(|bit| bits & (1 << bit) == 0) {
                let (x, y) = (left * 8 + bit % 8, top * 8 + bit / 8);
                let first = (3..21).contains(&x) && (4..20).contains(&y);
                assert!(first || x + y >= 50, "{x} {y}");
            }
        }
    }
}
