//! The host of `examples/forward`: its own light on meshes and solids.

#[path = "../../examples/forward/main.rs"]
mod forward;

/// A revolved ball and a mesh of a ball look alike under the host's light; validation is silent.
#[test]
fn solids_are_lit_like_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let [mesh, none] = forward::run(folder.path().to_str().unwrap(), true).unwrap();
    println!("pixels that differ: {mesh} with a mesh, {none} without a ball");
    assert!(mesh < 50 && none > 10_000, "{mesh}, {none}");
}

/// The bytes of the example are what its GLSL gives.
#[test]
#[cfg(feature = "shaderc")] // compiles GLSL at run time
fn kept_bytes_are_what_the_glsl_gives() {
    crate::common::assert_kept_shading("forward", "light.glsl", forward::SHADING);
}
