//! The gallery's scenes: each has its picture and its place in the documentation, and maps no larger than the papers claim.
#![cfg(feature = "cli")]
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::device;
use revmap::gpu::Renderer;
use revmap::maps::DisplacementMap;
use revmap::scene::{Scene, file};
use revmap::settings::{Planes, Settings, Solver};
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scenes() -> Vec<(String, PathBuf)> {
    let entries = std::fs::read_dir(root().join("assets/gallery")).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "toml"));
    files.sort();
    let named = |f: PathBuf| (f.file_stem().unwrap().to_str().unwrap().to_owned(), f);
    files.into_iter().map(named).collect()
}

#[test]
fn every_scene_has_its_picture_and_its_words() {
    let page = std::fs::read_to_string(root().join("docs/gallery.md")).unwrap();
    let mut names: Vec<String> = scenes().into_iter().map(|(name, _)| name).collect();
    assert!(names.len() >= 10, "{names:?}");
    for name in &names {
        let link = format!("../assets/gallery/{name}.toml");
        assert!(page.contains(&link), "no link to {link}");
    }
    names.push("maps".into());
    for name in &names {
        let picture = format!("pictures/{name}.png");
        assert!(page.contains(&picture), "{picture} is not shown");
        let (width, height) = image::image_dimensions(root().join("docs").join(&picture)).unwrap();
        assert!(
            width <= 801 && height <= 600,
            "{picture}: {width} x {height}"
        );
    }
    let pictures = std::fs::read_dir(root().join("docs/pictures")).unwrap();
    let bytes: u64 = pictures.map(|p| p.unwrap().metadata().unwrap().len()).sum();
    assert!(bytes < 4_000_000, "pictures take {bytes} bytes");
}

/// Article of 2025: at most 10 MB for shapes, 4 MB for a displacement map. What a scene's solids share is there once.
#[test]
fn maps_are_as_small_as_the_papers_claim() {
    let settings = Settings {
        width: 32,
        height: 24,
        solver: Solver::Live, // which reads maps
        planes: Planes::Color,
        ..Settings::default()
    };
    for (name, file) in scenes() {
        let scene: Scene = file::load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let renderer = Renderer::new(device(), &scene, &settings).unwrap();
        let [shapes, covers] = renderer.map_bytes();
        println!("{name}: {shapes} and {covers} bytes");
        assert!(
            shapes > 0 && shapes <= 10_000_000,
            "{name}: {shapes} bytes of shape maps"
        );
        for object in &scene.objects {
            if let Some(map) = &object.texturing.displacement_map {
                let bytes = map.encoded_bytes()[1] as u64;
                assert!(
                    bytes <= 4_000_000 && bytes <= covers,
                    "{name}: {bytes} bytes"
                );
            }
        }
    }
}

/// `bake` writes a displacement map that is the height map's; `render --verbose` says what maps take.
#[test]
fn the_program_writes_and_weighs_maps() {
    let folder = tempfile::tempdir().unwrap();
    let revmap = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_revmap"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        said
    };
    let asset = |name: &str| {
        root()
            .join("assets")
            .join(name)
            .to_str()
            .unwrap()
            .to_owned()
    };
    let (bottle, brick) = (asset("profiles/bottle.png"), asset("heights/brick.png"));
    revmap(&["bake", &bottle, "-o", "bottle.png", "--height-map", &brick]);
    let baked = DisplacementMap::from_image(folder.path().join("bottle.displacement.png")).unwrap();
    let own = DisplacementMap::from_image(&brick).unwrap();
    assert_eq!(baked.size(), own.size());
    let values = |m: &DisplacementMap| m.levels[0].texels.concat();
    let (a, b) = (values(&baked), values(&own));
    let largest = b.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    assert!(
        a.iter()
            .zip(&b)
            .all(|(a, b)| (a - b).abs() <= largest / 65_000.0)
    );

    let scene = asset("gallery/bumps.toml");
    let said = revmap(&[
        "render",
        &scene,
        "-o",
        "bumps.png",
        "--size",
        "64x20",
        "--solver",
        "live",
        "--verbose",
    ]);
    let line = said.lines().find(|l| l.contains("shape maps")).unwrap();
    let numbers: Vec<f64> = line.split(' ').filter_map(|w| w.parse().ok()).collect();
    assert!(
        matches!(numbers[..], [shapes, covers] if shapes > 0.1 && shapes <= 10.0 && covers > 1.0 && covers <= 4.0),
        "{line}"
    );
}
