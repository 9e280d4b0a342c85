//! The contour of a raster: closed loops along which its coverage, taken linearly between the centres of pixels, is one half.
//!
//! Marching squares (Lorensen & Cline 1987 in the plane). The loops are closed and in order, which the lines of
//! [`interface`](super::interface) are not; these are closer to the true edge.

use super::{Outline, Raster};
use glam::DVec2;
use std::collections::HashMap;

/// An edge of the net of nodes: from node `(i, j)` to the right (`down` false) or downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Edge {
    i: u32,
    j: u32,
    down: bool,
}

/// Nodes at the centres of pixels, closed by empty ones all round. Left of the first column's centres stand two more at
/// `r = 0`: its mirror image makes the coverage constant up to the axis, and there the loops are closed.
struct Net<'a> {
    raster: &'a Raster,
}

impl Net<'_> {
    fn columns(&self) -> u32 {
        self.raster.columns + 3
    }

    fn rows(&self) -> u32 {
        self.raster.rows + 2
    }

    fn value(&self, i: u32, j: u32) -> f64 {
        let (columns, rows) = (self.raster.columns, self.raster.rows);
        if i == 0 || i > columns + 1 || j == 0 || j > rows {
            return 0.0;
        }
        let column = i.saturating_sub(2) as usize;
        f64::from(self.raster.coverage[(j - 1) as usize * columns as usize + column])
    }

    fn place(&self, i: u32, j: u32) -> DVec2 {
        let side = f64::from(self.raster.rows);
        DVec2::new(
            (f64::from(i) - 1.5).max(0.0) / side,
            1.0 - (f64::from(j) - 0.5) / side,
        )
    }

    /// Where an edge is crossed.
    fn crossing(&self, e: Edge) -> DVec2 {
        let (i1, j1) = if e.down {
            (e.i, e.j + 1)
        } else {
            (e.i + 1, e.j)
        };
        let (a, b) = (self.value(e.i, e.j), self.value(i1, j1));
        let t = if a == b { 0.5 } else { (0.5 - a) / (b - a) };
        self.place(e.i, e.j).lerp(self.place(i1, j1), t)
    }
}

impl Raster {
    /// The solid's boundary where the coverage passes one half, solid on its left, in object units.
    #[must_use]
    pub fn outline(&self) -> Outline {
        let net = Net { raster: self };
        let mut next: HashMap<Edge, Edge> = HashMap::new();
        let mut starts = Vec::new();
        for j in 0..net.rows() - 1 {
            for i in 0..net.columns() - 1 {
                for (from, to) in cell_pieces(&net, i, j) {
                    next.insert(from, to);
                    starts.push(from);
                }
            }
        }
        let mut loops = Vec::new();
        for start in starts {
            let mut points = Vec::new();
            let mut edge = start;
            while let Some(following) = next.remove(&edge) {
                let p = net.crossing(edge);
                if points.last() != Some(&p) {
                    points.push(p);
                }
                edge = following;
            }
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            if points.len() >= 3 {
                loops.push(points);
            }
        }
        Outline { loops }
    }
}

/// The contour's pieces in the cell whose upper left node is `(i, j)`, each from edge to edge.
fn cell_pieces(net: &Net, i: u32, j: u32) -> Vec<(Edge, Edge)> {
    let top = Edge { i, j, down: false };
    let left = Edge { i, j, down: true };
    let bottom = Edge {
        i,
        j: j + 1,
        down: false,
    };
    let right = Edge {
        i: i + 1,
        j,
        down: true,
    };
    let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| net.value(i, j));
    let solid = corners.map(|v| v > 0.5);
    // Going round clockwise in the picture, the contour enters the cell where empty gives way to solid and leaves where solid
    // gives way to empty: then the solid is on its left.
    let edges = [top, right, bottom, left];
    let mut enter = Vec::with_capacity(2);
    let mut leave = Vec::with_capacity(2);
    for k in 0..4 {
        match (solid[k], solid[(k + 1) % 4]) {
            (false, true) => enter.push(k),
            (true, false) => leave.push(k),
            _ => {}
        }
    }
    match (&enter[..], &leave[..]) {
        (&[from], &[to]) => vec![(edges[from], edges[to])],
        (&[e0, e1], &[..]) => {
            // A saddle: solid in the middle joins the solid corners and the empty ones are cut off, else the reverse.
            let joined = corners.iter().sum::<f64>() > 2.0;
            let step = if joined { 3 } else { 1 };
            [e0, e1].map(|k| (edges[k], edges[(k + step) % 4])).to_vec()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(rows: u32, center: DVec2, radius: f64) -> (Outline, Raster) {
        let points = (0..720)
            .map(|k| {
                center + DVec2::from_angle(f64::from(k) * std::f64::consts::PI / 360.0) * radius
            })
            .map(|p| DVec2::new(p.x.max(0.0), p.y))
            .collect();
        let outline = Outline {
            loops: vec![points],
        };
        let raster = outline.rasterize(rows, rows);
        (outline, raster)
    }

    #[test]
    fn a_ball_on_the_axis_is_closed_along_it() {
        let (exact, raster) = ball(64, DVec2::new(0.0, 0.5), 0.4);
        let outline = raster.outline();
        assert_eq!(outline.loops.len(), 1);
        assert!((outline.area() - exact.area()).abs() < 1e-3 * exact.area());
        assert!(
            outline
                .segments()
                .any(|s| s.a.x == 0.0 && s.b.x == 0.0 && s.a.y > s.b.y)
        );
        for s in outline.surface_segments() {
            assert!(
                (s.a.distance(DVec2::new(0.0, 0.5)) - 0.4).abs() < 0.1 / 64.0,
                "{}",
                s.a
            );
        }
    }

    #[test]
    fn a_ring_has_a_hole_of_the_other_direction() {
        let (_, mut raster) = ball(64, DVec2::new(0.5, 0.5), 0.4);
        let (_, hole) = ball(64, DVec2::new(0.5, 0.5), 0.2);
        for (c, h) in raster.coverage.iter_mut().zip(&hole.coverage) {
            *c -= h;
        }
        let outline = raster.outline();
        assert_eq!(outline.loops.len(), 2);
        let area = std::f64::consts::PI * (0.16 - 0.04);
        assert!((outline.area() - area).abs() < 2e-3 * area);
    }

    #[test]
    fn the_border_of_the_picture_is_a_boundary() {
        let full = Raster {
            columns: 2,
            rows: 4,
            coverage: vec![1.0; 8],
        };
        let outline = full.outline();
        assert_eq!(outline.loops.len(), 1);
        // Corners of the picture are cut between the centres of its pixels and those beyond.
        let cut = 2.0 * 0.5 * 0.125 * 0.125;
        assert!(
            (outline.area() - (0.5 - cut)).abs() < 1e-12,
            "{}",
            outline.area()
        );
    }

    #[test]
    fn saddles_stay_closed() {
        let raster = Raster {
            columns: 3,
            rows: 3,
            coverage: vec![0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0],
        };
        assert_eq!(raster.outline().loops.len(), 3);
        let thick = Raster {
            coverage: raster.coverage.iter().map(|c| 0.45 + c * 0.5).collect(),
            ..raster
        };
        assert_eq!(thick.outline().loops.len(), 1);
    }
}
