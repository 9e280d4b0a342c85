//! The compilation of a host's GLSL behind the library's entry files.

use crate::error::{Error, ErrorKind, Result};
use crate::shader::{Module, shading_macros};
use shaderc_link::{Compiler, OptimizationLevel, complaints, spirv};

/// The library's GLSL: names in `#include`, texts.
const LIBRARY: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/library.rs"));

/// The head of the function that the host defines.
const FUNCTION: &str = "vec4 host_shade(Surface surface)";

/// The host's files: names and texts. The first defines the function.
pub(super) struct Source(Vec<(String, String)>);

fn library(name: &str) -> Option<&'static str> {
    let found = LIBRARY.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| *text)
}

impl Source {
    pub fn new(files: &[(&str, &str)]) -> Result<Self> {
        let usage = |message: String| Err(Error::new(ErrorKind::Usage, message));
        if files.is_empty() {
            return usage(format!("no files; give one that defines `{FUNCTION}`"));
        }
        if let Some((name, _)) = files.iter().find(|(name, _)| library(name).is_some()) {
            return usage(format!(
                "{name}: is the name of a file of revmap; rename it"
            ));
        }
        let own = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
        Ok(Self(files.iter().map(own).collect()))
    }

    /// Compiles the module of the host that replaces one of the library.
    pub fn words(&self, module: &Module) -> Result<Vec<u32>> {
        let failed = |e: shaderc_link::Error| Error::new(ErrorKind::Other, e.to_string());
        let compiler = Compiler::new().map_err(failed)?;
        let include = |wanted: &str| {
            if let Some(text) = library(wanted) {
                return Ok((wanted.to_owned(), text.to_owned()));
            }
            let own = self.0.iter().find(|(name, _)| name == wanted);
            let own = own.map(|(name, text)| (name.clone(), without_extensions(text)));
            own.ok_or_else(|| format!("{wanted}: there is no such file; give its text, too"))
        };
        let file = module.entry.file();
        let made = spirv(
            &compiler,
            (file, &self.entry(file)),
            &shading_macros(module),
            OptimizationLevel::Performance,
            include,
        );
        let made =
            made.map_err(|e| Error::new(ErrorKind::Content, self.message(&e.to_string())))?;
        Ok(made.as_binary().to_vec())
    }

    /// The entry file with the host's extensions at its head and the host's text at its end.
    fn entry(&self, file: &str) -> String {
        let text = library(file).unwrap_or_default();
        let (version, rest) = text.split_once('\n').unwrap_or_default();
        let lines = self.0.iter().flat_map(|(_, text)| text.lines());
        let extensions: Vec<&str> = lines.filter(|line| is_extension(line)).collect();
        let name = self.0.first().map_or("", |(name, _)| name);
        let extensions = extensions.join("\n");
        format!("{version}\n{extensions}\n{rest}\n#include \"{name}\"\n")
    }

    /// The compiler's first message about a file of the host, as `file:line: text`. A message about
    /// another place means that the function is missing.
    fn message(&self, text: &str) -> String {
        let all = complaints(text);
        let is_own = |line: &&String| {
            let mut names = self.0.iter().map(|(name, _)| name);
            names.any(|name| line.starts_with(&format!("{name}:")))
        };
        let own: Vec<_> = all.iter().filter(is_own).collect();
        match own.as_slice() {
            [one] => one.trim().to_owned(),
            [first, more @ ..] => format!("{} (and {} more)", first.trim(), more.len()),
            [] => {
                let name = self.0.first().map_or("", |(name, _)| name);
                if text.contains("No function definition") && text.contains("host_shade(") {
                    return format!("{name}: does not define `{FUNCTION}`; define it");
                }
                format!("{name}: does not fit the GLSL of revmap: {}", text.trim())
            }
        }
    }
}

/// True for a directive that GLSL allows only before all declarations.
fn is_extension(line: &str) -> bool {
    let directive = line.trim_start().strip_prefix('#');
    directive.is_some_and(|rest| rest.trim_start().starts_with("extension"))
}

/// The text with empty lines in place of its extensions, which are at the head of the module.
fn without_extensions(text: &str) -> String {
    let kept = |line| if is_extension(line) { "" } else { line };
    let lines: Vec<&str> = text.lines().map(kept).collect();
    lines.join("\n") + "\n"
}
