//! The second method: all points at which a ray can enter or leave a solid, by formula.
//!
//! `F = d - w` vanishes only where the nearest part of the outline, a segment's line or a corner,
//! is at distance `|w|`. `w` is linear in `z` (in two pieces with a chamfer), so a segment gives
//! `alpha r + beta z = gamma`, a frustum of a cone: a quadratic in `t`. A corner gives
//! `(r - pr)^2 + (z - pz)^2 = w^2`, a conic turned about the axis: a quartic. All roots, sorted,
//! cut the ray into pieces on each of which `F` keeps its sign. The sign in the middle of each
//! piece distinguishes inside from outside. Roots that belong to no surface do no harm. This method
//! shares only the input and output types with the bracketing method.
//!
//! The time grows with the square of the number of segments, and replicas are not supported: this
//! method exists to check the other.

mod path;
mod roots;

use super::{Hit, Ray, Surface, Trace, is_ray};
use glam::{DAffine3, DVec2, DVec3};
use path::{Curve, Path};
use revmap::error::{Error, ErrorKind, Result};
use revmap::profile::Outline;
use revmap::scene::{Growth, Object, Offset, Scene};

/// Pieces of a ray shorter than this, in object units, mark it as grazing.
const SLIVER: f64 = 1e-7;

/// A scene prepared for the analytic method.
#[derive(Debug)]
pub struct Analytic {
    parts: Vec<Part>,
}

#[derive(Debug)]
struct Part {
    object: usize,
    instance: usize,
    world: DAffine3,
    solid: Solid,
}

#[derive(Clone, Debug)]
struct Solid {
    outline: Outline,
    radius: f64,
    growth: Growth,
    axis: DVec2,
    /// `w = start + slope z` of each piece.
    pieces: Vec<(f64, f64)>,
    offset: Offset,
}

impl Analytic {
    /// Prepares a scene.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for content that this method does not support: replicas, and profiles
    /// that are images.
    pub fn new(scene: &Scene) -> Result<Self> {
        let mut parts = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let solid = Solid::new(object).map_err(|e| e.at_key(format!("object.{index}")))?;
            for (instance, p) in object.placements().iter().enumerate() {
                let world =
                    DAffine3::from_scale_rotation_translation(p.scale, p.rotation, p.position);
                parts.push(Part {
                    object: index,
                    instance,
                    world,
                    solid: solid.clone(),
                });
            }
        }
        Ok(Self { parts })
    }

    /// The first hit along a ray.
    #[must_use]
    pub fn trace(&self, ray: Ray) -> Trace {
        let mut best = Trace::default();
        for part in &self.parts {
            let inverse = part.world.inverse();
            let local = Ray {
                origin: inverse.transform_point3(ray.origin),
                direction: inverse.transform_vector3(ray.direction),
            };
            let mut found = part.solid.trace(local);
            best.grazes |= found.grazes;
            best.evaluations += found.evaluations;
            if let Some(hit) = &mut found.hit
                && best.hit.is_none_or(|b| hit.t < b.t)
            {
                hit.normal = (inverse.matrix3.transpose() * hit.normal).normalize_or_zero();
                (hit.object, hit.instance) = (part.object, part.instance);
                best.hit = found.hit;
            }
        }
        best
    }
}

impl Solid {
    fn new(object: &Object) -> Result<Self> {
        let refuse = |what: &str| Err(Error::new(ErrorKind::Content, what));
        if object.repeat != [1; 3] {
            return refuse("the analytic reference knows no replicas; use the bracketing one");
        }
        let Offset {
            extend,
            bevel,
            chamfer,
        } = object.offset;
        let mut pieces = vec![(extend + bevel, -bevel)];
        if bevel != 0.0 {
            pieces.push((extend + bevel * chamfer, 0.0));
        }
        let radius = object.profile.radius;
        let axis =
            DVec2::new(object.axis[0], object.axis[1]) * (2.0 * radius) - DVec2::splat(radius);
        Ok(Self {
            outline: object.profile.outline.clone(),
            radius,
            growth: Growth::of(object),
            axis,
            pieces,
            offset: object.offset,
        })
    }

    fn trace(&self, ray: Ray) -> Trace {
        let mut trace = Trace::default();
        let Some(inside) = Inside::new(self.radius, &self.growth, ray) else {
            return trace;
        };
        let start = ray.origin + ray.direction * inside.enter.max(0.0) - self.axis.extend(0.0);
        let length = inside.leave - inside.enter.max(0.0);
        let path = Path::new(start, ray.direction, length);
        let mut stops: Vec<(f64, Option<Curve>)> = Vec::new();
        for curve in self.curves() {
            let found = path.meet(curve);
            stops.extend(
                found
                    .filter(|s| *s > 0.0 && *s < length)
                    .map(|s| (s, Some(curve))),
            );
        }
        stops.push((length, None));
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));

        let speed = ray.direction.length();
        let mut was_solid = if inside.enter > 0.0 {
            Some(false)
        } else {
            None
        };
        let (mut from, mut by) = (0.0, None);
        for (to, next) in stops {
            // A double root gives one stop.
            if (to - from) * speed < 1e-13 && next.is_some() && from > 0.0 {
                continue;
            }
            let solid = self.value(path.at(0.5 * (from + to))) <= 0.0;
            trace.evaluations += 1;
            if was_solid.is_some_and(|was| was != solid) {
                trace.grazes |= (to - from) * speed < SLIVER;
                return trace.with(self.hit(&inside, &path, from, by, solid, ray));
            }
            was_solid = Some(solid);
            (from, by) = (to, next);
        }
        if was_solid == Some(true) {
            return trace.with(self.hit(&inside, &path, length, None, false, ray));
        }
        trace
    }

    /// The hit at `s` after the start. `entering` is true if the ray is in the solid beyond the
    /// hit.
    fn hit(
        &self,
        inside: &Inside,
        path: &Path,
        s: f64,
        by: Option<Curve>,
        entering: bool,
        ray: Ray,
    ) -> Hit {
        let place = path.point(s);
        let (gradient, surface) = match by {
            Some(curve) => (curve.gradient(place), Surface::Turned),
            None => {
                let face = if entering {
                    inside.enter_axis
                } else {
                    inside.leave_axis
                };
                (DVec3::AXES[face], Surface::Cut(face))
            }
        };
        // The outward normal points against a ray that enters, and along one that leaves.
        let along = gradient.dot(ray.direction) > 0.0;
        let normal = if along == entering {
            -gradient
        } else {
            gradient
        };
        Hit {
            t: inside.enter.max(0.0) + s,
            object: 0,
            instance: 0,
            normal,
            surface,
            place,
            cell: DVec3::ONE, // replicas are not its business
        }
    }

    /// Every curve on which `F` may vanish.
    fn curves(&self) -> impl Iterator<Item = Curve> {
        let sides = self
            .outline
            .loops
            .iter()
            .flat_map(|l| l.iter().zip(l.iter().cycle().skip(1)));
        sides.flat_map(|(&a, &b)| {
            let along = (b - a).normalize_or_zero();
            let (nr, nz) = (along.y, -along.x);
            let reach = nr * a.x + nz * a.y;
            self.pieces.iter().flat_map(move |&(start, slope)| {
                let line = |side: f64| Curve::Line {
                    alpha: nr,
                    beta: nz - side * slope,
                    gamma: reach + side * start,
                };
                [
                    line(1.0),
                    line(-1.0),
                    Curve::Conic {
                        corner: a,
                        start,
                        slope,
                    },
                ]
            })
        })
    }

    /// `F` by brute force: all segments for the distance, the winding number for the sign.
    fn value(&self, q: DVec2) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut winding = 0;
        for points in &self.outline.loops {
            for (k, &b) in points.iter().enumerate() {
                let a = points[(k + points.len() - 1) % points.len()];
                let (ab, aq) = (b - a, q - a);
                // A point left of an upward segment counts up, right of a downward one down.
                if a.y <= q.y {
                    if b.y > q.y && ab.perp_dot(aq) > 0.0 {
                        winding += 1;
                    }
                } else if b.y <= q.y && ab.perp_dot(aq) < 0.0 {
                    winding -= 1;
                }
                if a.x > super::field::ON_AXIS || b.x > super::field::ON_AXIS {
                    let foot = a + ab * (aq.dot(ab) / ab.dot(ab)).clamp(0.0, 1.0);
                    nearest = nearest.min((q - foot).length());
                }
            }
        }
        let Offset {
            extend,
            bevel,
            chamfer,
        } = self.offset;
        let depth = if 1.0 - q.y < chamfer {
            1.0 - q.y
        } else {
            chamfer
        };
        (if winding != 0 { -nearest } else { nearest }) - (extend + bevel * depth)
    }
}

/// The part of a ray within the box.
struct Inside {
    enter: f64,
    enter_axis: usize,
    leave: f64,
    leave_axis: usize,
}

impl Inside {
    /// `None` if the ray misses the box, has already left it, or is invalid.
    fn new(radius: f64, growth: &Growth, ray: Ray) -> Option<Self> {
        if !is_ray(ray.origin, ray.direction) {
            return None;
        }
        let mut inside = Self {
            enter: f64::NEG_INFINITY,
            enter_axis: 0,
            leave: f64::INFINITY,
            leave_axis: 0,
        };
        let side = radius + growth.side;
        let walls = [
            (-side, side),
            (-side, side),
            (-growth.low, 1.0 + growth.high),
        ];
        for (axis, (low, high)) in walls.into_iter().enumerate() {
            for (limit, outward) in [(low, -1.0), (high, 1.0)] {
                let (v, gap) = (
                    ray.direction[axis] * outward,
                    (limit - ray.origin[axis]) * outward,
                );
                if v == 0.0 && gap < 0.0 {
                    return None;
                }
                if v < 0.0 && gap / v > inside.enter {
                    (inside.enter, inside.enter_axis) = (gap / v, axis);
                }
                if v > 0.0 && gap / v < inside.leave {
                    (inside.leave, inside.leave_axis) = (gap / v, axis);
                }
            }
        }
        (inside.leave > inside.enter.max(0.0)).then_some(inside)
    }
}

impl Trace {
    fn with(mut self, hit: Hit) -> Self {
        self.hit = Some(hit);
        self
    }
}

#[cfg(test)]
mod tests;
