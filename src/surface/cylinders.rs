//! Cylinders about a solid's axis: some inside the solid, some around it.

use super::QuadricPatch;
use super::rows::extents;
use crate::profile::{Outline, Segment};

/// One cylinder, object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CylinderPiece {
    pub radius: f64,
    pub low: f64,
    pub high: f64,
}

/// Cylinders about a solid's axis, from the lowest to the highest: within the solid, hiding
/// everything behind them, or around it, containing everything that can show. Copies that are larger
/// on the screen use more of them.
#[derive(Clone, Debug)]
pub(crate) struct Cylinders {
    pieces: [Vec<CylinderPiece>; 3],
    /// Copies with fewer rows of pixels use few.
    few: u32,
}

/// Copies with at least so many rows of pixels use many cylinders.
const MANY_ROWS: u32 = 64;

/// Rows of equal height in which cylinders are searched.
const ROWS: usize = 64;

impl Cylinders {
    /// Cylinders within the solid that the patches enclose.
    pub fn inner(patches: &[QuadricPatch]) -> Self {
        Self {
            pieces: cylinders(&solid_radii(patches), COUNTS, false),
            few: 12,
        }
    }

    /// Cylinders around the solid that the patches enclose.
    pub fn outer(patches: &[QuadricPatch]) -> Self {
        let most = |node: &[f32; 2]| f64::from(node[1]).max(0.0).sqrt();
        let radii: Vec<f64> = extents(patches, ROWS).iter().map(most).collect();
        Self::around(&radii)
    }

    /// Cylinders around the solid that an outline encloses, within the height of its box.
    pub fn around_outline(outline: &Outline) -> Self {
        let rows = ROWS as f64;
        let mut radii = [0.0f64; ROWS];
        for Segment { a, b } in outline.surface_segments() {
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            let first = (low.y * rows).floor().max(0.0) as usize;
            let last = (high.y * rows).floor() as usize;
            let radius_at = |row: usize| {
                let part = (row as f64 / rows - low.y) / (high.y - low.y);
                // The division gives NaN for a level segment.
                let radius = low.x + part.clamp(0.0, 1.0) * (high.x - low.x);
                if radius.is_nan() {
                    low.x.max(high.x)
                } else {
                    radius
                }
            };
            let met = radii.iter_mut().enumerate().take(last + 1).skip(first);
            for (row, radius) in met {
                *radius = radius.max(radius_at(row)).max(radius_at(row + 1));
            }
        }
        Self::around(&radii)
    }

    /// Cylinders around a solid with these largest radii in rows of equal height.
    pub fn around(radii: &[f64]) -> Self {
        Self {
            pieces: cylinders(radii, COUNTS, true),
            few: 24,
        }
    }

    /// The cylinders for a copy that covers this many rows of pixels.
    pub fn of(&self, rows: u32) -> &[CylinderPiece] {
        &self.pieces[usize::from(rows >= self.few) + usize::from(rows >= MANY_ROWS)]
    }
}

/// Most cylinders of copies with few, more and many rows of pixels.
const COUNTS: [usize; 3] = [3, 8, 16];

/// The radius within which everything is solid, for each row of equal height over `0 <= z <= 1`.
/// Object units. Rounded down; 0 if there is no such radius.
fn solid_radii(patches: &[QuadricPatch]) -> [f64; ROWS] {
    // A row's middle on the axis is in the solid if an odd number of patches is beside it.
    let mut solid = [false; ROWS];
    for patch in patches.iter().filter(|p| !p.is_plane()) {
        let [first, end] = patch
            .z
            .map(|z| ((z * ROWS as f64 - 0.5).ceil().max(0.0) as usize).min(ROWS));
        for row in &mut solid[first.min(end)..end] {
            *row = !*row;
        }
    }
    let extents = extents(patches, ROWS);
    std::array::from_fn(|row| {
        let least = f64::from(extents[row][0]).max(0.0).sqrt();
        if solid[row] && least.is_finite() {
            (least * (1.0 - 1e-3) - 1e-4).max(0.0)
        } else {
            0.0
        }
    })
}

/// For each count, at most that many runs of rows, each with its least (`outer`: largest) radius.
/// Together they are as close to the radii as possible. Runs of radius 0 are left out.
fn cylinders<const K: usize>(
    radii: &[f64],
    counts: [usize; K],
    outer: bool,
) -> [Vec<CylinderPiece>; K] {
    let n = radii.len();
    let bound = |a: f64, b: f64| if (a < b) == outer { b } else { a };
    let sense = if outer { -1.0 } else { 1.0 };
    // The gain of the run of rows `i..j`, at `j (j - 1) / 2 + i`.
    let mut gains = Vec::with_capacity(n * (n + 1) / 2);
    for j in 1..=n {
        let (first, mut radius) = (gains.len(), radii[j - 1]);
        gains.resize(first + j, 0.0);
        for i in (0..j).rev() {
            radius = bound(radius, radii[i]);
            gains[first + i] = sense * (j - i) as f64 * radius;
        }
    }
    // The best cover of the first j rows, and the start of the last run. Rows may be left out of
    // inner cylinders, but not of outer ones.
    let left_out = |j: usize| {
        if outer && j > 0 {
            f64::NEG_INFINITY
        } else {
            0.0
        }
    };
    let mut best: Vec<(f64, usize)> = (0..=n).map(|j| (left_out(j), 0)).collect();
    let most = counts.into_iter().max().unwrap_or(0);
    let mut steps = Vec::with_capacity(most);
    for _ in 0..most {
        let next = |j: usize| {
            let mut found = (best[j].0, j);
            let first = j * j.saturating_sub(1) / 2;
            for (i, gain) in gains[first..first + j].iter().enumerate() {
                let covered = best[i].0 + gain;
                if covered > found.0 {
                    found = (covered, i);
                }
            }
            found
        };
        best = (0..=n).map(next).collect();
        steps.push(best.clone());
    }
    counts.map(|count| runs(radii, &steps[..count], bound))
}

/// The runs that lead to the best cover of all rows.
fn runs(
    radii: &[f64],
    steps: &[Vec<(f64, usize)>],
    bound: impl Fn(f64, f64) -> f64,
) -> Vec<CylinderPiece> {
    let n = radii.len();
    let (mut found, mut end) = (Vec::new(), n);
    for step in steps.iter().rev() {
        let begin = step[end].1;
        if let Some(radius) = radii[begin..end].iter().copied().reduce(&bound)
            && radius > 0.0
        {
            found.push(CylinderPiece {
                radius,
                low: begin as f64 / n as f64,
                high: end as f64 / n as f64,
            });
        }
        end = begin;
    }
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::surface::{ContourSource, FitOptions, Offset, fit_patches};
    use glam::DVec2;

    #[test]
    fn runs_keep_to_their_side_of_the_radii_and_cover_most() {
        let radii: Vec<f64> = (0..64)
            .map(|k| {
                if k < 16 {
                    0.4
                } else {
                    0.1 + 0.001 * f64::from(k)
                }
            })
            .collect();
        for (outer, sense) in [(false, -1.0), (true, 1.0)] {
            let [found] = cylinders(&radii, [8], outer);
            assert!(found.len() > 1 && found.len() <= 8);
            let mut covered = 0.0;
            for piece in &found {
                let rows = &radii[(piece.low * 64.0) as usize..(piece.high * 64.0) as usize];
                assert!(!rows.iter().any(|r| sense * (r - piece.radius) > 0.0));
                covered += piece.radius * rows.len() as f64;
            }
            covered /= radii.iter().sum::<f64>();
            assert!(covered > 0.9 && covered < 1.1, "{covered}");
            let touch = |w: &[CylinderPiece]| w[0].high == w[1].low;
            let apart = |w: &[CylinderPiece]| w[0].high <= w[1].low;
            assert!(found.windows(2).all(|w| touch(w) || !outer && apart(w)));
            let ends = [found[0].low, found[found.len() - 1].high];
            assert!(!outer || ends == [0.0, 1.0]);
        }
        assert!(cylinders(&[0.0; 64], [8], false)[0].is_empty());
    }

    fn patches(points: &[[f64; 2]]) -> Vec<QuadricPatch> {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        let outline = Outline {
            loops: vec![points],
        };
        let contour = ContourSource::new(&outline).unwrap();
        let contour = contour.contour(&Offset::default()).unwrap();
        fit_patches(&contour, &FitOptions::default())
    }

    #[test]
    fn all_within_is_solid_and_little_else_is() {
        // A cup on a foot: its bowl is hollow, its foot undercut.
        let cup = [
            [0.0, 0.1],
            [0.2, 0.1],
            [0.3, 0.0],
            [0.4, 0.0],
            [0.1, 0.5],
            [0.4, 1.0],
            [0.3, 1.0],
            [0.0, 0.6],
        ];
        let patches = patches(&cup);
        let radii = solid_radii(&patches);
        // Parity of the number of patches beyond a point.
        let is_solid = |r: f64, z: f64| {
            let beyond = patches
                .iter()
                .filter(|p| !p.is_plane() && p.z[0] <= z && z < p.z[1] && p.square_at(z) > r * r);
            beyond.count() % 2 == 1
        };
        for (row, &radius) in radii.iter().enumerate() {
            for k in 0..=100 {
                let z = (row as f64 + f64::from(k) / 100.0) / 64.0;
                for part in [0.0, 0.5, 1.0] {
                    let r = radius * part;
                    let inside = is_solid(r, z);
                    assert!(radius == 0.0 || inside, "row {row}, {r} {z}");
                }
            }
        }
        // The radius is 0 below and above the axis' part of the solid, and in the rows of its ends.
        assert!(radii[..7].iter().chain(&radii[38..]).all(|r| *r == 0.0));
        // The narrowest point is the joint of cup and foot.
        assert!((radii[31] - 0.1).abs() < 0.01 && radii[10] > 0.25);
    }
}
