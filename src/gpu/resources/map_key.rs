//! The choice of an object's shape map.

use crate::maps::{Bounds, MapFormat, MapSource};
use crate::profile::Profile;
use crate::scene::{Growth, Object};
use crate::settings::SearchSettings;
use crate::solid::reach::reach;

/// Upper limit on rows of a map whose box has grown.
const MOST_ROWS: f64 = 16384.0;

/// The parameters that a shape map is baked from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MapKey {
    pub rows: u32,
    pub source: MapSource,
    pub format: MapFormat,
    pub columns: u32,
}

/// Facts about a map that a shader needs, baked or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapFacts {
    pub columns: u32,
    pub rows: u32,
    pub scale: f32,
    pub bounds: Bounds,
}

impl MapKey {
    /// The key of the map that `object` needs. `columns` is the number that its solid needs under
    /// its offset.
    pub fn new(object: &Object, growth: &Growth, settings: &SearchSettings) -> Self {
        let source = settings.map_source.unwrap_or_default();
        let rows = settings.map_rows.unwrap_or(object.map_rows);
        // Texels of a grown box are as large as texels of the object's own box.
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

    /// Returns true if a map of this key can replace a map of the key `other`. Such a map may reach
    /// farther.
    pub fn holds(&self, other: &Self) -> bool {
        self.columns >= other.columns
            && Self {
                columns: other.columns,
                ..*self
            } == *other
    }

    /// The facts for a shader if no map is baked: the map's size, and the bounds of the solid.
    pub fn unbaked(&self, profile: &Profile) -> MapFacts {
        MapFacts {
            columns: self.columns,
            rows: self.rows,
            scale: 1.0,
            // A missing solid clips nothing and returns no hit.
            bounds: profile.outline.bounds().unwrap_or(Bounds {
                r_min: 0.0,
                r_max: profile.radius,
                z_min: 0.0,
                z_max: 1.0,
            }),
        }
    }
}
