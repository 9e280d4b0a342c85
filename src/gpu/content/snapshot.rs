//! The snapshot of all objects: what was set, with all that does not depend on a view: solids,
//! contours, maps, textures and techniques. An object's resources follow from the object and from
//! [`SceneFacts`]. They are made anew for changed objects, and for all objects if those facts change.

use super::entry::{Boundary, Derived, Entry, PreparedObject, Stale, shape};
use super::objects::{Objects, named};
use crate::error::{Error, Result, content, lock};
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::resources::shape_texture::{MapKey, ShapeTexture};
use crate::gpu::resources::textures::{BoundTextures, ShadowMaps, Textures};
use crate::maps::{MapFormat, Projection};
use crate::scene::{Lighting, Object, Shadow};
use crate::settings::{SearchSettings, Solver};
use crate::shader::generated::MAX_SHADOW_MAPS;
use crate::shader::{Demands, ShadowCasters, Technique, is_beveled};
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// The search for objects without a surface of their own; it reads only the map.
pub(in crate::gpu) const FALLBACK: Solver = Solver::Live;

/// All objects at one time. Nothing in it changes but the surfaces that its objects keep alive.
#[derive(Default)]
pub(in crate::gpu) struct Snapshot {
    pub objects: Vec<Arc<PreparedObject>>,
    /// Number of copies of each [`PreparedObject::look`].
    pub looks: HashMap<(Technique, usize), usize>,
    pub facts: SceneFacts,
    /// Number of instances, with free ones.
    pub instances: u32,
    /// One more than the largest number that an object has had.
    pub number_count: usize,
}

/// Facts of all objects that each object's resources depend on. Without shadows no object depends on
/// another.
#[derive(Clone, Default)]
pub(in crate::gpu) struct SceneFacts {
    shadow: Shadow,
    environment: bool,
    /// True if the fallback draws every object, because one has no surface and a shadow's ray meets
    /// all by one search.
    falls_back: bool,
    pub casters: ShadowCasters,
    pub shadow_maps: Arc<ShadowMaps>,
}

impl SceneFacts {
    /// The facts of these objects, but for their maps.
    fn of(lighting: &Lighting, objects: &[(u32, &Entry)]) -> Self {
        let shadow = lighting.shadow;
        let objects = if shadow == Shadow::Off { &[] } else { objects };
        let fails = |e: &Entry| e.boundary.as_ref().is_some_and(|b| b.fails());
        let any = |is: fn(&Object) -> bool| objects.iter().any(|(_, e)| is(&e.set.object));
        Self {
            shadow,
            environment: lighting.environment.is_some(),
            falls_back: objects.iter().any(|(_, e)| fails(e)),
            casters: ShadowCasters {
                repeated: any(|object| object.repeat != [1; 3]),
                beveled: any(|object| object.offset.bevel != 0.0),
            },
            shadow_maps: Arc::default(),
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        let facts = |of: &Self| (of.shadow, of.environment, of.falls_back, of.casters);
        facts(self) == facts(other) && Arc::ptr_eq(&self.shadow_maps, &other.shadow_maps)
    }

    /// The search that draws an object.
    fn solver_of(&self, boundary: &Boundary, wanted: Solver) -> Solver {
        match boundary.fails() || (self.falls_back && boundary.contour.is_some()) {
            true => FALLBACK,
            false => wanted,
        }
    }

    /// Adds the maps that shadows read. `known`: those of the last snapshot.
    fn add_maps(
        &mut self,
        all: &[Option<Arc<ShapeTexture>>],
        known: &Arc<ShadowMaps>,
    ) -> Result<()> {
        let mut maps = ShadowMaps::new();
        for map in all.iter().flatten().filter(|_| self.shadow != Shadow::Off) {
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
        let same = known
            .iter()
            .map(Arc::as_ptr)
            .eq(maps.iter().map(Arc::as_ptr));
        self.shadow_maps = if same { known.clone() } else { maps.into() };
        Ok(())
    }
}

/// Finds or makes the boundaries that objects lack, on all cores. Returns the number of contours that
/// do not close, and the tables of searches, which are not made yet.
pub(in crate::gpu) fn find_boundaries(
    objects: &mut Objects,
    geometry: &Mutex<Geometry>,
    settings: &SearchSettings,
) -> Result<(usize, Vec<Arc<OffsetSurface>>)> {
    let solver = settings.solver;
    let mut geometry = lock(geometry)?;
    let (mut contours, mut tables) = (Vec::new(), Vec::new());
    for entry in objects.entries_mut().filter(|e| e.boundary.is_none()) {
        let grown = geometry.solids.grown.grown(&entry.set.object);
        let (object, growth) = shape(grown.as_ref(), &entry.set.object);
        let solid = geometry.solids.get(&object.profile);
        let (mut contour, mut table) = (None, None);
        if solver.follows_tolerance() {
            contour = Some(solid.contour(&object.offset)?);
        } else if let (Solver::Other(search), false) = (solver, solver.reads_map()) {
            let rows = MapKey::new(object, &growth, settings).rows;
            let recipe = Recipe::Table { search, rows };
            table = Some(solid.surface(&object.offset, recipe)?);
        }
        contours.extend(contour.clone());
        tables.extend(table.clone());
        entry.boundary = Some(Arc::new(Boundary {
            grown,
            solid,
            contour,
            table,
            levels: Default::default(),
        }));
    }
    drop(geometry);
    contours.retain(|contour| !contour.is_made());
    let fails = distinct(&mut contours).par_iter();
    let failed = fails.filter(|c| c.get().is_err()).count();
    Ok((failed, tables))
}

impl Snapshot {
    /// The snapshot of all objects as set, after the snapshot `before`. Boundaries are there.
    pub fn new(
        objects: &Objects,
        before: &Self,
        demands: Demands,
        textures: &mut Textures,
        notes: &mut Vec<String>,
    ) -> Result<Self> {
        let order: Vec<_> = objects.ordered().collect();
        let mut facts = SceneFacts::of(demands.lighting, &order);
        let mut maps = Vec::with_capacity(order.len());
        for (position, (_, entry)) in order.iter().enumerate() {
            let map = find_map(entry, &facts, demands.settings, textures);
            maps.push(map.map_err(|e| named(e, position, &entry.set.object))?);
        }
        facts.add_maps(&maps, &before.facts.shadow_maps)?;
        let is_same = facts.is_same(&before.facts);
        let mut maker = Maker {
            demands,
            facts: &facts,
            textures,
            notes,
        };
        let mut prepared = Vec::with_capacity(order.len());
        for (position, ((number, entry), map)) in order.iter().zip(maps).enumerate() {
            let before = entry.prepared.as_ref();
            let kept = before.filter(|_| is_same && entry.stale <= Stale::State);
            let object = match (kept, &entry.boundary) {
                (Some(kept), _) if entry.stale == Stale::Nothing => kept.clone(),
                (_, None) => continue,
                (kept, Some(boundary)) => {
                    let derived = match kept {
                        Some(kept) => kept.derived.clone(),
                        None => {
                            let made = maker.derive(position, entry, boundary, map);
                            Arc::new(made.map_err(|e| named(e, position, &entry.set.object))?)
                        }
                    };
                    let before = before.map(Arc::as_ref);
                    let made = PreparedObject::new(*number, &entry.set, boundary, derived, before);
                    Arc::new(made)
                }
            };
            prepared.push(object);
        }
        let mut looks = HashMap::new();
        for object in &prepared {
            *looks.entry(object.look()).or_insert(0) += object.drawn().placements().len();
        }
        Ok(Self {
            objects: prepared,
            looks,
            facts,
            instances: objects.instances(),
            number_count: objects.number_count(),
        })
    }
}

/// Finds or bakes the shape map of an object, if its search reads one.
fn find_map(
    entry: &Entry,
    facts: &SceneFacts,
    settings: &SearchSettings,
    textures: &mut Textures,
) -> Result<Option<Arc<ShapeTexture>>> {
    let solver = |boundary: &Arc<Boundary>| facts.solver_of(boundary, settings.solver);
    if !entry
        .boundary
        .as_ref()
        .map(solver)
        .is_some_and(Solver::reads_map)
    {
        return Ok(None);
    }
    let (object, growth) = entry.shape();
    let key = MapKey::new(object, &growth, settings);
    textures.shape(&object.profile, key).map(Some)
}

struct Maker<'a> {
    demands: Demands<'a>,
    facts: &'a SceneFacts,
    textures: &'a mut Textures,
    notes: &'a mut Vec<String>,
}

impl Maker<'_> {
    /// Makes all that draws an object, beside its boundary. `position`: among all objects.
    fn derive(
        &mut self,
        position: usize,
        entry: &Entry,
        boundary: &Boundary,
        map: Option<Arc<ShapeTexture>>,
    ) -> Result<Derived> {
        if let Some(error) = boundary.table.as_ref().and_then(|table| table.failure()) {
            return Err(error.clone());
        }
        if let Some(Err(error)) = boundary.contour.as_ref().map(|c| c.get()) {
            self.note_fallback(position, &entry.set.object.name, error);
        }
        let settings = self.demands.settings;
        let (object, growth) = entry.shape();
        let solver = self.facts.solver_of(boundary, settings.solver);
        check_format(&entry.set.object, solver, settings)?;
        let map_facts = map.as_ref().map_or_else(
            || MapKey::new(object, &growth, settings).unbaked(&object.profile),
            |map| map.facts,
        );
        let arc = if object.texturing.projection == Projection::Arc {
            Some(self.textures.arc(&object.profile, &map_facts)?)
        } else {
            None
        };
        let shadows = &self.facts.shadow_maps;
        let mut numbered = (0u32..).zip(shadows.iter());
        let shadow_map = map.as_ref().and_then(|map| {
            let found = numbered.find(|(_, known)| Arc::ptr_eq(known, map));
            found.map(|(number, _)| number)
        });
        let images = &entry.set.images;
        let bound = BoundTextures {
            images: images.clone(),
            shape: map.clone(),
            arc: arc.clone(),
            shadows: shadows.clone(),
        };
        let textures = self.textures.set(&object.texturing, bound)?;
        let casters = self.facts.casters;
        let technique = Technique::new(&self.demands, solver, object, casters, images.look());
        let steps = settings.max_steps;
        let steps = steps.unwrap_or_else(|| solver.default_steps(is_beveled(object)));
        Ok(Derived {
            solver,
            steps: steps.max(1),
            map,
            facts: map_facts,
            arc,
            shadow_map: shadow_map.unwrap_or(0),
            textures,
            technique,
        })
    }

    /// Adds a note on an object whose contour failed with this error.
    fn note_fallback(&mut self, position: usize, name: &str, error: &Error) {
        let note = format!(
            "object.{position} ({name}) is drawn by the search {} in place of {}: {}",
            FALLBACK.name(),
            self.demands.settings.solver.name(),
            error.message
        );
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}

/// Returns an error if a map's format cannot show the object's offset.
fn check_format(object: &Object, solver: Solver, settings: &SearchSettings) -> Result<()> {
    if solver.reads_map() && settings.map_format == MapFormat::Rgba8 && object.offset.extend < 0.0 {
        let message = "is negative, and maps in rgba8 hold no distances within a solid; take r16, r32 or the solver quadric";
        return content("extend", message);
    }
    Ok(())
}

/// Each of these values once.
pub(in crate::gpu) fn distinct<T>(all: &mut Vec<Arc<T>>) -> &[Arc<T>] {
    all.sort_unstable_by_key(Arc::as_ptr);
    all.dedup_by_key(|one| Arc::as_ptr(one));
    all
}
