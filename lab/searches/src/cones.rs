//! Cone maps of solids that are single-valued in z: `r <= f(z)`, solid down to the axis.
//!
//! Such a solid is a height field over the axis: `z` is the position, `r` the height. Cone step
//! mapping (Dummer 2006) stores, for each position, the widest cone with its tip on the surface
//! there that contains nothing of the solid. A ray above the surface may advance to its exit from
//! that cone. The two flanks of a cone become cones of revolution when turned about the axis, and
//! the exit of a ray from one is a quadratic. A ray moves along the axis in one direction only, so
//! each flank has a slope of its own.
//!
//! # Layout
//!
//! Row `i` of `N` is `i / N <= z <= (i + 1) / N`.
//!
//! * `[g, g', k_up, k_down]`: `g` and `g'` are the radius at the row's lower and upper border,
//!   linear in between. From any point of the row, `(z, g(z))`, nothing of the solid at `z' > z` is
//!   beyond `g(z) + k_up (z' - z)`, and nothing at `z' < z` is beyond `g(z) + k_down (z - z')`.
//! * `[g, g', h, -1 - 4096 p - q]`, if that is closer to the surface: a level face at the height
//!   `(i + p / 2047) / N` splits the row. The radius goes from `g` to `h` below the face, and from
//!   `q / 4095` of the largest radius to `g'` above it. Such rows have no cones.
//!
//! The slopes are those of the borders. Let `k` be the steepest slope from the row's lower end to
//! any point of the surface above (0 if all of them descend), and `k'` the same from its upper end.
//! The row has `max(k, k')`. For a point between the two ends, the slope to a third point is the
//! mediant of theirs, so it is no steeper than the steeper of both.

mod surface;

use glam::DVec2;
use revmap::error::Result;
use revmap::search::SearchTable;
use revmap::surface::Contour;
use surface::{Row, Surface};

/// The table of `cone`.
pub(crate) fn rows(contour: &Contour, rows: u32) -> Result<SearchTable> {
    Ok(Cones::new(contour, rows)?.table())
}

/// The table of `relaxed`. These cones are wider, and a step may end inside the solid: the search
/// misses some surfaces.
pub(crate) fn relaxed_rows(contour: &Contour, rows: u32) -> Result<SearchTable> {
    Ok(Cones::relaxed(contour, rows)?.table())
}

/// The rows of a cone map; the [module](self) documents their layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cones {
    /// `[g, g', k_up, k_down]`, or a row with a level face.
    pub rows: Vec<[f32; 4]>,
    /// The largest radius.
    pub reach: f32,
}

/// Upper limit of slopes, which represents a jump.
const STEEPEST: f64 = 1e6;

impl Cones {
    /// The cone map of a contour in `rows` rows. Features thinner in z than a row may be lost, or
    /// filled.
    ///
    /// # Errors
    /// [`ErrorKind::Content`](revmap::error::ErrorKind::Content) if the solid is not single-valued
    /// at two neighbouring borders of rows: a line outwards from the axis leaves the solid more
    /// than once, or starts outside of it.
    pub fn new(contour: &Contour, rows: u32) -> Result<Self> {
        Self::with(contour, rows, slopes)
    }

    /// The cone map with relaxed cones (Policarpo and Oliveira 2007). Each is so wide that a
    /// straight ray of the half-plane, which comes in from the largest radius and has entered the
    /// solid, leaves the solid no sooner than the cone. The time grows with the square of `rows`.
    pub fn relaxed(contour: &Contour, rows: u32) -> Result<Self> {
        Self::with(contour, rows, relaxed_slopes)
    }

    fn with(contour: &Contour, rows: u32, slopes: fn(&[DVec2]) -> Vec<f64>) -> Result<Self> {
        let surface = Surface::new(contour, rows.max(1) as usize)?;
        let up = slopes(&surface.points);
        let turned: Vec<DVec2> = surface
            .points
            .iter()
            .rev()
            .map(|p| DVec2::new(p.x, 1.0 - p.y))
            .collect();
        let mut down = slopes(&turned);
        down.reverse();
        // Rounded up by the rounding of radii and heights to 32-bit floats.
        let steep = |k: f64| (k * (1.0 + 1e-5)).min(STEEPEST) as f32;
        let row = |row: &Row| {
            let [g, g_next] = row.radii.map(|r| r as f32);
            if let Some(level) = row.level {
                let [lower, rest] = level.numbers(surface.reach);
                return [g, g_next, lower, rest];
            }
            let (low, high) = (row.first, row.first + 1);
            let k = |all: &[f64]| steep(all[low].max(all[high]));
            [g, g_next, k(&up), k(&down)]
        };
        Ok(Self {
            rows: surface.rows.iter().map(row).collect(),
            reach: surface.reach as f32,
        })
    }

    /// The table in the layout of `published/cone/cone_rows.glsl`.
    fn table(&self) -> SearchTable {
        SearchTable {
            vectors: self.rows.iter().map(|r| r.map(f32::to_bits)).collect(),
            before: 0,
            facts: [self.rows.len() as u32, self.reach.to_bits(), 0],
        }
    }
}

/// The steepest slope `dr / dz` from each point of a surface to one farther up (the points are
/// sorted); 0 if all slopes descend.
fn slopes(points: &[DVec2]) -> Vec<f64> {
    let slope = |i: usize, j: usize| {
        let way = points[j] - points[i];
        if way.y > 0.0 {
            way.x / way.y
        } else if way.x > 0.0 {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
        }
    };
    let mut all = vec![0.0; points.len()];
    // The upper hull of the points after `i`, nearest last: the steepest slope is that to its first
    // corner.
    let mut hull: Vec<usize> = Vec::new();
    for i in (0..points.len()).rev() {
        while let [.., far, near] = hull[..]
            && slope(i, near) <= slope(i, far)
        {
            hull.pop();
        }
        if let Some(&near) = hull.last() {
            all[i] = slope(i, near).max(0.0);
        }
        hull.push(i);
    }
    all
}

/// The steepest slope from each point of a surface to an exit farther up, for a ray that has
/// entered in between; 0 if all slopes descend. At an exit, `dr / dz` of the ray from the largest
/// radius over the point is greater than that of the surface.
fn relaxed_slopes(points: &[DVec2]) -> Vec<f64> {
    let top = points.iter().fold(0.0, |m: f64, p| m.max(p.x));
    let of = |(i, from): (usize, &DVec2)| {
        let mut steepest = 0.0f64;
        for side in points[i..].windows(2) {
            let along = side[1] - side[0];
            for end in side {
                let way = *end - *from;
                // The ray from (top, from.y) falls less than the side does.
                let comes_out = (end.x - top) * along.y > along.x * way.y;
                if way.y > 0.0 && comes_out {
                    steepest = steepest.max(way.x / way.y);
                }
            }
        }
        steepest
    };
    points.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests;
