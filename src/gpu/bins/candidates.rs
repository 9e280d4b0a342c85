//! Clusters of copies that may show, from the nearest to the farthest, and their copies.

use super::seen::{Forms, Seen};
use super::{Batch, Item};
use crate::gpu::hulls::{is_apart, is_lopsided, may_be_lopsided, may_hold_eye};
use crate::scene::Cluster;
use rayon::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// A cluster that may be in the picture.
pub(super) struct Candidate<'a> {
    /// Of none of its copies is the nearest depth less: bits, as an item's.
    pub near: u32,
    /// They hold those of its copies.
    pub pixels: [u16; 4],
    batch: u32,
    cluster: &'a Cluster,
    /// Whether nothing depends on its copies but what they show.
    pub may_be_hidden: bool,
    /// Its copies, once they were asked for.
    items: OnceLock<Vec<Item>>,
}

#[cfg(test)]
impl Candidate<'_> {
    /// Whether its copies were looked at.
    pub fn is_opened(&self) -> bool {
        self.items.get().is_some()
    }
}

/// All of them.
pub(super) struct Candidates<'a> {
    pub forms: &'a Forms,
    pub batches: &'a [Batch<'a>],
    /// The nearest first.
    pub all: Vec<Candidate<'a>>,
    /// What was found of each batch's copies.
    found: Vec<Found>,
}

/// What copies of a batch that were asked for have in common, as [`Shown`](super::Shown) has it.
pub(super) struct Told {
    pub outside: bool,
    pub beams: bool,
}

struct Found {
    /// Whether the eye is outside of all of them, and the box cuts none.
    outside: AtomicBool,
    /// Whether hulls can be drawn in all of their boxes.
    even: AtomicBool,
}

impl<'a> Candidates<'a> {
    pub fn new(forms: &'a Forms, batches: &'a [Batch<'a>]) -> Self {
        let forward = forms.rows.row(2);
        let of = |(number, batch): (u32, &'a Batch<'a>)| {
            let axis = batch.shape.axis.length();
            let clusters = batch.placements.clusters().all().par_iter();
            clusters.filter_map(move |cluster| {
                let Seen { pixels, near } = forms.see_cluster(cluster, &batch.shape)?;
                let lopsided = || may_be_lopsided(batch.half_side, cluster);
                let entered = |surface| may_hold_eye(surface, axis, cluster, forms.eye, forward);
                Some(Candidate {
                    near: near.to_bits(),
                    pixels,
                    batch: number,
                    cluster,
                    may_be_hidden: !batch.whole.is_some_and(|s| lopsided() || entered(s)),
                    items: OnceLock::new(),
                })
            })
        };
        let mut all = Vec::new();
        for batch in (0..).zip(batches) {
            all.par_extend(of(batch));
        }
        all.par_sort_unstable_by_key(|candidate: &Candidate| candidate.near);
        let found = batches.iter().map(|batch| Found {
            outside: AtomicBool::new(batch.whole.is_some()),
            even: AtomicBool::new(batch.whole.is_some()),
        });
        Self {
            forms,
            batches,
            all,
            found: found.collect(),
        }
    }

    /// The copies of one of these that some pixel may show.
    pub fn items<'b>(&self, of: &'b Candidate) -> &'b [Item] {
        of.items.get_or_init(|| {
            let places = of.cluster.range.clone();
            places
                .filter_map(|place| self.item(of.batch, place))
                .collect()
        })
    }

    /// The copy in a place among its batch's clusters, if some pixel may show it.
    pub fn item(&self, number: u32, place: u32) -> Option<Item> {
        let (batch, found) = (&self.batches[number as usize], &self.found[number as usize]);
        let (copy, placement) = batch.placements.clusters().at(place);
        let spread = self.forms.spread(placement, batch.shape.axis);
        let Seen { pixels, near } = self.forms.see(&spread, &batch.shape)?;
        if batch.whole.is_some_and(|s| !is_apart(s, spread.eye)) {
            found.outside.store(false, Relaxed);
        }
        if batch.whole.is_some() && is_lopsided(batch.half_side, placement) {
            found.even.store(false, Relaxed);
        }
        Some(Item {
            near: near.to_bits(),
            batch: number,
            copy,
            pixels,
            place,
        })
    }

    /// Of each batch.
    pub fn found(self) -> impl Iterator<Item = Told> {
        self.found.into_iter().map(|found| {
            let outside = found.outside.into_inner();
            Told {
                outside,
                beams: outside && found.even.into_inner(),
            }
        })
    }
}
