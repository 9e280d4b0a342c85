//! The compilation of a folder's GLSL, as the library's own modules are compiled: the same entry
//! files, macros, compiler and optimiser. The words are kept on disk by all that goes into them.

use super::Folder;
use crate::manifest::Data;
use revmap::error::{Error, ErrorKind, Result};
use revmap::search::{Pass, SearchModule, StoredPlanes};
use revmap::settings::Solver;
use std::fmt::Write as _;

/// True if the program was built with the compiler.
pub const fn is_available() -> bool {
    cfg!(feature = "shaderc")
}

/// Compiles a folder's search for both stages; searches of crates are compiled already.
///
/// # Errors
/// The compiler's first error, with the place in the folder's own file.
pub fn compile(solver: Solver) -> Result<()> {
    let Some(folder) = super::of(solver) else {
        return Ok(());
    };
    for pass in [Pass::Fragment, Pass::Compute] {
        words(
            folder,
            &SearchModule {
                pass,
                output: StoredPlanes::Color,
                table: !folder.manifest.reads.is_map(),
                bounded: folder.manifest.steps.is_some(),
            },
        )?;
    }
    Ok(())
}

/// A look-up of a binary picture.
const BINARY_MAP: &str = "\
// True if the texel that holds a point is solid.
bool solid(vec2 rz)
{
    vec2 texel = floor(vec2(rz.x, 1.0 - rz.y) * shape.map_size.y) + 0.5;
    return field(vec2(0.0, 1.0) + vec2(1.0, -1.0) * texel * shape.texel) <= 0.0;
}
";

/// The table of a program.
const TABLE: &str = "\
vec4 table_vector(uint i) { return patch_vector(i); }
uint table_length() { return shape.table_fact_0; } // vectors
uint table_rows() { return shape.table_fact_1; } // --map-rows
";

/// Marks in the number of steps: a value that no search returns, and a hit that is no number.
/// Frames with every plane have them.
pub(super) const WRONG_VALUE: u32 = 1 << 28;
pub(super) const NO_NUMBER: u32 = 1 << 24;

/// The head of the search's function, and the names of its arguments.
fn function(folder: &Folder) -> (&'static str, &'static str) {
    match folder.manifest.reads.is_map() {
        true => (
            "uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)",
            "m, side, f, pixel, s, steps",
        ),
        false => (
            "uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)",
            "m, side, s, steps, quadric",
        ),
    }
}

/// The text in place of `search/hook.glsl`: parameters, helpers, the folder's file, and checks
/// around its function where the frame has a place for them.
fn hook(folder: &Folder, module: &SearchModule) -> String {
    let own = &folder.manifest;
    let mut text = String::new();
    for (name, value) in &folder.values {
        let kind = if let crate::manifest::Number::Int(_) = value {
            "int"
        } else {
            "float"
        };
        let _ = writeln!(text, "const {kind} {name} = {value};");
    }
    match own.reads {
        Data::Map => {}
        Data::BinaryMap => text += BINARY_MAP,
        Data::Patches => text += "bool starts_in_table(Meridian m) { return starts_within(m); }\n",
        Data::Table => text += TABLE,
    }
    if own.reads == Data::Table && !own.inside {
        text += "bool starts_in_table(Meridian m) { return false; }\n";
    }
    let checks = module.output == StoredPlanes::Planes;
    if own.inside && !checks {
        let _ = writeln!(text, "#include \"{}\"", own.glsl);
        return text;
    }
    let (head, arguments) = function(folder);
    let _ = write!(
        text,
        "#define search own_search\n#include \"{}\"\n#undef search\n{head}\n{{\n",
        own.glsl
    );
    if !own.reads.is_map() {
        text += "    quadric = vec4(0.0);\n";
    }
    if !own.inside {
        text += "    if (side < 0.0) { return LEFT; }\n";
    }
    let _ = writeln!(text, "    uint end = own_search({arguments});");
    if checks {
        let hit = match own.reads.is_map() {
            true => "vec4(s)",
            false => "quadric + s",
        };
        let _ = writeln!(
            text,
            "    bool hit = end == FOUND || end == NEARLY;\n    \
             vec4 number = {hit};\n    \
             steps += end > NEARLY ? {WRONG_VALUE}u : hit && (any(isnan(number)) || any(isinf(number))) ? {NO_NUMBER}u : 0u;"
        );
    }
    text + "    return end > NEARLY ? LEFT : end;\n}\n"
}

#[cfg(not(feature = "shaderc"))]
pub(super) fn words(folder: &Folder, module: &SearchModule) -> Result<Vec<u32>> {
    let _ = (hook(folder, module), function(folder));
    let message =
        "this program was built without the feature `shaderc`, which compiles searches of folders";
    Err(Error::new(ErrorKind::Usage, message).in_file(&folder.path))
}

#[cfg(feature = "shaderc")]
pub(super) use compiler::words;

#[cfg(feature = "shaderc")]
mod compiler {
    use super::super::returns;
    use super::*;
    use crate::{cache, modules::generated as g};
    use shaderc_link::modules::Fnv;
    use shaderc_link::{Compiler, OptimizationLevel, complaints, spirv};

    /// The library's GLSL: names in `#include`, texts.
    const LIBRARY: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/library.rs"));

    /// The words of a module, from the cache or from the compiler.
    pub fn words(folder: &Folder, module: &SearchModule) -> Result<Vec<u32>> {
        let hook = hook(folder, module);
        let kept = cache::folder().map(|cache| {
            let key = key(folder, module, &hook);
            cache.join("searches").join(format!("{key:016x}.spv"))
        });
        if let Some(bytes) = kept.as_deref().and_then(cache::read) {
            let words = bytes.as_chunks().0.iter().copied();
            return Ok(words.map(u32::from_le_bytes).collect());
        }
        let words = compiled(folder, module, &hook)?;
        if let Some(file) = &kept {
            let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
            cache::write(file, &bytes);
        }
        Ok(words)
    }

    /// A hash of all that decides on the words.
    fn key(folder: &Folder, module: &SearchModule, hook: &str) -> u64 {
        let version = concat!(env!("CARGO_PKG_VERSION"), " returns checked");
        let program = format!("{version} {:x} {:x}", g::SOURCES_HASH, g::COMPILER_HASH);
        let module = format!("{} {:?}", module.entry(), module.macros());
        let mut hash = Fnv::default();
        for part in [&program, &module, hook] {
            hash.add(part.as_bytes());
            hash.add(&[0]);
        }
        for (name, _, text) in &folder.sources {
            hash.add(name.as_bytes());
            hash.add(&[0]);
            hash.add(text.as_bytes());
            hash.add(&[0]);
        }
        hash.value()
    }

    fn compiled(folder: &Folder, module: &SearchModule, hook: &str) -> Result<Vec<u32>> {
        let failed = |e: shaderc_link::Error| Error::new(ErrorKind::Other, e.to_string());
        let compiler = Compiler::new().map_err(failed)?;
        let library = |name: &str| LIBRARY.iter().find(|(known, _)| *known == name);
        let include = |wanted: &str| {
            if wanted == "search/hook.glsl" {
                return Ok((wanted.to_owned(), hook.to_owned()));
            }
            let own = folder.sources.iter().find(|(name, ..)| name == wanted);
            let own = own.map(|(_, path, text)| (path.display().to_string(), text.clone()));
            let found = own.or_else(|| {
                library(wanted).map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
            });
            found.ok_or_else(|| {
                format!(
                    "{wanted}: there is no such file in the folder, beside it or in the library"
                )
            })
        };
        let entry = module.entry();
        let text = library(entry).map_or("", |(_, text)| text);
        let made_at = |level| spirv(&compiler, (entry, text), &module.macros(), level, include);
        // Words that are not optimised show whether a function can end without a return.
        if let Ok(plain) = made_at(OptimizationLevel::Zero)
            && let Some(name) = returns::missing(plain.as_binary())
        {
            let value = if name == "search" {
                "EXHAUSTED"
            } else {
                "false"
            };
            let message = format!(
                "the function `{name}` can end without a return; end it with one, such as `return {value};`"
            );
            return Err(Error::new(ErrorKind::Content, message).in_file(folder.glsl()));
        }
        let made = made_at(OptimizationLevel::Performance);
        let made =
            made.map_err(|e| Error::new(ErrorKind::Content, message(folder, &e.to_string())))?;
        Ok(made.as_binary().to_vec())
    }

    /// The compiler's first error in a file of the folder, as `file:line: text`. An error elsewhere
    /// means that the folder's function does not fit.
    fn message(folder: &Folder, text: &str) -> String {
        // Warnings count as errors.
        let all = complaints(text);
        let lines = || all.iter().map(|line| line.replace("own_search", "search"));
        let own = |line: &String| {
            let starts = |(_, path, _): &(_, std::path::PathBuf, _)| {
                line.starts_with(&format!("{}:", path.display()))
            };
            folder.sources.iter().any(starts)
        };
        let more = match lines().filter(own).count() {
            0 | 1 => String::new(),
            count => format!(" (and {} more)", count - 1),
        };
        if let Some(line) = lines().find(own) {
            return format!("{}{more}", line.trim());
        }
        let file = folder.glsl().display();
        let head = function(folder).0;
        if let Some((place, kind)) = returned(folder) {
            return format!(
                "{place}: search returns {kind}; the function that is called is `{head}`"
            );
        }
        let other = lines().next().unwrap_or_else(|| text.replace('\n', " "));
        if other.contains("'starts_in_table'") {
            return format!(
                "{file}: search.toml says inside = true: define `bool starts_in_table(Meridian m)`, or set inside = false"
            );
        }
        format!(
            "{file}: does not define the function that is called, `{head}`: {}",
            other.trim()
        )
    }

    /// The place and the type of a folder's `search`, if the type is not `uint`.
    fn returned(folder: &Folder) -> Option<(String, String)> {
        folder.sources.iter().find_map(|(_, path, text)| {
            let mut lines = text.lines().zip(1..);
            lines.find_map(|(line, number)| {
                let (kind, rest) = line.trim_start().split_once(char::is_whitespace)?;
                let rest = rest.trim_start().strip_prefix("search")?;
                let word = |c: char| c.is_alphanumeric() || c == '_';
                let is_other = kind != "uint" && !kind.is_empty() && kind.chars().all(word);
                (is_other && kind != "return" && rest.trim_start().starts_with('('))
                    .then(|| (format!("{}:{number}", path.display()), kind.to_owned()))
            })
        })
    }
}
