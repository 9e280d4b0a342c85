//! Conversion of values to all that does not depend on a view: solids, contours, maps, textures and
//! variants. What an object is drawn by follows from the object and from [`Common`] facts. It is
//! derived anew for changed objects, and for all objects if the common facts change.

use super::Content;
use super::entry::{Boundary, Derived, Values};
use crate::error::{Error, Result, content, lock};
use crate::gpu::resources::block::check_format;
use crate::gpu::resources::shape_texture::{MapKey, ShapeTexture};
use crate::gpu::resources::textures::{BoundTextures, ShadowMaps};
use crate::maps::Projection;
use crate::scene::Object;
use crate::settings::Solver;
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::shader::{ShadowCasters, is_beveled};
use crate::solid::offset_surface::Recipe;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Values that a refresh applies, by number of the object.
pub(in crate::gpu) type Wanted = BTreeMap<u32, Values>;

/// The search for objects without a surface of their own; it reads only the map.
pub(in crate::gpu) const FALLBACK: Solver = Solver::Live;

/// Facts of all objects that each object's resources depend on; the default without shadows.
#[derive(Clone, Default)]
pub(in crate::gpu) struct Common {
    /// True if the fallback draws every object, because one has no surface and a shadow's ray meets
    /// all by one search.
    falls_back: bool,
    /// The properties of solids that shadow rays may meet.
    pub casters: ShadowCasters,
    pub shadow_maps: Arc<ShadowMaps>,
}

impl Content {
    /// Applies the values that were added and set since the last call that succeeded, all or none.
    /// After an error they stay wanted, and the next call tries them again.
    pub fn refresh(&mut self) -> Result<()> {
        if self.wanted.is_empty() && !self.removed {
            return Ok(());
        }
        let mut wanted = std::mem::take(&mut self.wanted);
        let before = self.common.clone();
        if let Err(error) = self.make_all(&mut wanted) {
            (self.wanted, self.common) = (wanted, before);
            return Err(error);
        }
        self.removed = false;
        self.version += 1;
        for (number, values) in wanted {
            if let Some(entry) = self.objects.at_mut(number) {
                entry.version = self.version;
                entry.values = values;
            }
        }
        Ok(())
    }

    /// Makes the resources of all values that are wanted. Adds the values of all other objects if
    /// the common facts change.
    fn make_all(&mut self, wanted: &mut Wanted) -> Result<()> {
        self.find_boundaries(wanted)?;
        let found = (self.falls_back(wanted), self.shadow_casters(wanted));
        if found != (self.common.falls_back, self.common.casters) {
            // Other code draws each object from now on.
            (self.common.falls_back, self.common.casters) = found;
            self.objects.add_drawn(wanted);
        }
        for (&number, values) in wanted.iter_mut() {
            let made = self.find_map(number, values);
            made.map_err(|e| self.named(e, number, values))?;
        }
        let maps = self.shadow_maps(wanted)?;
        let known = self.common.shadow_maps.maps.iter();
        if !known.map(Arc::as_ptr).eq(maps.iter().map(Arc::as_ptr)) {
            // Each object binds the new maps.
            self.common.shadow_maps = Arc::new(ShadowMaps { maps });
            self.objects.add_drawn(wanted);
        }
        for (&number, values) in wanted {
            let made = self.derive(number, values);
            made.map_err(|e| self.named(e, number, values))?;
        }
        Ok(())
    }

    /// Finds or makes the boundaries that are missing, on all cores.
    fn find_boundaries(&mut self, wanted: &mut Wanted) -> Result<()> {
        let solver = self.settings.solver;
        let mut geometry = lock(&self.geometry)?;
        let (mut contours, mut tables) = (Vec::new(), Vec::new());
        for values in wanted.values_mut().filter(|v| v.boundary.is_none()) {
            values.grown = geometry.solids.grown.grown(&values.object);
            let object = values.drawn();
            let solid = geometry.solids.get(&object.profile);
            let (mut contour, mut table) = (None, None);
            if solver.follows_tolerance() {
                contour = Some(solid.contour(&object.offset)?);
            } else if let (Solver::Other(search), false) = (solver, solver.reads_map()) {
                let rows = MapKey::new(object, &values.growth(), &self.settings).rows;
                let recipe = Recipe::Table { search, rows };
                table = Some((0, solid.surface(&object.offset, recipe)?));
            }
            contours.extend(contour.clone());
            tables.extend(table.clone().map(|(_, table)| table));
            values.boundary = Some(Boundary {
                solid,
                contour,
                levels: table.into_iter().collect(),
                map: None,
            });
        }
        drop(geometry);
        contours.retain(|contour| !contour.is_made());
        let fails = distinct(&mut contours).par_iter();
        self.rebuilds += fails.filter(|c| c.get().is_err()).count() as u64;
        self.make_surfaces(&mut tables);
        Ok(())
    }

    /// Adds a note on an object whose contour failed with this error.
    fn note_fallback(&mut self, number: u32, object: &Object, error: &Error) {
        let note = format!(
            "object.{} ({}) is drawn by the search {} in place of {}: {}",
            self.objects.position(number),
            object.name,
            FALLBACK.name(),
            self.settings.solver.name(),
            error.message
        );
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    /// The latest values of all objects if they cast shadows.
    fn shadowed<'a>(&'a self, wanted: &'a Wanted) -> impl Iterator<Item = &'a Values> {
        let casts = self.casts();
        let all = self.objects.ordered().filter(move |_| casts);
        all.map(|(number, entry)| wanted.get(&number).unwrap_or(&entry.values))
    }

    fn falls_back(&self, wanted: &Wanted) -> bool {
        let mut boundaries = self.shadowed(wanted).filter_map(|v| v.boundary.as_ref());
        boundaries.any(Boundary::fails)
    }

    fn shadow_casters(&self, wanted: &Wanted) -> ShadowCasters {
        let mut objects = self.shadowed(wanted).map(|v| &v.object);
        ShadowCasters {
            repeated: self.shadowed(wanted).any(|v| v.object.repeat != [1; 3]),
            beveled: objects.any(|object| object.offset.bevel != 0.0),
        }
    }

    /// The maps that shadows read.
    fn shadow_maps(&self, wanted: &Wanted) -> Result<Vec<Arc<ShapeTexture>>> {
        let mut maps: Vec<Arc<ShapeTexture>> = Vec::new();
        let all = self.shadowed(wanted);
        for map in all.filter_map(|v| v.boundary.as_ref()?.map.as_ref()) {
            if !maps.iter().any(|known| Arc::ptr_eq(known, map)) {
                maps.push(map.clone());
            }
        }
        let count = maps.len();
        if count > MAX_SHADOW_MAPS as usize {
            let message = format!(
                "shadows between {count} different shapes; at most {MAX_SHADOW_MAPS} are drawn: share profiles, or set \"off\""
            );
            return content("shadow", message);
        }
        Ok(maps)
    }

    /// The search that draws an object.
    fn solver_of(&self, boundary: &Boundary) -> Solver {
        if boundary.fails() || (self.common.falls_back && boundary.contour.is_some()) {
            FALLBACK
        } else {
            self.settings.solver
        }
    }

    /// Finds or bakes the shape map of an object, if its search reads one.
    fn find_map(&mut self, number: u32, values: &mut Values) -> Result<()> {
        let (object, growth) = (values.drawn(), values.growth());
        let key = MapKey::new(object, &growth, &self.settings);
        let known = self.objects.at(number).map(|entry| &entry.values);
        let known = known.filter(|known| Arc::ptr_eq(&known.drawn().profile, &object.profile));
        let known = known.and_then(|known| known.boundary.as_ref()?.map.clone());
        let known = known.filter(|map| map.key.holds(&key));
        let Some(mut boundary) = values.boundary.take() else {
            return Ok(());
        };
        boundary.map = match known {
            _ if !self.solver_of(&boundary).reads_map() => None,
            Some(known) => Some(known),
            None => Some(self.textures.shape(&values.drawn().profile, key)?),
        };
        values.boundary = Some(boundary);
        Ok(())
    }

    /// Makes all that draws an object, beside its boundary.
    fn derive(&mut self, number: u32, values: &mut Values) -> Result<()> {
        let Some(boundary) = &values.boundary else {
            return Ok(());
        };
        let table = boundary.levels.first().map(|(_, surface)| surface);
        if let Some(error) = table.and_then(|table| table.failure()) {
            return Err(error.clone());
        }
        if let Some(Err(error)) = boundary.contour.as_ref().map(|c| c.get()) {
            self.note_fallback(number, &values.object, error);
        }
        let (object, map) = (values.drawn(), &boundary.map);
        let solver = self.solver_of(boundary);
        check_format(&values.object, solver, &self.settings).map_err(|mut e| {
            e.key = (e.key).map(|key| format!("object.{}.{key}", self.objects.position(number)));
            e
        })?;
        let facts = map.as_ref().map_or_else(
            || MapKey::new(object, &values.growth(), &self.settings).unbaked(&object.profile),
            |map| map.facts,
        );
        let arc = if object.texturing.projection == Projection::Arc {
            Some(self.textures.arc(&object.profile, &facts)?)
        } else {
            None
        };
        let shadows = &self.common.shadow_maps;
        let mut numbered = (0u32..).zip(&shadows.maps);
        let shadow_map = map.as_ref().and_then(|map| {
            let found = numbered.find(|(_, known)| Arc::ptr_eq(known, map));
            found.map(|(number, _)| number)
        });
        let bound = BoundTextures {
            images: values.images.clone(),
            shape: map.clone(),
            arc: arc.clone(),
            shadows: shadows.clone(),
        };
        let textures = self.textures.set(&object.texturing, bound)?;
        let steps = self.settings.max_steps;
        let steps = steps.unwrap_or_else(|| solver.default_steps(is_beveled(object)));
        values.derived = Some(Derived {
            solver,
            steps: steps.max(1),
            facts,
            arc,
            shadow_map: shadow_map.unwrap_or(0),
            textures,
            technique: self.technique(solver, object, &values.images),
        });
        Ok(())
    }

    /// Adds the key `object.N.profile` and the object's file to an error without them.
    fn named(&self, mut error: Error, number: u32, values: &Values) -> Error {
        if error.key.is_none() {
            error = error.at_key(format!("object.{}.profile", self.objects.position(number)));
        }
        match &values.object.file {
            Some(file) => error.in_file(file),
            None => error,
        }
    }
}

/// Each of these values once.
pub(in crate::gpu) fn distinct<T>(all: &mut Vec<Arc<T>>) -> &[Arc<T>] {
    all.sort_unstable_by_key(Arc::as_ptr);
    all.dedup_by_key(|one| Arc::as_ptr(one));
    all
}
