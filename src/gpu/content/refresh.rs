//! Conversion of an object's values to device resources. All objects are prepared before any new
//! value is stored. A failure restores what shadows need of all objects.

use super::Content;
use super::entry::{Entry, Prepared};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::resources::block::check_format;
use crate::gpu::resources::shape_texture::MapKey;
use crate::gpu::resources::shape_texture::ShapeTexture;
use crate::gpu::resources::solid_cache::Solid;
use crate::gpu::resources::textures::{Bound, ShadowMaps};
use crate::maps::Projection;
use crate::plan::{View, levels};
use crate::scene::{GrownObject, Growth, Object, Shadow};
use crate::settings::Solver;
use crate::shader::generated::{MAX_SHADOW_BATCHES, MAX_SHADOW_MAPS};
use crate::shader::{ShadowCasters, Variant};
use crate::solid::offset_surface::OffsetSurface;
use std::sync::Arc;

/// The search for objects without a surface of their own; it reads only the map.
pub(in crate::gpu) const FALLBACK: Solver = Solver::Live;

/// A changed object, resolved before the device is touched.
struct Resolved {
    number: u32,
    /// The object in a box that has grown.
    grown: Option<GrownObject>,
    solid: Arc<Solid>,
    level: u8,
    surface: Option<Arc<OffsetSurface>>,
}

impl Resolved {
    /// The object that is drawn for `entry`, and the growth of its box.
    fn shown<'a>(&'a self, entry: &'a Entry) -> (&'a Object, Growth) {
        let own = (entry.latest(), Growth::default());
        self.grown.as_ref().map_or(own, |g| (&g.object, g.growth))
    }
}

impl Content {
    /// Applies the values that were added and set since the last call. After an error, objects
    /// added since that call are left out until they are set again. Lights and all other values but
    /// placements and copies are again those of that call. `view` is the view of the next frame, if it is known.
    pub fn refresh(&mut self, view: Option<&View>) -> Result<()> {
        if self.changed.is_empty() {
            return Ok(());
        }
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        let before = (self.all_fall_back, self.casters, self.shadow_maps.clone());
        let result = self.apply(&changed, view);
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
        entry.version = version;
        self.version = version;
        let count = entry.object.placements().len();
        if entry.instances.len() != count {
            self.objects.resize(number, count)?;
        }
        Ok(())
    }

    fn apply(&mut self, changed: &[u32], view: Option<&View>) -> Result<()> {
        let resolved = self.resolve(changed, view)?;
        let (falls_back, casters) = (self.falls_back(&resolved), self.shadow_casters());
        if falls_back != self.all_fall_back || casters != self.casters {
            (self.all_fall_back, self.casters) = (falls_back, casters);
            // Other code draws each object from now on.
            if changed.len() < self.objects.len() {
                let all = self.objects.numbers();
                return self.apply(&all, view);
            }
        }
        let casts = self.lighting.shadow != Shadow::Off;
        if casts && self.objects.len() > MAX_SHADOW_BATCHES as usize {
            let (count, most) = (self.objects.len(), MAX_SHADOW_BATCHES);
            return Err(Error::new(
                ErrorKind::Content,
                format!("shadows between {count} objects; at most {most} are drawn: use instances, or set \"off\""),
            )
            .at_key("shadow"));
        }
        let mut mapped = Vec::with_capacity(resolved.len());
        for one in resolved {
            let map = self
                .map_of(&one)
                .map_err(|e| self.named(e, one.number, "profile"))?;
            mapped.push((one, map));
        }
        let shadow_maps = self.shadow_maps_with(&mapped)?;
        let all_anew = !Arc::ptr_eq(&shadow_maps, &self.shadow_maps);
        self.shadow_maps = shadow_maps;
        if all_anew && mapped.len() < self.objects.len() {
            let all = self.objects.numbers();
            return self.apply(&all, view);
        }
        let mut ready = Vec::with_capacity(mapped.len());
        for (one, map) in mapped {
            let number = one.number;
            let prepared = self
                .prepared(&one, map)
                .map_err(|e| self.named(e, number, "profile"))?;
            ready.push((number, one.grown, prepared));
        }
        self.version += 1;
        let version = self.version;
        for (number, grown, prepared) in ready {
            let Some(entry) = self.objects.at_mut(number) else {
                continue;
            };
            if let Some(wanted) = entry.wanted.take() {
                entry.object = wanted;
            }
            entry.grown = grown;
            entry.prepared = Some(prepared);
            entry.version = version;
        }
        Ok(())
    }

    /// Finds or makes the surfaces of changed objects, on all cores.
    fn resolve(&mut self, changed: &[u32], view: Option<&View>) -> Result<Vec<Resolved>> {
        let solver = self.settings.solver;
        let mut resolved = Vec::with_capacity(changed.len());
        for &number in changed {
            let Some(entry) = self.objects.at(number) else {
                continue;
            };
            let mut geometry = self.geometry.lock()?;
            let grown = geometry.solids.grown.grown(entry.latest());
            let object = grown.as_ref().map_or(entry.latest(), |g| &g.object);
            let growth = grown.as_ref().map(|g| g.growth).unwrap_or_default();
            let solid = geometry.solids.get(&object.profile);
            drop(geometry);
            // The common level for shadows is known only when all objects are planned.
            let level = match view {
                Some(view) if self.has_levels() && self.lighting.shadow == Shadow::Off => {
                    let pixels = levels::pixels_per_unit(object, growth.height(), view, false);
                    levels::coarsest(self.settings.tolerance, pixels)
                }
                _ => 0,
            };
            let surface = if solver.reads_map() {
                None
            } else if let Solver::Other(search) = solver {
                let rows = MapKey::new(object, &growth, &self.settings).rows;
                Some(solid.search_table(search, &object.offset, rows)?)
            } else {
                Some(solid.patches(&object.offset, &growth, level)?)
            };
            resolved.push(Resolved {
                number,
                grown,
                solid,
                level,
                surface,
            });
        }
        let surfaces: Vec<_> = resolved.iter().filter_map(|r| r.surface.clone()).collect();
        self.make_surfaces(&surfaces);
        for one in &resolved {
            let Some(error) = one.surface.as_ref().and_then(|s| s.failure()) else {
                continue;
            };
            if solver.reads_own_table() {
                return Err(self.named(error.clone(), one.number, "profile"));
            }
            let entry = self.objects.at(one.number);
            let name = entry.map_or("", |e| &e.latest().name);
            let note = format!(
                "object.{} ({name}) is drawn by the search {} in place of {}: {}",
                self.objects.position(one.number),
                FALLBACK.name(),
                solver.name(),
                error.message
            );
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        Ok(resolved)
    }

    /// Returns true if shadows force the fallback on all objects: a shadow's ray meets every solid
    /// by one search.
    fn falls_back(&self, resolved: &[Resolved]) -> bool {
        let fails =
            |s: &Option<Arc<OffsetSurface>>| s.as_ref().is_some_and(|s| s.failure().is_some());
        let is_new = |number: u32| resolved.iter().any(|r| r.number == number);
        let of_old = |(number, entry): (u32, &Entry)| {
            let prepared = entry.prepared.as_ref();
            let surface = prepared.and_then(|p| p.levels.first().map(|l| l.1.clone()));
            prepared.is_some_and(|p| p.fails || fails(&surface)) && !is_new(number)
        };
        self.lighting.shadow != Shadow::Off
            && (resolved.iter().any(|r| fails(&r.surface)) || self.objects.ordered().any(of_old))
    }

    /// The properties of solids that shadow rays may meet; the default without shadows.
    fn shadow_casters(&self) -> ShadowCasters {
        if self.lighting.shadow == Shadow::Off {
            return ShadowCasters::default();
        }
        let objects = || self.objects.ordered().map(|(_, e)| e.latest());
        ShadowCasters {
            repeated: objects().any(|o| o.repeat != [1; 3]),
            beveled: objects().any(|o| o.offset.bevel != 0.0),
        }
    }

    fn solver_of(&self, surface: Option<&Arc<OffsetSurface>>) -> Solver {
        let fails = surface.is_some_and(|s| s.failure().is_some());
        if fails || (self.all_fall_back && surface.is_some()) {
            FALLBACK
        } else {
            self.settings.solver
        }
    }

    /// The shape map of a changed object; `None` if nothing reads it.
    fn map_of(&mut self, one: &Resolved) -> Result<Option<Arc<ShapeTexture>>> {
        if !self.solver_of(one.surface.as_ref()).reads_map() {
            return Ok(None);
        }
        let Some(entry) = self.objects.at(one.number) else {
            return Ok(None);
        };
        let (wanted, growth) = one.shown(entry);
        let key = MapKey::new(wanted, &growth, &self.settings);
        let there = entry.prepared.as_ref().and_then(|p| p.map.as_ref());
        if let Some(there) = there
            && Arc::ptr_eq(&wanted.profile, &entry.drawn().profile)
            && there.key.holds(&key)
        {
            return Ok(Some(there.clone()));
        }
        one.solid
            .map(&self.device, &mut self.uploads, key)
            .map(Some)
    }

    /// The maps that shadows read, including maps of changed objects. Returns the present list if
    /// nothing differs.
    fn shadow_maps_with(
        &self,
        mapped: &[(Resolved, Option<Arc<ShapeTexture>>)],
    ) -> Result<Arc<ShadowMaps>> {
        if self.lighting.shadow == Shadow::Off {
            return Ok(if self.shadow_maps.maps.is_empty() {
                self.shadow_maps.clone()
            } else {
                Arc::default()
            });
        }
        let mut maps: Vec<Arc<ShapeTexture>> = Vec::new();
        for (number, entry) in self.objects.ordered() {
            let new = mapped.iter().find(|(r, _)| r.number == number);
            let map = match new {
                Some((_, map)) => map.as_ref(),
                None => entry.prepared.as_ref().and_then(|p| p.map.as_ref()),
            };
            if let Some(map) = map
                && !maps.iter().any(|m| Arc::ptr_eq(m, map))
            {
                maps.push(map.clone());
            }
        }
        let (count, most) = (maps.len(), MAX_SHADOW_MAPS as usize);
        if count > most {
            return Err(Error::new(
                ErrorKind::Content,
                format!("shadows between {count} different shapes; at most {most} are drawn: share profiles, or set \"off\""),
            )
            .at_key("shadow"));
        }
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

    fn prepared(&mut self, one: &Resolved, map: Option<Arc<ShapeTexture>>) -> Result<Prepared> {
        let (number, solid, surface) = (one.number, &one.solid, one.surface.clone());
        let solver = self.solver_of(surface.as_ref());
        let Some(entry) = self.objects.at(number) else {
            return Err(Error::new(
                ErrorKind::Other,
                "an object is gone while it is prepared",
            ));
        };
        let (object, growth) = one.shown(entry);
        check_format(entry.latest(), solver, &self.settings).map_err(|e| self.under(e, number))?;
        let facts = map.as_ref().map_or_else(
            || MapKey::new(object, &growth, &self.settings).unbaked(&object.profile),
            |m| m.facts,
        );
        let arc = if object.texturing.projection == Projection::Arc {
            Some(solid.arc(&self.device, &mut self.uploads, &facts)?)
        } else {
            None
        };
        let planes = self.output.planes();
        let (settings, lighting) = (&self.settings, &self.lighting);
        let variant = Variant::new(settings, planes, solver, lighting, object, self.casters);
        let shadow_map = map.as_ref().and_then(|map| {
            let same = |m: &Arc<ShapeTexture>| Arc::ptr_eq(m, map);
            self.shadow_maps.maps.iter().position(same)
        });
        let bound = Bound {
            look: &object.texturing,
            shape: map.clone(),
            arc: arc.clone(),
            shadows: &self.shadow_maps,
        };
        Ok(Prepared {
            textures: self.textures.set(&self.device, &mut self.uploads, bound)?,
            solid: solid.clone(),
            fails: surface.as_ref().is_some_and(|s| s.failure().is_some()),
            levels: surface
                .filter(|_| !solver.reads_map())
                .map(|surface| (one.level, surface))
                .into_iter()
                .collect(),
            solver,
            takes_patches: solver == Solver::Exact && settings.proxy_min_pixels != u32::MAX,
            map,
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
