//! Clusters of copies, and single copies, that may show, sorted from the nearest to the farthest.

use super::bounds::{Projector, ScreenBounds};
use super::{Batch, Item, Placements};
use crate::plan::proxy::{is_apart, is_lopsided, may_be_lopsided, may_hold_eye};
use crate::scene::{Cluster, Placement};
use rayon::prelude::*;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// A cluster, or a single copy, that may be in the picture.
pub(super) struct Candidate<'a> {
    /// Bits of a depth; no copy of the candidate is nearer.
    pub near: u32,
    /// A rectangle that contains the pixels of its copies.
    pub pixels: [u16; 4],
    batch: u32,
    /// None for a single copy.
    cluster: Option<&'a Cluster>,
    /// True if its copies affect nothing but the pixels that show them.
    pub may_be_hidden: bool,
    /// The copies, after they are read.
    items: OnceLock<Vec<Item>>,
}

#[cfg(test)]
impl Candidate<'_> {
    /// True if its copies were read.
    pub fn is_opened(&self) -> bool {
        self.items.get().is_some()
    }
}

/// All candidates of a view.
pub(super) struct Candidates<'a> {
    pub projector: &'a Projector,
    pub batches: &'a [Batch<'a>],
    /// The candidates, nearest first.
    pub all: Vec<Candidate<'a>>,
    /// One entry per batch.
    facts: Vec<Facts>,
}

/// Facts that hold for all copies of a batch that were read.
#[derive(Clone, Copy)]
pub(super) struct CopyFacts {
    /// True if the eye is outside of each copy's bounding cylinder.
    pub apart: bool,
    /// True if the ratio of each box's sides is small enough for beams of 32-bit floats.
    pub even: bool,
}

struct Facts {
    apart: AtomicBool,
    even: AtomicBool,
}

impl<'a> Candidates<'a> {
    pub fn new(projector: &'a Projector, batches: &'a [Batch<'a>]) -> Self {
        let facts = batches.iter().map(|batch| Facts {
            apart: AtomicBool::new(batch.surface.is_some()),
            even: AtomicBool::new(batch.surface.is_some()),
        });
        let mut candidates = Self {
            projector,
            batches,
            all: Vec::new(),
            facts: facts.collect(),
        };
        let mut all = Vec::new();
        for (number, batch) in (0..).zip(batches) {
            match batch.placements {
                Placements::One(_) => all.extend(candidates.single(number)),
                Placements::Many(copies) => {
                    let clusters = copies.clusters().all().par_iter();
                    all.par_extend(clusters.filter_map(|c| candidates.cluster(number, batch, c)));
                }
            }
        }
        all.par_sort_unstable_by_key(|candidate: &Candidate| candidate.near);
        candidates.all = all;
        candidates
    }

    fn single(&self, number: u32) -> Option<Candidate<'a>> {
        let item = self.item(number, 0)?;
        Some(Candidate {
            near: item.near,
            pixels: item.pixels,
            batch: number,
            cluster: None,
            may_be_hidden: true,
            items: vec![item].into(),
        })
    }

    fn cluster(&self, number: u32, batch: &Batch, cluster: &'a Cluster) -> Option<Candidate<'a>> {
        let axis = batch.shape.axis.length();
        let (eye, forward) = (self.projector.eye, self.projector.rows.row(2));
        let ScreenBounds { pixels, near } = self.projector.cluster_bounds(cluster, &batch.shape)?;
        let lopsided = || may_be_lopsided(batch.half_side, cluster);
        let entered = |surface| may_hold_eye(surface, axis, cluster, eye, forward);
        Some(Candidate {
            near: near.to_bits(),
            pixels,
            batch: number,
            cluster: Some(cluster),
            may_be_hidden: !batch.surface.is_some_and(|s| lopsided() || entered(s)),
            items: OnceLock::new(),
        })
    }

    /// The copies of a candidate that some pixel may show.
    pub fn items<'b>(&self, of: &'b Candidate) -> &'b [Item] {
        of.items.get_or_init(|| {
            let ranks = of.cluster.map_or(0..0, |cluster| cluster.range.clone());
            ranks.filter_map(|rank| self.item(of.batch, rank)).collect()
        })
    }

    /// The copy at a position among its batch's clusters, if some pixel may show it.
    pub fn item(&self, number: u32, rank: u32) -> Option<Item> {
        let (batch, facts) = (&self.batches[number as usize], &self.facts[number as usize]);
        let (copy, placement) = batch.placements.at(rank);
        let axes = self.projector.axes(placement, batch.shape.axis);
        let ScreenBounds { pixels, near } = self.projector.bounds(&axes, &batch.shape)?;
        if batch.surface.is_some_and(|s| !is_apart(s, axes.eye)) {
            facts.apart.store(false, Relaxed);
        }
        if batch.surface.is_some() && is_lopsided(batch.half_side, placement) {
            facts.even.store(false, Relaxed);
        }
        Some(Item {
            near: near.to_bits(),
            batch: number,
            copy,
            pixels,
            rank,
        })
    }

    /// The facts about the copies of each batch.
    pub fn facts(&self) -> Vec<CopyFacts> {
        let of = |facts: &Facts| CopyFacts {
            apart: facts.apart.load(Relaxed),
            even: facts.even.load(Relaxed),
        };
        self.facts.iter().map(of).collect()
    }
}

impl<'a> Placements<'a> {
    /// The number of the copy at a position, and its placement.
    pub fn at(&self, rank: u32) -> (u32, &'a Placement) {
        match self {
            Self::One(placement) => (0, placement),
            Self::Many(copies) => copies.clusters().at(rank),
        }
    }

    /// Number of copies.
    pub fn len(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Many(copies) => copies.len(),
        }
    }
}
