//! An outline, and its contours under offsets.

use crate::error::{Error, Result};
use crate::profile::Profile;
use crate::scene::Offset;
use crate::surface::{Contour, ContourSource, Cylinders};
use std::sync::{Arc, OnceLock};

/// A profile, and the source of its contours under offsets.
pub(crate) struct OutlineCache {
    pub profile: Arc<Profile>,
    source: OnceLock<Result<ContourSource>>,
    outer: OnceLock<Cylinders>,
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
    pub fn outer(&self) -> &Cylinders {
        let outline = &self.profile.outline;
        self.outer
            .get_or_init(|| Cylinders::around_outline(outline))
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

/// The contour of an outline under an offset, made on first use. Surfaces of all levels are made
/// from it.
pub(crate) struct OffsetContour {
    outline: Arc<OutlineCache>,
    offset: Offset,
    made: OnceLock<Result<Contour>>,
}

impl OffsetContour {
    pub fn new(outline: &Arc<OutlineCache>, offset: &Offset) -> Self {
        Self {
            outline: outline.clone(),
            offset: *offset,
            made: OnceLock::new(),
        }
    }

    /// True if it was made, or if making it failed.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }

    /// The contour, or the reason why there is none.
    pub fn get(&self) -> std::result::Result<&Contour, &Error> {
        let make = || self.outline.contour(&self.offset);
        self.made.get_or_init(make).as_ref()
    }
}
