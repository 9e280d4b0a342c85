//! Textures and shape maps as files, and distances that are measured in pixels.

pub(crate) mod header;
mod shape_map;
mod source;
mod texture;
mod transform;

pub use shape_map::{shape_map, write_shape_map};
pub use source::{BINARY, COVERAGE, MAP_SOURCES};
pub use texture::{color_map, displacement_map, write_displacement_map};

use revmap::maps::Projection;
use std::path::{Path, PathBuf};

/// The projection in a file's name before its extension, in upper or lower case.
///
/// ```
/// use revmap::maps::Projection;
/// use revmap_files::projection_of;
/// assert_eq!(projection_of("maps/vase.Spherical.png"), Some(Projection::Spherical));
/// assert_eq!(projection_of("vase.png"), None);
/// ```
#[must_use]
pub fn projection_of(path: impl AsRef<Path>) -> Option<Projection> {
    let stem = PathBuf::from(path.as_ref().file_stem()?);
    let name = stem.extension()?.to_str()?;
    let mut named = Projection::NAMES.into_iter();
    let found = named.find(|(own, _)| own.eq_ignore_ascii_case(name));
    found.map(|(_, projection)| projection)
}
