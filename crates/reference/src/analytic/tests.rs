#![allow(clippy::unwrap_used, clippy::panic)]
//! Compares the two methods on random solids and random rays.

use super::super::random::Random;
use super::super::{Reference, samples, tests};
use super::*;
use glam::DQuat;
use proptest::prelude::*;
use revmap::scene::Placement;

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.between(-size, size)))
    }
}

fn random_scene(dice: &mut Random, offset: Offset) -> Scene {
    let mut o = tests::object(
        samples::random((dice.next() * 1e9) as u64),
        dice.between(0.3, 0.6),
    );
    o.offset = offset;
    if dice.next() < 0.5 {
        o.axis = [dice.next(), dice.next()];
    }
    if dice.next() < 0.7 {
        o.placement = Placement {
            position: dice.vector(3.0),
            rotation: DQuat::from_scaled_axis(dice.vector(3.0)),
            scale: DVec3::new(
                dice.between(0.3, 3.0),
                dice.between(0.3, 3.0),
                dice.between(0.3, 3.0),
            ),
        };
    }
    tests::scene(vec![o])
}

/// A ray that usually hits the box: from afar, from near, from within; sometimes along an axis.
fn random_ray(dice: &mut Random, scene: &Scene) -> Ray {
    let p = &scene.objects[0].placement;
    let world = DAffine3::from_scale_rotation_translation(p.scale, p.rotation, p.position);
    let aim = DVec3::new(
        dice.between(-0.5, 0.5),
        dice.between(-0.5, 0.5),
        dice.next(),
    );
    let distance = [0.3, 1.0, 5.0][(dice.next() * 3.0) as usize];
    let mut from = aim + dice.vector(distance);
    if dice.next() < 0.15 {
        let keep = (dice.next() * 3.0) as usize;
        for k in (0..3).filter(|k| *k != keep) {
            from[k] = aim[k];
        }
    }
    let speed = dice.between(0.2, 3.0);
    Ray {
        origin: world.transform_point3(from),
        direction: world.transform_vector3(aim - from) * speed,
    }
}

#[derive(Default, Debug)]
struct Tally {
    rays: usize,
    hits: usize,
    cuts: usize,
    grazing: usize,
    creases: usize,
    worst: f64,
}

/// Traces by both methods and compares. Grazing rays are counted; all others must agree.
fn agree(
    seed: u64,
    rays: usize,
    offset: Offset,
    tally: &mut Tally,
) -> std::result::Result<(), TestCaseError> {
    let mut dice = Random(seed);
    let scene = random_scene(&mut dice, offset);
    let (one, two) = (
        Analytic::new(&scene).unwrap(),
        Reference::new(&scene).unwrap(),
    );
    for _ in 0..rays {
        let ray = random_ray(&mut dice, &scene);
        let (a, b) = (one.trace(ray), two.trace(ray));
        tally.rays += 1;
        if a.grazes || b.grazes {
            tally.grazing += 1;
            continue;
        }
        let (Some(p), Some(q)) = (a.hit, b.hit) else {
            prop_assert!(a.hit.is_none() && b.hit.is_none(), "{ray:?}\n{a:?}\n{b:?}");
            continue;
        };
        tally.hits += 1;
        tally.cuts += usize::from(matches!(q.surface, Surface::Cut(_)));
        let error = (p.t - q.t).abs() * ray.direction.length();
        tally.worst = tally.worst.max(error);
        prop_assert!(error < 1e-9, "{error}: {ray:?}\n{a:?}\n{b:?}");
        // Both normals of a crease are valid; one ray in a million hits a crease.
        if (p.normal - q.normal).length() > 1e-6 {
            tally.creases += 1;
        }
    }
    Ok(())
}

fn offsets() -> impl Strategy<Value = Offset> {
    let plain = Just(Offset {
        extend: 0.0,
        bevel: 0.0,
        chamfer: 1.0,
    });
    let extended = (-0.1..0.25f64).prop_map(|extend| Offset {
        extend,
        bevel: 0.0,
        chamfer: 1.0,
    });
    let beveled = (-0.1..0.15f64, -0.3..0.8f64).prop_map(|(extend, bevel)| Offset {
        extend,
        bevel,
        chamfer: 1.0,
    });
    let chamfered =
        (-0.1..0.15f64, -0.3..0.8f64, 0.0..1.0f64).prop_map(|(extend, bevel, chamfer)| Offset {
            extend,
            bevel,
            chamfer,
        });
    prop_oneof![plain, extended, beveled, chamfered]
}

proptest! {
    #[test]
    fn the_two_methods_agree(seed in any::<u64>(), offset in offsets()) {
        let mut tally = Tally::default();
        agree(seed, 40, offset, &mut tally)?;
        prop_assert_eq!(tally.creases, 0);
    }
}

#[test]
fn agreement_is_not_bought_by_calling_rays_grazing() {
    let mut tally = Tally::default();
    for seed in 0..120 {
        let k = (seed % 4) as f64;
        let offset = Offset {
            extend: 0.02 * (k - 1.0),
            bevel: 0.2 * k,
            chamfer: 1.0 - 0.25 * k,
        };
        agree(seed, 100, offset, &mut tally).unwrap();
    }
    eprintln!("{tally:?}");
    assert!(tally.hits > tally.rays / 2, "{tally:?}");
    assert!(tally.cuts > tally.rays / 50, "{tally:?}");
    assert!(tally.grazing < tally.rays / 500, "{tally:?}");
}

#[test]
fn what_it_does_not_know_is_refused() {
    let mut o = tests::object(samples::torus(), 0.5);
    o.repeat = [1, 2, 1];
    let error = Analytic::new(&tests::scene(vec![o])).unwrap_err();
    assert_eq!(error.key.as_deref(), Some("object.0"));
}
