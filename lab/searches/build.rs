//! Turns `published/` into what Rust embeds: the descriptions of the searches, and the SPIR-V of
//! the modules that `src/list.rs` lists, by the entry files and includes of the library.
//!
//! With the feature `shaderc` the GLSL is compiled here, and the library's GLSL is embedded for
//! searches of other folders; without it the SPIR-V kept in `spirv/` is taken.
//! `REVMAP_KEEP_SPIRV=1 cargo build` renews what is kept.

use manifest::Manifest;
use shaderc_link::modules::{self, Fallible, Modules};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

#[allow(dead_code)]
mod list {
    include!("src/list.rs");
}

#[allow(dead_code)]
#[path = "src/manifest.rs"]
mod manifest;

#[allow(dead_code)]
#[path = "../../src/search/module.rs"]
mod module;

const LIBRARY: &str = "../../shaders-glsl";
const OWN: &str = "published";
/// Its folders, in the order of reports.
const NAMES: [&str; 6] = ["linear", "relief", "secant", "circle", "cone", "relaxed"];
const ENTRIES: [&str; 2] = ["tree.frag", "walk.comp"];
const INCLUDES: [&str; 3] = ["core", "search", "stage"];

fn main() {
    println!("cargo::rerun-if-changed={OWN}");
    modules::run(generate);
}

fn generate() -> Fallible<()> {
    let includes = format!("{LIBRARY}/include");
    let mut sources: Vec<PathBuf> = ENTRIES
        .map(|entry| format!("{LIBRARY}/{entry}").into())
        .to_vec();
    for folder in INCLUDES {
        sources.extend(modules::files_in(
            format!("{includes}/{folder}"),
            &["glsl"],
        )?);
    }
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    fs::write(out.join("library.rs"), modules::texts(LIBRARY, &sources)?)?;
    for name in NAMES {
        sources.extend(modules::files_in(format!("{OWN}/{name}"), &["glsl"])?);
    }
    sources.extend(["src/list.rs", "../../src/search/module.rs"].map(PathBuf::from));
    let all = list::modules().into_iter().map(|listed| modules::Module {
        name: listed.name(),
        entry: listed.module.entry(),
        macros: listed.module.macros(),
        hook: Some(("search/hook.glsl", listed.hook)),
        optimized: true,
    });
    let modules = Modules {
        entries: &[LIBRARY],
        includes: &[OWN, &includes],
        kept: "spirv",
        all: all.collect(),
    };
    fs::write(out.join("modules.rs"), modules.embed(&sources)?)?;
    fs::write(out.join("published.rs"), published()?)?;
    Ok(())
}

/// A constant and a static for each search.
fn published() -> Fallible<String> {
    let mut text = String::new();
    for name in NAMES {
        let path = Path::new(OWN).join(name).join(manifest::FILE);
        let read = fs::read_to_string(&path)?;
        let of = Manifest::parse(&read, true).map_err(|e| format!("{}: {e}", path.display()))?;
        let (upper, glsl) = (name.to_uppercase(), hook(name, &of));
        let reads = match &of.table {
            Some(table) => format!("Table(&{})", table.rust),
            None => format!("Map {{ rgba8: {} }}", of.unsigned),
        };
        let steps = of.steps.map_or("None".to_owned(), |s| {
            let beveled = s.beveled.unwrap_or(s.default);
            let manifest::Bound { default, most, may_run_out, .. } = s;
            format!("Some(Steps {{ default: {default}, beveled: {beveled}, most: {most}, may_run_out: {may_run_out} }})")
        });
        let full = path.canonicalize()?;
        writeln!(
            text,
            "/// {name}: {about}.\npub const {upper}: Solver = Solver::Other(&{upper}_SEARCH);\n\
             static {upper}_SEARCH: Search = Search {{ name: {name:?}, about: {about:?}, source: {source:?}, licence: {licence:?}, \
             reads: Reads::{reads}, steps: {steps}, form: {form}, words: embedded(&|module| found({glsl:?}, module)) }};\n\
             const {upper}_TOML: &str = include_str!({full:?});",
            about = of.about,
            source = of.source,
            licence = of.licence,
            form = of.form,
        )?;
    }
    let all = NAMES.map(|name| format!("({0}, {0}_TOML)", name.to_uppercase()));
    writeln!(
        text,
        "/// The searches of this crate, each with its `search.toml`.\npub(crate) const PUBLISHED: [(Solver, &str); {}] = [{}];",
        all.len(),
        all.join(", ")
    )?;
    Ok(text)
}

/// The GLSL file of a search, from the folder of all.
fn hook(name: &str, of: &Manifest) -> String {
    let own = format!("{name}/{}", of.glsl);
    match Path::new(OWN).join(&own).exists() {
        true => own,
        false => of.glsl.clone(),
    }
}
