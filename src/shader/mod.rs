//! What `build.rs` makes of `shaders-glsl/`, and the variants that pipelines are made for.

mod list;
mod module;
mod reachable;
mod variant;

pub use list::{Dispatch, Module};
pub use module::{depth_less, listed, words};
pub(crate) use variant::is_beveled;
pub use variant::{Kind, Met, Variant};

/// Hashes, specialisation ids and values; names as in the GLSL.
// Numbers that the shaders alone read are listed, too, and what only tests compare.
#[allow(clippy::unreadable_literal, dead_code)]
pub mod generated {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

#[cfg(test)]
mod tests;
