//! The methods that measure the distances of a shape map.

use super::nearest::for_each_texel;
use super::round_down;
use crate::profile::{Bounds, Profile, Segment};
use std::fmt;
use std::hash::{Hash, Hasher};

/// A method that measures distances, plain data: the library's own is [`MapSource::EXACT`]. Other
/// crates bring methods for comparison. Two methods of one name are equal.
#[derive(Clone, Copy)]
pub struct MapSource {
    /// Name in options and files.
    pub name: &'static str,
    /// Measures a profile on a grid of `columns` x `rows` texels, laid out as in
    /// [`ShapeMap`](super::ShapeMap).
    pub measure: fn(profile: &Profile, columns: u32, rows: u32) -> Measured,
}

/// The signed distance at each texel's centre, object units, and the rectangle that the solid
/// occupies; `None` if the grid shows no solid.
pub type Measured = (Vec<f32>, Option<Bounds>);

impl MapSource {
    /// Exact distance to the outline's segments.
    pub const EXACT: Self = Self {
        name: "exact",
        measure: exact,
    };
}

impl Default for MapSource {
    fn default() -> Self {
        Self::EXACT
    }
}

impl PartialEq for MapSource {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for MapSource {}

impl Hash for MapSource {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl fmt::Debug for MapSource {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Signed distance of each texel's centre to the outline's surface, object units, never greater
/// than the true distance.
fn exact(profile: &Profile, columns: u32, rows: u32) -> Measured {
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
