//! Rays of the CPU's caster beside the reference in double precision.

use crate::common::change::Change;
use crate::common::rays::{Random, count};
use crate::common::shapes;
use glam::{DQuat, DVec3};
use revmap::cast::RayCaster;
use revmap::profile::Profile;
use revmap::scene::{Camera, Clip, Object, Placement, Scene};
use revmap_reference::{Ray, Reference};

/// Objects of each kind: offsets, cuts, replicas, placements, copies.
fn objects() -> Vec<Object> {
    let placed = Placement {
        position: DVec3::new(3.0, -2.0, 1.0),
        rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.9, -2.0),
        scale: DVec3::new(0.5, 0.8, 2.0),
    };
    let mut all: Vec<Object> = (shapes::all().into_iter())
        .map(|(name, profile)| Object::new(name, profile.into()))
        .collect();
    let plain = |profile: revmap::profile::Profile| Object::new("solid", profile.into());
    let vase = plain(shapes::vase());
    let copy = |k: u32| Placement {
        position: DVec3::new(f64::from(k % 10), f64::from(k / 10), 0.0),
        scale: DVec3::splat(0.5 + 0.002 * f64::from(k)),
        ..placed
    };
    all.extend([
        vase.clone().with(|o| {
            o.offset = shapes::offset(0.04, 0.3, 0.2);
            o.placement = placed;
        }),
        vase.clone().with(|o| {
            o.offset = shapes::offset(0.1, 0.0, 0.0);
            o.clip = Clip::Box;
        }),
        vase.clone().with(|o| o.axis = [0.75, 0.4]),
        plain(shapes::glass()).with(|o| {
            o.repeat = [2, 3, 2];
            o.mirror = [true, false, true];
            o.axis = [0.6, 0.5];
        }),
        vase.with(|o| o.instances = (0..200).map(copy).collect()),
    ]);
    all
}

/// A ray along the axis hits the tip of a cone, from both ends. There its two roots are one.
#[test]
fn rays_along_the_axis_hit_tips() {
    let mut random = Random(7);
    for _ in 0..200 {
        let [low, high] = [0.05 + 0.3 * random.next(), 0.6 + 0.3 * random.next()];
        let radius = 0.05 + 0.4 * random.next();
        let middle = low + (high - low) * random.next();
        let points = [[0.0, low], [radius, middle], [0.0, high]];
        let profile = Profile::polygon(&points, 0.5).unwrap();
        let caster = RayCaster::new(&Object::new("cones", profile.into())).unwrap();
        for (eye, tip) in [(-1.0, low), (2.0, high)] {
            let way = DVec3::new(0.0, 0.0, 0.5 - eye);
            let hit = caster.cast(DVec3::new(0.0, 0.0, eye), way);
            let z = hit.map(|hit| eye + hit.t * way.z);
            assert!(
                z.is_some_and(|z| (z - tip).abs() < 1e-5),
                "{points:?}: {z:?}"
            );
        }
    }
}

/// Hits are those of the reference, to within the fit of the patches. Rays that graze a surface may
/// miss it. Measured: at most 4 of 20,000 rays at one solid, the torus.
#[test]
fn casts_hit_what_the_reference_hits() {
    for object in objects() {
        let mut scene = Scene::new(Camera::new(DVec3::ONE, DVec3::ZERO));
        scene.objects.push(object.clone());
        let truth = Reference::new(&scene).unwrap();
        let caster = RayCaster::new(&object).unwrap();
        let [low, high] = caster.bounds().unwrap();
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let mut random = Random(7);
        let mut vector = |scale: f64| {
            let mut one = || 2.0 * random.next() - 1.0;
            DVec3::new(one(), one(), one()) * half * scale
        };
        let (mut hits, mut off, rays) = (0, 0, count(2000));
        for n in 0..rays {
            // Every fourth ray starts in the box, and so perhaps in the solid.
            let origin = middle + vector(if n % 4 == 0 { 1.0 } else { 6.0 });
            let direction = middle + vector(1.0) - origin;
            let expected = truth.trace(Ray { origin, direction });
            let found = caster.cast(origin, direction);
            if let (Some(a), Some(b)) = (found, expected.hit) {
                let point = origin + a.t * direction;
                assert!(point.cmpge(low - 1e-4).all() && point.cmple(high + 1e-4).all());
                let gap = (a.t - b.t).abs() * direction.dot(b.normal).abs();
                hits += 1;
                off += usize::from(
                    gap > 1e-4 || a.normal.dot(b.normal) < 0.999 || a.copy != b.instance,
                );
                let leaves = direction.dot(a.normal) > 0.0;
                assert!(
                    a.leaves == leaves || expected.grazes,
                    "{}: {a:?}",
                    object.name
                );
            } else {
                off += usize::from(found.is_some() != expected.hit.is_some() && !expected.grazes);
            }
        }
        assert!(hits > rays / 5, "{}: {hits} of {rays}", object.name);
        assert!(
            off <= 1 + rays / 4000,
            "{}: {off} of {hits} are off",
            object.name
        );
    }
}

#[test]
fn rays_that_are_none_hit_nothing() {
    let caster = RayCaster::new(&objects()[0]).unwrap();
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::splat(f64::INFINITY)] {
        assert_eq!(caster.cast(DVec3::splat(2.0), direction), None);
    }
    assert_eq!(caster.cast(DVec3::NAN, DVec3::X), None);
}
