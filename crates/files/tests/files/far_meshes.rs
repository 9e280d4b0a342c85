//! Meshes of objects far from the origin keep their shape, or are refused.

use glam::{DQuat, DVec3};
use revmap::error::ErrorKind;
use revmap::scene::{Camera, Object, Placement, Scene};
use revmap_files::{stl_rounding, write_meshes};
use revmap_tessellation::Triangles;
use std::path::Path;
use std::sync::Arc;

const TOLERANCE: f64 = 5e-4;

/// Two copies and an object beside them, all turned and stretched, at `far` times a direction.
fn scene(far: f64, scale: f64) -> Scene {
    let corners = [[0.0, 0.0], [0.4, 0.0], [0.3, 1.0], [0.0, 1.0]];
    let profile = revmap::profile::Profile::polygon(&corners, 0.5).unwrap();
    let place = |by: [f64; 3]| Placement {
        position: far * DVec3::new(1.0, -0.6, 0.3) + scale * DVec3::from(by),
        rotation: DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0),
        scale: scale * DVec3::new(1.0, 2.0, 0.7),
    };
    let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
    scene.objects = vec![Object::new("cone", Arc::new(profile)); 2];
    scene.objects[0].instances = vec![place([0.0; 3]), place([0.0, 0.1, 3.0])].into();
    scene.objects[1].placement = place([5.0, 0.0, 0.7]);
    scene
}

fn meshes(scene: &Scene) -> Vec<Triangles> {
    let all = scene.objects.iter();
    all.map(|o| Triangles::new(o, TOLERANCE).unwrap()).collect()
}

/// Every vertex of every copy, in the world.
fn vertices(scene: &Scene, meshes: &[Triangles]) -> Vec<DVec3> {
    let mut all = Vec::new();
    for (object, mesh) in scene.objects.iter().zip(meshes) {
        for copy in object.placements() {
            let place = |p: [f32; 3]| {
                copy.position + copy.rotation * (DVec3::from(p.map(f64::from)) * copy.scale)
            };
            all.extend(mesh.vertices.iter().map(|v| place(v.position)));
        }
    }
    all
}

fn nearest(all: &[DVec3], p: DVec3) -> f64 {
    let distances = all.iter().map(|q| q.distance(p));
    distances.fold(f64::INFINITY, f64::min)
}

#[test]
fn text_has_the_digits_that_a_far_object_needs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    for (far, scale) in [
        (0.0, 1.0),
        (1e6, 1.0),
        (1e8, 1.0),
        (1e8, 100.0),
        (1e4, 1e-3),
    ] {
        let scene = scene(far, scale);
        let meshes = meshes(&scene);
        write_meshes(&scene, &meshes, &path).unwrap();
        let wanted = vertices(&scene, &meshes);
        let text = std::fs::read_to_string(&path).unwrap();
        let places = text.lines().filter_map(|l| l.strip_prefix("v "));
        let (mut count, mut longest) = (0, 0);
        for line in places {
            let numbers: Vec<f64> = line.split(' ').map(|n| n.parse().unwrap()).collect();
            let off = nearest(&wanted, DVec3::new(numbers[0], -numbers[2], numbers[1]));
            // Doubles have a spacing of 1.5e-8 at 1e8.
            assert!(off < 1e-6 * scale + far * 3e-16, "{far} {scale}: {off}");
            (count, longest) = (count + 1, longest.max(line.len()));
        }
        assert!(count > 100 && longest < 66, "{count} {longest}");
    }
}

#[test]
fn an_stl_is_within_its_tolerance_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.stl");
    let write = |scene: &Scene| write_meshes(scene, &meshes(scene), &path);
    for scale in [1.0, 100.0, 1e-3] {
        let refused = |far: f64| write(&scene(far, scale)).unwrap_err();
        let error = refused(1e6 * scale);
        assert_eq!(error.kind, ErrorKind::Content);
        assert_eq!(error.key.as_deref(), Some("object.0.position"));
        assert_eq!(refused(1e8).kind, ErrorKind::Content);
        let limit = error.message.split("coordinates of ").nth(1).unwrap();
        let limit: f64 = limit.split(';').next().unwrap().parse().unwrap();
        refused(1.01 * limit);
        let near = scene(limit - 10.0 * scale, scale);
        write(&near).unwrap();
        let rounding = near.objects.iter().map(stl_rounding).fold(0.0, f64::max);
        assert!(rounding < TOLERANCE / 7.0);
        let off = farthest(&path, &vertices(&near, &meshes(&near)));
        // The rounding is of object units, of which the shortest is 0.7 of a scale.
        assert!(off < 0.7 * rounding * scale, "{scale}: {off}");
        assert!(off > 0.1 * rounding * scale, "{scale}: {off}");
    }
}

/// The largest distance of a corner to the nearest of `wanted`.
fn farthest(path: &Path, wanted: &[DVec3]) -> f64 {
    let bytes = std::fs::read(path).unwrap();
    let float = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let mut most = 0.0f64;
    for triangle in (84..bytes.len()).step_by(50).step_by(7) {
        for corner in 0..3 {
            let at = triangle + 12 + 12 * corner;
            let p = [0, 4, 8].map(|k| f64::from(float(at + k)));
            most = most.max(nearest(wanted, p.into()));
        }
    }
    most
}
