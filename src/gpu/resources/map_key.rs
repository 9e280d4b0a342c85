//! Which shape map an object reads.

use crate::maps::{Bounds, MapFormat, MapSource};
use crate::profile::Profile;
use crate::scene::{Growth, Object};
use crate::settings::SearchSettings;
use crate::solid::reach::reach;

/// Most rows of a map whose box has grown.
const MOST_ROWS: f64 = 16384.0;

/// What a shape map is baked from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MapKey {
    pub rows: u32,
    pub source: MapSource,
    pub format: MapFormat,
    pub columns: u32,
}

/// What a shader must know of a map, baked or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapFacts {
    pub columns: u32,
    pub rows: u32,
    pub scale: f32,
    pub bounds: Bounds,
}

impl MapKey {
    /// The map that `object` wants; `columns` as many as its solid needs under its offset.
    pub fn new(object: &Object, growth: &Growth, settings: &SearchSettings) -> Self {
        let source = settings.map_source.unwrap_or_default();
        let rows = settings.map_rows.unwrap_or(object.map_rows);
        // Texels of a grown box are as large as those of its own.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded
        let rows = (f64::from(rows) * growth.height())
            .ceil()
            .min(MOST_ROWS.max(f64::from(rows))) as u32;
        let reach = reach(object, 2.0 / f64::from(rows.max(1)));
        Self {
            rows,
            source,
            format: settings.map_format,
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most some 10^4
            columns: (reach.max(object.profile.radius) * f64::from(rows) - 1e-9).ceil() as u32,
        }
    }

    /// Whether a map of this key serves where `other` is wanted: it may reach farther.
    pub fn holds(&self, other: &Self) -> bool {
        self.columns >= other.columns
            && Self {
                columns: other.columns,
                ..*self
            } == *other
    }

    /// What a shader is told of the map where no map is baked: its size, and what the solid
    /// occupies.
    pub fn unbaked(&self, profile: &Profile) -> MapFacts {
        MapFacts {
            columns: self.columns,
            rows: self.rows,
            scale: 1.0,
            // Of a solid that is not there nothing is clipped; nothing is met either.
            bounds: profile.outline.bounds().unwrap_or(Bounds {
                r_min: 0.0,
                r_max: profile.radius,
                z_min: 0.0,
                z_max: 1.0,
            }),
        }
    }
}
