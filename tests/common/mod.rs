//! Common code of GPU tests: one validated device, scenes, and drawing that fails on any message of
//! the layers.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod change;
mod drawing;
pub mod host;
pub mod outlines;
pub mod passing;
pub mod prelude;
pub mod random;
mod scenes;
pub mod shapes;
pub mod ways;

pub use drawing::*;
pub use scenes::*;
pub use shapes::offset;

/// An upright copy of this size.
pub fn scaled(position: [f64; 3], size: f64) -> revmap::scene::Placement {
    placement(position, [0.0; 3], [size; 3])
}
