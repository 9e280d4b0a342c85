//! Maps made from a profile: signed distances on a grid, and their storage formats.

pub mod accuracy;
mod arc;
mod binary;
mod color;
mod displacement;
mod exact;
mod files;
mod half;
mod halving;
pub(crate) mod header;
mod nearest;
mod rounding;
mod shape_map;
mod store;
pub mod transform;

pub use arc::{ArcLength, ArcTable};
pub use color::ColorMap;
pub use displacement::{DisplacementMap, Level, SlopeFilter};
pub use files::Projection;
pub use store::EncodedMap;

use crate::settings::name_of;

/// The method that measures distances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MapSource {
    /// The papers' method: exact Euclidean distance to the nearest solid pixel's centre of a binary
    /// image.
    Binary,
    /// Distance to the outline of an anti-aliased picture of the map's own size: the outline is
    /// rasterised to 8 bits of coverage and traced again.
    Coverage,
    /// Exact distance to the outline's segments.
    #[default]
    Exact,
}

impl MapSource {
    /// The names in options and files.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("binary", Self::Binary),
        ("coverage", Self::Coverage),
        ("exact", Self::Exact),
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}

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

/// The rectangle of the half-plane that the solid occupies, object units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest `r`.
    pub r_min: f64,
    /// Largest `r`.
    pub r_max: f64,
    /// Lowest `z`.
    pub z_min: f64,
    /// Highest `z`.
    pub z_max: f64,
}
