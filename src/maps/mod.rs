//! Maps made from a profile: signed distances on a grid, and their storage formats.

mod arc;
mod color;
mod displacement;
mod half;
mod halving;
mod nearest;
mod projection;
mod rounding;
mod shape_map;
mod source;
mod store;

pub use crate::profile::Bounds;
pub use arc::{ArcLength, ArcTable};
pub use color::ColorMap;
pub use displacement::{DisplacementMap, Level, SlopeFilter};
pub use projection::Projection;
pub use rounding::round_down;
pub use source::{MapSource, Measured};
pub use store::EncodedMap;

use crate::names::name_of;

/// Largest number of texels on a side of a map.
pub const MAX_SIDE: u32 = 16_384;

/// The storage format of distances on the GPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapFormat {
    /// The papers' texture: R, G gradient, B unsigned distance, A form; 8 bits each.
    Rgba8,
    /// Signed distance as a 16-bit float.
    R16,
    /// Signed distance as a 32-bit float.
    R32,
}

impl MapFormat {
    /// The names in options and results.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("rgba8", Self::Rgba8),
        ("r16", Self::R16),
        ("r32", Self::R32),
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}

/// Options for baking a shape map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeOptions {
    /// The method that measures distances.
    pub source: MapSource,
    /// Rows of the map: one object unit is this many texels.
    pub rows: u32,
    /// The map covers `0 <= r <= reach`, object units; at least the profile's radius. A larger
    /// reach is needed for solids that extend past their cylinder: polygons wider than their box,
    /// offsets, an axis off the middle.
    pub reach: f64,
}

/// Signed distances to the profile's boundary on a grid of square texels.
///
/// Texel `(i, j)` is sampled at `r = (i + 0.5) h`, `z = 1 - (j + 0.5) h`, with `h = 1 / rows`: row
/// 0 is the top.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeMap {
    /// Texels along `r`.
    pub columns: u32,
    /// Texels along `z`.
    pub rows: u32,
    /// `R` of the shape box, object units (the map may reach farther).
    pub radius: f64,
    /// The method that measured the distances.
    pub source: MapSource,
    /// Signed distance in object units, positive outside; row by row from the top.
    pub distance: Vec<f32>,
    /// True for texels whose centre is solid; row by row from the top.
    pub form: Vec<bool>,
    /// The part of the half-plane that the solid occupies.
    pub bounds: Bounds,
}
