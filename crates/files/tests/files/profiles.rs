//! Profiles from files: accepted files, and refused files with their messages.

use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::profile::Profile;
use revmap_files::ProfileAxis;
use revmap_files::raster::pictured;
use std::path::Path;

fn asset(name: &str) -> Profile {
    let file = crate::asset("profiles").join(name);
    revmap_files::profile(file, ProfileAxis::Center).unwrap()
}

fn refusal(path: &Path) -> String {
    let error = revmap_files::profile(path, ProfileAxis::Center).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with(&path.display().to_string()), "{text}");
    assert!(!text.contains('\n'), "{text}");
    text
}

#[test]
fn what_cannot_be_read_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    assert!(refusal(&folder.path().join("missing.svg")).contains("does not exist"));
    assert!(refusal(folder.path()).contains("folder"));
    for name in ["empty.png", "empty.svg"] {
        assert!(refusal(&file(name, b"")).contains("empty (0 bytes)"));
    }
    assert!(refusal(&file("noise.svg", b"\x01\x02\x03")).contains("give a PNG, JPEG or SVG"));
    assert!(refusal(&file("text.svg", b"<svg")).contains("damaged"));
    let bottle = std::fs::read(crate::asset("profiles/bottle.png")).unwrap();
    for part in [8, 30, bottle.len() / 3] {
        assert!(refusal(&file("cut.png", &bottle[..part])).contains("damaged"));
    }
    // A file is read by its content, not its name.
    let renamed = revmap_files::profile(file("bottle.svg", &bottle), ProfileAxis::Center);
    assert_eq!(renamed.unwrap(), asset("bottle.png"));
}

#[test]
fn other_formats_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [
        ("GIF", &b"GIF89a\x01\0\x01\0"[..]),
        ("WebP", b"RIFF\x24\0\0\0WEBPVP8 "),
        ("BMP", b"BM\x46\0\0\0\0\0\0\0"),
        ("TIFF", b"II*\0\x08\0\0\0"),
        ("TIFF", b"MM\0*\0\0\0\x08"),
        ("AVIF", b"\0\0\0\x1cftypavif"),
        ("HEIC", b"\0\0\0\x1cftypheic"),
        ("PDF", b"%PDF-1.7\n"),
        ("PSD", b"8BPS\0\x01"),
    ] {
        let path = folder.path().join("profile.png");
        std::fs::write(&path, bytes).unwrap();
        let words = format!("is a {name} file, which is not read; convert it to PNG");
        assert!(refusal(&path).contains(&words), "{}", refusal(&path));
        let texture = revmap_files::color_map(&path).unwrap_err().to_string();
        assert!(texture.contains(&words), "{texture}");
        let scene = revmap_files::scene(folder.path().join("profile.png")).unwrap_err();
        assert!(scene.to_string().contains(&words), "{scene}");
    }
}

/// A file without end is refused before it fills the memory.
#[cfg(target_os = "linux")]
#[test]
fn files_without_end_are_refused() {
    let endless = Path::new("/dev/zero");
    let texture = revmap_files::color_map(endless).unwrap_err().to_string();
    let scene = revmap_files::scene(endless).unwrap_err().to_string();
    for text in [refusal(endless), texture, scene] {
        assert!(
            text.contains("/dev/zero") && text.contains("1 GiB"),
            "{text}"
        );
    }
    // A large file is refused by its size alone.
    let folder = tempfile::tempdir().unwrap();
    let large = folder.path().join("large.png");
    std::fs::File::create(&large)
        .unwrap()
        .set_len(3 << 30)
        .unwrap();
    assert!(refusal(&large).contains("1 GiB"));
}

/// The map of a drawing as an image must agree with the drawing's, at the image's resolution and at
/// others.
#[test]
fn an_image_of_a_drawing_gives_its_distances() {
    for name in ["pawn.svg", "bishop.svg", "king.svg", "rook.svg"] {
        let drawing = asset(name);
        let rows = 600;
        let columns = (drawing.radius * f64::from(rows)).ceil() as u32;
        let image = pictured(&drawing, columns, rows, 256).unwrap();
        for rows in [300, 512, 600] {
            let options = BakeOptions::new(MapSource::EXACT, rows);
            let [exact, traced] = [&drawing, &image].map(|p| ShapeMap::bake(p, &options).unwrap());
            let pairs = exact.distance.iter().zip(&traced.distance);
            let errors: Vec<f64> = pairs.map(|(a, b)| f64::from(a - b).abs() * 600.0).collect();
            let max = errors.iter().copied().fold(0.0, f64::max);
            // The bottom of a sharp notch is beyond the last pixel that is half covered. It is the
            // nearest point of whole wedges inside the solid.
            assert!(max < 1.7, "{name} at {rows}: {max} pixels");
            let outside = errors.iter().zip(&exact.form).filter(|(_, s)| !**s);
            let outside: Vec<f64> = outside.map(|(e, _)| *e).collect();
            let rms = (outside.iter().map(|e| e * e).sum::<f64>() / outside.len() as f64).sqrt();
            assert!(rms < 0.045, "{name} at {rows}: rms {rms} pixels");
        }
    }
}
