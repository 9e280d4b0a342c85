//! Places in the arena of tables.

use range_alloc::RangeAllocator;
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// What of the arena is free, in its units.
pub(crate) type Ranges = Arc<Mutex<RangeAllocator<u32>>>;

/// The parts of a surface that stand in the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// What searches walk.
    Tables,
    /// What the vertex shaders of hulls grow.
    Frusta,
    /// What lists of patches are made from.
    Patches,
}

/// A place in the arena, free again when dropped.
#[derive(Debug)]
pub(crate) struct Slot {
    range: Range<u32>,
    unit: u32,
    ranges: Ranges,
}

impl Slot {
    /// A range of units, of so many vectors each, that was taken from `ranges`.
    pub fn new(range: Range<u32>, unit: u32, ranges: &Ranges) -> Self {
        Self {
            range,
            unit,
            ranges: ranges.clone(),
        }
    }

    /// The vector with which it begins.
    pub fn begin(&self) -> u32 {
        self.range.start * self.unit
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        if let Ok(mut ranges) = self.ranges.lock() {
            ranges.free_range(self.range.clone());
        }
    }
}
