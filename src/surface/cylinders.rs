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
    /// Cylinders within the solid that the patches enclose, and around it.
    pub fn of_patches(patches: &[QuadricPatch]) -> [Self; 2] {
        let extents = extents(patches, ROWS);
        let inner = Self {
            pieces: cylinders(&solid_radii(patches, &extents), COUNTS, false),
            few: 12,
        };
        let most = |node: &[f32; 2]| f64::from(node[1]).max(0.0).sqrt();
        let radii: Vec<f64> = extents.iter().map(most).collect();
        [inner, Self::around(&radii)]
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
fn solid_radii(patches: &[QuadricPatch], extents: &[[f32; 2]]) -> [f64; ROWS] {
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
/// Neighbouring runs are joined, those first that lose (`outer`: gain) the least area. Runs of radius
/// 0 are left out.
fn cylinders<const K: usize>(
    radii: &[f64],
    counts: [usize; K],
    outer: bool,
) -> [Vec<CylinderPiece>; K] {
    let n = radii.len() as f64;
    let bound = |a: f64, b: f64| if (a < b) == outer { b } else { a };
    // The change of area by joining two runs. Equal runs are joined at no cost.
    let cost = |a: &Run, b: &Run| {
        let to = bound(a.radius, b.radius);
        a.rows() * (a.radius - to).abs() + b.rows() * (b.radius - to).abs()
    };
    let row = |(row, &radius): (usize, &f64)| Run {
        begin: row,
        end: row + 1,
        radius,
    };
    let mut runs: Vec<Run> = radii.iter().enumerate().map(row).collect();
    let mut costs: Vec<f64> = runs.windows(2).map(|w| cost(&w[0], &w[1])).collect();
    let mut found = [const { Vec::new() }; K];
    let mut order: Vec<usize> = (0..K).collect();
    order.sort_unstable_by_key(|&k| std::cmp::Reverse(counts[k]));
    for k in order {
        let solid = |runs: &[Run]| runs.iter().filter(|run| run.radius > 0.0).count();
        while solid(&runs) > counts[k] {
            let least = costs.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
            let Some((at, _)) = least else { break };
            let next = runs.remove(at + 1);
            costs.remove(at);
            runs[at].end = next.end;
            runs[at].radius = bound(runs[at].radius, next.radius);
            if at > 0 {
                costs[at - 1] = cost(&runs[at - 1], &runs[at]);
            }
            if let Some(after) = runs.get(at + 1) {
                costs[at] = cost(&runs[at], after);
            }
        }
        let solid = runs.iter().filter(|run| run.radius > 0.0);
        let piece = |run: &Run| CylinderPiece {
            radius: run.radius,
            low: run.begin as f64 / n,
            high: run.end as f64 / n,
        };
        found[k] = solid.map(piece).collect();
    }
    found
}

/// Consecutive rows that share a cylinder.
struct Run {
    begin: usize,
    end: usize,
    radius: f64,
}

impl Run {
    fn rows(&self) -> f64 {
        (self.end - self.begin) as f64
    }
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
        let radii = solid_radii(&patches, &extents(&patches, ROWS));
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
