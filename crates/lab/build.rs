//! The SPIR-V of the mesh baseline, and with the feature `shaderc` that of the floor. Without it
//! the mesh's is taken from `shaders/spirv/`, which `REVMAP_KEEP_SPIRV=1 cargo build` renews. The
//! floor's is the renderer's with what `shaders/floor/` has in place, and is not kept.

use shaderc_link::modules::{Fallible, Module, Modules, files_in};
use std::fmt::Write as _;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=shaders");
    println!("cargo::rerun-if-changed=../../shaders-glsl");
    if let Err(error) = generate() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

fn generate() -> Fallible<()> {
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let modules = compiled()?;
    let mut text = format!("static MODULES: [(&str, &[u32]); {}] = [\n", modules.len());
    for (name, words) in modules {
        writeln!(text, "    ({name:?}, &{words:?}),")?;
    }
    text.push_str("];\n");
    std::fs::write(out.join("floor.rs"), text)?;
    let mesh = ["mesh.vert", "mesh_color.frag", "mesh_planes.frag"];
    let mesh = Modules {
        entries: &["shaders"],
        includes: &["shaders"],
        kept: "shaders/spirv",
        all: mesh
            .map(|entry| module(entry.to_owned(), entry, Vec::new(), false))
            .into(),
    };
    let sources = files_in("shaders", &["vert", "frag", "glsl"])?;
    std::fs::write(out.join("mesh.rs"), mesh.embed(&sources)?)?;
    Ok(())
}

fn module(
    name: String,
    entry: &'static str,
    macros: Vec<(&'static str, &'static str)>,
    optimized: bool,
) -> Module {
    Module {
        name,
        entry,
        macros,
        hook: None,
        optimized,
    }
}

#[cfg(not(feature = "shaderc"))]
fn compiled() -> Fallible<Vec<(String, Vec<u32>)>> {
    Ok(Vec::new())
}

/// Every module: its file's name, then what it was compiled for.
#[cfg(feature = "shaderc")]
fn compiled() -> Fallible<Vec<(String, Vec<u32>)>> {
    let entries = [
        "cells.frag",
        "tiles.frag",
        "tree.frag",
        "tile_patches.comp",
        "tile_tree.comp",
        "tile_copies.comp",
    ];
    let mut all = vec![floor_module("proxy_cells.vert", Vec::new())];
    for file in entries {
        let search = ("SEARCH", "SEARCH_QUADRIC");
        all.push(floor_module(file, vec![search]));
        all.push(floor_module(
            file,
            vec![search, ("OUTPUT", "OUTPUT_PLANES")],
        ));
    }
    let modules = Modules {
        entries: &["shaders/floor", "../../shaders-glsl"],
        includes: &["shaders/floor", "../../shaders-glsl/include"],
        kept: "",
        all,
    };
    let words = modules.compiled()?;
    let names = modules.all.into_iter().map(|module| module.name);
    Ok(names.zip(words).collect())
}

/// Its name is as `floor.rs` has it.
#[cfg(feature = "shaderc")]
fn floor_module(entry: &'static str, macros: Vec<(&'static str, &'static str)>) -> Module {
    let value = |name: &str| macros.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
    let output = value("OUTPUT").unwrap_or("OUTPUT_COLOR");
    module(format!("{entry} {output}"), entry, macros, true)
}
