//! How far from its axis a map's solid reaches, at every height: where rays need not be looked at.
//!
//! What a search on the map can meet lies where the `d` that it reads is at most `w`. What it reads
//! changes by no more than 1.85 texels within half a texel beyond the outermost centres, where
//! cells are extrapolated, and by less elsewhere; the nearest point of the solid is less than a
//! texel's diagonal from a centre at which `d <= h`; and a cell's corner is as near to any of its
//! points. So all of it is nearer than `w` and 3.3 texels to such a centre, and in
//! [`Envelope::grown`] by `w` and [`SLACK`] texels. That holds of solids within the map; others
//! have no envelope.

use super::ShapeMap;
use glam::DVec2;

/// Bands of equal height over `0 <= z <= 1`: as many as beams ask.
pub(crate) const BANDS: usize = crate::shader::generated::BEAM_NODES as usize;

/// What is added to an offset, texels.
pub(crate) const SLACK: f64 = 4.0;

/// Ways in which supporting lines of the convex hull look, as parts of a right angle from the plane
/// `z = const` upwards; downwards too.
const WAYS: [f64; 3] = [0.25, 0.5, 0.75];

/// By how much the convex hull's level faces stand off, object units: those of a solid that its box
/// cuts lie in the box's own, and the rasteriser must not be the one to decide where these are.
/// With lavapipe's 256ths of a pixel no picture of `tests/gpu/hulls.rs` differs without it; devices
/// may have 16ths.
const OFF: f64 = 1e-3;

/// The largest radius of the solid in each of [`BANDS`] bands, object units; 0 where it has none.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Envelope {
    pub radii: Vec<f64>,
}

impl Envelope {
    /// Of the texels within one texel of the solid, their centres. None of a solid that lies partly
    /// outside of the map: what of it an offset lets in stands in no texel.
    pub fn of(map: &ShapeMap) -> Option<Self> {
        let (bounds, h) = (&map.bounds, map.texel());
        // Half a texel of roundings is within the slack.
        let [low, high, widest] = [-0.5 * h, 1.0 + 0.5 * h, map.reach() + 0.5 * h];
        if bounds.z_min < low || bounds.z_max > high || bounds.r_max > widest {
            return None;
        }
        let mut radii = vec![0.0f64; BANDS];
        let columns = map.columns as usize;
        for (j, row) in map.distance.chunks_exact(columns).enumerate() {
            let outermost = row.iter().rposition(|&d| f64::from(d) <= h);
            if let Some(i) = outermost {
                let z = 1.0 - (j as f64 + 0.5) * h;
                let band = ((z * BANDS as f64) as usize).min(BANDS - 1);
                radii[band] = radii[band].max((i as f64 + 0.5) * h);
            }
        }
        Some(Self { radii })
    }

    /// With all that is nearer than `by` (at least 0) to it.
    pub fn grown(&self, by: f64) -> Self {
        let bands = (by * BANDS as f64).ceil() as usize;
        let of = |k: usize| {
            let near = &self.radii[k.saturating_sub(bands)..(k + bands + 1).min(BANDS)];
            let most = near.iter().copied().fold(0.0, f64::max);
            if most > 0.0 { most + by } else { 0.0 }
        };
        Self {
            radii: (0..BANDS).map(of).collect(),
        }
    }

    /// A convex polygon `(r, z)` about it, counter-clockwise from the lower end on the axis to the
    /// upper; empty where it is empty.
    pub fn convex(&self) -> Vec<DVec2> {
        let edge = |k: usize| k as f64 / BANDS as f64;
        let solid = |r: &f64| *r > 0.0;
        let Some((first, last)) = Option::zip(
            self.radii.iter().position(solid),
            self.radii.iter().rposition(solid),
        ) else {
            return Vec::new();
        };
        let points: Vec<DVec2> = (first..=last)
            .flat_map(|k| [edge(k), edge(k + 1)].map(|z| DVec2::new(self.radii[k], z)))
            .collect();
        let most = points.iter().fold(0.0, |m: f64, p| m.max(p.x));
        let (low, high) = (edge(first) - OFF, edge(last + 1) + OFF);
        let mut polygon = vec![
            DVec2::new(0.0, low),
            DVec2::new(most, low),
            DVec2::new(most, high),
            DVec2::new(0.0, high),
        ];
        for part in WAYS {
            for up in [-1.0, 1.0] {
                let n = DVec2::from_angle(up * part * std::f64::consts::FRAC_PI_2);
                let reach = points.iter().fold(f64::MIN, |m, p| m.max(n.dot(*p)));
                polygon = cut_off(&polygon, n, reach);
            }
        }
        polygon
    }
}

/// What of a convex polygon has `n . p <= reach`.
fn cut_off(polygon: &[DVec2], n: DVec2, reach: f64) -> Vec<DVec2> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    let next = polygon.iter().cycle().skip(1);
    for (&a, &b) in polygon.iter().zip(next) {
        let (over_a, over_b) = (n.dot(a) - reach, n.dot(b) - reach);
        if over_a <= 0.0 {
            out.push(a);
        }
        if (over_a <= 0.0) != (over_b <= 0.0) {
            out.push(a.lerp(b, over_a / (over_a - over_b)));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::maps::{BakeOptions, MapSource};
    use crate::profile::Profile;
    use proptest::prelude::*;

    fn map(points: &[[f64; 2]], rows: u32, source: MapSource) -> ShapeMap {
        let profile = Profile::polygon(points, 0.5).unwrap();
        ShapeMap::bake(&profile, &BakeOptions::new(source, rows)).unwrap()
    }

    fn within(polygon: &[DVec2], p: DVec2) -> bool {
        polygon
            .iter()
            .zip(polygon.iter().cycle().skip(1))
            .all(|(&a, &b)| (b - a).perp_dot(p - a) >= -1e-12)
    }

    proptest! {
        /// Whatever a search can meet is in the grown envelope and in its convex hull, on fine maps
        /// and coarse ones, exact and binary.
        #[test]
        fn nothing_is_met_outside(
            r in 0.02..0.49f64, low in 0.0..0.5f64, thin in 0.02..0.5f64, notch in 0.0..0.3f64,
            w in -0.02..0.12f64, rows in prop::sample::select(vec![16u32, 64, 200]), binary: bool,
        ) {
            let high = low + thin;
            let points = [[0.0, low], [r, low], [notch.min(r), 0.5 * (low + high)], [r, high], [0.0, high]];
            let source = if binary { MapSource::Binary } else { MapSource::Exact };
            let profile = Profile::polygon(&points, 0.5).unwrap();
            // A thin shape may miss every texel of a coarse map: an error of its own.
            let Ok(map) = ShapeMap::bake(&profile, &BakeOptions::new(source, rows)) else { return Ok(()) };
            let grown = Envelope::of(&map).unwrap().grown(w.max(0.0) + SLACK * map.texel());
            let hull = grown.convex();
            for a in 0..120 {
                for b in 0..=240 {
                    let p = DVec2::new(f64::from(a) / 240.0, f64::from(b) / 240.0);
                    if p.x <= map.reach() && map.distance_at(p.x, p.y) <= w {
                        let band = ((p.y * BANDS as f64) as usize).min(BANDS - 1);
                        prop_assert!(grown.radii[band] >= p.x, "{p} {w}");
                        prop_assert!(within(&hull, p), "{p} {w} {hull:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_cones_hull_lies_close_to_it() {
        let map = map(&[[0.0, 0.0], [0.4, 0.0], [0.0, 0.8]], 512, MapSource::Exact);
        let hull = Envelope::of(&map).unwrap().grown(0.0).convex();
        let area: f64 = hull
            .iter()
            .zip(hull.iter().cycle().skip(1))
            .map(|(a, b)| 0.5 * a.perp_dot(*b))
            .sum();
        assert!((0.16..0.2).contains(&area), "{area}: the cone's is 0.16");
        assert_eq!((hull[0].x, hull[hull.len() - 1].x), (0.0, 0.0));
        assert!(hull[0].y < 0.0, "{hull:?}");
    }

    /// Its upper part would grow into the map.
    #[test]
    fn a_solid_outside_of_the_map_has_no_envelope() {
        for points in [
            [[0.0, -0.5], [0.4, -0.5], [0.0, -0.05]],
            [[0.0, 0.5], [0.4, 0.5], [0.0, 1.05]],
        ] {
            let map = map(&points, 64, MapSource::Exact);
            assert_eq!(Envelope::of(&map), None);
        }
    }

    #[test]
    fn of_nothing_there_is_no_hull() {
        let none = Envelope {
            radii: vec![0.0; BANDS],
        };
        assert!(none.grown(0.1).convex().is_empty());
    }
}
