//! Cylinders about a solid's axis: some inside the solid, some around it.

use super::{QuadricPatch, SOLID_ROWS, extents, solid_radii};
use crate::profile::{Outline, Segment};

/// One cylinder, object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CylinderPiece {
    pub radius: f64,
    pub low: f64,
    pub high: f64,
}

/// Cylinders about an axis, from the lowest to the highest. Copies that are larger on the screen
/// use more of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cylinders([Vec<CylinderPiece>; 3]);

impl Cylinders {
    /// Cylinders for rows with these radii: see [`cylinders`].
    pub fn new(radii: &[f64], outer: bool) -> Self {
        Self(cylinders(radii, [3, 8, 16], outer))
    }

    /// The cylinders for a copy that covers `rows` rows of pixels; few cylinders below `few` rows.
    pub fn of(&self, rows: u32, few: u32) -> &[CylinderPiece] {
        &self.0[usize::from(rows >= few) + usize::from(rows >= MANY_ROWS)]
    }
}

/// Least rows of pixels of a copy for which many cylinders pay.
const MANY_ROWS: u32 = 64;

/// Cylinders within a solid, which hide everything behind them.
#[derive(Clone, Debug, Default)]
pub(crate) struct InnerCylinders(Cylinders);

/// Cylinders around a solid, which contain everything that can show.
#[derive(Clone, Debug, Default)]
pub(crate) struct OuterCylinders(Cylinders);

/// Copies with fewer rows of pixels use few inner cylinders.
const FEW_ROWS: u32 = 12;

impl InnerCylinders {
    /// Inner cylinders of the solid that the patches enclose.
    pub fn new(patches: &[QuadricPatch]) -> Self {
        Self(Cylinders::new(&solid_radii(patches), false))
    }

    /// The cylinders for a copy that covers this many rows of pixels.
    pub fn of(&self, rows: u32) -> &[CylinderPiece] {
        self.0.of(rows, FEW_ROWS)
    }
}

/// Copies with fewer rows of pixels use few outer cylinders.
const FEW_OUTER_ROWS: u32 = 24;

impl OuterCylinders {
    /// Outer cylinders of the solid that the patches enclose.
    pub fn new(patches: &[QuadricPatch]) -> Self {
        let most = |node: &[f32; 2]| f64::from(node[1]).max(0.0).sqrt();
        let radii: Vec<f64> = extents(patches, SOLID_ROWS).iter().map(most).collect();
        Self::of_radii(&radii)
    }

    /// Outer cylinders of the solid that an outline encloses, within the height of its box.
    pub fn of_outline(outline: &Outline) -> Self {
        let rows = SOLID_ROWS as f64;
        let mut radii = [0.0f64; SOLID_ROWS];
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
        Self::of_radii(&radii)
    }

    /// Outer cylinders of a solid with these largest radii in rows of equal height.
    pub fn of_radii(radii: &[f64]) -> Self {
        Self(Cylinders::new(radii, true))
    }

    /// The cylinders for a copy that covers this many rows of pixels.
    pub fn of(&self, rows: u32) -> &[CylinderPiece] {
        self.0.of(rows, FEW_OUTER_ROWS)
    }
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
    use super::*;

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
        let [found] = cylinders(&radii, [8], false);
        assert!(found.len() > 1 && found.len() <= 8);
        let mut covered = 0.0;
        for piece in &found {
            let rows = &radii[(piece.low * 64.0) as usize..(piece.high * 64.0) as usize];
            assert!(rows.iter().all(|r| *r >= piece.radius));
            covered += piece.radius * rows.len() as f64;
        }
        assert!(covered > 0.9 * radii.iter().sum::<f64>());
        assert!(found.windows(2).all(|w| w[0].high <= w[1].low));
        assert!(cylinders(&[0.0; 64], [8], false)[0].is_empty());
        let [found] = cylinders(&radii, [8], true);
        assert!(found.len() <= 8 && found[0].low == 0.0 && found[found.len() - 1].high == 1.0);
        let mut covered = 0.0;
        for piece in &found {
            let rows = &radii[(piece.low * 64.0) as usize..(piece.high * 64.0) as usize];
            assert!(rows.iter().all(|r| *r <= piece.radius));
            covered += piece.radius * rows.len() as f64;
        }
        assert!(covered < 1.1 * radii.iter().sum::<f64>());
        assert!(found.windows(2).all(|w| w[0].high == w[1].low));
    }
}
