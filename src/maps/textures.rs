//! Textures of surfaces: colours, and the slopes of a height map, which are computed once and scaled
//! when the picture is drawn (Blinn 1978).

use super::mips::{self, Level, check_count};
use super::rounding::to_half;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::{linear_from_srgb, srgb_from_linear};
use crate::host_memory::{collected, filled};
use rayon::prelude::*;

/// A texture of colours, `R8G8B8A8_SRGB`, row 0 (`v = 1`) on top.
///
/// Smaller levels hold the mean light of the texels that they cover, weighted by alpha, so that
/// transparent texels add no colour to their neighbours. Drawing makes no use of alpha: a map with
/// transparent texels is first laid over the object's colour by [`ColorMap::over`].
#[derive(Clone, Debug, PartialEq)]
pub struct ColorMap {
    /// Levels from the full size down to 1 x 1.
    pub levels: Vec<Level<[u8; 4]>>,
}

impl ColorMap {
    /// Builds a map from sRGB texels with straight (not premultiplied) alpha, row by row from the
    /// top.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: no texels, or not `width * height` of them.
    /// [`ErrorKind::OutOfHostMemory`].
    pub fn from_texels(width: u32, height: u32, texels: Vec<[u8; 4]>) -> Result<Self> {
        check_count("colours", texels.len(), width, height)?;
        let linear: Vec<f32> = (0..=255u8).map(light_of_byte).collect();
        let premultiplied = |&[r, g, b, a]: &[u8; 4]| {
            let alpha = f32::from(a) / 255.0;
            let [r, g, b] = [r, g, b].map(|v| linear[usize::from(v)] * alpha);
            [r, g, b, alpha]
        };
        let light = collected(texels.iter().map(premultiplied), "the light of a texture")?;
        // The full size is stored unchanged, including the colours of transparent texels.
        let full = Level {
            width,
            height,
            texels,
        };
        Self::with_smaller(full, light)
    }

    /// Levels of a full size with this light.
    fn with_smaller(full: Level<[u8; 4]>, light: Vec<[f32; 4]>) -> Result<Self> {
        let light = mips::chain(full.width, full.height, light)?;
        let smaller = light[1..].iter().map(|level| level.map(from_light));
        let levels: Result<_> = std::iter::once(Ok(full)).chain(smaller).collect();
        Ok(Self { levels: levels? })
    }

    /// Returns true if no texel is transparent.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        let mut texels = self.levels.iter().take(1).flat_map(|level| &level.texels);
        texels.all(|texel| texel[3] == u8::MAX)
    }

    /// The opaque map that shows `color`, linear RGB from 0 to 1, where this map is transparent.
    ///
    /// # Errors
    /// [`ErrorKind::OutOfHostMemory`].
    pub fn over(&self, color: [f32; 3]) -> Result<Self> {
        let linear: Vec<f32> = (0..=255u8).map(light_of_byte).collect();
        let opaque = |&[r, g, b, a]: &[u8; 4]| {
            let alpha = f32::from(a) / 255.0;
            let light = |own: u8, below: f32| {
                linear[usize::from(own)] * alpha + below.clamp(0.0, 1.0) * (1.0 - alpha)
            };
            let [below_r, below_g, below_b] = color;
            [light(r, below_r), light(g, below_g), light(b, below_b), 1.0]
        };
        let Some(full) = self.levels.first() else {
            return Ok(self.clone());
        };
        let light = full.map(opaque)?;
        Self::with_smaller(light.map(from_light)?, light.texels)
    }

    /// Texels across and down of the full size.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        mips::size(&self.levels)
    }
}

/// Linear light of an sRGB value.
fn light_of_byte(v: u8) -> f32 {
    linear_from_srgb(f64::from(v) / 255.0) as f32
}

/// The sRGB texel of premultiplied linear light.
fn from_light(&[r, g, b, a]: &[f32; 4]) -> [u8; 4] {
    let encode = |v: f32| {
        let v = if a > 0.0 { v / a } else { 0.0 };
        (srgb_from_linear(f64::from(v)) * 255.0).round() as u8
    };
    [encode(r), encode(g), encode(b), (a * 255.0).round() as u8]
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
        let mut slopes = filled(w * h, [0.0f32; 2], "the slopes of a height map")?;
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
        mips::size(&self.levels)
    }

    /// The levels as `R16G16_SFLOAT` texels, native byte order, each rounded to the nearest half
    /// float.
    ///
    /// # Errors
    /// [`ErrorKind::OutOfHostMemory`].
    pub fn encode(&self) -> Result<Vec<Level<[u16; 2]>>> {
        let pack = |texel: &[f32; 2]| texel.map(to_half);
        self.levels.iter().map(|level| level.map(pack)).collect()
    }

    /// A map of known slopes, row by row from the top.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: no texels, or not `width * height` of them.
    pub fn from_slopes(width: u32, height: u32, slopes: Vec<[f32; 2]>) -> Result<Self> {
        check_count("slopes", slopes.len(), width, height)?;
        let levels = mips::chain(width, height, slopes)?;
        Ok(Self { levels })
    }
}

#[cfg(test)]
mod tests {
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
                let eu = 0.2 * TAU * 2.0 * (TAU * 2.0 * u).cos();
                let ev = 0.1 * TAU * 3.0 * (TAU * 3.0 * v).cos();
                // The second-order error is (k h)^2 / 6 of the slope; smoothing across adds as much
                // again.
                let near = (du - eu).abs() < 0.01 && (dv - ev).abs() < 0.015;
                assert!(near, "{filter:?} {k}");
            }
        }
    }

    /// The papers claim this memory.
    #[test]
    fn a_chain_down_to_one_texel_whose_mean_is_flat() {
        let map = waves(512, 512, SlopeFilter::Scharr);
        let bytes = |l: &Level<[u16; 2]>| size_of_val(&l.texels[..]);
        let levels = map.encode().unwrap();
        assert_eq!(bytes(&levels[0]), 1 << 20);
        assert_eq!(levels.iter().map(bytes).sum::<usize>(), 1_398_100);
        let map = waves(96, 40, SlopeFilter::Scharr);
        assert_eq!(map.levels.len(), 7);
        // Differences that wrap round cancel.
        let last = map.levels[6].texels[0];
        assert!(last.iter().all(|v| v.abs() < 1e-4));
        assert_eq!(map.encode().unwrap()[3].texels.len(), 12 * 5);
    }

    #[test]
    fn faults_are_named() {
        let text = |e: Result<DisplacementMap>| e.unwrap_err().to_string();
        let new = |w, h, v: &[f32]| DisplacementMap::from_heights(w, h, v, SlopeFilter::Central);
        assert!(text(new(2, 2, &[0.0; 3])).contains("3 heights"));
        assert!(text(new(0, 0, &[])).contains("0 heights"));
        assert!(text(new(2, 1, &[0.0, f32::NAN])).contains("height 1"));
        let colors = ColorMap::from_texels(2, 2, vec![[0; 4]; 3]).unwrap_err();
        assert!(colors.to_string().contains("3 colours"));
    }

    #[test]
    fn every_value_survives_the_way_to_light_and_back() {
        for v in 0..=255 {
            let l = light_of_byte(v);
            assert_eq!(from_light(&[l, l, l, 1.0]), [v, v, v, 255]);
        }
    }

    #[test]
    fn the_mean_of_black_and_white_is_half_the_light() {
        let white = |k: u32| (k + k / 8).is_multiple_of(2);
        let board = (0..64).map(|k| if white(k) { [255; 4] } else { [0, 0, 0, 255] });
        let map = ColorMap::from_texels(8, 8, board.collect()).unwrap();
        assert_eq!(map.levels.len(), 4);
        // Half the light of white is 188 in sRGB, not 128.
        let mut texels = map.levels[1..].iter().flat_map(|level| &level.texels);
        assert!(texels.all(|texel| *texel == [188, 188, 188, 255]));
    }

    #[test]
    fn transparent_texels_lend_no_colour() {
        let texels = vec![[200, 10, 10, 255], [0, 255, 0, 0]];
        let map = ColorMap::from_texels(2, 1, texels.clone()).unwrap();
        assert_eq!(map.levels[0].texels, texels);
        assert_eq!(map.levels[1].texels, [[200, 10, 10, 128]]);
    }

    #[test]
    fn a_map_over_a_colour_shows_it_where_it_is_transparent() {
        let texels = vec![
            [200, 10, 10, 255],
            [0, 255, 0, 0],
            [255, 255, 255, 128],
            [9; 4],
        ];
        let map = ColorMap::from_texels(4, 1, texels).unwrap();
        assert!(!map.is_opaque());
        let over = map.over([1.0, 0.0, 7.0]).unwrap();
        let [first, second, third, _] = over.levels[0].texels[..] else {
            unreachable!()
        };
        assert_eq!((first, second), ([200, 10, 10, 255], [255, 0, 255, 255]));
        // Half the light of white is 188.
        assert_eq!(third, [255, 188, 255, 255]);
        // Smaller levels are the mean of what shows, as of an opaque map.
        let plain = ColorMap::from_texels(4, 1, over.levels[0].texels.clone()).unwrap();
        for (own, other) in over.levels.iter().zip(&plain.levels) {
            for (a, b) in own
                .texels
                .iter()
                .flatten()
                .zip(other.texels.iter().flatten())
            {
                assert!(a.abs_diff(*b) <= 1);
            }
        }
        assert!(over.is_opaque());
        assert_eq!(over.over([0.0; 3]).unwrap(), over);
    }
}
