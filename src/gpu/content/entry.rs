//! An object as the host set it, and the same object as prepared: with all that its frames read.

use crate::error::Result;
use crate::gpu::resources::shape_texture::{ArcTexture, MapFacts, ShapeTexture};
use crate::gpu::resources::textures::{ObjectImages, TextureSet};
use crate::plan::levels;
use crate::scene::{Copies, GrownObject, Growth, Object, Placement};
use crate::settings::Solver;
use crate::shader::Technique;
use crate::solid::cache::Solid;
use crate::solid::contour::OffsetContour;
use crate::solid::farthest_corner;
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use std::ops::{Deref, Range};
use std::sync::{Arc, OnceLock};

/// An object as set, and its state in the last snapshot.
pub(in crate::gpu) struct Entry {
    pub set: ObjectState,
    /// The boundary of the object as set; `None` before it is made.
    pub boundary: Option<Arc<Boundary>>,
    /// The object in the last snapshot; `None` for a new one.
    pub prepared: Option<Arc<PreparedObject>>,
    /// What must be made anew for the next snapshot.
    pub stale: Stale,
}

/// The parts of a [`PreparedObject`] that a change makes invalid. Later ones include earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::gpu) enum Stale {
    Nothing,
    /// Placements, mask, instances, motion.
    State,
    /// Images.
    Look,
    /// All else.
    Shape,
}

/// Values of an object, all of which the host sets.
#[derive(Clone)]
pub(in crate::gpu) struct ObjectState {
    pub object: Object,
    pub images: ObjectImages,
    /// Views whose mask shares no bit with it do not show the object.
    pub mask: u32,
    pub instances: Range<u32>,
    pub last: Last,
}

/// The values of the last frame, for motion.
#[derive(Clone)]
pub(in crate::gpu) enum Last {
    /// They are the present ones.
    Same,
    /// There are none.
    New,
    Was(LastValues),
}

/// An object with the resources that its frames read, whatever the view. It never changes.
pub(in crate::gpu) struct PreparedObject {
    pub number: u32,
    pub state: ObjectState,
    /// The object that is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    pub boundary: Arc<Boundary>,
    pub derived: Arc<Derived>,
}

/// The boundary of an object, in the forms that searches read. It follows from the object alone.
pub(in crate::gpu) struct Boundary {
    /// The object that is drawn, in a box that has grown; with earlier placements.
    pub grown: Option<GrownObject>,
    /// Keeps the solid alive; the cache does not.
    pub solid: Arc<Solid>,
    /// The contour whose patches are searched, or would be if it closed; `None` for a search on the
    /// map or on a table of its own.
    pub contour: Option<Arc<OffsetContour>>,
    /// The table of a search that has one.
    pub table: Option<Arc<OffsetSurface>>,
    /// Surfaces of patches that views needed, by level. Keeps them alive.
    pub levels: [OnceLock<Arc<OffsetSurface>>; levels::COARSEST as usize + 1],
}

impl Boundary {
    /// True if the search on patches has no contour to search.
    pub fn fails(&self) -> bool {
        self.contour.as_ref().is_some_and(|c| c.get().is_err())
    }
}

/// The resources of an object that may depend on other objects.
pub(in crate::gpu) struct Derived {
    /// The search that draws the object; it may differ from the settings.
    pub solver: Solver,
    pub steps: u32,
    pub map: Option<Arc<ShapeTexture>>,
    pub facts: MapFacts,
    pub arc: Option<Arc<ArcTexture>>,
    /// The number of the object's map among the maps that shadows read.
    pub shadow_map: u32,
    pub textures: Arc<TextureSet>,
    pub technique: Technique,
}

#[derive(Clone)]
pub(in crate::gpu) struct LastValues {
    placement: Placement,
    instances: Copies,
    pub extend: f64,
}

impl LastValues {
    pub fn of(object: &Object) -> Self {
        Self {
            placement: object.placement,
            instances: object.instances.clone(),
            extend: object.offset.extend,
        }
    }

    /// The placements, if there are as many as `now`.
    pub fn placements(&self, now: usize) -> Option<&[Placement]> {
        let all = match self.instances.is_empty() {
            true => std::slice::from_ref(&self.placement),
            false => &self.instances,
        };
        (all.len() == now).then_some(all)
    }
}

impl Entry {
    pub const fn new(object: Object, images: ObjectImages, instances: Range<u32>) -> Self {
        Self {
            set: ObjectState {
                object,
                images,
                mask: u32::MAX,
                instances,
                last: Last::New,
            },
            boundary: None,
            prepared: None,
            stale: Stale::Shape,
        }
    }

    pub fn mark(&mut self, stale: Stale) {
        self.stale = self.stale.max(stale);
        if stale == Stale::Shape {
            self.boundary = None;
        }
    }

    /// The object that will be drawn, with earlier placements, and the growth of its box; before its
    /// boundary is made, the object as set.
    pub fn shape(&self) -> (&Object, Growth) {
        let grown = self.boundary.as_ref().and_then(|b| b.grown.as_ref());
        shape(grown, &self.set.object)
    }
}

/// The object that is drawn in place of another, and the growth of its box.
pub(super) fn shape<'a>(grown: Option<&'a GrownObject>, own: &'a Object) -> (&'a Object, Growth) {
    grown.map_or((own, Growth::default()), |g| (&g.object, g.growth))
}

impl Deref for PreparedObject {
    type Target = ObjectState;

    fn deref(&self) -> &ObjectState {
        &self.state
    }
}

impl PreparedObject {
    /// The object in a state. `before`: the same object in the last snapshot.
    pub fn new(
        number: u32,
        state: &ObjectState,
        boundary: &Arc<Boundary>,
        derived: Arc<Derived>,
        before: Option<&Self>,
    ) -> Self {
        let object = &state.object;
        let places = |of: &Object| (of.placement, of.instances.clone());
        let kept = before.filter(|before| {
            Arc::ptr_eq(&before.boundary, boundary) && places(&before.object) == places(object)
        });
        let placed = || boundary.grown.as_ref().map(|grown| grown.placed_as(object));
        Self {
            number,
            state: state.clone(),
            grown: kept.map_or_else(placed, |before| before.grown.clone()),
            boundary: boundary.clone(),
            derived,
        }
    }

    /// The object in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        shape(self.grown.as_ref(), &self.object).0
    }

    /// The growth of the box with the offset.
    pub fn growth(&self) -> Growth {
        shape(self.grown.as_ref(), &self.object).1
    }

    /// The coarsest level that a view needed; `None` before the first view.
    pub fn known_level(&self) -> Option<u8> {
        (0..=levels::COARSEST).rfind(|&level| self.boundary.levels[level as usize].get().is_some())
    }

    /// The surface of a level; none for a search on the map. A new surface is not made yet.
    pub fn surface(&self, level: u8) -> Result<Option<Arc<OffsetSurface>>> {
        let boundary = &self.boundary;
        // Surfaces of patches may be left from before the fallback.
        if self.derived.solver.reads_map() {
            return Ok(None);
        }
        if !self.derived.solver.follows_tolerance() {
            return Ok(boundary.table.clone());
        }
        let known = &boundary.levels[level as usize];
        if known.get().is_none() {
            let tolerance = levels::bound(level) / self.growth().height().max(1.0);
            let recipe = Recipe::Patches { level, tolerance };
            let surface = boundary.solid.surface(&self.drawn().offset, recipe)?;
            known.get_or_init(|| surface);
        }
        Ok(known.get().cloned())
    }

    /// Half of the box's side, then the radius, lowest `z` and highest `z` of the cylinder outside
    /// of which nothing is solid.
    pub fn bounds(&self, surfaces: &[Arc<OffsetSurface>]) -> [f32; 4] {
        let (object, map, solver) = (self.drawn(), &self.derived.facts, self.derived.solver);
        let texel = 1.0 / f64::from(map.rows);
        let grow = object.offset.largest_width().max(0.0) + texel;
        // The map gives no values beyond its last column.
        let reach = if solver.reads_map() {
            f64::from(map.columns) * texel
        } else {
            f64::INFINITY
        };
        let radius = (map.bounds.r_max + grow)
            .min(farthest_corner(object) + texel)
            .min(reach);
        let patches = surfaces.iter().filter(|_| solver.follows_tolerance());
        [
            object.profile.radius as f32,
            (radius + patches.map(|s| s.slack()).fold(0.0, f64::max)) as f32,
            (map.bounds.z_min - grow).max(0.0) as f32,
            (map.bounds.z_max + grow).min(1.0) as f32,
        ]
    }
}
