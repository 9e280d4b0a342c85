//! What shows in a strip of the picture, some columns of squares from top to bottom: copies are met
//! from the nearest to the farthest, and clusters that nearer copies hide are passed over.

use super::candidates::{Candidate, Candidates};
use super::cover::Cover;
use super::lists::Listed;
use super::seen::Forms;
use super::{Batch, Item};
use std::ops::Range;

/// So many clusters are opened at once: each time copies are sorted.
const OPENED: usize = 16;

pub(super) struct Strip<'a> {
    forms: &'a Forms,
    batches: &'a [Batch<'a>],
    cover: Cover,
    /// Squares across the picture.
    across: u32,
    /// Rows of squares in a band.
    band: u32,
    /// The ends of what shows in each row of the copy that is looked at.
    rows: Vec<[f64; 2]>,
    /// Of each band and batch, the nearest copy first; squares are counted from the band's first.
    pub listed: Vec<Vec<Vec<Listed>>>,
    /// Of each batch.
    pub copies: Vec<Vec<u32>>,
}

impl<'a> Strip<'a> {
    /// Of these columns of a picture of so many squares.
    pub fn new(
        forms: &'a Forms,
        batches: &'a [Batch<'a>],
        columns: Range<u32>,
        [across, down]: [u32; 2],
        band: u32,
    ) -> Self {
        Self {
            forms,
            batches,
            cover: Cover::new(columns, down),
            across,
            band,
            rows: Vec::new(),
            listed: vec![vec![Vec::new(); batches.len()]; down.div_ceil(band) as usize],
            copies: vec![Vec::new(); batches.len()],
        }
    }

    /// Lists what shows of all candidates.
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
            // Those of later clusters may be nearer than the others.
            let limit = here.get(n * OPENED).map_or(u32::MAX, |next| next.near);
            ready.extend(waiting.extract_if(.., |item: &mut Item| item.near < limit));
            ready.sort_unstable();
            ready.drain(..).for_each(|item| self.add(&item));
        }
    }

    /// Lists what shows of a copy that is not nearer than those before, and notes what it hides.
    pub fn add(&mut self, item: &Item) {
        let near = f32::from_bits(item.near);
        if !self.cover.is_open(item.pixels, near) {
            return;
        }
        let number = item.batch as usize;
        let batch = &self.batches[number];
        let (_, placement) = batch.placements.clusters().at(item.place);
        let spread = self.forms.spread(placement, batch.shape.axis);
        let [_, top, _, bottom] = item.pixels.map(u32::from);
        let known = batch.outer.filter(|_| item.near > 0).is_some_and(|outer| {
            let margin = self.forms.margin(&spread, &batch.shape);
            outer.rows(
                &spread,
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
            self.listed[(y / self.band) as usize][number].push(Listed {
                square: y % self.band * self.across + x,
                copy: batch.first + item.copy,
                near: item.near,
                pixels,
            });
        });
        if !shows {
            return;
        }
        self.copies[number].push(item.copy);
        if let Some(inner) = batch.inner.filter(|_| item.near > 0) {
            self.cover.add(&spread, inner, item.pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::gpu::bins::{Bins, Cylinder};
    use crate::gpu::offset_surface::OffsetSurface;
    use crate::gpu::solid::SolidCache;
    use crate::gpu::view::View;
    use crate::profile::Profile;
    use crate::scene::{Camera, Copies, Growth, Offset, Placement};
    use glam::{DQuat, DVec2, DVec3};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    /// Every copy of every batch, the nearest first, and no cluster passed over.
    fn fill_plainly(strip: &mut Strip, candidates: &Candidates) {
        let mut items = Vec::new();
        for (number, batch) in (0..).zip(candidates.batches) {
            let places = 0..batch.placements.len() as u32;
            items.extend(places.filter_map(|place| candidates.item(number, place)));
        }
        items.retain(|item: &Item| strip.cover.meets(item.pixels));
        items.sort_unstable();
        items.iter().for_each(|item| strip.add(item));
    }

    fn surface(points: &[[f64; 2]]) -> Arc<OffsetSurface> {
        let profile = Arc::new(Profile::polygon(points, 0.5).unwrap());
        let solid = SolidCache::default().get(&profile);
        let offset = Offset::default();
        solid.patches(&offset, &Growth::default(), 0).unwrap()
    }

    /// A field of 20 x 20 world units, of copies of about this size; `tall`: how much higher than
    /// wide.
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

    /// Bins are those of all copies in turn, to the last word, wherever the eye is; and of many
    /// clusters no copy is looked at.
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
                    placements,
                    first,
                    shape: Cylinder {
                        axis: DVec2::ZERO,
                        radius: 0.46,
                        low: 0.0,
                        high: 1.0,
                    },
                    inner: surface.inner(),
                    outer: surface.outer(),
                    whole: Some(surface),
                    half_side: 0.5,
                    lists: true,
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
            let forms = Forms::new(&view);
            for fragments in [false, true] {
                let bins = |fill: &(dyn Fn(&mut Strip, &Candidates) + Sync)| {
                    let candidates = Candidates::new(&forms, &batches);
                    Bins::of(candidates, fragments, 1 << 20, fill)
                };
                let closed = AtomicUsize::new(usize::MAX);
                let found = bins(&|strip, candidates| {
                    strip.fill(candidates);
                    let count = candidates.all.iter().filter(|c| !c.is_opened()).count();
                    closed.fetch_min(count, Relaxed);
                });
                let plain = bins(&fill_plainly);
                assert!(!plain.words.is_empty());
                assert_eq!(found.shown, plain.shown, "{eye:?}");
                assert!(found.words == plain.words, "{eye:?}");
                passed_over += closed.into_inner();
            }
        }
        assert!(passed_over > 100, "{passed_over}");
    }
}
