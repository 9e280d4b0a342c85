//! How fine the mesh of a copy is: in a fixed number of quads, or within a tolerance on the screen.

use super::placed::eye_about_axis;
use super::tessellation::Mesh;
use glam::{DQuat, DVec2, DVec3};
use revmap::scene::{CameraFrame, Object, Placement};
use revmap::surface::{Chain, Contour};
use std::collections::BTreeMap;

/// How fine the mesh of a copy is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fineness {
    /// So many segments around the axis and at most so many rings along the outline.
    Quads {
        /// Steps around the axis.
        segments: u32,
        /// Most steps along the meridian; more if it has more corners.
        rings: u32,
    },
    /// Silhouettes within so many pixels, each copy by its size on the screen. Copies beside the
    /// picture are left out.
    Pixels(f64),
}

/// Levels in a factor of two of pixels per object unit.
const LEVELS: f64 = 2.0;
/// The finest level: 2^16 pixels per object unit. An eye nearer to a surface sees larger errors.
const FINEST: i32 = 32;

/// A contour, and its largest radius, least and largest `z`.
pub(super) type Shape<'a> = (&'a Contour, &'a [f64; 3]);

impl Fineness {
    /// The copies of an object by level.
    pub(super) fn by_level(
        self,
        object: &Object,
        shape: Shape,
        sight: &Sight,
    ) -> BTreeMap<i32, Vec<Placement>> {
        let mut all: BTreeMap<i32, Vec<Placement>> = BTreeMap::new();
        match self {
            _ if object.placements().is_empty() => {}
            Self::Quads { .. } => drop(all.insert(0, object.placements().to_vec())),
            Self::Pixels(_) => {
                for copy in object.placements() {
                    if let Some(pixels) = sight.pixels_per_unit(object, shape, copy) {
                        let level = (LEVELS * pixels.log2()).ceil() as i32;
                        all.entry(level.clamp(0, FINEST)).or_default().push(*copy);
                    }
                }
            }
        }
        all
    }

    /// The mesh of a level.
    pub(super) fn mesh(self, contour: &Contour, level: i32) -> Mesh {
        match self {
            Self::Quads { segments, rings } => Mesh::new(contour, segments, rings),
            Self::Pixels(tolerance) => {
                let pixels = (f64::from(level) / LEVELS).exp2();
                Mesh::within(contour, tolerance / pixels)
            }
        }
    }
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

impl Sight {
    pub fn new(camera: &CameraFrame, size: (u32, u32)) -> Self {
        let (w, h) = (f64::from(size.0), f64::from(size.1));
        let corners = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]];
        let corners = corners.map(|[x, y]| camera.direction(x, y));
        let middle = camera.direction(0.5 * w, 0.5 * h);
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

    /// The most pixels that an object unit of a copy's surface takes; `None` of a copy beside the
    /// picture or behind the eye.
    ///
    /// What lies across a ray at depth `z` is seen up to `sqrt(1 + t^2) / z` large, with the tangent
    /// `t` of the ray's angle to the view: pictures are stretched towards their corners. The
    /// distance along the ray is `z sqrt(1 + t^2)`.
    fn pixels_per_unit(
        &self,
        object: &Object,
        (contour, &[widest, low, high]): Shape,
        copy: &Placement,
    ) -> Option<f64> {
        let Placement {
            position, scale, ..
        } = *copy;
        let turn = copy.rotation.normalize();
        let [x, y] = object.axis_offset();
        let way = position + turn * (scale * DVec3::new(x, y, 0.5 * (low + high))) - self.eye;
        let half = DVec3::new(widest, widest, 0.5 * (high - low)) * scale;
        let depth = way.dot(self.forward);
        let outside = |side: &DVec3| side.dot(way) < -half.length();
        if depth < -half.length() || self.sides.iter().any(outside) {
            return None;
        }
        let forward = turn.conjugate() * self.forward;
        let round = (forward * half).truncate().length();
        let nearest = depth - round - (forward.z * half.z).abs();
        let largest = if nearest > 0.0 {
            let stretch = 1.0 + self.steepest(way, turn, half).powi(2);
            stretch.sqrt() / nearest
        } else {
            let eye = eye_about_axis(object, copy, self.eye);
            let place = DVec2::new(eye.truncate().length(), eye.z);
            let away = distance(contour, place) * scale.min_element();
            (1.0 + self.steepest.powi(2)) / away
        };
        Some(scale.max_element() * largest / self.pixel)
    }

    /// The largest tangent of an angle between the view and a ray of the picture to a box. It is
    /// largest at a corner, because the points of less than an angle are a cone.
    fn steepest(&self, way: DVec3, turn: DQuat, half: DVec3) -> f64 {
        let tangent = |k: u32| {
            let sign = |bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let corner = way + turn * (half * DVec3::new(sign(0), sign(1), sign(2)));
            let depth = corner.dot(self.forward);
            let aside = (corner - depth * self.forward).length();
            if depth > 0.0 {
                aside / depth
            } else {
                f64::INFINITY
            }
        };
        (0..8).map(tangent).fold(0.0, f64::max).min(self.steepest)
    }
}

/// The distance of a point of the half-plane from a contour.
fn distance(contour: &Contour, point: DVec2) -> f64 {
    let to_segment = |ends: &[DVec2]| {
        let (start, way) = (ends[0], ends[1] - ends[0]);
        let along = (point - start).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
        point.distance(start + along.clamp(0.0, 1.0) * way)
    };
    let of_chain = |chain: &Chain| {
        let ends = [chain.points.last(), chain.points.first()].map(|p| p.copied());
        let last = if let ([Some(a), Some(b)], true) = (ends, chain.closed) {
            to_segment(&[a, b])
        } else {
            f64::INFINITY
        };
        (chain.points.windows(2))
            .map(to_segment)
            .fold(last, f64::min)
    };
    (contour.chains.iter())
        .map(of_chain)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests;
