//! The visible result of paint laid over paint: a layer of disjoint cells, each of one colour.

use revmap::profile::Region;

/// Premultiplied red, green, blue and alpha, in the drawing's own (sRGB) values.
pub(super) type Rgba = [f32; 4];

/// Disjoint cells of colour; the layer is transparent elsewhere.
#[derive(Debug, Default)]
pub(super) struct Layer {
    cells: Vec<(Rgba, Region)>,
    /// Opaque paint of one colour on top that is not yet merged. Merging many shapes at once costs
    /// far less than one after the other.
    pending: Vec<Region>,
    pending_color: Rgba,
}

impl Layer {
    /// Lays `color` over `region`.
    pub fn paint(&mut self, region: Region, color: Rgba) {
        if region.is_empty() || color[3] <= 0.0 {
            return;
        }
        if color[3] >= 1.0 {
            if color != self.pending_color {
                self.merge_pending();
                self.pending_color = color;
            }
            self.pending.push(region);
        } else {
            self.merge_pending();
            self.glaze(&region, color);
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
        let mut bare = region.clone();
        let mut cells = Vec::with_capacity(self.cells.len() * 2 + 1);
        for (below, cell) in self.cells.drain(..) {
            let both = cell.intersection(region);
            if both.is_empty() {
                cells.push((below, cell));
                continue;
            }
            bare = bare.difference(&cell);
            cells.push((below, cell.difference(region)));
            cells.push((over(color, below), both));
        }
        cells.push((color, bare));
        cells.retain(|(_, cell)| !cell.is_empty());
        self.cells = cells;
    }
}

/// `top` over `below`, both premultiplied (Porter & Duff 1984).
pub(super) fn over(top: Rgba, below: Rgba) -> Rgba {
    std::array::from_fn(|i| top[i] + below[i] * (1.0 - top[3]))
}
