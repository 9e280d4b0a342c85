//! Colour maps and displacement maps from pictures.

use super::header::{Header, write_png_map};
use crate::pixels::decode;
use crate::{ending, file_fault, read_bytes};
use revmap::error::{Error, Result};
use revmap::host_memory;
use revmap::maps::{ColorMap, DisplacementMap, SlopeFilter};
use std::path::Path;

/// A 16-bit code of a displacement map's channels that means slope 0.
const ZERO: f32 = 32_768.0;

/// Reads a colour map from a PNG or JPEG, upright by its EXIF data.
///
/// Transparent texels are kept; [`ColorMap::over`] lays them over an object's colour, as scene files
/// do.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File): missing, damaged, no picture, larger than
/// 16384 on a side.
pub fn color_map(path: impl AsRef<Path>) -> Result<ColorMap> {
    read(path.as_ref(), "colour map", |bytes| {
        let picture = decode(bytes, "PNG or JPEG")?;
        ColorMap::from_texels(picture.width, picture.height, picture.rgba8()?)
    })
}

/// Computes the slopes of an image file (PNG, JPEG), upright by its EXIF data. Its luminance over
/// black, as stored, is the height: transparent texels have height 0. A file that [`write_displacement_map`] wrote is loaded with its slopes.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File): missing, damaged, no picture, larger than
/// 16384 on a side.
pub fn displacement_map(path: impl AsRef<Path>, filter: SlopeFilter) -> Result<DisplacementMap> {
    read(path.as_ref(), "height map", |bytes| {
        let header = Header::of_png(bytes).filter(|h| h.kind() == Some("displacement"));
        if let Some(header) = header {
            let scale = header.number("scale")? as f32;
            let picture = decode(bytes, "PNG")?;
            let slope = |code: u16| (f32::from(code) - ZERO) / (ZERO - 1.0) * scale;
            let texels = picture.rgb16()?;
            let slopes = texels.iter().map(|p| [slope(p[0]), slope(p[1])]);
            let slopes = host_memory::collected(slopes, "a displacement map")?;
            return DisplacementMap::from_slopes(picture.width, picture.height, slopes);
        }
        let picture = decode(bytes, "PNG or JPEG")?;
        let heights = picture.luminance()?;
        DisplacementMap::from_heights(picture.width, picture.height, &heights, filter)
    })
}

/// Writes the full size as a 16-bit RGB PNG, for viewing and for loading again. R and G hold the
/// slope: 32768 is 0, and 1 and 65535 are the largest. B is 65535. A text chunk holds the largest
/// slope. Reloaded slopes are within 1/65534 of the largest.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File): another extension than `.png`, or it cannot
/// be written.
pub fn write_displacement_map(map: &DisplacementMap, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    let write = || {
        if ending(path) != "png" {
            return Err(file_fault(
                "a displacement map is written as .png; name it so",
            ));
        }
        let Some(level) = map.levels.first() else {
            return Err(file_fault(
                "the displacement map has no level; build it from an image",
            ));
        };
        let slopes = level.texels.as_flattened();
        let largest = slopes.iter().fold(0.0f32, |m, v| m.max(v.abs()));
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let code = |v: f32| (v / scale * (ZERO - 1.0) + ZERO).round() as u16;
        let texels = level.texels.iter();
        let data = texels.map(|&[u, v]| [code(u), code(v), u16::MAX].map(u16::to_be_bytes));
        let data = host_memory::collected(data, "a displacement map as PNG")?;
        let kind = (png::ColorType::Rgb, png::BitDepth::Sixteen);
        let header = format!("kind=displacement scale={scale}");
        let bytes = data.as_flattened().as_flattened();
        write_png_map(path, [level.width, level.height], kind, header, bytes)
    };
    write().map_err(|e: Error| e.in_file(path))
}

/// Reads a texture's file; errors name it.
fn read<T>(path: &Path, what: &str, make: impl Fn(&[u8]) -> Result<T>) -> Result<T> {
    let bytes = || {
        if path.is_dir() {
            return Err(file_fault(format!(
                "is a folder; give the {what} as a PNG or JPEG file"
            )));
        }
        read_bytes(path).map_err(|e| {
            file_fault(format!(
                "the {what} cannot be read ({e}); give a PNG or JPEG file"
            ))
        })
    };
    bytes()
        .and_then(|bytes| make(&bytes))
        .map_err(|e| e.in_file(path))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::f32::consts::TAU;

    #[test]
    fn slopes_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("waves.png");
        let heights: Vec<f32> = (0..33 * 20)
            .map(|k| 0.5 + 0.2 * ((k % 33) as f32 * TAU / 33.0).sin() + 0.01 * (k / 33) as f32)
            .collect();
        let map = DisplacementMap::from_heights(33, 20, &heights, SlopeFilter::Scharr).unwrap();
        write_displacement_map(&map, &file).unwrap();
        let back = displacement_map(&file, SlopeFilter::default()).unwrap();
        assert_eq!(back.size(), [33, 20]);
        let [was, is] = [&map, &back].map(|m| m.levels[0].texels.as_flattened());
        let largest = was.iter().fold(0.0f32, |m, v| m.max(v.abs()));
        for (a, b) in was.iter().zip(is) {
            assert!((a - b).abs() <= largest / 65_000.0);
        }
        assert!(write_displacement_map(&map, folder.path().join("waves.jpg")).is_err());
        let count = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(count, 1, "nothing half-written");
    }

    #[test]
    fn faults_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let text = color_map(folder.path()).unwrap_err().to_string();
        assert!(text.contains("folder"), "{text}");
        let missing = displacement_map("nowhere.png", SlopeFilter::default());
        let text = missing.unwrap_err().to_string();
        assert!(text.starts_with("nowhere.png: "), "{text}");
    }
}
