//! Normals and texture coordinates.

use crate::edges::is_watertight;
use crate::object;
use glam::{DVec2, DVec3};
use revmap::maps::Projection;
use revmap_tessellation::Triangles;
use std::f64::consts::PI;

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

/// Between the rings of a straight wall, `eta` is nearly that of each point.
#[test]
fn bent_coordinates_get_rings_of_their_own() {
    for projection in [Projection::Spherical, Projection::Cylindrical] {
        let mut can = object(&[[0.0, 0.1], [0.3, 0.1], [0.3, 0.9], [0.0, 0.9]]);
        can.texturing.projection = projection;
        let mesh = Triangles::new(&can, 1e-2).unwrap();
        assert!(is_watertight(&mesh));
        let rings = mesh.vertices.iter().filter(|v| v.uv[0] == 0.0).count();
        assert_eq!(rings > 4, projection == Projection::Spherical, "{rings}");
        for t in mesh.indices.chunks_exact(3) {
            let [a, b] = [t[1], t[2]].map(|k| mesh.vertices[k as usize]);
            let middle = 0.5
                * (DVec3::from(a.position.map(f64::from)) + DVec3::from(b.position.map(f64::from)));
            let wanted = match projection {
                Projection::Spherical => {
                    1.0 - middle.truncate().length().atan2(middle.z - 0.5) / PI
                }
                _ => middle.z,
            };
            let found = 0.5 * (f64::from(a.uv[1]) + f64::from(b.uv[1]));
            // The middle of a chord about the axis lies within the circle.
            assert!((found - wanted).abs() < 6e-3, "{found} for {wanted}");
        }
    }
}
