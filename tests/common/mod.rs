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

/// Asserts that the bytes of an example's shading are what its GLSL gives.
#[cfg(feature = "shaderc")] // compiles GLSL at run time
pub fn assert_kept_shading(example: &str, lights: &str, kept: &[u8]) {
    let path = |name: &str| format!("examples/{example}/{name}");
    let [shade, light] =
        ["shade.glsl", lights].map(|name| std::fs::read_to_string(path(name)).unwrap());
    let files = [(&*path("shade.glsl"), &*shade), (lights, &*light)];
    let stage = revmap::settings::DrawStage::Fragment;
    let made = revmap::shading::Shading::compile(stage, &files).unwrap();
    assert!(
        made.to_bytes().unwrap() == kept,
        "shaders changed; renew shade.shading by the command that {} names",
        path("main.rs")
    );
}
