//! Replicas compared with single objects, copies, images as profiles, unusual camera positions,
//! clearance.

use super::*;
use revmap::profile::Raster;
use revmap::scene::Copies;
use std::f64::consts::PI;

/// `n` rays at and through the unit box, by the golden ratio.
fn rays(n: u32) -> impl Iterator<Item = Ray> {
    (0..n).map(|k| {
        let part = |a: f64| (f64::from(k) * a).fract();
        let (g, h, m) = (
            part(0.618_033_988_75),
            part(0.754_877_666_25),
            part(0.569_840_290_998),
        );
        let aim = DVec3::new(part(0.3247) - 0.5, part(0.5497) - 0.5, part(0.8191));
        let (s, c) = (g * 2.0 * PI).sin_cos();
        let z = 2.0 * h - 1.0;
        let from = aim + DVec3::new(s, c, z) * (0.05 + 3.0 * m * m);
        Ray::new(from, (aim - from) * (0.5 + part(0.2137)))
    })
}

#[track_caller]
fn assert_same(a: &Reference, b: &Reference, rays: impl Iterator<Item = Ray>) {
    let (mut hits, mut grazing, mut all) = (0, 0, 0);
    for ray in rays {
        let (p, q) = (a.trace(ray), b.trace(ray));
        all += 1;
        if p.grazes || q.grazes {
            grazing += 1;
            continue;
        }
        match (p.hit, q.hit) {
            (Some(p), Some(q)) => {
                hits += 1;
                assert!((p.t - q.t).abs() < 1e-9, "{ray:?} {p:?} {q:?}");
                assert!((p.normal - q.normal).length() < 1e-6, "{ray:?} {p:?} {q:?}");
            }
            (p, q) => assert!(p.is_none() && q.is_none(), "{ray:?} {p:?} {q:?}"),
        }
    }
    assert!(
        hits > all / 10 && grazing < all / 50,
        "{hits} hits, {grazing} grazing of {all}"
    );
}

/// A single object for each cell of a repeated one.
fn singles(object: &Object) -> Vec<Object> {
    let mut list = Vec::new();
    let n = object.repeat.map(f64::from);
    let side = 2.0 * object.profile.radius;
    let size = DVec3::new(side, side, 1.0);
    for k in 0..object.repeat.iter().product::<u32>() {
        let index = [
            k % object.repeat[0],
            k / object.repeat[0] % object.repeat[1],
            k / (object.repeat[0] * object.repeat[1]),
        ];
        let mirrored: [bool; 3] = std::array::from_fn(|a| object.mirror[a] && index[a] % 2 == 1);
        let mut one = object.clone();
        (one.repeat, one.mirror) = ([1; 3], [false; 3]);
        one.clip = revmap::scene::Clip::Box; // as a cell cuts
        let at = |a: usize, shift: f64| (f64::from(index[a]) + shift) / n[a] * size[a];
        let mut place = Placement {
            position: DVec3::new(
                at(0, 0.5) - size.x / 2.0,
                at(1, 0.5) - size.y / 2.0,
                at(2, 0.0),
            ),
            rotation: DQuat::IDENTITY,
            scale: DVec3::from(n).recip(),
        };
        // A turned solid is its own mirror image except for the position of its axis.
        if mirrored[0] {
            one.axis[0] = 1.0 - one.axis[0];
        }
        if mirrored[1] {
            one.axis[1] = 1.0 - one.axis[1];
        }
        if mirrored[2] {
            // Half a turn about x turns it upside down, and turns y round too.
            place.position.z = at(2, 1.0);
            place.rotation = DQuat::from_rotation_x(PI);
            one.axis[1] = 1.0 - one.axis[1];
        }
        one.placement = place;
        list.push(one);
    }
    list
}

#[test]
fn replicas_are_as_many_single_objects() {
    for (repeat, mirror, axis) in [
        ([3, 3, 2], [false; 3], [0.5, 0.5]),
        ([3, 3, 2], [true; 3], [0.5, 0.5]),
        ([2, 1, 3], [true, false, true], [0.6, 0.35]),
        ([1, 4, 2], [false, true, false], [0.3, 0.5]),
    ] {
        for outline in [samples::hollow(), samples::cone(0.3, 0.1, 0.9)] {
            let mut o = object(outline, 0.5);
            o.offset = Offset {
                extend: 0.01,
                bevel: 0.05,
                chamfer: 0.6,
            };
            (o.repeat, o.mirror, o.axis) = (repeat, mirror, axis);
            let many = Reference::new(&scene(singles(&o))).unwrap();
            let one = Reference::new(&scene(vec![o])).unwrap();
            // Solids cut by their cells touch: single solids, seen from within, still show the
            // joint.
            let outside =
                |r: &Ray| axis == [0.5; 2] || (r.origin - DVec3::Z * 0.5).abs().max_element() > 0.5;
            assert_same(&one, &many, rays(2500).filter(outside));
        }
    }
}

#[test]
fn replicas_that_touch_are_one_solid() {
    let mut o = object(samples::cylinder(0.4, 0.0, 1.0), 0.5);
    o.repeat = [1, 1, 4];
    // The far end is seen from inside, not the joints.
    let found = shoot(&o, [0.1, 0.0, 0.1], [0.0, 0.0, 1.0]);
    assert!((found.hit.unwrap().t - 0.9).abs() < 1e-9);
    // A cone's base touches the next cone's tip: the joint is surface if only one side is solid.
    o.profile = Arc::new(Profile::new(samples::cone(0.4, 0.0, 1.0), 0.5));
    let found = shoot(&o, [0.2, 0.1, 0.2], [0.0, 0.0, 1.0]).hit.unwrap();
    assert!(
        (found.t - 0.05).abs() < 1e-9 && (found.normal + DVec3::Z).length() < 1e-9,
        "{found:?}"
    );
    // With mirroring, base meets base: the side of the upper cone is seen from within the lower
    // one.
    o.mirror[2] = true;
    let found = shoot(&o, [0.2, 0.1, 0.45], [0.0, 0.0, 1.0]).hit.unwrap();
    let z = 0.75 - 0.25 * 0.05f64.sqrt() / 0.4;
    assert!(
        (found.t - (z - 0.45)).abs() < 1e-9 && found.normal.z > 0.0,
        "{found:?}"
    );
}

#[test]
fn copies_are_as_many_objects_whatever_the_tree() {
    let mut crowd = object(samples::glass(), 0.4);
    crowd.instances = (0..60)
        .map(|k| {
            let part = |a: f64| (f64::from(k) * a).fract() - 0.5;
            Placement {
                position: DVec3::new(part(0.618), part(0.7548), part(0.5698)) * 2.0,
                rotation: DQuat::from_scaled_axis(
                    DVec3::new(part(0.32), part(0.54), part(0.81)) * 6.0,
                ),
                scale: DVec3::new(0.3 + part(0.21).abs(), 0.25, 0.4),
            }
        })
        .collect();
    let alone = crowd.instances.iter().map(|&placement| {
        let mut o = crowd.clone();
        (o.placement, o.instances) = (placement, Copies::default());
        o
    });
    let alone: Vec<Reference> = alone
        .map(|o| Reference::new(&scene(vec![o])).unwrap())
        .collect();
    let crowd = Reference::new(&scene(vec![crowd])).unwrap();
    let mut hits = 0;
    for ray in rays(1000) {
        let best = (0..60)
            .filter_map(|k| Some((alone[k].trace(ray).hit?.t, k)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let found = crowd.trace(ray).hit.map(|h| (h.t, h.instance));
        assert_eq!(found, best);
        hits += usize::from(found.is_some());
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn a_picture_is_its_outline() {
    // A cylinder of radius 12 pixels and 40 pixels high in an image of 64 rows, one column of it
    // half covered.
    let coverage = |i: u32, j: u32| {
        if (12..52).contains(&j) {
            [1.0, 0.75, 0.0][(i.max(10) - 10).min(2) as usize]
        } else {
            0.0
        }
    };
    let image = Raster {
        columns: 32,
        rows: 64,
        coverage: (0..32 * 64).map(|k| coverage(k % 32, k / 32)).collect(),
    };
    let o = object(revmap_files::trace(image).unwrap().outline, 0.5);
    // Eleven columns and three quarters of one.
    let r = 11.75 / 64.0;
    assert_hits(&o, &format!("2 0 0.5  -1 0 0  {}  1 0 0  turned", 2.0 - r));
    let t = 2.0 + 12.0 / 64.0;
    assert_hits(&o, &format!("0.01 0.02 3  0 0 -1  {t}  0 0 1  turned"));
}

#[test]
fn cameras_within_see_boundaries_everywhere() {
    for (eye, target) in [
        (DVec3::new(0.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 1.0)),
        (DVec3::new(0.0, 0.0, 0.5), DVec3::new(1.0, 0.0, 0.5)),
        (DVec3::new(0.1, -0.05, 0.6), DVec3::new(0.0, 0.0, 0.0)),
    ] {
        for extend in [0.0, 0.2] {
            let mut o = object(samples::ball(0.45, 64), 0.5);
            o.offset.extend = extend;
            let mut s = scene(vec![o]);
            (s.camera.eye, s.camera.target, s.camera.fov_y) = (eye, target, 100.0);
            let frame = draw(&s, &settings(41, 31), &|_, _| {}).unwrap();
            for k in 0..frame.pixels() {
                assert!(
                    frame.hits(k) && frame.pixel(k).iter().all(|v| v.is_finite()),
                    "pixel {k} from {eye}"
                );
                let n = glam::Vec3::from(frame.normal[k]);
                let shaded = glam::Vec3::from(frame.shading_normal[k]);
                assert!((n.length() - 1.0).abs() < 1e-6 && (n + shaded).length() < 1e-6);
            }
        }
    }
}

#[test]
fn clearance_is_how_deep_or_how_far() {
    let ball = || object(samples::ball(0.3, 400), 0.5);
    let at = |o: Object, y: f64, z: f64| {
        let ray = Ray::new(DVec3::new(2.0, y, z), DVec3::new(-3.0, 0.0, 0.0));
        let reference = Reference::new(&scene(vec![o])).unwrap();
        reference.clearance_within(ray, [0.0, f64::INFINITY], 1e-4)
    };
    for y in [0.0, 0.1, 0.25, 0.299, 0.301, 0.35, 0.45] {
        let found = at(ball(), y, 0.5);
        assert!((found - (y - 0.3)).abs() < 3e-4, "{y}: {found}");
    }
    // The clearance of a ray past the box is at least the distance to the box.
    assert!(at(ball(), 0.7, 0.5) >= 0.2 - 1e-4);
    // A solid cut by the box is at most as deep as the box's face allows.
    let found = at(object(samples::cylinder(0.45, -1.0, 2.0), 0.5), 0.0, 0.98);
    assert!((found + 0.02).abs() < 3e-4, "{found}");
    // Replicas: the half-size ball's cell.
    let mut o = ball();
    o.repeat = [2, 2, 2];
    let found = at(o, 0.25 + 0.1, 0.25);
    assert!((found - (0.2 - 0.3)).abs() < 3e-4, "{found}");
}
