//! Which squares of the screen each instance's box covers: the work list of the compute path.

use super::view::View;
use crate::scene::Placement;
use crate::shader::generated::{BIN_PIXELS, GROUP_PIXELS};
use glam::{DVec2, DVec3};

/// A square of the screen and the boxes that cover it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bin {
    /// In bins: `x | y << 16`.
    corner: u32,
    /// Into the list of instances.
    first: u32,
    /// How many.
    count: u32,
}

/// Bins of all batches, one after another, and the lists they point into, as the shader's one buffer of words holds them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bins {
    pub bins: Vec<Bin>,
    pub instances: Vec<u32>,
}

/// A rectangle of bins or work groups, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub low: (u32, u32),
    pub high: (u32, u32),
}

impl Rectangle {
    /// How many squares.
    pub fn squares(self) -> u64 {
        u64::from(self.high.0 - self.low.0 + 1) * u64::from(self.high.1 - self.low.1 + 1)
    }

    /// The squares of as many whole groups of squares as hold it.
    pub fn padded(self) -> u32 {
        let groups = |low: u32, high: u32| (high - low + 1).next_multiple_of(GROUP_PIXELS);
        groups(self.low.0, self.high.0) * groups(self.low.1, self.high.1)
    }
}

impl Bins {
    /// The shader's words: four a bin, then the lists.
    pub fn words(&self) -> Vec<u32> {
        let lists = 4 * self.bins.len() as u32;
        let mut words = Vec::with_capacity(4 * self.bins.len() + self.instances.len());
        for bin in &self.bins {
            words.extend([bin.corner, lists + bin.first, bin.count, 0]);
        }
        words.extend(&self.instances);
        words
    }

    /// Adds a batch of boxes of radius `radius`; `first` is its first instance's number. Returns its range of bins.
    pub fn add(
        &mut self,
        view: &View,
        radius: f64,
        first: u32,
        placements: &[Placement],
    ) -> std::ops::Range<u32> {
        let [_, full] = view.corners();
        let bins = |pixels: f64| (pixels / f64::from(BIN_PIXELS)).ceil() as u32;
        let (across, down) = (bins(full.x), bins(full.y));
        let covered: Vec<_> = placements
            .iter()
            .map(|p| rectangle(view, BIN_PIXELS, radius, p))
            .collect();
        let mut counts = vec![0u32; (across * down) as usize];
        let each = |r: &Rectangle, visit: &mut dyn FnMut(usize)| {
            for y in r.low.1..=r.high.1 {
                for x in r.low.0..=r.high.0 {
                    visit((y * across + x) as usize);
                }
            }
        };
        for r in covered.iter().flatten() {
            each(r, &mut |bin| counts[bin] += 1);
        }
        let start = self.bins.len();
        let mut next = vec![0u32; counts.len()];
        let mut at = self.instances.len();
        for (bin, count) in counts.iter().enumerate() {
            if *count > 0 {
                let bin_number = bin as u32;
                self.bins.push(Bin {
                    corner: (bin_number % across) | (bin_number / across) << 16,
                    first: at as u32,
                    count: *count,
                });
                next[bin] = at as u32;
                at += *count as usize;
            }
        }
        self.instances.resize(at, 0);
        for (instance, r) in (first..).zip(&covered) {
            if let Some(r) = r {
                each(r, &mut |bin| {
                    self.instances[next[bin] as usize] = instance;
                    next[bin] += 1;
                });
            }
        }
        start as u32..self.bins.len() as u32
    }
}

/// The squares of `unit` pixels that a box may touch; none if it lies behind the eye or beside the picture.
pub(crate) fn rectangle(
    view: &View,
    unit: u32,
    radius: f64,
    placement: &Placement,
) -> Option<Rectangle> {
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    let mut farthest = f64::NEG_INFINITY;
    for corner in 0..8 {
        let sign = |bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 };
        let p = DVec3::new(
            sign(1) * radius,
            sign(2) * radius,
            f64::from(corner / 4 % 2),
        );
        let world = placement.position + placement.rotation * (placement.scale * p);
        let (pixel, depth) = view.project(world);
        nearest = nearest.min(depth);
        farthest = farthest.max(depth);
        low = low.min(pixel);
        high = high.max(pixel);
    }
    if farthest <= 0.0 {
        return None;
    }
    let [corner, full] = view.corners();
    if nearest <= 1e-9 * farthest {
        // A box around or beside the eye projects to no rectangle.
        (low, high) = (corner, full);
    }
    low = (low - 1.0).max(corner);
    high = (high + 1.0).min(full - 1.0);
    if low.x > high.x || low.y > high.y || !(low.is_finite() && high.is_finite()) {
        return None;
    }
    let bin = |v: f64| (v / f64::from(unit)) as u32;
    Some(Rectangle {
        low: (bin(low.x), bin(low.y)),
        high: (bin(high.x), bin(high.y)),
    })
}
