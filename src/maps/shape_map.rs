//! Shape maps: signed distances on a grid, baked from a profile, and sampled as the shaders do.

use super::nearest::for_each_texel;
use super::{MAX_SIDE, round_down};
use crate::error::{Error, ErrorKind, Result, content};
use crate::host_memory;
use crate::profile::{Bounds, Profile, Segment};
use glam::DVec2;
use std::fmt;
use std::hash::{Hash, Hasher};

/// A method that measures distances, plain data: the library's own is [`MapSource::EXACT`]. Other
/// crates bring methods for comparison. Two methods of one name are equal.
#[derive(Clone, Copy)]
pub struct MapSource {
    /// Name in options and files.
    pub name: &'static str,
    /// Measures a profile on a grid of `columns` x `rows` texels, laid out as in
    /// [`ShapeMap`](super::ShapeMap).
    pub measure: fn(profile: &Profile, columns: u32, rows: u32) -> Result<Measured>,
}

/// The signed distance at each texel's centre, object units, and the rectangle that the solid
/// occupies; `None` if the grid shows no solid.
pub type Measured = (Vec<f32>, Option<Bounds>);

impl MapSource {
    /// Exact distance to the outline's segments.
    pub const EXACT: Self = Self {
        name: "exact",
        measure: exact,
    };
}

impl Default for MapSource {
    fn default() -> Self {
        Self::EXACT
    }
}

impl PartialEq for MapSource {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for MapSource {}

impl Hash for MapSource {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl fmt::Debug for MapSource {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Options for baking a shape map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeOptions {
    /// The method that measures distances.
    pub source: MapSource,
    /// Rows of the map: one object unit is this many texels.
    pub rows: u32,
    /// The map covers `0 <= r <= reach`, object units; at least the profile's radius. A larger
    /// reach is needed for solids that extend past their cylinder: polygons wider than their box,
    /// offsets, an axis off the middle.
    pub reach: f64,
}

impl BakeOptions {
    /// Options for `rows` rows over the profile's own box.
    #[must_use]
    pub fn new(source: MapSource, rows: u32) -> Self {
        Self {
            source,
            rows,
            reach: 0.0,
        }
    }
}

/// Signed distances to the profile's boundary on a grid of square texels.
///
/// Texel `(i, j)` is sampled at `r = (i + 0.5) h`, `z = 1 - (j + 0.5) h`, with `h = 1 / rows`: row
/// 0 is the top.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeMap {
    /// Texels along `r`.
    pub columns: u32,
    /// Texels along `z`.
    pub rows: u32,
    /// `R` of the shape box, object units (the map may reach farther).
    pub radius: f64,
    /// The method that measured the distances.
    pub source: MapSource,
    /// Signed distance in object units, positive outside; row by row from the top.
    pub distance: Vec<f32>,
    /// True for texels whose centre is solid; row by row from the top.
    pub form: Vec<bool>,
    /// The part of the half-plane that the solid occupies.
    pub bounds: Bounds,
}

impl ShapeMap {
    /// Measures the signed distances to a profile's boundary on a grid of `options.rows` rows.
    ///
    /// The map covers `0 <= z <= 1` and `0 <= r <= max(R, reach)`, rounded up to whole texels. The
    /// axis is not a boundary.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: rows outside 2 ..= 16384, a reach that is not finite or leads to
    /// more than 16384 columns, a shape that leaves no texel solid. [`ErrorKind::OutOfHostMemory`].
    pub fn bake(profile: &Profile, options: &BakeOptions) -> Result<Self> {
        let BakeOptions {
            source,
            rows,
            reach,
        } = *options;
        let wrong = |message: String| content("map_rows", message);
        if !(2..=MAX_SIDE).contains(&rows) {
            return wrong(format!("{rows} rows; give 2 to {MAX_SIDE}"));
        }
        if !reach.is_finite() {
            let message = format!("the map cannot reach to {reach}; give a finite radius");
            return Err(Error::new(ErrorKind::Content, message));
        }
        // Slightly less, so that a radius of columns / rows is not rounded up to one more column.
        let wanted = (reach.max(profile.radius) * f64::from(rows) - 1e-6)
            .ceil()
            .max(2.0);
        if wanted > f64::from(MAX_SIDE) {
            return wrong(format!(
                "the map would have {wanted} columns, {MAX_SIDE} is the most; take fewer rows or a narrower shape"
            ));
        }
        let columns = wanted as u32;
        let (distance, Some(bounds)) = (source.measure)(profile, columns, rows)? else {
            return wrong(format!(
                "at {rows} rows the shape covers no texel; take more rows or a thicker shape"
            ));
        };
        let form = distance.iter().map(|&d| d <= 0.0);
        let form = host_memory::collected(form, "the form of a map")?;
        Ok(Self {
            columns,
            rows,
            radius: profile.radius,
            source,
            distance,
            form,
            bounds,
        })
    }

    /// `h`: the side of a texel, object units.
    #[must_use]
    pub fn texel(&self) -> f64 {
        1.0 / f64::from(self.rows)
    }

    /// Largest `r` that the map covers: `0 <= r <= reach`.
    #[must_use]
    pub fn reach(&self) -> f64 {
        f64::from(self.columns) / f64::from(self.rows)
    }

    /// The signed distance at `(r, z)`, object units: bilinear between texels, as the shaders read
    /// it.
    ///
    /// Outside the map, let `c` be the nearest point of its rectangle and `l` the distance to it.
    /// The result is `sqrt(d(c)^2 + l^2)`, which never exceeds the distance to a solid within the
    /// rectangle. If `d(c)` is negative, the result is `d(c) + l`. Negative `r` is the mirrored
    /// half.
    #[must_use]
    pub fn distance_at(&self, r: f64, z: f64) -> f64 {
        let p = DVec2::new(r.abs(), z);
        let c = p.clamp(DVec2::ZERO, DVec2::new(self.reach(), 1.0));
        let d = self.bilinear(c.x, c.y);
        let beyond = (p - c).length();
        if d > 0.0 { d.hypot(beyond) } else { d + beyond }
    }

    /// The derivative `(dD/dr, dD/dz)` of the bilinear cell that contains `(r, z)`, not normalised.
    /// Its length is 1 if the distances around are exact and have the same nearest point of the
    /// surface.
    #[must_use]
    pub fn gradient_at(&self, r: f64, z: f64) -> [f64; 2] {
        let (cell, x, y) = self.cell(r, z);
        let [[a, b], [c, d]] = cell;
        let side = f64::from(self.rows);
        let across = (b - a) * (1.0 - y) + (d - c) * y;
        let down = (c - a) * (1.0 - x) + (d - b) * x;
        [across * side, -down * side]
    }

    fn bilinear(&self, r: f64, z: f64) -> f64 {
        let ([[a, b], [c, d]], x, y) = self.cell(r, z);
        let mix = |p: f64, q: f64, t: f64| p + (q - p) * t;
        mix(mix(a, b, x), mix(c, d, x), y)
    }

    /// The four texels around a point (`[row][column]`) and the point's position between them;
    /// texels beyond the border repeat.
    fn cell(&self, r: f64, z: f64) -> ([[f64; 2]; 2], f64, f64) {
        let side = f64::from(self.rows);
        let (u, v) = (r * side - 0.5, (1.0 - z) * side - 0.5);
        let (x, y) = (u.floor(), v.floor());
        let texel = |i: f64, j: f64| {
            let i = i.clamp(0.0, f64::from(self.columns - 1)) as usize;
            let j = j.clamp(0.0, f64::from(self.rows - 1)) as usize;
            f64::from(self.distance[j * self.columns as usize + i])
        };
        let row = |j: f64| [texel(x, j), texel(x + 1.0, j)];
        ([row(y), row(y + 1.0)], u - x, v - y)
    }
}

/// Signed distance of each texel's centre to the outline's surface, object units, never greater
/// than the true distance.
fn exact(profile: &Profile, columns: u32, rows: u32) -> Result<Measured> {
    let outline = &profile.outline;
    let (columns, rows) = (columns as usize, rows as usize);
    let segments: Vec<Segment> = outline.surface_segments().collect();
    let heights = (0..rows).map(|row| 1.0 - (row as f64 + 0.5) / rows as f64);
    // The solid is between an odd and the next even crossing of a row.
    let crossings = outline.crossings(heights);
    let distances = for_each_texel(&segments, [columns, rows], |column, row, distance, _| {
        let r = (column as f64 + 0.5) / rows as f64;
        let inside = crossings[row].partition_point(|&c| c <= r) % 2 == 1;
        round_down(if inside { -distance } else { distance })
    })?;
    Ok((distances, outline.bounds()))
}
