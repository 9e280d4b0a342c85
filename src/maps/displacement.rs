//! Displacement maps: the slopes of a height map, computed once and scaled when the picture is
//! drawn (Blinn 1978).

use super::files::{encode_png, extension};
use super::half::to_half;
use super::halving;
use super::header::Header;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::atomic_file::write_bytes;
use crate::pictures::decode;
use rayon::prelude::*;
use std::path::Path;

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

/// A 16-bit code of the file's channels that means slope 0.
const ZERO: f32 = 32_768.0;

impl DisplacementMap {
    /// Computes the slopes of an image file (PNG, JPEG); its luminance, as stored, is the height. A
    /// file that [`DisplacementMap::save`] wrote is loaded with its slopes.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: missing, damaged, no picture, larger than 16384 on a side.
    pub fn from_image(path: impl AsRef<Path>) -> Result<Self> {
        Self::from_image_with(path, SlopeFilter::default())
    }

    /// Computes the slopes of an image file with a given filter.
    ///
    /// # Errors
    /// The errors of [`DisplacementMap::from_image`].
    pub fn from_image_with(path: impl AsRef<Path>, filter: SlopeFilter) -> Result<Self> {
        let path = path.as_ref();
        let read = || {
            let bytes = read_map(path, "height map")?;
            if let Some(header) =
                Header::of_png(&bytes).filter(|h| h.kind() == Some("displacement"))
            {
                return Self::from_file(&bytes, &header);
            }
            let picture = decode(&bytes, "PNG or JPEG")?;
            Self::from_heights(picture.width, picture.height, &picture.luminance(), filter)
        };
        read().map_err(|e: Error| e.in_file(path))
    }

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
        let fault = |message: String| Error::new(ErrorKind::Content, message);
        if heights.is_empty() || heights.len() != w * h {
            return Err(fault(format!(
                "{} heights for {width} x {height} texels; give as many as there are texels",
                heights.len()
            )));
        }
        if let Some(k) = heights.iter().position(|v| !v.is_finite()) {
            return Err(fault(format!(
                "height {k} is not finite; give numbers from 0 to 1"
            )));
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
        Ok(Self::from_slopes(w, h, slopes))
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

    /// Writes the full size as a 16-bit RGB PNG, for viewing and for loading again. R and G hold
    /// the slope: 32768 is 0, and 1 and 65535 are the largest. B is 65535. A text chunk holds the
    /// largest slope. Reloaded slopes are within 1/65534 of the largest.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: another extension than `.png`, or it cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let write = || {
            if extension(path).as_deref() != Some("png") {
                return Err(fault("a displacement map is written as .png; name it so"));
            }
            let Some(level) = self.levels.first() else {
                return Err(fault(
                    "the displacement map has no level; build it from an image",
                ));
            };
            let largest = level
                .texels
                .iter()
                .flatten()
                .fold(0.0f32, |m, v| m.max(v.abs()));
            let scale = if largest > 0.0 { largest } else { 1.0 };
            let code = |v: f32| (v / scale * (ZERO - 1.0) + ZERO).round() as u16;
            let data: Vec<u8> = level
                .texels
                .iter()
                .flat_map(|&[u, v]| [code(u), code(v), u16::MAX])
                .flat_map(u16::to_be_bytes)
                .collect();
            let header = format!("kind=displacement scale={scale}");
            let size = [level.width, level.height];
            let bytes = encode_png(
                size,
                png::ColorType::Rgb,
                png::BitDepth::Sixteen,
                &header,
                &data,
            )?;
            write_bytes(path, &bytes)
        };
        write().map_err(|e: Error| e.in_file(path))
    }

    fn from_file(bytes: &[u8], header: &Header) -> Result<Self> {
        let scale = header.number("scale")? as f32;
        let picture = decode(bytes, "PNG")?;
        let slope = |code: u16| (f32::from(code) - ZERO) / (ZERO - 1.0) * scale;
        let texels = picture.rgb16();
        let slopes = texels.iter().map(|p| [slope(p[0]), slope(p[1])]).collect();
        Ok(Self::from_slopes(
            picture.width as usize,
            picture.height as usize,
            slopes,
        ))
    }

    fn from_slopes(width: usize, height: usize, slopes: Vec<[f32; 2]>) -> Self {
        let levels = halving::chain(width, height, slopes)
            .into_iter()
            .map(|(w, h, texels)| Level {
                width: w as u32,
                height: h as u32,
                texels,
            })
            .collect();
        Self { levels }
    }
}

fn fault(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::File, message)
}

/// A texture's file, or an error that names it.
pub(super) fn read_map(path: &Path, what: &str) -> Result<Vec<u8>> {
    if path.is_dir() {
        return Err(fault(format!(
            "is a folder; give the {what} as a PNG or JPEG file"
        )));
    }
    std::fs::read(path).map_err(|e| {
        fault(format!(
            "the {what} cannot be read ({e}); give a PNG or JPEG file"
        ))
    })
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
    fn saved_and_loaded() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("waves.png");
        let map = waves(33, 20, SlopeFilter::Scharr);
        map.save(&file).unwrap();
        let back = DisplacementMap::from_image(&file).unwrap();
        assert_eq!(back.size(), [33, 20]);
        let largest = map.levels[0]
            .texels
            .iter()
            .flatten()
            .fold(0.0f32, |m, v| m.max(v.abs()));
        for (a, b) in map.levels[0]
            .texels
            .iter()
            .flatten()
            .zip(back.levels[0].texels.iter().flatten())
        {
            assert!((a - b).abs() <= largest / 65_000.0);
        }
        assert!(map.save(folder.path().join("waves.jpg")).is_err());
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "nothing half-written"
        );
    }

    #[test]
    fn faults_are_named() {
        let text = |e: Result<DisplacementMap>| e.unwrap_err().to_string();
        let new = |w, h, v: &[f32]| DisplacementMap::from_heights(w, h, v, SlopeFilter::Central);
        assert!(text(new(2, 2, &[0.0; 3])).contains("3 heights"));
        assert!(text(new(0, 0, &[])).contains("0 heights"));
        assert!(text(new(2, 1, &[0.0, f32::NAN])).contains("height 1"));
        assert!(text(DisplacementMap::from_image("nowhere.png")).starts_with("nowhere.png: "));
    }
}
