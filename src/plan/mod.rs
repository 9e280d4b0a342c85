//! The content of a frame as plain data: a view, objects and limits give a [`FramePlan`]. No module
//! here uses Vulkan, and [`plan()`] cannot fail.
//!
//! The fragment stage draws proxies ([`proxy`]) or tiles. The compute stage draws tiles
//! ([`tiles`]). Objects with the same pipeline and the same set of textures share
//! draws and dispatches, so their number does not grow with the number of objects.

pub(crate) mod levels;
mod path;
pub(crate) mod proxy;
pub(crate) mod tiles;
mod view;

pub use path::DrawPath;
pub(crate) use path::{Conditions, LIST_LENGTHS, Path, PlanObject, shape_of};
pub use view::{DepthOrder, View, Viewport};

use crate::shader::generated::{
    BOX_INDICES, GROUP_PIXELS, RING_CORNERS, STRIP_INDICES, TILE_BINS, TREE_BIN,
};
use crate::shader::{Kind, Pushed, Variant};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use tiles::{Batch, Drawer, LayerTiles, Projector, Visible};

/// Number of objects from which paths are chosen on all cores. Waking the cores takes as long as
/// choosing a thousand paths.
const MANY: usize = 4096;

/// Most work groups of one dispatch; every device supports this number.
const MOST_GROUPS: u32 = 65_535;

/// A frame's draws and dispatches, and all data that they read.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FramePlan {
    /// Steps in the order in which they are recorded.
    pub steps: Vec<Step>,
    pub draws: Vec<IndexedDraw>,
    /// Records of tiles, and the copies of tiles that have several.
    pub words: Vec<u32>,
    /// Words of the bins, to which the device sorts tiles by the length of their lists of patches.
    pub bin_words: u32,
    /// Words of the bins' heads, which come first and are zeroed before that.
    pub bin_head_words: u32,
    /// One path per object.
    pub paths: Vec<DrawPath>,
    /// The copies of each object that are read; none if all are.
    pub copies: Vec<Option<Vec<u32>>>,
    /// The parts of each object's surface that are read.
    pub parts: Vec<Parts>,
    /// True if compute compares depths.
    pub compares_depths: bool,
}

/// Parts of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Parts {
    /// Tables that searches walk.
    pub tables: bool,
    /// Frusta of cells, and rows of the box's sides.
    pub frusta: bool,
    /// Patches that lists are made from.
    pub patches: bool,
}

/// One draw or dispatch, or several draws that one command records.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    /// Steps of a phase wait for the steps of the phase before.
    pub phase: u32,
    pub variant: Variant,
    pub kind: Kind,
    /// Index of the object whose textures are bound and, with `variant.own_tables`, whose tables
    /// are bound.
    pub object: u32,
    pub call: Call,
}

/// The command that a step records.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Call {
    /// Draws of [`FramePlan::draws`].
    Draws(Range<u32>),
    /// Records of quads.
    Quads(Range<u32>),
    /// Work groups.
    Dispatch(u32, Pushed),
    /// Work groups; the head at this word of the bins holds their number.
    Indirect(u32, Pushed),
}

/// `VkDrawIndexedIndirectCommand`: indices, instances, first index, vertex offset, first instance.
pub(crate) type IndexedDraw = [u32; 5];

/// Plans a frame.
pub(crate) fn plan(view: &View, objects: &[PlanObject], with: &Conditions) -> FramePlan {
    let chosen = |of: &PlanObject| with.choose(of, view);
    let paths: Vec<Path> = if objects.len() < MANY {
        objects.iter().map(chosen).collect()
    } else {
        objects.par_iter().with_min_len(64).map(chosen).collect()
    };
    let mut plan = FramePlan {
        paths: paths.iter().map(Path::public).collect(),
        copies: vec![None; objects.len()],
        parts: vec![Parts::default(); objects.len()],
        ..FramePlan::default()
    };
    let variants = variants(objects, with);
    plan.add_proxies(view, objects, (&paths, &variants));
    plan.add_tiles(view, objects, (&paths, &variants), with);
    for (parts, object) in plan.parts.iter_mut().zip(objects) {
        parts.tables |= with.casts;
        parts.tables &= object.surface.is_some();
    }
    plan
}

impl Path {
    fn public(&self) -> DrawPath {
        match self {
            Self::Box => DrawPath::Box,
            Self::Cells { .. } => DrawPath::Cells,
            Self::Tiles => DrawPath::Tiles,
        }
    }
}

/// The variant of each object. The result depends on whether another object has the same variant
/// and textures. The view has no influence, so a moving camera needs no other pipelines.
pub(crate) fn variants(objects: &[PlanObject], with: &Conditions) -> Vec<Variant> {
    let mut looks = HashMap::new();
    for of in objects {
        *looks.entry((of.variant, of.textures)).or_insert(0u32) += 1;
    }
    let of_look = |of: &PlanObject| {
        let alone = looks.get(&(of.variant, of.textures)) == Some(&1);
        Variant {
            one_object: u32::from(alone),
            one_instance: u32::from(alone && of.copies().len() == 1),
            own_tables: u32::from(alone && with.holds_tables(of)),
            ..of.variant
        }
    };
    objects.iter().map(of_look).collect()
}

/// Objects that share a pipeline and a set of textures.
struct Layer {
    variant: Variant,
    kind: Kind,
    objects: Vec<u32>,
    draws: Vec<IndexedDraw>,
}

impl Layer {
    /// The layer of an object; created for the first object of that layer.
    fn of<'a>(
        all: &'a mut Vec<Self>,
        objects: &[PlanObject],
        number: usize,
        (variant, kind): (Variant, Kind),
    ) -> (usize, &'a mut Self) {
        let textures = objects[number].textures;
        let same = |layer: &Self| {
            let like = layer.objects.first().map(|&n| objects[n as usize].textures);
            (layer.variant, layer.kind, like) == (variant, kind, Some(textures))
        };
        let at = all.iter().position(same).unwrap_or_else(|| {
            all.push(Self {
                variant,
                kind,
                objects: Vec::new(),
                draws: Vec::new(),
            });
            all.len() - 1
        });
        all[at].objects.push(number as u32);
        (at, &mut all[at])
    }
}

impl FramePlan {
    /// Boxes and cells.
    fn add_proxies(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        (paths, variants): (&[Path], &[Variant]),
    ) {
        let mut layers = Vec::new();
        for (n, (of, path)) in objects.iter().zip(paths).enumerate() {
            let count = of.object.placements().len() as u32;
            let draw = |indices: u32, first| [indices, count, first, 0, of.first_instance];
            let seen = |outside: bool| Variant {
                outside: u32::from(outside),
                ..variants[n]
            };
            let mut add = |kind: Kind, outside, draws: &mut dyn Iterator<Item = IndexedDraw>| {
                let key = (seen(outside).of_kind(kind), kind);
                Layer::of(&mut layers, objects, n, key)
                    .1
                    .draws
                    .extend(draws);
            };
            match path {
                Path::Tiles => {}
                Path::Box => {
                    let apart = |s| proxy::is_seen_from_outside(of.object, s, view);
                    let outside = of.surface.is_some_and(|s| apart(s));
                    add(
                        Kind::Boxes,
                        outside,
                        &mut [draw(BOX_INDICES, 0)].into_iter(),
                    );
                    self.parts[n].tables = true;
                }
                Path::Cells { frusta, cut } => {
                    let corners = |frusta: u32| 6 * RING_CORNERS * frusta;
                    let all = BOX_INDICES + STRIP_INDICES;
                    let of_run = |run: &Range<u32>| {
                        draw(corners(run.end - run.start), all + corners(run.start))
                    };
                    add(Kind::Cells, !cut, &mut frusta.iter().map(of_run));
                    if *cut {
                        let strips = draw(STRIP_INDICES, BOX_INDICES);
                        add(Kind::Boxes, false, &mut [strips].into_iter());
                    }
                    self.parts[n].frusta = true;
                    self.parts[n].tables |= *cut;
                }
            }
        }
        for layer in layers {
            let first = self.draws.len() as u32;
            self.draws.extend(&layer.draws);
            self.steps.push(Step {
                phase: 0,
                variant: layer.variant,
                kind: layer.kind,
                object: layer.objects[0],
                call: Call::Draws(first..self.draws.len() as u32),
            });
        }
    }

    /// Tiles of all objects whose path is [`Path::Tiles`].
    fn add_tiles(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        (paths, variants): (&[Path], &[Variant]),
        with: &Conditions,
    ) {
        let drawn = |n: &usize| paths[*n] == Path::Tiles;
        let numbers: Vec<usize> = (0..objects.len()).filter(drawn).collect();
        if numbers.is_empty() {
            self.compares_depths = with.host_depths;
            return;
        }
        let batches: Vec<Batch> = (numbers.iter())
            .map(|&n| batch(&objects[n], with))
            .collect();
        let projector = Projector::new(view);
        let visible = Visible::new(view, &projector, &batches);
        let mut layers = Vec::new();
        let mut layer_of = Vec::with_capacity(numbers.len());
        let kind = if with.compute {
            Kind::TileTree
        } else {
            Kind::Quads
        };
        let copies = visible.copies();
        for (batch, &n) in numbers.iter().enumerate() {
            let of = &objects[n];
            if copies[batch].is_empty() {
                // The object is in no layer, because none of its copies is listed.
                layer_of.push(u32::MAX);
                continue;
            }
            let variant = Variant {
                outside: u32::from(of.is_whole() && visible.is_apart(batch)),
                ..variants[n]
            };
            let (layer, _) = Layer::of(&mut layers, objects, n, (variant, kind));
            layer_of.push(layer as u32);
        }
        let drawer = if with.compute {
            Drawer::Groups
        } else {
            Drawer::Fragments
        };
        let mut dealt = visible.deal(drawer, &layer_of, layers.len());
        for (layer, tiles) in layers.iter().zip(&mut dealt.layers) {
            let patches = |&n: &u32| objects[n as usize].listed_patches();
            let patches = layer.objects.iter().map(patches).sum();
            if !with.gains_by_lists(tiles.listed.len() as u64, patches) {
                tiles.unlist();
            }
        }
        let sum = |of: fn(u32) -> u32| -> u64 {
            let counted = |l: &LayerTiles| u64::from(of(l.listed.len() as u32));
            dealt.layers.iter().map(counted).sum()
        };
        if sum(bin_words) > with.room() || !with.pays_to_list(sum(|tiles| tiles)) {
            dealt.layers.iter_mut().for_each(LayerTiles::unlist);
        }
        for (batch, (&n, copies)) in numbers.iter().zip(copies).enumerate() {
            if copies.is_empty() {
                self.paths[n] = DrawPath::Nothing;
            }
            let shows = !copies.is_empty();
            let lists = || !dealt.layers[layer_of[batch] as usize].listed.is_empty();
            self.parts[n].tables = shows;
            self.parts[n].patches = shows && visible.lists_patches(batch) && lists();
            self.copies[n] = (!with.casts).then_some(copies);
        }
        if with.compute {
            self.dispatch(&layers, &dealt.layers, objects, with);
        } else {
            for (layer, tiles) in layers.iter().zip(&dealt.layers) {
                self.steps.push(Step {
                    phase: 0,
                    variant: layer.variant.of_kind(kind),
                    kind,
                    object: layer.objects[0],
                    call: Call::Quads(tiles.quads.clone()),
                });
            }
        }
        self.words = dealt.words;
    }

    /// Adds the dispatches of tiles. Lists of patches come first, then tiles of one copy, which
    /// share no pixels. Tiles of several copies follow, layer by layer.
    fn dispatch(
        &mut self,
        layers: &[Layer],
        tiles: &[LayerTiles],
        objects: &[PlanObject],
        with: &Conditions,
    ) {
        let several = tiles.iter().any(|t| !t.several.is_empty());
        self.compares_depths = several || with.host_depths;
        let heads = |t: &LayerTiles| t.listed.len().div_ceil(MOST_GROUPS as usize) as u32;
        self.bin_head_words = 4 * TILE_BINS * tiles.iter().map(heads).sum::<u32>();
        let mut phase = 2;
        let mut later = Vec::new();
        let mut head = 0;
        self.bin_words = self.bin_head_words;
        for (layer, tiles) in layers.iter().zip(tiles) {
            let base = Variant {
                depth_test: u32::from(self.compares_depths),
                depth_keep: u32::from(self.compares_depths),
                ..layer.variant
            };
            let step = |phase, kind, variant: Variant, call| Step {
                phase,
                variant: variant.of_kind(kind),
                kind,
                object: layer.objects[0],
                call,
            };
            let first = &objects[layer.objects[0] as usize];
            let (object, instance) = (first.number, first.first_instance);
            for records in chunks(&tiles.listed) {
                let count = records.end - records.start;
                let (first, begin) = (records.start, self.bin_words);
                let pushed = |bin| Pushed {
                    first,
                    count,
                    heads: head,
                    records: begin,
                    bin,
                    object,
                    instance,
                };
                let groups = count.div_ceil(GROUP_PIXELS * GROUP_PIXELS);
                let call = Call::Dispatch(groups, pushed(0));
                self.steps.push(step(0, Kind::TileLists, base, call));
                // The last bin holds tiles that walk the tree.
                let lengths = LIST_LENGTHS.into_iter().chain([1]);
                for (bin, list_length) in (0..).zip(lengths) {
                    let call = Call::Indirect(head + 4 * bin, pushed(bin));
                    let kind = match bin < TREE_BIN {
                        true => Kind::TilePatches,
                        false => Kind::TileTree,
                    };
                    let variant = Variant {
                        list_length,
                        ..base
                    };
                    later.push(step(1, kind, variant, call));
                }
                head += 4 * TILE_BINS;
                self.bin_words += 4 * TILE_BINS * count;
            }
            let alone = chunks(&tiles.single).map(|records| (1, Kind::TileTree, records));
            let shared = chunks(&tiles.several).map(|records| (phase, Kind::TileCopies, records));
            for (phase, kind, records) in alone.chain(shared) {
                let pushed = Pushed {
                    first: records.start,
                    object,
                    instance,
                    ..Pushed::default()
                };
                let call = Call::Dispatch(records.len() as u32, pushed);
                later.push(step(phase, kind, base, call));
            }
            phase += u32::from(!tiles.several.is_empty());
        }
        later.sort_by_key(|step| step.phase);
        self.steps.extend(later);
    }
}

/// An object's copies, as input for finding tiles.
fn batch<'a>(of: &'a PlanObject<'a>, with: &Conditions) -> Batch<'a> {
    let surface = of.surface.filter(|_| of.object.repeat == [1; 3]);
    let surface = surface.map(Arc::as_ref).filter(|s| s.is_of_patches());
    let culls = surface.filter(|_| with.occlusion_culling);
    let outlined = with.uses_outline(of) && of.object.repeat == [1; 3];
    let of_outline = of.outline.filter(|_| outlined && surface.is_none());
    let of_outline = of_outline.map(|(outline, away)| (outline.outer(), away));
    Batch {
        placements: of.copies(),
        first: of.first_instance,
        shape: of.shape,
        inner: culls.filter(|_| of.is_whole()).and_then(|s| s.inner()),
        outer: culls
            .and_then(|s| s.outer())
            .map(|outer| (outer, 0.0))
            .or(of_outline),
        surface,
        half_side: of.object.profile.radius,
        permits_lists: with.permits_lists(of),
    }
}

/// Words of the bins of this many tiles: see `compute.glsl`.
fn bin_words(tiles: u32) -> u32 {
    4 * TILE_BINS * (tiles.div_ceil(MOST_GROUPS) + tiles)
}

/// Runs of records, each short enough for one dispatch.
fn chunks(records: &Range<u32>) -> impl Iterator<Item = Range<u32>> {
    let Range { start, end } = *records;
    (start..end)
        .step_by(MOST_GROUPS as usize)
        .map(move |first| first..end.min(first + MOST_GROUPS))
}
