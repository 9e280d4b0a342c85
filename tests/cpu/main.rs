//! The library's public parts that need no device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/cpu.rs"]
mod common;

mod antialias;
mod cast;
mod contours;
mod hull_rays;
mod imports;
mod surface;

/// The smallest scene, the smallest program and the first host stand in the documents as they are.
#[test]
fn documents_show_what_is_there() {
    let shown = |page: &str, text: &str| assert!(page.contains(text.trim()), "{text}");
    let scene = include_str!("../../assets/scenes/smallest.toml");
    shown(include_str!("../../docs/scene-files.md"), scene);
    let (_, program) = include_str!("../../examples/smallest.rs")
        .split_once('\n')
        .unwrap();
    shown(include_str!("../../docs/embedding.md"), program);
    let host = include_str!("../../examples/first_host.rs");
    let host = host.splitn(3, '\n').nth(2).unwrap();
    shown(include_str!("../../docs/first-host.md"), host);
}
