//! Shape maps as image files, for viewing and for loading again.

use super::binary;
use super::header::{Header, KEYWORD, shape_header};
use super::store::unpack_distance;
use super::{Bounds, MapFormat, MapSource, ShapeMap};
use crate::error::{Error, ErrorKind, Result};
use crate::frame::atomic_file::write_bytes;
#[cfg(feature = "exr")]
use crate::pictures::check_exr;
use crate::pictures::{MAX_SIDE, Pixels, Png, Samples};
use crate::profile::Raster;
#[cfg(feature = "exr")]
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The projection that lays a texture onto a solid. A map's file name contains its projection:
/// `vase.spherical.png`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// `(x, y)` of the box, seen from above.
    Planar,
    /// Azimuth and height.
    #[default]
    Cylindrical,
    /// Azimuth and polar angle about the middle of the box.
    Spherical,
    /// Azimuth and length along the profile.
    Arc,
}

impl Projection {
    /// All projections.
    pub const ALL: [Self; 4] = [Self::Planar, Self::Cylindrical, Self::Spherical, Self::Arc];

    /// The name in scene files and file names.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Planar => "planar",
            Self::Cylindrical => "cylindrical",
            Self::Spherical => "spherical",
            Self::Arc => "arc",
        }
    }

    /// The projection of that name; upper and lower case are equal.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|p| p.name().eq_ignore_ascii_case(name))
    }

    /// The projection in a file's name before its extension.
    ///
    /// ```
    /// use revmap::maps::Projection;
    /// assert_eq!(Projection::of_file("maps/vase.spherical.png"), Some(Projection::Spherical));
    /// assert_eq!(Projection::of_file("vase.png"), None);
    /// ```
    #[must_use]
    pub fn of_file(path: impl AsRef<Path>) -> Option<Self> {
        let stem = PathBuf::from(path.as_ref().file_stem()?);
        Self::from_name(stem.extension()?.to_str()?)
    }

    /// `path` with the projection before its extension, unless it has one already: `vase.png`
    /// becomes `vase.spherical.png`.
    #[must_use]
    pub fn mark_file(self, path: impl AsRef<Path>) -> PathBuf {
        let path = path.as_ref();
        match (Self::of_file(path), path.extension()) {
            (None, Some(extension)) => {
                let mut marked = std::ffi::OsString::from(self.name());
                marked.push(".");
                marked.push(extension);
                path.with_extension(marked)
            }
            _ => path.to_path_buf(),
        }
    }
}

fn fault(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::File, message)
}

impl ShapeMap {
    /// Writes the map in the format of the file's extension:
    ///
    /// * `.png`: the papers' texture, 8-bit RGBA ([`MapFormat::Rgba8`]), with the scale and the
    ///   other values in a text chunk;
    /// * `.exr` (feature `exr`): lossless, 32-bit float channels `distance` (object units) and
    ///   `form` (1 solid, 0 empty).
    ///
    /// The file is written completely or not at all.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: another extension, or it cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let bytes = match extension(path).as_deref() {
            Some("png") => self.to_png(),
            Some("exr") => self.to_exr(),
            _ => Err(fault(
                "a shape map is written as .png (papers) or .exr (lossless); name it so",
            )),
        };
        bytes
            .and_then(|b| write_bytes(path, &b))
            .map_err(|e| e.in_file(path))
    }

    /// Reads a map that [`ShapeMap::save`] wrote, or a papers' texture from elsewhere.
    ///
    /// An EXR file is read back bit for bit. A PNG file's distances outside are its bytes, which
    /// were rounded down when written. The papers store none inside; these are measured from the
    /// form as the source `binary` does. A PNG without this crate's text chunk has no scale. All
    /// its distances are measured from its form, and its box is as wide as the map.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: missing, damaged, or no shape map.
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let read = || {
            let bytes = std::fs::read(path).map_err(|e| {
                fault(format!(
                    "the map cannot be read ({e}); give a file that `ShapeMap::save` wrote"
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

    fn to_png(&self) -> Result<Vec<u8>> {
        let encoded = self.encode(MapFormat::Rgba8);
        encode_png(
            [self.columns, self.rows],
            png::ColorType::Rgba,
            png::BitDepth::Eight,
            &shape_header(self, encoded.scale),
            &encoded.bytes,
        )
    }

    #[cfg(not(feature = "exr"))]
    fn to_exr(&self) -> Result<Vec<u8>> {
        Err(without_exr())
    }

    #[cfg(feature = "exr")]
    fn to_exr(&self) -> Result<Vec<u8>> {
        use exr::prelude::*;
        let form = self
            .form
            .iter()
            .map(|&s| if s { 1.0 } else { 0.0 })
            .collect();
        let channels = [("distance", self.distance.clone()), ("form", form)]
            .map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values)));
        let mut attributes = LayerAttributes::named("shape map");
        attributes.other.insert(
            Text::from(KEYWORD),
            exr::meta::attribute::AttributeValue::Text(Text::from(&*shape_header(self, 1.0))),
        );
        let layer = Layer::new(
            (self.columns as usize, self.rows as usize),
            attributes,
            Encoding {
                compression: Compression::ZIP16,
                blocks: Blocks::ScanLines,
                line_order: LineOrder::Increasing,
            },
            AnyChannels::sort(channels.into_iter().collect()),
        );
        let mut out = Cursor::new(Vec::new());
        Image::from_layer(layer)
            .write()
            .non_parallel()
            .to_buffered(&mut out)
            .map_err(|e| {
                fault(format!(
                    "the map cannot be written as EXR ({e}); write a .png"
                ))
            })?;
        Ok(out.into_inner())
    }
}

#[cfg(not(feature = "exr"))]
fn without_exr() -> Error {
    fault("this build lacks the feature `exr`; build with it, or use a .png")
}

#[cfg(not(feature = "exr"))]
fn from_exr(_: &[u8]) -> Result<ShapeMap> {
    Err(without_exr())
}

#[cfg(feature = "exr")]
fn from_exr(bytes: &[u8]) -> Result<ShapeMap> {
    use exr::prelude::*;
    let damaged = |e: String| fault(format!("the map is damaged ({e}); bake it again"));
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false);
    let meta = meta.map_err(|e| damaged(e.to_string()))?;
    check_exr(&meta, bytes.len() as u64).map_err(damaged)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| damaged(e.to_string()))?;
    let layer = image.layer_data;
    let header = match layer.attributes.other.get(&Text::from(KEYWORD)) {
        Some(exr::meta::attribute::AttributeValue::Text(text)) => Header::parse(&text.to_string()),
        _ => return Err(no_map()),
    };
    let size = layer.size;
    let mut distance = Vec::new();
    let mut form = Vec::new();
    for channel in layer.channel_data.list {
        let FlatSamples::F32(values) = channel.sample_data else {
            continue;
        };
        if channel.name == *"distance" {
            distance = values;
        } else if channel.name == *"form" {
            form = values.iter().map(|&v| v > 0.5).collect();
        }
    }
    let texels = size.area();
    if header.kind() != Some("shape") || distance.len() != texels || form.len() != texels {
        return Err(no_map());
    }
    let (columns, rows) = checked_size(size.width() as u64, size.height() as u64)?;
    Ok(ShapeMap {
        columns,
        rows,
        radius: header.number("radius")?,
        source: header.source()?,
        distance,
        form,
        bounds: header.bounds()?,
    })
}

fn from_png(bytes: &[u8]) -> Result<ShapeMap> {
    let header = Header::of_png(bytes);
    if header
        .as_ref()
        .and_then(Header::kind)
        .is_some_and(|k| k != "shape")
    {
        return Err(no_map());
    }
    let reader = Png::open(bytes)
        .map_err(|e| fault(format!("is no map that can be read ({e}); bake it again")))?;
    let (columns, rows) = reader.size();
    let (columns, rows) = checked_size(u64::from(columns), u64::from(rows))?;
    let texels = match reader.pixels() {
        Ok(Pixels {
            channels: 4,
            samples: Samples::Byte(texels),
            ..
        }) => texels,
        Ok(_) => return Err(no_map()),
        Err(e) => return Err(fault(format!("the map is damaged ({e}); bake it again"))),
    };
    let form: Vec<bool> = texels.chunks_exact(4).map(|t| t[3] > 127).collect();
    if !form.contains(&true) || !form.contains(&false) {
        return Err(no_map());
    }
    let raster = Raster {
        columns,
        rows,
        coverage: form.iter().map(|&s| if s { 1.0 } else { 0.0 }).collect(),
    };
    let mut distance = binary::distances(&raster);
    let (radius, source, bounds) = match header {
        Some(header) => {
            let scale = header.number("scale")? as f32;
            for ((d, texel), solid) in distance.iter_mut().zip(texels.chunks_exact(4)).zip(&form) {
                if !solid {
                    *d = unpack_distance(texel[2], scale);
                }
            }
            (header.number("radius")?, header.source()?, header.bounds()?)
        }
        None => {
            let radius = f64::from(columns) / f64::from(rows);
            let whole = Bounds {
                r_min: 0.0,
                r_max: radius,
                z_min: 0.0,
                z_max: 1.0,
            };
            (radius, MapSource::Binary, raster.bounds().unwrap_or(whole))
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

fn no_map() -> Error {
    fault("is no shape map; give a file that `ShapeMap::save` wrote")
}

fn checked_size(columns: u64, rows: u64) -> Result<(u32, u32)> {
    match (u32::try_from(columns), u32::try_from(rows)) {
        (Ok(c), Ok(r)) if (2..=MAX_SIDE).contains(&c) && (2..=MAX_SIDE).contains(&r) => Ok((c, r)),
        _ => Err(fault(format!(
            "the map has {columns} x {rows} texels; 2 to {MAX_SIDE} on a side can be read"
        ))),
    }
}

/// A file's extension in lower case.
pub(super) fn extension(path: &Path) -> Option<String> {
    path.extension()
        .and_then(|e| e.to_str())
        .map(str::to_ascii_lowercase)
}

/// A PNG with a header in its text.
pub(super) fn encode_png(
    [width, height]: [u32; 2],
    color: png::ColorType,
    depth: png::BitDepth,
    header: &str,
    data: &[u8],
) -> Result<Vec<u8>> {
    let mut out = Vec::new();
    let mut write = || -> std::result::Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(&mut out, width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        encoder.add_text_chunk(KEYWORD.to_owned(), header.to_owned())?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(data)?;
        writer.finish()
    };
    write().map_err(|e| fault(format!("the map cannot be written as PNG ({e})")))?;
    Ok(out)
}

#[cfg(test)]
mod tests;
