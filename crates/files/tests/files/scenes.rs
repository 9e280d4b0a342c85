//! The scenes that come with the program, and bare profiles in place of scenes.

use revmap_files::ProfileAxis;

/// Pictures of every solid, whole and half, bring no warning about their form.
#[test]
fn pictures_of_their_solids_look_as_intended() {
    let entries = std::fs::read_dir(crate::asset("scenes")).unwrap();
    let files = entries.map(|entry| entry.unwrap().path());
    for file in files.filter(|file| file.extension() == Some("toml".as_ref())) {
        let scene = revmap_files::scene(&file).unwrap_or_else(|e| panic!("{e}"));
        for profile in scene.objects.iter().map(|o| &o.profile) {
            let (rows, margin) = (240, 6);
            let columns = (profile.radius * f64::from(rows)).ceil() as u32 + margin;
            if 2 * columns > 16384 {
                continue; // the record: no picture is so wide
            }
            let half = revmap_files::raster::rasterize(&profile.outline, columns, rows).unwrap();
            let shade = |column: u32, row: u32| {
                let coverage = half.coverage[(row * columns + column) as usize];
                image::Luma([(255.0 * (1.0 - coverage)).round() as u8])
            };
            let whole = image::GrayImage::from_fn(2 * columns, rows, |x, y| {
                let column = if x < columns {
                    columns - 1 - x
                } else {
                    x - columns
                };
                shade(column, y)
            });
            let half = image::GrayImage::from_fn(columns, rows, shade);
            for (picture, axis) in [(whole, ProfileAxis::Center), (half, ProfileAxis::Left)] {
                let read = revmap_files::profile_from_bytes(&crate::png(picture), axis).unwrap();
                assert_eq!(read.warnings, [""; 0], "{}, {axis:?}", file.display());
            }
        }
    }
}

/// Values that are set count when a profile in place of a scene is first read, and for its camera.
#[test]
fn a_bare_profile_is_read_with_what_is_set() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("thin.svg");
    let thin = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
        <rect y='10' width='40' height='80'/></svg>";
    std::fs::write(&file, thin).unwrap();
    let scene = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        revmap_files::SceneFile::open(&file)?.scene(&sets)
    };
    let center = scene(&["object.0.profile_axis=center"]);
    let empty = center.unwrap_err().to_string();
    assert!(empty.contains("set profile_axis"), "{empty}");
    assert!(!empty.contains("profile_threshold"), "{empty}");
    let pale = thin.replace("<rect", "<rect fill='#b0b0ff'");
    std::fs::write(&file, pale).unwrap();
    let found = [&[][..], &["object.0.profile_axis=left"]].map(|sets| scene(sets).unwrap());
    let notes = |k: usize| &found[k].objects[0].profile.notes;
    assert!(
        notes(0).len() == 2 && notes(0)[0] == notes(1)[0],
        "{found:?}"
    );
    std::fs::write(&file, thin).unwrap();
    let left = "object.0.profile_axis=left";
    let near = scene(&[left]).unwrap();
    let found = scene(&[]).unwrap();
    assert_eq!(
        found.objects[0].profile.outline,
        near.objects[0].profile.outline
    );
    let far = scene(&[left, "object.0.extend=0.5"]).unwrap();
    assert!(far.camera.eye.length() > 1.3 * near.camera.eye.length());
    let own = scene(&[left, "camera.eye.0=9", "object.0.extend=0.5"]).unwrap();
    assert_eq!(own.camera.eye.x, 9.0);
    assert_eq!(own.camera.eye.y, far.camera.eye.y);
}
