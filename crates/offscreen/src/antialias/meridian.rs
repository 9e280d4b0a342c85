//! The part of an object's silhouettes that is independent of the view: its boundary as patches, as
//! coarse as a copy's size on the screen allows.

use revmap::error::Result;
use revmap::scene::{GrownProfiles, Object, Placement};
use revmap::surface::{Contour, ContourSource, FitOptions, QuadricPatch, fit_patches};
use std::sync::OnceLock;

/// Number of levels, each twice as coarse as the one before.
const LEVELS: usize = 13;
/// Largest distance between patches and the boundary, pixels.
pub(super) const TOLERANCE: f64 = 1.0 / 16.0;

/// The boundary of an object, prepared.
pub(super) struct Meridian {
    /// The object in the box that is enlarged for its offset.
    pub object: Object,
    contour: Contour,
    levels: [OnceLock<Vec<QuadricPatch>>; LEVELS],
}

impl Meridian {
    /// Returns `None` for replicas, which their cells cut.
    ///
    /// # Errors
    /// The contour does not close.
    pub fn new(object: &Object) -> Result<Option<Self>> {
        if object.repeat != [1; 3] {
            return Ok(None);
        }
        let grown = GrownProfiles::default().grown(object);
        let object = grown.map_or_else(|| object.clone(), |grown| grown.object);
        let contour = ContourSource::new(&object.profile.outline)?.contour(&object.offset)?;
        Ok(Some(Self {
            object,
            contour,
            levels: Default::default(),
        }))
    }

    /// The patches for a copy with `pixels` pixels per object unit.
    pub fn patches(&self, pixels: f64) -> &[QuadricPatch] {
        let exact = FitOptions::default().tolerance;
        let coarser = (TOLERANCE / (pixels * exact)).log2().floor();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
        let level = coarser.clamp(0.0, LEVELS as f64 - 1.0) as usize;
        self.levels[level].get_or_init(|| {
            let tolerance = exact * f64::from(1u32 << level);
            fit_patches(&self.contour, &FitOptions { tolerance })
        })
    }

    /// Distance from the middle of a copy's box to its corners.
    pub fn size(&self, copy: &Placement) -> f64 {
        let radius = self.object.profile.radius;
        (glam::DVec3::new(radius, radius, 0.5) * copy.scale).length()
    }
}
