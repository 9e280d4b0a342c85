//! The kept header is what the sources give.

use std::path::Path;

/// With this variable set, the header is written instead of compared.
const KEEP: &str = "REVMAP_KEEP_HEADER";

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The texts of all sources below a folder.
fn texts(below: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(below).unwrap();
    let texts = entries.map(|entry| match entry.unwrap().path() {
        path if path.is_dir() => texts(&path),
        path => vec![std::fs::read_to_string(path).unwrap()],
    });
    texts.flatten().collect()
}

#[test]
fn the_header_is_what_the_sources_give() {
    let mut builder = cbindgen::Builder::new().with_config(
        cbindgen::Config::from_file(folder().join("cbindgen.toml").to_str().unwrap()).unwrap(),
    );
    // The root alone: cbindgen goes from it to every module, and would take a file named here
    // twice.
    builder = builder.with_src(folder().join("src/lib.rs"));
    let mut made = Vec::new();
    builder.generate().unwrap().write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let path = folder().join("include/revmap.h");
    if std::env::var_os(KEEP).is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap();
    let differs = made.lines().zip(kept.lines()).position(|(a, b)| a != b);
    assert!(
        made == kept,
        "line {differs:?} differs; renew it: {KEEP}=1 cargo test -p revmap-capi header"
    );
    // Every exported name of the sources is declared, and once.
    let mut count = 0;
    for text in texts(&folder().join("src")) {
        for part in text.split("extern \"C\" fn ").skip(1) {
            let name = part.split('(').next().unwrap();
            let declared = |line: &&str| {
                let comment = line.trim_start().starts_with(['*', '/']);
                !comment
                    && (line.contains(&format!(" {name}(")) || line.contains(&format!("*{name}(")))
            };
            assert_eq!(kept.lines().filter(declared).count(), 1, "{name}");
            count += 1;
        }
    }
    assert!(count > 50, "{count} functions");
}
