//! The massive core of a solid: a radius about the axis for each row of equal height.

use super::QuadricPatch;
use super::rows::extents;

/// Rows of equal height.
pub(crate) const SOLID_ROWS: usize = 64;

const N: usize = SOLID_ROWS;

/// The radius within which everything is solid, for each row of equal height over `0 <= z <= 1`.
/// Object units. Rounded down; 0 if there is no such radius.
pub(crate) fn solid_radii(patches: &[QuadricPatch]) -> [f64; N] {
    // A row's middle on the axis is in the solid if an odd number of patches is beside it.
    let mut solid = [false; N];
    for patch in patches.iter().filter(|p| !p.is_plane()) {
        let [first, end] = patch
            .z
            .map(|z| ((z * N as f64 - 0.5).ceil().max(0.0) as usize).min(N));
        for row in &mut solid[first.min(end)..end] {
            *row = !*row;
        }
    }
    let extents = extents(patches, N);
    std::array::from_fn(|row| {
        let least = f64::from(extents[row][0]).max(0.0).sqrt();
        if solid[row] && least.is_finite() {
            (least * (1.0 - 1e-3) - 1e-4).max(0.0)
        } else {
            0.0
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Outline;
    use crate::surface::Offset;
    use crate::surface::{ContourSource, FitOptions, fit_patches};
    use glam::DVec2;

    fn patches(points: &[[f64; 2]]) -> Vec<QuadricPatch> {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        let outline = Outline {
            loops: vec![points],
        };
        let contour = ContourSource::new(&outline).unwrap();
        let contour = contour.contour(&Offset::default()).unwrap();
        fit_patches(&contour, &FitOptions::default())
    }

    #[test]
    fn all_within_is_solid_and_little_else_is() {
        // A cup on a foot: its bowl is hollow, its foot undercut.
        let cup = [
            [0.0, 0.1],
            [0.2, 0.1],
            [0.3, 0.0],
            [0.4, 0.0],
            [0.1, 0.5],
            [0.4, 1.0],
            [0.3, 1.0],
            [0.0, 0.6],
        ];
        let patches = patches(&cup);
        let radii = solid_radii(&patches);
        // Parity of the number of patches beyond a point.
        let is_solid = |r: f64, z: f64| {
            let beyond = patches
                .iter()
                .filter(|p| !p.is_plane() && p.z[0] <= z && z < p.z[1] && p.square_at(z) > r * r);
            beyond.count() % 2 == 1
        };
        for (row, &radius) in radii.iter().enumerate() {
            for k in 0..=100 {
                let z = (row as f64 + f64::from(k) / 100.0) / 64.0;
                for part in [0.0, 0.5, 1.0] {
                    let r = radius * part;
                    let inside = is_solid(r, z);
                    assert!(radius == 0.0 || inside, "row {row}, {r} {z}");
                }
            }
        }
        // The radius is 0 below and above the axis' part of the solid, and in the rows of its ends.
        assert!(radii[..7].iter().chain(&radii[38..]).all(|r| *r == 0.0));
        // The narrowest point is the joint of cup and foot.
        assert!((radii[31] - 0.1).abs() < 0.01 && radii[10] > 0.25);
    }
}
