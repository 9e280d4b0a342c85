//! Hulls on the CPU, ray by ray: shells have no gaps, and nothing that they leave out is visible.
//! All is computed in double precision, so that no rounding excuses a lost ray.

use crate::common::outlines::outline;
use crate::common::rays::{Random, count, enters_frustum, eye_around, guards, hull, profiles};
use crate::common::shapes;
use glam::{DVec2, DVec3};
use revmap::profile::{Outline, Profile};
use revmap::scene::Offset;
use revmap::surface::{ContourSource, FitOptions, Frustum, ProxyHull, QuadricPatch, fit_patches};
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

/// A ray: its origin and its unit direction.
type Ray = (DVec3, DVec3);

impl Solid {
    /// `None` if the contour does not close.
    fn new(outline: &Outline, offset: &Offset, patches_per_cell: u32) -> Option<Self> {
        let contour = ContourSource::new(outline).unwrap().contour(offset).ok()?;
        let patches = fit_patches(&contour, &FitOptions::default());
        let hull = hull(&patches, patches_per_cell);
        Some(Self { patches, hull })
    }

    /// A polygon without an offset.
    fn of(points: &[[f64; 2]], patches_per_cell: u32) -> Self {
        let profile = Profile::polygon(points, 0.5).unwrap();
        Self::new(&profile.outline, &Offset::default(), patches_per_cell).unwrap()
    }

    /// The first hit of a ray, and its patch.
    fn first(&self, (o, v): Ray) -> Option<(f64, usize)> {
        let roots =
            (self.patches.iter().enumerate()).filter_map(|(k, p)| Some((root(p, o, v)?, k)));
        roots.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The nearest hit of the fragments of a ray.
    fn fragment(&self, (o, v): Ray) -> Option<f64> {
        let entered = |f: &&Frustum| enters_frustum(f, self.hull.sides, o, v);
        let cell = |f: &Frustum| &self.patches[f.first as usize..][..f.count as usize];
        let cells = self.hull.frusta.iter().filter(entered).map(cell);
        let hits = cells.flatten().filter_map(|p| root(p, o, v));
        hits.min_by(f64::total_cmp)
    }

    /// True if the fragments of a ray lose its hit; `None` without a hit, and from within the
    /// shells.
    fn loses(&self, (o, v): Ray) -> Option<bool> {
        let flat = DVec2::new(o.truncate().length(), o.z);
        let (t, patch) = self
            .first((o, v))
            .filter(|_| self.hull.clear_of(flat, 1e-3))?;
        let (a, b) = v.any_orthonormal_pair();
        let same = |side: DVec3| self.first((o + ASIDE * side, v)).map(|hit| hit.1) == Some(patch);
        let found = self.fragment((o, v));
        Some(found.is_none_or(|found| found > t + 1e-9) && [a, -a, b, -b].into_iter().all(same))
    }

    /// How many rays hit and how many of these are lost, with one of them.
    fn lost(&self, rays: impl Iterator<Item = Ray>) -> (usize, usize, String) {
        let (mut hits, mut lost, mut one) = (0, 0, String::new());
        for ray in rays {
            let Some(is_lost) = self.loses(ray) else {
                continue;
            };
            hits += 1;
            if is_lost {
                lost += 1;
                one = format!("{ray:?}");
            }
        }
        (hits, lost, one)
    }

    /// Rays at points close to joints, from eyes around.
    fn at_joints(&self, rays: usize, random: &mut Random) -> impl Iterator<Item = Ray> {
        (0..rays).map(move |_| {
            let o = eye_around(random, 1.55);
            let patch = &self.patches[random.below(self.patches.len())];
            let way = (0.02 * random.next() / patch.start.distance(patch.end)).min(1.0);
            let way = if random.chance(0.5) { way } else { 1.0 - way };
            let near = patch.start.lerp(patch.end, way);
            let near = near - 3e-4 * patch.gradient(near).normalize();
            let (sin, cos) = (random.next() * TAU).sin_cos();
            let at = DVec3::new(near.x * cos, near.x * sin, near.y);
            (o, (at - o).normalize())
        })
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

/// Rays at solids from all around.
#[test]
fn hulls_lose_no_ray() {
    for (extend, bevel, chamfer) in [(0.0, 0.0, 1.0), (0.02, 0.0, 1.0), (-0.02, 0.06, 0.7)] {
        let offset = shapes::offset(extend, bevel, chamfer);
        for (name, profile) in profiles() {
            for patches_per_cell in [1, 3] {
                let solid = Solid::new(&profile.outline, &offset, patches_per_cell).unwrap();
                let mut random = Random(11);
                let rays = (0..count(600)).map(|_| {
                    let origin = eye_around(&mut random, 1.55);
                    let [x, y, z] = [random.next(), random.next(), random.next()];
                    let direction = DVec3::new(x - 0.5, y - 0.5, z) - origin;
                    (origin, direction.normalize())
                });
                let (hits, lost, one) = solid.lost(rays);
                let what =
                    format!("{name}, {offset:?}, {patches_per_cell}: {lost} of {hits}, {one}");
                assert!(hits > 50 && lost == 0, "{what}");
            }
        }
    }
}

/// Random outlines with short edges, thin rims, slots and fins. Of 600, shells without walls at the
/// level of their joints, without the inner rims of ridges, or without their shortest patches lose
/// rays in 4.
#[test]
fn short_edges_lose_no_ray() {
    let mut failures = Vec::new();
    let (mut hits, mut frusta) = (0, 0);
    for seed in 0..count(600) as u64 {
        let mut random = Random(seed * 7919 + 13);
        let points = outline(seed % 6, &mut random);
        let profile = Profile::polygon(&points, 0.5).ok();
        let solid = profile
            .filter(|profile| profile.outline.loops.len() == 1)
            .and_then(|profile| Solid::new(&profile.outline, &Offset::default(), 8));
        if let Some(solid) = solid {
            let (hit, lost, one) = solid.lost(solid.at_joints(1000, &mut random));
            hits += hit;
            frusta += solid.hull.frusta.len();
            if lost > 0 {
                failures.push(format!("{seed}: {lost} of {hit}, {one}: {points:?}"));
            }
        }
    }
    println!("{hits} rays, {frusta} frusta");
    assert!(hits > 0 && failures.is_empty(), "{}", failures.join("\n"));
}

/// Thin ledges and rims at the ends of cells.
#[test]
fn rims_and_ledges_lose_no_ray() {
    let ledge = vec![
        [0.10070874609126598, 0.94],
        [0.0, 0.94],
        [0.37670857681604786, 0.04],
        [0.45789064347860303, 0.34],
        [0.41723172148963583, 0.34],
        [0.41723172148963583, 0.49],
        [0.41801724761820014, 0.49],
        [0.14881301676183442, 0.79],
        [0.4077006168065225, 0.79],
    ];
    // The mirror image: the ledge faces up and is seen from below.
    let below = ledge.iter().rev().map(|[r, z]| [*r, 1.0 - z]).collect();
    let rim = vec![
        [0.42037396931714804, 0.8300237391211497],
        [0.07970580923790756, 0.6460095492224637],
        [0.09885382536848282, 0.3483777493886423],
        [0.16564666791459592, 0.4096639095138618],
    ];
    let turned = rim.iter().rev().map(|[r, z]| [*r, 1.0 - z]).collect();
    // The inner wall of a ring above an equally thin ledge.
    let hole = vec![
        [0.2, 0.2],
        [0.45, 0.2],
        [0.45, 0.8],
        [0.3, 0.8],
        [0.3, 0.5],
        [0.2992, 0.5],
    ];
    // A rim of 0.016 at the end of a cell that leans outwards as a whole: the rim itself faces up,
    // and rays come over the wall at its upper end.
    let narrow = vec![
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
    // The chamfer above the rim of an underside is shorter than the margin of frusta.
    let chamfer = vec![
        [0.1, 0.49],
        [0.28, 0.49],
        [0.38253591159320594, 0.64],
        [0.4445125608591141, 0.64],
        [0.44444763471024945, 0.6400668390194846],
        [0.274956735871248, 0.79],
    ];
    for (name, points) in [
        ("ledge", ledge),
        ("below", below),
        ("rim", rim),
        ("turned", turned),
        ("hole", hole),
        ("narrow rim", narrow),
        ("short chamfer", chamfer),
    ] {
        for patches_per_cell in 2..=8 {
            let solid = Solid::of(&points, patches_per_cell);
            let (hits, lost, one) = solid.lost(solid.at_joints(count(6000), &mut Random(1)));
            let what =
                format!("{name}, {patches_per_cell} patches a cell: {lost} of {hits}, {one}");
            assert!(hits > 1000 && lost == 0, "{what}");
        }
    }
}

/// Some rasterisers round corners to a sixteenth of a pixel. The flat sides of a record reach 0.0002 of
/// their radius past their rims: that much, where its diameter is 600 pixels.
#[test]
fn flat_sides_of_wide_solids_reach_past_their_rims() {
    let record = [
        [1.8, 0.1],
        [25.0, 0.1],
        [25.5, 0.25],
        [73.0, 0.25],
        [75.0, 0.2],
        [75.0, 0.8],
        [73.0, 0.75],
        [25.5, 0.75],
        [25.0, 0.9],
        [1.8, 0.9],
    ];
    let solid = Solid::of(&record, 8);
    let patches = (0u32..).zip(&solid.patches);
    let level = patches.filter(|(_, patch)| patch.start.y == patch.end.y);
    let mut compared = 0;
    for (n, patch) in level {
        let own = (solid.hull.frusta.iter()).filter(|f| (f.first, f.count) == (n, 1));
        let radii: Vec<f64> = own
            .flat_map(|f| [f.from[0], f.to[0]].map(f64::from))
            .collect();
        if radii.is_empty() {
            continue;
        }
        compared += 1;
        let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
        let most = radii.iter().copied().fold(0.0, f64::max) * (PI / 12.0).cos();
        let rims = [
            patch.start.x.min(patch.end.x),
            patch.start.x.max(patch.end.x),
        ];
        assert!(least < rims[0] * (1.0 - 1.9e-4), "{patch:?}: {least}");
        assert!(most > rims[1] * (1.0 + 1.9e-4), "{patch:?}: {most}");
    }
    assert!(compared >= 2, "{compared}");
}

/// Vessels and rings, whose inside may be visible: `r z` of each corner.
const VESSELS: [(&str, &str); 5] = [
    // A round flask with a narrow neck.
    (
        "flask",
        "0 0.02, 0.3 0.05, 0.4 0.25, 0.3 0.5, 0.08 0.7, 0.08 0.95, 0.06 0.95, 0.06 0.68, 0.28 0.47, \
         0.37 0.25, 0.28 0.08, 0 0.05",
    ),
    // A bowl with a ledge that hangs inwards, and a step.
    (
        "ledges",
        "0 0, 0.4 0, 0.4 0.9, 0.2 0.9, 0.2 0.8, 0.35 0.8, 0.35 0.5, 0.25 0.5, 0.25 0.1, 0 0.1",
    ),
    // Open at both ends, with a waist.
    ("pipe", "0.35 0, 0.4 0, 0.15 0.5, 0.4 1, 0.35 1, 0.1 0.5"),
    // A bell: its hollow opens downwards.
    (
        "bell",
        "0.4 0, 0.42 0.02, 0.2 0.9, 0 0.95, 0 0.85, 0.16 0.8",
    ),
    // A solid without a hollow hides nothing.
    ("cone", "0 0.1, 0.4 0.1, 0 0.9"),
];

/// Points of cells that a hull leaves out for an eye: something nearer to the eye hides every one.
#[test]
fn what_a_hull_leaves_out_no_ray_meets() {
    let mut random = Random(5);
    let number = |text: &str| text.parse::<f64>().unwrap();
    let corner = |text: &str| {
        let (r, z) = text.split_once(' ').unwrap();
        [number(r), number(z)]
    };
    let vessel = |points: &str| {
        let points: Vec<_> = points.split(", ").map(corner).collect();
        Profile::polygon(&points, 0.5).unwrap()
    };
    let mut profiles = VESSELS
        .map(|(name, points)| (name, vessel(points)))
        .to_vec();
    profiles.extend([("torus", shapes::torus()), ("glass", shapes::glass())]);
    for (name, profile) in profiles {
        // Small cells: as many as possible are within the hollow.
        let solid = Solid::new(&profile.outline, &Offset::default(), 1).unwrap();
        let hull = &solid.hull;
        let (mut left_out, mut rays) = (0, 0);
        for _ in 0..60 {
            let (sin, cos) = ((random.next() * 2.0 - 1.0) * 1.57).sin_cos();
            let far = 0.6 + 3.0 * random.next();
            let eye = DVec3::new(far * cos, 0.0, 0.5 + far * sin);
            let flat = DVec2::new(eye.x.abs(), eye.z);
            let seen = hull.seen_from(&[flat]);
            let number_of = |band: usize| u32::try_from(band).unwrap();
            for (k, band) in hull.frusta.iter().enumerate() {
                if seen.iter().any(|run| run.contains(&number_of(k))) {
                    continue;
                }
                left_out += 1;
                let patch = &solid.patches[band.first as usize];
                for _ in 0..4 {
                    let part = random.next();
                    let z = patch.start.y + part * (patch.end.y - patch.start.y);
                    let r = if patch.is_plane() {
                        patch.start.x + part * (patch.end.x - patch.start.x)
                    } else {
                        patch.square_at(z).max(0.0).sqrt()
                    };
                    let (y, x) = (random.next() * 6.3).sin_cos();
                    let way = DVec3::new(r * x, r * y, z) - eye;
                    let hit = solid.first((eye, way.normalize()));
                    let hidden = hit.is_some_and(|(t, _)| t < way.length() - 1e-4);
                    assert!(hidden, "{name}: from {eye} the point ({r}, {z}) is seen");
                    rays += 1;
                }
            }
        }
        println!("{name}: {left_out} bands left out, {rays} rays");
        assert_eq!(left_out > 0, name != "cone", "{name}");
    }
}
