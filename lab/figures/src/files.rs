//! Files of a folder of results, each written whole or not at all.

use crate::chart::Figure;
use crate::chart::svg::svg;
use revmap::error::{Error, ErrorKind, Result};
use revmap_files::Picture;
pub use revmap_files::write_bytes;
use std::path::Path;

/// Makes a folder and those above it.
pub fn make(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| {
        let message = format!("cannot be made ({e}); choose another folder");
        Error::new(ErrorKind::File, message).in_file(folder)
    })
}

/// Writes a text file, whole or not at all.
pub fn write_text(file: &Path, text: &str) -> Result<()> {
    write_bytes(file, text.as_bytes())
}

/// Writes a figure into `folder/charts`: as SVG.
pub fn keep_figure(folder: &Path, name: &str, figure: &Figure) -> Result<()> {
    let charts = folder.join("charts");
    make(&charts)?;
    write_text(&charts.join(format!("{name}.svg")), &svg(figure))
}

/// A picture as a PNG file.
pub fn png(picture: &Picture) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    picture.encode_png(&mut bytes)?;
    Ok(bytes)
}
