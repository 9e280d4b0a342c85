//! Rays against objects on the CPU.

use crate::fault::{Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::object::RevmapObjectInfo;
use crate::pointers::{check_room, list, put};
use crate::structures::read;
use revmap::cast::RayCaster;
use revmap::scene::Object;
use std::sync::Arc;

/// An object prepared for rays on the CPU, in double precision: for picking and physics. It keeps
/// the values that the object had.
pub struct RevmapRayCaster;
handle!(RevmapRayCaster, "ray caster", Arc<RayCaster>);

/// A ray.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapRay {
    /// World units.
    pub origin: [f64; 3],
    /// The direction; any length but zero.
    pub direction: [f64; 3],
}

/// The first point of a ray on the boundary of an object.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapRayHit {
    /// The point is origin + t * direction; infinite without a hit.
    pub t: f64,
    /// Unit outward normal in the world, without bumps; zero without a hit.
    pub normal: [f64; 3],
    /// Number of the copy; 0 without copies.
    pub copy: u32,
    /// 1 if the ray starts in the solid and leaves it here, else 0.
    pub leaves: u32,
}

/// The least box around an object, along the axes of the world.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapBounds {
    /// Least x, y, z, world units.
    pub low: [f64; 3],
    /// Largest x, y, z, world units. Less than low if nothing of the object is left.
    pub high: [f64; 3],
}

/// An object prepared for rays.
pub(crate) fn caster(object: &Object) -> Outcome<RayCaster> {
    object.check()?;
    Ok(RayCaster::new(object)?)
}

/// Prepares an object for rays, without a device.
///
/// Fails with REVMAP_RESULT_CONTENT for values out of range, or if the contour under the offset does
/// not close. If nothing of the solid is left, rays hit nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_ray_caster_create(
    object: *const RevmapObjectInfo,
    ray_caster: *mut *mut RevmapRayCaster,
) -> RevmapResult {
    create(ray_caster, || caster(&read(object)?.object()?))
}

/// Finds the first hit of each ray at t >= 0: the surface that is drawn, without bumps. A ray that
/// starts in a copy hits the point where it leaves that copy. A ray with a number that is not
/// finite, or without a direction, hits nothing. Both arrays have count elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_ray_caster_cast(
    ray_caster: *const RevmapRayCaster,
    rays: *const RevmapRay,
    count: usize,
    hits: *mut RevmapRayHit,
) -> RevmapResult {
    enter(|| {
        let caster = RevmapRayCaster::get(ray_caster)?;
        let rays = list(rays, count, "rays")?;
        if count > 0 {
            check_room(hits.cast_const(), count, "hits")?;
        }
        for (number, ray) in rays.iter().enumerate() {
            let hit = cast(&caster, ray);
            hits.add(number).write(hit);
        }
        Ok(())
    })
}

fn cast(caster: &RayCaster, ray: &RevmapRay) -> RevmapRayHit {
    match caster.cast(ray.origin.into(), ray.direction.into()) {
        Some(hit) => RevmapRayHit {
            t: hit.t,
            normal: hit.normal.to_array(),
            copy: u32::try_from(hit.copy).unwrap_or(u32::MAX),
            leaves: u32::from(hit.leaves),
        },
        None => RevmapRayHit {
            t: f64::INFINITY,
            normal: [0.0; 3],
            copy: 0,
            leaves: 0,
        },
    }
}

/// Returns the least box around the object, all of its copies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_ray_caster_bounds(
    ray_caster: *const RevmapRayCaster,
    bounds: *mut RevmapBounds,
) -> RevmapResult {
    put(bounds, "bounds", || {
        let found = RevmapRayCaster::get(ray_caster)?.bounds();
        let ends = found.map(|ends| ends.map(|end| end.to_array()));
        let [low, high] = ends.unwrap_or([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
        Ok(RevmapBounds { low, high })
    })
}

/// Destroys a ray caster; null is none.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_ray_caster_destroy(ray_caster: *mut RevmapRayCaster) -> RevmapResult {
    enter(|| RevmapRayCaster::destroy(ray_caster))
}
