//! Compiles the floor's shaders where the feature `shaderc` is on: those of the renderer, with what
//! `shaders/floor/` has in place of theirs. None is kept in the repository: they are for measuring
//! alone.

use std::error::Error;
use std::fmt::Write as _;
#[cfg(feature = "shaderc")]
use std::path::Path;
use std::path::PathBuf;

type Fallible<T> = Result<T, Box<dyn Error>>;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=shaders/floor");
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
    Ok(())
}

#[cfg(not(feature = "shaderc"))]
fn compiled() -> Fallible<Vec<(String, Vec<u32>)>> {
    Ok(Vec::new())
}

/// Every module: its file's name, then what it was compiled for.
#[cfg(feature = "shaderc")]
fn compiled() -> Fallible<Vec<(String, Vec<u32>)>> {
    const VARIANTS: [&[(&str, &str)]; 3] = [
        &[],
        &[("TEXTURED", "1")],
        &[("TEXTURED", "1"), ("OUTPUT", "OUTPUT_PLANES")],
    ];
    let entries = [
        ("hull.frag", None),
        ("box.frag", None),
        ("box.frag", Some("DISPATCH_BEAMS")),
        ("bins.frag", None),
        ("listed.comp", Some("DISPATCH_LISTS")),
        ("trace.comp", None),
        ("trace.comp", Some("DISPATCH_BEAMS")),
        ("trace.comp", Some("DISPATCH_BINS")),
    ];
    let compiler = shaderc_link::Compiler::new()?;
    let mut modules = vec![module(&compiler, "hull.vert", &[])?];
    for (file, dispatch) in entries {
        for macros in VARIANTS {
            let mut all = vec![("SEARCH", "SEARCH_QUADRIC"), ("OWN_TABLES", "1")];
            all.extend(macros);
            all.extend(dispatch.map(|dispatch| ("DISPATCH", dispatch)));
            modules.push(module(&compiler, file, &all)?);
        }
    }
    Ok(modules)
}

#[cfg(feature = "shaderc")]
fn module(
    compiler: &shaderc_link::Compiler,
    file: &str,
    macros: &[(&str, &str)],
) -> Fallible<(String, Vec<u32>)> {
    let (path, source) = read(file, "../../shaders-glsl")?;
    let source = (path.as_str(), source.as_str());
    let level = shaderc_link::OptimizationLevel::Performance;
    let made = shaderc_link::spirv(compiler, source, macros, level, include)?;
    Ok((name(file, macros), made.as_binary().to_vec()))
}

/// As `floor.rs` has it.
#[cfg(feature = "shaderc")]
fn name(file: &str, macros: &[(&str, &str)]) -> String {
    let has = |name: &str| {
        macros
            .iter()
            .find(|(n, _)| *n == name)
            .map(|(_, value)| *value)
    };
    format!(
        "{file} {} {} {}",
        has("OUTPUT").unwrap_or("OUTPUT_COLOR"),
        has("DISPATCH").unwrap_or("DISPATCH_RECTANGLE"),
        has("TEXTURED").unwrap_or("0"),
    )
}

#[cfg(feature = "shaderc")]
fn include(wanted: &str) -> Result<(String, String), String> {
    read(wanted, "../../shaders-glsl/include")
}

/// A file's path and text: the floor's, or else the renderer's.
#[cfg(feature = "shaderc")]
fn read(wanted: &str, renderer: &str) -> Result<(String, String), String> {
    let path = ["shaders/floor", renderer]
        .iter()
        .map(|folder| Path::new(folder).join(wanted))
        .find(|path| path.exists())
        .ok_or_else(|| format!("{wanted}: there is no such file"))?;
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok((path.to_string_lossy().into_owned(), text))
}
