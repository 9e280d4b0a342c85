//! The SPIR-V of the mesh baseline. Without shaderc it is taken from `shaders/spirv/`, which
//! `REVMAP_KEEP_SPIRV=1 cargo build` renews.

use shaderc_link::modules::{self, Fallible, Module, Modules, files_in};
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=shaders");
    modules::run(generate);
}

fn generate() -> Fallible<()> {
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let module = |(entry, name, shadows): (&'static str, &str, bool)| Module {
        name: name.to_owned(),
        entry,
        macros: shadows.then_some(("SHADOWS", "1")).into_iter().collect(),
        hook: None,
        optimized: false,
    };
    let mesh = Modules {
        entries: &["shaders"],
        includes: &["shaders"],
        kept: "shaders/spirv",
        all: [
            ("mesh.vert", "mesh.vert", false),
            ("mesh_color.frag", "mesh_color.frag", false),
            ("mesh_planes.frag", "mesh_planes.frag", false),
            ("mesh_color.frag", "shadowed_color.frag", true),
            ("mesh_planes.frag", "shadowed_planes.frag", true),
            ("caster.vert", "caster.vert", false),
        ]
        .map(module)
        .into(),
    };
    let sources = files_in("shaders", &["vert", "frag", "glsl"])?;
    std::fs::write(out.join("mesh.rs"), mesh.embed(&sources)?)?;
    Ok(())
}
