//! From an object's values to what the device needs of it. All that can fail comes first; then
//! everything is taken over at once.

use super::block::check_format;
use super::entry::{Entry, Prepared};
use super::levels;
use super::map_key::MapKey;
use super::offset_surface::OffsetSurface;
use super::reach::largest_width;
use super::renderer::Renderer;
use super::shape_texture::ShapeTexture;
use super::solid::Solid;
use super::textures::{Bound, ShadowMaps};
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::maps::envelope::SLACK;
use crate::maps::{MapFormat, Projection};
use crate::scene::{GrownObject, Growth, Object, Shadow};
use crate::settings::Solver;
use crate::shader::generated::{MAX_SHADOW_BATCHES, MAX_SHADOW_MAPS};
use crate::shader::{Met, Variant};
use std::sync::Arc;

/// The search of what has no surface of its own: it reads the map alone.
pub(super) const FALLBACK: Solver = Solver::Live;

/// What is known of a changed object before the device is touched.
struct Resolved {
    number: u32,
    /// In a box that has grown.
    grown: Option<GrownObject>,
    solid: Arc<Solid>,
    level: u8,
    surface: Option<Arc<OffsetSurface>>,
}

impl Resolved {
    /// What is drawn of `entry`, and by how much its box has grown.
    fn shown<'a>(&'a self, entry: &'a Entry) -> (&'a Object, Growth) {
        let own = (entry.latest(), Growth::default());
        self.grown.as_ref().map_or(own, |g| (&g.object, g.growth))
    }
}

impl Renderer {
    /// Takes over what was added and set since the last call. Where something fails, what was added
    /// since is left out until it is set again, and everything else stays as it was. `view`: the
    /// one that is drawn next, where it is known.
    pub(super) fn refresh(&mut self, view: Option<&View>) -> Result<()> {
        if self.changed.is_empty() {
            return Ok(());
        }
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        let result = self.take_over(&changed, view);
        if result.is_err() {
            for number in changed {
                self.forget(number)?;
            }
        }
        result
    }

    /// Drops what was set of an entry.
    fn forget(&mut self, number: u32) -> Result<()> {
        let Some(entry) = &mut self.entries[number as usize] else {
            return Ok(());
        };
        entry.wanted = None;
        let count = entry.object.placements().len();
        if entry.instances.len() != count {
            let unused = entry.instances.clone();
            let range = self.swap_instances(unused, count)?;
            if let Some(entry) = &mut self.entries[number as usize] {
                entry.instances = range;
            }
        }
        Ok(())
    }

    fn take_over(&mut self, changed: &[u32], view: Option<&View>) -> Result<()> {
        let resolved = self.resolve(changed, view)?;
        let (falls_back, met) = (self.falls_back(&resolved), self.shadows_meet());
        if falls_back != self.all_fall_back || met != self.met {
            (self.all_fall_back, self.met) = (falls_back, met);
            // Each is drawn by another code from now on.
            if changed.len() < self.order.len() {
                let all = self.order.clone();
                return self.take_over(&all, view);
            }
        }
        let casts = self.lighting.shadow != Shadow::Off;
        if casts && self.order.len() > MAX_SHADOW_BATCHES as usize {
            let (count, most) = (self.order.len(), MAX_SHADOW_BATCHES);
            return Err(Error::new(
                Stage::Scene,
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
        let before = std::mem::replace(&mut self.shadow_maps, shadow_maps);
        if all_anew && mapped.len() < self.order.len() {
            let all = self.order.clone();
            return self.take_over(&all, view);
        }
        self.retire(before);
        let mut ready = Vec::with_capacity(mapped.len());
        for (one, map) in mapped {
            let number = one.number;
            let prepared = self
                .prepared(&one, map)
                .map_err(|e| self.named(e, number, "profile"))?;
            ready.push((number, one.grown, prepared));
        }
        for (number, grown, prepared) in ready {
            let Some(entry) = &mut self.entries[number as usize] else {
                continue;
            };
            if let Some(wanted) = entry.wanted.take() {
                entry.object = wanted;
            }
            entry.grown = grown;
            let old = entry.prepared.replace(prepared);
            self.retire(old);
            self.unplanned.push(number);
        }
        Ok(())
    }

    /// Finds or makes the surfaces of changed objects, on all cores.
    fn resolve(&mut self, changed: &[u32], view: Option<&View>) -> Result<Vec<Resolved>> {
        let solver = self.settings.solver;
        let mut resolved = Vec::with_capacity(changed.len());
        for &number in changed {
            let Some(entry) = &self.entries[number as usize] else {
                continue;
            };
            let grown = self.solids.grown.grown(entry.latest());
            let object = grown.as_ref().map_or(entry.latest(), |g| &g.object);
            let growth = grown.as_ref().map(|g| g.growth).unwrap_or_default();
            let solid = self.solids.get(&object.profile);
            // Shadows' common level is known when all are planned.
            let level = match view {
                Some(view) if self.has_levels() && self.lighting.shadow == Shadow::Off => {
                    let pixels = levels::pixels_per_unit(object, growth.height(), view, false);
                    levels::coarsest(self.settings.tolerance, pixels)
                }
                _ => 0,
            };
            let surface = if solver.reads_map() {
                None
            } else if solver.is_of_cones() {
                let rows = MapKey::new(object, &growth, &self.settings).rows;
                Some(solid.cones(&object.offset, rows, solver == Solver::Relaxed)?)
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
        self.make_surfaces(resolved.iter().filter_map(|r| r.surface.as_ref()));
        for one in &resolved {
            let Some(error) = one.surface.as_ref().and_then(|s| s.failure()) else {
                continue;
            };
            if solver.is_of_cones() {
                return Err(self.named(error.clone(), one.number, "profile"));
            }
            let name = self.entries[one.number as usize]
                .as_ref()
                .map_or("", |e| &e.latest().name);
            let note = format!(
                "object.{} ({name}) is drawn by the search {} in place of {}: {}",
                self.place(one.number),
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

    /// Whether shadows force the fallback on all: a shadow's ray meets every solid by one search.
    fn falls_back(&self, resolved: &[Resolved]) -> bool {
        let fails =
            |s: &Option<Arc<OffsetSurface>>| s.as_ref().is_some_and(|s| s.failure().is_some());
        let is_new = |number: u32| resolved.iter().any(|r| r.number == number);
        let of_old = |&number: &u32| {
            let entry = self.entries[number as usize].as_ref();
            let prepared = entry.and_then(|e| e.prepared.as_ref());
            prepared.is_some_and(|p| fails(&p.surface)) && !is_new(number)
        };
        self.lighting.shadow != Shadow::Off
            && (resolved.iter().any(|r| fails(&r.surface)) || self.order.iter().any(of_old))
    }

    /// What shadows' rays may meet; nothing where there are none.
    fn shadows_meet(&self) -> Met {
        if self.lighting.shadow == Shadow::Off {
            return Met::default();
        }
        let objects = || self.ordered().map(Entry::latest);
        Met {
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

    /// The shape map of a changed object, where it is read.
    fn map_of(&mut self, one: &Resolved) -> Result<Option<Arc<ShapeTexture>>> {
        let soft = self.lighting.shadow == Shadow::Soft;
        if !self.solver_of(one.surface.as_ref()).reads_map() && !soft {
            return Ok(None);
        }
        let Some(entry) = &self.entries[one.number as usize] else {
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

    /// The maps that shadows read, with those of changed objects; the same list where nothing
    /// differs.
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
        for &number in &self.order {
            let new = mapped.iter().find(|(r, _)| r.number == number);
            let map = match new {
                Some((_, map)) => map.as_ref(),
                None => self.entries[number as usize]
                    .as_ref()
                    .and_then(|e| e.prepared.as_ref()?.map.as_ref()),
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
                Stage::Scene,
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
        let Some(entry) = &self.entries[number as usize] else {
            return Err(Error::new(
                Stage::Draw,
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
        let proxy = self.proxy(object, solver, solid, map.as_deref(), surface.as_ref())?;
        let planes = self.output.planes();
        let (settings, lighting) = (&self.settings, &self.lighting);
        let variant = Variant::new(settings, planes, solver, lighting, object, self.met);
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
            level: one.level,
            levels: Vec::new(),
            solver,
            surface: surface.filter(|_| !solver.reads_map()),
            proxy,
            map,
            facts,
            arc,
            shadow_map: shadow_map.and_then(|n| u32::try_from(n).ok()).unwrap_or(0),
            variant,
        })
    }

    /// What rays of an object can be held to before they are searched: its boundary; of a search on
    /// the map, where its solid may be.
    fn proxy(
        &self,
        object: &Object,
        solver: Solver,
        solid: &Solid,
        map: Option<&ShapeTexture>,
        surface: Option<&Arc<OffsetSurface>>,
    ) -> Result<Option<Arc<OffsetSurface>>> {
        if self.settings.proxy_min_pixels == u32::MAX {
            return Ok(None);
        }
        match (solver, map) {
            (Solver::Hull, _) => Ok(surface.cloned()),
            // A map of 8 bits bounds nothing.
            (Solver::Live, Some(map)) if self.settings.map_format != MapFormat::Rgba8 => {
                let by = largest_width(&object.offset).max(0.0) + SLACK / f64::from(map.facts.rows);
                // As much as halves of floats are rounded by.
                solid.envelope(map, by * (1.0 + 1.0 / 1024.0))
            }
            _ => Ok(None),
        }
    }

    /// Where an entry stands among all.
    fn place(&self, number: u32) -> usize {
        self.order.iter().position(|&n| n == number).unwrap_or(0)
    }

    /// Adds which object it was to an error that has a key, or this one.
    fn named(&self, error: Error, number: u32, key: &str) -> Error {
        let error = if error.key.is_none() {
            self.under(error.at_key(key), number)
        } else {
            error
        };
        let entry: Option<&Entry> = self.entries[number as usize].as_ref();
        match entry.and_then(|e| e.latest().file.clone()) {
            Some(file) if error.file.is_none() => error.in_file(file),
            _ => error,
        }
    }

    fn under(&self, mut error: Error, number: u32) -> Error {
        if let Some(key) = &mut error.key
            && !key.starts_with("object.")
        {
            *key = format!("object.{}.{key}", self.place(number));
        }
        error
    }
}
