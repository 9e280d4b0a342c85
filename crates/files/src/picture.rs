//! Writes frames as PNG: 8-bit sRGB RGBA, for viewing.

use crate::pixels::decode;
use crate::{file_fault, read_bytes, write_atomically};
use revmap::error::Result;
use revmap::frame::{Frame, linear_from_srgb};
use revmap::host_memory;
use std::io::Write;
use std::path::Path;

/// Writes the colour of a frame as 8-bit sRGB RGBA. Values are clamped to `[0, 1]`; alpha is
/// linear.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File), with the file's name, if it cannot be
/// written.
pub fn write_png(frame: &Frame, path: impl AsRef<Path>) -> Result<()> {
    Picture::of(frame)
        .and_then(|picture| picture.write_png(&path))
        .map_err(|e| e.in_file(&path))
}

/// A picture for viewing: sRGB with alpha, 8 bits each, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height` values.
    pub rgba: Vec<[u8; 4]>,
}

impl Picture {
    /// The colour of a frame. Values are clamped to `[0, 1]`; alpha is linear.
    ///
    /// # Errors
    /// [`ErrorKind::OutOfHostMemory`](revmap::error::ErrorKind::OutOfHostMemory).
    pub fn of(frame: &Frame) -> Result<Self> {
        let codes = Codes::new();
        let code = |&[r, g, b, a]: &[f32; 4]| {
            let [r, g, b] = [r, g, b].map(|v| codes.code(v));
            [r, g, b, alpha_code(a)]
        };
        Ok(Self {
            width: frame.width,
            height: frame.height,
            rgba: host_memory::collected(frame.color.iter().map(code), "a picture of 8 bits")?,
        })
    }

    /// Reads a PNG or JPEG.
    ///
    /// # Errors
    /// [`ErrorKind::File`](revmap::error::ErrorKind::File), with the file's name: missing, damaged, no
    /// picture, larger than 16384 on a side.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bytes = read_bytes(path).map_err(|e| {
            file_fault(format!("cannot be read ({e}); give a picture")).in_file(path)
        })?;
        let pixels = decode(&bytes, "PNG or JPEG").map_err(|e| e.in_file(path))?;
        Ok(Self {
            width: pixels.width,
            height: pixels.height,
            rgba: pixels.rgba8().map_err(|e| e.in_file(path))?,
        })
    }

    /// Writes a PNG.
    ///
    /// # Errors
    /// [`ErrorKind::File`](revmap::error::ErrorKind::File), with the file's name, if it cannot be
    /// written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<()> {
        write_atomically(path.as_ref(), |writer| self.encode_png(writer))
    }

    /// Writes the bytes of a PNG.
    ///
    /// # Errors
    /// [`ErrorKind::File`](revmap::error::ErrorKind::File) if they cannot be written, or if there
    /// are not `width * height` pixels.
    pub fn encode_png(&self, writer: impl Write) -> Result<()> {
        let size = [self.width, self.height];
        let kind = (png::ColorType::Rgba, png::BitDepth::Eight);
        encode(writer, size, kind, self.rgba.as_flattened(), |encoder| {
            encoder.set_compression(png::Compression::Fast);
            encoder.set_filter(png::Filter::Adaptive);
            Ok(())
        })
    }
}

/// Writes the bytes of a PNG, by an encoder that `set` changes.
pub(crate) fn encode<'a, W: Write + 'a>(
    writer: W,
    [width, height]: [u32; 2],
    (color, depth): (png::ColorType, png::BitDepth),
    data: &[u8],
    set: impl FnOnce(&mut png::Encoder<'a, W>) -> std::result::Result<(), png::EncodingError>,
) -> Result<()> {
    let write = || -> std::result::Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(writer, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        set(&mut encoder)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(data)?;
        writer.finish()
    };
    write().map_err(|e| {
        let full = matches!(&e, png::EncodingError::IoError(io) if io.kind() == std::io::ErrorKind::StorageFull);
        let why = if full { "the disk is full; free some space".into() } else { e.to_string() };
        file_fault(format!("cannot be written: {why}"))
    })
}

/// Linear values at which one code turns into the next. They give exact rounding to the nearest
/// code without a power per value.
struct Codes([f64; 255]);

impl Codes {
    fn new() -> Self {
        Self(std::array::from_fn(|k| {
            linear_from_srgb((k as f64 + 0.5) / 255.0)
        }))
    }

    fn code(&self, linear: f32) -> u8 {
        // A NaN is below no bound, so it becomes 0, not white.
        self.0.partition_point(|&bound| f64::from(linear) >= bound) as u8
    }
}

fn alpha_code(alpha: f32) -> u8 {
    (f64::from(alpha).clamp(0.0, 1.0) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::frame::srgb_from_linear;

    #[test]
    fn codes_are_the_nearest_ones() {
        let codes = Codes::new();
        for k in 0..=100_000 {
            let linear = k as f32 / 100_000.0;
            let exact = srgb_from_linear(f64::from(linear)) * 255.0;
            let code = f64::from(codes.code(linear));
            assert!(
                (code - exact).abs() <= 0.500_01,
                "{linear}: {code} for {exact}"
            );
        }
        // The last two pairs were published.
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        let linear = [-1.0, 0.0, 1.0, 9.0, nan, inf, 0.5, 0.215_860_5];
        assert_eq!(
            linear.map(|v| codes.code(v)),
            [0, 0, 255, 255, 0, 255, 188, 128]
        );
        assert_eq!([nan, 0.5, 2.0].map(alpha_code), [0, 128, 255]);
    }

    #[test]
    fn a_picture_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut frame = Frame::new(3, 2, [0.0; 4]).unwrap();
        frame.color[1] = [1.0, 0.5, 0.0, 1.0];
        frame.color[3] = [0.0, 0.215_860_5, 5.0, 0.5];
        write_png(&frame, &path).unwrap();
        let read = image::open(&path).unwrap().to_rgba8();
        assert_eq!(read.dimensions(), (3, 2));
        for (x, y, wanted) in [
            (1, 0, [255, 188, 0, 255]),
            (0, 1, [0, 128, 255, 128]),
            (2, 1, [0; 4]),
        ] {
            assert_eq!(read.get_pixel(x, y).0, wanted);
        }
        assert_eq!(Picture::read(&path).unwrap(), Picture::of(&frame).unwrap());
        std::fs::write(&path, "x").unwrap();
        let error = Picture::read(&path).unwrap_err().to_string();
        assert!(
            error.contains("a.png") && error.contains("no picture"),
            "{error}"
        );
    }
}
