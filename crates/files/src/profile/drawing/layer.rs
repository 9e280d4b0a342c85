//! Paint laid over paint within a tile.

use super::paint::{Paint, Rgba, over};
use super::tile::{Tile, overlap};
use revmap::profile::Region;

/// Disjoint cells of colour that fill a tile.
#[derive(Debug)]
pub(super) struct Layer {
    tile: Tile,
    cells: Vec<(Rgba, Region)>,
    /// Opaque paint of one colour on top that is not yet merged. Merging many shapes at once costs
    /// far less than one after the other.
    pending: Vec<Region>,
    pending_color: Rgba,
}

impl Layer {
    /// A transparent layer.
    pub fn new(tile: Tile) -> Self {
        Self {
            tile,
            cells: vec![([0.0; 4], tile.region())],
            pending: Vec::new(),
            pending_color: [0.0; 4],
        }
    }

    pub fn lay(&mut self, paints: &[Paint]) {
        for paint in paints {
            match paint {
                Paint::Region(region, color, _) => self.paint(region, *color),
                Paint::Group {
                    opacity,
                    clip,
                    paints,
                } => {
                    let mut own = Self::new(self.tile);
                    own.lay(paints);
                    for (color, cell) in own.into_cells() {
                        let color = color.map(|v| v * opacity);
                        match clip {
                            Some(clip) => self.paint(&cell.intersection(clip), color),
                            None => self.paint(&cell, color),
                        }
                    }
                }
            }
        }
    }

    /// Lays `color` over `region`.
    fn paint(&mut self, region: &Region, color: Rgba) {
        if color[3] <= 0.0 || region.is_empty() {
            return;
        }
        if color[3] >= 1.0 {
            if color != self.pending_color {
                self.merge_pending();
                self.pending_color = color;
            }
            self.pending.push(region.clone());
        } else {
            self.merge_pending();
            self.glaze(region, color);
        }
    }

    /// The layer's cells.
    pub fn into_cells(mut self) -> Vec<(Rgba, Region)> {
        self.merge_pending();
        self.cells
    }

    /// Merges the opaque paint; everything below it is removed.
    fn merge_pending(&mut self) {
        if self.pending.is_empty() {
            return;
        }
        let top = Region::merged(std::mem::take(&mut self.pending));
        let mut own = None;
        for (color, cell) in &mut self.cells {
            if *color == self.pending_color {
                own = Some(cell);
            } else {
                *cell = cell.difference(&top);
            }
        }
        match own {
            Some(cell) => *cell = cell.union(&top),
            None => self.cells.push((self.pending_color, top)),
        }
        self.cells.retain(|(_, cell)| !cell.is_empty());
    }

    /// Lays translucent paint: it mixes with the paint below, cell by cell.
    fn glaze(&mut self, region: &Region, color: Rgba) {
        if self.tile.is_covered_by(region) {
            for (below, _) in &mut self.cells {
                *below = over(color, *below);
            }
            return;
        }
        let mut cells = Vec::with_capacity(self.cells.len() * 2);
        let extent = region.extent(self.tile.grid);
        for (below, cell) in self.cells.drain(..) {
            if !overlap(extent, cell.extent(self.tile.grid)) {
                cells.push((below, cell));
                continue;
            }
            let both = cell.intersection(region);
            if both.is_empty() {
                cells.push((below, cell));
                continue;
            }
            cells.push((below, cell.difference(region)));
            cells.push((over(color, below), both));
        }
        cells.retain(|(_, cell)| !cell.is_empty());
        self.cells = cells;
    }
}
