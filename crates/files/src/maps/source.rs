//! Distances that are measured in pixels, for comparison with the papers.

use super::transform::{NONE, squared_to_other};
use crate::raster::{bounds, rasterize, resample, with_levels};
use crate::trace::outline;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;
use revmap::maps::{MapSource, Measured, round_down};
use revmap::profile::{Profile, Raster};
use std::borrow::Cow;

/// What needs memory, in messages.
const MAP: &str = "the distances of a map";

/// The papers' source: exact Euclidean distance between the centres of a binary image's texels.
///
/// A texel is solid if more than half of it is covered: by the picture's pixels if the profile has
/// them, otherwise by the outline. A grid that shows no solid texel is refused.
pub const BINARY: MapSource = MapSource {
    name: "binary",
    measure: binary,
};

/// Distance to the outline of an anti-aliased picture of the map's own size: the outline is
/// rasterised to 8 bits of coverage and traced again.
pub const COVERAGE: MapSource = MapSource {
    name: "coverage",
    measure: coverage,
};

/// All sources of distance, with their names in options and files.
pub const MAP_SOURCES: [(&str, MapSource); 3] = [
    (BINARY.name, BINARY),
    (COVERAGE.name, COVERAGE),
    (MapSource::EXACT.name, MapSource::EXACT),
];

fn coverage(profile: &Profile, columns: u32, rows: u32) -> Result<Measured> {
    let seen = with_levels(rasterize(&profile.outline, columns, rows)?, 256);
    let traced = Profile::new(outline(&seen), profile.radius);
    (MapSource::EXACT.measure)(&traced, columns, rows)
}

fn binary(profile: &Profile, columns: u32, rows: u32) -> Result<Measured> {
    let raster = match &profile.raster {
        Some(r) if (r.columns, r.rows) == (columns, rows) => Cow::Borrowed(r),
        Some(r) => Cow::Owned(resample(r, columns, rows)?),
        None => Cow::Owned(rasterize(&profile.outline, columns, rows)?),
    };
    Ok((binary_distances(&raster)?, bounds(&raster)))
}

/// Signed distance of each texel's centre, object units. Outside: to the nearest solid texel's
/// centre, as in the papers. The papers store nothing inside. There the same slope is continued
/// through the same zero: one texel less than the distance to the nearest empty texel's centre,
/// negative. Everything beyond the right, top and bottom borders is empty; the axis at the left is
/// not a boundary.
pub(super) fn binary_distances(raster: &Raster) -> Result<Vec<f32>> {
    let form = raster.coverage.iter().map(|&c| c > 0.5);
    let form: Vec<bool> = host_memory::collected(form, MAP)?;
    let squared = squared_to_other(&form, raster.columns as usize)?;
    let texel = 1.0 / f64::from(raster.rows);
    let signed = |squared: u32, solid: bool| {
        let distance = match squared {
            NONE => f64::INFINITY,
            squared => f64::from(squared).sqrt(),
        };
        round_down(if solid { 1.0 - distance } else { distance } * texel)
    };
    let mut out = host_memory::filled(form.len(), 0.0, MAP)?;
    let each = out.par_iter_mut().zip(&squared).zip(&form);
    each.for_each(|((out, &squared), &solid)| *out = signed(squared, solid));
    Ok(out)
}
