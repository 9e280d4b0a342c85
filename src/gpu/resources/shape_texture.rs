//! Textures that are made from a profile: its shape map, which [`MapKey`] chooses, and lengths along
//! its outline.

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::memory::Image;
use crate::gpu::memory::images::Uploads;
use crate::maps::{ArcLength, BakeOptions, MapFormat, MapSource, ShapeMap};
use crate::profile::{Bounds, Profile};
use crate::scene::{Growth, Object};
use crate::settings::SearchSettings;
use crate::solid::reach::reach;
use ash::vk;
use std::sync::Arc;

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
        // Texels of a grown box are as large as texels of the object's own box, those of a shrunk
        // box smaller.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded
        let rows = (f64::from(rows) * growth.height().max(1.0))
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

/// A shape map on the device.
pub(crate) struct ShapeTexture {
    pub key: MapKey,
    pub facts: MapFacts,
    pub texture: Arc<Image>,
}

/// Lengths along the outline on the device, for a map of the same size.
pub(crate) struct ArcTexture {
    /// Length of the longest part of the outline, in object units.
    pub length: f64,
    pub texture: Arc<Image>,
}

impl ShapeTexture {
    /// Bakes the map, and queues its upload to the device.
    pub fn bake(
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        profile: &Profile,
        key: MapKey,
    ) -> Result<Self> {
        let options = BakeOptions {
            source: key.source,
            rows: key.rows,
            reach: f64::from(key.columns) / f64::from(key.rows),
        };
        let map = ShapeMap::bake(profile, &options)?;
        let encoded = map.encode(key.format);
        let format = match key.format {
            MapFormat::Rgba8 => vk::Format::R8G8B8A8_UNORM,
            MapFormat::R16 => vk::Format::R16_SFLOAT,
            MapFormat::R32 => vk::Format::R32_SFLOAT,
        };
        let size = (encoded.columns, encoded.rows);
        Ok(Self {
            key,
            facts: MapFacts {
                columns: encoded.columns,
                rows: encoded.rows,
                scale: encoded.scale,
                bounds: map.bounds,
            },
            texture: uploads.image(device, "shape map", format, size, &[&encoded.bytes])?,
        })
    }
}

impl ArcTexture {
    /// Makes the lengths for a map with these facts.
    pub fn new(
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        profile: &Profile,
        facts: &MapFacts,
    ) -> Result<Self> {
        let lengths = ArcLength::new(profile)?;
        let table = lengths.table(facts.columns, facts.rows);
        // Not every device has 16-bit normalised textures; all have 32-bit floats.
        let texels: Vec<f32> = table
            .texels
            .iter()
            .map(|t| f32::from(*t) / f32::from(u16::MAX))
            .collect();
        let size = (table.columns, table.rows);
        let bytes: &[u8] = bytemuck::cast_slice(&texels);
        let format = vk::Format::R32_SFLOAT;
        Ok(Self {
            length: lengths.total(),
            texture: uploads.image(device, "arc lengths", format, size, &[bytes])?,
        })
    }
}
