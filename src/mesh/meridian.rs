//! A contour's chains, thinned to rings.

use crate::pieces::{Chain, Contour};
use glam::DVec2;

/// A ring of vertices, seen in the half-plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ring {
    pub point: DVec2,
    /// Unit outward normals of the surface before it and after it; equal where there is no crease.
    pub normals: [DVec2; 2],
}

/// The rings of one chain; a closed one ends with the ring that it begins with.
#[derive(Clone, Debug, Default)]
pub(super) struct Strand {
    pub rings: Vec<Ring>,
    pub closed: bool,
}

/// Joints that turn more are creases: twice what a circle of 48 corners turns at each.
const CREASE: f64 = 15.0 * std::f64::consts::PI / 180.0;
/// The least and the largest tolerance, object units: points nearer to a line are on it, and what is farther is another shape.
const TOLERANCES: [f64; 2] = [1e-8, 0.05];

/// All chains, in at most `most` chords together if corners allow.
pub(super) fn meridian(contour: &Contour, most: usize) -> Vec<Strand> {
    let lines: Vec<Line> = contour.chains.iter().filter_map(Line::new).collect();
    let count =
        |tolerance: f64| -> usize { lines.iter().map(|l| l.thinned(tolerance).len() - 1).sum() };
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

/// A chain from its first point to its last; a closed one begins, and ends, at a crease if it has any.
struct Line {
    points: Vec<DVec2>,
    /// Outward normals of the segments: segment `k` runs from point `k` on.
    normals: Vec<DVec2>,
    /// First and last point, and creases between.
    fixed: Vec<usize>,
    closed: bool,
}

impl Line {
    fn new(chain: &Chain) -> Option<Self> {
        let mut points = chain.points.clone();
        points.dedup();
        if chain.closed {
            let n = points.len();
            let way = |k: usize| points[(k + 1) % n] - points[k % n];
            let corner = (0..n).find(|&k| turns(way(k + n - 1), way(k)));
            points.rotate_left(corner.unwrap_or(0));
            let first = *points.first()?;
            points.push(first);
        } else {
            points.first_mut()?.x = 0.0;
            points.last_mut()?.x = 0.0;
        }
        if points.len() < 3 {
            return None;
        }
        let normals: Vec<DVec2> = points
            .windows(2)
            .map(|p| -(p[1] - p[0]).perp().normalize_or_zero())
            .collect();
        let last = points.len() - 1;
        let mut fixed = vec![0];
        fixed.extend((1..last).filter(|&k| turns(normals[k - 1], normals[k])));
        fixed.push(last);
        Some(Self {
            points,
            normals,
            fixed,
            closed: chain.closed,
        })
    }

    /// The points that stay: between those that are fixed, chords as long as the tolerance allows.
    fn thinned(&self, tolerance: f64) -> Vec<usize> {
        let mut kept = vec![0];
        for ends in self.fixed.windows(2) {
            let mut at = ends[0];
            while at < ends[1] {
                at = self.reach(at, ends[1], tolerance);
                kept.push(at);
            }
        }
        kept
    }

    /// The farthest point up to `end` such that all between lie within the tolerance of the line to it: the directions that
    /// meet the discs about all points so far are an interval (Imai and Iri).
    fn reach(&self, from: usize, end: usize, tolerance: f64) -> usize {
        let start = self.points[from];
        let ahead = self.points[from + 1] - start;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut found = from + 1;
        for k in from + 1..=end {
            // A chord does not turn back.
            if (self.points[k] - self.points[k - 1]).dot(ahead) < 0.0 {
                break;
            }
            let way = self.points[k] - start;
            let angle = ahead.angle_to(way);
            if (low..=high).contains(&angle) {
                found = k;
            }
            let far = way.length();
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
        let kept = self.thinned(tolerance);
        let bulges: Vec<f64> = kept.windows(2).map(|k| self.bulge(k[0], k[1])).collect();
        let last = kept.len() - 1;
        let rings = kept.iter().enumerate().map(|(n, &k)| {
            let normals = self.normals_at(k);
            let mut point = self.points[k];
            if self.fixed.binary_search(&k).is_err() && n > 0 && n < last {
                point += normals[0] * (0.25 * (bulges[n - 1] + bulges[n]));
                point.x = point.x.max(0.0);
            }
            Ring { point, normals }
        });
        Strand {
            rings: rings.collect(),
            closed: self.closed,
        }
    }

    /// How far the contour lies outside the chord between two of its points, at most; negative inside.
    fn bulge(&self, a: usize, b: usize) -> f64 {
        let (start, chord) = (self.points[a], self.points[b] - self.points[a]);
        let outward = -chord.perp().normalize_or_zero();
        self.points[a..b]
            .iter()
            .map(|p| (p - start).dot(outward))
            .fold(
                0.0,
                |most, d| if d.abs() > f64::abs(most) { d } else { most },
            )
    }

    fn normals_at(&self, k: usize) -> [DVec2; 2] {
        let last = self.points.len() - 1;
        let (before, after) = match k {
            0 if self.closed => (last - 1, 0),
            _ if k == last && self.closed => (last - 1, 0),
            0 => return [self.pole(0); 2],
            _ if k == last => return [self.pole(last - 1); 2],
            _ => (k - 1, k),
        };
        let [m, n] = [self.normals[before], self.normals[after]];
        if turns(m, n) {
            return [m, n];
        }
        // The nearer neighbour's direction tells more of the tangent.
        let length = |k: usize| self.points[k].distance(self.points[k + 1]);
        let smooth = (m * length(after) + n * length(before)).normalize_or(n);
        [smooth; 2]
    }

    /// On the axis, where segment `k` ends: along it where the surface is smooth, else a cone's.
    fn pole(&self, k: usize) -> DVec2 {
        let n = self.normals[k];
        if turns(n, DVec2::new(-n.x, n.y)) {
            n
        } else {
            DVec2::new(0.0, n.y.signum())
        }
    }
}

/// Whether two directions are a crease apart.
fn turns(a: DVec2, b: DVec2) -> bool {
    a.angle_to(b).abs() > CREASE
}
