//! Shells of triangles around the patches, so that a rasteriser finds the patch that a ray meets.
//!
//! # Cells
//!
//! Up to [`ProxyHullOptions::patches_per_cell`] consecutive patches of a chain are a **cell**. A
//! **shell** surrounds the cell's surface on the empty side. The shell has frusta along the surface
//! and walls at the two ends, from the frusta down to the surface and a little into the solid.
//! Shell and surface enclose the cell's part of the empty space. A ray from outside that first
//! meets the solid on one of the cell's patches was in that part just before. The ray came in
//! through the shell: through the surface it would have come out of the solid, which it then would
//! have met before. So
//!
//! > a fragment of a front-facing triangle tests the patches of its own cell, no others, and the
//! > nearest fragment is the first hit.
//!
//! No ray is lost, at any grazing angle and for any fold of the profile. Chains, undercuts and
//! cavities need no special care, and every hit of a fragment is a true point of the boundary. The
//! argument holds for eyes outside all shells ([`ProxyHull::clear_of`]).
//!
//! # Frusta
//!
//! The shell of a cell is a polyline in the half-plane. Each of its parts, turned about the axis in
//! `n` steps, is a **frustum** of `2 n` triangles. A frustum is as long as the surface stays within
//! [`ProxyHullOptions::gap`] of it. A frustum runs along the surface's chord, moved outwards until
//! it touches the surface. Such a line is the support line: the extremes of a quadric's meridian
//! above a line are the roots of a quadratic. Two frusta that meet at a bulge are extended to their
//! intersection. In a hollow they are cut at it. Otherwise a third frustum joins them.
//!
//! A wall runs on in its own direction until it is in the solid all round. Where it would end beside
//! the solid, as at a narrow rim, it continues on the level of the joint instead, since no ray
//! crosses a level twice.
//!
//! A regular polygon of `n` corners at radius `f r` contains the circle of radius `r` with `f = 1 /
//! cos(pi / n)`, and is inside it with `f = 1`. Walls that face away from the axis use the first
//! factor, walls that face the axis the second. Planes use the first at their outer rim and the
//! second at the inner rim. The radii of [`Frustum`] are those of the corners.
//!
//! # Expansion in a vertex shader
//!
//! Each frustum has `6 n` corners. A vertex shader makes the `2 n` different ones from their
//! number, and an index buffer repeats them. Corner `v` has `frustum = v / (6 n)` and `side = v %
//! (6 n) / 6`. The number `v % 6` selects one of `A_side, A_side+1, B_side+1, A_side, B_side+1,
//! B_side`, where ring `A` is `from`, `B` is `to`, and corner `s` is at the azimuth `2 pi s / n`.
//! Counter-clockwise is front.

use super::QuadricPatch;
use super::cavity_culling::CavityCulling;
use super::cells;
use super::frusta::FrustaBuilder;
pub use super::frusta::ProxyHullOptions;
use glam::DVec2;
use std::ops::Range;

/// A ring of triangles between two regular polygons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frustum {
    /// Radius of the corners and height of the ring where it begins.
    pub from: [f32; 2],
    /// Radius of the corners and height of the ring where it ends. Seen along `(from, to)`, the
    /// solid is on the left.
    pub to: [f32; 2],
    /// The cell's first patch.
    pub first: u32,
    /// Number of the cell's patches, which are contiguous.
    pub count: u32,
    /// Number of the cell.
    pub cell: u32,
}

/// The shells of all cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProxyHull {
    /// Corners of each ring.
    pub sides: u32,
    /// All frusta, cell by cell.
    pub frusta: Vec<Frustum>,
    /// The extent of each cell's shell: `[r min, r max, z min, z max]`.
    pub extents: Vec<[f64; 4]>,
    /// The largest radius of each cell's surface.
    pub reaches: Vec<f64>,
    sight: CavityCulling,
}

impl ProxyHull {
    /// The shells around patches that [`fit_patches`](super::fit_patches) made.
    pub fn new(patches: &[QuadricPatch], options: &ProxyHullOptions) -> Self {
        let sides = options.sides.max(3);
        let mut hull = Self {
            sides,
            ..Self::default()
        };
        let widen = 1.0 / (std::f64::consts::PI / f64::from(sides)).cos();
        let builder = FrustaBuilder {
            options,
            patches,
            widen,
        };
        let cells = cells::divide(patches, options);
        for range in &cells {
            let cell = &patches[range.clone()];
            hull.push(&builder.of(cell), range.start, range.len());
            hull.reaches
                .push(cell.iter().fold(0.0, |most, p| most.max(p.r[1])));
        }
        hull.sight = CavityCulling::new(patches, &cells);
        hull
    }

    /// Runs of frusta that eyes at these `(r, z)` may see. Cells in cavities that no eye looks into
    /// are left out, because drawing their shells has no effect.
    pub fn seen_from(&self, eyes: &[DVec2]) -> Vec<Range<u32>> {
        self.runs(|cell| !eyes.iter().all(|&eye| self.sight.hides(cell, eye)))
    }

    /// Runs of the frusta of cells for which `wanted` is true.
    pub fn runs(&self, wanted: impl Fn(usize) -> bool) -> Vec<Range<u32>> {
        let wanted: Vec<bool> = (0..self.extents.len()).map(wanted).collect();
        let mut runs: Vec<Range<u32>> = Vec::new();
        for (frustum, number) in self.frusta.iter().zip(0..) {
            if wanted[frustum.cell as usize] {
                match runs.last_mut() {
                    Some(run) if run.end == number => run.end += 1,
                    _ => runs.push(number..number + 1),
                }
            }
        }
        runs
    }

    fn push(&mut self, points: &[[DVec2; 2]], first: usize, count: usize) {
        let mut extent = [f64::INFINITY, 0.0, f64::INFINITY, f64::NEG_INFINITY];
        for [a, b] in points {
            for p in [a, b] {
                extent[0] = extent[0].min(p.x);
                extent[1] = extent[1].max(p.x);
                extent[2] = extent[2].min(p.y);
                extent[3] = extent[3].max(p.y);
            }
            let flat = |p: &DVec2| [p.x as f32, p.y as f32];
            if flat(a) != flat(b) {
                self.frusta.push(Frustum {
                    from: flat(a),
                    to: flat(b),
                    first: first as u32,
                    count: count as u32,
                    cell: self.extents.len() as u32,
                });
            }
        }
        // Flat sides are nearer to the axis than their corners.
        extent[0] *= (std::f64::consts::PI / f64::from(self.sides)).cos();
        self.extents.push(extent);
    }

    /// True if an eye at `(r, z)` is outside all shells by at least `margin`. Otherwise front faces
    /// may be behind it.
    pub fn clear_of(&self, eye: DVec2, margin: f64) -> bool {
        self.extents.iter().all(|e| {
            eye.x < e[0] - margin
                || eye.x > e[1] + margin
                || eye.y < e[2] - margin
                || eye.y > e[3] + margin
        })
    }
}
