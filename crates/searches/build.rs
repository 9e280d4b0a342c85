//! Turns `shaders/` into the SPIR-V that Rust embeds: of the modules that `src/list.rs` lists, by the entry files and includes of the
//! library.
//!
//! With the feature `shaderc` the GLSL is compiled here; without it the SPIR-V kept in `spirv/` is taken.
//! `REVMAP_KEEP_SPIRV=1 cargo build` renews what is kept.

use shaderc_link::modules::{self, Fallible, Modules};
use std::path::PathBuf;

#[allow(dead_code)]
mod list {
    include!("src/list.rs");
}

#[allow(dead_code)]
#[path = "../../src/search/module.rs"]
mod module;

const LIBRARY: &str = "../../shaders-glsl";
const OWN: &str = "shaders";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={OWN}");
    if let Err(error) = generate() {
        for line in error.to_string().lines() {
            println!("cargo::error={line}");
        }
    }
}

fn generate() -> Fallible<()> {
    let includes = format!("{LIBRARY}/include");
    let mut sources: Vec<PathBuf> = ["tree.frag", "tile_tree.comp", "tile_copies.comp"]
        .map(|entry| format!("{LIBRARY}/{entry}").into())
        .to_vec();
    for folder in ["core", "search", "stage"] {
        let folder = format!("{includes}/{folder}");
        sources.extend(modules::files_in(folder, &["glsl"])?);
    }
    sources.extend(modules::files_in(OWN, &["glsl"])?);
    sources.extend(["src/list.rs", "../../src/search/module.rs"].map(PathBuf::from));
    let all = list::modules().into_iter().map(|listed| modules::Module {
        name: listed.name(),
        entry: listed.module.entry(),
        macros: listed.module.macros(),
        hook: Some(("search/hook.glsl", listed.hook)),
        optimized: true,
        for_tests: false,
    });
    let modules = Modules {
        entries: &[LIBRARY],
        includes: &[OWN, &includes],
        kept: "spirv",
        all: all.collect(),
    };
    let text = modules.embed(&sources)?;
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    std::fs::write(out.join("modules.rs"), text)?;
    Ok(())
}
