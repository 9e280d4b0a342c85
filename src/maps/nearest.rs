//! Finds the nearest of many segments, exactly, for every texel of a grid.
//!
//! Bands of the grid are cut into squares, which are halved repeatedly. Each keeps only those
//! segments that can be nearest to any of its points. Two tests reject the others:
//!
//! * Let `m` be the least distance from its middle to a segment, and `q` half of its diagonal. A
//!   segment farther than `m + 2 q` is nearest nowhere: both distances change by at most `q` on the
//!   way to any point.
//! * Let `b` be the point, on any segment, that is nearest to the middle. A segment is nearest
//!   nowhere if `b` is nearer than it at all four corners. The reason: for each point `s` of the
//!   segment, `|p - s|^2 - |p - b|^2` is linear in `p`, and so is least at a corner.
//!
//! Squares of 4 x 4 texels keep a handful of segments, which are all measured. The result is exact,
//! without approximation.

use crate::error::Result;
use crate::host_memory;
use crate::profile::Segment;
use glam::DVec2;
use rayon::prelude::*;

/// Rows of the bands that are processed independently, and side of their squares, texels.
const TILE: usize = 128;
/// Side of the squares that are not halved further, texels.
const LEAF: usize = 4;
/// Fewer segments than this cost more to halve than to measure.
const FEW: usize = 3;

/// Evaluates `value(column, row, distance, segment)` for every texel of a grid of `[columns, rows]`
/// square texels of side `1 / rows`. Texel (0, 0) is at the top left, the axis at the left edge.
/// `distance` is from the texel's centre to the nearest segment in object units, `segment` the
/// index of that segment. Without segments they are `+inf` and 0.
pub(crate) fn for_each_texel<T: Copy + Default + Send>(
    segments: &[Segment],
    [columns, rows]: [usize; 2],
    value: impl Fn(usize, usize, f64, usize) -> T + Sync,
) -> Result<Vec<T>> {
    let what = "the texels of a map";
    let mut out = host_memory::filled(columns * rows, T::default(), what)?;
    let side = rows as f64;
    let search = Search {
        pieces: segments.iter().map(|s| Piece::new(s, side)).collect(),
        columns,
        rows,
        value,
    };
    let bands = out.par_chunks_mut((columns * TILE).max(1)).enumerate();
    bands.for_each(|(band, out)| {
        let top = band * TILE;
        let mut stack: Vec<u32> = (0..segments.len() as u32).collect();
        search.narrow([0, top], [columns, TILE], 0, &mut stack);
        let end = stack.len();
        for left in (0..columns).step_by(TILE) {
            search.narrow([left, top], [TILE; 2], segments.len(), &mut stack);
            search.fill([left, top], TILE, end, &mut stack, top, out);
            stack.truncate(end);
        }
    });
    Ok(out)
}

/// A segment in texels, y downwards, prepared for measuring.
#[derive(Clone, Copy)]
struct Piece {
    start: DVec2,
    along: DVec2,
    inverse: f64,
}

impl Piece {
    fn new(s: &Segment, side: f64) -> Self {
        let place = |p: DVec2| DVec2::new(p.x * side, (1.0 - p.y) * side);
        let (start, along) = (place(s.a), place(s.b) - place(s.a));
        let length2 = along.length_squared();
        Self {
            start,
            along,
            inverse: if length2 > 0.0 { 1.0 / length2 } else { 0.0 },
        }
    }

    fn nearest(&self, p: DVec2) -> DVec2 {
        let t = ((p - self.start).dot(self.along) * self.inverse).clamp(0.0, 1.0);
        self.start + self.along * t
    }

    fn squared(&self, p: DVec2) -> f64 {
        self.nearest(p).distance_squared(p)
    }
}

struct Search<F> {
    pieces: Vec<Piece>,
    columns: usize,
    rows: usize,
    value: F,
}

impl<F> Search<F> {
    /// Appends to the stack those entries, from `from` on, that can be nearest within a rectangle of
    /// texels.
    fn narrow(&self, corner: [usize; 2], sides: [usize; 2], from: usize, stack: &mut Vec<u32>) {
        let vector = |[x, y]: [usize; 2]| DVec2::new(x as f64, y as f64);
        // Only texel centres are evaluated, so the rectangle ends half a texel inside its texels.
        let half = 0.5 * (vector(sides) - 1.0);
        let middle = vector(corner) + 0.5 + half;
        let end = stack.len();
        let (mut least, mut which) = (f64::INFINITY, 0);
        for &k in &stack[from..end] {
            let squared = self.pieces[k as usize].squared(middle);
            if squared < least {
                (least, which) = (squared, k);
            }
        }
        if from == end {
            return;
        }
        // The slack covers rounding only; too many candidates do no harm.
        let reach = (least.sqrt() + 2.0 * half.length()) * (1.0 + 1e-12) + 1e-9;
        let near = self.pieces[which as usize].nearest(middle);
        let signs = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let corners = signs
            .map(|(x, y)| middle + half * DVec2::new(x, y))
            .map(|corner| (corner, corner.distance_squared(near) * (1.0 + 1e-12) + 1e-9));
        for k in from..end {
            let candidate = stack[k];
            let piece = &self.pieces[candidate as usize];
            if candidate == which
                || piece.squared(middle) <= reach * reach
                    && corners
                        .iter()
                        .any(|&(corner, limit)| piece.squared(corner) <= limit)
            {
                stack.push(candidate);
            }
        }
    }
}

impl<T, F: Fn(usize, usize, f64, usize) -> T> Search<F> {
    /// Fills a square of `out`, whose first row is row `top` of the grid, from the candidates
    /// `stack[from..]`.
    fn fill(
        &self,
        [x, y]: [usize; 2],
        side: usize,
        from: usize,
        stack: &mut Vec<u32>,
        top: usize,
        out: &mut [T],
    ) {
        if x >= self.columns || y >= self.rows {
            return;
        }
        if side > LEAF && stack.len() - from > FEW {
            let half = side / 2;
            let end = stack.len();
            for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
                let corner = [x + dx, y + dy];
                self.narrow(corner, [half; 2], from, stack);
                self.fill(corner, half, end, stack, top, out);
                stack.truncate(end);
            }
            return;
        }
        for row in y..(y + side).min(self.rows) {
            let line = &mut out[(row - top) * self.columns..][..self.columns];
            for (column, value) in line.iter_mut().enumerate().skip(x).take(side) {
                let p = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let (mut best, mut which) = (f64::INFINITY, 0);
                for &k in &stack[from..] {
                    let d = self.pieces[k as usize].squared(p);
                    if d < best {
                        (best, which) = (d, k as usize);
                    }
                }
                *value = (self.value)(column, row, best.sqrt() / self.rows as f64, which);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn equals_brute_force(
            columns in 1usize..150,
            rows in 1usize..150,
            points in prop::collection::vec([-0.2f64..1.5, -0.3f64..1.3, -0.1f64..0.1, -0.1f64..0.1], 1..120),
        ) {
            let segment = |&[x, y, dx, dy]: &[f64; 4]| {
                let a = DVec2::new(x, y);
                Segment { a, b: a + DVec2::new(dx, dy) }
            };
            let segments: Vec<Segment> = points.iter().map(segment).collect();
            let found = for_each_texel(&segments, [columns, rows], |_, _, d, k| (d, k)).unwrap();
            let h = 1.0 / rows as f64;
            for (i, &(d, k)) in found.iter().enumerate() {
                let p = DVec2::new(((i % columns) as f64 + 0.5) * h, 1.0 - ((i / columns) as f64 + 0.5) * h);
                let exact = segments.iter().map(|s| s.nearest(p).0.distance(p)).fold(f64::INFINITY, f64::min);
                prop_assert!((d - exact).abs() < 1e-12, "texel {i}: {d} for {exact}");
                prop_assert!((segments[k].nearest(p).0.distance(p) - exact).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn no_segments_no_end() {
        let found = for_each_texel(&[], [3, 2], |_, _, d, _| d).unwrap();
        assert_eq!(found, [f64::INFINITY; 6]);
    }
}
