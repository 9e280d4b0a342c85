//! Simple scenes stay simple: the smallest scene of the README and the smallest program of
//! docs/embedding.md.

use crate::common::draw;
use revmap::settings::Settings;

#[allow(dead_code)]
#[path = "../../examples/smallest.rs"]
mod program;

const README: &str = include_str!("../../README.md");
const EMBEDDING: &str = include_str!("../../docs/embedding.md");

#[test]
fn the_smallest_scene_is_three_lines() {
    let text = include_str!("../../assets/scenes/smallest.toml");
    assert!(text.lines().count() <= 3 && README.contains(text.trim()));
    let scene = revmap_files::scene("assets/scenes/smallest.toml").unwrap();
    let frame = draw(&scene, &Settings::default());
    let hits = (0..frame.pixels()).filter(|&k| frame.hits(k)).count();
    assert!(hits > frame.pixels() / 20, "{hits} pixels");
}

#[test]
fn the_smallest_program_is_under_thirty_lines() {
    let text = include_str!("../../examples/smallest.rs");
    assert!(text.lines().count() < 30);
    let code = text.split_once('\n').map_or("", |(_, code)| code);
    assert!(EMBEDDING.contains(code.trim()));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pawn.png");
    program::picture(file.to_str().unwrap()).unwrap();
    assert!(file.metadata().unwrap().len() > 1000);
}
