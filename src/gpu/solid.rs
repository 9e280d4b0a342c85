//! Prepared solids: everything that is made from one profile, keyed in one place and shared by all
//! objects that show it.
//!
//! The cache holds nothing alive. Objects do, and frames in flight; what the last of them lets go
//! is gone.

use super::device::Shared;
use super::kept::Kept;
use super::levels;
use super::map_key::{MapFacts, MapKey};
use super::offset_surface::{OffsetSurface, Recipe};
use super::outlined::Outlined;
use super::shape_texture::{ArcTexture, ShapeTexture};
use super::uploads::Uploads;
use crate::error::{Error, Result, Stage};
use crate::profile::Profile;
use crate::scene::{GrownProfiles, Growth, Offset};
use std::hash::Hash;
use std::sync::{Arc, Mutex};

/// The solids of a renderer, by profile.
#[derive(Default)]
pub(crate) struct SolidCache {
    /// By the profile's address, which a solid keeps from being used again.
    solids: Kept<usize, Solid>,
    /// Profiles in boxes that have grown with offsets.
    pub grown: GrownProfiles,
}

/// All that is made from one profile.
pub(crate) struct Solid {
    pub outlined: Arc<Outlined>,
    surfaces: Shelf<SurfaceKey, OffsetSurface>,
    maps: Shelf<MapKey, ShapeTexture>,
    arcs: Shelf<(u32, u32), ArcTexture>,
}

/// A table for several threads.
type Shelf<K, V> = Mutex<Kept<K, V>>;

fn shelved<K: Hash + Eq, V>(
    shelf: &Shelf<K, V>,
    key: K,
    make: impl FnOnce() -> Result<V>,
) -> Result<Arc<V>> {
    let poisoned = |_| Error::new(Stage::Draw, "a solid's lock is poisoned");
    shelf.lock().map_err(poisoned)?.get(key, make)
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

impl SolidCache {
    /// The solid of a profile.
    pub fn get(&mut self, profile: &Arc<Profile>) -> Arc<Solid> {
        let key = Arc::as_ptr(profile) as usize;
        let known = self.solids.known(&key);
        known.unwrap_or_else(|| self.solids.keep(key, Solid::new(profile)))
    }
}

impl Solid {
    fn new(profile: &Arc<Profile>) -> Self {
        Self {
            outlined: Arc::new(Outlined::new(profile)),
            surfaces: Shelf::default(),
            maps: Shelf::default(),
            arcs: Shelf::default(),
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
        shelved(&self.surfaces, key, || {
            let tolerance = levels::bound(level) / growth.height();
            let recipe = Recipe::Patches(self.outlined.clone(), *offset, level, tolerance);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The boundary as empty cones; not made yet where it is new.
    pub fn cones(&self, offset: &Offset, rows: u32, relaxed: bool) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Cones(bits(offset), rows, relaxed);
        shelved(&self.surfaces, key, || {
            let recipe = Recipe::Cones(self.outlined.clone(), *offset, rows, relaxed);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// Where the solid of `map` may be under offsets up to `by`; none of a solid that lies partly
    /// outside of its map.
    pub fn envelope(&self, map: &ShapeTexture, by: f64) -> Result<Option<Arc<OffsetSurface>>> {
        let Some(envelope) = map.envelope() else {
            return Ok(None);
        };
        let key = SurfaceKey::Envelope(map.key, by.to_bits());
        let made = shelved(&self.surfaces, key, || {
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
        shelved(&self.maps, key, || {
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
        shelved(&self.arcs, (facts.columns, facts.rows), || {
            ArcTexture::new(device, uploads, &self.outlined.profile, facts)
        })
    }
}

/// Of both zeros one.
fn bits(offset: &Offset) -> [u64; 3] {
    [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits())
}
