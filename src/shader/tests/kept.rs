//! Stored SPIR-V, for builds without a compiler.

/// Fails if the stored hash of the sources is not theirs, if a stored module differs from that of
/// the same compiler, or if nothing reads a file of the folder. `renew` says how to store again.
pub fn assert_kept(
    (folder, renew): (&str, &str),
    [sources, compiler]: [u64; 2],
    modules: Vec<(String, Option<Vec<u32>>)>,
    unpack: impl Fn(&[u8]) -> Option<Vec<u32>>,
) {
    let kept = |name: &str| std::fs::read(format!("{folder}/{name}")).unwrap();
    let hashes = String::from_utf8(kept("sources.fnv")).unwrap();
    let hashes: Vec<&str> = hashes.lines().collect();
    let sources = format!("{sources:#018x}");
    assert_eq!(
        hashes[0], sources,
        "shaders changed; renew {folder} {renew}"
    );
    let files = std::fs::read_dir(folder).unwrap().count();
    assert_eq!(files, modules.len() + 1, "files that nothing reads");
    let same_compiler = hashes[1] == format!("{compiler:#018x}");
    for (name, compiled) in modules {
        let words = unpack(&kept(&format!("{name}.spv.z")));
        assert!(words.is_some() && compiled.is_some(), "{name}");
        assert!(words == compiled || !same_compiler, "{name} differs");
    }
}
