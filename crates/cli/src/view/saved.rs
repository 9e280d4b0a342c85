//! Files that the window writes: the scene as TOML, a turntable, times of its frames.

use super::times::Cost;
use revmap::error::Result;
use revmap::scene::Scene;
use revmap_bench::measure::drawn::assignments;
use revmap_files::{SceneFile, write_bytes};
use std::path::{Path, PathBuf};

/// A free path beside `file`: its stem, `-`, a number from 1 on, `ending`.
pub fn beside(file: &Path, ending: &str) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let numbered = |n: u32| file.with_file_name(format!("{stem}-{n}{ending}"));
    (1..)
        .map(numbered)
        .find(|path| !path.exists())
        .unwrap_or_else(|| numbered(0))
}

/// Writes the shown state as a scene beside `source`, so that its paths lead to the same files.
pub fn write_scene(
    source: &Path,
    file: &SceneFile,
    first: &Scene,
    shown: &Scene,
) -> Result<PathBuf> {
    let path = beside(source, ".toml");
    let (before, after) = (assignments(first), assignments(shown));
    // Only changed values are written; the others stay as in the file.
    let changed = after.into_iter().filter(|one| !before.contains(one));
    let mut changed: Vec<_> = changed.collect();
    if file.text(&[])?.contains("stand = true") {
        let objects = shown.objects.iter().zip(&first.objects).enumerate();
        for (n, (object, _)) in objects.filter(|(_, (a, b))| a.placement != b.placement) {
            // Its position is that of the box, as shown.
            let at = object.placement.position.to_array();
            changed.extend([
                format!("object.{n}.position={at:?}"),
                format!("object.{n}.stand=false"),
            ]);
        }
    }
    let text = file.text(&changed)?;
    write_bytes(&path, text.as_bytes())?;
    Ok(path)
}

/// Writes the cost of each frame.
pub fn write_times(path: &Path, all: &[Cost]) -> Result<()> {
    let mut text = String::from("frame,prepare_ms,gpu_ms,present_ms,pipelines_compiled\n");
    for (n, cost) in all.iter().enumerate() {
        let [prepare, device, present] = [cost.prepare, cost.device, cost.present];
        let compiled = cost.compiled;
        text += &format!("{n},{prepare:.4},{device:.4},{present:.4},{compiled}\n");
    }
    write_bytes(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec3;
    use revmap::scene::Shadow;

    const TEXT: &str = "[camera]\neye = [2, 0, 1]\ntarget = [0, 0, 0.5]\n\
                        [[object]]\npolygon = [[0, 0], [0.4, 0], [0, 1]]\n";

    #[test]
    fn a_saved_scene_is_the_one_that_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let source = folder.path().join("cone.toml");
        std::fs::write(&source, TEXT).unwrap();
        let mut file = SceneFile::open(&source).unwrap();
        let first = file.scene(&[]).unwrap();
        let mut shown = first.clone();
        shown.objects[0].offset.bevel = 0.25;
        shown.objects[0].repeat = [2, 1, 3];
        shown.camera.eye = DVec3::new(-1.5, 0.25, 3.0);
        shown.shadow = Shadow::Hard;
        shown.lights.push(shown.lights[0]);
        shown.lights[1].color = [1.0, 0.5, 0.0];
        let path = write_scene(&source, &file, &first, &shown).unwrap();
        assert_eq!(path, folder.path().join("cone-1.toml"));
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("extend"), "what was not touched: {text}");
        let read = SceneFile::open(&path).unwrap().scene(&[]).unwrap();
        assert_eq!(assignments(&read), assignments(&shown));
        // The next file gets another name.
        let next = write_scene(&source, &file, &first, &shown).unwrap();
        assert_eq!(next, folder.path().join("cone-2.toml"));
    }
}
