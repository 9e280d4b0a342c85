//! Slots in the arena of tables.

use range_alloc::RangeAllocator;
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// The free ranges of the arena, in its units.
pub(crate) type Ranges = Arc<Mutex<RangeAllocator<u32>>>;

/// The parts of a surface that are in the arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// Tables that searches walk.
    Tables,
    /// Frusta that the vertex shaders of hulls expand.
    Frusta,
    /// Patches that lists are made from.
    Patches,
}

/// A slot in the arena; freed when dropped.
#[derive(Debug)]
pub(crate) struct Slot {
    range: Range<u32>,
    unit: u32,
    ranges: Ranges,
}

impl Slot {
    /// A slot from a range of units that was taken from `ranges`. `unit`: vectors per unit.
    pub fn new(range: Range<u32>, unit: u32, ranges: &Ranges) -> Self {
        Self {
            range,
            unit,
            ranges: ranges.clone(),
        }
    }

    /// The first vector of the slot.
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
