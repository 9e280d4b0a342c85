//! Files of [`revmap`]: what turns a file into an outline, a texture or a scene, and a frame
//! into a file.
//!
//! The library draws values in memory. This crate reads them: a profile from an SVG drawing or a
//! picture, a whole scene from TOML.
//!
//! ```no_run
//! use revmap::{gpu::Device, scene::Object, settings::Settings};
//! use revmap_files::ProfileAxis;
//!
//! // A scene file with all that it names, and one object more.
//! let mut scene = revmap_files::scene("board.toml")?;
//! let pawn = revmap_files::profile("pawn.svg", ProfileAxis::Center)?;
//! scene.objects.push(Object::new("pawn", pawn.into()));
//!
//! let device = Device::open(None)?;
//! let drawn = revmap_offscreen::draw(&device, &scene, &Settings::default())?;
//! revmap_files::write_png(&drawn.frame, "board.png")?;
//! revmap_files::write_exr(&drawn.frame, "board.exr")?;
//! # Ok::<(), revmap::Error>(())
//! ```
//!
//! | file | read | written |
//! |---|---|---|
//! | profile: SVG, svgz, PNG, JPEG | [`profile`](profile()), [`profile_from_bytes`] | [`write_outline`] (SVG) |
//! | scene: TOML, with CSV for copies | [`scene`](scene()), [`SceneFile`] for scenes that differ in some keys | [`SceneFile::text`] |
//! | textures: PNG, JPEG | [`color_map`], [`displacement_map`] | [`write_displacement_map`] |
//! | shape map: PNG, EXR | [`shape_map`] | [`write_shape_map`] |
//! | frame: PNG (colour), EXR (all planes) | [`read_exr`] | [`write_png`], [`write_exr`] |
//! | mesh: glTF, OBJ, STL | | [`write_meshes`] |
//!
//! A failure is an [`Error`] that names file, key and remedy. No file is left half
//! written ([`write_atomically`]).
//!
//! Pictures are [traced](trace()): their outline is the curve at which they pass one half of grey.
//! [`raster`] has the way back, from an outline to pixels. The [sources of distance](MAP_SOURCES)
//! that are measured in pixels exist for comparison with the papers.

mod atomic_file;
mod faults;
mod jpeg_end;
mod maps;
mod mesh;
mod openexr;
mod outline;
mod picture;
mod pixels;
mod profile;
pub mod raster;
pub mod scene;
mod trace;

pub use atomic_file::{
    Sink, check_writable, destination, remove_unfinished, write_atomically, write_bytes,
};
pub use maps::{
    BINARY, COVERAGE, MAP_SOURCES, color_map, displacement_map, projection_of, shape_map,
    write_displacement_map, write_shape_map,
};
pub use mesh::{MESH_ENDINGS, mesh_files, stl_rounding, write_meshes};
pub use openexr::{read_exr, write_exr};
pub use outline::{WrittenOutline, write_outline};
pub use picture::{Picture, write_png};
pub use profile::{
    ProfileAxis, ProfileOptions, ProfileRead, Smooth, profile, profile_from_bytes, show_outline,
};
pub use scene::{SceneFile, scene, warnings};
pub use trace::trace;

use revmap::error::{Error, ErrorKind};
use revmap::frame::linear_from_srgb;
use std::io::Read as _;

/// A picture as the bytes of a PNG.
#[cfg(test)]
#[allow(clippy::unwrap_used)]
fn png_bytes(picture: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let picture = picture.into();
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}

/// Most bytes of a file that is read.
const MOST_BYTES: u64 = 1 << 30;

/// All bytes of a file, which may be a pipe. A device without end is refused, too.
fn read_bytes(path: &std::path::Path) -> std::io::Result<Vec<u8>> {
    let checked = |size: u64| match size <= MOST_BYTES {
        true => Ok(size as usize),
        false => Err(std::io::Error::new(
            std::io::ErrorKind::FileTooLarge,
            "holds more than 1 GiB",
        )),
    };
    let file = std::fs::File::open(path)?;
    let mut bytes = Vec::new();
    bytes.try_reserve(checked(file.metadata()?.len())?)?;
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    checked(bytes.len() as u64).map(|_| bytes)
}

/// What a file's name ends in, in small letters.
fn ending(path: &std::path::Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}

/// Reads a colour of CSS, such as `orange`, `#e0a030` or `rgb(224 160 48 / 50%)`, as linear red,
/// green and blue, not premultiplied, and alpha. `None` for other text.
///
/// ```
/// assert_eq!(revmap_files::css_color("lime"), Some([0.0, 1.0, 0.0, 1.0]));
/// assert_eq!(revmap_files::css_color("greenish"), None);
/// ```
#[must_use]
pub fn css_color(text: &str) -> Option<[f32; 4]> {
    let [r, g, b, alpha] = revmap_drawing::css_color(text)?;
    let [r, g, b] = [r, g, b].map(|v| linear_from_srgb(v.into()) as f32);
    Some([r, g, b, alpha])
}

/// A failure of a file.
fn file_fault(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::File, message)
}

/// A failure of a file's content.
fn content_fault(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Content, message)
}
