//! Prepared solids: everything that is made from one profile, keyed in one place. All objects that
//! show the profile share the solid.
//!
//! The cache keeps nothing alive. Objects and frames in flight do; a value is dropped with the last
//! of them.

use crate::error::{Result, lock};
use crate::profile::Profile;
use crate::scene::{GrownProfiles, Offset};
use crate::search::Search;
use crate::solid::contour::{OffsetContour, OutlineSource};
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, Weak};

/// Weak references by key: a value stays as long as an owner holds it elsewhere.
pub(crate) struct Kept<K, V>(HashMap<K, Weak<V>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Hash + Eq, V> Kept<K, V> {
    /// The value of a key, if it is alive.
    pub fn known(&self, key: &K) -> Option<Arc<V>> {
        self.0.get(key).and_then(Weak::upgrade)
    }

    /// Adds a new value. Removes dead entries first if the table would grow.
    pub fn keep(&mut self, key: K, value: V) -> Arc<V> {
        if self.0.len() == self.0.capacity() {
            self.0.retain(|_, known| known.strong_count() > 0);
        }
        let made = Arc::new(value);
        self.0.insert(key, Arc::downgrade(&made));
        made
    }

    /// The value of a key; made now if it is not alive.
    pub fn get(&mut self, key: K, make: impl FnOnce() -> Result<V>) -> Result<Arc<V>> {
        match self.known(&key) {
            Some(known) => Ok(known),
            None => Ok(self.keep(key, make()?)),
        }
    }

    pub fn living(&self) -> impl Iterator<Item = Arc<V>> + '_ {
        self.0.values().filter_map(Weak::upgrade)
    }
}

#[derive(Default)]
pub(crate) struct SolidCache {
    /// The key is the profile's address. A solid keeps its profile, so no other profile gets the
    /// address.
    solids: Kept<usize, Solid>,
    /// Profiles in boxes that have grown with offsets.
    pub grown: GrownProfiles,
}

impl SolidCache {
    pub fn get(&mut self, profile: &Arc<Profile>) -> Arc<Solid> {
        let key = Arc::as_ptr(profile) as usize;
        let known = self.solids.known(&key);
        known.unwrap_or_else(|| self.solids.keep(key, Solid::new(profile)))
    }

    pub fn surfaces(&self) -> Result<Vec<Arc<OffsetSurface>>> {
        let mut all = Vec::new();
        for solid in self.solids.living() {
            all.extend(lock(&solid.surfaces)?.living());
        }
        Ok(all)
    }
}

pub(crate) struct Solid {
    source: Arc<OutlineSource>,
    contours: Mutex<Kept<[u64; 3], OffsetContour>>,
    surfaces: Mutex<Kept<SurfaceKey, OffsetSurface>>,
}

/// The search that the table is of, if any; bits of the offset; level, or rows of the table.
type SurfaceKey = (Option<&'static Search>, [u64; 3], u32);

impl Solid {
    pub fn new(profile: &Arc<Profile>) -> Self {
        Self {
            source: Arc::new(OutlineSource::new(profile)),
            contours: Mutex::default(),
            surfaces: Mutex::default(),
        }
    }

    /// The contour under an offset. A new contour is not made yet.
    pub fn contour(&self, offset: &Offset) -> Result<Arc<OffsetContour>> {
        lock(&self.contours)?.get(bits(offset), || {
            Ok(OffsetContour::new(&self.source, offset))
        })
    }

    /// The surface of a recipe under an offset. A new surface is not made yet.
    pub fn surface(&self, offset: &Offset, recipe: Recipe) -> Result<Arc<OffsetSurface>> {
        let (search, part) = match recipe {
            Recipe::Patches { level, .. } => (None, level.into()),
            Recipe::Table { search, rows } => (Some(search), rows),
        };
        lock(&self.surfaces)?.get((search, bits(offset), part), || {
            Ok(OffsetSurface::new(self.contour(offset)?, recipe))
        })
    }
}

/// The bits of an offset; both zeros give the same bits.
fn bits(offset: &Offset) -> [u64; 3] {
    [offset.extend, offset.bevel, offset.chamfer].map(|v| (v + 0.0).to_bits())
}
