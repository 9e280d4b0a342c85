//! The ways to lay a texture onto a solid.

use crate::names::name_of;

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
