//! Steps of walks. In fragments each layer of a scene has a draw of points over the rows of the
//! picture that may show it.
//!
//! In compute each layer has a rectangle of tiles. Lists of what the tiles may show come first, an
//! invocation a tile; then the pixels of tiles that show something. Few large solids have lists of
//! patches too, for tiles of one copy. A lone solid needs no lists of copies: GPUs cull its
//! patches in each work group, and CPUs make lists of patches for a large one. Otherwise all tiles
//! of the rectangle walk.

use super::open_pixels::OpenPixels;
use super::path::{LIST_LENGTHS, MOST_PROXIES, is_flat};
use super::projector::{Projector, Rectangle, TILE_PIXELS};
use super::walk::{Layer, Walks};
use super::{Call, Conditions, FramePlan, PlanObject, Step, View, projector, proxy};
use crate::shader::generated::{
    CULLED_PIXELS, GROUP_PIXELS, MOST_GROUPS, QUAD_BITS, TILE_BINS, TILE_WALK_VECTORS, WALK_BIN,
    WALKS_LISTED, WALKS_OPEN,
};
use crate::shader::{Drawn, Kind, Pushed, Variant};
use crate::solid::offset_surface::Part;
use std::ops::Range;
use std::sync::Arc;

/// Blocks of tiles for which one dispatch makes lists. No bin has more tiles than a dispatch has work
/// groups.
const MOST_BLOCKS: u32 = MOST_GROUPS / TILE_PIXELS;

/// How the tiles of a layer are found.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lists {
    /// All tiles of its rectangle are drawn.
    None,
    /// So are all squares, whose work groups cull the patches of its only copy.
    Culled,
    Copies,
    /// Lists of copies, and of patches where there is one copy.
    Patches,
}

impl Lists {
    /// Heads of bins for each dispatch.
    const fn heads(self) -> u32 {
        match self {
            Self::None | Self::Culled => 0,
            Self::Copies => 1,
            Self::Patches => TILE_BINS,
        }
    }

    /// Vectors of the bins for each tile, walks of tiles among them.
    const fn vectors(self) -> u32 {
        match self {
            Self::None | Self::Culled => 0,
            Self::Copies => TILE_WALK_VECTORS,
            Self::Patches => TILE_WALK_VECTORS + WALK_BIN,
        }
    }
}

struct Shown<'a> {
    layer: &'a Layer,
    variant: Variant,
    pixels: Rectangle,
    lists: Lists,
}

impl Shown<'_> {
    /// Squares of so many pixels across and down that hold its rectangle.
    fn squares(&self, side: u32) -> [u32; 2] {
        squares(self.pixels, side)
    }

    fn blocks(&self) -> u32 {
        let [across, down] = self
            .squares(GROUP_PIXELS)
            .map(|tiles| tiles.div_ceil(GROUP_PIXELS));
        across * down
    }

    fn chunks(&self) -> u32 {
        self.blocks().div_ceil(MOST_BLOCKS)
    }
}

/// Squares of a grid, `side` pixels wide, across and down that hold a rectangle of pixels.
fn squares([left, top, right, bottom]: Rectangle, side: u32) -> [u32; 2] {
    [[left, right], [top, bottom]].map(|[first, last]| last / side - first / side + 1)
}

fn tiles(pixels: Rectangle) -> u64 {
    let [across, down] = squares(pixels, GROUP_PIXELS).map(u64::from);
    across * down
}

impl FramePlan {
    /// The walks, after all else. `open`: the pixels that compute draws; all if none.
    pub(super) fn add_walks(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        variants: &[Variant],
        (walks, with): (&Walks, &Conditions),
        open: Option<&OpenPixels>,
    ) {
        let projector = projector(view, objects, with);
        if let Some([left, top, right, bottom]) = projector.picture() {
            self.picture = [left, top, right + 1 - left, bottom + 1 - top];
        }
        // What is drawn by one walk needs no depths.
        let alone = walks.layers.len() == 1 && !with.host_depths;
        let of_layer = |layer: &Layer| {
            let apart = |n: &u32| {
                let of = &objects[*n as usize];
                let apart = |s: &Arc<_>| proxy::is_seen_from_outside(of.object, s, view);
                of.surface().is_some_and(apart)
            };
            // Few copies cost the host less than a test of each ray.
            let few = layer.copies(objects) <= MOST_PROXIES;
            let outside = few && layer.objects.iter().all(apart);
            for &n in &layer.objects {
                self.parts[n as usize][Part::Tables as usize] = true;
                self.outside[n as usize] = outside;
            }
            let mut variant = variants[layer.objects[0] as usize];
            if layer.objects.len() > 1 {
                variant.speciality.drawn = Drawn::Objects;
            }
            variant.speciality.depths &= !alone;
            variant.seen_from_outside(outside)
        };
        let variants: Vec<Variant> = walks.layers.iter().map(of_layer).collect();
        if with.compute {
            let layers = (walks, variants.as_slice());
            return self.add_walk_tiles((view, &projector), objects, layers, (with, open));
        }
        for (layer, variant) in walks.layers.iter().zip(variants) {
            let Some((pixels, _)) = covered(&projector, objects, walks, layer) else {
                continue;
            };
            self.steps.push(Step {
                phase: 0,
                variant: variant.of_kind(Kind::Walk),
                kind: Kind::Walk,
                object: layer.objects[0],
                call: Call::Walk(points(self.picture, pixels), layer.root),
            });
        }
    }

    /// The dispatches of all walks. `variants`: one for each layer. `open`: the pixels that are
    /// drawn; all if none.
    fn add_walk_tiles(
        &mut self,
        (view, projector): (&View, &Projector),
        objects: &[PlanObject],
        (walks, variants): (&Walks, &[Variant]),
        (with, open): (&Conditions, Option<&OpenPixels>),
    ) {
        let layers = walks.layers.iter().zip(variants);
        let mut shown: Vec<Shown> = layers
            .filter_map(|(layer, &variant)| {
                let (pixels, covered) = covered(projector, objects, walks, layer)?;
                let lists = match open {
                    Some(_) => Lists::None,
                    None => self.lists_of(view, objects, layer, (covered, with)),
                };
                Some(Shown {
                    layer,
                    variant,
                    pixels,
                    lists,
                })
            })
            .collect();
        let vectors =
            |s: &Shown| u64::from(s.lists.vectors()) * u64::from(s.blocks() * TILE_PIXELS);
        if 16 * shown.iter().map(vectors).sum::<u64>() > with.room() {
            let listed = shown.iter_mut().filter(|s| s.lists.heads() > 0);
            listed.for_each(|s| s.lists = Lists::None);
        }
        self.bin_heads = shown.iter().map(|s| s.chunks() * s.lists.heads()).sum();
        self.bin_vectors = self.bin_heads;
        let (mut head, mut draws) = (0, Vec::new());
        // Each layer compares its depths with those of the layers before it.
        for (phase, shown) in (1..).zip(&shown) {
            let object = shown.layer.objects[0];
            let of = &objects[object as usize];
            let side = match shown.lists {
                Lists::Culled => CULLED_PIXELS,
                _ => GROUP_PIXELS,
            };
            let [left, top] = [0, 1].map(|axis| shown.pixels[axis] / side * side);
            let [across, down] = shown.squares(side);
            let pushed = Pushed {
                corner: left | top << QUAD_BITS,
                size: across | down << 16,
                root: shown.layer.root,
                object: of.number,
                instance: of.first_instance,
                ..Pushed::default()
            };
            let beginning = |first| Pushed { first, ..pushed };
            let step = |phase, kind, call| Step {
                phase,
                variant: shown.variant.of_kind(kind),
                kind,
                object,
                call,
            };
            if let Some(open) = open {
                let from = self.open_pixels.len() as u32;
                open.add_within(shown.pixels, &mut self.open_pixels);
                let all = from..self.open_pixels.len() as u32;
                for pixels in chunks(all, MOST_GROUPS * TILE_PIXELS) {
                    let groups = pixels.len() as u32 / TILE_PIXELS;
                    let pushed = Pushed {
                        walks: WALKS_OPEN,
                        ..beginning(pixels.start)
                    };
                    let call = Call::Groups(groups, pushed);
                    draws.push(step(phase, Kind::WalkTiles, call));
                }
                continue;
            }
            if shown.lists.heads() == 0 {
                let kind = match shown.lists {
                    Lists::Culled => Kind::CulledTiles,
                    _ => Kind::WalkTiles,
                };
                for tiles in chunks(0..across * down, MOST_GROUPS) {
                    let call = Call::Groups(tiles.len() as u32, beginning(tiles.start));
                    draws.push(step(phase, kind, call));
                }
                continue;
            }
            let makes = match shown.lists {
                Lists::Patches => Kind::TileLists,
                _ => Kind::WalkLists,
            };
            for blocks in chunks(0..shown.blocks(), MOST_BLOCKS) {
                let room = blocks.len() as u32 * TILE_PIXELS;
                let lists = Pushed {
                    heads: head,
                    tiles: self.bin_vectors,
                    room,
                    ..beginning(blocks.start)
                };
                let call = Call::Groups(blocks.len() as u32, lists);
                self.steps.push(step(0, makes, call));
                if shown.lists == Lists::Patches {
                    for length in LIST_LENGTHS {
                        let pushed = Pushed {
                            tiles: self.bin_vectors,
                            ..pushed
                        };
                        let call = Call::Indirect(head, pushed);
                        draws.push(step(phase, Kind::TilePatches(length), call));
                        self.bin_vectors += room;
                        head += 1;
                    }
                }
                let pushed = Pushed {
                    tiles: self.bin_vectors,
                    walks: WALKS_LISTED,
                    ..pushed
                };
                draws.push(step(phase, Kind::WalkTiles, Call::Indirect(head, pushed)));
                self.bin_vectors += TILE_WALK_VECTORS * room;
                head += 1;
            }
        }
        self.steps.extend(draws);
    }

    /// How the tiles of a layer are found, of which the copies cover so many tiles. Marks the tables
    /// of patches that they read.
    fn lists_of(
        &mut self,
        view: &View,
        objects: &[PlanObject],
        layer: &Layer,
        (tiles, with): (u64, &Conditions),
    ) -> Lists {
        let of_layer = || layer.objects.iter().map(|&n| &objects[n as usize]);
        let permits = |of: &PlanObject| {
            let apart = |surface: &Arc<_>| proxy::is_apart_from_all(of.object, surface, view);
            with.permits_lists(of) && of.surface().is_some_and(apart)
        };
        let copies = layer.copies(objects);
        let may_list = copies <= MOST_PROXIES && of_layer().all(permits);
        let gains = || {
            let patches = of_layer().filter_map(PlanObject::surface);
            let patches: u64 = patches.map(|surface| surface.patches() as u64).sum();
            let (each, tiles) = (
                patches / layer.objects.len() as u64,
                view.tiles_of_all_rows(tiles),
            );
            with.gains_by_lists(tiles, each, || of_layer().any(|of| is_flat(of.object)))
        };
        let lists = match copies == 1 {
            true if may_list && with.has_wide_groups() => Lists::Culled,
            _ if may_list && gains() => Lists::Patches,
            true => return Lists::None,
            false => return Lists::Copies,
        };
        for &n in &layer.objects {
            self.parts[n as usize][Part::Patches as usize] = true;
        }
        lists
    }
}

/// The pixels that may show a copy of a layer, if any, and the number of tiles that its copies cover.
/// Of many copies the box of all is taken.
fn covered(
    projector: &Projector,
    objects: &[PlanObject],
    walks: &Walks,
    layer: &Layer,
) -> Option<(Rectangle, u64)> {
    if layer.copies(objects) > MOST_PROXIES {
        let pixels = projector.box_bounds(walks.bounds(layer))?;
        return Some((pixels, tiles(pixels)));
    }
    let of_layer = layer.objects.iter().map(|&n| &objects[n as usize]);
    let copies =
        of_layer.flat_map(|of| of.object.placements().iter().map(|copy| (copy, &of.shape)));
    let seen = copies.filter_map(|(copy, shape)| projector.bounds(copy, shape));
    seen.map(|pixels| (pixels, tiles(pixels))).reduce(
        |([a, b, c, d], tiles), ([left, top, right, bottom], more)| {
            let pixels = [a.min(left), b.min(top), c.max(right), d.max(bottom)];
            (pixels, tiles + more)
        },
    )
}

/// The points over the rows of a picture that have pixels of a rectangle, as in `walk.vert`.
fn points([_, begin, width, height]: [u32; 4], [_, top, _, bottom]: Rectangle) -> Range<u32> {
    let side = match width.min(height) {
        ..GROUP_PIXELS => 1,
        _ => GROUP_PIXELS,
    };
    let across = width.div_ceil(side);
    across * ((top - begin) / side)..across * ((bottom - begin) / side + 1)
}

fn chunks(range: Range<u32>, most: u32) -> impl Iterator<Item = Range<u32>> {
    let Range { start, end } = range;
    (start..end)
        .step_by(most as usize)
        .map(move |first| first..end.min(first.saturating_add(most)))
}
