//! Distances to the reference, and refusals.

use crate::edges::is_watertight;
use crate::{SCENES, corners, object, scene, volume};
use glam::DVec3;
use revmap::error::ErrorKind;
use revmap::scene::{Camera, Clip, Object, Offset, Placement};
use revmap_reference::{Ray, Reference};
use revmap_tessellation::{Triangles, pixel_tolerance, strands_within};
use std::f64::consts::TAU;

/// Distance of a point to the nearest triangle.
fn distance(triangles: &[[DVec3; 3]], p: DVec3) -> f64 {
    let to = |[a, b, c]: &[DVec3; 3]| {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let edges = [(a, b), (b, c), (c, a)];
        if edges
            .iter()
            .all(|(a, b)| (*b - *a).cross(p - *a).dot(normal) >= 0.0)
        {
            return (p - a).dot(normal).abs();
        }
        let edge = |(a, b): (&DVec3, &DVec3)| {
            let along = b - a;
            let t = (p - a).dot(along) / along.length_squared().max(1e-300);
            p.distance(a + along * t.clamp(0.0, 1.0))
        };
        edges.map(edge).into_iter().fold(f64::INFINITY, f64::min)
    };
    triangles.iter().map(to).fold(f64::INFINITY, f64::min)
}

/// The largest distance from the mesh to the reference, and from the reference to the mesh, at many
/// points of both.
fn hausdorff(object: &Object, tolerance: f64) -> [f64; 2] {
    let mut scene = scene("smallest");
    let placement = Placement::default();
    scene.objects = vec![Object {
        placement,
        ..object.clone()
    }];
    let reference = Reference::new(&scene).unwrap();
    let triangles = corners(&Triangles::new(object, tolerance).unwrap());
    let mut found = [0.0f64; 2];
    // The surface lies near each triangle's middle and near its corners, along some direction.
    for (k, [a, b, c]) in triangles
        .iter()
        .enumerate()
        .step_by(triangles.len() / 700 + 1)
    {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let weights = [[1.0 / 3.0; 3], [0.98, 0.01, 0.01], [0.01, 0.495, 0.495]][k % 3];
        let p = a * weights[0] + b * weights[1] + c * weights[2];
        let radial = p.with_z(0.0).normalize_or_zero();
        let slanted = [radial + DVec3::Z, radial - DVec3::Z].map(DVec3::normalize);
        let along = [normal, radial, DVec3::Z, slanted[0], slanted[1]];
        let along = along.into_iter().flat_map(|way| [way, -way]);
        let reach = |way: DVec3| {
            let ray = Ray::new(p - way * 3.0 * tolerance, way);
            reference
                .trace(ray)
                .hit
                .map(|hit| (hit.t - 3.0 * tolerance).abs())
        };
        let near = along.filter_map(reach).fold(f64::INFINITY, f64::min);
        found[0] = found[0].max(near);
    }
    for k in 0..400 {
        let (turn, z) = (2.4 * f64::from(k), f64::from(k % 40) / 39.0);
        let middle = DVec3::new(0.0, 0.0, z);
        let origin = DVec3::new(
            3.0 * turn.cos(),
            3.0 * turn.sin(),
            6.0 * (f64::from(k) / 400.0) - 2.5,
        );
        let direction = middle + DVec3::new(0.2 * turn.sin(), 0.0, 0.0) - origin;
        if let Some(hit) = reference.trace(Ray { origin, direction }).hit {
            found[1] = found[1].max(distance(&triangles, origin + direction * hit.t));
        }
    }
    found
}

#[test]
fn twelve_solids_are_within_the_tolerance_of_the_reference() {
    for name in SCENES {
        for tolerance in [5e-3, 5e-4] {
            let object = &scene(name).objects[0];
            let mesh = Triangles::new(object, tolerance).unwrap();
            assert!(is_watertight(&mesh), "{name}");
            let found = hausdorff(object, tolerance);
            println!(
                "{name} {tolerance}: {} triangles, {found:?}",
                mesh.indices.len() / 3
            );
            assert!(
                found.iter().all(|d| *d <= tolerance),
                "{name} {tolerance}: {found:?}"
            );
            // No check that passes whatever is measured: the errors are not far below.
            assert!(
                found.iter().any(|d| *d > 0.05 * tolerance),
                "{name} {tolerance}: {found:?}"
            );
        }
    }
}

#[test]
fn offsets_are_within_the_tolerance_of_the_reference() {
    let pawn = scene("pawn").objects[0].clone();
    let offsets = [
        (0.05, 0.0, 1.0),
        (-0.02, 0.0, 1.0),
        (0.0, 0.3, 0.6),
        (0.01, 0.2, 1.0),
    ];
    for (extend, bevel, chamfer) in offsets {
        for clip in [Clip::None, Clip::Box] {
            let offset = Offset {
                extend,
                bevel,
                chamfer,
            };
            let object = Object {
                offset,
                clip,
                ..pawn.clone()
            };
            let Ok(mesh) = Triangles::new(&object, 1e-3) else {
                assert!(clip == Clip::Box && extend + bevel > 0.0, "{offset:?}");
                continue;
            };
            let found = hausdorff(&object, 1e-3);
            assert!(is_watertight(&mesh) && volume(&mesh) > 0.0);
            assert!(found.iter().all(|d| *d <= 1e-3), "{offset:?}: {found:?}");
        }
    }
}

#[test]
fn thin_walls_do_not_cross() {
    // Two walls that are bent alike, nearer to each other than the tolerance.
    let wall = |d: f64| {
        (0..=60).map(move |k| {
            let z = 0.1 + 0.8 * f64::from(k) / 60.0;
            [0.3 + d + 0.05 * (12.0 * z).sin(), z]
        })
    };
    let shell: Vec<[f64; 2]> = wall(0.002)
        .chain(wall(0.0).collect::<Vec<_>>().into_iter().rev())
        .collect();
    let shell = object(&shell);
    let mesh = Triangles::new(&shell, 0.02).unwrap();
    let expected = TAU * 0.3 * 0.002 * 0.8;
    assert!(
        (volume(&mesh) / expected - 1.0).abs() < 0.1,
        "{}",
        volume(&mesh)
    );
    let source = revmap::surface::ContourSource::new(&shell.profile.outline).unwrap();
    let contour = source.contour(&Offset::default()).unwrap();
    let many = |tolerance| strands_within(&contour, tolerance)[0].rings.len();
    assert!(many(0.02) > 8 && many(0.02) <= many(1e-5));
}

#[test]
fn what_a_mesh_has_not_is_refused() {
    let plain = object(&[[0.0, 0.1], [0.4, 0.1], [0.4, 0.9], [0.0, 0.9]]);
    let refused = |change: &dyn Fn(&mut Object), tolerance| {
        let mut object = plain.clone();
        change(&mut object);
        let error = Triangles::new(&object, tolerance).unwrap_err();
        (error.kind, error.key.unwrap())
    };
    let content = |key: &str| (ErrorKind::Content, key.to_owned());
    assert_eq!(refused(&|o| o.repeat = [2, 1, 1], 1e-3), content("repeat"));
    assert_eq!(refused(&|o| o.axis = [0.9, 0.5], 1e-3), content("axis"));
    assert_eq!(
        refused(&|o| o.offset.extend = -0.5, 1e-3),
        content("extend")
    );
    let boxed = |o: &mut Object| (o.clip, o.offset.extend) = (Clip::Box, 0.2);
    assert_eq!(refused(&boxed, 1e-3), content("radius"));
    for tolerance in [0.0, -1.0, f64::NAN, 1e-9] {
        assert_eq!(refused(&|_| (), tolerance).0, ErrorKind::Usage);
    }
}

#[test]
fn pixels_are_those_on_the_nearest_point_of_a_box() {
    let mut object = object(&[[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]]);
    let mut camera = Camera::new(DVec3::new(2.5, 0.0, 0.5), DVec3::ZERO);
    camera.fov_y = 90.0;
    let tolerance =
        |object: &Object, distance| pixel_tolerance(object, &camera, 100, 0.5, distance);
    // A picture at distance 2 is 4 wide.
    assert!((tolerance(&object, None).unwrap() - 0.02).abs() < 1e-12);
    assert!((tolerance(&object, Some(20.0)).unwrap() - 0.2).abs() < 1e-12);
    object.placement.scale = DVec3::new(2.0, 1.0, -4.0);
    // The box's face is at 1.5, and its tallest side is 4 times as long.
    assert!((tolerance(&object, None).unwrap() - 0.01 * (1.5f64.hypot(0.5)) / 4.0).abs() < 1e-12);
    object.placement.scale = DVec3::splat(6.0);
    assert_eq!(tolerance(&object, None), None);
}
