//! The part of a contour that does not depend on the offset.

use crate::error::Result;
use crate::profile::Profile;
use crate::scene::Offset;
use crate::surface::{Contour, ContourSource, OuterCylinders};
use std::sync::{Arc, OnceLock};

/// A profile, and the source of its contours under offsets.
pub(crate) struct OutlineCache {
    pub profile: Arc<Profile>,
    source: OnceLock<Result<ContourSource>>,
    outer: OnceLock<OuterCylinders>,
}

impl OutlineCache {
    pub fn new(profile: &Arc<Profile>) -> Self {
        Self {
            profile: profile.clone(),
            source: OnceLock::new(),
            outer: OnceLock::new(),
        }
    }

    /// Cylinders that contain the solid without its offset.
    pub fn outer(&self) -> &OuterCylinders {
        let outline = &self.profile.outline;
        self.outer
            .get_or_init(|| OuterCylinders::of_outline(outline))
    }

    /// The contour under `offset`.
    ///
    /// # Errors
    /// Fails if the profile has no contour, or if the contour does not close.
    pub fn contour(&self, offset: &Offset) -> Result<Contour> {
        let source = self
            .source
            .get_or_init(|| ContourSource::new(&self.profile.outline));
        match source {
            Ok(source) => source.contour(offset),
            Err(error) => Err(error.clone()),
        }
    }
}
