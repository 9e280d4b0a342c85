//! Outlines as drawings of a few curves, read again.

use glam::DVec2;
use revmap::error::ErrorKind;
use revmap::profile::Profile;
use revmap_files::{ProfileAxis, ProfileOptions, Smooth, profile, write_outline};
use std::path::PathBuf;

fn files() -> Vec<PathBuf> {
    let folder = |name: &str| std::fs::read_dir(crate::asset(name)).unwrap();
    let entries = folder("profiles").chain(folder("gallery"));
    let files = entries.map(|entry| entry.unwrap().path());
    let is_profile = |f: &PathBuf| f.extension().is_some_and(|e| e == "svg" || e == "png");
    files.filter(is_profile).collect()
}

fn read(file: &PathBuf) -> Profile {
    let axis = match file.parent().unwrap().ends_with("gallery") {
        true => ProfileAxis::Left,
        false => ProfileAxis::Center,
    };
    let options = ProfileOptions {
        axis,
        smooth: Smooth::Auto,
        ..ProfileOptions::default()
    };
    profile(file, options).unwrap()
}

/// Largest distance from points on the surface of `a`, ten a segment, to that of `b`.
fn apart(a: &Profile, b: &Profile) -> f64 {
    let surface: Vec<_> = b.outline.surface_segments().collect();
    let nearest = |p: DVec2| {
        let distances = surface.iter().map(|s| s.nearest(p).0.distance(p));
        distances.fold(f64::INFINITY, f64::min)
    };
    let points = a.outline.surface_segments().flat_map(|s| {
        let part = move |k: u32| s.a.lerp(s.b, f64::from(k) / 10.0);
        (0..=10).map(part)
    });
    points.map(nearest).fold(0.0, f64::max)
}

#[test]
fn outlines_are_read_again_as_the_same_solid() {
    let folder = tempfile::tempdir().unwrap();
    let clean = folder.path().join("clean.svg");
    let files = files();
    assert!(files.len() >= 12);
    for file in files {
        let before = read(&file);
        let written = write_outline(&before, &clean, 1e-5).unwrap();
        let pieces = [written.lines, written.curves];
        assert!(written.changed < 1e-3, "{written:?}");
        let after = profile(&clean, ProfileAxis::Center).unwrap();
        let found = [apart(&before, &after), apart(&after, &before)];
        let points: usize = before.outline.loops.iter().map(Vec::len).sum();
        println!("{}: {points} points, {pieces:?}, {found:?}", file.display());
        assert!(
            found.iter().all(|d| *d <= 1e-5 + 1e-8),
            "{}: {found:?}",
            file.display()
        );
        assert!((before.radius - after.radius).abs() < 1e-9);
        assert!((before.outline.area() / after.outline.area() - 1.0).abs() < 1e-4);
        assert_eq!(after.warnings, [""; 0]);
        assert_eq!(before.outline.loops.len(), after.outline.loops.len());
        if file.extension().unwrap() == "svg" {
            assert!(pieces[0] + pieces[1] < points / 3, "{pieces:?} of {points}");
        }
    }
}

/// The Hausdorff distance is measured: a coarse drawing is far off, and within its tolerance.
#[test]
fn tolerances_are_kept_and_used() {
    let folder = tempfile::tempdir().unwrap();
    let clean = folder.path().join("clean.svg");
    let bottle = read(&crate::asset("profiles/bottle.png"));
    let pieces = |tolerance| -> usize {
        let written = write_outline(&bottle, &clean, tolerance).unwrap();
        let after = profile(&clean, ProfileAxis::Center).unwrap();
        let found = apart(&bottle, &after).max(apart(&after, &bottle));
        assert!(
            found <= tolerance + 1e-8 && found > 0.1 * tolerance,
            "{found} {tolerance}"
        );
        written.lines + written.curves
    };
    let (few, many) = (pieces(3e-3), pieces(1e-5));
    assert!(few < 40 && many > 2 * few, "{few} {many}");
    for tolerance in [0.0, f64::NAN, -1.0] {
        let error = write_outline(&bottle, &clean, tolerance).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Usage);
    }
    let error = write_outline(&bottle, folder.path().join("none/a.svg"), 1e-5).unwrap_err();
    assert!(error.to_string().contains("none/a.svg"));
}

/// A solid between two fins, in a drawing of 100 x 100.
const FINS: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
    <path d='M40 5H60V95H40ZM20 5H80V6H20ZM20 7H80V8H20ZM20 94H80V95H20Z'/></svg>";

/// Every tolerance is refused, or leaves a drawing that is read again; its change is measured.
#[test]
fn what_is_written_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let clean = folder.path().join("clean.svg");
    let fins = revmap_files::profile_from_bytes(FINS.as_bytes(), ProfileAxis::Center).unwrap();
    let pawn = read(&crate::asset("profiles/pawn.svg"));
    let mut refused = 0;
    for shape in [&fins, &pawn] {
        for tolerance in [1e-5, 1e-3, 0.02, 0.1, 0.3, 1.0, 1e9, f64::INFINITY] {
            let _ = std::fs::remove_file(&clean);
            match write_outline(shape, &clean, tolerance) {
                Ok(written) => {
                    let after = profile(&clean, ProfileAxis::Center).unwrap();
                    let gained = (after.outline.area() / shape.outline.area() - 1.0).abs();
                    assert!(written.changed + 1e-9 >= gained, "{written:?} {gained}");
                }
                Err(e) => {
                    assert_eq!(e.kind, ErrorKind::Usage);
                    assert!(e.to_string().contains("leaves no shape"), "{e}");
                    assert!(tolerance >= 0.1 && !clean.exists(), "{tolerance}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused >= 4, "{refused}");
    let changed = |tolerance| write_outline(&fins, &clean, tolerance).unwrap().changed;
    assert!(changed(1e-5) < 1e-9);
    assert!(changed(0.02) > 0.03, "{}", changed(0.02));
}
