#![allow(clippy::unwrap_used)]
use crate::list::modules;
use crate::modules::generated as g;
use revmap::search::unpacked;
use std::collections::BTreeSet;

#[path = "../../../src/shader/tests/kept.rs"]
mod kept;
use kept::assert_kept;

/// Fixes the number of modules, so that an addition is noticed.
#[test]
fn modules_are_few() {
    let names: BTreeSet<String> = modules().iter().map(|listed| listed.name()).collect();
    assert_eq!((names.len(), modules().len()), (16, 16));
    let is_spirv = |packed: &&&[u8]| unpacked(packed).is_some_and(|words| words[0] == 0x0723_0203);
    assert_eq!(g::MODULES.iter().filter(is_spirv).count(), 16);
}

/// Stored SPIR-V was made from today's sources, and is equal word for word if the same compiler is
/// used here.
#[test]
fn kept_spirv_is_what_the_sources_give() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/spirv");
    let renew = "with REVMAP_KEEP_SPIRV=1 cargo build -p revmap-searches --features shaderc";
    let all = modules().into_iter().zip(g::MODULES);
    let all = all.map(|(listed, packed)| (listed.name(), unpacked(packed)));
    let hashes = [g::SOURCES_HASH, g::COMPILER_HASH];
    assert_kept((folder, renew), hashes, all.collect(), unpacked);
}
