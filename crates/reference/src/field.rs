//! Exact signed distance to an outline, in double precision.
//!
//! Unsigned distance: the nearest segment, found by a tree of rectangles. Sign: parity of the
//! segments crossed on the way to `r = +inf`, counted within one of many horizontal slabs. The
//! loops' direction and order therefore do not matter.

use glam::DVec2;
use revmap::profile::Outline;

/// Points closer to the axis than this are on it. A segment between two such points closes a loop
/// and is not part of the surface.
pub(super) const ON_AXIS: f64 = 1e-9;

/// A segment of the surface.
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

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec2,
    max: DVec2,
    /// In a leaf: the first segment. Otherwise: the right child (the left one follows its parent).
    next: u32,
    /// Number of segments; 0 for a node that is not a leaf.
    count: u32,
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
    nodes: Vec<Node>,
    slabs: Slabs,
}

/// Segments by height, for parity.
#[derive(Debug)]
struct Slabs {
    low: f64,
    per_unit: f64,
    /// `starts[k]..starts[k + 1]` are the indices in `members` of slab `k`.
    starts: Vec<u32>,
    members: Vec<u32>,
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
        let mut nodes = Vec::with_capacity(segments.len());
        build(&mut segments, 0, &mut nodes);
        let slabs = Slabs::new(&segments);
        let mut field = Self {
            segments,
            nodes,
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
        if self.inside(q) {
            -away.normalize()
        } else {
            away.normalize()
        }
    }

    /// The segment nearest to `q`.
    pub fn nearest(&self, q: DVec2, hint: u32) -> Nearest {
        let mut best = (self.segments[hint as usize].square_to(q), hint);
        let mut stack = [(0u32, 0f64); 64];
        stack[0] = (0, self.nodes[0].square_to(q));
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (index, bound) = stack[height];
            if bound >= best.0 {
                continue;
            }
            let node = self.nodes[index as usize];
            if node.count > 0 {
                for k in node.next..node.next + node.count {
                    let square = self.segments[k as usize].square_to(q);
                    if square < best.0 {
                        best = (square, k);
                    }
                }
                continue;
            }
            let mut children =
                [index + 1, node.next].map(|c| (c, self.nodes[c as usize].square_to(q)));
            // The nearer child is visited first: it goes on top.
            if children[0].1 < children[1].1 {
                children.swap(0, 1);
            }
            for child in children {
                if child.1 < best.0 && height < stack.len() {
                    stack[height] = child;
                    height += 1;
                }
            }
        }
        Nearest {
            segment: best.1,
            distance: best.0.sqrt(),
        }
    }
}

impl Segment {
    /// Square of the distance to `q`.
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

impl Node {
    fn square_to(&self, q: DVec2) -> f64 {
        (self.min - q)
            .max(q - self.max)
            .max(DVec2::ZERO)
            .length_squared()
    }
}

const LEAF: usize = 4;

/// Appends the tree over `segments`, which are sorted into its order; `first` is the index of the
/// slice in the whole.
fn build(segments: &mut [Segment], first: u32, nodes: &mut Vec<Node>) {
    let min = segments
        .iter()
        .fold(DVec2::INFINITY, |m, s| m.min(s.a).min(s.b));
    let max = segments
        .iter()
        .fold(DVec2::NEG_INFINITY, |m, s| m.max(s.a).max(s.b));
    let place = nodes.len();
    let leaf = segments.len() <= LEAF;
    nodes.push(Node {
        min,
        max,
        next: first,
        count: if leaf { segments.len() as u32 } else { 0 },
    });
    if leaf {
        return;
    }
    let axis = usize::from(max.y - min.y > max.x - min.x);
    let half = segments.len() / 2;
    segments.select_nth_unstable_by(half, |p, q| {
        (p.a[axis] + p.b[axis]).total_cmp(&(q.a[axis] + q.b[axis]))
    });
    let (left, right) = segments.split_at_mut(half);
    build(left, first, nodes);
    nodes[place].next = nodes.len() as u32;
    build(right, first + half as u32, nodes);
}

impl Slabs {
    fn new(segments: &[Segment]) -> Self {
        let low = segments
            .iter()
            .fold(f64::INFINITY, |m, s| m.min(s.a.y).min(s.b.y));
        let high = segments
            .iter()
            .fold(f64::NEG_INFINITY, |m, s| m.max(s.a.y).max(s.b.y));
        let count = segments.len().clamp(16, 8192);
        let per_unit = if high > low {
            count as f64 / (high - low)
        } else {
            0.0
        };
        let slab = |z: f64| (((z - low) * per_unit) as usize).min(count - 1);
        let range = |s: &Segment| slab(s.a.y.min(s.b.y))..=slab(s.a.y.max(s.b.y));
        let mut starts = vec![0u32; count + 1];
        for s in segments {
            for k in range(s) {
                starts[k + 1] += 1;
            }
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut fill = starts.clone();
        let mut members = vec![0; starts[count] as usize];
        for (index, s) in segments.iter().enumerate() {
            for k in range(s) {
                members[fill[k] as usize] = index as u32;
                fill[k] += 1;
            }
        }
        Self {
            low,
            per_unit,
            starts,
            members,
        }
    }

    /// Segments that may include the height `z`. Segments and points are placed with the same
    /// rounding, so none is missed.
    fn at(&self, z: f64) -> &[u32] {
        let place = (z - self.low) * self.per_unit;
        let count = self.starts.len() - 1;
        if place < 0.0 || place > count as f64 || place.is_nan() {
            return &[];
        }
        let k = (place as usize).min(count - 1);
        &self.members[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::samples;
    use proptest::prelude::*;

    fn brute(outline: &Outline, q: DVec2) -> f64 {
        let mut best = f64::INFINITY;
        let mut turns = 0.0;
        for points in &outline.loops {
            for (k, &a) in points.iter().enumerate() {
                let b = points[(k + 1) % points.len()];
                // Winding number by angles, independent of the tree and the slabs.
                turns += (a - q).perp_dot(b - q).atan2((a - q).dot(b - q));
                if a.x.max(b.x) > 0.0 {
                    let s = ((q - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    best = best.min(q.distance(a + (b - a) * s));
                }
            }
        }
        if turns.abs() > 3.0 { -best } else { best }
    }

    proptest! {
        #[test]
        fn distances_are_those_of_brute_force(seed in 0u64..2000, r in 0.0..1.2f64, z in -0.3..1.3f64) {
            let outline = samples::random(seed);
            let field = Field::new(&outline).unwrap();
            let q = DVec2::new(r, z);
            let (expected, mut hint) = (brute(&outline, q), 0);
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
            let f = |q: DVec2| brute(&outline, q);
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
