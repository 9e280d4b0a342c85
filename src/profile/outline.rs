//! Queries of an [`Outline`]: bounds, inside, exact distances and gradients.

use super::Outline;
use glam::DVec2;

/// The rectangle of the half-plane that the solid occupies, object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest `r`.
    pub r_min: f64,
    /// Largest `r`.
    pub r_max: f64,
    /// Lowest `z`.
    pub z_min: f64,
    /// Highest `z`.
    pub z_max: f64,
}

impl Bounds {
    /// The smallest rectangle that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            r_min: self.r_min.min(other.r_min),
            r_max: self.r_max.max(other.r_max),
            z_min: self.z_min.min(other.z_min),
            z_max: self.z_max.max(other.z_max),
        }
    }
}

/// A straight piece of a boundary from `a` to `b`, with the solid on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The start, `(r, z)` in object units.
    pub a: DVec2,
    /// The end, `(r, z)` in object units.
    pub b: DVec2,
}

impl Segment {
    /// The point of the segment nearest to `p`, and its position between `a` (0) and `b` (1).
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> (DVec2, f64) {
        let along = self.b - self.a;
        let length2 = along.length_squared();
        let t = if length2 > 0.0 {
            ((p - self.a).dot(along) / length2).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (self.a + along * t, t)
    }
}

/// Area within a closed loop of points, negative if it runs clockwise.
#[must_use]
pub fn loop_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
}

impl Outline {
    /// All segments, including those along the axis.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.loops.iter().flat_map(|points| {
            let next = points.iter().cycle().skip(1);
            points.iter().zip(next).map(|(&a, &b)| Segment { a, b })
        })
    }

    /// The segments that are surface of the turned solid: all but those along the axis.
    pub fn surface_segments(&self) -> impl Iterator<Item = Segment> + '_ {
        self.segments().filter(|s| s.a.x > 0.0 || s.b.x > 0.0)
    }

    /// Enclosed area of the half-plane, without holes.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.loops.iter().map(|points| loop_area(points)).sum()
    }

    /// The rectangle that the solid occupies; `None` for an empty outline.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        let mut points = self.loops.iter().flatten();
        let &first = points.next()?;
        let (low, high) = points.fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        Some(Bounds {
            r_min: low.x,
            r_max: high.x,
            z_min: low.y,
            z_max: high.y,
        })
    }

    /// Returns true if `p = (r, z)` is solid: an odd number of crossings is to its right.
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        self.segments()
            .filter(|s| crossing(s, p.y).is_some_and(|r| r > p.x))
            .count()
            % 2
            == 1
    }

    /// The point of the solid's surface nearest to `p`; `None` when there is no surface.
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> Option<DVec2> {
        self.nearest_segment(p).map(|(_, nearest)| nearest)
    }

    /// The segment of the surface nearest to `p`, with its nearest point.
    fn nearest_segment(&self, p: DVec2) -> Option<(Segment, DVec2)> {
        let all = self.surface_segments().map(|s| (s, s.nearest(p).0));
        all.min_by(|(_, x), (_, y)| x.distance_squared(p).total_cmp(&y.distance_squared(p)))
    }

    /// Exact signed Euclidean distance of `p = (r, z)`, `r >= 0`, to the surface, object units,
    /// positive outside.
    ///
    /// The axis is not a boundary. The mirrored half is not searched: with `r >= 0` a point of the
    /// surface is never farther than its mirror image. `+inf` when there is no surface.
    #[must_use]
    pub fn signed_distance(&self, p: DVec2) -> f64 {
        let d = self.nearest(p).map_or(f64::INFINITY, |q| q.distance(p));
        if self.contains(p) { -d } else { d }
    }

    /// Unit gradient of the signed distance at `p`: away from the surface outside, towards it
    /// inside.
    ///
    /// For `p` on the surface the difference vanishes; the gradient is then the outward normal of
    /// that segment. `(0, 0)` when there is no surface.
    #[must_use]
    pub fn gradient(&self, p: DVec2) -> DVec2 {
        let Some((segment, nearest)) = self.nearest_segment(p) else {
            return DVec2::ZERO;
        };
        let away = p - nearest;
        // The direction of a shorter difference is rounding noise.
        if away.length_squared() < 1e-24 {
            return -(segment.b - segment.a).perp().normalize_or_zero();
        }
        let unit = away.normalize();
        if self.contains(p) { -unit } else { unit }
    }

    /// The radii at which a horizontal line crosses the boundary, ascending, for each height of
    /// `heights`. The line is inside between the first and the second, between the third and the
    /// fourth, and so on.
    #[must_use]
    pub fn crossings(&self, heights: impl ExactSizeIterator<Item = f64> + Clone) -> Vec<Vec<f64>> {
        let mut rows = vec![Vec::new(); heights.len()];
        let mut order: Vec<(f64, usize)> = heights.enumerate().map(|(i, z)| (z, i)).collect();
        order.sort_by(|x, y| x.0.total_cmp(&y.0));
        for s in self.segments() {
            let (low, high) = (s.a.y.min(s.b.y), s.a.y.max(s.b.y));
            let from = order.partition_point(|&(z, _)| z < low);
            for &(z, row) in order[from..].iter().take_while(|&&(z, _)| z < high) {
                if let Some(r) = crossing(&s, z) {
                    rows[row].push(r);
                }
            }
        }
        for row in &mut rows {
            row.sort_by(f64::total_cmp);
        }
        rows
    }
}

/// The radius at which a segment crosses the height `z`. The segment's lower end counts and its
/// upper end does not, so that a corner counts once.
fn crossing(s: &Segment, z: f64) -> Option<f64> {
    let (low, high) = if s.a.y <= s.b.y {
        (s.a, s.b)
    } else {
        (s.b, s.a)
    };
    (low.y <= z && z < high.y).then(|| low.x + (high.x - low.x) * ((z - low.y) / (high.y - low.y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    /// A cylinder of radius 0.4 between 0.2 and 0.8, with a cavity ring inside.
    fn cylinder() -> Outline {
        let v = DVec2::new;
        Outline {
            loops: vec![
                vec![v(0.0, 0.2), v(0.4, 0.2), v(0.4, 0.8), v(0.0, 0.8)],
                vec![v(0.2, 0.4), v(0.2, 0.6), v(0.3, 0.6), v(0.3, 0.4)],
            ],
        }
    }

    #[test]
    fn axis_is_no_boundary() {
        let o = cylinder();
        assert_eq!(o.segments().count(), 8);
        assert_eq!(o.surface_segments().count(), 7);
        // A point on the axis: the nearest surface is the cavity, not the axis segment.
        assert!((o.signed_distance(DVec2::new(0.0, 0.5)) + 0.2).abs() < 1e-15);
    }

    #[test]
    fn distances_signs_and_gradients() {
        let o = cylinder();
        let v = DVec2::new;
        let cases = [
            (v(0.5, 0.5), 0.1, v(1.0, 0.0)),
            (v(0.39, 0.5), -0.01, v(1.0, 0.0)),
            (
                v(0.5, 0.9),
                0.1 * 2f64.sqrt(),
                v(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
            ),
            (v(0.1, 0.21), -0.01, v(0.0, -1.0)),
            (v(0.21, 0.5), 0.01, v(1.0, 0.0)),
            (v(0.1, 0.9), 0.1, v(0.0, 1.0)),
        ];
        for (p, d, g) in cases {
            assert!((o.signed_distance(p) - d).abs() < 1e-12, "{p}");
            assert!((o.gradient(p) - g).length() < 1e-9, "{p}");
        }
        assert!((o.gradient(v(0.4, 0.5)) - v(1.0, 0.0)).length() < 1e-12);
        assert!((o.gradient(v(0.2, 0.5)) - v(1.0, 0.0)).length() < 1e-12);
    }

    #[test]
    fn area_bounds_and_crossings() {
        let o = cylinder();
        assert!((o.area() - (0.24 - 0.02)).abs() < 1e-12);
        assert_eq!(
            o.bounds(),
            Some(Bounds {
                r_min: 0.0,
                r_max: 0.4,
                z_min: 0.2,
                z_max: 0.8
            })
        );
        let rows = o.crossings([0.9, 0.5, 0.2].into_iter());
        assert_eq!(rows, vec![vec![], vec![0.0, 0.2, 0.3, 0.4], vec![0.0, 0.4]]);
    }
}
