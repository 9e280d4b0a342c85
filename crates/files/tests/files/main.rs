//! Files as a program reads and writes them: those of the repository, damaged ones, and maps of
//! every source.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod annotation;
mod browser_rules;
mod damaged_files;
mod drawings;
mod far_meshes;
mod map_accuracy;
mod meshes;
mod outlines;
mod profiles;
mod scenes;
mod seeming;
mod shape_maps;

/// Wants `words` in a text, such as that of an error.
#[track_caller]
fn holds(text: impl std::fmt::Display, words: &str) {
    let text = text.to_string();
    assert!(text.contains(words), "{words}: {text}");
}

/// A file of the repository's `assets`.
fn asset(name: &str) -> std::path::PathBuf {
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets");
    std::path::Path::new(assets).join(name)
}

/// A picture as the bytes of a PNG.
fn png(picture: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    let picture = picture.into();
    picture.write_to(&mut out, image::ImageFormat::Png).unwrap();
    out.into_inner()
}
