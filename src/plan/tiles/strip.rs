//! The copies that show in a strip of the picture, which is a range of columns of tiles from top to
//! bottom. Copies are visited from the nearest to the farthest.

use super::Batch;
use super::bounds::{Projector, ScreenBounds, first_pixel, last_pixel};
use super::cover::{Cover, within_rows};
use super::outer::rows;
use super::tile_writer::TileCopy;
use crate::plan::proxy::is_apart;
use std::ops::Range;

/// A copy that some pixel may show.
#[derive(Clone, Copy)]
pub(super) struct Item {
    bounds: ScreenBounds,
    batch: u32,
    /// Number of the instance.
    copy: u32,
    /// Rank in the order of the batch's clusters.
    rank: u32,
}

/// The copies of a cluster, in its rectangle of pixels.
pub(super) struct Opened {
    pub pixels: [u16; 4],
    pub items: Vec<Item>,
}

/// The index of no copy.
const NONE: u32 = u32::MAX;

/// A range of columns of tiles. Its vectors live from copy to copy, which saves their allocation.
pub(super) struct Strip<'a> {
    projector: &'a Projector,
    batches: &'a [Batch<'a>],
    cover: Cover,
    /// The ends of each row of the current copy.
    rows: Vec<[f64; 2]>,
    /// The pixels between these ends: first, end.
    spans: Vec<[i32; 2]>,
    /// The squares and pixels that may show it.
    open: Vec<([u32; 2], u64)>,
    /// Copies that may be farther than those of the next cluster.
    waiting: Vec<Item>,
    /// The listed copies of all tiles, each with the index of the next one of its tile, or [`NONE`].
    listed: Vec<(TileCopy, u32)>,
    /// Indices of the nearest and the farthest listed copy of each tile. One vector for all tiles
    /// takes half of the time of one for each tile.
    tiles: Vec<[u32; 2]>,
    /// Number of every instance that may show.
    pub copies: Vec<u32>,
    /// For each batch, true if rays begin outside of the bounding cylinder of each copy that may show.
    pub apart: Vec<bool>,
}

impl Item {
    /// The copy of this rank in a batch, if some pixel may show it.
    pub fn new(projector: &Projector, batches: &[Batch], batch: u32, rank: u32) -> Option<Self> {
        let of = &batches[batch as usize];
        let (copy, placement) = of.object.copy_at(rank);
        let bounds = projector.bounds(placement, &of.shape)?;
        let copy = of.first + copy;
        Some(Self {
            bounds,
            batch,
            copy,
            rank,
        })
    }

    /// Order of copies: by nearest depth, then by object and copy, wherever their instances are.
    /// Depths are not negative, so the order of their bits is theirs.
    fn key(&self) -> (u64, u32) {
        let near = u64::from(self.bounds.near.to_bits());
        (near << 32 | u64::from(self.batch), self.copy)
    }
}

impl<'a> Strip<'a> {
    /// An empty strip of these columns, in a picture of `down` rows of tiles.
    pub fn new(
        projector: &'a Projector,
        batches: &'a [Batch<'a>],
        columns: Range<u32>,
        down: u32,
    ) -> Self {
        Self {
            projector,
            batches,
            listed: Vec::new(),
            tiles: vec![[NONE; 2]; columns.len() * down as usize],
            cover: Cover::new(columns, down, projector.margin),
            rows: Vec::new(),
            spans: Vec::new(),
            open: Vec::new(),
            waiting: Vec::new(),
            copies: Vec::new(),
            apart: vec![true; batches.len()],
        }
    }

    /// The copies that a tile may show, nearest first.
    pub fn tile(&self, x: u32, y: u32) -> impl Iterator<Item = TileCopy> {
        let listed = |n: u32| self.listed.get(n as usize);
        let first = listed(self.tiles[self.cover.at(x, y)][0]);
        std::iter::successors(first, move |(_, next)| listed(*next)).map(|(copy, _)| *copy)
    }

    /// True unless all copies within these bounds are beside the strip or hidden by listed ones.
    pub fn may_show(&self, bounds: &ScreenBounds) -> bool {
        self.cover.meets(bounds.pixels) && !self.cover.hides(bounds.pixels, bounds.near)
    }

    /// Lists the visible part of waiting and opened copies nearer than `limit`, the bits of a depth.
    /// The others wait.
    pub fn fill(&mut self, opened: &[Opened], limit: u32) {
        let here = opened.iter().filter(|of| self.cover.meets(of.pixels));
        let items = here.flat_map(|of| &of.items);
        let items = items.filter(|item| self.cover.meets(item.bounds.pixels));
        self.waiting.extend(items);
        let nearer = |item: &mut Item| item.bounds.near.to_bits() < limit;
        let mut ready: Vec<Item> = self.waiting.extract_if(.., nearer).collect();
        ready.sort_unstable_by_key(Item::key);
        ready.iter().for_each(|item| self.add(item));
    }

    /// Lists the visible part of a copy and records what it hides. No earlier copy may be farther
    /// than it.
    fn add(&mut self, item: &Item) {
        let ScreenBounds { pixels, near } = item.bounds;
        self.cover.open(pixels, near, &mut self.open);
        if self.open.is_empty() {
            return;
        }
        let batch = &self.batches[item.batch as usize];
        let (_, placement) = batch.object.copy_at(item.rank);
        let axes = self.projector.axes(placement, batch.shape.axis);
        let [_, top, _, bottom] = pixels.map(u32::from);
        let in_front = near > 0.0;
        let outer = batch.outer.filter(|_| in_front);
        let known = outer.is_some_and(|(outer, away)| {
            let margin = away + self.projector.margin(&axes, &batch.shape);
            let within = top..bottom + 1;
            rows(outer, &axes, margin, within, bottom - top, &mut self.rows)
        });
        if known {
            let span =
                |&[low, high]: &[f64; 2]| [first_pixel(low), last_pixel(high).saturating_add(1)];
            self.spans.clear();
            self.spans.extend(self.rows.iter().map(span));
        }
        let mut shows = false;
        for &([x, y], mut pixels) in &self.open {
            if known {
                pixels &= within_rows([x, y], &self.spans, top);
            }
            if pixels != 0 {
                shows = true;
                let number = self.listed.len() as u32;
                let [first, last] = &mut self.tiles[self.cover.at(x, y)];
                match self.listed.get_mut(*last as usize) {
                    Some((_, next)) => *next = number,
                    None => *first = number,
                }
                *last = number;
                let copy = TileCopy {
                    batch: item.batch,
                    copy: item.copy,
                    near,
                    pixels,
                };
                self.listed.push((copy, NONE));
            }
        }
        if !shows {
            return;
        }
        self.copies.push(item.copy);
        if let Some(surface) = batch.surface {
            let reach = self.projector.reach(&axes);
            self.apart[item.batch as usize] &= is_apart(surface, axes.eye, reach);
        }
        // The near plane may cut what hides others.
        let is_whole = f64::from(near) > self.projector.start;
        if let Some(inner) = batch.inner.filter(|_| is_whole) {
            self.cover.add(&axes, inner, pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::View;
    use crate::plan::tiles::{Cylinder, FIRST_ROUND, Visible};
    use crate::profile::Profile;
    use crate::scene::{Camera, Object, Offset, Placement};
    use crate::solid::cache::Solid;
    use crate::solid::offset_surface::{OffsetSurface, Recipe};
    use crate::surface::FitOptions;
    use glam::{DQuat, DVec2, DVec3};
    use std::sync::Arc;

    fn surface(points: &[[f64; 2]]) -> Arc<OffsetSurface> {
        let profile = Arc::new(Profile::polygon(points, 0.5).unwrap());
        let solid = Arc::new(Solid::new(&profile));
        let FitOptions { tolerance } = FitOptions::default();
        let exact = Recipe::Patches {
            level: 0,
            tolerance,
        };
        solid.surface(&Offset::default(), exact).unwrap()
    }

    /// A field of 20 x 20 world units with copies of about this size. `tall`: ratio of height to
    /// width.
    fn field(count: u32, seed: u32, size: f64, tall: f64) -> Object {
        let of = |k: u32| {
            let part = |step: f64| (f64::from(k + 999 * seed) * step).fract();
            let [x, y] = [part(0.754_877_666), part(0.569_840_291)];
            let scale = size * (0.5 + part(0.618_034));
            Placement {
                position: DVec3::new(20.0 * x - 10.0, 20.0 * y - 10.0, 0.3 * part(0.3247)),
                rotation: DQuat::from_rotation_z(6.0 * part(0.414_214))
                    * DQuat::from_rotation_x(0.5 * part(0.8191)),
                scale: DVec3::new(scale, scale, tall * scale),
            }
        };
        let profile = Profile::polygon(&[[0.0, 0.0], [0.5, 0.5], [0.0, 1.0]], 0.5).unwrap();
        let mut object = Object::new("field", Arc::new(profile));
        object.instances = (0..count).map(of).collect();
        object
    }

    /// The tiles equal those of one round, in which all clusters are opened, to the last word, wherever
    /// the eye is. In several rounds many clusters are never opened.
    #[test]
    fn clusters_that_are_passed_over_change_nothing() {
        let column = surface(&[[0.0, 0.0], [0.4, 0.0], [0.4, 1.0], [0.0, 1.0]]);
        let spindle = surface(&[[0.0, 0.0], [0.45, 0.5], [0.0, 1.0]]);
        let fields = [
            (field(9000, 1, 0.35, 1.0), &column),
            (field(700, 2, 0.2, 40.0), &spindle),
            (field(40, 3, 3.0, 0.7), &column),
        ];
        let mut first = 0;
        let batches: Vec<Batch> = fields
            .iter()
            .map(|(object, surface)| {
                let batch = Batch {
                    object,
                    first,
                    shape: Cylinder {
                        axis: DVec2::ZERO,
                        radius: 0.46,
                        low: 0.0,
                        high: 1.0,
                    },
                    inner: surface.cylinders().map(|[inner, _]| inner),
                    outer: surface.cylinders().map(|[_, outer]| (outer, 0.0)),
                    surface: Some(surface),
                    permits_lists: true,
                };
                first += object.instances.len() as u32;
                batch
            })
            .collect();
        let mut passed_over = 0;
        for (eye, target) in [
            ([-16.0, -3.0, 2.0], [0.0, 0.0, 0.0]),
            ([-9.0, 0.5, 0.4], [0.0, 0.2, 0.3]),
            ([0.2, 0.1, 0.5], [9.0, 3.0, 0.2]),
            ([-30.0, -90.0, 20.0], [0.0, 0.0, 0.0]),
            ([0.0, 0.0, 25.0], [0.0, 0.1, 0.0]),
        ] {
            let camera = Camera::new(DVec3::from_array(eye), DVec3::from_array(target));
            let view = View::from_camera(&camera, (333, 210), [0.1, 1e3]).unwrap();
            let projector = Projector::new(&view, 0.0, 0.0);
            let (found, opened) = Visible::in_rounds(&projector, &batches, FIRST_ROUND);
            let (plain, all) = Visible::in_rounds(&projector, &batches, usize::MAX);
            assert_eq!(found.copies(), plain.copies(), "{eye:?}");
            let [found, plain] = [&found, &plain].map(|v| v.write(None, &[0, 1, 0], 2));
            assert!(!plain.words.is_empty());
            assert!(found == plain, "{eye:?}");
            passed_over += all - opened;
        }
        assert!(passed_over > 100, "{passed_over}");
    }
}
