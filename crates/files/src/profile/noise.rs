//! Noise of a picture, and the blur that removes it before the outline is traced.

use crate::trace::roughness;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;
use revmap::profile::Raster;

/// An outline that noise moves by this many texels (rms) or more is rough.
///
/// Measured on seven silhouettes at 128 to 512 rows: clean pictures, sharp or blurred, have at most
/// 0.002; JPEG has 0.005 or less at quality 95 and 0.006 or more at 70; Gaussian noise of 10 of 255
/// has 0.027 or more.
pub(super) const ROUGH: f64 = 0.005;
/// Pixels of blur for each texel of roughness. The blur spreads the noise without moving the points
/// less, so slopes are better in proportion to its width.
const RATIO: f64 = 20.0;
/// Least and largest blur that is chosen, pixels. The least one makes every edge wider than the
/// sums of coverage reach, so that all points of the outline are placed by interpolation: a mixture
/// leaves kinks. A wider one than the largest rounds corners more than noise moves them.
const CHOSEN: [f64; 2] = [1.25, 4.0];

/// Width of the Gaussian blur that removes noise from a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smooth {
    /// Standard deviation in pixels of the picture: 0 for none, at most
    /// [`ProfileOptions::MOST_SMOOTH`](super::ProfileOptions::MOST_SMOOTH).
    Pixels(f64),
    /// From the noise of the picture: 1.25 to 4 pixels, or none if the outline is not rough.
    Auto,
}

impl Default for Smooth {
    /// No blur.
    fn default() -> Self {
        Self::Pixels(0.0)
    }
}

impl Smooth {
    /// Blurs a picture's right half. `split`: the axis is the middle of column 0.
    pub(super) fn apply(self, raster: &mut Raster, split: bool) -> Result<()> {
        let pixels = match self {
            Self::Pixels(pixels) => pixels,
            Self::Auto => match roughness(raster, split) {
                rough if rough < ROUGH => 0.0,
                rough => (RATIO * rough).clamp(CHOSEN[0], CHOSEN[1]),
            },
        };
        if pixels > 0.0 {
            blur(raster, pixels, split)?;
        }
        Ok(())
    }
}

/// Blurs by a Gaussian. The blur continues the picture with its mirror image left of the axis, and
/// with its border pixels beyond the other borders.
fn blur(raster: &mut Raster, sigma: f64, split: bool) -> Result<()> {
    let reach = (3.0 * sigma).ceil() as isize;
    let weights: Vec<f32> = (-reach..=reach)
        .map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp() as f32)
        .collect();
    let total: f32 = weights.iter().sum();
    let (columns, rows) = (raster.columns as usize, raster.rows as usize);
    let pixels = raster.coverage.len();
    let mut across = host_memory::filled(pixels, 0.0f32, "the pixels of a blurred picture")?;
    let before = std::mem::take(&mut raster.coverage);
    let mirrored = |i: isize| match i {
        0.. => i as usize,
        _ if split => -i as usize,
        _ => (-i - 1) as usize,
    };
    across
        .par_chunks_mut(columns)
        .zip(before.par_chunks(columns))
        .for_each(|(out, line)| {
            for (i, value) in out.iter_mut().enumerate() {
                let at = |k: isize| line[mirrored(i as isize + k).min(columns - 1)];
                let sum: f32 = weights.iter().zip(-reach..).map(|(w, k)| w * at(k)).sum();
                *value = sum / total;
            }
        });
    let mut down = before;
    down.par_chunks_mut(columns)
        .enumerate()
        .for_each(|(j, out)| {
            out.fill(0.0);
            for (w, k) in weights.iter().zip(-reach..) {
                let row = (j as isize + k).clamp(0, rows as isize - 1) as usize;
                let line = &across[row * columns..][..columns];
                for (sum, value) in out.iter_mut().zip(line) {
                    *sum += w / total * value;
                }
            }
        });
    raster.coverage = down;
    Ok(())
}

#[cfg(test)]
mod tests;
