//! Scenes in TOML, and one `key=value` behind the first byte 0.
#![no_main]

use revmap_files::SceneFile;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let (text, set) = text.split_once('\0').map_or((text, None), |(text, set)| (text, Some(set.to_owned())));
    let Ok(mut file) = SceneFile::parse(text, "/nonexistent") else { return };
    let sets: Vec<String> = set.into_iter().collect();
    if let Ok(scene) = file.scene(&sets) {
        let _ = revmap_files::warnings(&scene, 64, 48);
        let again = file.text(&sets).unwrap();
        let again = SceneFile::parse(&again, "/nonexistent").unwrap().scene(&[]);
        assert!(again.is_ok(), "a scene's own text is a scene");
    }
});
