//! Prepared solids: everything that is made from one profile, keyed in one place and shared by all
//! objects that show it.
//!
//! The cache holds nothing alive. Objects do, and frames in flight; what the last of them lets go
//! is gone.

use super::device::Shared;
use super::levels;
use super::memory::Image;
use super::offset_surface::{OffsetSurface, Recipe};
use super::uploads::Uploads;
use crate::error::{Error, Result, Stage};
use crate::maps::envelope::Envelope;
use crate::maps::{ArcLength, BakeOptions, Bounds, MapFormat, MapSource, ShapeMap};
use crate::profile::Profile;
use crate::scene::{GrownProfiles, Growth, Object, Offset};
use crate::settings::SearchSettings;
use crate::surface::{Contour, ContourSource};
use ash::vk;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, OnceLock, Weak};

/// Most rows of a map whose box has grown.
const MOST_ROWS: f64 = 16384.0;

/// The solids of a renderer, by profile.
#[derive(Default)]
pub(crate) struct SolidCache {
    /// By the profile's address, which a solid keeps from being used again.
    solids: HashMap<usize, Weak<Solid>>,
    /// Profiles in boxes that have grown with offsets.
    pub grown: GrownProfiles,
}

/// All that is made from one profile.
pub(crate) struct Solid {
    pub outlined: Arc<Outlined>,
    surfaces: Kept<SurfaceKey, OffsetSurface>,
    maps: Kept<MapKey, ShapeTexture>,
    arcs: Kept<(u32, u32), ArcTexture>,
}

/// What of a profile does not depend on the offset.
pub(crate) struct Outlined {
    pub profile: Arc<Profile>,
    source: OnceLock<Result<ContourSource>>,
}

/// A table of weak references that forgets the dead.
struct Kept<K, V>(Mutex<HashMap<K, Weak<V>>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Hash + Eq, V> Kept<K, V> {
    fn get(&self, key: K, make: impl FnOnce() -> Result<V>) -> Result<Arc<V>> {
        let mut all = self
            .0
            .lock()
            .map_err(|_| Error::new(Stage::Draw, "a solid's lock is poisoned"))?;
        if let Some(known) = all.get(&key).and_then(Weak::upgrade) {
            return Ok(known);
        }
        if all.len() == all.capacity() {
            all.retain(|_, known| known.strong_count() > 0);
        }
        let made = Arc::new(make()?);
        all.insert(key, Arc::downgrade(&made));
        Ok(made)
    }
}

#[derive(PartialEq, Eq, Hash)]
enum SurfaceKey {
    /// Bits of the offset, level.
    Patches([u64; 3], u8),
    /// Likewise, rows, whether relaxed.
    Cones([u64; 3], u32, bool),
    /// The map, and bits of what its envelope is grown by.
    Envelope(MapKey, u64),
}

/// What a shape map is baked from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MapKey {
    pub rows: u32,
    pub source: MapSource,
    pub format: MapFormat,
    pub columns: u32,
}

/// A shape map on the device.
pub(crate) struct ShapeTexture {
    pub key: MapKey,
    pub facts: MapFacts,
    pub texture: Arc<Image>,
    envelope: Option<Envelope>,
}

/// Lengths along the outline on the device, for a map of the same size.
pub(crate) struct ArcTexture {
    /// Length of the longest part of the outline, object units.
    pub length: f64,
    pub texture: Arc<Image>,
}

/// What a shader must know of a map, baked or not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapFacts {
    pub columns: u32,
    pub rows: u32,
    pub scale: f32,
    pub bounds: Bounds,
}

impl SolidCache {
    /// The solid of a profile.
    pub fn get(&mut self, profile: &Arc<Profile>) -> Arc<Solid> {
        let key = Arc::as_ptr(profile) as usize;
        if let Some(known) = self.solids.get(&key).and_then(Weak::upgrade) {
            return known;
        }
        self.solids.retain(|_, known| known.strong_count() > 0);
        let solid = Arc::new(Solid::new(profile));
        self.solids.insert(key, Arc::downgrade(&solid));
        solid
    }
}

impl Solid {
    fn new(profile: &Arc<Profile>) -> Self {
        Self {
            outlined: Arc::new(Outlined {
                profile: profile.clone(),
                source: OnceLock::new(),
            }),
            surfaces: Kept::default(),
            maps: Kept::default(),
            arcs: Kept::default(),
        }
    }

    /// The boundary as quadrics; not made yet where it is new.
    pub fn patches(
        &self,
        offset: &Offset,
        growth: &Growth,
        level: u8,
    ) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Patches(bits(offset), level);
        self.surfaces.get(key, || {
            let tolerance = levels::bound(level) / growth.height();
            let recipe = Recipe::Patches(self.outlined.clone(), *offset, level, tolerance);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The boundary as empty cones; not made yet where it is new.
    pub fn cones(&self, offset: &Offset, rows: u32, relaxed: bool) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Cones(bits(offset), rows, relaxed);
        self.surfaces.get(key, || {
            let recipe = Recipe::Cones(self.outlined.clone(), *offset, rows, relaxed);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// Where the solid of `map` may be under offsets up to `by`; none of a solid that lies partly
    /// outside of its map.
    pub fn envelope(&self, map: &ShapeTexture, by: f64) -> Result<Option<Arc<OffsetSurface>>> {
        let Some(envelope) = &map.envelope else {
            return Ok(None);
        };
        let key = SurfaceKey::Envelope(map.key, by.to_bits());
        let made = self.surfaces.get(key, || {
            Ok(OffsetSurface::new(Recipe::Envelope(envelope.grown(by))))
        });
        made.map(Some)
    }

    /// The shape map, baked and on its way to the device where it is new.
    pub fn map(
        &self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        key: MapKey,
    ) -> Result<Arc<ShapeTexture>> {
        self.maps.get(key, || {
            ShapeTexture::bake(device, uploads, &self.outlined.profile, key)
        })
    }

    /// The table of lengths along the outline.
    pub fn arc(
        &self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        facts: &MapFacts,
    ) -> Result<Arc<ArcTexture>> {
        self.arcs.get((facts.columns, facts.rows), || {
            let lengths = ArcLength::new(&self.outlined.profile)?;
            let table = lengths.table(facts.columns, facts.rows);
            // 16-bit normalised textures are not everywhere; 32-bit floats are.
            let texels: Vec<f32> = table
                .texels
                .iter()
                .map(|t| f32::from(*t) / f32::from(u16::MAX))
                .collect();
            let size = (table.columns, table.rows);
            let bytes: &[u8] = bytemuck::cast_slice(&texels);
            let format = vk::Format::R32_SFLOAT;
            Ok(ArcTexture {
                length: lengths.total(),
                texture: uploads.image(device, "arc lengths", format, size, &[bytes])?,
            })
        })
    }
}

/// Of both zeros one.
fn bits(offset: &Offset) -> [u64; 3] {
    [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits())
}

impl Outlined {
    /// The contour under `offset`.
    ///
    /// # Errors
    /// Where the profile has none, or it does not close.
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
        let reach = super::block::reach(object, 2.0 / f64::from(rows.max(1)));
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

impl ShapeTexture {
    fn bake(
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
            envelope: Envelope::of(&map),
        })
    }
}
