//! A **profile**: the solid region of the meridian half-plane that is turned about the axis.
//!
//! Coordinates are `(r, z)` in object units. The axis is `r = 0`; the shape box extends from
//! `z = 0` to `z = 1` and to the radius `R`. A profile is made from a polygon
//! ([`Profile::polygon`]) or a known [`Outline`] ([`Profile::new`]); the crate `revmap-files` reads
//! drawings and pictures. Maps, arc lengths, surfaces, meshes and the reference are all computed
//! from the outline.

mod outline;
mod polygon;
mod region;

pub use outline::{Bounds, Segment, loop_area};
pub use region::{FillRule, Grid, Region};

use crate::error::Result;
use glam::DVec2;

/// Points this close to the axis, on either side, in units of the largest radius, are moved onto
/// it; of a radius above 1, in object units. `0.5 * sin(pi)` is not quite 0, and drawings are
/// inexact. No picture shows a gap so narrow, but it would count as surface, and a negative offset
/// would open a bore there.
const AXIS_SLACK: f64 = 1e-4;

/// The solid's boundary as closed chains of straight segments.
///
/// The loops do not cross. The solid is on the **left** of every segment: outer loops run
/// counter-clockwise in `(r, z)`, holes clockwise. All points have `r >= 0`. Segments along `r = 0`
/// close a loop on the axis. They are inside the turned solid and not part of its surface (see
/// [`Outline::surface_segments`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Closed loops; the last point joins the first.
    pub loops: Vec<Vec<DVec2>>,
}

/// Solid fraction of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Pixels along `r`; the axis is the left edge of column 0.
    pub columns: u32,
    /// Pixels along `z`; row 0 is the top.
    pub rows: u32,
    /// Solid fraction in `[0, 1]`, row by row from the top; `columns * rows` values.
    pub coverage: Vec<f32>,
}

/// A solid region of the half-plane and the radius of its shape box.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The region's boundary.
    pub outline: Outline,
    /// `R`: the shape box is `[-R, R]^2 x [0, 1]`.
    pub radius: f64,
    /// The pixels of the picture that the outline was traced from, for maps that are measured in
    /// them. `None` for drawings and polygons, and for pictures whose axis is the middle of a
    /// column of pixels.
    pub raster: Option<Raster>,
    /// Features of the picture that look unintended: one sentence each, with the key that changes
    /// it.
    pub warnings: Vec<String>,
    /// What a photograph was read as: one sentence. Other profiles have none.
    pub notes: Vec<String>,
}

impl Profile {
    /// Largest coordinate of a polygon, object units: far beyond any box, and small enough to keep
    /// nine digits.
    pub const EXTENT: f64 = 1e4;

    /// A profile from a closed polygon of `[r, z]` points, object units, `radius` being the `R` of
    /// its box.
    ///
    /// The last point joins the first; both directions of travel are accepted. If the polygon
    /// crosses or covers itself, the solid is everything that it winds round (non-zero rule). The
    /// polygon may extend past its box; drawing cuts it there.
    ///
    /// ```
    /// let cone = revmap::profile::Profile::polygon(&[[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]], 0.5)?;
    /// assert_eq!(cone.radius, 0.5);
    /// # Ok::<(), revmap::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`ErrorKind::Content`](crate::error::ErrorKind::Content), with the key `polygon` or
    /// `radius`, for fewer than 3 points, a coordinate that is not finite or beyond 10,000, a point
    /// with `r < 0`, no area, or a radius that is not positive.
    pub fn polygon(points: &[[f64; 2]], radius: f64) -> Result<Self> {
        polygon::profile(points, radius)
    }

    /// A profile with a known outline. The loops are used unchanged, except that points near the
    /// axis are moved onto it: nearer than 1e-4 of the largest radius, or than 1e-4 object units if
    /// that radius is above 1. [`Outline`] lists the requirements of loops.
    #[must_use]
    pub fn new(mut outline: Outline, radius: f64) -> Self {
        let points = || outline.loops.iter().flatten();
        let largest = points().map(|point| point.x).fold(0.0, f64::max);
        let slack = AXIS_SLACK * largest.min(1.0);
        for point in outline.loops.iter_mut().flatten() {
            if point.x.abs() < slack {
                point.x = 0.0;
            }
        }
        let has_area = |points: &Vec<DVec2>| points.iter().any(|point| point.x > 0.0);
        if outline.loops.iter().any(has_area) {
            outline.loops.retain(has_area);
        }
        Self {
            outline,
            radius,
            raster: None,
            warnings: Vec::new(),
            notes: Vec::new(),
        }
    }
}
