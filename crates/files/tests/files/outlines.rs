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
        let pieces = write_outline(&before, &clean, 1e-5).unwrap();
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
        let count = write_outline(&bottle, &clean, tolerance).unwrap();
        let after = profile(&clean, ProfileAxis::Center).unwrap();
        let found = apart(&bottle, &after).max(apart(&after, &bottle));
        assert!(
            found <= tolerance + 1e-8 && found > 0.1 * tolerance,
            "{found} {tolerance}"
        );
        count.iter().sum()
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
