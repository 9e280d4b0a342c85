//! Normals and texture coordinates.

use crate::edges::is_watertight;
use crate::{SCENES, object, scene};
use glam::{DVec2, DVec3};
use revmap::maps::{ArcLength, ColorMap, Projection};
use revmap::scene::Object;
use revmap_tessellation::Triangles;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

#[test]
fn normals_split_at_edges_and_coordinates_run_once_around() {
    let can = object(&[[0.0, 0.1], [0.3, 0.1], [0.3, 0.9], [0.0, 0.9]]);
    let mesh = Triangles::new(&can, 1e-3).unwrap();
    for v in &mesh.vertices {
        let [x, y, z] = v.position.map(f64::from);
        let normal = DVec3::from(v.normal.map(f64::from));
        let radial = DVec2::new(x, y).normalize_or_zero().extend(0.0);
        let faces = [radial, DVec3::Z, DVec3::NEG_Z];
        assert!(
            faces.iter().any(|face| face.distance(normal) < 1e-6),
            "{v:?}"
        );
        assert!((f64::from(v.uv[1]) - z).abs() < 1e-6);
    }
    // No triangle goes back across the texture.
    for t in mesh.indices.chunks_exact(3) {
        let u = [0, 1, 2].map(|k| mesh.vertices[t[k] as usize].uv[0]);
        let wide = u.iter().fold(0.0f32, |m, v| m.max((v - u[0]).abs()));
        assert!(wide < 0.1, "{u:?}");
    }
    let seam = mesh
        .vertices
        .iter()
        .filter(|v| v.uv[0] == 1.0 && v.position[0] != 0.0);
    assert!(seam.clone().count() > 3 && seam.clone().all(|v| v.position[0] < 0.0));
}

/// Every projection but `planar`, of which `eta` also depends on the azimuth.
fn eta(object: &Object) -> Box<dyn Fn(DVec2) -> f64> {
    match object.texturing.projection {
        Projection::Spherical => Box::new(|p| 1.0 - p.x.atan2(p.y - 0.5) / PI),
        Projection::Arc => {
            let arc = ArcLength::new(&object.profile).unwrap();
            Box::new(move |p| arc.eta(p.x, p.y))
        }
        _ => Box::new(|p| p.y),
    }
}

/// The largest error of `eta` within triangles, and that of `xi` in steps about the axis.
fn errors(object: &Object, tolerance: f64) -> [f64; 2] {
    let mesh = Triangles::new(object, tolerance).unwrap();
    assert!(is_watertight(&mesh));
    let eta = eta(object);
    let steps = mesh.vertices.iter().map(|v| f64::from(v.uv[0]));
    let step = steps.filter(|xi| *xi > 1e-6).fold(1.0, f64::min);
    let mut found = [0.0f64; 2];
    for t in mesh.indices.chunks_exact(3) {
        let v = [0, 1, 2].map(|k| mesh.vertices[t[k] as usize]);
        let places = v.map(|v| DVec3::from(v.position.map(f64::from)));
        let coordinates = v.map(|v| DVec2::from(v.uv.map(f64::from)));
        for weights in WEIGHTS {
            let mut point = DVec3::ZERO;
            let (mut radius, mut uv) = (0.0, DVec2::ZERO);
            for k in 0..3 {
                point += weights[k] * places[k];
                radius += weights[k] * places[k].truncate().length();
                uv += weights[k] * coordinates[k];
            }
            // The point of the surface that is nearest is as far from the axis as the corners.
            let off = (uv.y - eta(DVec2::new(radius, point.z))).abs();
            let xi = 0.5 + point.y.atan2(point.x) / TAU;
            let aside = (uv.x - xi + 0.5).rem_euclid(1.0) - 0.5;
            found = [found[0].max(off), found[1].max(aside.abs() / step)];
        }
    }
    found
}

const WEIGHTS: [[f64; 3]; 7] = [
    [1.0 / 3.0; 3],
    [0.1, 0.1, 0.8],
    [0.1, 0.8, 0.1],
    [0.8, 0.1, 0.1],
    [0.02, 0.49, 0.49],
    [0.49, 0.02, 0.49],
    [0.49, 0.49, 0.02],
];

/// Solids of scenes, and cans, tubes and cones from wide to thin.
#[test]
fn coordinates_are_right_within_triangles() {
    let mut all: Vec<Object> = SCENES.map(|name| scene(name).objects[0].clone()).into();
    for r in [0.35, 0.2, 0.05, 0.01, 0.001] {
        all.push(object(&[[0.0, 0.0], [r, 0.0], [r, 1.0], [0.0, 1.0]]));
        all.push(object(&[
            [r, 0.1],
            [r + 0.1, 0.1],
            [r + 0.1, 0.6],
            [r, 0.7],
        ]));
        all.push(object(&[[0.0, 0.1], [r, 0.1], [0.0, 0.93]]));
    }
    for mut object in all {
        for projection in [
            Projection::Spherical,
            Projection::Cylindrical,
            Projection::Arc,
        ] {
            object.texturing.projection = projection;
            for tolerance in [1e-2, 5e-4] {
                let [eta, xi] = errors(&object, tolerance);
                println!(
                    "{} {projection:?} {tolerance}: {eta:.5} {xi:.3}",
                    object.name
                );
                let allowed = 0.002 + 0.5 * tolerance;
                assert!(
                    eta < allowed,
                    "{} {projection:?} {tolerance}: {eta}",
                    object.name
                );
                // Half a step on the axis, nearly a whole one where a ring is close to it.
                assert!(xi < 1.0, "{} {projection:?} {tolerance}: {xi}", object.name);
            }
        }
    }
}

/// The projection along the axis is exact.
#[test]
fn planar_coordinates_are_those_of_places() {
    let mut vase = scene("vase").objects[0].clone();
    vase.texturing.projection = Projection::Planar;
    let side = 2.0 * vase.profile.radius;
    for v in Triangles::new(&vase, 1e-3).unwrap().vertices {
        let place = DVec2::from([v.position[0], v.position[1]].map(f64::from));
        let wanted = place / side + 0.5;
        assert!(DVec2::from(v.uv.map(f64::from)).distance(wanted) < 1e-6);
    }
}

/// A colour map of four rows ends in the middle of its first and last, and a ring is there.
#[test]
fn rings_are_where_a_map_ends() {
    let mut can = object(&[[0.0, 0.1], [0.3, 0.1], [0.3, 0.9], [0.0, 0.9]]);
    let map = ColorMap::from_texels(1, 4, vec![[9; 4]; 4]).unwrap();
    can.texturing.color_map = Some(Arc::new(map));
    can.texturing.offset = [0.0, 0.1];
    for projection in [Projection::Cylindrical, Projection::Spherical] {
        can.texturing.projection = projection;
        let mesh = Triangles::new(&can, 1e-2).unwrap();
        assert!(is_watertight(&mesh));
        for t in mesh.indices.chunks_exact(3) {
            let eta = [0, 1, 2].map(|k| f64::from(mesh.vertices[t[k] as usize].uv[1]) - 0.1);
            for end in [0.125, 0.875] {
                let below = eta.iter().any(|eta| *eta < end - 1e-5);
                let above = eta.iter().any(|eta| *eta > end + 1e-5);
                assert!(!(below && above), "{eta:?}");
            }
        }
    }
}
