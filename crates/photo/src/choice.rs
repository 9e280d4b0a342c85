//! The best of many masks.

use crate::form::{Border, Rows, mirrored, turned};
use crate::ground::{Backdrop, distances};
use crate::mask::{Mask, cleaned, count, largest, likeness, mask, otsu, shared};
use crate::work::Work;
use rayon::prelude::*;

/// A mask and what speaks for it.
pub(crate) struct Candidate {
    pub mask: Mask,
    /// The number of its ground.
    pub ground: usize,
    pub border: Border,
    pub parts_left_out: usize,
    pub rows: Rows,
    pub axis: f64,
    pub symmetry: f64,
    /// Part of the border at which the picture has no edge.
    pub faint: f64,
    /// The mask that it was made from, if that is another.
    pub origin: Option<Mask>,
    pub score: f64,
}

/// Thresholds, times Otsu's.
const THRESHOLDS: [f32; 5] = [1.0, 0.6, 0.35, 0.2, 1.5];

/// Masks that are less different count as one.
const SAME: f64 = 0.996;

/// Masks that are less different are improved once.
const ALIKE: f64 = 0.98;
/// Masks that are improved.
const MOST_IMPROVED: usize = 24;

/// All masks, the best first.
pub(crate) fn candidates(work: &Work, backdrops: &[Backdrop]) -> Vec<Candidate> {
    let least = 2.2 * work.noise / work.blur + 0.8;
    let (w, h) = (work.width, work.height);
    let mut rough = Vec::new();
    for (ground, backdrop) in backdrops.iter().enumerate() {
        for distances in distances(work, backdrop) {
            let otsu = otsu(&distances, w);
            let edges = THRESHOLDS.map(|t| otsu * t).into_iter();
            let edges = edges.filter(|t| *t >= least);
            rough.extend(edges.map(|t| (ground, mask(w, h, |i| distances[i] > t))));
        }
    }
    let rough = rough.into_par_iter().map(|(ground, rough)| {
        let (mask, left_out) = cleaned(&rough);
        (mask, ground, left_out)
    });
    let mut distinct: Vec<(Mask, usize, usize)> = Vec::new();
    for found in rough.collect::<Vec<_>>() {
        if count(&found.0) >= 50 && !distinct.iter().any(|d| likeness(&d.0, &found.0) > SAME) {
            distinct.push(found);
        }
    }
    let found = distinct.into_par_iter();
    let found =
        found.filter_map(|(mask, ground, left_out)| Candidate::new(work, mask, ground, left_out));
    let mut found: Vec<Candidate> = found.collect();
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut distinct: Vec<&Candidate> = Vec::new();
    for candidate in &found {
        let is_new = !distinct
            .iter()
            .any(|d| likeness(&d.mask, &candidate.mask) > ALIKE);
        if is_new && distinct.len() < MOST_IMPROVED {
            distinct.push(candidate);
        }
    }
    let more = distinct.par_iter().flat_map_iter(|c| c.improved(work));
    found.extend(more.collect::<Vec<_>>());
    found.sort_by(|a, b| b.score.total_cmp(&a.score));
    found
}

fn touches(mask: &Mask) -> bool {
    let (w, h) = mask.dimensions();
    (0..h).any(|y| mask.get_pixel(0, y).0[0] > 0 || mask.get_pixel(w - 1, y).0[0] > 0)
}

impl Candidate {
    /// `None` for a mask that is far too small or large, or that has no border.
    pub fn new(work: &Work, mask: Mask, ground: usize, parts_left_out: usize) -> Option<Self> {
        let (w, h) = mask.dimensions();
        let area = count(&mask);
        let part = area as f64 / f64::from(w * h);
        if !(0.008..=0.8).contains(&part) {
            return None;
        }
        let border = Border::of(&mask)?;
        let solid = |x: u32, y: u32| mask.get_pixel(x, y).0[0] > 0;
        let column = |x: u32| (0..h).filter(|y| solid(x, *y)).count() as f64 / f64::from(h);
        let row = |y: u32| (0..w).filter(|x| solid(*x, y)).count() as f64 / f64::from(w);
        let (left, right, top, bottom) = (column(0), column(w - 1), row(0), row(h - 1));
        let rows = border.rows(0.0);
        let height = rows.ends.len() as f64 / f64::from(h);
        let touched = left.max(right) > 0.05 * height;
        let (symmetry, rows) = border.best(!touched);
        let filled = (area as f64 / rows.area().max(1.0)).min(1.0);
        let (edges, faint) = edges(work, &border)?;
        let side = (left + right)
            * if left > 0.0 && right > 0.0 || top + bottom > 0.0 {
                1.0
            } else {
                0.3
            };
        let across = left > 0.0 && right > 0.0 && side > 0.02;
        let score = symmetry.powi(3)
            * filled.powi(2)
            * edges
            * part.powf(0.32)
            * (1.0 - 0.8 * side.min(1.0))
            * (1.0 - 0.5 * top)
            * if across { 0.6 } else { 1.0 }
            / (1.0 + 0.02 * border.raggedness(area));
        let axis = rows.axis(f64::from(w));
        Some(Self {
            mask,
            ground,
            border,
            parts_left_out,
            rows,
            axis,
            symmetry,
            faint,
            origin: None,
            score,
        })
    }

    /// Returns true for a larger thing on the same axis that holds this one and is nearly as likely.
    pub fn continues(&self, best: &Self) -> bool {
        let [own, other] = [self, best].map(|c| count(&c.mask) as f64);
        let beside = (self.axis - best.axis).abs() / f64::from(best.mask.width());
        let alike = likeness(&self.mask, &best.mask);
        let both = alike * (own + other) / (1.0 + alike);
        self.score > 0.8 * best.score && own > 1.4 * other && both > 0.93 * other && beside < 0.015
    }

    /// The part of the mask that is on both sides of its axis.
    pub fn mirrored(&self, work: &Work) -> Mask {
        let (axis, angle) = (self.axis, self.rows.angle);
        shared(&self.mask, |p| mirrored(p, work.middle(), axis, angle))
    }

    /// Masks that are better where the thing has bands, a handle or a shadow.
    fn improved(&self, work: &Work) -> Vec<Self> {
        let (w, h) = (work.width, work.height);
        let rows = match self.symmetry < 0.97 {
            true => self.border.straightest(),
            false => self.border.rows(self.rows.angle),
        };
        let (axis, angle) = (rows.axis(w as f64), rows.angle);
        let middle = work.middle();
        let of = |mask: Mask, part: f64| {
            if count(&mask) < 50 || likeness(&mask, &self.mask) >= 0.99 {
                return None;
            }
            let mut made = Self::new(work, mask, self.ground, self.parts_left_out)?;
            made.score *= part;
            made.origin = Some(self.mask.clone());
            Some(made)
        };
        let mut made = Vec::new();
        let mut base = self.mask.clone();
        if !touches(&base) {
            base = shared(&base, |p| mirrored(p, middle, axis, angle));
            made.extend(of(base.clone(), 0.93));
        }
        let clear = 1.5 + 2.0 * work.noise;
        let is_edge = |row: usize, r: f64| {
            let side = |u: f64| {
                strongest(work, turned([u, rows.top + row as f64], middle, -angle)) > clear
            };
            side(axis - r) && side(axis + r)
        };
        if let Some(widths) = rows.bridged(axis, 0.17 * rows.ends.len() as f64, is_edge) {
            let bridged = mask(w, h, |i| {
                let place = [(i % w) as f64 + 0.5, (i / w) as f64 + 0.5];
                let [u, v] = turned(place, middle, angle);
                let row = (v - rows.top).round();
                let width = widths.get(row as usize).filter(|_| row >= 0.0);
                base.as_raw()[i] > 0 || width.is_some_and(|r| (u - axis).abs() < *r)
            });
            made.extend(of(largest(&bridged).0, 0.95));
        }
        made
    }
}

/// The strength of the picture's edges along a border, in `[0, 1]`: weak places count most.
fn edges(work: &Work, border: &Border) -> Option<(f64, f64)> {
    let (w, h) = (work.width, work.height);
    let inside =
        |[x, y]: &&[f64; 2]| *x > 1.0 && *y > 1.0 && *x < w as f64 - 1.0 && *y < h as f64 - 1.0;
    let points = border.points.iter().filter(inside);
    let mut found: Vec<f32> = points.map(|p| strongest(work, *p)).collect();
    if found.len() < 20 {
        return None;
    }
    found.sort_by(f32::total_cmp);
    let at = |part: f64| f64::from(found[(part * (found.len() - 1) as f64) as usize]);
    let noise = 2.0 * f64::from(work.noise) + 0.4;
    let edges = [0.12, 0.3, 0.5].map(|p| at(p) / (at(p) + noise));
    let edges = edges.iter().sum::<f64>() / 3.0;
    let faint = found.partition_point(|g| *g < 1.5) as f64 / found.len() as f64;
    Some((edges, faint))
}

/// The largest gradient within two pixels of a place.
fn strongest(work: &Work, p: [f64; 2]) -> f32 {
    let [x, y] = p.map(|v| v.max(0.0) as usize);
    let near = |at: usize, end: usize| at.saturating_sub(2)..(at + 3).min(end);
    let rows = near(y, work.height).flat_map(|y| {
        let columns = near(x, work.width);
        columns.map(move |x| y * work.width + x)
    });
    rows.map(|i| work.gradient[i]).fold(0.0, f32::max)
}
