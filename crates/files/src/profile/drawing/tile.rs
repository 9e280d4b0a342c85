//! Rectangles of the plane.

use glam::DVec2;
use revmap::profile::{Grid, Region};

/// A rectangle of the plane, corners on the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    pub grid: Grid,
    pub low: DVec2,
    pub high: DVec2,
}

impl Tile {
    pub fn region(self) -> Region {
        Region::rectangle(self.grid, self.low, self.high)
    }

    /// Two halves of the longer side.
    pub fn halves(self) -> [Self; 2] {
        let size = self.high - self.low;
        let middle = self.grid.rounded(0.5 * (self.low + self.high));
        let (mut end, mut start) = (self.high, self.low);
        match size.x > size.y {
            true => (end.x, start.x) = (middle.x, middle.x),
            false => (end.y, start.y) = (middle.y, middle.y),
        }
        [Self { high: end, ..self }, Self { low: start, ..self }]
    }

    /// The part of a region in the tile; `None` for none.
    pub fn part(self, region: &Region) -> Option<Region> {
        let [low, high] = region.extent(self.grid)?;
        if !overlap(Some([low, high]), Some([self.low, self.high])) {
            return None;
        }
        if low.cmpge(self.low).all() && high.cmple(self.high).all() {
            return Some(region.clone());
        }
        if region.is_rectangle() {
            let (low, high) = (low.max(self.low), high.min(self.high));
            return Some(Region::rectangle(self.grid, low, high));
        }
        Some(region.intersection(&self.region())).filter(|r| !r.is_empty())
    }

    /// Returns true if a region, which is within the tile, is all of it.
    pub fn is_covered_by(self, region: &Region) -> bool {
        region.is_rectangle() && region.extent(self.grid) == Some([self.low, self.high])
    }
}

/// Returns true if two extents have area in common.
pub(super) fn overlap(a: Option<[DVec2; 2]>, b: Option<[DVec2; 2]>) -> bool {
    a.zip(b)
        .is_some_and(|(a, b)| a[0].cmplt(b[1]).all() && b[0].cmplt(a[1]).all())
}
