//! Rays through the C interface: what the Rust ray caster returns.

use crate::names::*;
use crate::recording::BESIDE;
use crate::{POINTS, RADIUS, device, object_of, spindle};
use revmap::cast::RayCaster;

/// Rays from around towards the middle of the first copy, and some that hit nothing.
fn rays() -> Vec<RevmapRay> {
    let around = (0..200).map(|n| {
        let (angle, z) = (0.1 * f64::from(n), 0.01 * f64::from(n % 100));
        let origin = [3.0 * angle.cos(), 3.0 * angle.sin(), 1.5];
        RevmapRay {
            origin,
            direction: [-origin[0], -origin[1], z - 1.5],
        }
    });
    let inside = RevmapRay {
        origin: [0.0, 0.0, 0.2],
        direction: [1.0, 0.0, 0.0],
    };
    let none = [[0.0; 3], [f64::NAN, 0.0, 0.0], [-1.0, 0.0, 0.0]].map(|direction| RevmapRay {
        origin: [-3.0, 0.0, 0.5],
        direction,
    });
    around.chain([inside]).chain(none).collect()
}

/// The hits in Rust, as C has them.
fn hits_in_rust(caster: &RayCaster, rays: &[RevmapRay]) -> Vec<Option<RevmapRayHit>> {
    let cast = |ray: &RevmapRay| caster.cast(ray.origin.into(), ray.direction.into());
    let hits = rays.iter().map(cast).map(|hit| {
        hit.map(|hit| RevmapRayHit {
            t: hit.t,
            normal: hit.normal.to_array(),
            copy: hit.copy as u32,
            leaves: u32::from(hit.leaves),
        })
    });
    hits.collect()
}

/// The hits in C; those that are none are checked.
fn hits_in_c(caster: *mut RevmapRayCaster, rays: &[RevmapRay]) -> Vec<Option<RevmapRayHit>> {
    let unset = RevmapRayHit {
        t: -1.0,
        ..crate::zeros()
    };
    let mut hits = vec![unset; rays.len()];
    ok! { revmap_ray_caster_cast(caster, rays.as_ptr(), rays.len(), hits.as_mut_ptr()); }
    let none = RevmapRayHit {
        t: f64::INFINITY,
        ..crate::zeros()
    };
    let hit = |hit: RevmapRayHit| (hit != none).then_some(hit);
    hits.into_iter().map(hit).collect()
}

#[test]
fn rays_hit_what_they_hit_in_rust() {
    let (rays, device, profile) = (rays(), device(), spindle());
    let mut object = Object::new("object", Profile::polygon(&POINTS, RADIUS).unwrap().into());
    let beside = Placement {
        position: BESIDE.into(),
        ..Placement::default()
    };
    object.offset.extend = 0.01;
    object.instances = vec![Placement::default(), beside].into();
    let (mut caster, mut renderer) = (null_mut(), null_mut());
    let (mut added, mut bounds) = (0, crate::zeros());
    let mut info = object_of(profile);
    let mut copies = [info.placement; 2];
    copies[1].position = BESIDE;
    info.offset.extend = 0.01;
    (info.instances, info.instance_count) = (copies.as_ptr(), copies.len());
    ok! {
        revmap_ray_caster_create(&info, &mut caster);
        revmap_ray_caster_bounds(caster, &mut bounds);
    }
    let in_rust = RayCaster::new(&object).unwrap();
    let wanted = hits_in_rust(&in_rust, &rays);
    assert_eq!(hits_in_c(caster, &rays), wanted);
    let hits: Vec<_> = wanted.iter().flatten().collect();
    assert!(
        (150..rays.len()).contains(&hits.len()),
        "{} hits",
        hits.len()
    );
    assert!(hits.iter().any(|hit| hit.copy == 1) && hits.iter().any(|hit| hit.leaves == 1));
    let wanted = in_rust.bounds().unwrap().map(|end| end.to_array());
    assert_eq!([bounds.low, bounds.high], wanted);
    ok! { revmap_ray_caster_destroy(caster); }

    // An object of a renderer, with its present values; the caster keeps them.
    ok! {
        revmap_renderer_create_compute(device, 0, null(), 1, &mut renderer);
        revmap_renderer_add(renderer, &info, &mut added);
        revmap_renderer_set_instances(renderer, added, &copies[1], 1);
        revmap_renderer_ray_caster(renderer, added, &mut caster);
        revmap_renderer_remove(renderer, added);
    }
    object.instances = vec![beside].into();
    let wanted = hits_in_rust(&RayCaster::new(&object).unwrap(), &rays);
    assert_eq!(hits_in_c(caster, &rays), wanted);
    ok! {
        revmap_ray_caster_destroy(caster);
        revmap_renderer_destroy(renderer);
        revmap_device_check(device);
        revmap_device_destroy(device);
        revmap_profile_destroy(profile);
    }
}

#[test]
fn wrong_arguments_of_rays_are_refused() {
    let (profile, mut caster) = (spindle(), null_mut());
    let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
    fail! {
        Handle, "the profile is null": revmap_ray_caster_create(&info, &mut caster);
        Usage, "RevmapObjectInfo is null": revmap_ray_caster_create(null(), &mut caster);
    }
    info.profile = profile;
    fail! {
        Usage, "null": revmap_ray_caster_create(&info, null_mut());
    }
    assert!(caster.is_null(), "a failure has written a handle");
    ok! {
        revmap_ray_caster_create(&info, &mut caster);
        revmap_ray_caster_cast(caster, null(), 0, null_mut());
    }
    let (ray, mut hit) = (rays()[0], crate::zeros());
    fail! {
        Usage, "rays is null": revmap_ray_caster_cast(caster, null(), 1, &mut hit);
        Usage, "hits is null": revmap_ray_caster_cast(caster, &ray, 1, null_mut());
        Usage, "bounds is null": revmap_ray_caster_bounds(caster, null_mut());
    }
    ok! { revmap_ray_caster_destroy(caster); }
    fail! {
        Handle, "the ray caster was destroyed": revmap_ray_caster_cast(caster, &ray, 1, &mut hit);
        Handle, "the renderer is null": revmap_renderer_ray_caster(null(), 1, &mut caster);
    }
    ok! {
        revmap_ray_caster_destroy(null_mut());
        revmap_profile_destroy(profile);
    }
}
