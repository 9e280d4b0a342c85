//! The GLSL of `shaders-glsl/` in Rust: modules and numbers that `build.rs` makes of it, blocks of
//! data that it reads, and the variants from which pipelines are made.

mod blocks;
mod catalogue;
mod external;
mod frozen;
mod module;
mod outputs;
mod rounding;
mod spirv;
mod technique;
mod textures;
mod variant;

pub use blocks::{
    AppearanceBlock, BinTile, CasterRoot, FrameBlock, FrameView, InstanceBlock, LastCopy,
    LevelTables, LightBlock, OBJECT_STRIDE, ObjectBlock, PlacedEye, Pushed, ShapeBlock, WalkNode,
};
#[cfg(test)]
pub(crate) use catalogue::modules;
#[cfg(feature = "shaderc")]
pub use catalogue::shading_macros;
pub use catalogue::{Module, SearchCode, shading_modules};
pub use frozen::frozen;
pub use module::words;
pub use outputs::{with_locations, with_outputs_for};
pub use rounding::without_contraction;
pub use spirv::{depth_less, instructions, op};
pub(crate) use technique::is_beveled;
pub use technique::{Demands, HostLook, ShadowCasters, Technique};
pub use textures::{with_constant_textures, with_varying_textures};
#[cfg(feature = "other-shaders")]
pub(crate) use variant::Outside;
pub use variant::{Drawn, Kind, Lights, Speciality, Variant};

/// Hashes, specialisation ids and values; names as in the GLSL.
// The list includes numbers that only the shaders read, or that only tests compare.
#[allow(dead_code)]
pub mod generated {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

#[cfg(test)]
mod tests;
