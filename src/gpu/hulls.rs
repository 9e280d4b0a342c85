//! Hulls: what the vertex shader grows, and which objects can be drawn by theirs.

use crate::pieces::{Hull, HullOptions, Piece, Record};
use crate::scene::{CameraFrame, Object, Placement};
use crate::shader::generated::{BAND_VECTORS, HULL_SIDES, HULL_TESTS};
use glam::{DVec2, DVec3};

/// By how much an eye has to stand clear of a shell, and a shell of the near plane, object units.
const CLEARANCE: f64 = 1e-3;

/// How far a band may lie from the surface, object units: fewer triangles against fewer fragments that meet nothing.
const GAP: f64 = 0.01;

/// The hull of `object` whose boundary the pieces are, if it shows from this camera all that the box would: the box cuts nothing of the
/// solid and holds no replicas, the eye is outside all shells, the near plane cuts none.
pub(crate) fn of(object: &Object, pieces: &[Piece], camera: &CameraFrame, near: f64) -> Option<Hull> {
    let radius = object.profile.radius;
    let [x, y] = object.axis.map(|o| (2.0 * o - 1.0) * radius);
    let side_face = radius - x.abs().max(y.abs());
    let cut = pieces.iter().any(|p| p.r[1] > side_face);
    if cut || object.repeat != [1; 3] {
        return None;
    }
    let hull = Hull::new(
        pieces,
        &HullOptions {
            sides: HULL_SIDES,
            tests: HULL_TESTS,
            gap: std::env::var("HULL_GAP").map_or(GAP, |v| v.parse().unwrap()),
            ..HullOptions::default()
        },
    );
    let axis = DVec3::new(x, y, 0.0);
    let seen = |placement| is_in_front(&hull, placement, axis, camera, near);
    object.placements().iter().all(seen).then_some(hull)
}

/// Whether a copy's shells are all in front of the near plane, and the eye in none of them.
fn is_in_front(
    hull: &Hull,
    placement: &Placement,
    axis: DVec3,
    camera: &CameraFrame,
    near: f64,
) -> bool {
    let turn = placement.rotation.conjugate();
    let eye = turn * (camera.eye - placement.position) / placement.scale - axis;
    let forward = turn * camera.forward * placement.scale;
    let aside = forward.truncate().length();
    let margin = CLEARANCE * forward.length();
    let ahead = hull.extents.iter().all(|&[_, r, low, high]| {
        let lowest = (forward.z * (low - eye.z)).min(forward.z * (high - eye.z));
        lowest - forward.truncate().dot(eye.truncate()) - r * aside >= near + margin
    });
    ahead && hull.clear_of(DVec2::new(eye.truncate().length(), eye.z), CLEARANCE)
}

/// Appends a hull's bands in the layout of `hull.vert`; returns where they stand.
pub(crate) fn append(hull: &Hull, pieces: &[Piece], out: &mut Vec<[f32; 4]>) -> usize {
    let begin = out.len();
    // A guard that nothing passes.
    let none = [[0.0; 4], [0.0, 0.0, 1.0, 0.0]];
    for band in &hull.bands {
        out.push([band.from[0], band.from[1], band.to[0], band.to[1]]);
        let first = band.first as usize;
        for k in 0..HULL_TESTS as usize {
            let record = pieces.get(first + k).filter(|_| k < band.count as usize);
            let vectors = record.map(|p| Record::new(p, first + k));
            out.extend(vectors.map_or(none, |r| [r.quadric, r.guard]));
        }
    }
    debug_assert_eq!(out.len() - begin, hull.bands.len() * BAND_VECTORS as usize);
    begin
}

/// Corners that every band's triangles join, in the numbering of `hull.vert`: `2 n` vertices a band, the rings one after the other.
pub(crate) fn indices(bands: usize) -> Vec<u32> {
    let n = HULL_SIDES;
    (0..u32::try_from(bands).unwrap_or(0))
        .flat_map(|band| {
            (0..n).flat_map(move |side| {
                let (a, b) = (band * 2 * n, band * 2 * n + n);
                let next = (side + 1) % n;
                [a + side, a + next, b + next, a + side, b + next, b + side]
            })
        })
        .collect()
}
