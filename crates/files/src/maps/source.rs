//! Distances that are measured in pixels, for comparison with the papers.

use crate::raster::{bounds, rasterize, resample, with_levels};
use crate::trace::outline;
use image::{GrayImage, Luma};
use imageproc::distance_transform::euclidean_squared_distance_transform;
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
    let squared = squared_to_other(&form, raster.columns as usize);
    let texel = 1.0 / f64::from(raster.rows);
    let signed = |(squared, solid): (f64, &bool)| {
        let distance = squared.sqrt();
        round_down(if *solid { 1.0 - distance } else { distance } * texel)
    };
    host_memory::collected(squared.zip(&form).map(signed), MAP)
}

/// The squared distance, in texels, from the centre of each texel of `form` (row by row, `columns`
/// to the row) to the nearest centre of the other value; infinite if there is none (Felzenszwalb &
/// Huttenlocher 2012). Empty texels continue beyond the right, upper and lower borders.
fn squared_to_other(form: &[bool], columns: usize) -> impl ExactSizeIterator<Item = f64> {
    let rows = form.len() / columns;
    let to = |wanted: bool| {
        // With a rim of empty texels beyond those borders.
        let at = |x: u32, y: u32| {
            let inside = (x as usize) < columns && (1..=rows).contains(&(y as usize));
            let solid = inside && form[(y as usize - 1) * columns + x as usize];
            Luma([u8::from(solid == wanted)])
        };
        let image = GrayImage::from_fn(columns as u32 + 1, rows as u32 + 2, at);
        euclidean_squared_distance_transform(&image)
    };
    let (solid, empty) = rayon::join(|| to(true), || to(false));
    (0..form.len()).map(move |k| {
        let distances = if form[k] { &empty } else { &solid };
        distances.get_pixel((k % columns) as u32, (k / columns) as u32 + 1)[0]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_force(form: &[bool], columns: i64) -> Vec<f64> {
        let rows = form.len() as i64 / columns;
        let place = |k: usize| (k as i64 % columns, k as i64 / columns);
        let solid = |x: i64, y: i64| {
            x < columns && (0..rows).contains(&y) && form[(y * columns + x) as usize]
        };
        let one = |k: usize| {
            let (x, y) = place(k);
            // Nothing counts left of the axis.
            let all = (0..=columns).flat_map(|u| (-1..=rows).map(move |v| (u, v)));
            let other = all.filter(|&(u, v)| solid(u, v) != form[k]);
            other
                .map(|(u, v)| ((u - x).pow(2) + (v - y).pow(2)) as f64)
                .fold(f64::INFINITY, f64::min)
        };
        (0..form.len()).map(one).collect()
    }

    proptest! {
        #[test]
        fn distances_equal_brute_force(
            columns in 1usize..24,
            density in 0.0f64..1.0,
            noise in prop::collection::vec(0.0f64..1.0, 1..400),
        ) {
            let count = noise.len().next_multiple_of(columns);
            let form: Vec<bool> =
                (0..count).map(|k| noise[k % noise.len()] < density * density).collect();
            let found: Vec<f64> = squared_to_other(&form, columns).collect();
            prop_assert_eq!(found, brute_force(&form, columns as i64));
        }
    }

    #[test]
    fn long_distances_are_exact() {
        let mut form = vec![false; 90_000];
        form[0] = true;
        let last = squared_to_other(&form, 30_000).last();
        assert_eq!(last, Some(29_999.0 * 29_999.0 + 4.0));
    }
}
