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
            return Err(Error::new(
                ErrorKind::Content,
                "the profile has no surface to lay a texture along; draw a solid",
            ));
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
    #[must_use]
    pub fn table(&self, columns: u32, rows: u32) -> ArcTable {
        let side = f64::from(rows);
        let texels = for_each_texel(
            &self.segments,
            columns as usize,
            rows as usize,
            |i, j, _, k| {
                let p = DVec2::new(i as f64 + 0.5, side - (j as f64 + 0.5)) / side;
                (self.on_segment(k, p) * f64::from(u16::MAX)).round() as u16
            },
        );
        ArcTable {
            columns,
            rows,
            texels,
        }
    }

    fn on_segment(&self, k: usize, p: DVec2) -> f64 {
        let (Some(segment), Some(&[from, to])) = (self.segments.get(k), self.eta.get(k)) else {
            return 0.0;
        };
        from + (to - from) * segment.nearest(p).1
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

impl ArcTable {
    /// `eta` at `(r, z)` as a shader reads it; the border repeats beyond the table.
    #[must_use]
    pub fn eta_at(&self, r: f64, z: f64) -> f64 {
        let side = f64::from(self.rows);
        let (u, v) = (r.abs() * side - 0.5, (1.0 - z) * side - 0.5);
        let (x, y) = (u.floor(), v.floor());
        let texel = |i: f64, j: f64| {
            let i = (x + i).clamp(0.0, f64::from(self.columns - 1)) as usize;
            let j = (y + j).clamp(0.0, f64::from(self.rows - 1)) as usize;
            f64::from(self.texels[j * self.columns as usize + i]) / f64::from(u16::MAX)
        };
        let mut four = [
            texel(0.0, 0.0),
            texel(1.0, 0.0),
            texel(0.0, 1.0),
            texel(1.0, 1.0),
        ];
        let highest = four.iter().copied().fold(0.0, f64::max);
        for eta in &mut four {
            if highest - *eta > 0.5 {
                *eta += 1.0;
            }
        }
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let eta = mix(
            mix(four[0], four[1], u - x),
            mix(four[2], four[3], u - x),
            v - y,
        );
        if eta > 1.0 { eta - 1.0 } else { eta }
    }
}

/// The contour's chains, each in the direction in which `eta` grows.
fn chains(outline: &Outline) -> Vec<Vec<DVec2>> {
    let mut found = Vec::new();
    for points in &outline.loops {
        let n = points.len();
        let on_axis = |k: usize| points[k % n].x <= 0.0 && points[(k + 1) % n].x <= 0.0;
        match (0..n).find(|&k| on_axis(k)) {
            Some(axis) => {
                let mut chain = Vec::new();
                for k in axis + 1..=axis + n {
                    chain.push(points[k % n]);
                    if on_axis(k) {
                        if chain.len() > 1 {
                            found.push(upwards(std::mem::take(&mut chain)));
                        }
                        chain.clear();
                    }
                }
            }
            None => {
                let least = |&i: &usize, &j: &usize| {
                    points[i]
                        .x
                        .total_cmp(&points[j].x)
                        .then(points[i].y.total_cmp(&points[j].y))
                };
                let start = (0..n).min_by(least).unwrap_or(0);
                let mut ring: Vec<DVec2> = (start..=start + n).map(|k| points[k % n]).collect();
                let area: f64 = ring.windows(2).map(|w| w[0].perp_dot(w[1])).sum();
                if area < 0.0 {
                    // A cavity runs clockwise.
                    ring.reverse();
                }
                found.push(ring);
            }
        }
    }
    found
}

fn upwards(mut chain: Vec<DVec2>) -> Vec<DVec2> {
    if let (Some(first), Some(last)) = (chain.first(), chain.last())
        && first.y > last.y
    {
        chain.reverse();
    }
    chain
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

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
        let can = arc(&[
            [0.0, 0.1],
            [0.4, 0.1],
            [0.4, 0.9],
            [0.0, 0.9],
            [0.0, 0.8],
            [0.3, 0.8],
            [0.3, 0.2],
            [0.0, 0.2],
        ]);
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
        let ball: Vec<[f64; 2]> = (0..=180)
            .map(|k| (f64::from(k)).to_radians())
            .map(|a| [0.4 * a.sin(), 0.5 - 0.4 * a.cos()])
            .collect();
        let ring: Vec<[f64; 2]> = (0..360)
            .map(|k| (f64::from(k)).to_radians())
            .map(|a| [0.26 - 0.2 * a.cos(), 0.5 - 0.2 * a.sin()])
            .collect();
        for points in [ball, ring] {
            let exact = arc(&points);
            let table = exact.table(128, 256);
            for p in &points {
                let (got, wanted) = (table.eta_at(p[0], p[1]), exact.eta(p[0], p[1]));
                let round = (got - wanted).abs().min(1.0 - (got - wanted).abs());
                // Half a texel of 256 rows, of a contour 1.26 long.
                assert!(round < 0.5 / 256.0 / 1.25, "{got} for {wanted} at {p:?}");
            }
        }
    }
}
