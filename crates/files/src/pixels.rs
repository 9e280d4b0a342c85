//! Pictures from files: PNG and JPEG.

use crate::file_fault;
use crate::jpeg_end;
use image::metadata::Orientation;
use rayon::prelude::*;
use revmap::error::{Error, Result};
use revmap::host_memory;
use revmap::maps::MAX_SIDE;
use revmap_drawing::luminance;
use std::io::Cursor;
use zune_core::{bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

/// What needs memory, in messages.
const PICTURE: &str = "the pixels of a picture";

/// Samples of 8 or of 16 bits.
#[derive(Debug, PartialEq)]
pub(crate) enum Samples {
    Byte(Vec<u8>),
    Word(Vec<u16>),
}

/// A decoded picture, row 0 on top. Palettes and grey of less than 8 bits are expanded.
///
/// The picture is upright: the orientation that its EXIF data gives has been applied.
#[derive(Debug)]
pub(crate) struct Pixels {
    pub width: u32,
    pub height: u32,
    /// Samples of a pixel: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA.
    pub channels: usize,
    /// `width * height * channels` values.
    pub samples: Samples,
}

impl Pixels {
    /// Every pixel, turned by `to` from RGBA in `[0, 1]`, as stored; opaque where the file has no
    /// alpha.
    pub fn map<T: Clone + Default + Send>(
        &self,
        to: impl Fn([f32; 4]) -> T + Sync,
    ) -> Result<Vec<T>> {
        match &self.samples {
            Samples::Byte(v) => mapped(v, self.channels, 255.0, to),
            Samples::Word(v) => mapped(v, self.channels, 65_535.0, to),
        }
    }

    /// Every pixel as RGBA of 8 bits.
    pub fn rgba8(&self) -> Result<Vec<[u8; 4]>> {
        self.map(|p| p.map(|v| (v * 255.0).round() as u8))
    }

    /// Every pixel as RGB of 16 bits.
    pub fn rgb16(&self) -> Result<Vec<[u16; 3]>> {
        self.map(|[r, g, b, _]| [r, g, b].map(|v| (v * 65_535.0).round() as u16))
    }

    /// The picture as its EXIF data turns it. Data that cannot be read turns nothing.
    fn upright(self, exif: Option<&[u8]>) -> Result<Self> {
        let tiff = exif.map(|exif| exif.strip_prefix(b"Exif\0\0").unwrap_or(exif));
        let turn = tiff.and_then(Orientation::from_exif_chunk);
        let Some(turn) = turn.filter(|turn| *turn != Orientation::NoTransforms) else {
            return Ok(self);
        };
        // The tag's values, from 1: four ways without columns as rows, then four with.
        let number = turn.to_exif() - 1;
        let (swapped, mirrored) = (number >= 4, matches!(number, 1 | 2 | 5 | 6));
        let flipped = matches!(number, 2 | 3 | 6 | 7);
        let (width, height) = match swapped {
            true => (self.height, self.width),
            false => (self.width, self.height),
        };
        let (w, h) = (width as usize, height as usize);
        let place = |k: usize| {
            let x = if mirrored { w - 1 - k % w } else { k % w };
            let y = if flipped { h - 1 - k / w } else { k / w };
            if swapped { x * h + y } else { y * w + x }
        };
        let channels = self.channels;
        let samples = match self.samples {
            Samples::Byte(v) => Samples::Byte(turned(&v, channels, place)?),
            Samples::Word(v) => Samples::Word(turned(&v, channels, place)?),
        };
        Ok(Self {
            width,
            height,
            channels,
            samples,
        })
    }

    /// Luminance of every pixel over black, in `[0, 1]`, as stored.
    pub fn luminance(&self) -> Result<Vec<f32>> {
        self.map(|[r, g, b, alpha]| alpha * luminance([r, g, b]))
    }
}

/// Samples, `channels` a pixel, of pixels that are stored at these places.
fn turned<T: Copy>(
    stored: &[T],
    channels: usize,
    place: impl Fn(usize) -> usize,
) -> Result<Vec<T>> {
    let mut turned = host_memory::reserved(stored.len(), "the pixels of an upright picture")?;
    for k in 0..stored.len() / channels {
        turned.extend_from_slice(&stored[place(k) * channels..][..channels]);
    }
    Ok(turned)
}

fn mapped<S: Copy + Into<f32> + Sync, T: Clone + Default + Send>(
    samples: &[S],
    channels: usize,
    full: f32,
    to: impl Fn([f32; 4]) -> T + Sync,
) -> Result<Vec<T>> {
    let value = |s: S| s.into() / full;
    let pixels = samples.par_chunks_exact(channels);
    let rgba = |p: &[S]| match *p {
        [v] => [value(v), value(v), value(v), 1.0],
        [v, a] => [value(v), value(v), value(v), value(a)],
        [r, g, b] => [value(r), value(g), value(b), 1.0],
        [r, g, b, a, ..] => [r, g, b, a].map(value),
        [] => [1.0; 4], // no picture has pixels without a sample
    };
    let mut out = host_memory::filled(pixels.len(), T::default(), PICTURE)?;
    let both = out.par_iter_mut().zip(pixels);
    both.for_each(|(out, p)| *out = to(rgba(p)));
    Ok(out)
}

/// The first bytes of a PNG.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of a JPEG.
const JPEG: &[u8] = b"\xff\xd8\xff";

/// Returns true if the bytes begin as a PNG or a JPEG does.
pub(crate) fn is_picture(bytes: &[u8]) -> bool {
    bytes.starts_with(PNG) || bytes.starts_with(JPEG)
}

/// Decodes a PNG or JPEG of at most [`MAX_SIDE`] pixels on a side; the remedy names `kinds` of
/// files.
///
/// The size is read and checked before anything is decoded.
pub(crate) fn decode(bytes: &[u8], kinds: &str) -> Result<Pixels> {
    let broken =
        |e: String| file_fault(format!("the image is damaged ({e}); save or copy it again"));
    let checked = |(width, height): (u32, u32)| {
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(file_fault(format!(
                "the image has {width} x {height} pixels; {MAX_SIDE} x {MAX_SIDE} is the most, scale it down"
            )));
        }
        Ok(())
    };
    if bytes.starts_with(PNG) {
        let reader = Png::open(bytes).map_err(|e| broken(e.to_string()))?;
        checked(reader.size())?;
        return reader.pixels(broken);
    }
    if bytes.starts_with(JPEG) {
        let mut reader = jpeg(bytes).map_err(|e| broken(e.to_string()))?;
        let (width, height) = reader.dimensions().unwrap_or_default();
        let (width, height) = (width as u32, height as u32); // at most 65535
        checked((width, height))?;
        let samples = jpeg_samples(&mut reader)?.map_err(|e| broken(e.to_string()))?;
        if !is_whole_jpeg(bytes, &samples)? {
            return Err(broken("it ends too early".to_owned()));
        }
        let pixels = Pixels {
            width,
            height,
            channels: reader.output_colorspace().map_or(3, |c| c.num_components()),
            samples: Samples::Byte(samples),
        };
        return pixels.upright(reader.exif().map(Vec::as_slice));
    }
    let unknown = || format!("is no picture that can be read; give a {kinds} file");
    Err(file_fault(foreign(bytes).unwrap_or_else(unknown)))
}

/// Formats that are not read: name, place of the mark, mark.
const FOREIGN: [(&str, usize, &[u8]); 12] = [
    ("GIF", 0, b"GIF8"),
    ("WebP", 8, b"WEBP"),
    ("BMP", 0, b"BM"),
    ("TIFF", 0, b"II*\0"),
    ("TIFF", 0, b"MM\0*"),
    ("AVIF", 4, b"ftypavi"),
    ("HEIC", 4, b"ftyphei"),
    ("HEIC", 4, b"ftypmif1"),
    ("JPEG XL", 0, b"\xff\x0a"),
    ("PDF", 0, b"%PDF"),
    ("PostScript", 0, b"%!PS"),
    ("PSD", 0, b"8BPS"),
];

/// What is wrong with a file that is empty or of a known format that is not read.
pub(crate) fn foreign(bytes: &[u8]) -> Option<String> {
    if bytes.is_empty() {
        return Some("is empty (0 bytes); save or copy it again".to_owned());
    }
    let is_of = |(_, at, mark): &&(&str, usize, &[u8])| {
        bytes.get(*at..).is_some_and(|rest| rest.starts_with(mark))
    };
    let (name, ..) = FOREIGN.iter().find(is_of)?;
    Some(format!(
        "is a {name} file, which is not read; convert it to PNG"
    ))
}

/// A PNG whose header was read.
pub(crate) struct Png<'a>(png::Reader<Cursor<&'a [u8]>>);

impl<'a> Png<'a> {
    pub fn open(bytes: &'a [u8]) -> std::result::Result<Self, png::DecodingError> {
        // Callers check the size; the decoder's own guess at a limit would refuse large pictures of
        // 16 bits.
        let limits = png::Limits { bytes: usize::MAX };
        let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
        decoder.set_transformations(png::Transformations::EXPAND);
        decoder.read_info().map(Self)
    }

    pub fn size(&self) -> (u32, u32) {
        self.0.info().size()
    }

    /// The pixels, or what `broken` makes of the decoder's words.
    pub fn pixels(mut self, broken: impl Fn(String) -> Error) -> Result<Pixels> {
        // A size that overflows is that of a picture that does not fit into memory.
        let size = self.0.output_buffer_size().unwrap_or(usize::MAX);
        let mut bytes = host_memory::filled(size, 0, PICTURE)?;
        let frame = self.0.next_frame(&mut bytes);
        let frame = frame.map_err(|e| broken(e.to_string()))?;
        bytes.truncate(frame.buffer_size());
        let samples = if frame.bit_depth == png::BitDepth::Sixteen {
            let words = bytes.as_chunks().0.iter();
            let words = words.map(|w| u16::from_be_bytes(*w));
            Samples::Word(host_memory::collected(words, PICTURE)?)
        } else {
            Samples::Byte(bytes)
        };
        // EXIF data may follow the pixels.
        self.0.finish().map_err(|e| broken(e.to_string()))?;
        let pixels = Pixels {
            width: frame.width,
            height: frame.height,
            channels: frame.color_type.samples(),
            samples,
        };
        let exif = self.0.info().exif_metadata.as_deref();
        pixels.upright(exif)
    }
}

/// A JPEG whose headers were read, to be decoded to grey or RGB.
fn jpeg(bytes: &[u8]) -> std::result::Result<JpegDecoder<ZCursor<&[u8]>>, DecodeErrors> {
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers()?;
    let color = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => ColorSpace::Luma,
        _ => ColorSpace::RGB,
    };
    decoder.set_options(options.jpeg_set_out_colorspace(color));
    Ok(decoder)
}

/// The samples of a JPEG whose headers were read. The decoder's fault is within; the outer one is
/// that of memory.
fn jpeg_samples(
    reader: &mut JpegDecoder<ZCursor<&[u8]>>,
) -> Result<std::result::Result<Vec<u8>, DecodeErrors>> {
    let size = reader.output_buffer_size().unwrap_or_default();
    let mut samples = host_memory::filled(size, 0, PICTURE)?;
    Ok(reader.decode_into(&mut samples).map(|()| samples))
}

/// Returns true if no data of the file are missing. The decoder draws missing data grey, or as what
/// stands in their place.
fn is_whole_jpeg(bytes: &[u8], samples: &[u8]) -> Result<bool> {
    let Some(longer) = jpeg_end::lengthened(bytes)? else {
        return Ok(false);
    };
    let Ok(mut reader) = jpeg(&longer) else {
        return Ok(false);
    };
    Ok(jpeg_samples(&mut reader)?.is_ok_and(|same| same == samples))
}

#[cfg(test)]
mod tests;
