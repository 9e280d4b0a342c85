//! The library's public parts that need no device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/cpu.rs"]
mod common;

mod antialias;
mod contours;
#[cfg(all(
    feature = "drawing",
    feature = "exr",
    feature = "jpeg",
    feature = "scene-file"
))]
mod damaged_files;
#[cfg(feature = "drawing")]
mod hull_rays;
mod map_accuracy;
#[cfg(feature = "drawing")]
mod profiles;
#[cfg(all(feature = "drawing", feature = "scene-file"))]
mod scenes;
#[cfg(feature = "drawing")]
mod surface;
