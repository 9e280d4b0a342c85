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
    let text = |name: &str| std::fs::read_to_string(format!("examples/forward/{name}")).unwrap();
    let [shade, light] = ["shade.glsl", "light.glsl"].map(text);
    let files = [
        ("examples/forward/shade.glsl", &*shade),
        ("light.glsl", &*light),
    ];
    let stage = revmap::settings::DrawStage::Fragment;
    let made = revmap::shading::Shading::compile(stage, &files).unwrap();
    assert!(
        made.to_bytes().unwrap() == forward::SHADING,
        "shaders changed; renew shade.shading by the command that examples/forward/main.rs names"
    );
}
