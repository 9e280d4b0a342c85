//! Finds the nearest of many segments, exactly, for every texel of a grid.
//!
//! Squares of the grid are halved repeatedly. Each square keeps only those segments that can be
//! nearest to any of its points. Two tests reject the others:
//!
//! * Let `m` be the least distance from the square's middle to a segment, and `q` half of its
//!   diagonal. A segment farther than `m + 2 q` is nearest nowhere: both distances change by at
//!   most `q` on the way to any point.
//! * Let `b` be the point, on any segment, that is nearest to the middle. A segment is nearest
//!   nowhere if `b` is nearer than it at all four corners. The reason: for each point `s` of the
//!   segment, `|p - s|^2 - |p - b|^2` is linear in `p`, and so is least at a corner.
//!
//! Squares of 4 x 4 texels keep a handful of segments, which are all measured. The result is exact,
//! without approximation.

use crate::profile::Segment;
use glam::DVec2;
use rayon::prelude::*;

/// Side of the squares that are processed independently, texels.
const TILE: usize = 128;
/// Side of the squares that are not halved further, texels.
const LEAF: usize = 4;
/// Fewer segments than this cost more to halve than to measure.
const FEW: usize = 3;

/// Evaluates `value(column, row, distance, segment)` for every texel of a grid of `columns x rows`
/// square texels of side `1 / rows`. Texel (0, 0) is at the top left, the axis at the left edge.
/// `distance` is from the texel's centre to the nearest segment in object units, `segment` the
/// index of that segment. Without segments they are `+inf` and 0.
pub(crate) fn for_each_texel<T: Copy + Default + Send>(
    segments: &[Segment],
    columns: usize,
    rows: usize,
    value: impl Fn(usize, usize, f64, usize) -> T + Sync,
) -> Vec<T> {
    let mut out = vec![T::default(); columns * rows];
    if out.is_empty() {
        return out;
    }
    let search = Search {
        pieces: segments
            .iter()
            .map(|s| Piece::new(s, rows as f64))
            .collect(),
        columns,
        rows,
        value,
    };
    let across = columns.div_ceil(TILE);
    let mut lists = vec![Vec::new(); across * rows.div_ceil(TILE)];
    let side = columns.max(rows).next_power_of_two().max(TILE);
    let mut stack: Vec<u32> = (0..segments.len() as u32).collect();
    search.deal(0, 0, side, 0, &mut stack, &mut |x, y, list| {
        lists[y / TILE * across + x / TILE] = list.to_vec();
    });
    out.par_chunks_mut(columns * TILE)
        .zip(lists.par_chunks(across))
        .enumerate()
        .for_each(|(band, (out, lists))| {
            for (tile, list) in lists.iter().enumerate() {
                let mut stack = list.clone();
                let corner = [tile * TILE, band * TILE];
                search.fill(corner, TILE, 0, &mut stack, band * TILE, out);
            }
        });
    out
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

    /// The point of the segment that is nearest to `p`.
    fn nearest(&self, p: DVec2) -> DVec2 {
        let t = ((p - self.start).dot(self.along) * self.inverse).clamp(0.0, 1.0);
        self.start + self.along * t
    }

    /// Squared distance in texels.
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
    /// Appends to the stack those entries, from `from` on, that can be nearest within a square of
    /// texels.
    fn narrow(&self, [x, y]: [usize; 2], side: usize, from: usize, stack: &mut Vec<u32>) {
        let middle = DVec2::new(x as f64, y as f64) + 0.5 * side as f64;
        // Only texel centres are evaluated, so the square ends half a texel inside its texels.
        let half = 0.5 * (side as f64 - 1.0);
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
        let reach = (least.sqrt() + 2.0 * half * std::f64::consts::SQRT_2) * (1.0 + 1e-12) + 1e-9;
        let near = self.pieces[which as usize].nearest(middle);
        let corners = [(-half, -half), (half, -half), (-half, half), (half, half)]
            .map(|(dx, dy)| middle + DVec2::new(dx, dy))
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

    /// Distributes the segments among the tiles.
    fn deal(
        &self,
        x: usize,
        y: usize,
        side: usize,
        from: usize,
        stack: &mut Vec<u32>,
        put: &mut impl FnMut(usize, usize, &[u32]),
    ) {
        if x >= self.columns || y >= self.rows {
            return;
        }
        let end = stack.len();
        self.narrow([x, y], side, from, stack);
        if side <= TILE {
            put(x, y, &stack[end..]);
        } else {
            let half = side / 2;
            for (dx, dy) in [(0, 0), (half, 0), (0, half), (half, half)] {
                self.deal(x + dx, y + dy, half, end, stack, put);
            }
        }
        stack.truncate(end);
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
                self.narrow(corner, half, from, stack);
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
            let segments: Vec<Segment> = points
                .iter()
                .map(|&[x, y, dx, dy]| Segment { a: DVec2::new(x, y), b: DVec2::new(x + dx, y + dy) })
                .collect();
            let found = for_each_texel(&segments, columns, rows, |_, _, d, k| (d, k));
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
        let found = for_each_texel(&[], 3, 2, |_, _, d, _| d);
        assert_eq!(found, [f64::INFINITY; 6]);
    }
}
