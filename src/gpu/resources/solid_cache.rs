//! Prepared solids: everything that is made from one profile, keyed in one place. All objects that
//! show the profile share the solid.
//!
//! The cache keeps nothing alive. Objects and frames in flight do; a value is dropped with the last
//! of them.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::images::Uploads;
use crate::gpu::resources::shape_texture::{ArcTexture, ShapeTexture};
use crate::gpu::resources::shape_texture::{MapFacts, MapKey};
use crate::plan::levels;
use crate::profile::Profile;
use crate::scene::{GrownProfiles, Growth, Offset};
use crate::search::Search;
use crate::solid::kept::Kept;
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use crate::solid::outline_cache::{OffsetContour, OutlineCache};
use std::hash::Hash;
use std::sync::{Arc, Mutex};

/// Solids by profile.
#[derive(Default)]
pub(crate) struct SolidCache {
    /// The key is the profile's address. A solid keeps its profile, so no other profile gets the
    /// address.
    solids: Kept<usize, Solid>,
    /// Profiles in boxes that have grown with offsets.
    pub grown: GrownProfiles,
}

/// Everything that is made from one profile.
pub(crate) struct Solid {
    pub outline: Arc<OutlineCache>,
    contours: Shelf<[u64; 3], OffsetContour>,
    surfaces: Shelf<SurfaceKey, OffsetSurface>,
    /// The key includes the uploading renderer: commands of two renderers may run in any order.
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
    /// Bits of the offset; level.
    Patches([u64; 3], u8),
    /// The search; bits of the offset; rows.
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
            contours: Shelf::default(),
            surfaces: Shelf::default(),
            maps: Shelf::default(),
            arcs: Shelf::default(),
        }
    }

    /// The contour under an offset. A new contour is not made yet.
    pub fn contour(&self, offset: &Offset) -> Result<Arc<OffsetContour>> {
        shelved(&self.contours, bits(offset), || {
            Ok(OffsetContour::new(&self.outline, offset))
        })
    }

    /// The boundary under an offset as quadrics. A new surface is not made yet.
    pub fn patches(
        &self,
        offset: &Offset,
        growth: &Growth,
        level: u8,
    ) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Patches(bits(offset), level);
        shelved(&self.surfaces, key, || {
            let tolerance = levels::bound(level) / growth.height().max(1.0);
            let recipe = Recipe::Patches(self.contour(offset)?, level, tolerance);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The table of a search of another crate. A new table is not made yet.
    pub fn search_table(
        &self,
        search: &'static Search,
        offset: &Offset,
        rows: u32,
    ) -> Result<Arc<OffsetSurface>> {
        let key = SurfaceKey::Search(search, bits(offset), rows);
        shelved(&self.surfaces, key, || {
            let recipe = Recipe::Search(search, self.contour(offset)?, rows);
            Ok(OffsetSurface::new(recipe))
        })
    }

    /// The shape map. A new map is baked, and its upload is queued.
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

/// The bits of an offset; both zeros give the same bits.
fn bits(offset: &Offset) -> [u64; 3] {
    [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits())
}
