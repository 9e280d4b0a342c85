//! Distances to the outline itself.

use super::nearest::for_each_texel;
use super::{Measured, round_down};
use crate::profile::{Profile, Segment};

/// Signed distance of each texel's centre to the outline's surface, object units, never greater
/// than the true distance.
pub(super) fn measure(profile: &Profile, columns: u32, rows: u32) -> Measured {
    let outline = &profile.outline;
    let (columns, rows) = (columns as usize, rows as usize);
    let segments: Vec<Segment> = outline.surface_segments().collect();
    let heights = (0..rows).map(|row| 1.0 - (row as f64 + 0.5) / rows as f64);
    // The solid is between an odd and the next even crossing of a row.
    let crossings = outline.crossings(heights);
    let distances = for_each_texel(&segments, columns, rows, |column, row, distance, _| {
        let r = (column as f64 + 0.5) / rows as f64;
        let inside = crossings[row].partition_point(|&c| c <= r) % 2 == 1;
        round_down(if inside { -distance } else { distance })
    });
    (distances, outline.bounds())
}
