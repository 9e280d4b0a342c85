//! The content of a frame as plain data: a view, objects and limits give a [`FramePlan`]. No module
//! here uses Vulkan, and [`plan()`] cannot fail.
//!
//! The fragment stage draws proxies ([`proxy`]) or [walks](walk), the compute stage
//! [walks](walk_steps). Objects with the same pipeline and the same set of textures share
//! draws and dispatches, so their number does not grow with the number of objects.

pub(crate) mod levels;
mod open_pixels;
pub(crate) mod path;
pub(crate) mod precedence;
mod projector;
pub(crate) mod proxy;
mod view;
#[cfg(test)]
mod viewports;
pub(crate) mod walk;
mod walk_steps;

pub use path::DrawPath;
pub(crate) use path::{Conditions, PlanObject, shape_of};
pub use view::{DepthOrder, View, Viewport};

pub use open_pixels::OpenPixels;
pub(crate) use projector::MOST_PIXELS;
use projector::Projector;

use crate::shader::generated::{BOX_INDICES, RING_CORNERS};
use crate::shader::{Drawn, Kind, Pushed, Speciality, Variant};
use crate::solid::offset_surface::{OffsetSurface, Part};
use crate::surface::Frustum;
use path::CellRuns;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use walk::Walks;

/// Number of objects from which paths are chosen on all cores. Waking the cores takes as long as
/// choosing a thousand paths.
const MANY: usize = 4096;

/// A frame's draws and dispatches, and all data that they read.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FramePlan {
    pub steps: Vec<Step>,
    pub draws: Vec<IndexedDraw>,
    /// The buffer of open pixels: see `walk.comp`.
    pub open_pixels: Vec<u32>,
    /// Vectors of the bins: see `compute.glsl`.
    pub bin_vectors: u32,
    /// Heads of the bins, a vector each, which come first and are zeroed before that.
    pub bin_heads: u32,
    /// The pixels that walks may draw: left and upper edge, width, height.
    pub picture: [u32; 4],
    pub paths: Vec<DrawPath>,
    /// For each object, whether each [`Part`] of its surfaces is read.
    pub parts: Vec<[bool; 3]>,
    /// For each object that is not drawn by cells, true if its box cuts nothing, and rays from the eye
    /// begin outside of the solid.
    pub outside: Vec<bool>,
}

/// One draw or dispatch, or several draws that one command records.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    /// Steps of a phase wait for the steps of the phase before.
    pub phase: u32,
    pub variant: Variant,
    pub kind: Kind,
    /// Index of the object whose textures are bound, and whose block and tables if it is the only
    /// one.
    pub object: u32,
    pub call: Call,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Call {
    /// Draws of [`FramePlan::draws`].
    Draws(Range<u32>),
    /// Points over tiles of the picture, for fragments that walk the hierarchy of this index.
    Walk(Range<u32>, u32),
    /// Work groups; this head of the bins holds their number.
    Indirect(u32, Pushed),
    Groups(u32, Pushed),
}

/// `VkDrawIndexedIndirectCommand`: indices, instances, first index, vertex offset, first instance.
pub(crate) type IndexedDraw = [u32; 5];

/// Plans a frame. `open`: the pixels that compute draws; all if none. `walks`: the hierarchies that
/// rays walk.
pub(crate) fn plan(
    view: &View,
    objects: &[PlanObject],
    with: &Conditions,
    open: Option<&OpenPixels>,
    walks: &Walks,
) -> FramePlan {
    let cells = for_each(objects, |of| with.cells(of, view));
    let path = |(of, cells): (&PlanObject, &Option<_>)| match cells {
        Some(_) => DrawPath::Cells,
        None if with.walks_to(of) => DrawPath::Walk,
        None => DrawPath::Box,
    };
    let mut plan = FramePlan {
        paths: objects.iter().zip(&cells).map(path).collect(),
        parts: vec![[false; 3]; objects.len()],
        outside: vec![false; objects.len()],
        ..FramePlan::default()
    };
    let variants = variants(objects, with);
    plan.add_proxies(view, objects, cells, &variants);
    plan.add_walks(view, objects, &variants, (walks, with), open);
    for (parts, object) in plan.parts.iter_mut().zip(objects) {
        let tables = &mut parts[Part::Tables as usize];
        *tables = (*tables || with.casts) && !object.surfaces.is_empty();
    }
    plan
}

/// The surfaces whose hulls must be made before [`plan()`] reads them.
pub(crate) fn missing_hulls(
    view: &View,
    objects: &[PlanObject],
    with: &Conditions,
) -> impl Iterator<Item = Arc<OffsetSurface>> {
    let lacking = for_each(objects, |of| with.lacks_hull(of, view));
    lacking.into_iter().flatten()
}

/// The values of a function for all objects, on all cores for [`MANY`].
fn for_each<T: Send>(
    objects: &[PlanObject],
    of: impl Fn(&PlanObject) -> T + Send + Sync,
) -> Vec<T> {
    match objects.len() < MANY {
        true => objects.iter().map(of).collect(),
        false => objects.par_iter().with_min_len(16).map(of).collect(),
    }
}

/// The projector of a view, with a margin for the levels of copies.
fn projector(view: &View, objects: &[PlanObject], with: &Conditions) -> Projector {
    let levelled = objects.iter().any(|of| of.levels.is_some());
    let slack = if levelled {
        levels::allowed(with.tolerance)
    } else {
        0.0
    };
    Projector::new(view, with.ray_spread, slack)
}

/// The variant of each object: its technique, and what its draws promise. A promise may depend on
/// the other objects of the plan.
fn variants(objects: &[PlanObject], with: &Conditions) -> Vec<Variant> {
    let of_look = |of: &PlanObject| Variant {
        technique: of.technique,
        speciality: Speciality {
            lights: with.lights,
            drawn: match of.object.placements().len() {
                copies if copies < of.look_copies => Drawn::Objects,
                1 => Drawn::OneCopy,
                _ => Drawn::OneObject,
            },
            depths: with.compares_depths(),
            ..Speciality::GENERAL
        },
    };
    objects.iter().map(of_look).collect()
}

/// Draws of objects that share a pipeline and a set of textures, in the order of the first objects.
#[derive(Default)]
struct Layers {
    all: Vec<Layer>,
    /// The index of each layer: objects may have as many looks as there are objects.
    numbers: HashMap<(Variant, Kind, usize), usize>,
}

struct Layer {
    variant: Variant,
    kind: Kind,
    object: u32,
    draws: Vec<IndexedDraw>,
}

impl Layers {
    /// Adds draws of an object; the layer is created for its first object.
    fn add(
        &mut self,
        object: u32,
        textures: usize,
        (variant, kind): (Variant, Kind),
        draws: Vec<IndexedDraw>,
    ) {
        let next = self.all.len();
        let at = *(self.numbers.entry((variant, kind, textures))).or_insert(next);
        match self.all.get_mut(at) {
            Some(layer) => layer.draws.extend(draws),
            None => self.all.push(Layer {
                variant,
                kind,
                object,
                draws,
            }),
        }
    }
}

impl FramePlan {
    fn add_proxies(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        cells: Vec<Option<CellRuns>>,
        variants: &[Variant],
    ) {
        let mut layers = Layers::default();
        for (n, (of, cells)) in objects.iter().zip(cells).enumerate() {
            let count = of.object.placements().len() as u32;
            let draw = |indices: u32, first| [indices, count, first, 0, of.first_instance];
            let mut add = |kind, [outside, single]: [bool; 2], draws: Vec<IndexedDraw>| {
                let mut variant = variants[n].seen_from_outside(outside);
                variant.speciality.single = single;
                layers.add(n as u32, of.textures, (variant.of_kind(kind), kind), draws);
            };
            if self.paths[n] == DrawPath::Box {
                let surface = of.surface().filter(|s| s.is_of_patches());
                let apart = |s| proxy::is_seen_from_outside(of.object, s, view);
                self.outside[n] = surface.is_some_and(|s| apart(s));
                self.parts[n][Part::Tables as usize] = true;
                let draws = vec![draw(BOX_INDICES, 0)];
                add(Kind::Boxes, [self.outside[n], false], draws);
            }
            let Some([cut, whole]) = cells else {
                continue;
            };
            let corners = |frusta: usize| 6 * RING_CORNERS * frusta as u32;
            let hull = of.surface().and_then(|s| s.hull());
            let frusta = hull.map(|made| made.hull.frusta.as_slice());
            let is_single = |f: &Frustum| f.count == 1;
            // The draws of the parts of a run whose cells have one patch, or several.
            let of_run = |run: &Range<u32>, single: bool| {
                let mut begin = run.start as usize;
                let frusta = &frusta.unwrap_or_default()[begin..run.end as usize];
                let parts = frusta.chunk_by(|a, b| is_single(a) == is_single(b));
                let draws = parts.filter_map(|part| {
                    let first = BOX_INDICES + corners(begin);
                    begin += part.len();
                    (is_single(&part[0]) == single).then(|| draw(corners(part.len()), first))
                });
                draws.collect::<Vec<_>>()
            };
            self.parts[n][Part::Frusta as usize] = true;
            self.parts[n][Part::Tables as usize] = !cut.is_empty();
            for (kind, runs) in [(Kind::CutCells, cut), (Kind::Cells, whole)] {
                for single in [true, false] {
                    let draws: Vec<_> = runs.iter().flat_map(|run| of_run(run, single)).collect();
                    if !draws.is_empty() {
                        add(kind, [false, single], draws);
                    }
                }
            }
        }
        for layer in layers.all {
            let first = self.draws.len() as u32;
            self.draws.extend(&layer.draws);
            self.steps.push(Step {
                phase: 0,
                variant: layer.variant,
                kind: layer.kind,
                object: layer.object,
                call: Call::Draws(first..self.draws.len() as u32),
            });
        }
    }
}
