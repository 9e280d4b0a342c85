//! Outlines as pixels, and changes of their resolution.

mod area;

pub use area::rasterize;

use crate::trace;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;
use revmap::maps::Bounds;
use revmap::profile::{Profile, Raster};

/// What needs memory, in messages.
const PIXELS: &str = "the pixels of an outline";

/// Coverage on another grid of square pixels, `rows` to the object unit. Each new pixel is the
/// mean, by area, of the old pixels that it covers. Everything beyond the picture is empty.
///
/// # Errors
/// [`ErrorKind::OutOfHostMemory`](revmap::error::ErrorKind::OutOfHostMemory).
pub fn resample(raster: &Raster, columns: u32, rows: u32) -> Result<Raster> {
    let pixels = columns as usize * rows as usize;
    let mut coverage = host_memory::filled(pixels, 0.0, PIXELS)?;
    if coverage.is_empty() || raster.coverage.is_empty() {
        return Ok(Raster {
            columns,
            rows,
            coverage,
        });
    }
    let (width, ratio) = (
        raster.columns as usize,
        f64::from(raster.rows) / f64::from(rows),
    );
    let rows_of = |row| covered(row, ratio, raster.rows as usize);
    let lines = coverage.par_chunks_mut(columns as usize).enumerate();
    lines.for_each(|(row, out)| {
        // First the rows of the old grid, then intervals of their sums.
        let mut sums = vec![0.0f64; width];
        for (row, weight) in rows_of(row) {
            let line = &raster.coverage[row * width..][..width];
            for (sum, &c) in sums.iter_mut().zip(line) {
                *sum += weight * f64::from(c);
            }
        }
        for (column, value) in out.iter_mut().enumerate() {
            let parts = covered(column, ratio, width);
            let sum: f64 = parts.map(|(c, weight)| weight * sums[c]).sum();
            *value = (sum / (ratio * ratio)).clamp(0.0, 1.0) as f32;
        }
    });
    Ok(Raster {
        columns,
        rows,
        coverage,
    })
}

/// Coverage in `levels` even steps, as a picture stores it: 256 for 8 bits, 2 for a binary
/// picture (solid if over one half).
#[must_use]
pub fn with_levels(mut raster: Raster, levels: u16) -> Raster {
    let most = f32::from(levels.max(2) - 1);
    for c in &mut raster.coverage {
        *c = (*c * most - 0.5).ceil().max(0.0) / most;
    }
    raster
}

/// The profile that is read from a picture of another one: `columns` x `rows` pixels in `levels`
/// greys. Its box keeps its radius.
///
/// # Errors
/// The errors of [`trace`](crate::trace()).
pub fn pictured(profile: &Profile, columns: u32, rows: u32, levels: u16) -> Result<Profile> {
    let seen = rasterize(&profile.outline, columns, rows)?;
    Ok(Profile {
        radius: profile.radius,
        ..trace(with_levels(seen, levels))?
    })
}

/// The rectangle of pixels more than half solid, one pixel wider all round where the picture
/// allows. It contains every edge that the picture can represent. `None` for an empty raster.
#[must_use]
pub(crate) fn bounds(raster: &Raster) -> Option<Bounds> {
    let (width, side) = (raster.columns as usize, f64::from(raster.rows));
    let mut found: Option<[usize; 4]> = None;
    for (row, line) in raster.coverage.chunks_exact(width.max(1)).enumerate() {
        let solid = |c: &f32| *c > 0.5;
        if let (Some(first), Some(last)) =
            (line.iter().position(solid), line.iter().rposition(solid))
        {
            let [left, right, top, _] = found.unwrap_or([first, last, row, row]);
            found = Some([left.min(first), right.max(last), top, row]);
        }
    }
    let [left, right, top, bottom] = found?;
    Some(Bounds {
        r_min: left.saturating_sub(1) as f64 / side,
        r_max: (right + 2).min(width) as f64 / side,
        z_min: (1.0 - (bottom + 2) as f64 / side).max(0.0),
        z_max: 1.0 - top.saturating_sub(1) as f64 / side,
    })
}

/// The old pixels, of a line of `length`, that pixel `k` of the new line covers, each with the
/// covered part of it. A new pixel is `ratio` old ones long.
fn covered(k: usize, ratio: f64, length: usize) -> impl Iterator<Item = (usize, f64)> {
    let [from, to] = [k, k + 1].map(|k| (k as f64 * ratio).min(length as f64));
    let touched = from as usize..to.ceil().max(from) as usize;
    touched.filter_map(move |k| {
        let part = to.min(k as f64 + 1.0) - from.max(k as f64);
        (part > 0.0).then_some((k, part))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn ramp() -> Raster {
        Raster {
            columns: 6,
            rows: 4,
            coverage: (0..24).map(|k| (k % 7) as f32 / 7.0).collect(),
        }
    }

    #[test]
    fn area_is_kept_at_every_resolution() {
        let r = ramp();
        let total = |r: &Raster| {
            r.coverage.iter().map(|&c| f64::from(c)).sum::<f64>() / f64::from(r.rows).powi(2)
        };
        assert_eq!(resample(&r, 6, 4).unwrap(), r);
        for rows in [1, 3, 5, 8, 10, 17, 64] {
            // Wide enough for the whole picture, and beyond it.
            let resampled = resample(&r, rows * 2, rows).unwrap();
            assert!((total(&resampled) - total(&r)).abs() < 1e-6, "{rows}");
        }
        let double = resample(&r, 12, 8).unwrap();
        assert_eq!(double.coverage[13], r.coverage[0]);
        assert_eq!(double.coverage[14], r.coverage[1]);
    }

    #[test]
    fn bounds_surround_the_solid() {
        let mut r = Raster {
            columns: 8,
            rows: 8,
            coverage: vec![0.2; 64],
        };
        assert_eq!(bounds(&r), None);
        r.coverage[3 * 8 + 2] = 0.9;
        r.coverage[5 * 8 + 7] = 0.6;
        let b = bounds(&r);
        let expected = Bounds {
            r_min: 0.125,
            r_max: 1.0,
            z_min: 0.125,
            z_max: 0.75,
        };
        assert_eq!(b, Some(expected));
    }
}
