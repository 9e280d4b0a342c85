//! Rays of the CPU's caster beside the reference in double precision.

use crate::common::change::Change;
use crate::common::rays::{Random, count, profiles};
use crate::common::shapes;
use glam::{DQuat, DVec3};
use revmap::cast::RayCaster;
use revmap::profile::Profile;
use revmap::scene::{Camera, Clip, Object, Offset, Placement, Scene};
use revmap_reference::{Ray, Reference};

const OFFSETS: [(f64, f64, f64); 8] = [
    (0.0, 0.0, 1.0),
    (0.02, 0.0, 1.0),
    (-0.01, 0.0, 1.0),
    (0.0, 0.1, 1.0),
    (0.01, -0.05, 0.5),
    (0.0, 0.2, 0.25),
    (-0.02, 0.06, 0.7),
    (0.08, 0.0, 1.0),
];

/// Objects of each kind: every profile under every offset in its box, then placements, cuts,
/// replicas and copies.
fn objects() -> Vec<Object> {
    let placed = Placement {
        position: DVec3::new(3.0, -2.0, 1.0),
        rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.9, -2.0),
        scale: DVec3::new(0.5, 0.8, 2.0),
    };
    let profiles = profiles();
    let of = |(extend, bevel, chamfer)| {
        profiles.iter().map(move |(name, profile)| {
            Object::new(name, profile.clone().into()).with(|o| {
                o.offset = shapes::offset(extend, bevel, chamfer);
                o.clip = Clip::Box;
            })
        })
    };
    let mut all: Vec<Object> = OFFSETS.into_iter().flat_map(of).collect();
    let plain = |profile: Profile| Object::new("solid", profile.into());
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
    let (mut all_hits, mut all_wrong, rays) = (0, 0, count(2000));
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
        let (mut depths, mut off, mut wrong) = (Vec::new(), 0, 0);
        for n in 0..rays {
            // Every fourth ray starts in the box, and so perhaps in the solid.
            let origin = middle + vector(if n % 4 == 0 { 1.0 } else { 6.0 });
            let direction = middle + vector(1.0) - origin;
            let expected = truth.trace(Ray { origin, direction });
            let found = caster.cast(origin, direction);
            if let (Some(a), Some(b)) = (found, expected.hit) {
                let point = origin + a.t * direction;
                assert!(point.cmpge(low - 1e-4).all() && point.cmple(high + 1e-4).all());
                let apart = (a.t - b.t).abs() * direction.length();
                let cosine = direction.normalize().dot(b.normal).abs();
                depths.push(apart * 512.0);
                let turned = a.normal.dot(b.normal) < 0.999;
                off += usize::from(apart * cosine > 1e-4 || turned || a.copy != b.instance);
                let leaves = direction.dot(a.normal) > 0.0;
                let right = a.leaves == leaves || expected.grazes;
                assert!(right, "{}: {a:?}", object.name);
            } else {
                wrong += usize::from(found.is_some() != expected.hit.is_some() && !expected.grazes);
            }
        }
        depths.sort_by(f64::total_cmp);
        let (hits, p99) = (depths.len(), depths[depths.len() * 99 / 100]);
        let (name, offset) = (&object.name, object.offset);
        let what =
            format!("{name}, {offset:?}: {hits} hits, {off} off, {wrong} wrong, p99 {p99:.4}");
        println!("{what}");
        assert!(hits > rays / 10 && p99 < 0.02, "{what}");
        // Patches are round where outlines of drawings have corners, and where offsets make such.
        let plain = shapes::all().iter().any(|(n, _)| n == name) && offset == Offset::default();
        let is_exact = plain || name == "solid";
        assert!(!is_exact || off + wrong <= 1 + rays / 4000, "{what}");
        assert!(wrong <= 2, "{what}");
        (all_hits, all_wrong) = (all_hits + hits, all_wrong + wrong);
    }
    let what = format!("{all_wrong} wrong of {all_hits}");
    assert!(all_wrong as f64 <= 5e-5 * all_hits as f64, "{what}");
}

#[test]
fn rays_that_are_none_hit_nothing() {
    let caster = RayCaster::new(&objects()[0]).unwrap();
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::splat(f64::INFINITY)] {
        assert_eq!(caster.cast(DVec3::splat(2.0), direction), None);
    }
    assert_eq!(caster.cast(DVec3::NAN, DVec3::X), None);
}
