//! The way from a profile and an offset to a few quadrics of revolution, and to the tables that a
//! shader walks.
//!
//! The surface `F(r, z) = d(r, z) - w(z) = 0` of a solid is a handful of closed curves of the
//! half-plane. [`ContourSource`] finds them exactly. [`fit_patches`] cuts them into the longest
//! patches that a quadric
//!
//! ```text
//! G(r, z) = a r^2 + k0 + k1 z + k2 z^2,   a in {-1, 0, 1},   G < 0 in the solid
//! ```
//!
//! follows within a tolerance. [`Tables`] distributes the patches to rows of equal height. In `(z,
//! r^2)` a ray is a parabola and a patch a parabola or a horizontal line. The intersection is one
//! quadratic in `t`, the same for cylinders, cones, spheres, paraboloids, hyperboloids and planes.
//!
//! The patches are wrapped in shells for the rasteriser ([`hull`]).
//!
//! Data flows one way: outline → contour → patches → rows and hull. All of it is cheap enough to be
//! made anew after each change of the offset. The parts that depend only on the outline are
//! prepared once, in the [`ContourSource`].

mod cavity_culling;
mod cells;
mod chain;
mod contour;
mod fit;
mod frusta;
pub mod hull;
mod offset;
pub mod rows;
mod tree;

pub use chain::Chain;
use chain::JOINT;
pub use contour::{Contour, ContourSource, MOST_SEGMENTS};
pub use fit::{FitOptions, fit_patches};
pub use hull::{Frustum, ProxyHull, ProxyHullOptions};
pub use rows::{GpuPatch, ROWS, Tables};
pub(crate) use rows::{extents, touched};

use glam::DVec2;

/// The offset `w(z)` between the profile and the surface `F = d - w = 0`:
/// `w = extend + bevel * min(u, chamfer)`, with the depth `u = 1 - z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// `e`, object units; negative insets.
    pub extend: f64,
    /// `b`, slope.
    pub bevel: f64,
    /// `c`, depth in `[0, 1]` down to which the bevel increases.
    pub chamfer: f64,
}

impl Default for Offset {
    /// The profile itself: `w = 0`. A bevel set on this default extends to the bottom.
    fn default() -> Self {
        Self {
            extend: 0.0,
            bevel: 0.0,
            chamfer: 1.0,
        }
    }
}

impl Offset {
    /// The largest offset of the surface in the box.
    pub(crate) fn largest_width(&self) -> f64 {
        self.extend + (self.bevel * self.chamfer.clamp(0.0, 1.0)).max(0.0)
    }
}

/// Height of the sheets of a cone above and below its tip, object units.
///
/// A ray through the tip of `r^2 = q (h^2 - APART^2)` has the term `q APART^2` under the root, times the
/// square of its slope. Shaders compute it as the difference of products of size `(q h)^2`, with fewer
/// than 16 roundings, `h` from where they count the ray's roots to the tip. That is at most half a row of
/// [`ROWS`], so the square of this number is `16 * 2^-24 / 512^2`.
const APART: f64 = 1.0 / 524_288.0;

/// A part of the boundary that one quadric of revolution describes; monotone in `z`, solid on its
/// left.
///
/// All lengths are object units. Neighbours share their end points to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadricPatch {
    /// `[a, k0, k1, k2]` of `G = a r^2 + k0 + k1 z + k2 z^2`: negative in the solid, `grad G = (2 a
    /// r, k1 + 2 k2 z)` outward. `a` is 1 if the solid is towards the axis, -1 if it is away from
    /// it, 0 for planes `z = const`.
    pub quadric: [f64; 4],
    /// Point `(r, z)` at which the chain enters the patch.
    pub start: DVec2,
    /// Point `(r, z)` at which the chain leaves the patch.
    pub end: DVec2,
    /// Least and largest `z`.
    pub z: [f64; 2],
    /// Least and largest `r`.
    pub r: [f64; 2],
    /// `[cz, cr, low, high]`: a point of the quadric belongs to the patch if `low <= cz z + cr r^2
    /// <= high`.
    ///
    /// A range of only `z` would be too coarse: on a flat patch a rounding of `z` moves `r` far.
    /// The left side grows along the patch about as its length does, in either direction. The ends
    /// are moved outwards by the largest rounding of 32-bit floats, so that neighbours overlap and
    /// no ray passes between them.
    pub guard: [f64; 4],
    /// Number of its chain in the [`Contour`].
    pub chain: u32,
    /// The patch before it in its chain; none if the chain begins on the axis.
    pub previous: Option<u32>,
    /// The patch after it; none if the chain ends on the axis.
    pub next: Option<u32>,
}

/// Least and largest `r`, then `z`, of patches.
pub(crate) fn extent(patches: &[QuadricPatch]) -> [[f64; 2]; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let join = |[low, high]: [f64; 2], with: [f64; 2]| [low.min(with[0]), high.max(with[1])];
    patches
        .iter()
        .fold([none; 2], |[r, z], p| [join(r, p.r), join(z, p.z)])
}

impl QuadricPatch {
    /// `r^2` on the quadric at height `z`; NaN for a plane, which has none.
    pub fn square_at(&self, z: f64) -> f64 {
        let [a, k0, k1, k2] = self.quadric;
        if a == 0.0 {
            f64::NAN
        } else {
            -a * (k0 + z * (k1 + z * k2))
        }
    }

    /// The anchor, and `[a, k0, k1, k2]` of `G = a r^2 + k0 + k1 h + k2 h^2` with `h = z - anchor`.
    ///
    /// The anchor is the `z` of the end nearer to the axis, as `rounded` returns it. There `G` has its
    /// smallest terms, so a flat cone keeps its tip: about `z = 0` the terms of its `G` are hundreds of
    /// times as large, and their rounding joins its two sheets.
    ///
    /// The sheets of a cone `r^2 = q h^2` meet in a tip on the axis. Rays through the tip have a double
    /// root, and rounding decides whether they have one at all. So the sheets are kept [`APART`].
    pub(crate) fn about_anchor(&self, rounded: impl Fn(f64) -> f64) -> (f64, [f64; 4]) {
        let (start, end) = (self.start, self.end);
        let inner = if start.x < end.x { start } else { end };
        let anchor = rounded(inner.y);
        let [a, k0, k1, k2] = self.quadric;
        let constant = if inner.x <= JOINT && a * k2 < 0.0 {
            -k2 * APART * APART
        } else {
            k0 + anchor * (k1 + anchor * k2)
        };
        (anchor, [a, constant, k1 + 2.0 * anchor * k2, k2])
    }

    /// True if it is a plane `z = const`.
    pub fn is_plane(&self) -> bool {
        self.quadric[0] == 0.0
    }

    /// `grad G` at `(r, z)`: outward, not of unit length.
    pub fn gradient(&self, p: DVec2) -> DVec2 {
        let [a, _, k1, k2] = self.quadric;
        DVec2::new(2.0 * a * p.x, k1 + 2.0 * k2 * p.y)
    }
}
