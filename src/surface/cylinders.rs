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
    /// Many, some, then few.
    pieces: Vec<CylinderPiece>,
    /// The ends of these.
    ends: [usize; 3],
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
        let inner = solid_radii(patches, &extents);
        let outer = std::array::from_fn(|row| f64::from(extents[row][1]).max(0.0).sqrt());
        [Self::new(&inner, false, 12), Self::around(&outer)]
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
    pub fn around(radii: &[f64; ROWS]) -> Self {
        Self::new(radii, true, 24)
    }

    /// At most as many runs of rows as [`COUNTS`] says, each with its least (`outer`: largest)
    /// radius. Neighbouring runs are joined, those first that lose (`outer`: gain) the least area.
    /// Runs of radius 0 are left out.
    fn new(radii: &[f64; ROWS], outer: bool, few: u32) -> Self {
        let mut runs = Runs::new(radii, outer);
        let mut solid = radii.iter().filter(|radius| **radius > 0.0).count();
        let mut pieces = Vec::with_capacity(COUNTS.iter().sum());
        let ends = COUNTS.map(|count| {
            while solid > count
                && let Some(gone) = runs.join()
            {
                solid -= gone;
            }
            pieces.extend(runs.pieces());
            pieces.len()
        });
        Self { pieces, ends, few }
    }

    /// The cylinders for a copy that covers this many rows of pixels.
    pub fn of(&self, rows: u32) -> &[CylinderPiece] {
        let [many, some, few] = self.ends;
        let range = match rows {
            MANY_ROWS.. => 0..many,
            rows if rows >= self.few => many..some,
            _ => some..few,
        };
        &self.pieces[range]
    }
}

/// Most cylinders of copies with many, some and few rows of pixels.
const COUNTS: [usize; 3] = [16, 8, 3];

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

/// Runs of consecutive rows that share a cylinder. A run's data is at its first row.
struct Runs {
    /// Radii of the runs; negative for runs within the solid, so that joined runs have the larger
    /// value.
    radii: [f64; ROWS],
    /// The row after the run.
    ends: [usize; ROWS],
    /// The first row of the run that ends with this row.
    begins: [usize; ROWS],
    /// The change of area by joining a run with the next one, in the order of these values;
    /// [`NEVER`] if there is none. The lowest bits are the row, so that the least value gives the run.
    costs: [[u64; GROUP]; GROUP],
    /// The least cost of each group.
    least: [u64; GROUP],
}

/// Rows in a group, and groups.
const GROUP: usize = 8;
const _: () = assert!(GROUP * GROUP == ROWS);
/// The bits of a cost that hold a row.
const ROW_BITS: u64 = ROWS as u64 - 1;
const NEVER: u64 = u64::MAX;

impl Runs {
    /// One run for each row.
    fn new(radii: &[f64; ROWS], outer: bool) -> Self {
        let mut runs = Self {
            radii: radii.map(|radius| if outer { radius } else { -radius }),
            ends: std::array::from_fn(|row| row + 1),
            begins: std::array::from_fn(|row| row),
            costs: [[NEVER; GROUP]; GROUP],
            least: [NEVER; GROUP],
        };
        for row in 0..ROWS {
            runs.costs[row / GROUP][row % GROUP] = runs.cost(row);
        }
        runs.least = runs.costs.each_ref().map(least);
        runs
    }

    /// The cost of joining a run with the next one.
    fn cost(&self, run: usize) -> u64 {
        let next = self.ends[run];
        if next == ROWS {
            return NEVER;
        }
        let [a, b] = [run, next].map(|run| self.radii[run]);
        let to = larger(a, b);
        let rows = [run, next].map(|run| (self.ends[run] - run) as u32);
        let cost = f64::from(rows[0]) * (to - a) + f64::from(rows[1]) * (to - b);
        // The order of positive numbers is that of their bits.
        cost.to_bits() & !ROW_BITS | run as u64
    }

    fn set_cost(&mut self, run: usize, cost: u64) {
        let (group, known) = (&mut self.costs[run / GROUP], &mut self.least[run / GROUP]);
        let before = std::mem::replace(&mut group[run % GROUP], cost);
        if cost < *known {
            *known = cost;
        } else if before == *known {
            *known = least(group);
        }
    }

    /// Joins the two runs that cost least. Returns the number of runs with a radius above 0 that are
    /// gone; `None` if there is one run.
    fn join(&mut self) -> Option<usize> {
        let least = least(&self.least);
        if least == NEVER {
            return None;
        }
        let run = (least & ROW_BITS) as usize;
        let next = self.ends[run];
        let [a, b] = [run, next].map(|run| self.radii[run]);
        let to = larger(a, b);
        self.radii[run] = to;
        self.ends[run] = self.ends[next];
        self.begins[self.ends[run] - 1] = run;
        self.set_cost(next, NEVER);
        self.set_cost(run, self.cost(run));
        if run > 0 {
            let before = self.begins[run - 1];
            self.set_cost(before, self.cost(before));
        }
        let solid = |radius: f64| usize::from(radius != 0.0);
        Some(solid(a) + solid(b) - solid(to))
    }

    fn pieces(&self) -> impl Iterator<Item = CylinderPiece> {
        let next = |run: &usize| Some(self.ends[*run]).filter(|next| *next < ROWS);
        let runs = std::iter::successors(Some(0), next);
        let piece = |run: usize| CylinderPiece {
            radius: self.radii[run].abs(),
            low: run as f64 / ROWS as f64,
            high: self.ends[run] as f64 / ROWS as f64,
        };
        runs.map(piece).filter(|piece| piece.radius > 0.0)
    }
}

fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The least of a group, without a long chain of comparisons.
fn least(&[a, b, c, d, e, f, g, h]: &[u64; GROUP]) -> u64 {
    let [left, right] = [a.min(b).min(c.min(d)), e.min(f).min(g.min(h))];
    left.min(right)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::surface::{ContourSource, FitOptions, Offset, fit_patches};
    use glam::DVec2;

    #[test]
    fn runs_keep_to_their_side_of_the_radii_and_cover_most() {
        let radii = std::array::from_fn(|k| if k < 16 { 0.4 } else { 0.1 + 0.001 * k as f64 });
        for (outer, sense) in [(false, -1.0), (true, 1.0)] {
            let found = Cylinders::new(&radii, outer, 24);
            let found = found.of(MANY_ROWS - 1);
            assert!(found.len() > 1 && found.len() <= 8);
            let mut covered = 0.0;
            for piece in found {
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
        assert!(
            Cylinders::new(&[0.0; ROWS], false, 24)
                .of(MANY_ROWS)
                .is_empty()
        );
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
