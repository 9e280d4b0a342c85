//! Steps that draw tiles, by dispatches.

use super::path::{LIST_LENGTHS, is_flat};
use super::tiles::{Batch, LayerTiles, OpenPixels, TILE_PIXELS, Visible};
use super::{
    Call, Conditions, DrawPath, FramePlan, Layer, Layers, Path, PlanObject, Step, View, projector,
};
use crate::shader::generated::{MOST_GROUPS, TILE_BINS, TREE_BIN};
use crate::shader::{BinTile, Kind, Pushed, Variant};
use crate::solid::offset_surface::Part;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

impl FramePlan {
    /// Tiles of all objects whose path is [`Path::Tiles`].
    pub(super) fn add_tiles(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        (paths, variants): (&[Path], &[Variant]),
        (with, open): (&Conditions, Option<&OpenPixels>),
    ) {
        let drawn = |n: &usize| paths[*n] == Path::Tiles;
        let numbers: Vec<usize> = (0..objects.len()).filter(drawn).collect();
        if numbers.is_empty() {
            return;
        }
        let batches: Vec<Batch> = (numbers.par_iter())
            .map(|&n| batch(&objects[n], with))
            .collect();
        let projector = projector(view, objects, with);
        let visible = Visible::new(view, &projector, &batches);
        let mut layers = Layers::default();
        let mut layer_of = Vec::with_capacity(numbers.len());
        let copies = visible.copies();
        for (batch, &n) in numbers.iter().enumerate() {
            let of = &objects[n];
            if copies[batch].is_empty() {
                // The object is in no layer, because none of its copies is listed.
                layer_of.push(u32::MAX);
                continue;
            }
            self.outside[n] = of.is_whole() && visible.is_apart(batch);
            let variant = variants[n].seen_from_outside(self.outside[n]);
            let layer = layers.of(objects, n as u32, (variant, Kind::TileTree));
            layer_of.push(layer as u32);
        }
        let layers = layers.all;
        let mut tiles = visible.write(open, &layer_of, layers.len());
        leave_out_lists(view, objects, &layers, &mut tiles.layers, with);
        for (batch, (&n, copies)) in numbers.iter().zip(copies).enumerate() {
            if copies.is_empty() {
                self.paths[n] = DrawPath::Nothing;
            }
            let shows = !copies.is_empty();
            let lists = || !tiles.layers[layer_of[batch] as usize].listed.is_empty();
            self.parts[n][Part::Tables as usize] = shows;
            self.parts[n][Part::Patches as usize] =
                shows && visible.lists_patches(batch) && lists();
            self.copies[n] = (!with.casts).then_some(copies);
        }
        self.dispatch(&layers, &tiles.layers, objects);
        self.tile_words = tiles.words;
    }

    /// Adds the dispatches of tiles. Lists of patches come first, then tiles of one copy, which
    /// share no pixels. Tiles of several copies follow, layer by layer.
    fn dispatch(&mut self, layers: &[Layer], tiles: &[LayerTiles], objects: &[PlanObject]) {
        let heads = |t: &LayerTiles| t.listed.len().div_ceil(MOST_GROUPS as usize) as u32;
        let mut head = self.bin_heads;
        self.bin_heads += TILE_BINS * tiles.iter().map(heads).sum::<u32>();
        let mut phase = 2;
        let mut later = Vec::new();
        self.bin_vectors = self.bin_heads;
        for (layer, tiles) in layers.iter().zip(tiles) {
            let base = layer.variant;
            let step = |phase, kind, call| Step {
                phase,
                variant: base.of_kind(kind),
                kind,
                object: layer.objects[0],
                call,
            };
            let first = &objects[layer.objects[0] as usize];
            let (object, instance) = (first.number, first.first_instance);
            for range in chunks(&tiles.listed, 1) {
                let count = range.end - range.start;
                let begin = self.bin_vectors;
                let pushed = |bin| Pushed {
                    first: range.start,
                    count,
                    heads: head,
                    tiles: begin,
                    bin,
                    object,
                    instance,
                    ..Pushed::default()
                };
                let call = Call::Groups(count.div_ceil(TILE_PIXELS), pushed(0));
                self.steps.push(step(0, Kind::TileLists, call));
                let call = |bin| Call::Indirect(head + bin, pushed(bin));
                for (bin, length) in (0..).zip(LIST_LENGTHS) {
                    later.push(step(1, Kind::TilePatches(length), call(bin)));
                }
                later.push(step(1, Kind::TileTree, call(TREE_BIN)));
                head += TILE_BINS;
                self.bin_vectors += TILE_BINS * count;
            }
            let ranges = [
                (1, Kind::TileTree, &tiles.single, 1),
                (phase, Kind::TileCopies, &tiles.queued, 1),
                (phase, Kind::TileCopies, &tiles.gathered, TILE_PIXELS),
            ];
            for (phase, kind, range, per_group) in ranges {
                for range in chunks(range, per_group) {
                    let pushed = Pushed {
                        first: range.start,
                        gathered: u32::from(per_group > 1),
                        object,
                        instance,
                        ..Pushed::default()
                    };
                    let call = Call::Groups(range.len() as u32 / per_group, pushed);
                    later.push(step(phase, kind, call));
                }
            }
            phase += u32::from(!tiles.queued.is_empty() || !tiles.gathered.is_empty());
        }
        later.sort_by_key(|step| step.phase);
        self.steps.extend(later);
    }
}

/// Leaves out lists of patches where they take longer than the tree, or need too much room.
fn leave_out_lists(
    view: &View,
    objects: &[PlanObject],
    layers: &[Layer],
    tiles: &mut [LayerTiles],
    with: &Conditions,
) {
    let layers_of_lists = layers.iter().zip(&mut *tiles);
    for (layer, tiles) in layers_of_lists.filter(|(_, tiles)| !tiles.listed.is_empty()) {
        let patches = |&n: &u32| objects[n as usize].listed_patches();
        let mean = layer.objects.iter().map(patches).sum::<u64>() / layer.objects.len() as u64;
        let tiles_of_all = view.tiles_of_all_rows(tiles.listed.len() as u64);
        let flat = || {
            layer
                .objects
                .iter()
                .any(|&n| is_flat(objects[n as usize].object))
        };
        if !with.gains_by_lists(tiles_of_all, mean, flat) {
            tiles.unlist();
        }
    }
    let bytes = |l: &LayerTiles| {
        size_of::<BinTile>() as u64 * u64::from(bin_vectors(l.listed.len() as u32))
    };
    if tiles.iter().map(bytes).sum::<u64>() > with.room() {
        tiles.iter_mut().for_each(LayerTiles::unlist);
    }
}

/// An object's copies, as input for finding tiles.
fn batch<'a>(of: &'a PlanObject<'a>, with: &Conditions) -> Batch<'a> {
    let surface = of.surface().filter(|_| of.object.repeat == [1; 3]);
    let surface = surface.map(Arc::as_ref).filter(|s| s.is_of_patches());
    let culls = surface.filter(|_| with.occlusion_culling);
    // A single copy hides no other.
    let inner = culls.filter(|_| !with.single_copy && of.is_whole());
    let outlined = with.uses_outline(of) && of.object.repeat == [1; 3];
    let of_outline = of.outline.filter(|_| outlined && surface.is_none());
    let of_outline = of_outline.map(|(outline, away)| (outline.outer(), away));
    Batch {
        object: of.object,
        first: of.first_instance,
        shape: of.shape,
        inner: inner.and_then(|s| s.cylinders()).map(|[inner, _]| inner),
        outer: culls
            .and_then(|s| s.cylinders())
            .map(|[_, outer]| (outer, 0.0))
            .or(of_outline),
        surface,
        permits_lists: with.permits_lists(of),
    }
}

/// Vectors of the bins of this many tiles: see `compute.glsl`.
fn bin_vectors(tiles: u32) -> u32 {
    TILE_BINS * (tiles.div_ceil(MOST_GROUPS) + tiles)
}

/// Parts of a range, each short enough for one dispatch of groups of so many.
fn chunks(range: &Range<u32>, per_group: u32) -> impl Iterator<Item = Range<u32>> {
    let (Range { start, end }, most) = (range.clone(), per_group * MOST_GROUPS);
    (start..end)
        .step_by(most as usize)
        .map(move |first| first..end.min(first + most))
}
