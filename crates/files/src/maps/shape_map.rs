//! Shape maps as image files, for viewing and for loading again.

use super::header::{Header, KEYWORD, shape_header, write_png_map};
use super::source::{BINARY, binary_distances};
use crate::openexr::{first_layer, layer, layer_sizes, write_layer};
use crate::pixels::{Png, Samples};
use crate::{ending, file_fault, raster, read_bytes, write_atomically};
use exr::meta::attribute::AttributeValue;
use exr::prelude::{FlatSamples, LayerAttributes, Text};
use revmap::error::{Error, Result};
use revmap::host_memory;
use revmap::maps::{EncodedMap, MAX_SIDE, MapFormat, ShapeMap};
use revmap::profile::Raster;
use std::io::Cursor;
use std::path::Path;

/// What needs memory, in messages.
const MAP: &str = "the texels of a map";

/// Writes the map in the format of the file's extension:
///
/// * `.png`: the papers' texture, 8-bit RGBA ([`MapFormat::Rgba8`]), with the scale and the other
///   values in a text chunk;
/// * `.exr`: lossless, 32-bit float channels `distance` (object units) and `form` (1 solid, 0
///   empty).
///
/// The file is written completely or not at all.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File): another extension, or it cannot be written.
pub fn write_shape_map(map: &ShapeMap, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    match ending(path).as_str() {
        "png" => write_png(map, path),
        "exr" => write_exr(map, path),
        _ => Err(file_fault(
            "a shape map is written as .png (papers) or .exr (lossless); name it so",
        )),
    }
    .map_err(|e| e.in_file(path))
}

/// Reads a map that [`write_shape_map`] wrote, or a papers' texture from elsewhere.
///
/// An EXR file is read back bit for bit. A PNG file's distances outside are its bytes, which
/// were rounded down when written. The papers store none inside; these are measured from the
/// form as the source `binary` does. A PNG without this crate's text chunk has no scale. All
/// its distances are measured from its form, and its box is as wide as the map.
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File): missing, damaged, or no shape map.
pub fn shape_map(path: impl AsRef<Path>) -> Result<ShapeMap> {
    let path = path.as_ref();
    let read = || {
        let bytes = read_bytes(path).map_err(|e| {
            file_fault(format!(
                "the map cannot be read ({e}); give a file that `revmap bake` wrote"
            ))
        })?;
        if bytes.starts_with(b"\x76\x2f\x31\x01") {
            from_exr(&bytes)
        } else {
            from_png(&bytes)
        }
    };
    read().map_err(|e: Error| e.in_file(path))
}

fn write_png(map: &ShapeMap, path: &Path) -> Result<()> {
    let encoded = map.encode(MapFormat::Rgba8)?;
    let kind = (png::ColorType::Rgba, png::BitDepth::Eight);
    let header = shape_header(map, encoded.scale);
    write_png_map(path, [map.columns, map.rows], kind, header, &encoded.bytes)
}

fn write_exr(map: &ShapeMap, path: &Path) -> Result<()> {
    let mut attributes = LayerAttributes::named("shape map");
    let header = AttributeValue::Text(Text::from(&*shape_header(map, 1.0)));
    attributes.other.insert(Text::from(KEYWORD), header);
    let form = map.form.iter().map(|&s| f32::from(u8::from(s)));
    let form = host_memory::collected(form, MAP)?;
    let distance = host_memory::collected(map.distance.iter().copied(), MAP)?;
    let channels = [("distance", distance), ("form", form)];
    let layer = layer([map.columns, map.rows], attributes, channels);
    write_atomically(path, |writer| {
        write_layer(layer, writer).map_err(|e| {
            file_fault(format!(
                "the map cannot be written as EXR ({e}); write a .png"
            ))
        })
    })
}

fn from_exr(bytes: &[u8]) -> Result<ShapeMap> {
    layer_sizes(Cursor::new(bytes), bytes.len() as u64).map_err(damaged)?;
    let layer = first_layer(Cursor::new(bytes)).map_err(damaged)?;
    let header = match layer.attributes.other.get(&Text::from(KEYWORD)) {
        Some(AttributeValue::Text(text)) => Header::parse(&text.to_string()),
        _ => return Err(no_map()),
    };
    let size = layer.size;
    let (mut distance, mut form) = (Vec::new(), Vec::new());
    for channel in layer.channel_data.list {
        let FlatSamples::F32(values) = channel.sample_data else {
            continue;
        };
        if channel.name == *"distance" {
            distance = values;
        } else if channel.name == *"form" {
            form = host_memory::collected(values.iter().map(|&v| v > 0.5), MAP)?;
        }
    }
    let texels = size.area();
    if header.kind() != Some("shape") || distance.len() != texels || form.len() != texels {
        return Err(no_map());
    }
    checked_size(size.width(), size.height())?;
    Ok(ShapeMap {
        columns: size.width() as u32, // at most MAX_SIDE
        rows: size.height() as u32,
        radius: header.number("radius")?,
        source: header.source()?,
        distance,
        form,
        bounds: header.bounds()?,
    })
}

fn from_png(bytes: &[u8]) -> Result<ShapeMap> {
    let header = Header::of_png(bytes);
    if header.as_ref().is_some_and(|h| h.kind() != Some("shape")) {
        return Err(no_map());
    }
    let reader = Png::open(bytes)
        .map_err(|e| file_fault(format!("is no map that can be read ({e}); bake it again")))?;
    let (columns, rows) = reader.size();
    checked_size(columns as usize, rows as usize)?;
    let pixels = reader.pixels(damaged)?;
    let (4, Samples::Byte(bytes)) = (pixels.channels, pixels.samples) else {
        return Err(no_map());
    };
    let form = bytes.chunks_exact(4).map(|t| t[3] > 127);
    let form: Vec<bool> = host_memory::collected(form, MAP)?;
    if !form.contains(&true) || !form.contains(&false) {
        return Err(no_map());
    }
    let pixels = Raster {
        columns,
        rows,
        coverage: host_memory::collected(form.iter().map(|&s| f32::from(u8::from(s))), MAP)?,
    };
    let mut distance = binary_distances(&pixels)?;
    let (radius, source, bounds) = match header {
        Some(header) => {
            let stored = EncodedMap {
                columns,
                rows,
                format: MapFormat::Rgba8,
                scale: header.number("scale")? as f32,
                bytes,
            };
            let stored = stored.distances();
            for ((d, outside), solid) in distance.iter_mut().zip(stored).zip(&form) {
                if !solid {
                    *d = outside;
                }
            }
            (header.number("radius")?, header.source()?, header.bounds()?)
        }
        None => {
            let bounds = raster::bounds(&pixels).ok_or_else(no_map)?;
            (f64::from(columns) / f64::from(rows), BINARY, bounds)
        }
    };
    Ok(ShapeMap {
        columns,
        rows,
        radius,
        source,
        distance,
        form,
        bounds,
    })
}

fn damaged(why: String) -> Error {
    file_fault(format!("the map is damaged ({why}); bake it again"))
}

fn no_map() -> Error {
    file_fault("is no shape map; give a file that `revmap bake` wrote")
}

fn checked_size(columns: usize, rows: usize) -> Result<()> {
    let sides = 2..=MAX_SIDE as usize;
    if sides.contains(&columns) && sides.contains(&rows) {
        return Ok(());
    }
    Err(file_fault(format!(
        "the map has {columns} x {rows} texels; 2 to {MAX_SIDE} on a side can be read"
    )))
}

#[cfg(test)]
mod tests;
