//! The SPIR-V of the mesh baseline. Without shaderc it is taken from `shaders/spirv/`, which
//! `REVMAP_KEEP_SPIRV=1 cargo build` renews.

use shaderc_link::modules::{Fallible, Module, Modules, files_in};
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=shaders");
    if let Err(error) = generate() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

fn generate() -> Fallible<()> {
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let module = |entry: &'static str| Module {
        name: entry.to_owned(),
        entry,
        macros: Vec::new(),
        hook: None,
        optimized: false,
    };
    let mesh = Modules {
        entries: &["shaders"],
        includes: &["shaders"],
        kept: "shaders/spirv",
        all: ["mesh.vert", "mesh_color.frag", "mesh_planes.frag"]
            .map(module)
            .into(),
    };
    let sources = files_in("shaders", &["vert", "frag", "glsl"])?;
    std::fs::write(out.join("mesh.rs"), mesh.embed(&sources)?)?;
    Ok(())
}
