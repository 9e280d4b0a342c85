//! SPIR-V words by module.

use super::list::{Module, modules};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

/// The modules, one after another, each packed by `build.rs`.
static ARCHIVE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/modules.bin"));

/// Where each module's bytes are.
fn places() -> &'static HashMap<Module, Range<usize>> {
    static PLACES: OnceLock<HashMap<Module, Range<usize>>> = OnceLock::new();
    PLACES.get_or_init(|| {
        let mut begin = 0;
        let of = |(module, bytes): (Module, &usize)| {
            let range = begin..begin + bytes;
            begin = range.end;
            (module, range)
        };
        let sizes = super::generated::MODULE_BYTES;
        modules().into_iter().zip(sizes).map(of).collect()
    })
}

/// The module of [`modules`] that stands for this one: itself, or the least general one that does
/// its work.
#[must_use]
pub fn listed(module: &Module) -> Option<Module> {
    module.covered_by(|m| places().contains_key(m))
}

/// The words of the module that stands for this one; `None` where there is none.
#[must_use]
pub fn words(module: &Module) -> Option<Vec<u32>> {
    unpacked(ARCHIVE.get(places().get(&listed(module)?)?.clone())?)
}

/// Words from what `build.rs` has packed: deflated; seven bits a byte, the least first, the eighth
/// says that more follow.
#[must_use]
pub fn unpacked(packed: &[u8]) -> Option<Vec<u32>> {
    let bytes = miniz_oxide::inflate::decompress_to_vec(packed).ok()?;
    let mut words = Vec::with_capacity(bytes.len() / 2);
    let (mut word, mut shift) = (0u32, 0);
    for byte in bytes {
        word |= u32::from(byte & 127).checked_shl(shift)?;
        shift += 7;
        if byte & 128 == 0 {
            words.push(word);
            (word, shift) = (0, 0);
        }
    }
    Some(words)
}

/// A module's words for reversed depth: fragments that promise to lie no nearer than their triangle
/// promise so where depth falls away from the eye.
#[must_use]
pub fn depth_less(words: &[u32]) -> Vec<u32> {
    const HEADER: usize = 5;
    const EXECUTION_MODE: u32 = 16;
    const DEPTH_GREATER: u32 = 14;
    const DEPTH_LESS: u32 = 15;
    let mut out = words.to_vec();
    let mut at = HEADER;
    while let Some(&first) = out.get(at) {
        // The entry point, then the mode.
        if first & 0xffff == EXECUTION_MODE
            && let Some(mode) = out.get_mut(at + 2)
            && *mode == DEPTH_GREATER
        {
            *mode = DEPTH_LESS;
        }
        at += ((first >> 16) as usize).max(1);
    }
    out
}
