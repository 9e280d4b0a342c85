//! What `build.rs` makes of `shaders-glsl/`, and the variants a pipeline is specialised for.

mod variant;

pub use variant::Variant;

/// SPIR-V words, specialisation ids and values; names as in the GLSL.
#[allow(clippy::unreadable_literal)]
pub mod generated {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}
