//! Which copies each square of the screen shows, nearest first: what objects of several copies are
//! drawn from, in both stages.
//!
//! 1. Clusters of copies that stand near each other are found in the picture ([`seen_cluster`]) and
//!    sorted, the nearest first ([`candidates`]).
//! 2. From the nearest to the farthest they are opened, but for those that are hidden as a whole
//!    ([`strip`]): of each copy a rectangle of pixels and the nearest depth are found ([`seen`]);
//!    copies that no pixel's ray can meet are left out, and the others sorted, the nearest first.
//! 3. In this order they are listed in the squares in which they may show ([`outer`]). What a copy
//!    is sure to hide is marked there ([`cover`]), and later copies are not listed for pixels in
//!    which all of them lies behind it.
//! 4. What is listed is dealt out to bins ([`lists`]).
//!
//! A copy is left out only where its solid is proven not to be, or solids that it lies behind are
//! proven to be: pictures are those of unculled copies to the last bit, or but for roundings where
//! patches are listed for bins of one copy. Nothing is taken from an earlier frame. Strips of the
//! picture are filled in parallel, columns of squares from top to bottom: on a field they are all
//! alike, where rows near the horizon hold most copies. Bins are made in parallel in bands of rows.

mod candidates;
mod cover;
mod inner;
mod lists;
mod outer;
mod rectangle;
mod seen;
mod seen_cluster;
mod squares;
mod strip;

pub(crate) use inner::Inner;
pub(crate) use outer::Outer;
pub(crate) use rectangle::{Rectangle, rectangle};
pub(crate) use seen::{Cylinder, Forms};

use super::offset_surface::OffsetSurface;
use super::plan::list_words;
use super::view::View;
use crate::scene::Copies;
use candidates::{Candidates, Told};
use cover::{SIDE, within};
use lists::{BandLists, Visitor};
use rayon::prelude::*;
use std::ops::Range;
use strip::Strip;

/// Copies of one object.
pub(crate) struct Batch<'a> {
    pub placements: &'a Copies,
    /// The number of the first among all instances.
    pub first: u32,
    pub shape: Cylinder,
    /// What each is sure to hide; none where that is not known.
    pub inner: Option<&'a Inner>,
    /// Where each can show; none where its cylinder alone is known.
    pub outer: Option<&'a Outer>,
    /// The surface of solids of which the box cuts nothing.
    pub whole: Option<&'a OffsetSurface>,
    /// Half of the box's side.
    pub half_side: f64,
    /// Whether patches may be listed for bins of one copy.
    pub lists: bool,
}

/// What a batch draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shown {
    /// Its bins: numbers of four words each.
    pub range: Range<u32>,
    /// In a pass: its squares of one copy each.
    pub spots: Range<u32>,
    /// In compute: bins of one copy each, of which no two share pixels. They are drawn before the
    /// others.
    pub alone: Range<u32>,
    /// The word where the lists of their patches begin.
    pub lists: u32,
    /// Its copies that may show, by their place in the batch.
    pub copies: Vec<u32>,
    /// Whether the eye is outside of all of them, and the box cuts none.
    pub outside: bool,
    /// Whether what a square's rays may meet can besides be told from the middle ray.
    pub beams: bool,
}

/// Bins of all batches and their lists, as the shader's one buffer of words holds them
/// (`bins.glsl`).
#[derive(Clone, Debug, Default)]
pub(crate) struct Bins {
    pub words: Vec<u32>,
    /// Of each batch.
    pub shown: Vec<Shown>,
}

/// A copy that some pixel may show. They are sorted by these values, in this order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Item {
    /// Bits of the nearest depth: not negative, so they order as it does.
    near: u32,
    batch: u32,
    copy: u32,
    pixels: [u16; 4],
    /// Among the batch's clusters.
    place: u32,
}

/// What one batch has in one band.
struct Part {
    lists: BandLists,
    /// Copies that may show: all of the batch's are in the first band's.
    copies: Vec<u32>,
}

impl Bins {
    /// What of these batches a view of perspective shows. `fragments`: they are drawn for bins, by
    /// squares; else work groups. `room`: most words that lists of patches may take in all.
    pub fn new(view: &View, batches: &[Batch], fragments: bool, room: u64) -> Self {
        let forms = Forms::new(view);
        let candidates = Candidates::new(&forms, batches);
        Self::of(candidates, fragments, room, |strip, candidates| {
            strip.fill(candidates);
        })
    }

    /// What `fill` lists in the strips of the picture.
    fn of(
        candidates: Candidates,
        fragments: bool,
        room: u64,
        fill: impl Fn(&mut Strip, &Candidates) + Sync,
    ) -> Self {
        let (forms, batches) = (candidates.forms, candidates.batches);
        let squares = |pixels: f64| ((pixels + 0.5) / f64::from(SIDE)).ceil() as u32;
        let (across, down) = (squares(forms.high.x), squares(forms.high.y));
        // Several for each thread, as some take longer.
        let of_all = |all: u32| all.div_ceil(4 * rayon::current_num_threads() as u32);
        let (strip, band) = (of_all(across).max(8), of_all(down).max(2));
        let starts: Vec<u32> = (0..across).step_by(strip as usize).collect();
        let filled = |&left: &u32| {
            let columns = left..(left + strip).min(across);
            let mut strip = Strip::new(forms, batches, columns, [across, down], band);
            fill(&mut strip, &candidates);
            strip
        };
        let strips: Vec<Strip> = starts.par_iter().map(filled).collect();
        let found: Vec<Told> = candidates.found().collect();
        let visitor = |(batch, told): (&Batch, &Told)| match (fragments, told.beams && batch.lists)
        {
            (true, _) => Visitor::Fragments,
            (false, false) => Visitor::Groups,
            (false, true) => Visitor::GroupsAndLists,
        };
        let visitors: Vec<Visitor> = batches.iter().zip(&found).map(visitor).collect();
        let picture = forms.picture();
        let inside = |square: [u32; 2]| within(square, picture);
        let dealt = |visitors: &[Visitor]| -> Vec<Vec<Part>> {
            let of = |number: u32| {
                let top = number * band;
                let squares = across * band.min(down - top);
                let corner = |square: u32| [square % across, square / across + top];
                let part = |batch: usize| {
                    let listed = strips.iter().map(|s| &s.listed[number as usize][batch][..]);
                    let listed = listed.collect::<Vec<_>>().concat();
                    let copies = strips.iter().filter(|_| number == 0);
                    Part {
                        lists: BandLists::new(&listed, squares, visitors[batch], corner, inside),
                        copies: copies.flat_map(|s| &s.copies[batch]).copied().collect(),
                    }
                };
                (0..batches.len()).into_par_iter().map(part).collect()
            };
            (0..down.div_ceil(band)).into_par_iter().map(of).collect()
        };
        let mut parts = dealt(&visitors);
        let alone = parts.iter().flatten().map(|part| part.lists.alone.len());
        if u64::from(list_words(alone.sum::<usize>() as u32)) > room {
            parts = dealt(&vec![Visitor::Groups; batches.len()]);
        }
        Self::joined(&parts, batches, &found)
    }

    fn joined(parts: &[Vec<Part>], batches: &[Batch], told: &[Told]) -> Self {
        let mut bins: Vec<[u32; 4]> = Vec::new();
        let mut spots: Vec<[u32; 4]> = Vec::new();
        let mut lists = 0;
        let mut shown = Vec::with_capacity(batches.len());
        for (number, batch) in batches.iter().enumerate() {
            let first = bins.len() as u32;
            let mut shows = vec![false; batch.placements.len()];
            let own = || parts.iter().map(|band| &band[number]);
            let mut put = |all: for<'b> fn(&'b BandLists) -> &'b [[u32; 4]]| {
                let mut lists = lists;
                for part in own() {
                    bins.extend(all(&part.lists).iter().map(|[corner, list, count, near]| {
                        [*corner, list + lists as u32, *count, *near]
                    }));
                    lists += part.lists.words.len();
                }
                bins.len() as u32
            };
            let alone = put(|lists| &lists.alone);
            let end = put(|lists| &lists.bins);
            let first_spot = spots.len() as u32;
            for part in own() {
                spots.extend(&part.lists.spots);
                lists += part.lists.words.len();
                for &copy in &part.copies {
                    shows[copy as usize] = true;
                }
            }
            let copies = (0u32..).zip(&shows).filter(|(_, shows)| **shows);
            shown.push(Shown {
                alone: first..alone,
                range: alone..end,
                spots: first_spot..spots.len() as u32,
                lists: 0,
                copies: copies.map(|(copy, _)| copy).collect(),
                outside: told[number].outside,
                beams: told[number].beams,
            });
        }
        // Behind all bins.
        let begin = bins.len() as u32;
        for one in &mut shown {
            one.spots = begin + one.spots.start..begin + one.spots.end;
        }
        let behind = 4 * (bins.len() + spots.len()) as u32;
        for bin in &mut bins {
            bin[1] += behind;
        }
        let mut words = Vec::with_capacity(behind as usize + lists);
        words.extend(bins.as_flattened());
        words.extend(spots.as_flattened());
        for number in 0..batches.len() {
            for band in parts {
                words.extend(&band[number].lists.words);
            }
        }
        Self { words, shown }
    }
}
