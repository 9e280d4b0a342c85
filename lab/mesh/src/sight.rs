//! How large a copy's silhouettes are seen.

use glam::{DQuat, DVec2, DVec3};
use revmap::profile::Segment;
use revmap::scene::{CameraFrame, Object, Placement};
use revmap::surface::{Chain, Contour};

/// A contour, and its largest radius, least and largest `z`.
pub(super) type Shape<'a> = (&'a Contour, &'a [f64; 3]);

/// Of copies whose radius is below this part of their depth all points are as near.
const SMALL: f64 = 1.0 / 32.0;

/// The ball around a copy, and its largest scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub middle: DVec3,
    pub radius: f64,
    pub scale: f64,
    /// Whether the camera may see it.
    pub seen: bool,
}

/// What of a camera tells how large a copy is seen.
pub(super) struct Sight {
    eye: DVec3,
    forward: DVec3,
    /// Unit normals of the planes through the picture's sides, inwards.
    sides: [DVec3; 4],
    /// Of a pixel at depth 1.
    pixel: f64,
    /// The largest tangent of an angle between a ray and the view.
    steepest: f64,
}

/// A copy before a camera.
struct Seen<'a> {
    sight: &'a Sight,
    copy: &'a Placement,
    turn: DQuat,
    /// Of the box, object units.
    axis: DVec2,
    /// The eye about the axis, object units.
    eye: DVec3,
}

impl Sight {
    pub fn new(camera: &CameraFrame, size: (u32, u32)) -> Self {
        let corners = corners(camera, size);
        let middle = corners.iter().sum::<DVec3>();
        let side = |k: usize| {
            let normal = corners[k].cross(corners[(k + 1) % 4]).normalize();
            normal * normal.dot(middle).signum()
        };
        let steep = corners.map(|c| (c - camera.forward).length());
        Self {
            eye: camera.eye,
            forward: camera.forward,
            sides: [0, 1, 2, 3].map(side),
            pixel: camera.right.length(),
            steepest: steep.into_iter().fold(0.0, f64::max),
        }
    }

    pub fn ball(&self, object: &Object, &[widest, low, high]: &[f64; 3], copy: &Placement) -> Ball {
        let (turn, scale) = (copy.rotation.normalize(), copy.scale);
        let axis = DVec2::from(object.axis_offset());
        let middle = copy.position + turn * (scale * axis.extend(0.5 * (low + high)));
        let radius = (DVec3::new(widest, widest, 0.5 * (high - low)) * scale).length();
        let way = middle - self.eye;
        let outside = |side: &DVec3| side.dot(way) < -radius;
        Ball {
            middle,
            radius,
            scale: scale.max_element(),
            seen: way.dot(self.forward) >= -radius && !self.sides.iter().any(outside),
        }
    }

    /// The pixels that an object unit of a copy's silhouettes takes at most; `None` of a copy beside
    /// the picture or behind the eye.
    pub fn pixels_per_unit(
        &self,
        object: &Object,
        (contour, extent): Shape,
        copy: &Placement,
    ) -> Option<f64> {
        let (turn, scale) = (copy.rotation.normalize(), copy.scale);
        let axis = DVec2::from(object.axis_offset());
        let Ball {
            middle,
            radius,
            seen,
            ..
        } = self.ball(object, extent, copy);
        let way = middle - self.eye;
        let depth = way.dot(self.forward);
        if !seen {
            return None;
        }
        let seen = Seen {
            sight: self,
            copy,
            turn,
            axis,
            eye: eye_about_axis(object, copy, self.eye),
        };
        let small = radius < SMALL * depth;
        let of_contours = (!small).then(|| seen.of_contours(contour)).flatten();
        let largest = of_contours.unwrap_or_else(|| match depth > 2.0 * radius {
            true => (way.length() + radius) / (depth - radius).powi(2),
            false => {
                let nearest = distance(contour, &seen) * scale.min_element();
                (1.0 + self.steepest.powi(2)) / nearest
            }
        });
        Some(scale.max_element() * largest / self.pixel)
    }
}

impl Seen<'_> {
    /// How large a length is seen that lies across the ray at a point of the copy; `None` beside the
    /// picture. At depth `z` and distance `D` that is `D / z^2`: pictures are stretched towards
    /// their corners.
    fn at(&self, point: DVec3) -> Option<f64> {
        let place = self.turn * (self.copy.scale * (point + self.axis.extend(0.0)));
        let way = self.copy.position + place - self.sight.eye;
        let (depth, square) = (way.dot(self.sight.forward), way.length_squared());
        let most = 1.0 + self.sight.steepest.powi(2);
        (depth > 0.0 && square <= most * depth * depth).then(|| square.sqrt() / (depth * depth))
    }

    /// The largest of all points in the picture at which the surface turns from the eye: its
    /// silhouettes are there, hidden ones too. `None` if there are none.
    ///
    /// With the eye at `(e, 0, h)` and a normal `(n, m)` in the half-plane, the ring `(r, z)` is seen
    /// where `n (e cos - r) + m (h - z) > 0`, with the azimuth from the eye.
    fn of_contours(&self, contour: &Contour) -> Option<f64> {
        let beside = self.eye.truncate();
        let e = beside.length().max(1e-9);
        let towards = beside / e;
        let largest_at = |ring: DVec2, cos: f64| {
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let across = sin * towards.perp();
            let on = |side: DVec2| self.at((ring.x * (cos * towards + side)).extend(ring.y));
            [on(across), on(-across)]
                .into_iter()
                .flatten()
                .reduce(f64::max)
        };
        let of_ring = |ring: DVec2, normals: [DVec2; 2]| {
            let faces = normals.map(|n| n.x * (e - ring.x) + n.y * (self.eye.z - ring.y) > 0.0);
            let turns = normals.map(|n| (ring.x - n.y / n.x * (self.eye.z - ring.y)) / e);
            let front = (faces[0] != faces[1]).then_some(1.0);
            let all = turns
                .into_iter()
                .filter(|cos| cos.abs() <= 1.0)
                .chain(front);
            all.filter_map(|cos| largest_at(ring, cos)).reduce(f64::max)
        };
        let of_chain = |chain: &Chain| {
            let points = &chain.points;
            let count = points.len();
            // The outward normal of the segment behind a point, in any length.
            let normal = |k: usize| {
                let way = points[(k + 1) % count] - points[k % count];
                DVec2::new(way.y, -way.x)
            };
            let rings = if chain.closed {
                0..count
            } else {
                1..count.max(2) - 1
            };
            let all = rings.filter_map(|k| of_ring(points[k], [normal(k + count - 1), normal(k)]));
            all.reduce(f64::max)
        };
        contour.chains.iter().filter_map(of_chain).reduce(f64::max)
    }
}

/// The distance of the eye from a contour, object units.
fn distance(contour: &Contour, seen: &Seen) -> f64 {
    let point = DVec2::new(seen.eye.truncate().length(), seen.eye.z);
    let of_chain = |chain: &Chain| {
        let first = chain.points.first().filter(|_| chain.closed);
        let ends = chain.points.iter().skip(1).chain(first);
        let sides = chain.points.iter().zip(ends);
        let to = |(&a, &b)| point.distance(Segment { a, b }.nearest(point).0);
        sides.map(to).fold(f64::INFINITY, f64::min)
    };
    (contour.chains.iter())
        .map(of_chain)
        .fold(f64::INFINITY, f64::min)
}

/// Rays through the picture's corners, forward component 1.
pub(super) fn corners(camera: &CameraFrame, (width, height): (u32, u32)) -> [DVec3; 4] {
    let [w, h] = [f64::from(width), f64::from(height)];
    [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]].map(|[x, y]| camera.direction(x, y))
}

/// The eye in object space, about the axis.
pub(super) fn eye_about_axis(object: &Object, placement: &Placement, eye: DVec3) -> DVec3 {
    let [x, y] = object.axis_offset();
    let back = placement.rotation.normalize().conjugate();
    back * (eye - placement.position) / placement.scale - DVec3::new(x, y, 0.0)
}
