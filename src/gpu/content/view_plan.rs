//! A frame's plan, and the surfaces that it draws.

use super::entry::PreparedObject;
use super::snapshot::Snapshot;
use crate::error::Result;
use crate::plan::levels::{self, COPY_LEVELS, CopyLevels, coarsest, pixels_per_unit};
use crate::plan::path::MOST_PROXIES;
use crate::plan::precedence::{Body, Precedence, flats};
use crate::plan::walk::Walks;
use crate::plan::{Conditions, FramePlan, OpenPixels, PlanObject, View, shape_of};
use crate::settings::Tolerance;
use crate::shader::Technique;
use crate::solid::offset_surface::{OffsetSurface, Part};
use std::ops::Range;
use std::sync::Arc;

pub(crate) struct ViewPlan {
    pub view: View,
    pub snapshot: Arc<Snapshot>,
    pub with: Conditions,
    pub open: Option<Arc<OpenPixels>>,
    pub frame: FramePlan,
    /// Objects that the view's mask shows, in order.
    pub objects: Vec<PlannedObject>,
    /// Those of their copies that lag behind others.
    pub precedence: Arc<Precedence>,
    pub walks: Arc<Walks>,
}

pub(crate) struct PlannedObject {
    pub object: Arc<PreparedObject>,
    pub level: u8,
    /// The surfaces that the search walks, from the finest level on; none for searches on the map.
    pub surfaces: Vec<Arc<OffsetSurface>>,
    /// The choice of each copy's level, if copies have levels of their own.
    pub levels: Option<CopyLevels>,
}

impl PlannedObject {
    /// The vectors that hold a part of all its levels, and others between them.
    pub fn window(&self, part: Part) -> Range<u32> {
        let stored = self.surfaces.iter().filter_map(|surface| {
            let begin = surface.slot(part)?.begin();
            Some(begin..begin + surface.vectors(part).len() as u32)
        });
        stored
            .reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
            .unwrap_or_default()
    }

    /// The object in the form that a plan reads. `look_copies`: number of copies of its look.
    pub fn input(&self, look_copies: usize) -> PlanObject<'_> {
        let prepared = &*self.object;
        let object = prepared.drawn();
        let bounds = prepared.bounds(&self.surfaces[..self.surfaces.len().min(1)]);
        PlanObject {
            object,
            number: prepared.number,
            first_instance: prepared.instances.start,
            technique: prepared.derived.technique,
            textures: prepared.look().1,
            look_copies,
            surfaces: &self.surfaces,
            levels: self.levels.as_ref(),
            shape: shape_of(object, bounds.map(f64::from)),
        }
    }
}

/// The objects that a view shows, with surfaces of the levels that it allows. New surfaces are not
/// made yet. With shadows all objects take the finest level that one of them needs, because a shadow
/// may fall nearer to the eye than its caster.
pub(super) fn planned(
    view: &View,
    snapshot: &Snapshot,
    with: &Conditions,
) -> Result<Vec<PlannedObject>> {
    let shown = snapshot.objects.iter().filter(|o| o.mask & view.mask != 0);
    let mut all: Vec<_> = shown.map(|object| with_level(object, view, with)).collect();
    if with.casts {
        let finest = all.iter().map(|f| f.level).min().unwrap_or(0);
        all.iter_mut().for_each(|f| f.level = finest);
    }
    for one in &mut all {
        // The device finds the level of each copy, so no view rules a level out.
        let coarser = one.levels.iter().flat_map(|_| &COPY_LEVELS[1..]);
        for level in [one.level].iter().chain(coarser) {
            one.surfaces.extend(one.object.surface(*level)?);
        }
    }
    Ok(all)
}

/// An object at the coarsest level that the view allows, without surfaces. Objects with many copies
/// have a level for each, if they cast no shadow: the view has no influence on that, so a moving
/// camera needs no other pipelines.
fn with_level(object: &Arc<PreparedObject>, view: &View, with: &Conditions) -> PlannedObject {
    let drawn = object.drawn();
    let many = drawn.instances.len() > MOST_PROXIES && drawn.repeat == [1; 3];
    let follows = object.derived.solver.follows_tolerance() && with.tolerance != Tolerance::EXACT;
    let (mut level, mut levels) = (0, None);
    if follows && many && !with.casts && !with.parallel {
        let height = object.growth().height();
        levels = Some(CopyLevels::new(drawn, height, view, with.tolerance));
    } else if follows {
        let pixels = object.pixels_per_unit(view, with.casts);
        // An object that does not show takes a level that is already made.
        let hidden = pixels <= 0.0 && !with.casts;
        let known = object.known_level().filter(|_| hidden);
        level = known.unwrap_or_else(|| coarsest(with.tolerance, pixels));
    }
    PlannedObject {
        object: object.clone(),
        level,
        surfaces: Vec::new(),
        levels,
    }
}

/// The order of these objects' copies whose faces may coincide: that of the scene.
pub(super) fn precedence(objects: &[PlannedObject]) -> Precedence {
    let drawn = objects.iter().map(|planned| planned.object.drawn());
    let count = drawn.map(|object| object.placements().len()).sum();
    Precedence::new(count, || {
        let bodies = objects.iter().flat_map(|planned| {
            let (prepared, object) = (&planned.object, planned.object.drawn());
            let (bounds, side) = (prepared.derived.facts.bounds, object.profile.radius);
            let grow = object.offset.largest_width().max(0.0);
            let [low, high] = [bounds.z_min - grow, bounds.z_max + grow];
            let ends = [side, bounds.r_max + grow, low.max(0.0), high.min(1.0)];
            let (shape, flats) = (shape_of(object, ends), flats(object));
            let copies = (prepared.instances.start..).zip(object.placements());
            copies.map(move |(instance, place)| Body::new(instance, place, &shape, &flats))
        });
        bodies.collect()
    })
}

impl PreparedObject {
    /// What objects of one draw have in common: the technique, and the number of a set of textures.
    pub fn look(&self) -> (Technique, usize) {
        let textures = Arc::as_ptr(&self.derived.textures) as usize;
        (self.derived.technique, textures)
    }

    /// The largest number of pixels that one unit of the profile takes in a view. `all` includes
    /// copies outside the picture.
    fn pixels_per_unit(&self, view: &View, all: bool) -> f64 {
        pixels_per_unit(self.drawn(), self.growth().height(), view, all)
    }

    /// Upper bound on the shift of the silhouette by patches of a level in a view, in pixels.
    pub fn error_pixels(&self, level: u8, view: &View) -> f64 {
        levels::bound(level) * self.pixels_per_unit(view, false)
    }
}
