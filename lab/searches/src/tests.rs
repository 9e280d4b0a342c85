#![allow(clippy::unwrap_used)]
use crate::list::modules;
use crate::modules::generated as g;
use revmap::search::unpacked;
use std::collections::BTreeSet;

/// Fixes the number of modules, so that an addition is noticed.
#[test]
fn modules_are_few() {
    let names: BTreeSet<String> = modules().iter().map(|listed| listed.name()).collect();
    assert_eq!((names.len(), modules().len()), (24, 24));
    let is_spirv = |packed: &&&[u8]| unpacked(packed).is_some_and(|words| words[0] == 0x0723_0203);
    assert_eq!(g::MODULES.iter().filter(is_spirv).count(), 24);
}

/// Stored SPIR-V was made from today's sources, and is equal word for word if the same compiler is
/// used here.
#[test]
fn kept_spirv_is_what_the_sources_give() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/spirv");
    let kept = |name: &str| std::fs::read(format!("{folder}/{name}")).unwrap();
    let hashes = String::from_utf8(kept("sources.fnv")).unwrap();
    let hashes: Vec<&str> = hashes.lines().collect();
    assert_eq!(
        hashes[0],
        format!("{:#018x}", g::SOURCES_HASH),
        "shaders changed; renew spirv/ with REVMAP_KEEP_SPIRV=1 cargo build -p revmap-searches --features shaderc"
    );
    if hashes[1] == format!("{:#018x}", g::COMPILER_HASH) {
        for (listed, packed) in modules().iter().zip(g::MODULES) {
            let name = listed.name();
            let same = unpacked(&kept(&format!("{name}.spv.z"))) == unpacked(packed);
            assert!(same, "{name}: kept words differ from the compiled");
        }
    }
    let files = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(files, modules().len() + 1, "files that nothing reads");
}
