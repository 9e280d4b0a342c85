//! Bakes a shape map, and samples it as the shaders do.

use super::{BakeOptions, MAX_SIDE, MapSource, ShapeMap};
use crate::error::{Error, ErrorKind, Result};
use crate::profile::Profile;
use glam::DVec2;

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

impl ShapeMap {
    /// Measures the signed distances to a profile's boundary on a grid of `options.rows` rows.
    ///
    /// The map covers `0 <= z <= 1` and `0 <= r <= max(R, reach)`, rounded up to whole texels. The
    /// axis is not a boundary.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: rows outside 2 ..= 16384, a reach that is not finite or leads to
    /// more than 16384 columns, a shape that leaves no texel solid.
    pub fn bake(profile: &Profile, options: &BakeOptions) -> Result<Self> {
        let BakeOptions {
            source,
            rows,
            reach,
        } = *options;
        let fault = |message: String| Error::new(ErrorKind::Content, message);
        if !(2..=MAX_SIDE).contains(&rows) {
            return Err(fault(format!("{rows} rows; give 2 to {MAX_SIDE}")).at_key("map_rows"));
        }
        if !reach.is_finite() {
            return Err(fault(format!(
                "the map cannot reach to {reach}; give a finite radius"
            )));
        }
        // Slightly less, so that a radius of columns / rows is not rounded up to one more column.
        let wanted = (reach.max(profile.radius) * f64::from(rows) - 1e-6)
            .ceil()
            .max(2.0);
        if wanted > f64::from(MAX_SIDE) {
            return Err(fault(format!(
                "the map would have {wanted} columns, {MAX_SIDE} is the most; take fewer rows or a narrower shape"
            ))
            .at_key("map_rows"));
        }
        let columns = wanted as u32;
        let (distance, Some(bounds)) = (source.measure)(profile, columns, rows) else {
            return Err(fault(format!(
                "at {rows} rows the shape covers no texel; take more rows or a thicker shape"
            ))
            .at_key("map_rows"));
        };
        let form = distance.iter().map(|&d| d <= 0.0).collect();
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
