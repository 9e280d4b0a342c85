//! Shells have no gaps: rays at joints of outlines with short edges, thin rims, slots and fins.
//! All is computed in double precision, so that no rounding excuses a lost ray.

use crate::common::rays::{Random, count};
use crate::common::walk::guards;
use glam::{DVec2, DVec3};
use revmap::profile::Profile;
use revmap::scene::Offset;
use revmap::surface::{
    ContourSource, FitOptions, ProxyHull, ProxyHullOptions, QuadricPatch, fit_patches,
};
use std::f64::consts::{PI, TAU};

/// Height beyond floor and ceiling from which on guards admit other sheets of a quadric.
const HEIGHT_SLACK: f64 = 1e-3;

/// Distance by which a ray is moved aside in all directions: only rays that hit the same patch then
/// are tested.
const ASIDE: f64 = 2e-5;

struct Solid {
    patches: Vec<QuadricPatch>,
    hull: ProxyHull,
}

impl Solid {
    /// A polygon's only loop; `None` if it has several.
    fn new(points: &[[f64; 2]], patches_per_cell: u32) -> Option<Self> {
        let profile = Profile::polygon(points, 0.5).ok()?;
        if profile.outline.loops.len() != 1 {
            return None;
        }
        let source = ContourSource::new(&profile.outline).unwrap();
        let contour = source.contour(&Offset::default()).ok()?;
        let patches = fit_patches(&contour, &FitOptions::default());
        let options = ProxyHullOptions {
            patches_per_cell,
            ..ProxyHullOptions::default()
        };
        let hull = ProxyHull::new(&patches, &options);
        Some(Self { patches, hull })
    }

    /// The first hit of a ray, and its patch.
    fn first(&self, o: DVec3, v: DVec3) -> Option<(f64, usize)> {
        let roots =
            (self.patches.iter().enumerate()).filter_map(|(k, p)| Some((root(p, o, v)?, k)));
        roots.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The nearest hit of the fragments of a ray.
    fn fragment(&self, o: DVec3, v: DVec3) -> Option<f64> {
        let n = self.hull.sides as usize;
        let step = |k: usize| DVec2::from_angle(TAU * k as f64 / n as f64);
        let circle: Vec<DVec2> = (0..=n).map(step).collect();
        let mut best: Option<f64> = None;
        for frustum in &self.hull.frusta {
            let corner = |k: usize, [r, z]: [f32; 2]| (circle[k] * f64::from(r)).extend(z.into());
            let entered = (0..n).any(|k| {
                let [a, b] = [k, k + 1].map(|k| corner(k, frustum.from));
                let [c, d] = [k, k + 1].map(|k| corner(k, frustum.to));
                enters(o, v, [a, b, d]) || enters(o, v, [a, d, c])
            });
            if entered {
                let cell = &self.patches[frustum.first as usize..][..frustum.count as usize];
                let hits = cell.iter().filter_map(|p| root(p, o, v));
                best = hits.chain(best).min_by(f64::total_cmp);
            }
        }
        best
    }

    /// Rays at points close to joints, from eyes around: how many hit and how many of these are
    /// lost, with the place of one.
    fn lost(&self, rays: usize, random: &mut Random) -> (usize, usize, String) {
        let (mut hits, mut lost, mut place) = (0, 0, String::new());
        for _ in 0..rays {
            let (sin, cos) = ((random.next() * 2.0 - 1.0) * 1.55).sin_cos();
            let (y, x) = (random.next() * TAU).sin_cos();
            let o = DVec3::new(x * cos, y * cos, sin) * 2.2 + DVec3::Z * 0.5;
            let patch = &self.patches[(random.next() * self.patches.len() as f64) as usize];
            let way = (0.02 * random.next() / patch.start.distance(patch.end)).min(1.0);
            let way = if random.next() < 0.5 { way } else { 1.0 - way };
            let near = patch.start.lerp(patch.end, way);
            let near = near - 3e-4 * patch.gradient(near).normalize();
            let (sin, cos) = (random.next() * TAU).sin_cos();
            let v = (DVec3::new(near.x * cos, near.x * sin, near.y) - o).normalize();
            let flat = DVec2::new(o.truncate().length(), o.z);
            let Some((t, patch)) = self.first(o, v).filter(|_| self.hull.clear_of(flat, 1e-3))
            else {
                continue;
            };
            hits += 1;
            let (a, b) = v.any_orthonormal_pair();
            let steady = || {
                let moved = [a, -a, b, -b].map(|side| self.first(o + ASIDE * side, v));
                moved
                    .into_iter()
                    .all(|hit| hit.is_some_and(|hit| hit.1 == patch))
            };
            if self.fragment(o, v).is_none_or(|found| found > t + 1e-9) && steady() {
                let p = o + v * t;
                lost += 1;
                place = format!("patch {patch} at ({}, {})", p.truncate().length(), p.z);
            }
        }
        (hits, lost, place)
    }
}

/// The `t` at which a ray enters a patch.
fn root(patch: &QuadricPatch, o: DVec3, v: DVec3) -> Option<f64> {
    let [a, k0, k1, k2] = patch.quadric;
    let flat = |p: DVec3, q: DVec3| p.truncate().dot(q.truncate());
    let al = a * flat(v, v) + k2 * v.z * v.z;
    let be = a * flat(o, v) + (0.5 * k1 + k2 * o.z) * v.z;
    let ga = a * flat(o, o) + k0 + o.z * (k1 + k2 * o.z);
    let s = (be * be - al * ga).sqrt();
    let t = if be <= 0.0 {
        ga / (s - be)
    } else {
        -(be + s) / al
    };
    let p = o + v * t;
    let is_hit = t >= 0.0
        && (-HEIGHT_SLACK..=1.0 + HEIGHT_SLACK).contains(&p.z)
        && guards(patch, flat(p, p), p.z);
    is_hit.then_some(t)
}

/// True if a ray passes a triangle against its normal.
fn enters(o: DVec3, v: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    let side = |p: DVec3, q: DVec3| (q - o).cross(p - o).dot(v) >= 0.0;
    normal.dot(v) < 0.0 && normal.dot(a - o) < 0.0 && side(a, b) && side(b, c) && side(c, a)
}

/// A random outline: half a star, a ring, discs, any polygon, a body with slots or one with fins.
/// Some of its corners are cut off by edges of 0.0001 to 0.05.
fn outline(kind: u64, random: &mut Random) -> Vec<[f64; 2]> {
    let mut within = |low: f64, high: f64| low + (high - low) * random.next();
    let n = within(3.0, 9.0) as usize;
    let turn = |k: usize, all: f64| DVec2::from_angle(all * k as f64 / n as f64);
    let mut points: Vec<DVec2> = match kind {
        0 => (0..=n)
            .map(|k| {
                let p = within(0.15, 0.48) * turn(k, PI).rotate(DVec2::NEG_Y);
                let r = if k == 0 || k == n { 0.0 } else { p.x };
                DVec2::new(r, 0.5 + p.y)
            })
            .collect(),
        1 => (0..n)
            .map(|k| DVec2::new(0.26, 0.5) + within(0.05, 0.22) * turn(k, TAU))
            .collect(),
        2 => {
            let mut points = vec![DVec2::new(0.0, 0.04)];
            for k in 0..n {
                let z = 0.04 + 0.9 * k as f64 / n as f64;
                points.push(DVec2::new(within(0.08, 0.46), z));
                points.push(DVec2::new(within(0.08, 0.46), z + 0.9 / n as f64));
            }
            points.push(DVec2::new(0.0, 0.94));
            points
        }
        3 => (0..n.min(6))
            .map(|_| DVec2::new(within(0.0, 0.48), within(0.02, 0.98)))
            .collect(),
        _ => {
            let (bore, tilt) = (within(-0.1, 0.1).max(0.0), within(-0.1, 0.1));
            let (r, low, high) = (within(0.3, 0.45), within(0.1, 0.3), within(0.6, 0.9));
            vec![
                DVec2::new(bore, low),
                DVec2::new(r, low + tilt),
                DVec2::new(r + tilt, high),
                DVec2::new(bore, high + tilt),
            ]
        }
    };
    for _ in 0..if kind >= 4 { 2 } else { 0 } {
        let k = within(0.0, points.len() as f64) as usize;
        let (a, b) = (points[k], points[(k + 1) % points.len()]);
        if a.x + b.x == 0.0 || a.distance(b) < 0.05 {
            continue;
        }
        // Slots go into the solid, fins out of it.
        let depth = within(0.01, 0.1) * if kind == 4 { 1.0 } else { -1.0 };
        let tip = depth * (b - a).perp().normalize() + within(-0.15, 0.15) * (b - a);
        let from = within(0.2, 0.8);
        let to = from + within(-7.0, -3.5).exp() / a.distance(b);
        let [p, q] = [from, to.min(0.95)].map(|part| a.lerp(b, part));
        let sharp = within(0.0, 1.0) < 0.4;
        let added = [p, p + tip, if sharp { p + tip } else { q + tip }, q];
        points.splice(k + 1..k + 1, added.map(|p| p.max(DVec2::ZERO)));
    }
    for _ in 0..if kind < 4 { 3 } else { 1 } {
        let count = points.len();
        let k = within(0.0, count as f64) as usize;
        let (before, here, next) = (
            points[(k + count - 1) % count],
            points[k],
            points[(k + 1) % count],
        );
        if here.x > 0.0 {
            let length = within(1e-4f64.ln(), 0.05f64.ln()).exp();
            let mut towards = |other: DVec2, part: f64| {
                let most = 0.4 * other.distance(here);
                here + (other - here).normalize_or_zero() * length.min(most) * part
            };
            let part = within(0.0, 1.0);
            points.splice(k..=k, [towards(before, part), towards(next, 1.0)]);
        }
    }
    points.into_iter().map(Into::into).collect()
}

/// Random outlines. Of 600, shells without walls at the level of their joints, without the inner rims
/// of ridges, or without their shortest patches lose rays in 4.
#[test]
fn short_edges_lose_no_ray() {
    let mut failures = Vec::new();
    let (mut hits, mut frusta) = (0, 0);
    for seed in 0..count(600) as u64 {
        let mut random = Random(seed * 7919 + 13);
        let points = outline(seed % 6, &mut random);
        if let Some(solid) = Solid::new(&points, 8) {
            let (hit, lost, place) = solid.lost(2000, &mut random);
            hits += hit;
            frusta += solid.hull.frusta.len();
            if lost > 0 {
                failures.push(format!(
                    "{seed}: {lost} of {hit}, one on {place}: {points:?}"
                ));
            }
        }
    }
    println!("{hits} rays, {frusta} frusta");
    assert!(hits > 0 && failures.is_empty(), "{}", failures.join("\n"));
}

/// A rim of 0.016 at the end of a cell that leans outwards as a whole: the rim itself faces up, and
/// rays come over the wall at its upper end.
#[test]
fn a_narrow_rim_at_the_end_of_a_cell_is_enclosed() {
    let points = [
        [0.131933, 0.118276],
        [0.158050, 0.103708],
        [0.397365, 0.034788],
        [0.323659, 0.565625],
        [0.420326, 0.677196],
        [0.412566, 0.690839],
        [0.247981, 0.760700],
        [0.111086, 0.883183],
        [0.067088, 0.862553],
        [0.048068, 0.801923],
        [0.030889, 0.580703],
        [0.033079, 0.557485],
        [0.0, 0.113918],
        [0.155462, 0.356134],
    ];
    for patches_per_cell in [2, 3, 4, 5, 6, 7, 8] {
        let solid = Solid::new(&points, patches_per_cell).unwrap();
        let (hits, lost, place) = solid.lost(count(20_000), &mut Random(1));
        assert!(
            hits > 0 && lost == 0,
            "{patches_per_cell}: {lost} of {hits}, one on {place}"
        );
    }
}
