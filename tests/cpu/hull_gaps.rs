//! Shells have no gaps: rays at joints of outlines with short edges, thin rims, slots and fins.
//! All is computed in double precision, so that no rounding excuses a lost ray.

use crate::common::outlines::outline;
use crate::common::rays::{Random, count, enters_frustum, eye_around, guards, hull};
use glam::{DVec2, DVec3};
use revmap::profile::Profile;
use revmap::scene::Offset;
use revmap::surface::{ContourSource, FitOptions, Frustum, ProxyHull, QuadricPatch, fit_patches};
use std::f64::consts::TAU;

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
        let hull = hull(&patches, patches_per_cell);
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
        let entered = |f: &&Frustum| enters_frustum(f, self.hull.sides, o, v);
        let cell = |f: &Frustum| &self.patches[f.first as usize..][..f.count as usize];
        let cells = self.hull.frusta.iter().filter(entered).map(cell);
        let hits = cells.flatten().filter_map(|p| root(p, o, v));
        hits.min_by(f64::total_cmp)
    }

    /// Rays at points close to joints, from eyes around: how many hit and how many of these are
    /// lost, with the place of one.
    fn lost(&self, rays: usize, random: &mut Random) -> (usize, usize, String) {
        let (mut hits, mut lost, mut place) = (0, 0, String::new());
        for _ in 0..rays {
            let o = eye_around(random, 1.55);
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

/// Random outlines. Of 600, shells without walls at the level of their joints, without the inner rims
/// of ridges, or without their shortest patches lose rays in 4.
#[test]
fn short_edges_lose_no_ray() {
    let mut failures = Vec::new();
    let (mut hits, mut frusta) = (0, 0);
    for seed in 0..count(600) as u64 {
        let mut random = Random(seed * 7919 + 13);
        let points = outline(seed % 6, &mut || random.next());
        if let Some(solid) = Solid::new(&points, 8) {
            let (hit, lost, place) = solid.lost(1000, &mut random);
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

/// A flat underside around a narrow hollow, 30 to 1,000 times as wide as high: it ends at the hollow's
/// edge, so that rays into the hollow meet the wall behind. With 128 bands for a flat segment it
/// reached up to 0.035 past the edge.
#[test]
fn a_wide_underside_ends_at_its_hollow() {
    for width in [30.0, 100.0, 300.0, 1000.0] {
        let points = [[width, 0.1], [0.2, 0.5], [0.0, 0.9]];
        let solid = Solid::new(&points, 8).unwrap();
        let (eye, mut random) = (DVec3::new(-3.0, 4.4, -2.3), Random(3));
        for _ in 0..count(5000) {
            let (r, (sin, cos)) = (
                0.19995 * random.next().sqrt(),
                (random.next() * TAU).sin_cos(),
            );
            let at = DVec3::new(r * cos, r * sin, 0.5);
            let hit = solid.first(eye, (at - eye).normalize());
            let z = hit.map(|(t, _)| (eye + t * (at - eye).normalize()).z);
            assert!(
                z.is_some_and(|z| z > 0.50001),
                "{width}: {z:?} through {at}"
            );
        }
    }
}
