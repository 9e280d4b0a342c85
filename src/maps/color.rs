//! Colour maps: 8-bit sRGB texels with mip levels averaged in linear light.

use super::Level;
use super::displacement::{check_count, levels};
use crate::error::Result;
use crate::frame::linear_from_srgb;

/// A texture of colours, `R8G8B8A8_SRGB`, row 0 (`v = 1`) on top.
///
/// Smaller levels hold the mean light of the texels that they cover, weighted by alpha, so that
/// transparent texels add no colour to their neighbours.
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
    /// [`ErrorKind::Content`](crate::error::ErrorKind::Content): no texels, or not `width * height`
    /// of them.
    pub fn from_texels(width: u32, height: u32, texels: Vec<[u8; 4]>) -> Result<Self> {
        check_count("colours", texels.len(), width, height)?;
        let linear: Vec<f32> = (0..=255u8).map(light_of_byte).collect();
        let light = texels
            .iter()
            .map(|&[r, g, b, a]| {
                let alpha = f32::from(a) / 255.0;
                let channel = |v: u8| linear[usize::from(v)] * alpha;
                [channel(r), channel(g), channel(b), alpha]
            })
            .collect();
        let mut levels = levels(width, height, light, from_light);
        // The full size is stored unchanged, including the colours of transparent texels.
        levels[0].texels = texels;
        Ok(Self { levels })
    }

    /// Texels across and down of the full size.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.levels.first().map_or([0, 0], |l| [l.width, l.height])
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
        let v = if v <= 0.003_130_8 {
            v * 12.92
        } else {
            1.055 * v.powf(1.0 / 2.4) - 0.055
        };
        (v * 255.0).round() as u8
    };
    [encode(r), encode(g), encode(b), (a * 255.0).round() as u8]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_value_survives_the_way_to_light_and_back() {
        for v in 0..=255 {
            let l = light_of_byte(v);
            assert_eq!(from_light(&[l, l, l, 1.0]), [v, v, v, 255]);
        }
    }

    #[test]
    fn the_mean_of_black_and_white_is_half_the_light() {
        let board: Vec<[u8; 4]> = (0..64)
            .map(|k| {
                if (k + k / 8) % 2 == 0 {
                    [255; 4]
                } else {
                    [0, 0, 0, 255]
                }
            })
            .collect();
        let map = ColorMap::from_texels(8, 8, board).unwrap();
        assert_eq!(map.levels.len(), 4);
        for level in &map.levels[1..] {
            // Half the light of white is 188 in sRGB, not 128.
            assert!(
                level.texels.iter().all(|t| *t == [188, 188, 188, 255]),
                "{level:?}"
            );
        }
    }

    #[test]
    fn transparent_texels_lend_no_colour() {
        let texels = vec![[200, 10, 10, 255], [0, 255, 0, 0]];
        let map = ColorMap::from_texels(2, 1, texels.clone()).unwrap();
        assert_eq!(map.levels[0].texels, texels);
        assert_eq!(map.levels[1].texels, [[200, 10, 10, 128]]);
    }

    #[test]
    fn faults_are_named() {
        assert!(
            ColorMap::from_texels(2, 2, vec![[0; 4]; 3])
                .unwrap_err()
                .to_string()
                .contains("3 colours")
        );
    }
}
