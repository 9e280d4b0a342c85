//! Fits a curve to points that are accurate to a fraction of a texel: first corners, then straight
//! runs, then round parts.
//!
//! * A **corner** is a local maximum of the turn between two lines: through the points 1.5 to 4.5
//!   texels before and after (to 7 in binary pictures). The turn must be larger than the points'
//!   noise can cause. The corner is placed at the intersection of the lines of its two sides.
//! * A stretch between corners is **straight** if one line fits it as well as the noise allows. It
//!   is level or upright if its whole drift is less than that noise.
//! * Every other point is moved to the parabola (in the arc length) through its neighbours. The
//!   window is the widest whose residuals are no more than noise: uniform within a texel in binary
//!   pictures (rms 0.29), a few hundredths in anti-aliased ones.
//!
//! All lengths are in texels.

mod least_squares;

use glam::DVec2;
use least_squares::{Parabola, line_through, meeting, parabola};
use revmap::profile::{Segment, loop_area};

/// Points along a boundary: closed, or from the axis to the axis (`x = 0`).
#[derive(Clone, Debug, Default)]
pub(super) struct Trail {
    pub points: Vec<DVec2>,
    pub closed: bool,
}

/// Bounds on the points' errors.
#[derive(Clone, Copy, Debug)]
struct Noise {
    /// Largest and root mean square residual of a fit that is still as good as the points.
    most: f64,
    rms: f64,
    /// Distance along the curve that the lines of a corner extend.
    reach: f64,
    /// Cosine of the least turn of a corner.
    turn: f64,
    /// Largest number of points on each side of a window.
    window: usize,
    /// Straight runs that drift less than this are level or upright.
    drift: f64,
    /// Residuals (rms) below this are noise, even if a parabola explains them.
    least: f64,
    /// Largest residual of a corner's straight sides.
    line: f64,
    /// Lines that meet farther from the curve than this touch a round part.
    round: f64,
    /// True if the points are good enough to distinguish a corner between curved sides from a bend.
    curved: bool,
}

const BINARY: Noise = Noise {
    most: 0.62,
    rms: 0.3,
    reach: 7.0,
    turn: 0.82,
    window: 40,
    drift: 0.6,
    least: 0.1,
    line: 0.62,
    round: 0.75,
    curved: false,
};
const GRADED: Noise = Noise {
    most: 0.1,
    rms: 0.04,
    reach: 5.5,
    turn: 0.94,
    window: 10,
    drift: 0.08,
    least: 0.01,
    line: 0.03,
    round: 0.45,
    curved: true,
};
/// A run is not straight if a parabola leaves less than this part of the line's residuals.
const BENT: f64 = 0.75;
/// Smallest `|dr|` of the unit direction of a straight run that crosses the axis.
const SLANT: f64 = 0.2;
/// Points nearer to a corner than this are affected by its rounding.
const NEAR: f64 = 1.5;

/// The smoothed curve's points. A curve of a few pixels that would lose half of its area stays as
/// it is.
pub(super) fn smooth(mut trail: Trail, graded: bool) -> Vec<DVec2> {
    if trail.points.len() < 3 {
        return trail.points;
    }
    let noise = if graded { GRADED } else { BINARY };
    let mut line = Line::new(&trail);
    let mut corners = line.corners(&noise);
    if let Some(first) = corners.first().map(|c| c.index - line.first)
        && trail.closed
    {
        // A closed trail begins with a corner, so that no run extends past its ends.
        trail.points.rotate_left(first);
        line = Line::new(&trail);
        for corner in &mut corners {
            corner.index -= first;
        }
    }
    let runs = line.runs(&corners, &noise);
    if loop_area(&runs) / loop_area(&trail.points) > 0.5 {
        runs
    } else {
        trail.points
    }
}

/// The trail continued past its ends: round again if it is closed, mirrored if it ends on the axis.
struct Line {
    points: Vec<DVec2>,
    /// Arc length up to each point.
    place: Vec<f64>,
    /// The trail itself is `first..first + count`.
    first: usize,
    count: usize,
    closed: bool,
}

/// A line: a point and a unit direction.
type Side = (DVec2, DVec2);

/// Cosine of half of the turn between two directions: near 0 at the tip of a wedge.
fn half_cosine([(_, u), (_, v)]: [Side; 2]) -> f64 {
    (0.5 * (1.0 + u.dot(v))).max(0.0).sqrt()
}

/// A corner or an end: its index in the list and its position.
#[derive(Clone, Copy, Debug)]
struct Corner {
    index: usize,
    point: Option<DVec2>,
}

impl Line {
    fn new(trail: &Trail) -> Self {
        const EXTRA: usize = 48;
        let n = trail.points.len();
        let at = |k: isize| {
            let n = n as isize;
            if trail.closed {
                return trail.points[k.rem_euclid(n) as usize];
            }
            // The end on the axis is its own mirror image.
            let inner = if k < 0 { -k } else { k.min(2 * (n - 1) - k) };
            let p = trail.points[inner as usize];
            if inner == k { p } else { DVec2::new(-p.x, p.y) }
        };
        let extra = EXTRA.min(if trail.closed { n } else { n - 1 });
        let points: Vec<DVec2> = (-(extra as isize)..(n + extra) as isize).map(at).collect();
        let mut place = vec![0.0; points.len()];
        for k in 1..points.len() {
            place[k] = place[k - 1] + points[k].distance(points[k - 1]);
        }
        Self {
            points,
            place,
            first: extra,
            count: n,
            closed: trail.closed,
        }
    }

    fn corners(&self, noise: &Noise) -> Vec<Corner> {
        let range = self.first..self.first + self.count;
        // Cosine of the turn at each point. Among equal ones, the point where the sides meet is
        // used.
        let turns: Vec<f64> = (0..self.points.len())
            .map(
                |k| match self.sides(k, noise).filter(|_| range.contains(&k)) {
                    Some(sides) => {
                        let away = meeting(sides).map_or(0.0, |m| m.distance(self.points[k]));
                        sides[0].1.dot(sides[1].1) + 1e-3 * away
                    }
                    None => 1.0,
                },
            )
            .collect();
        let mut corners: Vec<Corner> = Vec::new();
        for k in range.clone() {
            let own = turns[k];
            if own >= noise.turn {
                continue;
            }
            let near = |j: &usize| (self.place[*j] - self.place[k]).abs() < 2.5;
            let before = (0..k).rev().take_while(near);
            let after = (k + 1..self.points.len()).take_while(near);
            let sharpest = before.chain(after).all(|j| {
                // A closed trail wraps round past its ends.
                let turn = match self.closed {
                    true => turns[self.first + (j + self.count - self.first) % self.count],
                    false => turns[j],
                };
                turn > own || (turn == own && j > k)
            });
            if sharpest {
                let point = self.sides(k, noise).and_then(meeting);
                corners.push(Corner {
                    index: k,
                    point: point.filter(|m| m.distance(self.points[k]) < 2.0),
                });
            }
        }
        corners
    }

    /// The two sides of a corner at point `k`, each as a point and a direction. Both sides are
    /// tangents of parabolas through the points before and after if these are good and many enough.
    /// Otherwise they are lines, unless these merely touch a round part.
    fn sides(&self, k: usize, noise: &Noise) -> Option<[Side; 2]> {
        let part = |from: f64, to: f64| {
            let low = self.place.partition_point(|&s| s < self.place[k] + from);
            let high = self.place.partition_point(|&s| s <= self.place[k] + to);
            low..high
        };
        let parts = [part(-noise.reach, -NEAR), part(NEAR, noise.reach)];
        if noise.curved && parts.iter().all(|p| p.len() >= 4) {
            let fits = parts.clone().map(|p| self.parabola(k, p.start, p.end - 1));
            if let [Some(a), Some(b)] = fits
                && a.most.max(b.most) <= noise.most
            {
                return Some([(a.point, a.way), (b.point, b.way)]);
            }
        }
        let [a, b] = parts.map(|p| line_through(self.points.get(p)?));
        let ((p, u, x), (q, v, y)) = (a?, b?);
        let sides = [(p, u), (q, v)];
        // The pixels' curve stays farther away from a sharp corner.
        let wedge = half_cosine(sides).max(0.25);
        let met = meeting(sides)?;
        (x.max(y) <= noise.line && self.away(met, k) * wedge < noise.round).then_some(sides)
    }

    /// Distance of a position from the trail near point `k`.
    fn away(&self, m: DVec2, k: usize) -> f64 {
        let near = k.saturating_sub(4)..(k + 4).min(self.points.len() - 1);
        let distances = near.map(|j| {
            let (a, b) = (self.points[j], self.points[j + 1]);
            Segment { a, b }.nearest(m).0.distance(m)
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Fits everything between corners.
    fn runs(&self, corners: &[Corner], noise: &Noise) -> Vec<DVec2> {
        let last = self.first + self.count - 1;
        let end = |index| Corner { index, point: None };
        let mut ends: Vec<Corner> = corners.to_vec();
        if !self.closed {
            if ends.first().is_none_or(|c| c.index != self.first) {
                ends.insert(0, end(self.first));
            }
            if ends.last().is_none_or(|c| c.index != last) {
                ends.push(end(last));
            }
        } else if let Some(&first) = ends.first() {
            ends.push(Corner {
                index: first.index + self.count,
                ..first
            });
        } else {
            return (self.first..=last)
                .map(|k| self.rounded(k, 0, self.points.len() - 1, noise))
                .collect();
        }
        let on_axis = |c: &Corner| !self.closed && (c.index == self.first || c.index == last);
        let straight: Vec<Option<Side>> = ends
            .windows(2)
            .map(|pair| {
                // A straight run that ends on the axis has to cross it: a run from axis to axis
                // encloses nothing.
                let ends = pair.iter().filter(|c| on_axis(c)).count();
                self.straight(pair[0].index, pair[1].index, noise)
                    .filter(|(_, way)| ends == 0 || (ends == 1 && way.x.abs() > SLANT))
            })
            .collect();
        let mut out: Vec<DVec2> = Vec::new();
        for (k, pair) in ends.windows(2).enumerate() {
            if !self.closed && k == 0 {
                out.push(self.end(&pair[0], straight[0], noise));
            } else {
                let before = straight[k.checked_sub(1).unwrap_or(straight.len() - 1)];
                out.extend(self.corner(&pair[0], [before, straight[k]], noise));
            }
            if straight[k].is_none() {
                // The trail continues past an end on the axis that is no corner.
                let limit = |c: &Corner, beyond: usize| match on_axis(c) && c.point.is_none() {
                    true => beyond,
                    false => c.index,
                };
                let low = limit(&pair[0], 0);
                let high = limit(&pair[1], self.points.len() - 1);
                // Points that a corner has rounded are ignored.
                let room = |j: &usize| {
                    let far = |c: &Corner| (self.place[*j] - self.place[c.index]).abs() > NEAR;
                    pair.iter().all(|c| c.point.is_none() || far(c))
                };
                let inner = (pair[0].index + 1..pair[1].index).filter(room);
                out.extend(inner.map(|j| self.rounded(j, low, high, noise)));
            }
        }
        if !self.closed
            && let Some(corner) = ends.last()
        {
            let before = straight.last().copied().flatten();
            out.push(self.end(corner, before, noise));
        }
        out
    }

    /// The position of a corner: the intersection of its straight sides if it has them. If they do
    /// not meet near by, each straight side has an end of its own.
    fn corner(&self, corner: &Corner, sides: [Option<Side>; 2], noise: &Noise) -> Vec<DVec2> {
        let own = self.points[corner.index];
        let tangents = self.sides(corner.index, noise);
        let [before, after] = [0, 1].map(|k| sides[k].or(tangents.map(|t| t[k])));
        if let Some(pair) = before.zip(after).map(|(a, b)| [a, b])
            && let Some(met) = meeting(pair)
        {
            // The tip of a wedge is far from the nearest pixel that it covers by one half.
            let wedge = 2.0 / half_cosine(pair).max(0.25);
            let reach = match sides.iter().flatten().count() {
                2 => wedge,
                1 if noise.curved => wedge.min(3.0),
                _ => 2.0,
            };
            if met.distance(own) < reach {
                return vec![met];
            }
        }
        let foot = |(p, u): Side| p + u * u.dot(own - p);
        let feet: Vec<DVec2> = sides.into_iter().flatten().map(foot).collect();
        if feet.is_empty() {
            return vec![corner.point.unwrap_or(own)];
        }
        feet
    }

    /// The end of a trail on the axis. The trail's mirror image is the other side.
    fn end(&self, corner: &Corner, side: Option<Side>, noise: &Noise) -> DVec2 {
        let z = match (side, corner.point) {
            (Some((p, u)), _) => (p - u * (p.x / u.x)).y,
            (_, Some(p)) => p.y,
            _ => {
                self.rounded(corner.index, 0, self.points.len() - 1, noise)
                    .y
            }
        };
        DVec2::new(0.0, z)
    }

    /// The line of a straight run between two corners.
    fn straight(&self, from: usize, to: usize, noise: &Noise) -> Option<Side> {
        let low = self.place.partition_point(|&s| s < self.place[from] + 1.0);
        let high = self
            .place
            .partition_point(|&s| s <= self.place[to.min(self.place.len() - 1)] - 1.0);
        let points = self.points.get(low..high)?;
        let (p, u, most) = line_through(points)?;
        if most > noise.most {
            return None;
        }
        // Both long and short arcs look straight within the noise, unless a parabola explains much
        // more of it.
        if points.len() > 5 {
            let sum: f64 = points.iter().map(|q| u.perp_dot(*q - p).powi(2)).sum();
            let rms = (sum / points.len() as f64).sqrt();
            let bent = self.parabola(usize::midpoint(low, high), low, high - 1);
            if rms > noise.least && bent.is_some_and(|b| b.rms < BENT * rms) {
                return None;
            }
        }
        let length = points[0].distance(points[points.len() - 1]);
        let level = |drift: f64, way: DVec2| {
            (drift.abs() * length < noise.drift).then(|| way * u.dot(way).signum())
        };
        let way = level(u.y, DVec2::X)
            .or_else(|| level(u.x, DVec2::Y))
            .unwrap_or(u);
        Some((p, way))
    }

    /// The parabola through points `from..=to`, at point `k`.
    fn parabola(&self, k: usize, from: usize, to: usize) -> Option<Parabola> {
        parabola(&self.points, &self.place, k, from, to)
    }

    /// Point `k` moved to the parabola of its neighbours between two corners.
    fn rounded(&self, k: usize, low: usize, high: usize, noise: &Noise) -> DVec2 {
        let mut best = self.points[k];
        // A window over much of a small loop would shrink it.
        let most = noise
            .window
            .min(self.count / if self.closed { 6 } else { 3 });
        let mut m = 2;
        while m <= most {
            // The window has equally many points on each side, so that the fit is not biased to
            // either. Near a corner the other side has a few more.
            let (left, right) = (k - low, high.min(self.points.len() - 1) - k);
            let (left, right) = (left.min(m), right.min(m));
            if left + right < m.min(4) {
                break;
            }
            let Some(fit) = self.parabola(k, k - left, k + right) else {
                break;
            };
            if fit.rms > noise.rms || fit.most > noise.most {
                break;
            }
            best = fit.point;
            m += if m < 8 { 1 } else { m / 4 };
        }
        best
    }
}
