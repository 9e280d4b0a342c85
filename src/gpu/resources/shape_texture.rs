//! Textures that are made from a profile: its shape map, which [`MapKey`] chooses, and lengths along
//! its outline.

use crate::error::Result;
use crate::gpu::memory::images::{Image, Uploads};
use crate::maps::{ArcLength, BakeOptions, MAX_SIDE, MapFormat, MapSource, ShapeMap};
use crate::profile::{Bounds, Profile};
use crate::scene::{Growth, Object};
use crate::settings::SearchSettings;
use crate::solid::reach;
use ash::vk;
use std::sync::Arc;

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

/// Steps, for each unit of height, in which a map grows beyond its box: a changing offset rarely makes
/// a map anew.
const REACH_STEPS: u32 = 8;

impl MapKey {
    /// The key of the map that `object` needs. The columns of the box come first, then as many
    /// [steps](REACH_STEPS) as its solid needs under its offset. The key follows from the object
    /// alone, so its pictures do, too.
    pub fn new(object: &Object, growth: &Growth, settings: &SearchSettings) -> Self {
        let source = settings.map_source.unwrap_or_default();
        let rows = settings.map_rows.unwrap_or(object.map_rows);
        // Texels of a grown box are as large as texels of the object's own box, those of a shrunk
        // box smaller.
        let grown = (f64::from(rows) * growth.height().max(1.0)).ceil() as u32;
        let rows = grown.min(MAX_SIDE.max(rows));
        let reach = reach(object, 2.0 / f64::from(rows.max(1)));
        let columns = |width: f64| (width * f64::from(rows) - 1e-9).ceil() as u32;
        let own = columns(object.profile.radius);
        let step = rows.div_ceil(REACH_STEPS).max(1);
        let beyond = columns(reach).saturating_sub(own);
        Self {
            rows,
            source,
            format: settings.map_format,
            columns: own.saturating_add(beyond.next_multiple_of(step)),
        }
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

pub(crate) struct ShapeTexture {
    // Kept because its address is the key of its textures.
    _profile: Arc<Profile>,
    pub facts: MapFacts,
    pub texture: Arc<Image>,
}

/// Lengths along the outline on the device, for a map of the same size.
pub(crate) struct ArcTexture {
    // Kept because its address is the key of its textures.
    _profile: Arc<Profile>,
    /// Length of the longest part of the outline, in object units.
    pub length: f64,
    pub texture: Arc<Image>,
}

impl ShapeTexture {
    /// Bakes the map, and queues its upload to the device.
    pub fn bake(uploads: &mut Uploads, profile: &Arc<Profile>, key: MapKey) -> Result<Self> {
        let options = BakeOptions {
            source: key.source,
            rows: key.rows,
            reach: f64::from(key.columns) / f64::from(key.rows),
        };
        let map = ShapeMap::bake(profile, &options)?;
        let encoded = map.encode(key.format)?;
        let format = match key.format {
            MapFormat::Rgba8 => vk::Format::R8G8B8A8_UNORM,
            MapFormat::R16 => vk::Format::R16_SFLOAT,
            MapFormat::R32 => vk::Format::R32_SFLOAT,
        };
        let size = (encoded.columns, encoded.rows);
        Ok(Self {
            _profile: profile.clone(),
            facts: MapFacts {
                columns: encoded.columns,
                rows: encoded.rows,
                scale: encoded.scale,
                bounds: map.bounds,
            },
            texture: uploads.image("shape map", format, size, &[&encoded.bytes])?,
        })
    }
}

impl ArcTexture {
    /// Makes the lengths for a map with these facts.
    pub fn new(uploads: &mut Uploads, profile: &Arc<Profile>, facts: &MapFacts) -> Result<Self> {
        let lengths = ArcLength::new(profile)?;
        let table = lengths.table(facts.columns, facts.rows)?;
        // Not every device has 16-bit normalised textures; all have 32-bit floats.
        let fraction = |texel: &u16| f32::from(*texel) / f32::from(u16::MAX);
        let texels = table.texels.iter().map(fraction);
        let texels = crate::host_memory::collected(texels, "the lengths of a profile")?;
        let size = (table.columns, table.rows);
        let bytes: &[u8] = bytemuck::cast_slice(&texels);
        let format = vk::Format::R32_SFLOAT;
        Ok(Self {
            _profile: profile.clone(),
            length: lengths.total(),
            texture: uploads.image("arc lengths", format, size, &[bytes])?,
        })
    }
}
