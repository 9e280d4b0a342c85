//! Displacement maps: the slopes of a height map, computed once and scaled when the picture is
//! drawn (Blinn 1978).

use super::half::to_half;
use super::halving;
use crate::error::{Error, ErrorKind, Result};
use rayon::prelude::*;

/// A level of a mip chain, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Level<T> {
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// `width * height` texels, row by row from the top.
    pub texels: Vec<T>,
}

/// The filter that computes slopes from heights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlopeFilter {
    /// Difference of the two neighbours: the sharpest, `[-1 0 1] / 2`.
    Central,
    /// Difference of the two neighbours, smoothed across by `[3 10 3] / 16` (Scharr 2000), which
    /// treats all directions alike.
    #[default]
    Scharr,
}

/// Partial derivatives of a height map over texture coordinates, with mip levels.
///
/// Heights are `H` in `[0, 1]`. A texel holds `(dH/du, dH/dv)` per unit of texture coordinate. `u`
/// runs to the right over the whole width, `v` upwards over the whole height (`v = 1` is the top
/// row). The map repeats, so differences wrap round its borders, and the sum over each level is 0.
/// Smaller levels hold means: the slope of the smoothed heights.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacementMap {
    /// Levels from the full size down to 1 x 1.
    pub levels: Vec<Level<[f32; 2]>>,
}

impl DisplacementMap {
    /// Computes the slopes of heights in `[0, 1]`, row by row from the top.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: no texels, or not `width * height` of them, or a height that is not
    /// finite.
    pub fn from_heights(
        width: u32,
        height: u32,
        heights: &[f32],
        filter: SlopeFilter,
    ) -> Result<Self> {
        let (w, h) = (width as usize, height as usize);
        check_count("heights", heights.len(), width, height)?;
        if let Some(k) = heights.iter().position(|v| !v.is_finite()) {
            let message = format!("height {k} is not finite; give numbers from 0 to 1");
            return Err(Error::new(ErrorKind::Content, message));
        }
        let across = match filter {
            SlopeFilter::Central => [0.0, 1.0, 0.0],
            SlopeFilter::Scharr => [3.0 / 16.0, 10.0 / 16.0, 3.0 / 16.0],
        };
        let mut slopes = vec![[0.0f32; 2]; w * h];
        slopes.par_chunks_mut(w).enumerate().for_each(|(row, out)| {
            // A picture's next row is lower, towards smaller v.
            let rows = [(row + h - 1) % h, row, (row + 1) % h].map(|j| &heights[j * w..][..w]);
            for (column, slope) in out.iter_mut().enumerate() {
                let columns = [(column + w - 1) % w, column, (column + 1) % w];
                let (mut du, mut dv) = (0.0, 0.0);
                for (weight, k) in across.iter().zip(0..) {
                    du += weight * (rows[k][columns[2]] - rows[k][columns[0]]);
                    dv += weight * (rows[0][columns[k]] - rows[2][columns[k]]);
                }
                *slope = [0.5 * du * width as f32, 0.5 * dv * height as f32];
            }
        });
        Self::from_slopes(width, height, slopes)
    }

    /// Texels across and down of the full size.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.levels.first().map_or([0, 0], |l| [l.width, l.height])
    }

    /// The levels as `R16G16_SFLOAT` texels, native byte order, each rounded to the nearest half
    /// float.
    #[must_use]
    pub fn encode(&self) -> Vec<Level<[u16; 2]>> {
        let pack = |t: &[f32; 2]| t.map(to_half);
        self.levels
            .iter()
            .map(|l| Level {
                width: l.width,
                height: l.height,
                texels: l.texels.iter().map(pack).collect(),
            })
            .collect()
    }

    /// Bytes of the full size, and of all levels, as [`DisplacementMap::encode`] gives them.
    #[must_use]
    pub fn encoded_bytes(&self) -> [usize; 2] {
        let bytes = |l: &Level<[f32; 2]>| l.texels.len() * 4;
        [
            self.levels.first().map_or(0, bytes),
            self.levels.iter().map(bytes).sum(),
        ]
    }

    /// A map of known slopes, row by row from the top.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: no texels, or not `width * height` of them.
    pub fn from_slopes(width: u32, height: u32, slopes: Vec<[f32; 2]>) -> Result<Self> {
        check_count("slopes", slopes.len(), width, height)?;
        Ok(Self {
            levels: levels(width, height, slopes, |texel| *texel),
        })
    }
}

/// Refuses a list that does not hold one value for each texel.
pub(super) fn check_count(what: &str, count: usize, width: u32, height: u32) -> Result<()> {
    if count > 0 && count == width as usize * height as usize {
        return Ok(());
    }
    Err(Error::new(
        ErrorKind::Content,
        format!("{count} {what} for {width} x {height} texels; give as many as there are texels"),
    ))
}

/// The mip chain of a picture, each texel turned into its stored form by `stored`.
pub(super) fn levels<const N: usize, T>(
    width: u32,
    height: u32,
    texels: Vec<[f32; N]>,
    stored: impl Fn(&[f32; N]) -> T,
) -> Vec<Level<T>> {
    halving::chain(width as usize, height as usize, texels)
        .into_iter()
        .map(|(w, h, texels)| Level {
            width: w as u32,
            height: h as u32,
            texels: texels.iter().map(&stored).collect(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::f32::consts::TAU;

    fn waves(width: u32, height: u32, filter: SlopeFilter) -> DisplacementMap {
        let heights: Vec<f32> = (0..width * height)
            .map(|k| {
                let u = ((k % width) as f32 + 0.5) / width as f32;
                let v = 1.0 - ((k / width) as f32 + 0.5) / height as f32;
                0.5 + 0.2 * (TAU * 2.0 * u).sin() + 0.1 * (TAU * 3.0 * v).sin()
            })
            .collect();
        DisplacementMap::from_heights(width, height, &heights, filter).unwrap()
    }

    #[test]
    fn slopes_of_waves_in_both_directions() {
        for filter in [SlopeFilter::Central, SlopeFilter::Scharr] {
            let map = waves(256, 128, filter);
            for (k, &[du, dv]) in map.levels[0].texels.iter().enumerate() {
                let u = ((k % 256) as f32 + 0.5) / 256.0;
                let v = 1.0 - ((k / 256) as f32 + 0.5) / 128.0;
                let (eu, ev) = (
                    0.2 * TAU * 2.0 * (TAU * 2.0 * u).cos(),
                    0.1 * TAU * 3.0 * (TAU * 3.0 * v).cos(),
                );
                // The second-order error is (k h)^2 / 6 of the slope; smoothing across adds as much
                // again.
                assert!(
                    (du - eu).abs() < 0.01 && (dv - ev).abs() < 0.015,
                    "{filter:?} {k}"
                );
            }
        }
    }

    #[test]
    fn a_chain_down_to_one_texel_whose_mean_is_flat() {
        let map = waves(96, 40, SlopeFilter::Scharr);
        assert_eq!(map.levels.len(), 7);
        let last = map.levels.last().unwrap();
        assert!(
            last.texels[0].iter().all(|v| v.abs() < 1e-4),
            "wrapping differences cancel"
        );
        assert_eq!(map.encode()[3].texels.len(), 12 * 5);
    }

    #[test]
    fn memory_is_what_the_papers_claim() {
        assert_eq!(
            waves(512, 512, SlopeFilter::Scharr).encoded_bytes(),
            [1 << 20, 1_398_100]
        );
        assert!(waves(1024, 1024, SlopeFilter::Scharr).encoded_bytes()[0] <= 4 << 20);
    }

    #[test]
    fn faults_are_named() {
        let text = |e: Result<DisplacementMap>| e.unwrap_err().to_string();
        let new = |w, h, v: &[f32]| DisplacementMap::from_heights(w, h, v, SlopeFilter::Central);
        assert!(text(new(2, 2, &[0.0; 3])).contains("3 heights"));
        assert!(text(new(0, 0, &[])).contains("0 heights"));
        assert!(text(new(2, 1, &[0.0, f32::NAN])).contains("height 1"));
    }
}
