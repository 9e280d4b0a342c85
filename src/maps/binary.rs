//! The papers' distances: between the centres of pixels of a binary image.

use super::rounding::round_down;
use super::transform::{NONE, Surroundings, squared_to_other};
use crate::profile::Raster;
use rayon::prelude::*;

/// Signed distance of each texel's centre, object units. Outside: to the nearest solid texel's
/// centre, as in the papers. The papers store nothing inside. There the same slope is continued
/// through the same zero: one texel less than the distance to the nearest empty texel's centre,
/// negative. Everything beyond the right, top and bottom borders is empty; the axis at the left is
/// not a boundary.
pub(super) fn distances(raster: &Raster) -> Vec<f32> {
    let form: Vec<bool> = raster.coverage.par_iter().map(|&c| c > 0.5).collect();
    let around = Surroundings {
        left: false,
        others: true,
    };
    let squared = squared_to_other(&form, raster.columns as usize, around);
    let texel = 1.0 / f64::from(raster.rows);
    squared
        .par_iter()
        .zip(&form)
        .map(|(&squared, &solid)| {
            let distance = if squared == NONE {
                f64::INFINITY
            } else {
                f64::from(squared).sqrt()
            };
            round_down(if solid {
                (1.0 - distance) * texel
            } else {
                distance * texel
            })
        })
        .collect()
}
