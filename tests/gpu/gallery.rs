//! The gallery's scenes: each has a picture and a place in the documentation, and its maps are no
//! larger than the papers claim.

use crate::common::{device, sized};
use revmap::scene::Scene;
use revmap::settings::{Planes, Settings, Solver};
use revmap_offscreen::Offscreen;
use std::path::{Path, PathBuf};

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
        let small = width <= 801 && height <= 600;
        assert!(small, "{picture}: {width} x {height}");
    }
    let pictures = std::fs::read_dir(root().join("docs/pictures")).unwrap();
    let bytes: u64 = pictures.map(|p| p.unwrap().metadata().unwrap().len()).sum();
    assert!(bytes < 4_000_000, "pictures take {bytes} bytes");
}

/// Article of 2025: at most 10 MB for shapes, 4 MB for a displacement map. Data shared by a scene's
/// solids counts once.
#[test]
fn maps_are_as_small_as_the_papers_claim() {
    let settings = Settings {
        solver: Solver::Live, // this search reads maps
        planes: Planes::Color,
        ..sized(32, 24)
    };
    for (name, file) in scenes() {
        let scene: Scene = revmap_files::scene(&file).unwrap_or_else(|e| panic!("{e}"));
        let renderer = Offscreen::new(device(), &scene, &settings).unwrap();
        let [shapes, covers] = renderer.renderer().map_bytes();
        println!("{name}: {shapes} and {covers} bytes");
        let small = shapes > 0 && shapes <= 10_000_000;
        assert!(small, "{name}: {shapes} bytes of shape maps");
        for object in &scene.objects {
            if let Some(map) = &object.texturing.displacement_map {
                let bytes = map.encoded_bytes()[1] as u64;
                let small = bytes <= 4_000_000 && bytes <= covers;
                assert!(small, "{name}: {bytes} bytes");
            }
        }
    }
    device().check().unwrap();
}
