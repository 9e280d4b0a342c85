//! With the feature `shaderc` the SPIR-V of the floor: the renderer's GLSL with what
//! `shaders/floor/` has in place. It is not kept.

use shaderc_link::modules::{self, Fallible};
#[cfg(feature = "shaderc")]
use shaderc_link::modules::{Module, Modules};
use std::fmt::Write as _;
use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=shaders");
    println!("cargo::rerun-if-changed=../../shaders-glsl");
    modules::run(generate);
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
    Ok(())
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
        "tree.frag",
        "walk.frag",
        "tile_patches.comp",
        "culled_tiles.comp",
        "walk.comp",
    ];
    let mut all = vec![module("proxy_cells.vert", Vec::new())];
    for file in entries {
        let search = [("SEARCH", "SEARCH_QUADRIC"), ("REPEATED", "1")];
        let color = match file.ends_with(".frag") {
            true => [search.as_slice(), &[("OUTPUT", "OUTPUT_LIST")]].concat(),
            false => search.to_vec(),
        };
        all.push(module(file, color));
        let planes = [("OUTPUT", "OUTPUT_PLANES")];
        all.push(module(file, [search.as_slice(), &planes].concat()));
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
fn module(entry: &'static str, macros: Vec<(&'static str, &'static str)>) -> Module {
    let value = |name: &str| macros.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
    let output = value("OUTPUT").unwrap_or("OUTPUT_COLOR");
    Module {
        name: format!("{entry} {output}"),
        entry,
        macros,
        hook: None,
        optimized: true,
    }
}
