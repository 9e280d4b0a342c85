//! The second method: all points at which a ray can enter or leave a solid, by formula; and the
//! comparison of the two methods on random solids and rays.
//!
//! `F = d - w` vanishes only where the nearest part of the outline, a segment's line or a corner,
//! is at distance `|w|`. `w` is linear in `z` (in two pieces with a chamfer), so a segment gives
//! `alpha r + beta z = gamma`, a frustum of a cone. A corner gives `(r - pr)^2 + (z - pz)^2 = w^2`,
//! a conic turned about the axis. Both are polynomials in `t` once `r` is squared away. All roots,
//! sorted, cut the ray into pieces on each of which `F` keeps its sign. The sign in the middle of
//! each piece distinguishes inside from outside. Roots that belong to no surface do no harm.
//!
//! The time grows with the square of the number of segments. Replicas and copies are not supported.

use super::*;
use crate::random::Random;
use glam::{DAffine3, DVec2};
use proptest::prelude::*;
use revmap::profile::Segment;
use revmap::scene::Growth;

/// Pieces of a ray shorter than this, in object units, mark it as grazing.
const SLIVER: f64 = 1e-7;

/// A result of the method: the first hit, with its normal.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    hit: Option<(f64, DVec3)>,
    grazes: bool,
}

/// A curve on which `F` may vanish: `square r^2 + z[0] + z[1] z + z[2] z^2 = linear r`.
struct Curve {
    square: f64,
    z: [f64; 3],
    linear: f64,
}

impl Curve {
    /// Every `x` in `[0, 1]` at which the ray `start + x way` may meet the curve.
    fn meet(self, start: DVec3, way: DVec3) -> Vec<f64> {
        let Self { square, z, linear } = self;
        let (p, v) = (start.truncate(), way.truncate());
        let r2 = [p.dot(p), 2.0 * p.dot(v), v.dot(v)];
        // l(x) = linear r, and its square, a polynomial.
        let l = [
            square * r2[0] + z[0] + (z[1] + z[2] * start.z) * start.z,
            square * r2[1] + (z[1] + 2.0 * z[2] * start.z) * way.z,
            square * r2[2] + z[2] * way.z * way.z,
        ];
        let k = linear * linear;
        let roots = in_unit_interval(&[
            l[0] * l[0] - k * r2[0],
            2.0 * l[0] * l[1] - k * r2[1],
            2.0 * l[0] * l[2] + l[1] * l[1] - k * r2[2],
            2.0 * l[1] * l[2],
            l[2] * l[2],
        ]);
        // The square has nearly double roots where the curve itself has single ones.
        let curve = |x: f64| {
            let r = (start + way * x).truncate().length();
            let (slope, radial) = (l[1] + 2.0 * x * l[2], linear * (0.5 * r2[1] + x * r2[2]));
            let slope = slope - if radial == 0.0 { 0.0 } else { radial / r };
            (l[0] + x * (l[1] + x * l[2]) - linear * r, slope)
        };
        roots.into_iter().map(|x| polish(x, 1e-3, curve)).collect()
    }
}

/// A few Newton steps on the function itself, given as `(value, slope)`. Each step must reduce the
/// value, and the result must stay near the start.
fn polish(start: f64, reach: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = start;
    let (mut value, mut slope) = f(x);
    for _ in 0..6 {
        let next = x - value / slope;
        let (v, s) = f(next);
        if v.is_nan() || v.abs() >= value.abs() || (next - start).abs() > reach {
            break;
        }
        (x, value, slope) = (next, v, s);
    }
    x
}

/// Candidates for the roots of a polynomial in `[0, 1]`: every root with a change of sign, exact to
/// rounding, and every turning point (which may hide a pair of roots). Coefficients from the
/// constant upwards.
fn in_unit_interval(coefficients: &[f64]) -> Vec<f64> {
    let Some(degree @ 1..) = coefficients.iter().rposition(|c| *c != 0.0) else {
        return Vec::new();
    };
    let derivative: Vec<f64> = (1..=degree).map(|k| coefficients[k] * k as f64).collect();
    let mut stops = in_unit_interval(&derivative);
    let mut roots = stops.clone();
    stops.push(1.0);
    stops.sort_by(f64::total_cmp);
    let value = |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let mut low = 0.0;
    for high in stops {
        // The polynomial is monotonic between turning points: one root at most.
        let is_below = |x: f64| value(x) < 0.0;
        if is_below(low) != is_below(high) {
            roots.push(bisect(is_below, low, high));
        }
        low = high;
    }
    roots
}

/// The place at which a condition changes.
fn bisect(holds: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    let at_first = holds(low);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        *(if holds(middle) == at_first {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
}

/// Every curve on which `F` may vanish.
fn curves(object: &Object) -> Vec<Curve> {
    let Offset {
        extend,
        bevel,
        chamfer,
    } = object.offset;
    // `w = start + slope z` above and below the chamfer's depth.
    let pieces = [[extend + bevel, -bevel], [extend + bevel * chamfer, 0.0]];
    let mut all = Vec::new();
    for Segment { a, b } in object.profile.outline.segments() {
        let along = (b - a).normalize_or_zero();
        let normal = DVec2::new(along.y, -along.x);
        for &[start, slope] in &pieces[..1 + usize::from(bevel != 0.0)] {
            all.extend([1.0, -1.0].map(|side| Curve {
                square: 0.0,
                z: [normal.dot(a) + side * start, side * slope - normal.y, 0.0],
                linear: normal.x,
            }));
            if [start, slope] != [0.0; 2] {
                all.push(Curve {
                    square: 1.0,
                    z: [
                        a.dot(a) - start * start,
                        -2.0 * (a.y + start * slope),
                        1.0 - slope * slope,
                    ],
                    linear: 2.0 * a.x,
                });
            }
        }
    }
    all
}

/// The first hit of a ray with the one object of a scene.
fn trace(object: &Object, ray: Ray) -> Found {
    let p = object.placement;
    let world = DAffine3::from_scale_rotation_translation(p.scale, p.rotation, p.position);
    let inverse = world.inverse();
    let direction = inverse.transform_vector3(ray.direction);
    let mut found = trace_local(object, inverse.transform_point3(ray.origin), direction);
    if let Some((_, normal)) = &mut found.hit {
        *normal = (inverse.matrix3.transpose() * *normal).normalize_or_zero();
    }
    found
}

fn trace_local(object: &Object, origin: DVec3, direction: DVec3) -> Found {
    let (radius, growth) = (object.profile.radius, Growth::of(object));
    let side = radius + growth.side;
    let low = DVec3::new(-side, -side, -growth.low);
    let high = DVec3::new(side, side, 1.0 + growth.high);
    let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
    for axis in 0..3 {
        let [a, b] = [low, high].map(|wall| (wall[axis] - origin[axis]) / direction[axis]);
        if a.min(b) > enter.0 {
            enter = (a.min(b), axis);
        }
        if a.max(b) < leave.0 {
            leave = (a.max(b), axis);
        }
    }
    let mut found = Found::default();
    let first = enter.0.max(0.0);
    if leave.0 <= first {
        return found;
    }
    let axis = DVec2::from(object.axis) * (2.0 * radius) - DVec2::splat(radius);
    let start = origin + direction * first - axis.extend(0.0);
    let way = direction * (leave.0 - first);
    let mut stops: Vec<f64> = curves(object)
        .into_iter()
        .flat_map(|curve| curve.meet(start, way))
        .filter(|x| *x > 0.0 && *x < 1.0)
        .collect();
    stops.push(1.0);
    stops.sort_by(f64::total_cmp);

    let value = |p: DVec3| {
        let q = DVec2::new(p.truncate().length(), p.z);
        let offset = &object.offset;
        let w = offset.extend + offset.bevel * (1.0 - q.y).min(offset.chamfer);
        object.profile.outline.signed_distance(q) - w
    };
    let is_solid = |x: f64| value(start + way * x) <= 0.0;
    // The outward normal points against a ray that enters, and along one that leaves.
    let face = |axis: usize, side: f64| side * DVec3::AXES[axis] * direction[axis].signum();
    let t = |x: f64| first + x * (leave.0 - first);
    let mut was_solid = (enter.0 > 0.0).then_some(false);
    let (mut from, mut before) = (0.0, 0.0);
    for to in stops {
        let (length, middle) = ((to - from) * way.length(), 0.5 * (from + to));
        // A double root gives one stop.
        if length < 1e-13 && to < 1.0 && from > 0.0 {
            continue;
        }
        let solid = is_solid(middle);
        if was_solid.is_some_and(|was| was != solid) {
            found.grazes = length < SLIVER;
            if from == 0.0 {
                found.hit = Some((t(0.0), face(enter.1, -1.0)));
                return found;
            }
            let x = bisect(is_solid, before, middle);
            let (p, step) = (start + way * x, 1e-7);
            let slope = |axis| value(p + step * axis) - value(p - step * axis);
            let gradient = DVec3::from(DVec3::AXES.map(slope)) / (2.0 * step);
            found.hit = Some((t(x), gradient));
            return found;
        }
        was_solid = Some(solid);
        (from, before) = (to, middle);
    }
    if was_solid == Some(true) {
        found.hit = Some((t(1.0), face(leave.1, 1.0)));
    }
    found
}

impl Random {
    fn vector(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.between(low, high)))
    }
}

fn random_object(dice: &mut Random, offset: Offset) -> Object {
    let outline = samples::random((dice.next() * 1e9) as u64);
    let mut o = object(outline, dice.between(0.3, 0.6));
    o.offset = offset;
    if dice.next() < 0.5 {
        o.axis = [dice.next(), dice.next()];
    }
    if dice.next() < 0.7 {
        o.placement = Placement {
            position: dice.vector(-3.0, 3.0),
            rotation: DQuat::from_scaled_axis(dice.vector(-3.0, 3.0)),
            scale: dice.vector(0.3, 3.0),
        };
    }
    o
}

/// A ray that usually hits the box: from afar, from near, from within; sometimes along an axis.
fn random_ray(dice: &mut Random, object: &Object) -> Ray {
    let p = &object.placement;
    let world = DAffine3::from_scale_rotation_translation(p.scale, p.rotation, p.position);
    let aim = dice.vector(-0.5, 0.5) + 0.5 * DVec3::Z;
    let distance = [0.3, 1.0, 5.0][(dice.next() * 3.0) as usize];
    let mut from = aim + dice.vector(-distance, distance);
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
    let object = random_object(&mut dice, offset);
    let reference = Reference::new(&scene(vec![object.clone()])).unwrap();
    for _ in 0..rays {
        let ray = random_ray(&mut dice, &object);
        let (a, b) = (trace(&object, ray), reference.trace(ray));
        tally.rays += 1;
        if a.grazes || b.grazes {
            tally.grazing += 1;
            continue;
        }
        let (Some((t, normal)), Some(hit)) = (a.hit, b.hit) else {
            prop_assert!(a.hit.is_none() && b.hit.is_none(), "{ray:?}\n{a:?}\n{b:?}");
            continue;
        };
        tally.hits += 1;
        tally.cuts += usize::from(matches!(hit.surface, Surface::Cut(_)));
        let error = (t - hit.t).abs() * ray.direction.length();
        tally.worst = tally.worst.max(error);
        prop_assert!(error < 1e-9, "{error}: {ray:?}\n{a:?}\n{b:?}");
        // Both normals of a crease are valid; one ray in a million hits a crease.
        tally.creases += usize::from((normal - hit.normal).length() > 1e-6);
    }
    Ok(())
}

fn offsets() -> impl Strategy<Value = Offset> {
    let offset = |extend, bevel, chamfer| Offset {
        extend,
        bevel,
        chamfer,
    };
    prop_oneof![
        Just(offset(0.0, 0.0, 1.0)),
        (-0.1..0.25f64).prop_map(move |extend| offset(extend, 0.0, 1.0)),
        (-0.1..0.15f64, -0.3..0.8f64).prop_map(move |(extend, bevel)| offset(extend, bevel, 1.0)),
        (-0.1..0.15f64, -0.3..0.8f64, 0.0..1.0f64)
            .prop_map(move |(extend, bevel, chamfer)| offset(extend, bevel, chamfer)),
    ]
}

proptest! {
    #[test]
    fn the_two_methods_agree(seed in any::<u64>(), offset in offsets()) {
        let mut tally = Tally::default();
        agree(seed, 40, offset, &mut tally)?;
        prop_assert_eq!(tally.creases, 0);
    }

    #[test]
    fn planted_roots_are_found(roots in proptest::collection::vec(0.01..0.99f64, 1..5)) {
        let mut sorted = roots.clone();
        sorted.sort_by(f64::total_cmp);
        prop_assume!(sorted.windows(2).all(|p| p[1] - p[0] > 0.02));
        let mut coefficients = vec![1.0];
        for r in &roots {
            let shifted: Vec<f64> = std::iter::once(0.0).chain(coefficients.clone()).collect();
            coefficients.push(0.0);
            coefficients = coefficients.iter().zip(shifted).map(|(c, s)| s - r * c).collect();
        }
        let found = in_unit_interval(&coefficients);
        for r in &roots {
            prop_assert!(found.iter().any(|f| (f - r).abs() < 1e-9), "{r} of {roots:?} not in {found:?}");
        }
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
