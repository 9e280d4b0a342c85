//! The form of a mask: its rows across an axis that may be tilted, the axis, the symmetry.

use crate::mask::Mask;
use image::imageops;
use imageproc::contours::{BorderType, find_contours};

/// The border of a mask: centres of its outermost pixels, in order.
pub(crate) struct Border {
    pub points: Vec<[f64; 2]>,
    middle: [f64; 2],
    width: f64,
}

/// Rows of a mask from the top, one pixel apart, in a frame that is turned about the picture's
/// middle. A row that is not there has its left end right of its right one.
pub(crate) struct Rows {
    pub angle: f64,
    /// Place of row 0 in the turned frame.
    pub top: f64,
    /// Left and right end, in the turned frame.
    pub ends: Vec<[f64; 2]>,
}

const NONE: [f64; 2] = [f64::MAX, f64::MIN];

/// A band of the ground's colour is a notch of more than so many pixels.
const DEEP: f64 = 8.0;

/// Largest tilt that is looked for, degrees.
const MOST_TILT: i32 = 8;

impl Border {
    pub fn of(mask: &Mask) -> Option<Self> {
        let (w, h) = mask.dimensions();
        let mut wide = Mask::new(w + 2, h + 2);
        imageops::replace(&mut wide, mask, 1, 1);
        let outer = find_contours::<i32>(&wide).into_iter();
        let outer = outer.filter(|c| c.border_type == BorderType::Outer);
        let longest = outer.max_by_key(|c| c.points.len())?;
        let points = longest.points.iter();
        Some(Self {
            points: points
                .map(|p| [f64::from(p.x) - 0.5, f64::from(p.y) - 0.5])
                .collect(),
            middle: [0.5 * f64::from(w), 0.5 * f64::from(h)],
            width: f64::from(w),
        })
    }

    pub fn rows(&self, angle: f64) -> Rows {
        let points: Vec<_> = (self.points.iter().map(|p| turned(*p, self.middle, angle))).collect();
        let heights = || points.iter().map(|p| p[1]);
        let (low, high) = (
            heights().fold(f64::MAX, f64::min),
            heights().fold(f64::MIN, f64::max),
        );
        let top = (low - 0.5).ceil() + 0.5;
        let count = ((high - top).floor().max(0.0) as usize) + 1;
        let mut ends = vec![NONE; count];
        let mut widen = |k: f64, u: f64| {
            if let Some(row) = ends.get_mut(k as usize).filter(|_| k >= 0.0) {
                *row = [row[0].min(u - 0.5), row[1].max(u + 0.5)];
            }
        };
        let next = points.iter().cycle().skip(1);
        for (a, b) in points.iter().zip(next) {
            let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
            let (from, to) = (a[1] - top, b[1] - top);
            let mut k = from.ceil();
            while k <= to {
                let t = if to > from {
                    (k - from) / (to - from)
                } else {
                    0.0
                };
                widen(k, a[0] + t * (b[0] - a[0]));
                if to <= from {
                    widen(k, b[0]);
                }
                k += 1.0;
            }
        }
        Rows { angle, top, ends }
    }

    /// The symmetry of the best tilt, and its rows. Upright counts unless another is clearly better.
    pub fn best(&self, may_tilt: bool) -> (f64, Rows) {
        let at = |angle: f64| {
            let rows = self.rows(angle);
            (self.symmetry(&rows), rows)
        };
        let upright = at(0.0);
        if !may_tilt {
            return upright;
        }
        let better = |a: (f64, Rows), b: (f64, Rows)| if b.0 > a.0 { b } else { a };
        let coarse = (-MOST_TILT..=MOST_TILT)
            .map(|k| at(f64::from(k)))
            .reduce(better);
        let around = coarse.as_ref().map_or(0.0, |c| c.1.angle);
        let fine = (-4..=4).map(|k| at(around + 0.25 * f64::from(k)));
        match fine.chain(coarse).reduce(better) {
            Some(best) if best.0 > upright.0 + 0.004 => best,
            _ => upright,
        }
    }

    /// The rows whose middles are on one line most clearly, whatever is beside the thing.
    pub fn straightest(&self) -> Rows {
        let at = |angle: f64| {
            let rows = self.rows(angle);
            let axis = rows.axis(self.width);
            let near = rows
                .ends
                .iter()
                .filter(|e| (0.5 * (e[0] + e[1]) - axis).abs() < 0.8);
            (near.count() as f64 / rows.ends.len() as f64, rows)
        };
        let upright = at(0.0);
        let angles = (-16..=16).map(|k| 0.5 * f64::from(k));
        match angles.map(at).max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some(best) if best.0 > 1.15 * upright.0 => best.1,
            _ => upright.1,
        }
    }

    /// Intersection over union of the rows and their mirror image, as far as the picture shows it.
    pub fn symmetry(&self, rows: &Rows) -> f64 {
        let axis = rows.axis(self.width);
        let of = |axis: f64| {
            let (low, high) = (
                (2.0 * axis - self.width).max(0.0),
                self.width.min(2.0 * axis),
            );
            let (mut both, mut either) = (0.0, 0.0);
            for [l, r] in rows.ends.iter().filter(|e| e[0] < e[1]) {
                let (l, r) = (l.max(low), r.min(high));
                let shared = (r.min(2.0 * axis - l) - l.max(2.0 * axis - r)).max(0.0);
                both += shared;
                either += (2.0 * (r - l) - shared).max(0.0);
            }
            both / f64::max(either, 1.0)
        };
        [-0.5, 0.0, 0.5]
            .map(|d| of(axis + d))
            .into_iter()
            .fold(0.0, f64::max)
    }

    /// Length squared by area: 1 for a disc.
    pub fn raggedness(&self, area: usize) -> f64 {
        (self.points.len() as f64).powi(2) / (4.0 * std::f64::consts::PI * area.max(1) as f64)
    }
}

/// A place in the frame that is turned by `angle` degrees about `middle`.
pub(crate) fn turned([x, y]: [f64; 2], middle: [f64; 2], angle: f64) -> [f64; 2] {
    let (s, c) = angle.to_radians().sin_cos();
    let (x, y) = (x - middle[0], y - middle[1]);
    [c * x + s * y + middle[0], c * y - s * x + middle[1]]
}

/// The mirror image of a place at an axis in that frame.
pub(crate) fn mirrored(p: [f64; 2], middle: [f64; 2], axis: f64, angle: f64) -> [f64; 2] {
    let [u, v] = turned(p, middle, angle);
    turned([2.0 * axis - u, v], middle, -angle)
}

impl Rows {
    /// Half widths that fill bands of the ground's colour: notches lower than `most` are filled on
    /// straight lines, where the picture has edges (`is_edge` of a row and a half width) along most
    /// of them. Other rows are 0. `None` if there are no such notches.
    pub fn bridged(
        &self,
        axis: f64,
        most: f64,
        is_edge: impl Fn(usize, f64) -> bool,
    ) -> Option<Vec<f64>> {
        let half = |e: &[f64; 2]| (axis - e[0]).min(e[1] - axis).max(0.0);
        let widths: Vec<f64> = self.ends.iter().map(half).collect();
        let reach = (0.5 * most) as usize;
        let over = |widths: &[f64], start: f64, of: fn(f64, f64) -> f64| -> Vec<f64> {
            let near =
                |i: usize| &widths[i.saturating_sub(reach)..(i + reach + 1).min(widths.len())];
            (0..widths.len())
                .map(|i| near(i).iter().copied().fold(start, of))
                .collect()
        };
        let closed = over(&over(&widths, 0.0, f64::max), f64::MAX, f64::min);
        let kept: Vec<usize> = (0..widths.len())
            .filter(|&i| widths[i] > closed[i] - 2.5)
            .collect();
        let mut filled = vec![0.0; widths.len()];
        for pair in kept.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
            let [a, b] = [pair[0], pair[1]];
            let at =
                |i: usize| widths[a] + (i - a) as f64 / (b - a) as f64 * (widths[b] - widths[a]);
            let deepest = (a + 1..b).map(|i| at(i) - widths[i]).fold(0.0, f64::max);
            let edges = (a + 1..b).filter(|&i| is_edge(i, at(i))).count();
            if deepest > DEEP && 10 * edges > 6 * (b - a - 1) {
                (a + 1..b).for_each(|i| filled[i] = at(i));
            }
        }
        filled.iter().any(|r| *r > 0.0).then_some(filled)
    }

    /// The axis: where the middles of most rows are. Rows at the picture's sides count only if
    /// there are few others.
    pub fn axis(&self, width: f64) -> f64 {
        let middles = |inside: bool| -> Vec<f64> {
            let rows = self.ends.iter().filter(|e| e[0] < e[1]);
            let rows = rows.filter(|e| !inside || e[0] > 1.5 && e[1] < width - 1.5);
            rows.map(|e| 0.5 * (e[0] + e[1])).collect()
        };
        let mut found = middles(true);
        if found.len() * 12 < self.ends.len() {
            found = middles(false);
        }
        mode(&found)
    }

    /// Area between the ends.
    pub fn area(&self) -> f64 {
        self.ends.iter().map(|e| (e[1] - e[0]).max(0.0)).sum()
    }
}

/// The value near which most values are.
pub(crate) fn mode(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::MAX, f64::min);
    let high = values.iter().copied().fold(f64::MIN, f64::max);
    if values.is_empty() {
        return 0.0;
    }
    let mut counts = vec![0.0; (2.0 * (high - low)) as usize + 13];
    for value in values {
        let at = (2.0 * (value - low)).round() as usize + 6;
        for (k, count) in counts.iter_mut().enumerate().skip(at - 6).take(13) {
            *count += (-0.125 * (k as f64 - at as f64).powi(2)).exp();
        }
    }
    let most = counts.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let peak = most.map_or(0.0, |(k, _)| low + 0.5 * (k as f64 - 6.0));
    let near: Vec<f64> = values
        .iter()
        .copied()
        .filter(|v| (v - peak).abs() < 2.5)
        .collect();
    match near.is_empty() {
        true => peak,
        false => near.iter().sum::<f64>() / near.len() as f64,
    }
}
