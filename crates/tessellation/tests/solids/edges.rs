//! Every edge belongs to two triangles, also where parts of a solid touch.

use crate::random::Random;
use crate::{object, volume};
use glam::DVec2;
use revmap::profile::{Profile, Segment};
use revmap::scene::Object;
use revmap_tessellation::Triangles;
use std::collections::{HashMap, HashSet};
use std::f64::consts::{PI, TAU};

/// Every edge of a triangle is that of one other, in the other direction, and no triangle has two
/// equal corners. Vertices of one place are one.
pub fn is_watertight(mesh: &Triangles) -> bool {
    faults(mesh) == 0
}

/// Edges of other than two triangles.
fn faults(mesh: &Triangles) -> usize {
    let bits = |k: u32| {
        let place = mesh.vertices[k as usize].position;
        place.map(|v| (v + 0.0).to_bits())
    };
    let mut edges: HashMap<_, [u32; 2]> = HashMap::new();
    for t in mesh.indices.chunks_exact(3) {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (bits(a), bits(b))) {
            // An edge between equal places counts as a fault.
            let count = edges.entry((a.min(b), a.max(b))).or_default();
            count[usize::from(a < b)] += 1;
        }
    }
    edges.values().filter(|count| **count != [1, 1]).count()
}

/// True if some point off the axis is that of two corners.
fn touches(object: &Object) -> bool {
    let mut seen = HashSet::new();
    let mut points = object.profile.outline.segments().map(|s| s.a);
    points.any(|p| p.x > 0.0 && !seen.insert([p.x, p.y].map(f64::to_bits)))
}

/// Volume and surface of a solid of frusta.
fn measures(object: &Object) -> [f64; 2] {
    let parts = object.profile.outline.segments().map(|Segment { a, b }| {
        let volume = PI / 3.0 * (b.y - a.y) * (a.x * a.x + a.x * b.x + b.x * b.x);
        [volume, PI * (a.x + b.x) * a.distance(b)]
    });
    parts.fold([0.0; 2], |sum, part| [0, 1].map(|k| sum[k] + part[k]))
}

fn check(points: &[[f64; 2]], axis: [f64; 2], tolerance: f64, what: &str) {
    let profile = Profile::polygon(points, 2.0).unwrap();
    let object = Object {
        axis,
        ..Object::new("polygon", profile.into())
    };
    let mesh = Triangles::new(&object, tolerance).unwrap();
    assert_eq!(faults(&mesh), 0, "{what}, {tolerance}: {points:?}");
    let [wanted, surface] = measures(&object);
    let off = (volume(&mesh) - wanted).abs();
    assert!(
        off < surface * tolerance,
        "{what}, {tolerance}: {off}, {points:?}"
    );
}

/// Random polygons on a coarse grid, whose corners and edges often meet, and anywhere.
#[test]
fn random_polygons_have_edges_of_two_triangles() {
    let (mut met, mut all) = (0, 0);
    for seed in 0..3000u64 {
        let mut random = Random::of(seed);
        random.next();
        let cells = if seed % 3 == 2 { 1e9 } else { 5.0 };
        let count = 3 + (random.next() * 8.0) as usize;
        let mut place = |size: f64| (random.next() * cells * size).round() / cells * 0.5;
        let points: Vec<[f64; 2]> = (0..count).map(|_| [place(0.9), place(2.0)]).collect();
        if Profile::polygon(&points, 2.0).is_err() {
            continue; // no area
        }
        all += 1;
        met += usize::from(touches(&object(&points)));
        let tolerance = [5e-2, 1e-2, 1e-3, 1e-4, 1e-5][seed as usize % 5];
        let axis = [[0.5; 2], [0.6, 0.45]][seed as usize % 2];
        check(&points, axis, tolerance, &format!("seed {seed}"));
    }
    assert!(all > 2500 && met > 500, "{met} of {all}");
}

/// Two cones that meet in a circle, three parts in one circle, balls, and a bore beside a wall.
#[test]
fn parts_that_touch_are_apart() {
    let bow = [[0.1, 0.0], [0.4, 0.0], [0.1, 1.0], [0.4, 1.0]];
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        check(&bow, [0.5; 2], tolerance, "bow");
    }
    let fan: Vec<[f64; 2]> = (0..3)
        .flat_map(|k| {
            let at = |turn: f64| DVec2::new(0.25, 0.5) + 0.2 * DVec2::from_angle(TAU * turn / 6.0);
            let turn = f64::from(2 * k);
            [[0.25, 0.5], at(turn).into(), at(turn + 1.0).into()]
        })
        .collect();
    let lens = |middle: f64, turn: f64| {
        let at = move |k: u32| turn + TAU * f64::from(k) / 64.0;
        (0..64).map(move |k| [0.3 + 0.1 * at(k).cos(), middle + 0.1 * at(k).sin()])
    };
    let rings: Vec<[f64; 2]> = lens(0.4, 0.25 * TAU)
        .chain(lens(0.6, -0.25 * TAU))
        .collect();
    let hollow = [
        [0.1, 0.1],
        [0.5, 0.1],
        [0.5, 0.5],
        [0.3, 0.2],
        [0.2, 0.2],
        [0.3, 0.4],
        [0.5, 0.5],
        [0.5, 0.9],
        [0.1, 0.9],
    ];
    for (what, points) in [("fan", &fan[..]), ("rings", &rings), ("hollow", &hollow)] {
        assert!(touches(&object(points)), "{what}");
        for tolerance in [1e-2, 1e-3, 1e-4] {
            check(points, [0.5; 2], tolerance, what);
        }
    }
}
