//! What GPU tests share: one validated device, scenes, and drawing with any message of the layers a
//! failure.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod drawing;
pub mod host;
pub mod passing;
mod scenes;
pub mod shapes;
pub mod ways;

pub use drawing::*;
pub use scenes::*;
