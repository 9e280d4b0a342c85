//! A host's functions of shading.

use crate::enums;
use crate::fault::{Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::{list, put_bytes, text};
use revmap::settings::DrawStage;
use revmap::shading::Shading;
use std::ffi::{c_char, c_void};
use std::sync::Arc;

/// A host's function of shading for one stage, as SPIR-V. docs/embedding.md has its signature.
pub struct RevmapShading;
handle!(RevmapShading, "shading", Arc<Shading>);

/// Reads a shading that the program `revmap shading` or revmap_shading_bytes() has written.
///
/// Fails with REVMAP_RESULT_CONTENT for bytes of another version of the library, and for damaged
/// bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_shading_from_bytes(
    bytes: *const c_void,
    count: usize,
    shading: *mut *mut RevmapShading,
) -> RevmapResult {
    create(shading, || {
        let bytes = list(bytes.cast::<u8>(), count, "bytes")?;
        Ok(Shading::from_bytes(bytes)?)
    })
}

/// Compiles GLSL: count files, each with a name and a text in UTF-8. The first defines the function,
/// the others are those that it includes, by their names in #include. stage is a RevmapStage.
///
/// Fails with REVMAP_RESULT_CONTENT for GLSL that does not compile, with file, line and message; with
/// REVMAP_RESULT_USAGE if the library was built without the feature `shaderc`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_shading_compile(
    stage: u32,
    names: *const *const c_char,
    texts: *const *const c_char,
    count: usize,
    shading: *mut *mut RevmapShading,
) -> RevmapResult {
    create(shading, || {
        let stage = enums::stage(stage)?;
        let names = list(names, count, "names")?;
        let texts = list(texts, count, "texts")?;
        let files = names.iter().zip(texts);
        let files = files.map(|(n, t)| Ok((text(*n, "name")?, text(*t, "text")?)));
        compiled(stage, &files.collect::<Outcome<Vec<_>>>()?)
    })
}

#[cfg(feature = "shaderc")]
fn compiled(stage: DrawStage, files: &[(&str, &str)]) -> Outcome<Shading> {
    Ok(Shading::compile(stage, files)?)
}

#[cfg(not(feature = "shaderc"))]
fn compiled(_: DrawStage, _: &[(&str, &str)]) -> Outcome<Shading> {
    let message = "this library was built without the feature `shaderc`, which compiles GLSL; \
                   write bytes with `revmap shading`";
    Err(crate::fault::Fault::usage(message))
}

/// Returns a shading's bytes for revmap_shading_from_bytes() of the same version of the library. With
/// null bytes, count becomes their number. Otherwise count is the room in bytes, which must be large
/// enough, and becomes the number of bytes written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_shading_bytes(
    shading: *const RevmapShading,
    bytes: *mut c_void,
    count: *mut usize,
) -> RevmapResult {
    put_bytes(
        bytes,
        count,
        || Ok(RevmapShading::get(shading)?.to_bytes()?),
    )
}

/// Destroys a shading; null is none. Renderers that use it stay as they are.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_shading_destroy(shading: *mut RevmapShading) -> RevmapResult {
    enter(|| RevmapShading::destroy(shading))
}
