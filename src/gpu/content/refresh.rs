//! Conversion of values to all that does not depend on a view: solids, contours, maps, textures and
//! variants. All is derived before any new value is stored. A failure restores what
//! shadows need of all objects.

use super::Content;
use super::entry::{Derived, Entry};
use crate::error::{Error, ErrorKind, Result, lock};
use crate::gpu::resources::block::check_format;
use crate::gpu::resources::shape_texture::{MapKey, ShapeTexture};
use crate::gpu::resources::textures::{BoundTextures, ShadowMaps};
use crate::maps::Projection;
use crate::scene::{GrownObject, Growth, Object};
use crate::settings::Solver;
use crate::shader::ShadowCasters;
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::solid::cache::{OffsetContour, Solid};
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::Arc;

/// The search for objects without a surface of their own; it reads only the map.
pub(in crate::gpu) const FALLBACK: Solver = Solver::Live;

/// An object for which all is derived anew, and what was found for it so far.
struct Resolved {
    number: u32,
    /// The object in a box that has grown.
    grown: Option<GrownObject>,
    solid: Arc<Solid>,
    /// The contour of a search on patches, made.
    contour: Option<Arc<OffsetContour>>,
    /// The table of another crate's search, made.
    table: Option<Arc<OffsetSurface>>,
    map: Option<Arc<ShapeTexture>>,
}

impl Resolved {
    /// The object that is drawn for `entry`, and the growth of its box.
    fn shown<'a>(&'a self, entry: &'a Entry) -> (&'a Object, Growth) {
        let own = (entry.latest(), Growth::default());
        self.grown.as_ref().map_or(own, |g| (&g.object, g.growth))
    }

    /// True if the search on patches has no contour to search.
    fn fails(&self) -> bool {
        self.contour.as_ref().is_some_and(|c| c.get().is_err())
    }
}

impl Content {
    /// Applies the values that were added and set since the last call. After an error, objects
    /// added since that call are left out until they are set again. Lights and all other values but
    /// placements and copies are again those of that call.
    pub fn refresh(&mut self) -> Result<()> {
        if self.changed.is_empty() {
            return Ok(());
        }
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        let before = (self.all_fall_back, self.casters, self.shadow_maps.clone());
        let result = self.apply(&changed);
        if result.is_ok() {
            self.lit.clone_from(&self.lighting);
        } else {
            self.lighting.clone_from(&self.lit);
            (self.all_fall_back, self.casters, self.shadow_maps) = before;
            for number in changed {
                self.forget(number)?;
            }
        }
        result
    }

    /// Drops the values that were set for an entry.
    fn forget(&mut self, number: u32) -> Result<()> {
        let version = self.version + 1;
        let Some(entry) = self.objects.at_mut(number) else {
            return Ok(());
        };
        entry.wanted = None;
        entry.wanted_images = None;
        entry.version = version;
        self.version = version;
        let count = entry.object.placements().len();
        if entry.instances.len() != count {
            self.objects.resize(number, count)?;
        }
        Ok(())
    }

    /// Derives all of the changed objects, and of all others if data that they share changes.
    fn apply(&mut self, changed: &[u32]) -> Result<()> {
        let mut work = self.resolve(changed)?;
        let common = (self.falls_back(&work), self.shadow_casters());
        if common != (self.all_fall_back, self.casters) {
            (self.all_fall_back, self.casters) = common;
            // Other code draws each object from now on.
            work.extend(self.resolve(&self.others(&work))?);
        }
        self.find_maps(&mut work)?;
        let shadow_maps = self.shadow_maps_with(&work)?;
        if !Arc::ptr_eq(&shadow_maps, &self.shadow_maps) {
            self.shadow_maps = shadow_maps;
            // Each object binds the new maps.
            let mut others = self.resolve(&self.others(&work))?;
            self.find_maps(&mut others)?;
            work.extend(others);
        }
        let mut ready = Vec::with_capacity(work.len());
        for one in work {
            let derived = self.derive(&one);
            let derived = derived.map_err(|e| self.named(e, one.number, "profile"))?;
            ready.push((one.number, one.grown, derived));
        }
        self.version += 1;
        let version = self.version;
        for (number, grown, derived) in ready {
            let Some(entry) = self.objects.at_mut(number) else {
                continue;
            };
            if let Some(wanted) = entry.wanted.take() {
                entry.object = wanted;
            }
            if let Some(images) = entry.wanted_images.take() {
                entry.images = images;
            }
            entry.grown = grown;
            entry.derived = Some(derived);
            entry.version = version;
        }
        Ok(())
    }

    /// The numbers of all other objects.
    fn others(&self, work: &[Resolved]) -> Vec<u32> {
        let known: HashSet<u32> = work.iter().map(|one| one.number).collect();
        let mut all = self.objects.numbers();
        all.retain(|number| !known.contains(number));
        all
    }

    /// Finds or makes the solids, contours and tables of objects, on all cores.
    fn resolve(&mut self, numbers: &[u32]) -> Result<Vec<Resolved>> {
        let solver = self.settings.solver;
        let mut resolved = Vec::with_capacity(numbers.len());
        let mut geometry = lock(&self.geometry)?;
        for &number in numbers {
            let Some(entry) = self.objects.at(number) else {
                continue;
            };
            let grown = geometry.solids.grown.grown(entry.latest());
            let object = grown.as_ref().map_or(entry.latest(), |g| &g.object);
            let growth = grown.as_ref().map(|g| g.growth).unwrap_or_default();
            let solid = geometry.solids.get(&object.profile);
            let (mut contour, mut table) = (None, None);
            if solver.follows_tolerance() {
                contour = Some(solid.contour(&object.offset)?);
            } else if let (Solver::Other(search), false) = (solver, solver.reads_map()) {
                let rows = MapKey::new(object, &growth, &self.settings).rows;
                table = Some(solid.surface(&object.offset, Recipe::Table { search, rows })?);
            }
            resolved.push(Resolved {
                number,
                grown,
                solid,
                contour,
                table,
                map: None,
            });
        }
        drop(geometry);
        self.rebuilds += make_contours(&resolved);
        let tables: Vec<_> = resolved.iter().filter_map(|r| r.table.clone()).collect();
        self.make_surfaces(&tables);
        for one in &resolved {
            if let Some(error) = one.table.as_ref().and_then(|table| table.failure()) {
                return Err(self.named(error.clone(), one.number, "profile"));
            }
            let error = one.contour.as_ref().and_then(|c| c.get().err());
            self.note_fallback(one.number, error);
        }
        Ok(resolved)
    }

    /// Adds a note on an object whose contour failed with this error.
    fn note_fallback(&mut self, number: u32, error: Option<&Error>) {
        let Some(error) = error else {
            return;
        };
        let name = self.objects.at(number).map_or("", |e| &e.latest().name);
        let note = format!(
            "object.{} ({name}) is drawn by the search {} in place of {}: {}",
            self.objects.position(number),
            FALLBACK.name(),
            self.settings.solver.name(),
            error.message
        );
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    /// Returns true if shadows force the fallback on all objects: a shadow's ray meets every solid
    /// by one search.
    fn falls_back(&self, work: &[Resolved]) -> bool {
        let fails = |derived: &Derived| {
            let contour = derived.contour.as_ref();
            contour.is_some_and(|contour| contour.get().is_err())
        };
        let old = |number: &u32| {
            let entry = self.objects.at(*number);
            entry.is_some_and(|entry| entry.derived.as_ref().is_some_and(fails))
        };
        self.casts() && (work.iter().any(Resolved::fails) || self.others(work).iter().any(old))
    }

    /// The properties of solids that shadow rays may meet; the default without shadows.
    fn shadow_casters(&self) -> ShadowCasters {
        if !self.casts() {
            return ShadowCasters::default();
        }
        let objects = || self.objects.ordered().map(|(_, e)| e.latest());
        ShadowCasters {
            repeated: objects().any(|o| o.repeat != [1; 3]),
            beveled: objects().any(|o| o.offset.bevel != 0.0),
        }
    }

    /// The search that draws an object.
    fn solver_of(&self, one: &Resolved) -> Solver {
        if one.fails() || (self.all_fall_back && one.contour.is_some()) {
            FALLBACK
        } else {
            self.settings.solver
        }
    }

    /// Finds or bakes the shape maps of objects.
    fn find_maps(&mut self, work: &mut [Resolved]) -> Result<()> {
        for one in work {
            let map = self.map_of(one);
            one.map = map.map_err(|e| self.named(e, one.number, "profile"))?;
        }
        Ok(())
    }

    /// The shape map of an object; `None` if nothing reads it.
    fn map_of(&mut self, one: &Resolved) -> Result<Option<Arc<ShapeTexture>>> {
        let Some(entry) = self.objects.at(one.number) else {
            return Ok(None);
        };
        if !self.solver_of(one).reads_map() {
            return Ok(None);
        }
        let (wanted, growth) = one.shown(entry);
        let key = MapKey::new(wanted, &growth, &self.settings);
        let there = entry.derived.as_ref().and_then(|p| p.map.as_ref());
        if let Some(there) = there
            && Arc::ptr_eq(&wanted.profile, &entry.drawn().profile)
            && there.key.holds(&key)
        {
            return Ok(Some(there.clone()));
        }
        let (uploads, profile) = (&mut self.uploads, &wanted.profile);
        Ok(Some(self.textures.shape(uploads, profile, key)?))
    }

    /// The maps that shadows read, including maps of changed objects. Returns the present value if
    /// nothing differs.
    fn shadow_maps_with(&self, work: &[Resolved]) -> Result<Arc<ShadowMaps>> {
        if !self.casts() {
            return Ok(if self.shadow_maps.maps.is_empty() {
                self.shadow_maps.clone()
            } else {
                Arc::default()
            });
        }
        let mut maps: Vec<Arc<ShapeTexture>> = Vec::new();
        for (number, entry) in self.objects.ordered() {
            let map = match work.iter().find(|one| one.number == number) {
                Some(one) => one.map.as_ref(),
                None => entry.derived.as_ref().and_then(|p| p.map.as_ref()),
            };
            if let Some(map) = map
                && !maps.iter().any(|m| Arc::ptr_eq(m, map))
            {
                maps.push(map.clone());
            }
        }
        let remedy = "share profiles";
        few_enough(maps.len(), "different shapes", MAX_SHADOW_MAPS, remedy)?;
        let same = maps.len() == self.shadow_maps.maps.len()
            && maps
                .iter()
                .zip(&self.shadow_maps.maps)
                .all(|(a, b)| Arc::ptr_eq(a, b));
        Ok(if same {
            self.shadow_maps.clone()
        } else {
            Arc::new(ShadowMaps { maps })
        })
    }

    /// Makes all that draws an object.
    fn derive(&mut self, one: &Resolved) -> Result<Derived> {
        let (number, solid, solver) = (one.number, &one.solid, self.solver_of(one));
        let Some(entry) = self.objects.at(number) else {
            return Err(Error::new(
                ErrorKind::Other,
                "an object is gone while it is refreshed",
            ));
        };
        let (object, growth) = one.shown(entry);
        check_format(entry.latest(), solver, &self.settings).map_err(|e| self.under(e, number))?;
        let facts = one.map.as_ref().map_or_else(
            || MapKey::new(object, &growth, &self.settings).unbaked(&object.profile),
            |m| m.facts,
        );
        let arc = if object.texturing.projection == Projection::Arc {
            let (uploads, profile) = (&mut self.uploads, &object.profile);
            Some(self.textures.arc(uploads, profile, &facts)?)
        } else {
            None
        };
        let variant = self.variant(solver, object, entry.latest_images());
        let shadow_map = one.map.as_ref().and_then(|map| {
            let same = |m: &Arc<ShapeTexture>| Arc::ptr_eq(m, map);
            self.shadow_maps.maps.iter().position(same)
        });
        let bound = BoundTextures {
            images: entry.latest_images().clone(),
            shape: one.map.clone(),
            arc: arc.clone(),
            shadows: self.shadow_maps.clone(),
        };
        let (uploads, look) = (&mut self.uploads, &object.texturing);
        Ok(Derived {
            textures: self.textures.set(uploads, look, bound)?,
            solid: solid.clone(),
            contour: one.contour.clone(),
            levels: one.table.iter().map(|table| (0, table.clone())).collect(),
            solver,
            takes_patches: solver == Solver::Exact && self.settings.proxy_min_pixels != u32::MAX,
            map: one.map.clone(),
            facts,
            arc,
            shadow_map: shadow_map.and_then(|n| u32::try_from(n).ok()).unwrap_or(0),
            variant,
        })
    }

    /// Adds the key `object.N.key` to an error without a key, and the object's file to an error
    /// without a file.
    fn named(&self, error: Error, number: u32, key: &str) -> Error {
        let error = if error.key.is_none() {
            self.under(error.at_key(key), number)
        } else {
            error
        };
        match self
            .objects
            .at(number)
            .and_then(|e| e.latest().file.clone())
        {
            Some(file) if error.file.is_none() => error.in_file(file),
            _ => error,
        }
    }

    fn under(&self, mut error: Error, number: u32) -> Error {
        if let Some(key) = &mut error.key
            && !key.starts_with("object.")
        {
            *key = format!("object.{}.{key}", self.objects.position(number));
        }
        error
    }
}

/// Returns an error for more of these than shadows are drawn between.
fn few_enough(count: usize, what: &str, most: u32, remedy: &str) -> Result<()> {
    if count <= most as usize {
        return Ok(());
    }
    let message = format!(
        "shadows between {count} {what}; at most {most} are drawn: {remedy}, or set \"off\""
    );
    Err(Error::new(ErrorKind::Content, message).at_key("shadow"))
}

/// Makes all contours that are not made yet, on all cores, each once. Returns the number of those
/// that do not close.
fn make_contours(resolved: &[Resolved]) -> u64 {
    let contours = resolved.iter().filter_map(|one| one.contour.as_ref());
    let mut new: Vec<_> = contours.filter(|contour| !contour.is_made()).collect();
    new.sort_unstable_by_key(|contour| Arc::as_ptr(contour));
    new.dedup_by_key(|contour| Arc::as_ptr(contour));
    let fails = new.par_iter().filter(|contour| contour.get().is_err());
    fails.count() as u64
}
