//! Pictures and maps of the scenes that come with the program, as it is run: what it refuses, warns
//! of and says.

use revmap::maps::{DisplacementMap, SlopeFilter};
use revmap_files::read_exr;
use std::path::PathBuf;
use std::process::Command;

fn asset(name: &str) -> String {
    let assets = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    assets.join(name).to_str().unwrap().to_owned()
}

#[test]
fn a_search_that_does_not_apply_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("goblet.png");
    let run = |scene: &str| {
        Command::new(env!("CARGO_BIN_EXE_revmap"))
            .args([
                "render",
                &asset(scene),
                "--size",
                "80x60",
                "--solver",
                "cone",
                "-o",
            ])
            .arg(&picture)
            .output()
            .unwrap()
    };
    let output = run("scenes/goblet.toml");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.lines().count() == 1 && said.contains("object.0.profile"),
        "{said}"
    );
    assert!(!picture.exists());
    let output = run("scenes/sphere.toml");
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn rays_out_of_steps_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("pawn.png");
    let said = |options: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_revmap"))
            .args([
                "render",
                &asset("scenes/pawn.toml"),
                "--size",
                "160x120",
                "-o",
            ])
            .arg(&picture)
            .args(options)
            .output()
            .unwrap();
        assert!(output.status.success(), "{options:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let few = ["--solver", "live", "--max-steps", "3"];
    assert!(said(&few).contains("pixels ran out of steps"));
    assert_eq!(said(&[&few[..], &["--quiet"]].concat()), "");
    let enough = said(&["--solver", "live"]);
    assert!(!enough.contains("out of steps"), "{enough}");
    let told = said(&["--solver", "live", "--verbose"]);
    assert!(told.contains("no pixel ran out of steps"), "{told}");
    // The default has none to run out of.
    let default = said(&["--verbose"]);
    assert!(!default.contains("out of steps"), "{default}");
}

/// `bake` writes a displacement map that is the height map's; `render --verbose` says what maps
/// take.
#[test]
fn maps_are_written_and_weighed() {
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
    let (bottle, brick) = (asset("profiles/bottle.png"), asset("heights/brick.png"));
    revmap(&["bake", &bottle, "-o", "bottle.png", "--height-map", &brick]);
    let baked = revmap_files::displacement_map(
        folder.path().join("bottle.displacement.png"),
        SlopeFilter::default(),
    )
    .unwrap();
    let own = revmap_files::displacement_map(&brick, SlopeFilter::default()).unwrap();
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

/// Many samples come to the colours of a picture 8 times as wide and high, averaged; the other
/// channels are the plain picture's.
#[test]
fn silhouettes_are_smoothed_in_pictures_and_not_in_data() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, options: &[&str]| {
        let file = folder.path().join(name);
        let output = Command::new(env!("CARGO_BIN_EXE_revmap"))
            .args(["render", &asset("scenes/pawn.toml"), "-q", "-o"])
            .arg(&file)
            .args(["--size", "64x48"])
            .args(options)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        std::fs::read(&file).unwrap()
    };
    for stage in ["fragment", "compute", "reference"] {
        let png = |how: &[&str]| draw("picture.png", &[&["--stage", stage], how].concat());
        let [on, off] = ["on", "off"].map(|how| png(&["--antialias", how]));
        assert!(on != off, "{stage}");
        let default = if stage == "reference" { &off } else { &on };
        assert!(png(&[]) == *default, "{stage}");
        assert!(png(&["--samples", "4"]) == png(&["--samples", "4", "--antialias", "off"]));
    }
    let [plain, on] = [&[][..], &["--antialias", "on"]].map(|how| draw("frame.exr", how));
    assert!(plain == draw("frame.exr", &["--antialias", "off"]));
    assert!(plain != on);
}

#[test]
fn samples_average_colours_alone() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, options: &[&str]| {
        let file = folder.path().join(name);
        let output = Command::new(env!("CARGO_BIN_EXE_revmap"))
            .args(["render", &asset("scenes/pawn.toml"), "-q", "-o"])
            .arg(&file)
            .args(options)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        read_exr(&file).unwrap()
    };
    let large = draw("large.exr", &["--size", "512x384"]);
    let plain = draw("plain.exr", &["--size", "64x48"]);
    let mut error = Vec::new();
    for samples in ["4", "64"] {
        let mut averaged = draw("averaged.exr", &["--size", "64x48", "--samples", samples]);
        let (mut total, mut between) = (0.0, 0);
        for (index, color) in averaged.color.iter().enumerate() {
            let (x, y) = (index % 64 * 8, index / 64 * 8);
            let mean = (0..64).map(|k| large.color[(y + k / 8) * 512 + x + k % 8]);
            let mean = mean.fold([0.0; 4], |s, c| [0, 1, 2, 3].map(|i| s[i] + c[i] / 64.0));
            let apart = (0..3).map(|i| f64::from((mean[i] - color[i]).abs()));
            total += apart.sum::<f64>() / 3.0 / 3072.0;
            between += usize::from(*color != plain.color[index]);
        }
        assert!(between > 100, "{between}");
        error.push(total);
        averaged.color = plain.color.clone();
        assert_eq!(averaged.first_difference(&plain), None);
    }
    assert!(error[1] < 1e-3 && error[1] < 0.5 * error[0], "{error:?}");
}
