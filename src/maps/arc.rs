//! Length along the profile for the projection `arc`: textures that are spread evenly neither by
//! height nor by angle.

use super::nearest::for_each_texel;
use crate::error::{Error, ErrorKind, Result};
use crate::profile::{Outline, Profile, Segment};
use glam::DVec2;

/// `eta`, the length along the solid's contour as a fraction of the whole, at every point of its
/// surface.
///
/// The contour consists of chains: from axis to axis (the outside of a vase, the inside of a closed
/// bottle), or closed (a ring). `eta` runs from 0 to 1 along each chain. A chain from axis to axis
/// starts at its lower end, so that `eta = 1` is the top. A closed chain starts and ends at its
/// least `r`, the side turned to the axis, and rises on its outer side.
///
/// A point off the surface has the `eta` of the nearest surface point; extended and beveled
/// surfaces use this value.
#[derive(Clone, Debug)]
pub struct ArcLength {
    segments: Vec<Segment>,
    /// `eta` at both ends of each segment.
    eta: Vec<[f64; 2]>,
}

/// `eta` on the grid of a shape map, ready for a texture: `R16_UNORM`, row 0 on top.
///
/// A shader reads the four texels around `(r, z)` and interpolates them bilinearly. If two of the
/// four differ by more than one half, the seam of a closed chain is between them: add 1 to the
/// smaller ones before the interpolation, and take the fraction after it. Errors are those of
/// bilinear interpolation, at most half a texel of length. Walls thinner than two texels are an
/// exception, since their two sides mix.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcTable {
    /// Texels along `r`.
    pub columns: u32,
    /// Texels along `z`.
    pub rows: u32,
    /// `eta * 65535`, row by row from the top.
    pub texels: Vec<u16>,
}

impl ArcLength {
    /// Measures a profile's contour.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: the profile has no surface.
    pub fn new(profile: &Profile) -> Result<Self> {
        let mut this = Self {
            segments: Vec::new(),
            eta: Vec::new(),
        };
        for chain in chains(&profile.outline) {
            this.add(&chain);
        }
        if this.segments.is_empty() {
            let message = "the profile has no surface to lay a texture along; draw a solid";
            return Err(Error::new(ErrorKind::Content, message));
        }
        Ok(this)
    }

    /// Length of the longest chain, object units.
    #[must_use]
    pub fn total(&self) -> f64 {
        let whole = |(s, [from, to]): (&Segment, &[f64; 2])| s.a.distance(s.b) / (to - from);
        let lengths = self.segments.iter().zip(&self.eta).map(whole);
        lengths.filter(|l| l.is_finite()).fold(0.0, f64::max)
    }

    /// `eta` at the point of the contour that is nearest to `(r, z)`, in `[0, 1]`.
    #[must_use]
    pub fn eta(&self, r: f64, z: f64) -> f64 {
        let p = DVec2::new(r.abs(), z);
        let distance = |s: &Segment| s.nearest(p).0.distance_squared(p);
        let nearest = (0..self.segments.len())
            .min_by(|&i, &j| distance(&self.segments[i]).total_cmp(&distance(&self.segments[j])));
        nearest.map_or(0.0, |k| self.on_segment(k, p))
    }

    /// The table for a map of `columns x rows` texels.
    ///
    /// # Errors
    /// [`ErrorKind::OutOfHostMemory`].
    pub fn table(&self, columns: u32, rows: u32) -> Result<ArcTable> {
        let (side, size) = (f64::from(rows), [columns, rows].map(|n| n as usize));
        let texels = for_each_texel(&self.segments, size, |i, j, _, k| {
            let p = DVec2::new(i as f64 + 0.5, side - (j as f64 + 0.5)) / side;
            (self.on_segment(k, p) * f64::from(u16::MAX)).round() as u16
        })?;
        Ok(ArcTable {
            columns,
            rows,
            texels,
        })
    }

    fn on_segment(&self, k: usize, p: DVec2) -> f64 {
        let [from, to] = self.eta[k];
        from + (to - from) * self.segments[k].nearest(p).1
    }

    fn add(&mut self, chain: &[DVec2]) {
        let total: f64 = chain.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut length = 0.0;
        for w in chain.windows(2) {
            let from = length / total;
            length += w[0].distance(w[1]);
            self.segments.push(Segment { a: w[0], b: w[1] });
            self.eta.push([from, length / total]);
        }
    }
}

/// The contour's chains, each in the direction in which `eta` grows.
fn chains(outline: &Outline) -> Vec<Vec<DVec2>> {
    let mut found = Vec::new();
    for points in &outline.loops {
        let n = points.len();
        let from = |start: usize| points.iter().cycle().skip(start).copied();
        let on_axis = |a: DVec2, b: DVec2| a.x <= 0.0 && b.x <= 0.0;
        if let Some(axis) = (0..n).find(|&k| on_axis(points[k], points[(k + 1) % n])) {
            // Edges on the axis are no part of the surface.
            let ring: Vec<DVec2> = from(axis + 1).take(n).collect();
            let chains = ring.chunk_by(|a, b| !on_axis(*a, *b));
            for mut chain in chains.filter(|c| c.len() > 1).map(<[DVec2]>::to_vec) {
                if chain[0].y > chain[chain.len() - 1].y {
                    chain.reverse();
                }
                found.push(chain);
            }
            continue;
        }
        let least = |&i: &usize, &j: &usize| {
            let [a, b] = [points[i], points[j]];
            a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
        };
        let start = (0..n).min_by(least).unwrap_or(0);
        let mut ring: Vec<DVec2> = from(start).take(n + 1).collect();
        let area: f64 = ring.windows(2).map(|w| w[0].perp_dot(w[1])).sum();
        if area < 0.0 {
            // A cavity runs clockwise.
            ring.reverse();
        }
        found.push(ring);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(arc: &ArcLength, p: DVec2) -> f64 {
        let distances = arc.segments.iter().map(|s| s.nearest(p).0.distance(p));
        distances.fold(f64::INFINITY, f64::min)
    }

    fn arc(points: &[[f64; 2]]) -> ArcLength {
        ArcLength::new(&Profile::polygon(points, 0.5).unwrap()).unwrap()
    }

    #[track_caller]
    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9, "{a} for {b}");
    }

    #[test]
    fn a_cylinder_is_unrolled_from_bottom_to_top() {
        // Bottom 0.3, side 0.4, top 0.3.
        for turned in [false, true] {
            let mut points = vec![[0.0, 0.2], [0.3, 0.2], [0.3, 0.6], [0.0, 0.6]];
            if turned {
                points.reverse();
            }
            let a = arc(&points);
            near(a.eta(0.0, 0.2), 0.0);
            near(a.eta(0.15, 0.2), 0.15);
            near(a.eta(0.3, 0.4), 0.5);
            near(a.eta(0.4, 0.4), 0.5);
            near(a.eta(0.15, 0.6), 0.85);
            near(a.eta(0.0, 0.7), 1.0);
        }
    }

    #[test]
    fn a_cavity_on_the_axis_runs_upwards_too() {
        // A hollow can: outside 0.1..0.9, inside 0.2..0.8, joined nowhere.
        let outside = [[0.0, 0.1], [0.4, 0.1], [0.4, 0.9], [0.0, 0.9]];
        let inside = [[0.0, 0.8], [0.3, 0.8], [0.3, 0.2], [0.0, 0.2]];
        let can = arc(&[outside, inside].concat());
        assert!(can.eta(0.3, 0.3) < 0.5 && can.eta(0.3, 0.7) > 0.5);
        assert!(can.eta(0.4, 0.3) < 0.5 && can.eta(0.4, 0.7) > 0.5);
    }

    #[test]
    fn a_ring_starts_towards_the_axis_and_rises_outside() {
        let ring = arc(&[[0.2, 0.4], [0.4, 0.4], [0.4, 0.6], [0.2, 0.6]]);
        near(ring.eta(0.3, 0.4), 0.125);
        near(ring.eta(0.4, 0.5), 0.375);
        near(ring.eta(0.3, 0.6), 0.625);
        near(ring.eta(0.2, 0.5), 0.875);
    }

    #[test]
    fn the_table_says_what_the_contour_says() {
        let circle = |r: f64, radius: f64, degrees: std::ops::Range<u16>| -> Vec<[f64; 2]> {
            let point = |a: f64| [r + radius * a.sin(), 0.5 - radius * a.cos()];
            degrees.map(|a| point(f64::from(a).to_radians())).collect()
        };
        let (ball, ring) = (circle(0.0, 0.4, 0..181), circle(0.26, 0.2, 0..360));
        for points in [ball, ring] {
            let exact = arc(&points);
            let table = exact.table(64, 128).unwrap();
            for (k, &texel) in table.texels.iter().enumerate() {
                let p = DVec2::new((k % 64) as f64 + 0.5, 127.5 - (k / 64) as f64) / 128.0;
                let (found, wanted) = (f64::from(texel) / 65535.0, exact.eta(p.x, p.y));
                // Texels at the same distance from two segments may have the value of either.
                let distance = |s: &Segment| s.nearest(p).0.distance(p);
                let at = |s: &&Segment| (distance(s) - nearest(&exact, p)).abs() < 1e-9;
                let ties = exact.segments.iter().filter(at).count();
                assert!(
                    (found - wanted).abs() < 1e-5 || ties > 1,
                    "{found} for {wanted} at {p}"
                );
            }
        }
    }
}
