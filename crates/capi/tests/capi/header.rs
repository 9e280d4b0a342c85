//! The kept header is what the sources give.

use std::path::{Path, PathBuf};

/// With this variable set, the header is written instead of compared.
const KEEP: &str = "REVMAP_KEEP_HEADER";

/// The sources in the order of the header.
const SOURCES: [&str; 12] = [
    "lib",
    "fault",
    "enums",
    "values",
    "device",
    "profile",
    "texture",
    "object",
    "rays",
    "shading",
    "renderer",
    "offscreen",
];
/// What has no part in the header.
const INNER: [&str; 2] = ["handle", "pointers"];

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn sources() -> Vec<PathBuf> {
    let mut all = Vec::new();
    for name in SOURCES {
        all.push(folder().join(format!("src/{name}.rs")));
        if name == "renderer" {
            let parts = [
                "frame",
                "objects",
                "images",
                "shading",
                "prewarm",
                "statistics",
            ];
            all.extend(parts.map(|n| folder().join(format!("src/renderer/{n}.rs"))));
        }
    }
    all
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
    for source in sources() {
        let text = std::fs::read_to_string(source).unwrap();
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

#[test]
fn every_source_is_in_the_header_or_named_as_inner() {
    let mut found: Vec<String> = std::fs::read_dir(folder().join("src"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    found.sort();
    let mut known = [&SOURCES[..], &INNER[..]].concat();
    known.sort_unstable();
    assert_eq!(found, known);
}
