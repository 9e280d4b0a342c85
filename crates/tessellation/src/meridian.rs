//! A contour's chains, thinned to rings.

use super::parted::{NEAR, cleaned, parted};
use glam::DVec2;
use revmap::surface::{Chain, Contour};

/// A ring of vertices, seen in the half-plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// `(r, z)`.
    pub point: DVec2,
    /// Unit outward normals of the surface before it and after it; equal where there is no crease.
    pub normals: [DVec2; 2],
}

/// The rings of one chain; a closed one ends with the ring that it begins with.
#[derive(Clone, Debug, Default)]
pub struct Strand {
    /// At least two, in the order of the chain: the solid is on the left.
    pub rings: Vec<Ring>,
    /// True if the chain is closed. Otherwise both ends are on the axis.
    pub closed: bool,
}

/// Joints that turn more are creases: twice what a circle of 48 corners turns at each.
const CREASE: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// Object units over which a corner is still one: three pixels of an image of 512 rows.
const AROUND: f64 = 3.0 / 512.0;
/// Vertices are shared where the normals on both sides differ by less. The error is half of that.
/// Without sharing a fine mesh takes a tenth more time (llvmpipe).
const SHARED: f64 = 4.0 * std::f64::consts::PI / 180.0;
/// The least and the largest tolerance, object units.
const TOLERANCES: [f64; 2] = [1e-8, 0.05];

/// All chains as strands of at most `most` chords together, or more if corners need them.
#[must_use]
pub fn strands_of(contour: &Contour, most: usize) -> Vec<Strand> {
    let lines = lines(&cleaned(&contour.chains));
    let chords = |line: &Line, tolerance| line.thinned(true, &|_| tolerance).len() - 1;
    let count = |tolerance: f64| -> usize { lines.iter().map(|l| chords(l, tolerance)).sum() };
    let [mut low, mut high] = TOLERANCES;
    if count(low) <= most {
        high = low;
    }
    while high > low * 1.001 {
        let middle = (low * high).sqrt();
        if count(middle) <= most {
            high = middle;
        } else {
            low = middle;
        }
    }
    lines.iter().map(|l| l.strand(high)).collect()
}

/// All chains as strands that are nowhere farther than `tolerance` from the contour. They do not
/// cross each other where walls are thin, and do not meet where parts of the solid touch: there they
/// are a quarter of the tolerance, or 1e-7 if that is more, away from the contour.
#[must_use]
pub fn strands_within(contour: &Contour, tolerance: f64) -> Vec<Strand> {
    let apart = (0.25 * tolerance).max(NEAR);
    let chains = cleaned(&contour.chains);
    let parted = parted(&chains, apart);
    let left = if parted.is_some() {
        tolerance - apart
    } else {
        tolerance
    };
    let lines = lines(parted.as_ref().unwrap_or(&chains));
    // Chords pass within this of all points, and rings are moved by at most half of it.
    let mut chords = left / 1.5;
    loop {
        let strands: Vec<Strand> = lines.iter().map(|l| l.strand(chords)).collect();
        // The finest strands are the contour, whose chains may touch.
        if chords < TOLERANCES[0] || !crosses(&strands) {
            return strands;
        }
        chords *= 0.5;
    }
}

pub(super) fn lines(chains: &[Chain]) -> Vec<Line> {
    chains.iter().map(Line::new).collect()
}

/// Returns true if any two chords cross, or are one there and back: a part thinner than the
/// tolerance. Chords that only touch do not cross.
fn crosses(strands: &[Strand]) -> bool {
    let chords = strands.iter().flat_map(|s| s.rings.windows(2));
    let mut chords: Vec<[DVec2; 2]> = chords.map(|r| [r[0].point, r[1].point]).collect();
    let low = |c: &[DVec2; 2]| c[0].y.min(c[1].y);
    chords.sort_by(|a, b| low(a).total_cmp(&low(b)));
    let mut beside: Vec<[DVec2; 2]> = Vec::new();
    chords.iter().any(|chord| {
        beside.retain(|c| c[0].y.max(c[1].y) >= low(chord));
        let found = beside.iter().any(|other| cross(chord, other));
        beside.push(*chord);
        found
    })
}

fn cross([a, b]: &[DVec2; 2], [c, d]: &[DVec2; 2]) -> bool {
    let sides = |a: &DVec2, b: &DVec2, c: &DVec2, d: &DVec2| {
        (b - a).perp_dot(c - a) * (b - a).perp_dot(d - a) < 0.0
    };
    [a, b] == [d, c] || sides(a, b, c, d) && sides(c, d, a, b)
}

/// A chain from its first point to its last; a closed one begins at a crease if it has any.
pub(super) struct Line {
    pub(super) points: Vec<DVec2>,
    /// Outward normals of the segments: segment `k` runs from point `k` on.
    normals: Vec<DVec2>,
    /// First and last point, and creases between.
    fixed: Vec<usize>,
    closed: bool,
}

impl Line {
    fn new(chain: &Chain) -> Self {
        let mut points = chain.points.clone();
        if chain.closed {
            let corner = (0..points.len()).find(|&k| is_corner(&points, true, k));
            points.rotate_left(corner.unwrap_or(0));
            points.push(points[0]);
        }
        let last = points.len() - 1;
        if !chain.closed {
            (points[0].x, points[last].x) = (0.0, 0.0);
        }
        let normals: Vec<DVec2> = points
            .windows(2)
            .map(|p| -(p[1] - p[0]).perp().normalize_or_zero())
            .collect();
        let mut fixed = vec![0];
        fixed.extend((1..last).filter(|&k| is_corner(&points, false, k)));
        fixed.push(last);
        Self {
            points,
            normals,
            fixed,
            closed: chain.closed,
        }
    }

    /// The points that stay: between those that are fixed, chords as long as the tolerance of each
    /// point allows. Without `corners` only the ends are fixed, and chords may cut folds.
    pub(super) fn thinned(&self, corners: bool, tolerance: &dyn Fn(usize) -> f64) -> Vec<usize> {
        let ends = [0, self.points.len() - 1];
        let fixed = if corners { &self.fixed[..] } else { &ends };
        let mut kept = vec![0];
        for section in fixed.windows(2) {
            let mut at = section[0];
            while at < section[1] {
                at = self.reach(at, section[1], !corners, tolerance);
                kept.push(at);
            }
        }
        kept
    }

    /// The farthest point up to `end` such that all between lie within their tolerance of the line
    /// to it: the directions that meet the discs about all points so far are an interval (Imai and
    /// Iri). The line does not turn back, or with `folds` by no more than the tolerance.
    fn reach(
        &self,
        from: usize,
        end: usize,
        folds: bool,
        tolerance: &dyn Fn(usize) -> f64,
    ) -> usize {
        let start = self.points[from];
        let ahead = self.points[from + 1] - start;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut found, mut farthest) = (from + 1, 0.0f64);
        for k in from + 1..=end {
            let (chord, tolerance) = (self.points[k] - start, tolerance(k));
            farthest = farthest.max(chord.length());
            let turns_back = match folds {
                true => chord.length() < farthest - tolerance,
                false => (self.points[k] - self.points[k - 1]).dot(ahead) < 0.0,
            };
            if turns_back {
                break;
            }
            let angle = ahead.angle_to(chord);
            if (low..=high).contains(&angle) {
                found = k;
            }
            let far = chord.length();
            if far > tolerance {
                let half = (tolerance / far).asin();
                low = low.max(angle - half);
                high = high.min(angle + half);
            }
            if low > high {
                break;
            }
        }
        found
    }

    fn strand(&self, tolerance: f64) -> Strand {
        self.strand_of(&self.thinned(true, &|_| tolerance))
    }

    /// The strand with rings at these points.
    pub(super) fn strand_of(&self, kept: &[usize]) -> Strand {
        let chords: Vec<Chord> = kept.windows(2).map(|k| self.chord(k[0], k[1])).collect();
        let last = chords.len();
        let rings = kept.iter().enumerate().map(|(n, &k)| {
            let neighbours = match (0 < n && n < last, self.closed) {
                (true, _) => Some([n - 1, n]),
                (false, true) => Some([last - 1, 0]),
                (false, false) => None,
            };
            let mut point = self.points[k];
            let Some([before, after]) = neighbours.map(|c| c.map(|c| chords[c])) else {
                let end = match n {
                    0 => chords[0].normals[0],
                    _ => chords[last - 1].normals[1],
                };
                return Ring {
                    point,
                    normals: [pole(end); 2],
                };
            };
            let normals = joined(before, after);
            if self.fixed.binary_search(&k).is_err() {
                let outward = (normals[0] + normals[1]).normalize_or_zero();
                point += outward * (0.25 * (before.bulge + after.bulge));
                point.x = point.x.max(0.0);
            }
            Ring { point, normals }
        });
        Strand {
            rings: rings.collect(),
            closed: self.closed,
        }
    }

    /// The chord between two points, with the normals that are nearest to the contour's if they
    /// turn evenly along it: least squares of the angle over the length.
    fn chord(&self, a: usize, b: usize) -> Chord {
        let first = self.normals[a];
        let (mut length, mut moments, mut angle) = (0.0, [0.0; 2], 0.0);
        for k in a..b {
            if k > a {
                angle += self.normals[k - 1].angle_to(self.normals[k]);
            }
            let step = self.points[k].distance(self.points[k + 1]);
            moments[0] += angle * step;
            moments[1] += angle * step * (length + 0.5 * step);
            length += step;
        }
        let mean = moments[0] / length;
        let half_turn = 6.0 * (moments[1] / length - 0.5 * moments[0]) / length;
        Chord {
            normals: [mean - half_turn, mean + half_turn]
                .map(|angle| DVec2::from_angle(angle).rotate(first)),
            turn: 2.0 * half_turn,
            bulge: self.bulge(a, b),
        }
    }

    /// How far the contour lies outside the chord between two points; negative inside.
    fn bulge(&self, a: usize, b: usize) -> f64 {
        let (start, chord) = (self.points[a], self.points[b] - self.points[a]);
        let outward = -chord.perp().normalize_or_zero();
        let outside = self.points[a..b].iter().map(|p| (p - start).dot(outward));
        let farther = |most: f64, d: f64| if d.abs() > most.abs() { d } else { most };
        outside.fold(0.0, farther)
    }
}

/// Between two rings.
#[derive(Clone, Copy)]
struct Chord {
    /// At its beginning and its end.
    normals: [DVec2; 2],
    /// Between them, radians.
    turn: f64,
    bulge: f64,
}

/// The normals where two chords meet: one, if they are near enough for what the chords turn, and
/// each its own where a shared one would be wrong along all of a straight chord.
fn joined(before: Chord, after: Chord) -> [DVec2; 2] {
    let [m, n] = [before.normals[1], after.normals[0]];
    let turn = before.turn.abs() + after.turn.abs();
    if m.angle_to(n).abs() > SHARED.max(0.25 * turn).min(CREASE) {
        [m, n]
    } else {
        [(m + n).normalize_or(n); 2]
    }
}

/// The normal on the axis: along it where the surface is smooth there, else a cone's.
fn pole(normal: DVec2) -> DVec2 {
    if turns(normal, DVec2::new(-normal.x, normal.y)) {
        normal
    } else {
        DVec2::new(0.0, normal.y.signum())
    }
}

/// Whether point `k` is a corner: the contour turns there, and still does seen from [`AROUND`]. An
/// outline of a picture that is jagged by less than its pixels does not.
fn is_corner(points: &[DVec2], closed: bool, k: usize) -> bool {
    let n = points.len();
    let neighbour = |p: usize, forward: bool| match (closed, forward) {
        (true, true) => (p + 1) % n,
        (true, false) => (p + n - 1) % n,
        (false, true) => (p + 1).min(n - 1),
        (false, false) => p.saturating_sub(1),
    };
    let [back, ahead] = [false, true].map(|forward| neighbour(k, forward));
    if !turns(points[k] - points[back], points[ahead] - points[k]) {
        return false;
    }
    let far = |forward| {
        let (mut p, mut length) = (k, 0.0);
        for _ in 0..n {
            let next = neighbour(p, forward);
            length += points[p].distance(points[next]);
            p = next;
            if length >= AROUND || next == neighbour(next, forward) {
                break;
            }
        }
        points[p]
    };
    turns(points[k] - far(false), far(true) - points[k])
}

/// Whether two directions are a crease apart.
fn turns(a: DVec2, b: DVec2) -> bool {
    a.angle_to(b).abs() > CREASE
}
