//! SPIR-V words by module.

use super::catalogue::{Module, modules};
use crate::search::unpacked;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

/// The modules in sequence, each packed by `build.rs`.
static ARCHIVE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/modules.bin"));

/// The byte range of each module.
fn byte_ranges() -> &'static HashMap<Module, Range<usize>> {
    static RANGES: OnceLock<HashMap<Module, Range<usize>>> = OnceLock::new();
    RANGES.get_or_init(|| {
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

/// The module of [`modules`] that replaces this one: itself, or the least general one that can do
/// its work.
#[must_use]
pub fn catalogued(module: &Module) -> Option<Module> {
    module.covered_by(|m| byte_ranges().contains_key(m))
}

/// The words of the module that replaces this one; `None` if no module can.
#[must_use]
pub fn words(module: &Module) -> Option<Vec<u32>> {
    unpacked(ARCHIVE.get(byte_ranges().get(&catalogued(module)?)?.clone())?)
}

/// A module's words for reversed depth. Fragments that declare a depth no nearer than their
/// triangle then declare it for depth that decreases away from the eye.
#[must_use]
pub fn depth_less(words: &[u32]) -> Vec<u32> {
    const HEADER: usize = 5;
    const EXECUTION_MODE: u32 = 16;
    const DEPTH_GREATER: u32 = 14;
    const DEPTH_LESS: u32 = 15;
    let mut out = words.to_vec();
    let mut at = HEADER;
    while let Some(&first) = out.get(at) {
        // The first operand is the entry point, the second the mode.
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
