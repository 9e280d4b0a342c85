//! The place of a copy in the last frame, for motion vectors.

use crate::gpu::content::entry::Entry;
use crate::plan::View;
use crate::shader::InstanceBlock;
use glam::{DVec3, DVec4};

/// The record from which `motion_of` of `stage/outputs.glsl` projects a point of a copy into the
/// last frame: three rows of the map from object space to `(x w, y w, w)`, then this frame's jitter
/// and the distance along the normal by which the surface was farther out.
///
/// The map is exact. A point moves along its normal if the extension changes, which is exact where
/// the surface keeps its distance to the profile. Motion leaves out a change of bevel or chamfer.
#[allow(clippy::cast_possible_truncation)]
pub(crate) fn last_block(entry: &Entry, copy: usize, view: &View) -> InstanceBlock {
    let (object, growth) = (&entry.values.object, entry.values.growth());
    let all = object.placements();
    let last = entry.last.as_ref();
    let last = last.and_then(|last| Some((&last.placements(all.len())?[copy], last.extend)));
    let (placement, extend) = last.unwrap_or((&all[copy], object.offset.extend));
    let rows = view
        .last
        .map_or_else(|| view.pixel_rows(), |last| last.rows);
    // A point `p` of the drawn box is `height p + origin` in the object's own units.
    let height = growth.height();
    let [x, y] = object.axis_offset();
    let rotation = placement.rotation.normalize();
    let moved = |v: DVec3| rotation * (placement.scale * v);
    let origin = placement.position + moved(DVec3::new(x, y, -growth.low));
    let ways = DVec3::AXES.map(|axis| moved(axis * height));
    let [row_x, row_y, row_w] = rows.map(|row| {
        let [a, b, c] = ways.map(|way| row.truncate().dot(way));
        let at = row.dot(origin.extend(1.0));
        DVec4::new(a, b, c, at).as_vec4().to_array()
    });
    let farther = (extend - object.offset.extend) / height;
    let jitter = -view.jitter;
    InstanceBlock {
        position_sx: row_x,
        rotation: row_y,
        scale_depth: row_w,
        // Positions of the shader count from the centre of pixel (0, 0).
        origin: [
            (jitter.x + 0.5) as f32,
            (jitter.y + 0.5) as f32,
            farther as f32,
            0.0,
        ],
        object: [0; 4],
    }
}
