//! The library's public parts that need no device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/cpu.rs"]
mod common;

mod antialias;
mod cast;
mod contours;
mod hull_gaps;
mod hull_rays;
mod surface;
