//! The offset contour `d = w(z)`: all curves that can form it, cut at their intersections. A part
//! is kept if no other part of the surface is nearer to it.
//!
//! `w` is linear in `z`, `w = alpha + beta z`, in one or two layers of height. Let `n` be a unit
//! vector away from the solid and `f` a point of the surface. The point `q = f + omega n` whose own
//! offset is `omega` solves `omega = alpha + beta (f.z + omega n.z)`:
//!
//! ```text
//! omega = (alpha + beta f.z) / (1 - beta n.z).
//! ```
//!
//! * Over a segment `n` is fixed and `f` moves: `q` moves along a straight line.
//! * About a corner `f` is fixed and `n` turns between the normals of its segments. `q` moves along
//!   a conic with a focus in the corner and the eccentricity `|beta|` (a circle if `beta = 0`). The
//!   conic is outside (`omega > 0`) at a convex corner, inside at a reflex one.
//!
//! If `1 - beta n.z` is negative (bevels steeper than 1 below the solid), `F` decreases away from
//! the surface, and the curve runs backwards.
//!
//! Every point of the contour is on such a curve. A point of a curve is on the contour if no other
//! part of the surface is nearer than `|omega|`. The answer can change only where two curves meet:
//! two lines, a line and a conic, or two conics. Two conics meet on the line midway between their
//! foci. All three cases are solved in closed form. Both curves take the very same point, so that
//! their parts join exactly. A feature's line and the conics of its own ends meet only at their
//! joints.

mod curve;

use super::chain::{JOINT, Segments};
use super::tree::Tree;
use crate::profile::Segment;
use curve::{Curve, meet, within};
use glam::DVec2;
use std::f64::consts::PI;

/// `w = alpha + beta z` for `low <= z <= high`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer<'a> {
    /// The surface.
    pub tree: &'a Tree,
    pub alpha: f64,
    pub beta: f64,
    pub low: f64,
    pub high: f64,
    /// Largest coordinate of the surface, at least 1: the unit of roundings.
    pub size: f64,
}

impl Layer<'_> {
    fn offset(&self, z: f64) -> f64 {
        self.alpha + self.beta * z
    }

    /// Possible ends of pieces of a corner's conic, in the order of the corner's turn: the borders of
    /// layer and half-plane, sign changes of the divisor, and steps of at most [`SWEEP`].
    fn conic_ends(&self, corner: &Corner) -> Vec<f64> {
        let (focus, turn) = (corner.point, corner.turn);
        let (from, to) = (corner.angle, corner.angle + turn);
        let mut ends = vec![from, to];
        let mut cut = |x: f64| ends.extend(within(x, from, to));
        for z in [self.low, self.high] {
            let sine = (z - focus.y) / self.offset(z);
            if sine.abs() <= 1.0 {
                cut(sine.asin());
                cut(PI - sine.asin());
            }
        }
        let axis = Curve::Conic {
            focus,
            size: self.offset(focus.y),
            from,
            to,
        };
        for x in axis.meets_line(self.beta, DVec2::X, 0.0) {
            cut(x);
        }
        // The far end of a thin ellipse, beyond which an arc is longer than its chord.
        cut(PI.copysign(self.beta) / 2.0);
        if self.beta.abs() >= 1.0 {
            let x = (1.0 / self.beta).asin();
            cut(x);
            cut(PI - x);
        }
        let sweeps = (turn.abs() / SWEEP).ceil();
        ends.extend((1..sweeps as u32).map(|k| from + turn * f64::from(k) / sweeps));
        ends.sort_unstable_by(|p, q| ((p - q) * turn.signum()).total_cmp(&0.0));
        ends
    }

    /// True if each point within `reach` of `middle` is hidden: some part of the surface is nearer
    /// than the offset there. A curve there meets no visible part of another, because both have the
    /// same offset where they meet. Without this test the curves of a fine pattern under a wide
    /// offset would all meet each other.
    fn hides(&self, middle: DVec2, reach: f64) -> bool {
        // A distance changes by at most the way, the offset by at most `beta` times it.
        let omega = self.offset(middle.y).abs() - (1.0 + self.beta.abs()) * reach;
        self.tree.any_nearer(middle, omega - NEARER * self.size)
    }

    /// The point, moved exactly onto a border of layer or half-plane if it is within `SHORT` of it.
    fn snapped(&self, mut p: DVec2) -> DVec2 {
        for z in [self.low, self.high] {
            if (p.y - z).abs() < SHORT {
                p.y = z;
            }
        }
        if p.x < SHORT {
            p.x = 0.0;
        }
        p
    }
}

/// A corner of the surface, with the normals before and after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub point: DVec2,
    /// Angle of the normal before it.
    pub angle: f64,
    /// Angle by which the normal turns: positive at convex corners.
    pub turn: f64,
}

/// Conics are divided into parts that turn less than this, and at the far end of an ellipse, so that
/// each part is about as large as its chord.
const SWEEP: f64 = 0.5;
/// Pieces of a conic that are tested for being hidden.
const PIECES: u32 = 8;
/// Largest distance of a conic from its chords, object units.
const SAGITTA: f64 = 1e-6;
/// Least difference of distances that counts as nearer, some roundings; unit: [`Layer::size`].
const NEARER: f64 = 2e-14;
/// Segments shorter than this are left out; the joint bridges them.
const SHORT: f64 = 0.2 * JOINT;

#[derive(Clone, Copy, Debug)]
struct Candidate {
    curve: Curve,
    low: DVec2,
    high: DVec2,
    /// Neighbours in the surface's order share a feature.
    feature: u32,
}

struct Trimmer<'a> {
    layer: &'a Layer<'a>,
    candidates: Vec<Candidate>,
}

pub(super) fn trim(
    layer: &Layer,
    segments: &[Segment],
    corners: &[[Option<Corner>; 2]],
    parts: &mut Segments,
) {
    let mut trimmer = Trimmer {
        layer,
        candidates: Vec::new(),
    };
    trimmer.load(segments, corners);
    let mut cuts = trimmer.cuts();
    cuts.sort_unstable_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)));
    trimmer.keep(&cuts, parts);
}

impl Trimmer<'_> {
    /// Finds the curves that can carry the contour.
    fn load(&mut self, segments: &[Segment], corners: &[[Option<Corner>; 2]]) {
        let (mut feature, mut end) = (1, None);
        for (s, [before, after]) in segments.iter().zip(corners) {
            // Neighbours in the list that do not join, such as two loops, share no feature.
            feature += if end == Some(s.a) { 2 } else { 4 };
            end = Some(s.b);
            // The corner before a segment that is not the corner after its predecessor: a curve
            // begins on the axis.
            if let Some(corner) = before {
                self.conic(corner, feature - 1);
            }
            self.line(s, feature);
            if let Some(corner) = after {
                self.conic(corner, feature + 1);
            }
        }
    }

    fn line(&mut self, s: &Segment, feature: u32) {
        let layer = self.layer;
        let normal = -(s.b - s.a).perp().normalize_or_zero();
        let divisor = 1.0 - layer.beta * normal.y;
        if divisor.abs() < 1e-9 {
            return;
        }
        let at = |f: DVec2| f + normal * (layer.offset(f.y) / divisor);
        let (a, b) = if divisor > 0.0 {
            (at(s.a), at(s.b))
        } else {
            (at(s.b), at(s.a))
        };
        let Some((a, b)) = clip_line(a, b, layer) else {
            return;
        };
        let candidate = Candidate {
            curve: Curve::Line { a, b },
            low: a.min(b) - SHORT,
            high: a.max(b) + SHORT,
            feature,
        };
        if !layer.hides(0.5 * (a + b), 0.5 * a.distance(b) + SHORT) {
            self.candidates.push(candidate);
        }
    }

    fn conic(&mut self, corner: &Corner, feature: u32) {
        let layer = self.layer;
        let focus = corner.point;
        let (size, turn) = (layer.offset(focus.y), corner.turn);
        for pair in layer.conic_ends(corner).windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let divisor = 1.0 - layer.beta * middle.sin();
            // Convex corners have their conic outside, reflex ones inside.
            if divisor.abs() < 1e-6 || (size / divisor > 0.0) != (turn > 0.0) {
                continue;
            }
            let [mut from, mut to] = [pair[0], pair[1]];
            if divisor < 0.0 {
                (from, to) = (to, from);
            }
            let curve = Curve::Conic {
                focus,
                size,
                from,
                to,
            };
            let inside = curve.point(layer.beta, middle);
            if inside.x < 0.0 || inside.y < layer.low || inside.y > layer.high {
                continue;
            }
            let [a, b] = curve.ends(layer);
            let chord = a.distance(b);
            let reach =
                |middle: DVec2, a: DVec2, b: DVec2| middle.distance(a).max(middle.distance(b));
            if chord < SHORT || layer.hides(inside, reach(inside, a, b)) {
                continue;
            }
            // The part between the first and the last pieces that may show.
            let at = |k: u32| from + (to - from) * f64::from(k) / f64::from(PIECES);
            let shows = |k: &u32| {
                let [a, middle, b] = [at(*k), 0.5 * (at(*k) + at(k + 1)), at(k + 1)]
                    .map(|x| curve.point(layer.beta, x));
                !layer.hides(middle, reach(middle, a, b))
            };
            let (Some(first), Some(last)) = ((0..PIECES).find(shows), (0..PIECES).rfind(shows))
            else {
                continue;
            };
            let (from, to) = (
                at(first),
                if last + 1 == PIECES { to } else { at(last + 1) },
            );
            let curve = Curve::Conic {
                focus,
                size,
                from,
                to,
            };
            let [a, b] = curve.ends(layer);
            let chord = a.distance(b);
            self.candidates.push(Candidate {
                curve,
                low: a.min(b) - chord,
                high: a.max(b) + chord,
                feature,
            });
        }
    }

    /// Cuts all curves at their intersections by a plane sweep upwards: `(candidate, parameter,
    /// point)` of each cut.
    fn cuts(&self) -> Vec<(u32, f64, DVec2)> {
        let candidates = &self.candidates;
        let mut order: Vec<u32> = (0..candidates.len() as u32).collect();
        order.sort_unstable_by(|&j, &k| {
            let z = |k: u32| candidates[k as usize].low.y;
            z(j).total_cmp(&z(k)).then(j.cmp(&k))
        });
        let (mut cuts, mut active) = (Vec::new(), Vec::new());
        for k in order {
            let own = &candidates[k as usize];
            active.retain(|&j: &u32| candidates[j as usize].high.y >= own.low.y);
            for &j in &active {
                let other = &candidates[j as usize];
                if other.low.x <= own.high.x && own.low.x <= other.high.x {
                    let (first, second) = (j.min(k), j.max(k));
                    meet(
                        self.layer.beta,
                        &candidates[first as usize],
                        &candidates[second as usize],
                        |x, y, p| {
                            cuts.push((first, x, p));
                            cuts.push((second, y, p));
                        },
                    );
                }
            }
            active.push(k);
        }
        cuts
    }

    /// Keeps the parts of each curve that are on the contour.
    fn keep(&self, mut cuts: &[(u32, f64, DVec2)], parts: &mut Segments) {
        let layer = self.layer;
        for (k, candidate) in self.candidates.iter().enumerate() {
            let own = cuts.partition_point(|c| c.0 as usize <= k);
            let (these, rest) = cuts.split_at(own);
            cuts = rest;
            let curve = &candidate.curve;
            let [begin, end] = curve.ends(layer);
            let [from, to] = curve.range();
            let place = |j: usize| match j {
                0 => (from, begin),
                j if j > these.len() => (to, end),
                // A conic that runs backwards has its cuts in reverse order.
                j if to < from => (these[these.len() - j].1, these[these.len() - j].2),
                j => (these[j - 1].1, these[j - 1].2),
            };
            for j in 0..=these.len() {
                let ((x0, a), (x1, b)) = (place(j), place(j + 1));
                if a.distance_squared(b) < SHORT * SHORT {
                    continue;
                }
                let middle = curve.point(layer.beta, 0.5 * (x0 + x1));
                if layer.hides(middle, 0.0) {
                    continue;
                }
                parts.begin();
                parts.point(a);
                if let Curve::Conic { .. } = curve {
                    let beta = layer.beta;
                    // Curvature times the square of the speed by angle. The divisor is the slope of F.
                    let bend = |x: f64, p: DVec2| {
                        let slope = (1.0 - 2.0 * beta * x.sin() + beta * beta).sqrt();
                        layer.offset(p.y).abs() / slope.max(1e-6)
                    };
                    let most = bend(x0, a).max(bend(x1, b));
                    let most = most.max(bend(0.5 * (x0 + x1), middle));
                    let step = (8.0 * SAGITTA / most.max(1e-12)).sqrt();
                    let n = ((x1 - x0).abs() / step).ceil().clamp(1.0, 4096.0);
                    parts.reserve(n as usize);
                    for i in 1..n as u32 {
                        parts.point(curve.point(layer.beta, x0 + (x1 - x0) * f64::from(i) / n));
                    }
                }
                parts.point(b);
            }
        }
    }
}

/// The part of a line within a layer and the half-plane. Returns none if the line is in the box's
/// floor or ceiling, or in the border to the layer below, which has it already.
fn clip_line(a: DVec2, b: DVec2, layer: &Layer) -> Option<(DVec2, DVec2)> {
    let level = |z: f64| (a.y - z).abs() < SHORT && (b.y - z).abs() < SHORT;
    if level(layer.low) || (level(layer.high) && layer.high >= 1.0) {
        return None;
    }
    let (mut from, mut to) = (0.0f64, 1.0f64);
    let mut ends = [a, b];
    // A value >= 0 is within.
    let mut cut = |va: f64, vb: f64, fix: &dyn Fn(&mut DVec2)| {
        if va < 0.0 && vb < 0.0 {
            from = 2.0;
        } else if va < 0.0 || vb < 0.0 {
            let x = va / (va - vb);
            let mut p = a.lerp(b, x);
            fix(&mut p);
            if va < 0.0 && x > from {
                (from, ends[0]) = (x, p);
            } else if vb < 0.0 && x < to {
                (to, ends[1]) = (x, p);
            }
        }
    };
    cut(a.x, b.x, &|p| p.x = 0.0);
    cut(a.y - layer.low, b.y - layer.low, &|p| p.y = layer.low);
    cut(layer.high - a.y, layer.high - b.y, &|p| p.y = layer.high);
    if from >= to {
        return None;
    }
    let ends = ends.map(|p| layer.snapped(p));
    (ends[0].distance_squared(ends[1]) >= SHORT * SHORT).then_some((ends[0], ends[1]))
}
