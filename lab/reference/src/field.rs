//! Exact signed distance to an outline, in double precision.
//!
//! Unsigned distance: the nearest segment, found by a tree of rectangles. Sign: parity of the
//! segments crossed on the way to `r = +inf`, counted within one of many horizontal slabs. The
//! loops' direction and order therefore do not matter.

use super::tree::{Bounds, Tree};
use glam::{DVec2, DVec3};
use revmap::profile::Outline;

/// Points closer to the axis than this are on it. A segment between two such points closes a loop
/// and is not part of the surface.
pub(super) const ON_AXIS: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
struct Segment {
    a: DVec2,
    b: DVec2,
    /// Unit normal, towards the empty side.
    normal: DVec2,
    /// `(b - a) / |b - a|^2`: its product with `q - a` is the position of the foot of the
    /// perpendicular on the segment, 0 to 1.
    along: DVec2,
}

/// The segment nearest to a point of the half-plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Index of a nearest segment.
    pub segment: u32,
    /// Distance, not negative.
    pub distance: f64,
}

/// The signed distance `d(r, z)`: negative inside the solid.
#[derive(Debug)]
pub(super) struct Field {
    segments: Vec<Segment>,
    tree: Tree,
    slabs: Slabs,
}

/// Segments by height, for parity.
#[derive(Debug)]
struct Slabs {
    low: f64,
    per_unit: f64,
    /// The indices of the segments in each slab, from below.
    members: Vec<Vec<u32>>,
}

impl Field {
    /// Prepares an outline; `None` if no part of it is off the axis or a point is not finite.
    pub fn new(outline: &Outline) -> Option<Self> {
        let mut segments = Vec::new();
        for points in &outline.loops {
            for (k, &a) in points.iter().enumerate() {
                let b = points[(k + 1) % points.len()];
                if !a.is_finite() {
                    return None;
                }
                let length = a.distance(b);
                if length > 0.0 && a.x.max(b.x) > ON_AXIS {
                    let along = (b - a) / (length * length);
                    let normal = DVec2::new(b.y - a.y, a.x - b.x) / length;
                    segments.push(Segment {
                        a,
                        b,
                        normal,
                        along,
                    });
                }
            }
        }
        if segments.is_empty() {
            return None;
        }
        let tree = Tree::new(&mut segments, 4, |s| Bounds {
            min: s.a.min(s.b).extend(0.0),
            max: s.a.max(s.b).extend(0.0),
        });
        let slabs = Slabs::new(&segments);
        let mut field = Self {
            segments,
            tree,
            slabs,
        };
        field.turn_normals_outwards();
        Some(field)
    }

    /// The caller's loops should run with the solid on the left. Parity works for both directions,
    /// and so must the normals.
    fn turn_normals_outwards(&mut self) {
        for k in 0..self.segments.len() {
            let s = self.segments[k];
            let step = s.normal * (s.a.distance(s.b) * 1e-6).min(1e-7);
            let middle = (s.a + s.b) * 0.5;
            let (ahead, behind) = (self.inside(middle + step), self.inside(middle - step));
            if ahead && !behind {
                self.segments[k].normal = -s.normal;
            }
        }
    }

    /// Returns true if `q` is in the solid.
    pub fn inside(&self, q: DVec2) -> bool {
        let mut parity = false;
        for &k in self.slabs.at(q.y) {
            let Segment { a, b, .. } = self.segments[k as usize];
            if (a.y <= q.y) != (b.y <= q.y) {
                let r = a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x);
                parity ^= r > q.x;
            }
        }
        parity
    }

    /// Signed distance at `q`. A `hint` (a segment that was nearest to a point close by) changes
    /// only the speed, never the result.
    pub fn distance(&self, q: DVec2, hint: &mut u32) -> f64 {
        let nearest = self.nearest(q, *hint);
        *hint = nearest.segment;
        if self.inside(q) {
            -nearest.distance
        } else {
            nearest.distance
        }
    }

    /// Unit gradient of the signed distance at `q`, given the nearest segment.
    pub fn gradient(&self, q: DVec2, nearest: Nearest) -> DVec2 {
        let s = self.segments[nearest.segment as usize];
        let place = (q - s.a).dot(s.along);
        if (0.0..=1.0).contains(&place) {
            return s.normal;
        }
        let away = q - if place < 0.0 { s.a } else { s.b };
        // Every direction between the two normals is valid at a corner itself.
        if nearest.distance < 1e-12 {
            return s.normal;
        }
        let outwards = if self.inside(q) { -1.0 } else { 1.0 };
        outwards * away.normalize()
    }

    pub fn nearest(&self, q: DVec2, hint: u32) -> Nearest {
        let mut best = (self.segments[hint as usize].square_to(q), hint);
        let point = q.extend(0.0);
        let least = |bounds: &Bounds| {
            let outside = (bounds.min - point).max(point - bounds.max);
            outside.max(DVec3::ZERO).length_squared()
        };
        self.tree.search(best.0, least, |k| {
            let square = self.segments[k].square_to(q);
            if square < best.0 {
                best = (square, k as u32);
            }
            square
        });
        Nearest {
            segment: best.1,
            distance: best.0.sqrt(),
        }
    }
}

impl Segment {
    fn square_to(&self, q: DVec2) -> f64 {
        let from_a = q - self.a;
        let place = from_a.dot(self.along);
        if place <= 0.0 {
            from_a.length_squared()
        } else if place >= 1.0 {
            q.distance_squared(self.b)
        } else {
            // Distance along the normal: exact to the last bits even for tiny distances.
            let d = from_a.dot(self.normal);
            d * d
        }
    }
}

impl Slabs {
    fn new(segments: &[Segment]) -> Self {
        let heights = || segments.iter().flat_map(|s| [s.a.y, s.b.y]);
        let low = heights().fold(f64::INFINITY, f64::min);
        let high = heights().fold(f64::NEG_INFINITY, f64::max);
        let count = segments.len().clamp(16, 8192);
        let per_unit = if high > low {
            count as f64 / (high - low)
        } else {
            0.0
        };
        let slab = |z: f64| (((z - low) * per_unit) as usize).min(count - 1);
        let range = |s: &Segment| slab(s.a.y.min(s.b.y))..=slab(s.a.y.max(s.b.y));
        let mut members = vec![Vec::new(); count];
        for (index, s) in segments.iter().enumerate() {
            for slab in &mut members[range(s)] {
                slab.push(index as u32);
            }
        }
        Self {
            low,
            per_unit,
            members,
        }
    }

    /// Segments that may include the height `z`. Segments and points are placed with the same
    /// rounding, so none is missed.
    fn at(&self, z: f64) -> &[u32] {
        let place = (z - self.low) * self.per_unit;
        let count = self.members.len();
        if place < 0.0 || place > count as f64 || place.is_nan() {
            return &[];
        }
        &self.members[(place as usize).min(count - 1)]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::samples;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn distances_are_those_of_brute_force(seed in 0u64..2000, r in 0.0..1.2f64, z in -0.3..1.3f64) {
            let outline = samples::random(seed);
            let field = Field::new(&outline).unwrap();
            let q = DVec2::new(r, z);
            let (expected, mut hint) = (outline.signed_distance(q), 0);
            let found = field.distance(q, &mut hint);
            prop_assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            // A hint changes nothing.
            let mut other = (field.segments.len() - 1) as u32;
            prop_assert_eq!(field.distance(q, &mut other).to_bits(), found.to_bits());
        }

        #[test]
        fn gradients_are_those_of_differences(seed in 0u64..500, r in 0.05..1.0f64, z in -0.2..1.2f64) {
            let outline = samples::random(seed);
            let field = Field::new(&outline).unwrap();
            let q = DVec2::new(r, z);
            let f = |q: DVec2| outline.signed_distance(q);
            let h = 1e-6;
            let numeric = DVec2::new(f(q + DVec2::X * h) - f(q - DVec2::X * h), f(q + DVec2::Y * h) - f(q - DVec2::Y * h)) / (2.0 * h);
            // The difference quotient is not a unit vector on ridges of the distance.
            prop_assume!((numeric.length() - 1.0).abs() < 1e-6);
            let g = field.gradient(q, field.nearest(q, 0));
            prop_assert!((g - numeric).length() < 1e-4, "{g} {numeric}");
        }
    }

    #[test]
    fn direction_of_loops_does_not_matter() {
        let outline = samples::torus();
        let mut turned = outline.clone();
        turned.loops.iter_mut().for_each(|l| l.reverse());
        let (a, b) = (Field::new(&outline).unwrap(), Field::new(&turned).unwrap());
        for k in 0..200 {
            let q = DVec2::new(f64::from(k) * 0.003, 0.3 + f64::from(k % 17) * 0.03);
            assert!((a.distance(q, &mut 0) - b.distance(q, &mut 0)).abs() < 1e-15);
            let (ga, gb) = (
                a.gradient(q, a.nearest(q, 0)),
                b.gradient(q, b.nearest(q, 0)),
            );
            assert!((ga - gb).length() < 1e-9, "{q}: {ga} {gb}");
        }
    }

    #[test]
    fn the_axis_is_no_boundary() {
        let field = Field::new(&samples::cylinder(0.25, 0.0, 1.0)).unwrap();
        assert!((field.distance(DVec2::new(0.0, 0.5), &mut 0) + 0.25).abs() < 1e-15);
        assert!(
            Field::new(&Outline {
                loops: vec![vec![DVec2::ZERO, DVec2::Y]]
            })
            .is_none()
        );
        assert!(Field::new(&Outline::default()).is_none());
    }
}
