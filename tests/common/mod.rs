//! Common code of GPU tests: one validated device, scenes, and drawing that fails on any message of
//! the layers.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod drawing;
pub mod host;
pub mod passing;
mod scenes;
pub mod shapes;
pub mod ways;

pub use drawing::*;
pub use scenes::*;
pub use shapes::offset;
