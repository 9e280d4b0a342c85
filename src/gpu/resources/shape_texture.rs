//! Textures that are made from a profile: its shape map, and lengths along its outline.

use crate::error::Result;
use crate::gpu::device::Shared;
use crate::gpu::memory::Image;
use crate::gpu::memory::uploads::Uploads;
use crate::gpu::resources::map_key::{MapFacts, MapKey};
use crate::maps::{ArcLength, BakeOptions, MapFormat, ShapeMap};
use crate::profile::Profile;
use ash::vk;
use std::sync::Arc;

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
