//! The contour of a profile under an offset, and the outline that it is made from.

use crate::error::{Error, Result};
use crate::profile::{Outline, Profile};
use crate::scene::Offset;
use crate::surface::{Contour, ContourSource};
use std::sync::{Arc, OnceLock};

/// The outline of a profile in the form that contours are made from, made on first use.
pub(crate) struct OutlineSource {
    profile: Arc<Profile>,
    made: OnceLock<Result<ContourSource>>,
}

impl OutlineSource {
    pub fn new(profile: &Arc<Profile>) -> Self {
        Self {
            profile: profile.clone(),
            made: OnceLock::new(),
        }
    }

    pub fn outline(&self) -> &Outline {
        &self.profile.outline
    }

    fn get(&self) -> Result<&ContourSource> {
        let made = self.made.get_or_init(|| ContourSource::new(self.outline()));
        made.as_ref().map_err(Clone::clone)
    }
}

/// The contour of a profile under an offset, made on first use. Surfaces of all levels are made from
/// it.
pub(crate) struct OffsetContour {
    source: Arc<OutlineSource>,
    offset: Offset,
    made: OnceLock<Result<Contour>>,
}

impl OffsetContour {
    pub fn new(source: &Arc<OutlineSource>, offset: &Offset) -> Self {
        Self {
            source: source.clone(),
            offset: *offset,
            made: OnceLock::new(),
        }
    }

    /// True if it was made, or if making it failed.
    pub fn is_made(&self) -> bool {
        self.made.get().is_some()
    }

    /// The contour. The reason why there is none: the profile has none, or it does not close.
    pub fn get(&self) -> std::result::Result<&Contour, &Error> {
        let make = || self.source.get()?.contour(&self.offset);
        self.made.get_or_init(make).as_ref()
    }
}
