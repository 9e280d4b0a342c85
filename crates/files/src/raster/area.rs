//! Exact coverage: the part of each pixel of a grid that is inside an outline.
//!
//! Green's theorem turns the covered area of a pixel into a sum over the pieces of the boundary.
//! Each segment is cut at the rows and columns that it passes. A piece adds to its own pixel the
//! area between itself and the pixel's right border, and its whole height to all pixels farther
//! right. A running sum along the row completes them. The result is exact up to rounding. The cost
//! is that of the boundary plus one pass over the pixels.

use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;
use revmap::profile::{Outline, Raster};

/// Coverage on a grid of `columns x rows` square pixels of side `1 / rows`, with the axis at
/// its left edge and `z = 1` at its top. Parts of the outline beyond the grid are cut off.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`](revmap::error::ErrorKind::OutOfHostMemory).
pub fn rasterize(outline: &Outline, columns: u32, rows: u32) -> Result<Raster> {
    let (width, height) = (columns as usize, rows as usize);
    let side = f64::from(rows);
    // Segments in pixels with y downwards, sorted into the rows they touch.
    let mut bins: Vec<Vec<[f64; 4]>> = vec![Vec::new(); height];
    for s in outline.segments() {
        let (x0, y0) = (s.a.x * side, (1.0 - s.a.y) * side);
        let (x1, y1) = (s.b.x * side, (1.0 - s.b.y) * side);
        if y0 == y1 || y0.max(y1) <= 0.0 || y0.min(y1) >= side {
            continue;
        }
        let first = y0.min(y1).max(0.0) as usize;
        let last = (y0.max(y1).ceil() as usize).min(height);
        for bin in &mut bins[first..last] {
            bin.push([x0, y0, x1, y1]);
        }
    }
    let mut coverage = host_memory::filled(width * height, 0.0, super::PIXELS)?;
    coverage
        .par_chunks_mut(width.max(1))
        .zip(&bins)
        .enumerate()
        .for_each(|(row, (out, bin))| {
            if bin.is_empty() {
                return;
            }
            let mut sums = vec![0.0f64; width + 1];
            for piece in bin {
                add_segment(&mut sums, *piece, row as f64);
            }
            let mut total = 0.0;
            for (value, sum) in out.iter_mut().zip(&sums) {
                total += sum;
                *value = total.clamp(0.0, 1.0) as f32;
            }
        });
    Ok(Raster {
        columns,
        rows,
        coverage,
    })
}

/// Adds the part of a segment inside the row `[top, top + 1]` to the row's differences.
fn add_segment(sums: &mut [f64], [x0, y0, x1, y1]: [f64; 4], top: f64) {
    // The solid is left of the direction of travel in (r, z). In pixels y points downwards, so a
    // segment that rises (y falls) has the solid at its left in the picture. The pixels right of it
    // lose coverage.
    let (sign, [xa, ya, xb, yb]) = if y1 > y0 {
        (1.0, [x0, y0, x1, y1])
    } else {
        (-1.0, [x1, y1, x0, y0])
    };
    let slope = (xb - xa) / (yb - ya);
    let at = |y: f64| xa + (y - ya) * slope;
    let (from, to) = (ya.max(top), yb.min(top + 1.0));
    if to <= from {
        return;
    }
    let (xf, xt) = (at(from), at(to));
    let (left, right, height) = (xf.min(xt), xf.max(xt), to - from);
    let end = (sums.len() - 1) as f64;
    if left >= end {
        return;
    }
    if right - left < 1e-12 {
        spread(sums, left.max(0.0), left.max(0.0), sign * height);
        return;
    }
    let mut x = left.max(0.0);
    while x < right.min(end) {
        let next = (x.floor() + 1.0).min(right);
        spread(sums, x, next, sign * height * (next - x) / (right - left));
        x = next;
    }
}

/// Adds a piece of height `height` between `x0` and `x1` of one column: its own pixel gets the
/// trapezoid right of it, the next pixel the rest.
fn spread(sums: &mut [f64], x0: f64, x1: f64, height: f64) {
    let column = (x0.floor() as usize).min(sums.len() - 2);
    let right_part = 1.0 - (0.5 * (x0 + x1) - column as f64);
    sums[column] += height * right_part;
    sums[column + 1] += height * (1.0 - right_part);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;

    fn square(low: [f64; 2], high: [f64; 2]) -> Outline {
        let v = DVec2::new;
        Outline {
            loops: vec![vec![
                v(low[0], low[1]),
                v(high[0], low[1]),
                v(high[0], high[1]),
                v(low[0], high[1]),
            ]],
        }
    }

    #[test]
    fn a_rectangle_covers_what_it_covers() {
        let raster = rasterize(&square([0.125, 0.3125], [0.5, 0.875]), 4, 4).unwrap();
        let expected = [
            [0.25, 0.5, 0.0, 0.0],
            [0.5, 1.0, 0.0, 0.0],
            [0.375, 0.75, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ];
        assert_eq!(raster.coverage, expected.concat());
    }

    #[test]
    fn what_lies_beyond_the_grid_is_cut_off() {
        let raster = rasterize(&square([0.0, -3.0], [7.0, 9.0]), 3, 5).unwrap();
        assert!(raster.coverage.iter().all(|&c| c == 1.0));
    }

    proptest! {
        // The sum over all pixels is the polygon's area, and each pixel agrees with dense sampling.
        #[test]
        fn triangles(p in prop::array::uniform6(0.0f64..1.0)) {
            let v = DVec2::new;
            let mut points = vec![v(p[0], p[1]), v(p[2], p[3]), v(p[4], p[5])];
            if (points[1] - points[0]).perp_dot(points[2] - points[0]) < 0.0 {
                points.reverse();
            }
            let outline = Outline { loops: vec![points] };
            let raster = rasterize(&outline, 7, 7).unwrap();
            let sum: f64 = raster.coverage.iter().map(|&c| f64::from(c)).sum();
            prop_assert!((sum / 49.0 - outline.area()).abs() < 1e-5);
            let n = 24;
            for row in 0..7 {
                for column in 0..7 {
                    let hits = (0..n * n).filter(|k| {
                        let x = (f64::from(column) + (f64::from(k % n) + 0.5) / f64::from(n)) / 7.0;
                        let y = (f64::from(row) + (f64::from(k / n) + 0.5) / f64::from(n)) / 7.0;
                        outline.contains(v(x, 1.0 - y))
                    }).count();
                    let exact = f64::from(raster.coverage[(row * 7 + column) as usize]);
                    prop_assert!((exact - hits as f64 / f64::from(n * n)).abs() < 0.1);
                }
            }
        }
    }
}
