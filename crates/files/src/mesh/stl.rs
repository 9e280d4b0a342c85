//! Binary STL: triangles with their normals, without colours, units as the scene has them.

use super::{Solid, placed};

/// The bytes of a file.
pub(super) fn bytes(solids: &[Solid]) -> Vec<u8> {
    let mut header = [b' '; 80];
    header[..36].copy_from_slice(b"solids of revolution, made by revmap");
    let mut bytes = header.to_vec();
    bytes.extend([0; 4]);
    let mut count = 0u32;
    for solid in solids {
        let mesh = solid.triangles;
        for copy in solid.object.placements() {
            for triangle in mesh.indices.chunks_exact(3) {
                let corner = |k: usize| mesh.vertices[triangle[k] as usize].position;
                let [a, b, c] = [0, 1, 2].map(|k| placed(corner(k), copy));
                let normal = (b - a).cross(c - a).normalize_or_zero();
                for v in [normal, a, b, c]
                    .map(|v| v.as_vec3().to_array())
                    .as_flattened()
                {
                    bytes.extend(v.to_le_bytes());
                }
                bytes.extend([0; 2]);
                count += 1;
            }
        }
    }
    bytes[80..84].copy_from_slice(&count.to_le_bytes());
    bytes
}
