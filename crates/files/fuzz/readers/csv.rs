//! CSV of copies, read by a scene that names it.
#![no_main]

use revmap_files::SceneFile;

const SCENE: &str = r#"
camera = { eye = [3, 0, 1], target = [0, 0, 0] }
[[object]]
polygon = [[0, 0], [1, 0], [0, 1]]
instances = "copies.csv"
"#;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("copies.csv"), bytes).unwrap();
    let mut scene = SceneFile::parse(SCENE, folder.path()).unwrap();
    let _ = scene.scene(&[]);
});
