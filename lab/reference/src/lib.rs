//! Ground truth: the first hit of each pixel's ray in double precision, by methods that share
//! nothing with the shaders.
//!
//! The surface is `F(r, z) = d(r, z) - w(z) = 0` within the shape box, closed by the box. `d` is
//! the exact distance to the profile's outline. `F` changes along a ray at most by a known factor,
//! so steps can be proven not to pass a surface.
//!
//! Steps are proven, then a bracket is narrowed. Tests compare with a second method, by formula.
//!
//! ```
//! use glam::{DVec2, DVec3};
//! use revmap::profile::{Outline, Profile};
//! use revmap_reference::{Ray, Reference};
//! use revmap::scene::{Camera, Object, Scene};
//! use std::sync::Arc;
//! // A cylinder of radius 1/4, from the floor of its box to the ceiling.
//! let points = [(0.0, 0.0), (0.25, 0.0), (0.25, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
//! let profile = Profile::new(Outline { loops: vec![points] }, 0.5);
//! let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
//! scene.objects.push(Object::new("cylinder", Arc::new(profile)));
//! let ray = Ray { origin: DVec3::new(2.0, 0.0, 0.5), direction: DVec3::NEG_X };
//! let hit = Reference::new(&scene)?.trace(ray).hit;
//! assert!(hit.is_some_and(|hit| (hit.t - 1.75).abs() < 1e-12 && hit.normal == DVec3::X));
//! # Ok::<(), revmap::Error>(())
//! ```

mod bracket;
mod draw;
mod field;
mod parts;
#[cfg(test)]
#[path = "../../../tests/common/random.rs"]
mod random;
#[cfg(test)]
#[path = "../../../tests/common/samples.rs"]
mod samples;
mod shade;
mod solid;
mod texture;
mod tree;

pub use draw::draw;
pub use shade::Colors;
pub use solid::Surface;

use field::Field;
use glam::DVec3;
use parts::{Part, Parts};
use revmap::error::{Error, ErrorKind, Result};
use revmap::profile::Profile;
use revmap::scene::{Placement, Scene};
use solid::Solid;
use std::sync::Arc;

/// A ray in the world. The direction may have any length, and `t` is in units of that length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The start, world units.
    pub origin: DVec3,
    /// The direction.
    pub direction: DVec3,
}

impl Ray {
    /// A ray from a start in a direction.
    pub fn new(origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> Self {
        Self {
            origin: origin.into(),
            direction: direction.into(),
        }
    }
}

/// Returns true for a valid ray: finite numbers, and a direction whose squared length is a normal
/// double. Any other ray hits nothing.
fn is_ray(origin: DVec3, direction: DVec3) -> bool {
    origin.is_finite() && direction.length_squared().is_normal()
}

/// Hits whose `t` differ by less than this part are of one point: more than their roundings, and
/// less than the lag by which shaders tell such hits apart.
const AT_ONCE: f64 = 1e-9;

/// The first boundary point along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The point is `origin + t direction`.
    pub t: f64,
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of its copy; 0 without copies.
    pub instance: usize,
    /// Unit outward normal, world space.
    pub normal: DVec3,
    /// The part of the boundary.
    pub surface: Surface,
    /// The point in its replica's cell: x, y from the axis of revolution, z from the floor, object
    /// units of the profile.
    pub place: DVec3,
    /// Units of that cell per object unit, along each axis; negative for a reflected replica.
    pub cell: DVec3,
}

/// The result of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trace {
    /// The first hit at `t >= 0`; that of the first copy in the scene where several coincide.
    pub hit: Option<Hit>,
    /// True if the ray touches a surface or an edge so closely that a change in the last digits
    /// could give another result.
    pub grazes: bool,
    /// Evaluations of the distance.
    pub evaluations: u32,
}

/// A scene prepared for rays.
#[derive(Debug)]
pub struct Reference {
    parts: Parts,
}

impl Reference {
    /// Prepares all objects of a scene.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] if a profile has no surface, or a placement is invalid (a scale that
    /// is not positive, a rotation that is zero, a number that is not finite).
    pub fn new(scene: &Scene) -> Result<Self> {
        let mut fields = Vec::new();
        let mut parts = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            let key = format!("object.{index}");
            let field = shared(&mut fields, &object.profile, prepare)
                .map_err(|e| e.at_key(format!("{key}.profile")))?;
            let solid = Arc::new(Solid::new(object, field));
            for (instance, placement) in object.placements().iter().enumerate() {
                let placement = checked(placement).map_err(|e| e.at_key(&key))?;
                parts.push(Part {
                    object: index,
                    instance,
                    solid: solid.clone(),
                    placement,
                });
            }
        }
        Ok(Self {
            parts: Parts::new(parts),
        })
    }

    /// The solids that contain a point of the world, and the others.
    pub fn split_at(&self, point: DVec3) -> [Self; 2] {
        let here = Ray::new(point, DVec3::Z);
        let contains = |part: &&Part| part.solid.lowest(part.local(here), 0.0, 1e-9, None) < 0.0;
        let (around, others) = self.parts.list.iter().cloned().partition(|p| contains(&p));
        [around, others].map(|parts| Self {
            parts: Parts::new(parts),
        })
    }

    /// The first hit along a ray. An invalid ray (no direction, a number that is not finite) hits
    /// nothing.
    pub fn trace(&self, ray: Ray) -> Trace {
        let mut all = Trace::default();
        let mut nearest = f64::INFINITY;
        if !is_ray(ray.origin, ray.direction) {
            return all;
        }
        self.parts.along(ray, |part| {
            let found = part.solid.trace(part.local(ray));
            all.evaluations += found.evaluations;
            all.grazes |= found.grazes;
            let Some(mut hit) = found.hit else {
                return f64::INFINITY;
            };
            (hit.object, hit.instance) = (part.object, part.instance);
            // If two are hit at once, the first in the scene is used, independent of the order in
            // the tree and of the last digits.
            let is_first = |best: Hit| match (hit.t - best.t).abs() <= AT_ONCE * best.t {
                true => (hit.object, hit.instance) < (best.object, best.instance),
                false => hit.t < best.t,
            };
            nearest = nearest.min(hit.t);
            if all.hit.is_none_or(is_first) {
                let Placement {
                    rotation, scale, ..
                } = part.placement;
                hit.normal = (rotation * (hit.normal / scale)).normalize_or_zero();
                all.hit = Some(hit);
            }
            nearest * (1.0 + AT_ONCE)
        });
        all
    }

    /// The depth to which a ray between two values of `t` enters the solids (negative), or the
    /// distance by which it misses all of them (positive), in object units and to within
    /// `tolerance`. This is the least value of `max(F, g)`, with `g` the distance to the box's
    /// faces, negative inside.
    ///
    /// The clearance distinguishes a wrong pixel from one that rounding decides: both signs are
    /// right at a silhouette as long as the clearance is small. With equal values of `t` it is the
    /// distance of a drawn hit from the surface. With a part up to a drawn hit, it shows a solid
    /// that the drawing has passed. An invalid ray has the clearance `+inf`.
    pub fn clearance_within(&self, ray: Ray, part: [f64; 2], tolerance: f64) -> f64 {
        self.each_lowest(ray, part, tolerance, None)
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns true if a part of a ray, between two values of `t`, is deeper in a solid than
    /// `depth`, object units, to within `tolerance`. This is much faster than
    /// [`Reference::clearance_within`], which computes the depth.
    pub fn goes_deeper(&self, ray: Ray, part: [f64; 2], depth: f64, tolerance: f64) -> bool {
        self.each_lowest(ray, part, tolerance, Some(-depth))
            .any(|lowest| lowest < -depth)
    }

    /// [`Solid::lowest`] of each part of the scene, on the part of the ray ahead of its start.
    fn each_lowest(
        &self,
        ray: Ray,
        [from, to]: [f64; 2],
        tolerance: f64,
        floor: Option<f64>,
    ) -> impl Iterator<Item = f64> {
        let valid = is_ray(ray.origin, ray.direction);
        let parts = self.parts.list.iter().take_while(move |_| valid);
        let from = from.max(0.0);
        let length = to.max(from) - from;
        parts.map(move |part| {
            let mut local = part.local(ray);
            local.origin += local.direction * from;
            (part.solid).lowest(local, length, tolerance.max(1e-9), floor)
        })
    }
}

/// What `make` gives for a profile, once for all objects that share the profile.
fn shared<T>(
    known: &mut Vec<(*const Profile, Arc<T>)>,
    profile: &Arc<Profile>,
    make: impl FnOnce(&Profile) -> Result<T>,
) -> Result<Arc<T>> {
    let pointer = Arc::as_ptr(profile);
    if let Some((_, found)) = known.iter().find(|(p, _)| *p == pointer) {
        return Ok(found.clone());
    }
    let new = Arc::new(make(profile)?);
    known.push((pointer, new.clone()));
    Ok(new)
}

fn prepare(profile: &Profile) -> Result<Field> {
    Field::new(&profile.outline).ok_or_else(|| {
        Error::new(
            ErrorKind::Content,
            "the profile has no surface; give one with a solid part off the axis",
        )
    })
}

fn checked(placement: &Placement) -> Result<Placement> {
    let Placement {
        position,
        rotation,
        scale,
    } = *placement;
    let wrong = |what: &str| Err(Error::new(ErrorKind::Content, what));
    if !(position.is_finite() && rotation.is_finite() && scale.is_finite()) {
        return wrong("its placement is not finite; give numbers");
    }
    if scale.min_element() <= 0.0 {
        return wrong("its scale is not positive; give three positive numbers");
    }
    if rotation.length_squared() == 0.0 {
        return wrong("its rotation is zero; give a unit quaternion");
    }
    Ok(Placement {
        position,
        rotation: rotation.normalize(),
        scale,
    })
}

#[cfg(test)]
mod tests;
