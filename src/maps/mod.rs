//! Maps made from a profile: signed distances on a grid, and their storage formats.

mod arc;
mod mips;
mod nearest;
mod rounding;
mod shape_map;
mod store;
mod textures;

pub use crate::profile::Bounds;
pub use arc::{ArcLength, ArcTable};
pub use mips::Level;
#[doc(hidden)]
pub use rounding::round_down;
pub use shape_map::{BakeOptions, MapSource, Measured, ShapeMap};
pub use store::EncodedMap;
pub use textures::{ColorMap, DisplacementMap, SlopeFilter};

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

/// The projection that lays a texture onto a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// `(x, y)` of the box, seen from above.
    Planar,
    /// Azimuth and height.
    #[default]
    Cylindrical,
    /// Azimuth and polar angle about the middle of the box.
    Spherical,
    /// Azimuth and length along the profile.
    Arc,
}

impl Projection {
    /// Every projection with its name in scene files and file names.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("planar", Self::Planar),
        ("cylindrical", Self::Cylindrical),
        ("spherical", Self::Spherical),
        ("arc", Self::Arc),
    ];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(&Self::NAMES, &self)
    }
}
