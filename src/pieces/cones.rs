//! Cone maps of solids that are single-valued in z: `r <= f(z)`, solid all the way to the axis.
//!
//! Such a solid is a height field over the axis: `z` is the place, `r` the height. Cone step mapping (Dummer 2006) keeps, for
//! each place, the widest cone that stands on the surface there and has nothing of the solid in it; a ray above the surface may go on to
//! where it leaves that cone. Turned about the axis a cone's two flanks are cones of revolution, and where a ray leaves one is a quadratic.
//! A ray moves along the axis one way only, so each flank has a slope of its own.
//!
//! # Layout
//!
//! Row `i` of `N` is `i / N <= z <= (i + 1) / N`.
//!
//! * `[g, g', k_up, k_down]`: `g` and `g'` are the radius at the row's lower and upper border, linear in between. From any point of the
//!   row, `(z, g(z))`, nothing of the solid at `z' > z` lies beyond `g(z) + k_up (z' - z)`, and nothing at `z' < z` beyond
//!   `g(z) + k_down (z - z')`.
//! * `[g, g', h, -1 - 4096 p - q]`, where that is closer to the surface: a level face at the height `(i + p / 2047) / N` splits the row. Below
//!   it the radius goes from `g` to `h`, above it from `q / 4095` of the largest radius to `g'`. Such rows have no cones.
//!
//! The slopes are those of the borders: with `k` the steepest way from the row's lower end to any point of the surface above (0 if all of
//! them lead down), and `k'` the same from its upper end, the row has `max(k, k')`. From a point between two ends the way to
//! a third is the mediant of theirs, so it is no steeper than the steeper of both.

use super::Contour;
use crate::error::{Error, Result, Stage};
use glam::DVec2;

/// The rows of a cone map; the [module](self) tells their layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cones {
    /// `[g, g', k_up, k_down]`, or a row with a level face.
    pub rows: Vec<[f32; 4]>,
    /// The largest radius.
    pub reach: f32,
}

/// A row's level face.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    /// Its height, in rows from the row's lower border.
    part: f64,
    /// The radius just below it and just above.
    radii: [f64; 2],
}

impl Level {
    const PARTS: f64 = 2047.0;
    const RADII: f64 = 4095.0;

    /// As it is kept: the upper radius rounded up, the others to the nearest.
    fn kept(self, reach: f64) -> Self {
        let upper = (self.radii[1] / reach * Self::RADII)
            .ceil()
            .min(Self::RADII);
        Self {
            part: (self.part * Self::PARTS).round() / Self::PARTS,
            radii: [self.radii[0], upper / Self::RADII * reach],
        }
    }

    /// The row's third and fourth number, of a level that is kept.
    fn numbers(self, reach: f64) -> [f32; 2] {
        let (p, q) = (self.part * Self::PARTS, self.radii[1] / reach * Self::RADII);
        [
            self.radii[0] as f32,
            -(1.0 + 4096.0 * p.round() + q.round()) as f32,
        ]
    }

    /// The row's radius at `x`, in rows from its lower border, where its own are `ends`.
    fn radius(self, ends: [f64; 2], x: f64) -> f64 {
        if x < self.part {
            ends[0] + (self.radii[0] - ends[0]) * x / self.part
        } else {
            ends[1] + (self.radii[1] - ends[1]) * (1.0 - x) / (1.0 - self.part).max(1e-9)
        }
    }
}

/// Steeper than this no way can be told from a jump.
const STEEPEST: f64 = 1e6;

impl Cones {
    /// The cone map of a contour in `rows` rows. What is thinner in z than a row may be lost, or filled.
    ///
    /// # Errors
    /// [`Stage::Profile`] where going outwards from the axis one leaves the solid more than once, or starts outside of it, at two
    /// neighbouring borders of rows.
    pub fn new(contour: &Contour, rows: u32) -> Result<Self> {
        let surface = Surface::new(contour, rows.max(1) as usize)?;
        let up = slopes(&surface.points);
        let turned: Vec<DVec2> = surface
            .points
            .iter()
            .rev()
            .map(|p| DVec2::new(p.x, 1.0 - p.y))
            .collect();
        let mut down = slopes(&turned);
        down.reverse();
        // Rounded up, by what 32-bit floats lose of radii and heights.
        let steep = |k: f64| (k * (1.0 + 1e-5)).min(STEEPEST) as f32;
        let row = |row: &Row| {
            let [g, g_next] = row.radii.map(|r| r as f32);
            if let Some(level) = row.level {
                let [lower, rest] = level.numbers(surface.reach);
                return [g, g_next, lower, rest];
            }
            let (low, high) = (row.first, row.first + 1);
            let k = |all: &[f64]| steep(all[low].max(all[high]));
            [g, g_next, k(&up), k(&down)]
        };
        Ok(Self {
            rows: surface.rows.iter().map(row).collect(),
            reach: surface.reach as f32,
        })
    }
}

/// The surface as rows have it.
struct Surface {
    rows: Vec<Row>,
    /// Every corner `(r, z)`, upwards.
    points: Vec<DVec2>,
    /// The largest radius.
    reach: f64,
}

struct Row {
    /// At its borders, seen from within.
    radii: [f64; 2],
    level: Option<Level>,
    /// Its lower end among the points.
    first: usize,
}

impl Surface {
    fn new(contour: &Contour, rows: usize) -> Result<Self> {
        /// Samples of a row that decide on its form.
        const FINE: usize = 8;
        let n = rows as f64;
        let borders = crossings(contour, rows, 0.0);
        let odd = |both: &[Vec<f64>; 2]| both.iter().any(|c| c.len() > 1);
        if let Some(i) = borders.windows(2).position(|w| odd(&w[0]) && odd(&w[1])) {
            return Err(Error::new(
                Stage::Profile,
                format!(
                    "is not single-valued in z: at z = {:.3} the solid begins off the axis or is left twice, which cone maps cannot hold; take --solver quadric",
                    i as f64 / n
                ),
            ));
        }
        let widest = |crossings: &[f64]| crossings.iter().fold(0.0f64, |m, &r| m.max(r));
        let fine: Vec<f64> = crossings(contour, rows * FINE, 0.5)
            .iter()
            .map(|both| widest(&both[0]))
            .collect();
        let levels = levels(contour, rows);
        let all = borders.iter().flatten().chain(std::iter::once(&fine));
        let reach = f64::from(all.map(|r| widest(r)).fold(1e-6, f64::max) as f32);
        let mut surface = Self {
            rows: Vec::with_capacity(rows),
            points: Vec::with_capacity(2 * rows),
            reach,
        };
        for (i, w) in borders.windows(2).enumerate() {
            let (low, high) = (i as f64 / n, (i + 1) as f64 / n);
            let radii = [widest(&w[0][0]), widest(&w[1][1])];
            let samples = &fine[i * FINE..][..FINE];
            let part = |k: usize| (k as f64 + 0.5) / FINE as f64;
            let off = |form: &dyn Fn(f64) -> f64| -> f64 {
                let all = samples.iter().enumerate();
                all.map(|(k, r)| (r - form(part(k))).abs()).sum()
            };
            let sloped = off(&|x| radii[0] + (radii[1] - radii[0]) * x);
            let level = levels[i].map(|z| {
                let part = z * n - i as f64;
                // The samples next to the face, on either side.
                let split = ((part * FINE as f64).round() as usize).min(FINE);
                let beside = [
                    split.checked_sub(1).map_or(radii[0], |k| samples[k]),
                    samples.get(split).copied().unwrap_or(radii[1]),
                ];
                let level = Level {
                    part,
                    radii: beside,
                };
                level.kept(reach)
            });
            let level = level.filter(|level| off(&|x| level.radius(radii, x)) < sloped);
            surface.rows.push(Row {
                radii,
                level,
                first: surface.points.len(),
            });
            surface.points.push(DVec2::new(radii[0], low));
            if let Some(level) = level {
                let z = (i as f64 + level.part) / n;
                let two = level.radii.map(|r| DVec2::new(r, z));
                surface.points.extend(two);
            }
            surface.points.push(DVec2::new(radii[1], high));
        }
        Ok(surface)
    }
}

/// The sides of a contour, the lower end first.
fn sides(contour: &Contour) -> impl Iterator<Item = [DVec2; 2]> {
    contour.chains.iter().flat_map(|chain| {
        let count = chain.points.len();
        let sides = if chain.closed {
            count
        } else {
            count.saturating_sub(1)
        };
        (0..sides).map(move |k| {
            let (a, b) = (chain.points[k], chain.points[(k + 1) % count]);
            if a.y < b.y { [a, b] } else { [b, a] }
        })
    })
}

/// Where the boundary is crossed going outwards, just above and just below each height `(i + shift) / rows`.
fn crossings(contour: &Contour, rows: usize, shift: f64) -> Vec<[Vec<f64>; 2]> {
    let n = rows as f64;
    let mut all: Vec<[Vec<f64>; 2]> = vec![Default::default(); rows + 1];
    for [low, high] in sides(contour) {
        if low.y == high.y {
            continue;
        }
        let from = (low.y * n - shift).ceil().max(0.0) as usize;
        for (i, both) in all.iter_mut().enumerate().skip(from) {
            let z = (i as f64 + shift) / n;
            if z > high.y {
                break;
            }
            let r = low.x + (high.x - low.x) * ((z - low.y) / (high.y - low.y));
            if low.y <= z && z < high.y {
                both[0].push(r);
            }
            if low.y < z && z <= high.y {
                both[1].push(r);
            }
        }
    }
    all
}

/// The mean height of what lies all but level in each row.
fn levels(contour: &Contour, rows: usize) -> Vec<Option<f64>> {
    let n = rows as f64;
    let mut sums = vec![[0.0; 2]; rows];
    for [low, high] in sides(contour) {
        let width = (high.x - low.x).abs();
        let height = high.y - low.y;
        if width < 2.0 * height {
            continue;
        }
        let row = |z: f64| ((z * n).floor().max(0.0) as usize).min(rows - 1);
        for (i, sum) in sums
            .iter_mut()
            .enumerate()
            .take(row(high.y) + 1)
            .skip(row(low.y))
        {
            // What of the side lies within the row.
            let (from, to) = (low.y.max(i as f64 / n), high.y.min((i + 1) as f64 / n));
            let share = if height > 0.0 {
                ((to - from) / height).max(0.0)
            } else {
                1.0
            };
            sum[0] += width * share;
            sum[1] += width * share * 0.5 * (from + to);
        }
    }
    let mean = |[width, moment]: [f64; 2]| (width > 0.0).then(|| moment / width);
    sums.into_iter().map(mean).collect()
}

/// From each point of a surface the steepest way `dr / dz` to one farther up (they stand in order); 0 where all lead down.
fn slopes(points: &[DVec2]) -> Vec<f64> {
    let slope = |i: usize, j: usize| {
        let way = points[j] - points[i];
        if way.y > 0.0 {
            way.x / way.y
        } else if way.x > 0.0 {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
        }
    };
    let mut all = vec![0.0; points.len()];
    // The upper hull of the points after `i`, nearest last: the steepest way leads to its first corner.
    let mut hull: Vec<usize> = Vec::new();
    for i in (0..points.len()).rev() {
        while let [.., far, near] = hull[..]
            && slope(i, near) <= slope(i, far)
        {
            hull.pop();
        }
        if let Some(&near) = hull.last() {
            all[i] = slope(i, near).max(0.0);
        }
        hull.push(i);
    }
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::pieces::ContourSource;
    use crate::profile::{Outline, Profile, Shape};
    use crate::scene::Offset;
    use proptest::prelude::*;

    fn contour(points: &[[f64; 2]], extend: f64) -> Contour {
        let profile = Profile::polygon(points, 0.5).unwrap();
        let Shape::Outline(outline) = &profile.shape else {
            unreachable!("polygons are outlines")
        };
        let offset = Offset {
            extend,
            ..Offset::default()
        };
        ContourSource::new(outline)
            .unwrap()
            .contour(&offset)
            .unwrap()
    }

    #[test]
    fn a_double_cone_by_hand() {
        let spindle = contour(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.0);
        let cones = Cones::new(&spindle, 4).unwrap();
        let expected = [
            [0.0, 0.2, 0.8, 0.0],
            [0.2, 0.4, 0.8, 0.0],
            [0.4, 0.2, 0.0, 0.8],
            [0.2, 0.0, 0.0, 0.8],
        ];
        for (row, wanted) in cones.rows.iter().zip(expected) {
            for (a, b) in row.iter().zip(wanted) {
                assert!((a - b).abs() < 1e-5, "{row:?} is not {wanted:?}");
            }
        }
    }

    #[test]
    fn what_is_not_single_valued_is_refused() {
        let ring = contour(&[[0.1, 0.2], [0.4, 0.2], [0.4, 0.7], [0.1, 0.7]], 0.0);
        let error = Cones::new(&ring, 64).unwrap_err();
        assert!(error.to_string().contains("z = 0.203"), "{error}");
        let cup = contour(
            &[
                [0.0, 0.1],
                [0.3, 0.1],
                [0.3, 0.9],
                [0.25, 0.9],
                [0.25, 0.2],
                [0.0, 0.2],
            ],
            0.0,
        );
        assert!(Cones::new(&cup, 64).is_err());
        // A cavity that is lower than a row is not seen.
        let scratched = [
            [0.0, 0.1],
            [0.3, 0.1],
            [0.2, 0.105],
            [0.3, 0.11],
            [0.3, 0.9],
            [0.0, 0.9],
        ];
        assert!(Cones::new(&contour(&scratched, 0.0), 64).is_ok());
        // However far it is extended.
        let column = [
            [0.0, 0.1],
            [0.1, 0.1],
            [0.3, 0.2],
            [0.1, 0.6],
            [0.2, 0.9],
            [0.0, 0.9],
        ];
        for extend in [0.0, 0.05, -0.03] {
            assert!(
                Cones::new(&contour(&column, extend), 64).is_ok(),
                "{extend}"
            );
        }
    }

    #[test]
    fn level_faces_keep_their_height() {
        let drum = contour(
            &[
                [0.0, 0.19],
                [0.3, 0.19],
                [0.3, 0.5],
                [0.2, 0.5],
                [0.2, 0.92],
                [0.0, 0.92],
            ],
            0.0,
        );
        let cones = Cones::new(&drum, 10).unwrap();
        let expected = [
            [0.0, 0.0, 0.3 / 0.09, 0.0],                        // of its upper end
            [0.0, 0.3, 0.0, -(1.0 + 4096.0 * 1842.0 + 4095.0)], // 0.9 of the row
            [0.3, 0.3, 0.0, 0.0],
            [0.3, 0.3, 0.0, 0.0],
            [0.3, 0.3, 0.0, 0.0],
            [0.2, 0.2, 0.0, STEEPEST as f32], // a jump at its lower border
        ];
        for (row, wanted) in cones.rows.iter().zip(expected) {
            for (a, b) in row.iter().zip(wanted) {
                // The face's height is kept to 1 / 2047 of the row.
                let tolerance = if b < 0.0 { 0.0 } else { 1e-3 * b.max(1.0) };
                assert!((a - b).abs() <= tolerance, "{row:?} is not {wanted:?}");
            }
        }
        assert_eq!((cones.rows[9][2], cones.reach), (0.2, 0.3));
    }

    /// Every cone of every row against every part of the surface, from all over the row.
    fn assert_empty(cones: &Cones) -> std::result::Result<(), TestCaseError> {
        let n = cones.rows.len() as f64;
        let mut surface = Vec::new();
        for (i, row) in cones.rows.iter().enumerate() {
            let [g, g_next, lower, flag] = row.map(f64::from);
            surface.push((g, i as f64 / n));
            if flag < 0.0 {
                let word = -flag - 1.0;
                let z = (i as f64 + (word / 4096.0).floor() / 2047.0) / n;
                let upper = word.rem_euclid(4096.0) / 4095.0 * f64::from(cones.reach);
                surface.extend([(lower, z), (upper, z)]);
            }
            surface.push((g_next, (i + 1) as f64 / n));
        }
        for (i, row) in cones.rows.iter().enumerate() {
            let [g, g_next, up, down] = row.map(f64::from);
            for part in [0.001, 0.3, 0.7, 0.999] {
                let (z, r) = ((i as f64 + part) / n, g + (g_next - g) * part);
                for &(r_j, z_j) in &surface {
                    let k = if z_j > z { up } else { down };
                    let bound = r + k * (z_j - z).abs() + 1e-6;
                    prop_assert!(down < 0.0 || r_j <= bound, "row {} at {}, {}", i, part, z_j);
                }
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn cones_hold_nothing_of_the_solid(radii in proptest::collection::vec(0.02f64..0.45, 2..30), rows in 3u32..70, level in 0usize..40) {
            let steps = (radii.len() - 1) as f64;
            let mut points = vec![glam::DVec2::new(0.0, 0.1)];
            points.extend(radii.iter().enumerate().map(|(k, &r)| glam::DVec2::new(r, 0.1 + 0.8 * k as f64 / steps)));
            points.push(glam::DVec2::new(0.0, 0.9));
            // Some sides level.
            if let Some(p) = points.get(level + 1) {
                let z = p.y;
                points[level].y = z;
            }
            let outline = Outline { loops: vec![points] };
            let contour = ContourSource::new(&outline).unwrap().contour(&Offset::default()).unwrap();
            assert_empty(&Cones::new(&contour, rows).unwrap())?;
        }
    }
}
