#![allow(clippy::unwrap_used)]
use super::super::tests::{CUP, contour, is_closed, ring, triangles};
use super::*;
use glam::{DVec2, DVec3, Vec3};
use revmap::profile::{Profile, Segment};
use revmap::scene::{Camera, CameraFrame, GrownProfiles, Offset, Scene};
use revmap::surface::ContourSource;
use revmap_compare::TruePicture;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::Arc;

const SIZE: (u32, u32) = (320, 240);

fn sphere() -> Vec<[f64; 2]> {
    let point = |k: u32| {
        let (sin, cos) = (PI * f64::from(k) / 128.0).sin_cos();
        [0.45 * sin, 0.5 - 0.45 * cos]
    };
    (0..=128).map(point).collect()
}

/// A foot, a waist with beads, a wide bowl, and a hollow.
fn goblet() -> Vec<[f64; 2]> {
    let outside = |k: u32| {
        let z = f64::from(k) / 200.0;
        let bowl = 0.16 * (1.0 + (6.0 * (z - 0.75)).tanh());
        let foot = 0.3 * (-30.0 * z).exp();
        [0.06 + bowl + foot + 0.012 * (70.0 * z).sin(), z]
    };
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..=200).map(outside));
    points.extend([[0.3, 1.0], [0.25, 0.7], [0.0, 0.65]]);
    points
}

fn plate() -> Vec<[f64; 2]> {
    let rim = |k: u32| {
        let angle = PI * (f64::from(k) / 16.0 - 0.5);
        [0.48 + 0.02 * angle.cos(), 0.5 + 0.02 * angle.sin()]
    };
    let mut points = vec![[0.0, 0.48]];
    points.extend((0..=16).map(rim));
    points.extend([[0.3, 0.5], [0.0, 0.5]]);
    points
}

fn scene(points: &[[f64; 2]], offset: Offset, elevation: f64, distance: f64) -> Scene {
    let (sin, cos) = elevation.to_radians().sin_cos();
    let middle = DVec3::new(0.0, 0.0, 0.5);
    let mut camera = Camera::new(
        middle + distance * DVec3::new(0.6 * cos, 0.8 * cos, sin),
        middle,
    );
    camera.fov_y = 50.0;
    let mut scene = Scene::new(camera);
    let mut object = Object::new("solid", Arc::new(Profile::polygon(points, 0.6).unwrap()));
    object.offset = offset;
    scene.objects.push(object);
    scene
}

/// The edges of a mesh at which its picture ends, in pixels, and points of them: edges of which one
/// side is seen and one side is not, where one of the two points beside the middle, or beside an end,
/// is not covered.
fn outline(
    (mesh, copy): (&Mesh, &Placement),
    camera: &CameraFrame,
) -> (Vec<[DVec2; 2]>, Vec<DVec2>) {
    let pixel = camera.right.length_squared();
    let seen = |p: Vec3| {
        let way = copy.position + copy.scale * p.as_dvec3() - camera.eye;
        let place = DVec2::new(way.dot(camera.right), -way.dot(camera.up));
        place / (way.dot(camera.forward) * pixel) + DVec2::from(camera.middle)
    };
    let triangles: Vec<[DVec2; 3]> = triangles(mesh).iter().map(|t| t.map(seen)).collect();
    let area = |[a, b, c]: [DVec2; 3]| (b - a).perp_dot(c - a);
    let covered = |p: DVec2| {
        triangles.iter().any(|&[a, b, c]| {
            let signs = [area([a, b, p]), area([b, c, p]), area([c, a, p])];
            signs.iter().all(|s| *s >= 0.0) || signs.iter().all(|s| *s <= 0.0)
        })
    };
    let key = |p: DVec2| p.to_array().map(f64::to_bits);
    let mut edges: HashMap<_, (i32, [DVec2; 2])> = HashMap::new();
    for t in &triangles {
        let facing = if area(*t) > 0.0 { 1 } else { -1 };
        for k in 0..3 {
            let ends = [t[k], t[(k + 1) % 3]];
            let mut keys = ends.map(key);
            keys.sort();
            edges.entry(keys).or_insert((0, ends)).0 += facing;
        }
    }
    // Two triangles that face alike share all others.
    let turning = edges.into_values().filter(|(sum, _)| *sum == 0);
    let (mut bare_edges, mut points) = (Vec::new(), Vec::new());
    for [a, b] in turning.map(|(_, ends)| ends) {
        let aside = (b - a).perp().normalize_or_zero() * 1e-4;
        let places = [0.001, 0.5, 0.999].map(|at| a.lerp(b, at));
        let bare = |p: &DVec2| covered(p + aside) != covered(p - aside);
        let before = points.len();
        points.extend(places.into_iter().filter(bare));
        if points.len() > before {
            bare_edges.push([a, b]);
        }
    }
    (bare_edges, points)
}

/// The largest distance of a mesh's outline from the true one, and the reverse, in pixels.
fn errors(drawn: (&Mesh, &Placement), scene: &Scene, camera: &CameraFrame) -> [f64; 2] {
    let picture = TruePicture::new(scene, SIZE.0, SIZE.1).unwrap();
    let (edges, points) = outline(drawn, camera);
    let way = |p: &DVec2| picture.outline_distance(p.x, p.y).unwrap_or(f64::INFINITY);
    let some = points.iter().step_by(1 + points.len() / 40);
    let there = some.map(way).fold(0.0, f64::max);
    let mut back = 0.0f64;
    for row in (0..SIZE.1).step_by(29) {
        let y = f64::from(row) + 0.31;
        let hits = |x: f64| picture.at(x, y).is_some();
        for column in 0..SIZE.0 {
            let [mut low, mut high] = [0, 1].map(|c| f64::from(column + c));
            if hits(low) == hits(high) {
                continue;
            }
            for _ in 0..20 {
                let middle = 0.5 * (low + high);
                *(if hits(middle) == hits(low) {
                    &mut low
                } else {
                    &mut high
                }) = middle;
            }
            let p = DVec2::new(low, y);
            let to = |&[a, b]: &[DVec2; 2]| p.distance(Segment { a, b }.nearest(p).0);
            let nearest = edges.iter().map(to);
            back = back.max(nearest.fold(f64::INFINITY, f64::min));
        }
    }
    [there, back]
}

/// From solids, views, offsets and tolerances: the outline of the triangles is within the tolerance
/// of the true one, at corners and in the middle of sides, and is not much better.
#[test]
fn outlines_keep_the_tolerance() {
    let bevel = Offset {
        extend: 0.01,
        bevel: 0.12,
        chamfer: 0.6,
    };
    let solids = [CUP.to_vec(), ring(512), sphere(), goblet(), plate()];
    let mut used = Vec::new();
    let mut number = 0;
    for points in &solids {
        for (elevation, distance) in [(0.0, 1.6), (25.0, 2.0), (60.0, 5.0), (88.0, 20.0)] {
            number += 1;
            let offset = [Offset::default(), bevel][number % 2];
            let tolerance = [0.1, 0.25, 0.5, 1.0, 2.0][number % 5];
            let scene = scene(points, offset, elevation, distance);
            let camera = CameraFrame::new(&scene.camera, SIZE.0, SIZE.1).unwrap();
            let mut grown = GrownProfiles::default();
            let grown = grown.grown(&scene.objects[0]).map(|grown| grown.object);
            let object = grown.as_ref().unwrap_or(&scene.objects[0]);
            let source = ContourSource::new(&object.profile.outline).unwrap();
            let contour = source.contour(&object.offset).unwrap();
            let extent = super::super::tessellation::extent_of(&contour);
            let fineness = Fineness::Pixels(tolerance);
            let sight = Sight::new(&camera, SIZE);
            let levels = fineness.by_level(object, (&contour, &extent), &sight);
            let (&level, copies) = levels.first_key_value().unwrap();
            assert_eq!((levels.len(), copies.len()), (1, 1));
            let mesh = fineness.mesh(&contour, level);
            assert!(is_closed(&mesh));
            let off = errors((&mesh, &copies[0]), &scene, &camera).map(|e| e / tolerance);
            let (n, m) = (mesh.segments, mesh.rings);
            println!("{number}: {tolerance} px, {n} x {m}, level {level}: {off:.3?}");
            assert!(off.iter().all(|o| *o <= 1.0), "{number}: {off:?}");
            used.push(off[0].max(off[1]));
        }
    }
    let mean = used.iter().sum::<f64>() / used.len() as f64;
    assert!(mean > 0.45, "{mean}");
}

/// Copies of 2 to 2,000 pixels: quads grow with the square root around and along.
#[test]
fn small_copies_have_few_triangles() {
    let contour = contour(&goblet(), &Offset::default());
    let of = |pixels: f64| {
        let mesh = Mesh::within(&contour, 0.25 / pixels);
        assert!(is_closed(&mesh));
        mesh.indices.len() / 3
    };
    let found = [2.0, 8.0, 30.0, 120.0, 500.0, 2000.0].map(of);
    println!("{found:?}");
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
    assert!(
        found[0] <= 100 && found[1] <= 200 && found[5] < 60_000,
        "{found:?}"
    );
}

/// An eye in a hollow, at a wall, at a corner or beside the box: no level is absurd.
#[test]
fn levels_are_bounded_for_eyes_within_boxes() {
    let contour = contour(&CUP, &Offset::default());
    let extent = super::super::tessellation::extent_of(&contour);
    let level = |eye: DVec3| {
        let mut scene = scene(&CUP, Offset::default(), 0.0, 1.0);
        scene.camera.eye = eye;
        let camera = CameraFrame::new(&scene.camera, SIZE.0, SIZE.1).unwrap();
        let sight = Sight::new(&camera, SIZE);
        let shape = (&contour, &extent);
        let levels = Fineness::Pixels(0.25).by_level(&scene.objects[0], shape, &sight);
        levels.first_key_value().map(|(level, _)| *level)
    };
    let hollow = level(DVec3::new(0.0, 0.0, 0.6)).unwrap();
    let outside = level(DVec3::new(0.8, 0.0, 0.6)).unwrap();
    assert!(
        outside < hollow && hollow < FINEST - 6,
        "{outside} {hollow}"
    );
}
