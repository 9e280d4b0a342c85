//! [`shaderc`](https://docs.rs/shaderc), re-exported, and how revmap compiles its GLSL. This crate's
//! build script adds the archives that Debian's and Ubuntu's `libshaderc-dev` leave out of
//! `libshaderc_combined.a`; where shaderc is whole it adds nothing.
//!
//! Without the feature `shaderc` nothing is compiled, and [`modules`] reads what is kept.

pub mod modules;

#[cfg(feature = "shaderc")]
pub use shaderc::*;

/// SPIR-V of the GLSL `text` of an entry file; the end of the file's name says which stage it is.
/// Warnings are errors. `include` gives the path and the text of what a directive names.
#[cfg(feature = "shaderc")]
pub fn spirv(
    compiler: &Compiler,
    (file, text): (&str, &str),
    macros: &[(&str, &str)],
    level: OptimizationLevel,
    include: impl Fn(&str) -> std::result::Result<(String, String), String>,
) -> Result<CompilationArtifact> {
    let kind = match file.rsplit('.').next() {
        Some("vert") => ShaderKind::Vertex,
        Some("frag") => ShaderKind::Fragment,
        _ => ShaderKind::Compute,
    };
    let mut options = CompileOptions::new()?;
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_2 as u32);
    options.set_optimization_level(level);
    options.set_warnings_as_errors();
    for (name, value) in macros {
        options.add_macro_definition(name, Some(value));
    }
    options.set_include_callback(|wanted, _, _, _| {
        let (resolved_name, content) = include(wanted)?;
        Ok(ResolvedInclude {
            resolved_name,
            content,
        })
    });
    compiler.compile_into_spirv(text, kind, file, "main", Some(&options))
}

/// The errors and warnings in a failure's text, as `file:line: message`. Other lines are headlines.
#[cfg(feature = "shaderc")]
pub fn complaints(text: &str) -> Vec<String> {
    let parted = |line: &str| {
        let (place, what) = line
            .split_once(" error: ")
            .or_else(|| line.split_once(" warning: "))?;
        Some(format!("{place} {what}"))
    };
    text.lines().filter_map(parted).collect()
}
