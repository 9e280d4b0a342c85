//! The copies that show in a strip of the picture, which is a range of columns of squares from top
//! to bottom. Copies are visited from the nearest to the farthest. Clusters that nearer copies hide
//! are skipped.

use super::bounds::Projector;
use super::candidates::{Candidate, Candidates};
use super::cover::Cover;
use super::deal::TileCopy;
use super::outer::rows;
use super::{BLOCK, Batch, Item};
use std::ops::Range;

/// Number of clusters that are opened at once; copies are sorted after each such step.
const OPENED: usize = 16;

pub(super) struct Strip<'a> {
    projector: &'a Projector,
    batches: &'a [Batch<'a>],
    cover: Cover,
    /// The ends of each row of the current copy.
    rows: Vec<[f64; 2]>,
    /// The listed copies of each band, nearest first.
    pub listed: Vec<Vec<TileCopy>>,
    /// Batch and number of every copy that may show.
    pub copies: Vec<(u32, u32)>,
}

impl<'a> Strip<'a> {
    /// An empty strip of these columns, in a picture of this size in tiles.
    pub fn new(
        projector: &'a Projector,
        batches: &'a [Batch<'a>],
        columns: Range<u32>,
        [_, down]: [u32; 2],
    ) -> Self {
        Self {
            projector,
            batches,
            cover: Cover::new(columns, down, projector.margin),
            rows: Vec::new(),
            listed: vec![Vec::new(); down.div_ceil(BLOCK) as usize],
            copies: Vec::new(),
        }
    }

    /// Lists the visible part of all candidates.
    pub fn fill(&mut self, candidates: &Candidates) {
        let here = |c: &&Candidate| self.cover.meets(c.pixels);
        let here: Vec<&Candidate> = candidates.all.iter().filter(here).collect();
        let (mut waiting, mut ready) = (Vec::new(), Vec::new());
        for (n, opened) in (1..).zip(here.chunks(OPENED)) {
            for candidate in opened {
                let near = f32::from_bits(candidate.near);
                if candidate.may_be_hidden && self.cover.hides(candidate.pixels, near) {
                    continue;
                }
                let items = candidates.items(candidate).iter();
                waiting.extend(items.filter(|item| self.cover.meets(item.pixels)));
            }
            // Copies of later clusters may be nearer than the remaining ones.
            let limit = here.get(n * OPENED).map_or(u32::MAX, |next| next.near);
            ready.extend(waiting.extract_if(.., |item: &mut Item| item.near < limit));
            ready.sort_unstable();
            ready.drain(..).for_each(|item| self.add(&item));
        }
    }

    /// Lists the visible part of a copy and records what it hides. No earlier copy may be farther
    /// than it.
    pub fn add(&mut self, item: &Item) {
        let near = f32::from_bits(item.near);
        if !self.cover.is_open(item.pixels, near) {
            return;
        }
        let batch = &self.batches[item.batch as usize];
        let (_, placement) = batch.placements.at(item.rank);
        let axes = self.projector.axes(placement, batch.shape.axis);
        let [_, top, _, bottom] = item.pixels.map(u32::from);
        let known = batch
            .outer
            .filter(|_| item.near > 0)
            .is_some_and(|(outer, away)| {
                let margin = away + self.projector.margin(&axes, &batch.shape);
                rows(
                    outer,
                    &axes,
                    margin,
                    top..bottom + 1,
                    bottom - top,
                    &mut self.rows,
                )
            });
        let rows = known.then_some(&self.rows[..]);
        let mut shows = false;
        self.cover.open(item.pixels, rows, near, |[x, y], pixels| {
            shows = true;
            self.listed[(y / BLOCK) as usize].push(TileCopy {
                tile: x / BLOCK * (BLOCK * BLOCK) + y % BLOCK * BLOCK + x % BLOCK,
                batch: item.batch,
                copy: batch.first + item.copy,
                near: item.near,
                pixels,
            });
        });
        if !shows {
            return;
        }
        self.copies.push((item.batch, item.copy));
        if let Some(inner) = batch.inner.filter(|_| item.near > 0) {
            self.cover.add(&axes, inner, item.pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::View;
    use crate::plan::tiles::{Cylinder, Drawer, Placements, Visible};
    use crate::profile::Profile;
    use crate::scene::{Camera, Copies, Offset, Placement};
    use crate::solid::cache::Solid;
    use crate::solid::offset_surface::{OffsetSurface, Recipe};
    use crate::surface::FitOptions;
    use glam::{DQuat, DVec2, DVec3};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    /// Every copy of every batch, nearest first, without skipping clusters.
    fn fill_plainly(strip: &mut Strip, candidates: &Candidates) {
        let mut items = Vec::new();
        for (number, batch) in (0..).zip(candidates.batches) {
            let ranks = 0..batch.placements.len() as u32;
            items.extend(ranks.filter_map(|rank| candidates.item(number, rank)));
        }
        items.retain(|item: &Item| strip.cover.meets(item.pixels));
        items.sort_unstable();
        items.iter().for_each(|item| strip.add(item));
    }

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
    fn field(count: u32, seed: u32, size: f64, tall: f64) -> Copies {
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
        (0..count).map(of).collect()
    }

    /// The tiles equal those of all copies in turn, to the last word, wherever the eye is. Many
    /// clusters are never opened.
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
            .map(|(placements, surface)| {
                let batch = Batch {
                    placements: Placements::Many(placements),
                    first,
                    shape: Cylinder {
                        axis: DVec2::ZERO,
                        radius: 0.46,
                        low: 0.0,
                        high: 1.0,
                    },
                    inner: surface.inner(),
                    outer: surface.outer().map(|outer| (outer, 0.0)),
                    surface: Some(surface),
                    half_side: 0.5,
                    permits_lists: true,
                };
                first += placements.len() as u32;
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
            let candidates = Candidates::new(&projector, &batches);
            let closed = AtomicUsize::new(usize::MAX);
            let found = Visible::of(&candidates, |strip, candidates| {
                strip.fill(candidates);
                let count = candidates.all.iter().filter(|c| !c.is_opened()).count();
                closed.fetch_min(count, Relaxed);
            });
            let plain = Visible::of(&Candidates::new(&projector, &batches), fill_plainly);
            assert_eq!(found.copies(), plain.copies(), "{eye:?}");
            for drawer in [Drawer::Fragments, Drawer::Groups] {
                let [found, plain] =
                    [&found, &plain].map(|v| v.deal(drawer, &[0, 1, 0], &[true, false]));
                assert!(!plain.words.is_empty());
                assert!(found == plain, "{eye:?}");
            }
            passed_over += closed.into_inner();
        }
        assert!(passed_over > 100, "{passed_over}");
    }
}
