//! Prepared solids: everything that is made from one profile, keyed in one place and shared by all
//! objects that show it.
//!
//! The cache holds nothing alive. Objects do, and frames in flight; what the last of them lets go
//! is gone.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::uploads::Uploads;
use crate::gpu::resources::map_key::{MapFacts, MapKey};
use crate::gpu::resources::shape_texture::{ArcTexture, ShapeTexture};
use crate::plan::levels;
use crate::profile::Profile;
use crate::scene::{GrownProfiles, Growth, Offset};
use crate::search::Search;
use crate::solid::kept::Kept;
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use crate::solid::outline_cache::OutlineCache;
use std::hash::Hash;
use std::sync::{Arc, Mutex};

/// Solids by profile.
#[derive(Default)]
pub(crate) struct SolidCache {
    /// By the profile's address, which a solid keeps from being used again.
    solids: Kept<usize, Solid>,
    /// Profiles in boxes that have grown with offsets.
    pub grown: GrownProfiles,
}

/// All that is made from one profile.
pub(crate) struct Solid {
    pub outline: Arc<OutlineCache>,
    surfaces: Shelf<SurfaceKey, OffsetSurface>,
    /// By who uploads them, too: commands of two renderers may run in any order.
    maps: Shelf<(u32, MapKey), ShapeTexture>,
    arcs: Shelf<(u32, u32, u32), ArcTexture>,
}

/// A table for several threads.
type Shelf<K, V> = Mutex<Kept<K, V>>;

fn shelved<K: Hash + Eq, V>(
    shelf: &Shelf<K, V>,
    key: K,
    make: impl FnOnce() -> Result<V>,
) -> Result<Arc<V>> {
    let poisoned = |_| Error::new(ErrorKind::Other, "a solid's lock is poisoned");
    shelf.lock().map_err(poisoned)?.get(key, make)
}

#[derive(PartialEq, Eq, Hash)]
enum SurfaceKey {
    /// Bits of the offset, level.
    Patches([u64; 3], u8),
    /// Likewise; rows.
    Search(&'static Search, [u64; 3], u32),
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
            outline: Arc::new(OutlineCache::new(profile)),
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
            let recipe = Recipe::Patches(self.outline.clone(), *offset, level, tolerance);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The table of a search of another crate; not made yet where it is new.
    pub fn search_table(
        &self,
        search: &'static Search,
        offset: &Offset,
        rows: u32,
    ) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Search(search, bits(offset), rows);
        shelved(&self.surfaces, key, || {
            let recipe = Recipe::Search(search, self.outline.clone(), *offset, rows);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The shape map, baked and on its way to the device where it is new.
    pub fn map(
        &self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        key: MapKey,
    ) -> Result<Arc<ShapeTexture>> {
        shelved(&self.maps, (uploads.owner(), key), || {
            ShapeTexture::bake(device, uploads, &self.outline.profile, key)
        })
    }

    /// The table of lengths along the outline.
    pub fn arc(
        &self,
        device: &Arc<Shared>,
        uploads: &mut Uploads,
        facts: &MapFacts,
    ) -> Result<Arc<ArcTexture>> {
        shelved(
            &self.arcs,
            (uploads.owner(), facts.columns, facts.rows),
            || ArcTexture::new(device, uploads, &self.outline.profile, facts),
        )
    }
}

/// Of both zeros one.
fn bits(offset: &Offset) -> [u64; 3] {
    [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits())
}
