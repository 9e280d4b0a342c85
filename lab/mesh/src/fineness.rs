//! How fine the mesh of a copy is: in a fixed number of quads, or within a tolerance on the screen.

use super::placed::eye_about_axis;
use super::tessellation::Mesh;
use glam::{DVec2, DVec3};
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
    /// What lies across a ray at distance `D` is seen `1 / (D cos^2)` large, with the ray's angle to
    /// the view: the picture is stretched towards its corners.
    fn pixels_per_unit(
        &self,
        object: &Object,
        (contour, &[widest, low, high]): Shape,
        copy: &Placement,
    ) -> Option<f64> {
        let scale = copy.scale;
        let [x, y] = object.axis_offset();
        let middle = copy.rotation.normalize() * (scale * DVec3::new(x, y, 0.5 * (low + high)));
        let way = copy.position + middle - self.eye;
        let half = DVec3::new(widest, widest, 0.5 * (high - low));
        let radius = (half * scale).length();
        let depth = way.dot(self.forward);
        let outside = |side: &DVec3| side.dot(way) < -radius;
        if depth < -radius || self.sides.iter().any(outside) {
            return None;
        }
        let mut steep = self.steepest;
        if depth > radius {
            let aside = (way - depth * self.forward).length();
            steep = steep.min((aside + radius) / (depth - radius));
        }
        let eye = eye_about_axis(object, copy, self.eye);
        let seen = eye * scale;
        let beside = seen.truncate().length() - widest * scale.x.max(scale.y);
        let above = (low * scale.z - seen.z).max(seen.z - high * scale.z);
        let mut away = beside.max(0.0).hypot(above.max(0.0));
        if away == 0.0 {
            let place = DVec2::new(eye.truncate().length(), eye.z);
            away = distance(contour, place) * scale.min_element();
        }
        Some(scale.max_element() * (1.0 + steep * steep) / (away * self.pixel))
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
