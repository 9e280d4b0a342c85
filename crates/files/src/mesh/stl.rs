//! Binary STL: triangles with their normals, without colours, units as the scene has them.

use super::{Solid, placed};
use crate::content_fault;
use glam::DVec3;
use revmap::error::Result;
use revmap::scene::{Growth, Object, Placement};

/// Readers take a file that begins with "solid" for text.
const HEAD: &[u8] = b"revmap: solids of revolution";
/// The part of the triangles' tolerance that rounding may have.
const SHARE: f64 = 1.0 / 7.0;
/// Bits behind the first of a coordinate.
const DIGITS: i32 = f32::MANTISSA_DIGITS as i32 - 1;

/// The largest distance by which an `.stl` rounds points of an object's copies, object units: its
/// coordinates have 32 bits, so it grows with the distance from the origin.
#[must_use]
pub fn stl_rounding(object: &Object) -> f64 {
    let rounding = |copy: &Placement| {
        let digit = farthest(object, copy).max(f64::MIN_POSITIVE).log2().floor();
        3f64.sqrt() * (digit - f64::from(DIGITS) - 1.0).exp2() / copy.scale.abs().min_element()
    };
    let all = object.placements().iter().map(rounding);
    all.fold(0.0, f64::max)
}

/// No coordinate of a copy is larger.
fn farthest(object: &Object, copy: &Placement) -> f64 {
    let growth = Growth::of(object);
    let side = object.profile.radius + growth.side;
    let corner = DVec3::new(side, side, (1.0 + growth.high).max(growth.low));
    copy.position.abs().max_element() + (corner * copy.scale).length()
}

/// Refuses a solid of which 32 bits do not keep the shape.
pub(super) fn check(solid: &Solid) -> Result<()> {
    let (rounding, allowed) = (
        stl_rounding(solid.object),
        SHARE * solid.triangles.tolerance,
    );
    if rounding <= allowed {
        return Ok(());
    }
    let copies = solid.object.placements().iter();
    let scales = copies.map(|copy| copy.scale.abs().min_element());
    let least = scales.fold(f64::INFINITY, f64::min);
    let holds = ((allowed * least / 3f64.sqrt()).log2().floor() + f64::from(DIGITS) + 2.0).exp2();
    let message = format!(
        "is so far from the origin that the 32 bits of an .stl round it by {rounding:.1e} object units, too much for its tolerance, which holds up to coordinates of {holds}; move it there, give a larger tolerance, or write .glb or .obj"
    );
    Err(content_fault(message).at_key(format!("object.{}.position", solid.number)))
}

/// The bytes of a file.
pub(super) fn bytes(solids: &[Solid]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..HEAD.len()].copy_from_slice(HEAD);
    bytes.extend([0; 4]);
    let mut count = 0u32;
    for solid in solids {
        let mesh = solid.triangles;
        for copy in solid.object.placements() {
            for triangle in mesh.indices.chunks_exact(3) {
                let corner = |k: usize| mesh.vertices[triangle[k] as usize].position;
                let [a, b, c] = [0, 1, 2].map(|k| placed(corner(k), copy));
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let [normal, a, b, c] = [normal, a, b, c].map(|v| v.as_vec3());
                if a == b || b == c || c == a {
                    continue; // rounded to a line
                }
                for v in [normal, a, b, c].map(|v| v.to_array()).as_flattened() {
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
