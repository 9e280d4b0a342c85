//! The data of a map's file beside its pixels: one line of `key=value` words.
//!
//! PNG files hold the line in a text chunk, EXR files in a text attribute, under [`KEYWORD`].
//! Numbers are written so that reading them restores every bit.

use super::MAP_SOURCES;
use crate::picture::encode;
use crate::{file_fault, write_atomically};
use revmap::error::{Error, Result};
use revmap::maps::{Bounds, MapSource, ShapeMap};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

/// The keyword of the text chunk or attribute.
pub(crate) const KEYWORD: &str = "revmap";

/// The words of a header.
#[derive(Debug, Default)]
pub(crate) struct Header {
    words: HashMap<String, String>,
}

impl Header {
    /// Splits a header's line.
    pub fn parse(text: &str) -> Self {
        let words = text
            .split_whitespace()
            .filter_map(|word| word.split_once('='));
        Self {
            words: words.map(|(k, v)| (k.to_owned(), v.to_owned())).collect(),
        }
    }

    /// The header of a PNG file, if it has one.
    pub fn of_png(bytes: &[u8]) -> Option<Self> {
        let reader = png::Decoder::new(Cursor::new(bytes)).read_info().ok()?;
        let chunks = &reader.info().uncompressed_latin1_text;
        chunks
            .iter()
            .find(|c| c.keyword == KEYWORD)
            .map(|c| Self::parse(&c.text))
    }

    /// The kind of map in the file: `shape` or `displacement`.
    pub fn kind(&self) -> Option<&str> {
        self.words.get("kind").map(String::as_str)
    }

    /// A finite number.
    pub fn number(&self, key: &str) -> Result<f64> {
        let number = self.words.get(key).and_then(|v| v.parse().ok());
        let finite = number.filter(|v: &f64| v.is_finite());
        finite.ok_or_else(|| lacks(key))
    }

    pub(super) fn source(&self) -> Result<MapSource> {
        let word = self.words.get("source").ok_or_else(|| lacks("source"))?;
        let mut sources = MAP_SOURCES.into_iter().map(|(_, source)| source);
        let found = sources.find(|source| source.name == word);
        found.ok_or_else(|| lacks("source"))
    }

    pub(super) fn bounds(&self) -> Result<Bounds> {
        Ok(Bounds {
            r_min: self.number("r_min")?,
            r_max: self.number("r_max")?,
            z_min: self.number("z_min")?,
            z_max: self.number("z_max")?,
        })
    }
}

/// Writes a map as a PNG with a header.
pub(super) fn write_png_map(
    path: &Path,
    size: [u32; 2],
    kind: (png::ColorType, png::BitDepth),
    header: String,
    data: &[u8],
) -> Result<()> {
    write_atomically(path, |writer| {
        encode(writer, size, kind, data, |encoder| {
            encoder.add_text_chunk(KEYWORD.to_owned(), header)
        })
    })
}

fn lacks(key: &str) -> Error {
    file_fault(format!(
        "the map's header lacks a good `{key}`; bake the map again"
    ))
}

/// The header of a shape map; `scale` is that of its distance channel.
pub(super) fn shape_header(map: &ShapeMap, scale: f32) -> String {
    let Bounds {
        r_min,
        r_max,
        z_min,
        z_max,
    } = map.bounds;
    format!(
        "kind=shape source={} radius={} scale={scale} r_min={r_min} r_max={r_max} z_min={z_min} z_max={z_max}",
        map.source.name, map.radius
    )
}
