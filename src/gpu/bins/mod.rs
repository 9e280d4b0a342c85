//! Which copies each square of the screen shows, nearest first: what objects of several copies are
//! drawn from, in both stages.
//!
//! 1. Every copy's rectangle of pixels and nearest depth are found ([`seen`]); copies that no
//!    pixel's ray can meet are left out.
//! 2. Copies of all objects are sorted, the nearest first.
//! 3. In this order they are listed in the squares in which they may show ([`outer`]). What a copy
//!    is sure to hide is marked there ([`cover`]), and later copies are not listed for pixels in
//!    which all of them lies behind it.
//!
//! A copy is left out only where its solid is proven not to be, or solids that it lies behind are
//! proven to be: pictures are those of unculled copies to the last bit, or but for roundings where
//! patches are listed for bins of one copy. Nothing is taken from an earlier frame. Bands of the screen are worked on in parallel.

mod cover;
mod inner;
mod lists;
mod outer;
mod rectangle;
mod seen;
mod squares;

pub(crate) use inner::Inner;
pub(crate) use outer::Outer;
pub(crate) use rectangle::{Rectangle, rectangle};
pub(crate) use seen::{Cylinder, Forms};

use super::hulls::{is_apart, is_lopsided};
use super::offset_surface::OffsetSurface;
use super::plan::list_words;
use super::view::View;
use crate::scene::Placement;
use cover::{Cover, SIDE, within};
use lists::{BandLists, Listed, Visitor};
use rayon::prelude::*;
use seen::Seen;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Copies of one object.
pub(crate) struct Batch<'a> {
    pub placements: &'a [Placement],
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
}

/// What one batch has in one band.
struct Part {
    lists: BandLists,
    /// Copies that may show.
    copies: Vec<u32>,
}

impl Bins {
    /// What of these batches a view of perspective shows. `fragments`: they are drawn for bins, by
    /// squares; else work groups. `room`: most words that lists of patches may take in all.
    pub fn new(view: &View, batches: &[Batch], fragments: bool, room: u64) -> Self {
        let forms = Forms::new(view);
        let mut items: Vec<Item> = Vec::new();
        let mut told = Vec::with_capacity(batches.len());
        let mut visitors = Vec::with_capacity(batches.len());
        for (number, batch) in (0u32..).zip(batches) {
            let apart = AtomicBool::new(batch.whole.is_some());
            let even = AtomicBool::new(batch.whole.is_some());
            const CHUNK: usize = 1024;
            items.par_extend(
                batch
                    .placements
                    .par_chunks(CHUNK)
                    .enumerate()
                    .flat_map_iter(|(chunk, copies)| {
                        let first = chunk * CHUNK;
                        let (forms, apart, even) = (&forms, &apart, &even);
                        copies.iter().enumerate().filter_map(move |(n, copy)| {
                            let spread = forms.spread(copy, batch.shape.axis);
                            let Seen { pixels, near } = forms.see(&spread, &batch.shape)?;
                            if batch.whole.is_some_and(|s| !is_apart(s, spread.eye)) {
                                apart.store(false, Relaxed);
                            }
                            if is_lopsided(batch.half_side, copy) {
                                even.store(false, Relaxed);
                            }
                            Some(Item {
                                near: near.to_bits(),
                                batch: number,
                                copy: (first + n) as u32,
                                pixels,
                            })
                        })
                    }),
            );
            let apart = apart.into_inner();
            let beams = apart && even.into_inner();
            told.push((apart, beams));
            visitors.push(match (fragments, beams && batch.lists) {
                (true, _) => Visitor::Fragments,
                (false, false) => Visitor::Groups,
                (false, true) => Visitor::GroupsAndLists,
            });
        }
        items.par_sort_unstable();
        let [_, full] = view.corners();
        let squares = |pixels: f64| (pixels / f64::from(SIDE)).ceil() as u32;
        let (across, down) = (squares(full.x), squares(full.y));
        let band = down
            .div_ceil(4 * rayon::current_num_threads() as u32)
            .max(2);
        let starts: Vec<u32> = (0..down).step_by(band as usize).collect();
        let filled = |visitors: &[Visitor]| -> Vec<Vec<Part>> {
            let of = |&first: &u32| {
                let cover = Cover::new(across, first, (first + band).min(down));
                fill(cover, across, &forms, batches, &items, visitors)
            };
            starts.par_iter().map(of).collect()
        };
        let mut parts = filled(&visitors);
        let alone = parts.iter().flatten().map(|part| part.lists.alone.len());
        if u64::from(list_words(alone.sum::<usize>() as u32)) > room {
            parts = filled(&vec![Visitor::Groups; batches.len()]);
        }
        Self::joined(&parts, batches, &told)
    }

    fn joined(parts: &[Vec<Part>], batches: &[Batch], told: &[(bool, bool)]) -> Self {
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
                outside: told[number].0,
                beams: told[number].1,
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

/// The bins of every batch in a band.
fn fill(
    mut cover: Cover,
    across: u32,
    forms: &Forms,
    batches: &[Batch],
    items: &[Item],
    visitors: &[Visitor],
) -> Vec<Part> {
    let mut listed: Vec<Vec<Listed>> = vec![Vec::new(); batches.len()];
    let mut copies: Vec<Vec<u32>> = vec![Vec::new(); batches.len()];
    let (top, bottom) = (cover.top, cover.bottom);
    let mut rows = Vec::new();
    for item in items {
        if u32::from(item.pixels[1]) >= bottom || u32::from(item.pixels[3]) < top {
            continue;
        }
        let number = item.batch as usize;
        let (batch, list) = (&batches[number], &mut listed[number]);
        let near = f32::from_bits(item.near);
        if !cover.is_open(item.pixels, near) {
            continue;
        }
        let before = list.len();
        let spread = || forms.spread(&batch.placements[item.copy as usize], batch.shape.axis);
        let known = batch.outer.filter(|_| item.near > 0).is_some_and(|outer| {
            let spread = spread();
            let margin = forms.margin(&spread, &batch.shape);
            let [_, first, _, last] = item.pixels.map(u32::from);
            let within = first.max(top)..(last + 1).min(bottom);
            outer.rows(&spread, margin, within, last - first, &mut rows)
        });
        let rows = known.then_some(&rows[..]);
        cover.open(item.pixels, rows, near, |square, pixels| {
            list.push(Listed {
                square,
                copy: batch.first + item.copy,
                near: item.near,
                pixels,
            });
        });
        if list.len() == before {
            continue;
        }
        copies[number].push(item.copy);
        if let Some(inner) = batch.inner.filter(|_| item.near > 0) {
            cover.add(&spread(), inner, item.pixels);
        }
    }
    let squares = across * (bottom - top) / SIDE;
    let picture = forms.picture();
    let inside = |square: [u32; 2]| within(square, picture);
    let corner = |square: u32| [square % across, square / across + top / SIDE];
    (listed.iter().zip(copies).zip(visitors))
        .map(|((listed, copies), visitor)| Part {
            lists: BandLists::new(listed, squares, *visitor, corner, inside),
            copies,
        })
        .collect()
}
