//! Completes a distribution's shaderc.
//!
//! Debian 12 and Ubuntu package `libshaderc_combined.a` without the glslang and SPIRV-Tools objects
//! it was meant to combine, and a shared library with undefined symbols. Their packages
//! `glslang-dev` and `spirv-tools` hold the missing archives. Link order matters between them; a
//! whole archive is asked for because shaderc, which needs their symbols, stands earlier on the
//! linker's command line.

use std::path::{Path, PathBuf};

/// In the order in which they use each other.
const ARCHIVES: [&str; 9] = [
    "SPIRV",
    "HLSL",
    "glslang",
    "MachineIndependent",
    "GenericCodeGen",
    "OGLCompiler",
    "OSDependent",
    "SPIRV-Tools-opt",
    "SPIRV-Tools",
];

/// An archive smaller than this may be a stub: glslang 14 and later keep the names of libraries
/// that they have merged into one, each with a single function that does nothing and has the same
/// name in all.
const STUB_BYTES: u64 = 4096;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=SHADERC_LIB_DIR");
    if std::env::var_os("CARGO_FEATURE_SHADERC").is_none()
        || std::env::var_os("SHADERC_LIB_DIR").is_some()
        || std::env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("linux")
    {
        return;
    }
    let Some(folder) = system_folder() else {
        return;
    };
    if is_whole(&folder.join("libshaderc_combined.a")) {
        return;
    }
    println!("cargo::rustc-link-search=native={}", folder.display());
    for name in ARCHIVES {
        let archive = folder.join(format!("lib{name}.a"));
        if archive.exists() && !is_stub(&archive) {
            println!("cargo::rustc-link-lib=static:+whole-archive={name}");
        }
    }
}

/// Where the distribution keeps libraries of the target, if shaderc is there.
fn system_folder() -> Option<PathBuf> {
    let arch = std::env::var("CARGO_CFG_TARGET_ARCH").ok()?;
    [
        format!("/usr/lib/{arch}-linux-gnu"),
        "/usr/lib64".to_owned(),
        "/usr/lib".to_owned(),
    ]
    .into_iter()
    .map(PathBuf::from)
    .find(|folder| folder.join("libshaderc_combined.a").exists())
}

/// A combined archive that keeps its promise holds glslang, many megabytes of it.
fn is_whole(archive: &Path) -> bool {
    const WITH_GLSLANG: u64 = 8 << 20;
    std::fs::metadata(archive).is_ok_and(|m| m.len() > WITH_GLSLANG)
}

/// Linking a stub brings nothing, and linking two defines their function twice.
fn is_stub(archive: &Path) -> bool {
    const NAME: &[u8] = b"stub_library_function";
    std::fs::metadata(archive).is_ok_and(|m| m.len() < STUB_BYTES)
        && std::fs::read(archive).is_ok_and(|bytes| bytes.windows(NAME.len()).any(|w| w == NAME))
}
