//! The surface of a contour in the rows of a cone map: a slope in each, or a level face if that is
//! closer.

use glam::DVec2;
use revmap::error::{Error, ErrorKind, Result};
use revmap::surface::Contour;

/// A row's level face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    /// The face's height, in rows from the row's lower border.
    part: f64,
    /// The radius just below it and just above.
    radii: [f64; 2],
}

impl Level {
    const PARTS: f64 = 2047.0;
    const RADII: f64 = 4095.0;

    /// The stored form: the upper radius rounded up, the others to the nearest.
    fn kept(self, reach: f64) -> Self {
        let upper = (self.radii[1] / reach * Self::RADII)
            .ceil()
            .min(Self::RADII);
        Self {
            part: (self.part * Self::PARTS).round() / Self::PARTS,
            radii: [self.radii[0], upper / Self::RADII * reach],
        }
    }

    /// The row's third and fourth number, for a level in stored form.
    pub(super) fn numbers(self, reach: f64) -> [f32; 2] {
        let (p, q) = (self.part * Self::PARTS, self.radii[1] / reach * Self::RADII);
        [
            self.radii[0] as f32,
            -(1.0 + 4096.0 * p.round() + q.round()) as f32,
        ]
    }

    /// The row's radius at `x`, in rows from its lower border; `ends` are the radii at its borders.
    fn radius(self, ends: [f64; 2], x: f64) -> f64 {
        if x < self.part {
            ends[0] + (self.radii[0] - ends[0]) * x / self.part
        } else {
            ends[1] + (self.radii[1] - ends[1]) * (1.0 - x) / (1.0 - self.part).max(1e-9)
        }
    }
}

pub(super) struct Surface {
    /// Rows from below.
    pub(super) rows: Vec<Row>,
    /// Every corner `(r, z)`, upwards.
    pub(super) points: Vec<DVec2>,
    /// The largest radius.
    pub(super) reach: f64,
}

pub(super) struct Row {
    /// Radii at the row's borders, as limits from within.
    pub(super) radii: [f64; 2],
    pub(super) level: Option<Level>,
    /// Index of the row's lower end among the points.
    pub(super) first: usize,
}

impl Surface {
    pub(super) fn new(contour: &Contour, rows: usize) -> Result<Self> {
        /// Number of samples of a row that decide on its form.
        const FINE: usize = 8;
        let n = rows as f64;
        let borders = crossings(contour, rows, 0.0);
        let odd = |both: &[Vec<f64>; 2]| both.iter().any(|c| c.len() > 1);
        if let Some(i) = borders.windows(2).position(|w| odd(&w[0]) && odd(&w[1])) {
            let z = i as f64 / n;
            let message = format!(
                "is not single-valued in z: at z = {z:.3} the solid begins off the axis or is left twice, which cone maps cannot hold; take the solver quadric"
            );
            return Err(Error::new(ErrorKind::Content, message));
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

/// Radii at which the boundary is crossed going outwards, just above and just below each height
/// `(i + shift) / rows`.
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

/// The mean height of the nearly level sides in each row.
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
        let within = row(low.y)..=row(high.y);
        for (i, sum) in within.clone().zip(&mut sums[within]) {
            // The part of the side within the row.
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
