//! Hulls on the CPU, ray by ray: every hit is in a cell whose triangles the ray enters, and nothing
//! that hulls leave out is visible.

use crate::common::rays::{self, Random, count, enters_frustum, eye_around, profiles};
use crate::common::shapes;
use glam::{DVec2, DVec3};
use revmap::cast::RayCaster;
use revmap::profile::{Outline, Profile};
use revmap::scene::{Clip, Object, Offset};
use revmap::surface::{ContourSource, FitOptions, Frustum, ProxyHull, QuadricPatch, fit_patches};

/// A solid's boundary, for rays and for hulls.
struct Boundary {
    patches: Vec<QuadricPatch>,
    caster: RayCaster,
}

impl Boundary {
    fn new(outline: &Outline, offset: &Offset) -> Self {
        let source = ContourSource::new(outline).unwrap();
        // A radius of 2 is wider than the solid: the hull has no side faces.
        let object = Object {
            offset: *offset,
            clip: Clip::Box,
            ..Object::new("solid", Profile::new(outline.clone(), 2.0).into())
        };
        Self {
            patches: fit_patches(&source.contour(offset).unwrap(), &FitOptions::default()),
            caster: RayCaster::new(&object).unwrap(),
        }
    }

    fn hull(&self, patches_per_cell: u32) -> ProxyHull {
        rays::hull(&self.patches, patches_per_cell)
    }

    /// `None` if a ray hits nothing, else whether it enters a triangle of the hit's cell.
    fn is_covered(&self, hull: &ProxyHull, origin: DVec3, direction: DVec3) -> Option<bool> {
        let hit = self.caster.cast(origin, direction)?;
        let point = origin + hit.t * direction;
        let (r, z) = (point.truncate().length(), point.z);
        let holds = |frustum: &&Frustum| {
            let first = frustum.first as usize;
            let cell = &self.patches[first..first + frustum.count as usize];
            cell.iter().any(|patch| is_on(patch, DVec2::new(r, z)))
        };
        let mut cells = hull.frusta.iter().filter(holds);
        Some(cells.any(|frustum| enters_frustum(frustum, hull.sides, origin, direction)))
    }
}

/// Returns true if a point of the half-plane is on a patch, up to rounding.
fn is_on(patch: &QuadricPatch, p: DVec2) -> bool {
    let ([a, k0, k1, k2], [cz, cr, low, high]) = (patch.quadric, patch.guard);
    let value = a * p.x * p.x + k0 + p.y * (k1 + p.y * k2);
    let (place, slack) = (cz * p.y + cr * p.x * p.x, 1e-6 * (cz.abs() + cr.abs()));
    value.abs() < 1e-5 * patch.gradient(p).length() && (low - slack..=high + slack).contains(&place)
}

/// Asserts that at most one hit in a thousand is lost: rounding decides at silhouettes.
#[track_caller]
fn assert_covered(what: &str, covered: impl Iterator<Item = Option<bool>>) {
    let hits: Vec<bool> = covered.flatten().collect();
    let lost = hits.iter().filter(|covered| !**covered).count();
    assert!(
        hits.len() > 50 && lost <= 1 + hits.len() / 1000,
        "{what}: {lost} of {}",
        hits.len()
    );
}

/// Cells lose no ray that hits the solid.
#[test]
fn hulls_lose_no_ray() {
    let count = count(600);
    for (extend, bevel, chamfer) in [(0.0, 0.0, 1.0), (0.02, 0.0, 1.0), (-0.02, 0.06, 0.7)] {
        let offset = shapes::offset(extend, bevel, chamfer);
        for (name, profile) in profiles() {
            let boundary = Boundary::new(&profile.outline, &offset);
            for tests in [1, 3] {
                let (hull, mut random) = (boundary.hull(tests), Random(11));
                let covered = (0..count).map(|_| {
                    let origin = eye_around(&mut random, 1.55);
                    let [x, y, z] = [random.next(), random.next(), random.next()];
                    let direction = DVec3::new(x - 0.5, y - 0.5, z) - origin;
                    boundary.is_covered(&hull, origin, direction.normalize())
                });
                assert_covered(&format!("{name}, {offset:?}, {tests}"), covered);
            }
        }
    }
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
        let boundary = Boundary::new(&profile.outline, &Offset::default());
        // Small cells: as many as possible are within the hollow.
        let hull = boundary.hull(1);
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
                let patch = &boundary.patches[band.first as usize];
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
                    let hit = boundary.caster.cast(eye, way.normalize());
                    let hidden = hit.is_some_and(|hit| hit.t < way.length() - 1e-4);
                    assert!(hidden, "{name}: from {eye} the point ({r}, {z}) is seen");
                    rays += 1;
                }
            }
        }
        println!("{name}: {left_out} bands left out, {rays} rays");
        assert_eq!(left_out > 0, name != "cone", "{name}");
    }
}

/// Rays at the surroundings of a joint: a thin ledge at a cell's end, a rim whose outer flank is
/// wrapped by one frustum.
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
    for (name, points) in [
        ("ledge", ledge),
        ("below", below),
        ("rim", rim),
        ("turned", turned),
        ("hole", hole),
    ] {
        let outline = Outline {
            loops: vec![points.into_iter().map(DVec2::from).collect()],
        };
        let boundary = Boundary::new(&outline, &Offset::default());
        let patches = &boundary.patches;
        let mut random = Random(5);
        for tests in [2, 3, 4, 5, 8] {
            let hull = boundary.hull(tests);
            let covered = (0..count(3000)).map(|_| {
                let origin = eye_around(&mut random, 1.55);
                // A point within a hundredth of a joint, a quarter of a texel under the surface. A
                // ray at the surface itself may be at a silhouette.
                let patch = &patches[(random.next() * patches.len() as f64) as usize];
                let way = 0.01 * random.next() / patch.start.distance(patch.end);
                let place = patch.start.lerp(patch.end, way.min(1.0));
                let place = place - 5e-4 * patch.gradient(place).normalize();
                let (sine, cosine) = (random.next() * 6.3).sin_cos();
                let target = DVec3::new(place.x * cosine, place.x * sine, place.y);
                boundary.is_covered(&hull, origin, (target - origin).normalize())
            });
            assert_covered(&format!("{name}, {tests} patches a cell"), covered);
        }
    }
}
