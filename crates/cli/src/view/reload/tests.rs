//! Sources are watched and compiled, and the window draws with the result.
#![allow(unsafe_code)] // shaders of the source tree
#![allow(clippy::unwrap_used)] // a test may stop at what it did not expect

use super::*;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::{DrawStage, Settings};

fn sources() -> Sources {
    Sources::read(Path::new(FOLDER)).unwrap()
}

const MACROS: [(&str, &str); 1] = [("SEARCH", "SEARCH_LIVE")];

#[test]
fn sources_compile_as_they_stand() {
    let source = sources().compiled(Arc::default()).unwrap();
    let words = source("tree.frag", &MACROS).unwrap().unwrap();
    assert_eq!(words[0], 0x0723_0203, "SPIR-V's first word");
    assert_eq!(source("tree.frag", &MACROS).unwrap(), Some(words));
}

#[test]
fn an_error_names_file_and_line() {
    let mut broken = sources();
    let file = "include/core/shade.glsl";
    let text = broken.texts.get_mut(file).unwrap();
    let line = text.lines().count() + 1;
    text.push_str("this is no GLSL\n");
    let source = broken.compiled(Arc::default()).unwrap();
    let error = source("tree.frag", &MACROS).unwrap_err().to_string();
    assert!(error.contains(&format!("{file}:{line}: error")), "{error}");
    let error = source("no.frag", &MACROS).unwrap_err().to_string();
    assert!(error.contains("no.frag"));
}

#[test]
fn numbers_that_rust_knows_are_refused() {
    let mut other = sources();
    other.texts.get_mut(SHARED).unwrap().push_str("// more\n");
    let error = other.compiled(Arc::default()).err().unwrap();
    assert!(error.to_string().contains("build it anew"), "{error}");
}

#[test]
fn a_changed_file_has_another_stamp() {
    let folder = tempfile::tempdir().unwrap();
    for part in PARTS {
        std::fs::create_dir_all(folder.path().join(part)).unwrap();
    }
    let file = folder.path().join("include/core/a.glsl");
    std::fs::write(&file, "a").unwrap();
    let before = stamps(folder.path());
    assert_eq!(before.len(), 1);
    assert_eq!(before, stamps(folder.path()));
    std::fs::write(&file, "ab").unwrap();
    assert_ne!(before, stamps(folder.path()));
}

/// Colours of a spindle on a device with these shaders, in both stages.
fn drawn(device: &Device, shaders: Option<ShaderSource>) -> Result<Vec<[f32; 4]>> {
    let device = match shaders {
        // SAFETY: the shaders are the library's, but for a tint.
        Some(shaders) => unsafe { device.with_shaders(shaders) }?,
        None => device.clone(),
    };
    let points = [[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]];
    let profile = Profile::polygon(&points, 0.5)?;
    let camera = Camera::new([1.6, 0.3, 1.1].into(), [0.0, 0.0, 0.5].into());
    let mut scene = Scene::new(camera);
    scene.objects.push(Object::new("spindle", profile.into()));
    let mut colors = Vec::new();
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let settings = Settings {
            width: 64,
            height: 48,
            stage,
            ..Settings::default()
        };
        let mut offscreen = Offscreen::new(&device, &scene, &settings)?;
        offscreen.draw()?;
        colors.extend(offscreen.read()?.color);
    }
    Ok(colors)
}

#[test]
fn a_changed_shader_is_drawn_with() {
    let device = Device::open_validated(None).unwrap();
    let built_in = drawn(&device, None).unwrap();
    let same = sources().compiled(Arc::default()).unwrap();
    assert_eq!(drawn(&device, Some(same)).unwrap(), built_in);

    let mut tinted = sources();
    let text = tinted.texts.get_mut("include/core/shade.glsl").unwrap();
    let (plain, tint) = ("vec4(color, 1.0)", "vec4(color * vec3(1.0, 1.0, 0.0), 1.0)");
    assert_eq!(text.matches(plain).count(), 1);
    *text = text.replace(plain, tint);
    let yellow = drawn(&device, Some(tinted.compiled(Arc::default()).unwrap())).unwrap();
    let without_blue = |c: &[f32; 4]| [c[0], c[1], 0.0, c[3]];
    assert!(yellow.iter().copied().eq(built_in.iter().map(without_blue)));
    assert!(built_in.iter().filter(|c| c[2] > 0.1).count() > 200);

    let given_up = Arc::new(AtomicBool::new(true));
    let error = drawn(&device, Some(sources().compiled(given_up).unwrap())).unwrap_err();
    assert!(error.to_string().contains("given up"), "{error}");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}
