//! Half widths of the thing, row by row, between pixels of the full picture.

use crate::Photo;
use crate::choice::Candidate;
use crate::form::{mode, turned};
use crate::ground::median_color;
use crate::work::{Color, Work, distance, lab_of, median};
use rayon::prelude::*;

/// Reduced pixels on both sides of a mask's edge where the edge may be.
const REACH: f64 = 6.0;
/// Rows at most.
const ROWS: f64 = 1000.0;
/// Halves that differ by this part of the width are not alike.
const ALIKE: f64 = 0.02;

/// Which half gives the radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Both, which are alike.
    Both,
    /// The left one; the right one is wider, or cut by the picture's edge.
    Left,
    /// The right one; the left one is wider, or cut by the picture's edge.
    Right,
}

/// The thing in the turned frame, reduced pixels.
pub(crate) struct Halves {
    /// Half widths, `step` apart from `top` on.
    pub radii: Vec<f64>,
    pub top: f64,
    pub step: f64,
    /// The axis at row 0, and how much it moves in a row.
    pub axis: f64,
    pub slope: f64,
    pub half: Half,
    /// The difference of the halves as a part of the width.
    pub differ: f64,
    /// True if the picture's left or right edge cuts the thing.
    pub cut: bool,
}

pub(crate) struct Sampler<'a> {
    pub photo: &'a Photo<'a>,
    pub work: &'a Work,
    /// Left and top margin that was cut off.
    pub margin: [f64; 2],
    pub angle: f64,
}

impl Sampler<'_> {
    /// A place of the turned frame in the reduced picture.
    pub fn place(&self, p: [f64; 2]) -> [f64; 2] {
        turned(p, self.work.middle(), -self.angle)
    }

    fn reduced(&self, p: [f64; 2]) -> Color {
        let [x, y] = self.place(p);
        let (w, h) = (self.work.width, self.work.height);
        bilinear([x - 0.5, y - 0.5], [w, h], |x, y| self.work.color(x, y))
    }

    /// The colour of the full picture where it has more to tell than the reduced one.
    fn color(&self, p: [f64; 2]) -> Color {
        if self.work.scale < 2.0 {
            return self.reduced(p);
        }
        let [x, y] = self.place(p);
        let at = [0, 1].map(|i| [x, y][i] * self.work.scale + self.margin[i] - 0.5);
        let (w, h) = (self.photo.width as usize, self.photo.height as usize);
        bilinear(at, [w, h], |x, y| {
            let [r, g, b, _] = self.photo.rgba[y * w + x];
            lab_of([r, g, b])
        })
    }

    /// How far the edge is outward of `from`, and `None` without a clear one. `deep`: how far the
    /// thing reaches inward.
    fn edge(&self, from: [f64; 2], out: [f64; 2], deep: f64) -> Option<f64> {
        let at = |t: f64| [from[0] + t * out[0], from[1] + t * out[1]];
        let mean = |from: f64, to: f64| -> Color {
            let samples: Vec<Color> = (0..4)
                .map(|k| self.reduced(at(from + (to - from) * f64::from(k) / 3.0)))
                .collect();
            median_color(samples.iter().copied())
        };
        let near = REACH.min(0.6 * deep);
        let (inside, outside) = (
            mean(-near - 3.0f64.min(0.4 * deep), -near),
            mean(REACH, REACH + 3.0),
        );
        let contrast = distance(inside, outside);
        if contrast < 3.0 {
            return None;
        }
        let step = (1.0 / self.work.scale).clamp(0.2, 0.5);
        let steps = ((REACH + near) / step) as usize;
        let part = |k: usize| {
            let color = self.color(at(k as f64 * step - near));
            let along = (0..3).map(|i| (color[i] - inside[i]) * (outside[i] - inside[i]));
            f64::from(along.sum::<f32>() / (contrast * contrast))
        };
        let parts: Vec<f64> = (0..=steps).map(part).collect();
        let crossings = (0..steps)
            .filter(|&k| parts[k] < 0.5 && parts[k + 1] >= 0.5)
            .map(|k| (k as f64 + (0.5 - parts[k]) / (parts[k + 1] - parts[k])) * step - near);
        crossings
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .filter(|t| t.abs() < 4.0)
    }
}

fn bilinear(p: [f64; 2], size: [usize; 2], at: impl Fn(usize, usize) -> Color) -> Color {
    let [x, y] = [0, 1].map(|i| p[i].clamp(0.0, (size[i] - 1) as f64));
    let (i, j) = (x as usize, y as usize);
    let (fx, fy) = ((x - i as f64) as f32, (y - j as f64) as f32);
    let (i1, j1) = ((i + 1).min(size[0] - 1), (j + 1).min(size[1] - 1));
    let corners = [at(i, j), at(i1, j), at(i, j1), at(i1, j1)];
    std::array::from_fn(|k| {
        let [a, b, c, d] = corners.map(|c| c[k]);
        (a + (b - a) * fx) * (1.0 - fy) + (c + (d - c) * fx) * fy
    })
}

/// Measures the thing of a mask.
pub(crate) fn halves(sampler: &Sampler, candidate: &Candidate) -> Halves {
    let (rows, work) = (&candidate.rows, sampler.work);
    let height = work.height as f64;
    let count = (rows.ends.len() as f64 * work.scale.max(1.0))
        .clamp(64.0, ROWS)
        .round();
    let vertical = |v: f64, way: f64| {
        let inside = if v < 3.0 || v > height - 3.0 {
            None
        } else {
            sampler.edge([candidate.axis, v], [0.0, way], 12.0)
        };
        v + way * inside.unwrap_or(0.0).clamp(-2.0, 2.0)
    };
    let last = rows.top + rows.ends.len() as f64 - 0.5;
    let (top, bottom) = (vertical(rows.top - 0.5, -1.0), vertical(last, 1.0));
    let step = (bottom - top) / count;
    let ends: Vec<[f64; 2]> = (0..count as usize)
        .into_par_iter()
        .map(|i| {
            let v = top + (i as f64 + 0.5) * step;
            let row = ((v - rows.top).round().max(0.0) as usize).min(rows.ends.len() - 1);
            let [l, r] = rows.ends[row];
            if l >= r {
                return [candidate.axis; 2];
            }
            let deep = (r - l) * 0.5;
            let side = |u: f64, way: f64| {
                let inside = (10.0..work.width as f64 - 10.0).contains(&u);
                let found = inside
                    .then(|| sampler.edge([u, v], [way, 0.0], deep))
                    .flatten();
                u + way * found.unwrap_or(0.0)
            };
            [side(l, -1.0), side(r, 1.0)]
        })
        .collect();
    finish(ends, top, step, candidate.axis, work.width as f64)
}

fn finish(ends: Vec<[f64; 2]>, top: f64, step: f64, axis: f64, width: f64) -> Halves {
    let touching = |e: &[f64; 2]| [e[0] < 2.0, e[1] > width - 2.0];
    let middles: Vec<(f64, f64)> = ends
        .iter()
        .enumerate()
        .filter(|(_, e)| e[1] > e[0] && touching(e) == [false; 2])
        .map(|(i, e)| (i as f64, 0.5 * (e[0] + e[1])))
        .collect();
    let (axis, slope) = line(&middles, axis, step);
    let sides: Vec<[f64; 2]> = ends
        .iter()
        .enumerate()
        .map(|(i, e)| {
            let axis = axis + slope * i as f64;
            [axis - e[0], e[1] - axis].map(|v| v.max(0.0))
        })
        .collect();
    let sum = |of: &dyn Fn(&[f64; 2]) -> f64| sides.iter().map(of).sum::<f64>();
    let differ = sum(&|s| (s[0] - s[1]).abs()) / sum(&|s| s[0] + s[1]).max(1e-9);
    let part = |side: usize| {
        ends.iter().filter(|e| touching(e)[side]).count() as f64 / ends.len().max(1) as f64
    };
    let cut = [0, 1].map(|side| part(side) > 0.05);
    let half = match cut {
        [true, false] => Half::Right,
        [false, true] => Half::Left,
        _ if differ <= ALIKE => Half::Both,
        _ if sum(&|s| s[0]) < sum(&|s| s[1]) => Half::Left,
        _ => Half::Right,
    };
    let radius = |(e, s): (&[f64; 2], &[f64; 2])| match (touching(e), half) {
        ([true, false], _) => s[1],
        ([false, true], _) => s[0],
        (_, Half::Both) => 0.5 * (s[0] + s[1]),
        _ => s[0].min(s[1]),
    };
    Halves {
        radii: ends.iter().zip(&sides).map(radius).collect(),
        top,
        step,
        axis,
        slope,
        half,
        differ,
        cut: cut != [false; 2],
    }
}

/// The line on which most middles are: place at row 0, and change in a row. The axis of the mask
/// stays if no other is better.
fn line(middles: &[(f64, f64)], axis: f64, step: f64) -> (f64, f64) {
    let values: Vec<f64> = middles.iter().map(|m| m.1).collect();
    if values.len() < 12 {
        return (axis, 0.0);
    }
    let upright = mode(&values);
    let near = |axis: f64, slope: f64| {
        let away = middles
            .iter()
            .filter(|m| (m.1 - axis - slope * m.0).abs() < 0.7);
        away.count()
    };
    let third = middles.len() / 3;
    let mut slopes: Vec<f32> = (0..middles.len() - third)
        .map(|i| {
            ((middles[i + third].1 - middles[i].1) / (middles[i + third].0 - middles[i].0)) as f32
        })
        .collect();
    let slope = f64::from(median(&mut slopes)).clamp(-0.015 * step, 0.015 * step);
    let starts: Vec<f64> = middles.iter().map(|m| m.1 - slope * m.0).collect();
    let start = mode(&starts);
    match near(start, slope) as f64 > 1.1 * near(upright, 0.0) as f64 {
        true => (start, slope),
        false => (upright, 0.0),
    }
}
