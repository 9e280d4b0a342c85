//! What a command line asks for: made under the names that it gives, or refused by exit code and
//! one line, before any file is written.

use crate::run::{Bench, CAMERA, CONE, lines};
use std::path::Path;

fn size(bench: &Bench, picture: &str) -> (u32, u32) {
    image::image_dimensions(bench.path(picture)).unwrap()
}

#[test]
fn wrong_usage() {
    let bench = Bench::new();
    bench.refuses(
        2,
        "render scene.toml -o a.png --size 0x0               | --size | 0
         render scene.toml -o a.png --size 100000x100000     | --size | 100000
         render scene.toml -o a.png --size 800               | --size | 800x600
         render scene.toml -o a.png --size -5x5              | --size | the width is -5; give 1 to 16384
         render scene.toml -o a.png --size axb               | --size | no number of pixels
         render scene.toml -o a.png --solver magic           | --solver | circle
         bench scene.toml --solver exact,magic               | mesh:SEGMENTSxRINGS, floor | circle
         chart scene.toml --solver magic                     | mesh:SEGMENTSxRINGS, floor | default,
         render scene.toml -o a.png --solver mesh:2x1        | --solver | 3 segments
         render scene.toml -o a.png --max-steps 0            | --max-steps | 0
         render scene.toml -o a.png --siez 1x1               | '--siez' found; a similar argument exists: '--size'; see `revmap render --help`
         render scene.toml -o a.png --set object.7.bevel=1   | --set object.7.bevel | has 1
         render scene.toml -o a.png --size 64,48             | --size | write it as 64x48;
         render scene.toml -o a.png --tolerance 50%          | --tolerance | 50%
         bench --passes -1                                   | --passes | -1
         bench --elevation -100.5                            | --elevation | -90 to 90
         animate scene.toml --frames 2 --vary object.0.position.2=0:1 | --vary object.0.position.2: the scene has no
         render scene.toml -o a.png --set object.0.color.0=.5 | --set object.0.color.0 | set the whole list first
         render scene.toml -o a.png --set light.0.radius=5   | --set light.0.radius | no [[light]]
         render scene.toml -o a.gif                          | a.gif | .png, .exr
         render scene.toml -o a                              | --output | .png, .exr
         render scene.toml -o a.png -o a.png                 | a.png | twice
         render scene.toml                                   | not provided: --output <FILE>; see `revmap render --help`
         draw scene.toml                                     | draw | --help
                                                             | render | --help",
    );
}

/// Numbers below 0 are values of the option before them.
#[test]
fn negative_numbers_are_values() {
    let bench = Bench::new();
    bench.done("animate scene.toml --frames 2 --turn -.5 --size 16x12");
    let vary = "--vary object.0.map_rows=10:20 --solver live";
    bench.done(&format!(
        "animate scene.toml --frames 3 {vary} --size 16x12"
    ));
    bench.refused("bench none.toml --elevation -.5,10", 1, &["none.toml"]);
}

#[test]
fn outputs_that_cannot_be_written() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("taken.png")).unwrap();
    for name in ["nowhere/out.png", "taken.png", "scene.toml/out.png"] {
        let command = format!("render scene.toml -o {name} --stage reference --size 16x12");
        bench.refused(&command, 1, &[name, "--output"]);
    }
    // The second of two: the first must not be written either.
    let two = "render scene.toml -o first.png -o nowhere/out.exr --stage reference";
    bench.refused(two, 1, &["nowhere/out.exr"]);
    // A scene is looked at after its outputs, but before any is written.
    bench.object("polygon = 1");
    bench.file("kept.png", "as it was");
    let command = "render scene.toml -o kept.png --stage reference";
    bench.refused(command, 1, &["object.0.polygon"]);
    assert_eq!(bench.read("kept.png"), b"as it was");
}

/// Without any driver: that, and nothing else, is exit code 3.
#[test]
fn drivers_that_are_not_there() {
    let bench = Bench::new();
    let render = "render scene.toml -o out.png --size 16x12";
    let compute = format!("{render} --stage compute");
    for arguments in [render, &compute, "devices"] {
        let mut command = bench.command(arguments);
        let nothing = Path::new("/nonexistent/driver.json");
        command.envs(["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].map(|name| (name, nothing)));
        bench.refused_by(&mut command, 3, &["Vulkan"]);
    }
}

#[test]
fn good_input_makes_what_was_asked_for() {
    let bench = Bench::new();
    let output = bench.done("render scene.toml -o a.png -o a.exr --stage reference --size 32x24");
    assert_eq!(size(&bench, "a.png"), (32, 24));
    let results = String::from_utf8(output.stdout.clone()).unwrap();
    let results: Vec<&str> = results.lines().collect();
    assert_eq!(results.len(), 2, "{results:?}");
    assert!(results[0].starts_with("a.png: 32x24, reference") && results[1].starts_with("a.exr: "));
    let said = lines(&output);
    assert!(said[0].starts_with("device: "), "{said:?}");
    assert_eq!(bench.names(), ["a.exr", "a.png", "scene.toml"]);

    // The same again is the same file, in place of the old one.
    let first = bench.read("a.exr");
    let again = "render scene.toml --stage reference --size 32x24 --quiet -o";
    let quiet = bench.done(&format!("{again} a.exr"));
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    assert_eq!(bench.read("a.exr"), first);
    // A value set on the command line is a value in the file.
    let set = "--set object.0.extend=0.1 --set camera.fov_y=50";
    bench.done(&format!("{again} set.exr {set}"));
    let camera = CAMERA.replace("[camera]", "[camera]\nfov_y = 50");
    bench.file("scene.toml", format!("{camera}{CONE}extend = 0.1\n"));
    bench.done(&format!("{again} same.exr"));
    let set = bench.read("set.exr");
    assert!(set == bench.read("same.exr") && set != first);
}

#[test]
fn maps_are_baked_under_the_names_that_were_asked_for() {
    let bench = Bench::new();
    bench.half("half.png");
    bench.grey("waves.png", 32, 16, |x, _| (x * 8) as u8);
    bench.done(
        "bake half.png -o map.spherical.png --profile-axis left --map-rows 80 --map-source binary --height-map waves.png",
    );
    bench.done("bake half.png -o map.exr --profile-axis left --map-rows 80 -q");
    bench.done("bake half.png -o v.2.exr --height-map waves.png -q");
    let made = "half.png map.displacement.png map.exr map.spherical.png scene.toml v.2.displacement.png v.2.exr \
                waves.png";
    assert_eq!(bench.names().join(" "), made);
    assert_eq!(size(&bench, "map.spherical.png"), (40, 80));
    assert_eq!(size(&bench, "map.displacement.png"), (32, 16));

    // A displacement map of an earlier run is not of the new map.
    let again = "bake half.png -o map.png --profile-axis left --map-rows 80";
    bench.warned_once(
        again,
        &["warning: map.displacement.png: is of an earlier run"],
    );
    assert!(lines(&bench.done(&format!("{again} --height-map waves.png"))).is_empty());
}

#[test]
#[cfg(not(feature = "viewer"))]
fn a_build_without_the_window_says_how_to_get_it() {
    let bench = Bench::new();
    let how = "`cargo install --path crates/cli --features viewer`";
    for arguments in ["", " scene.toml", " scene.toml --show steps --frames 3"] {
        bench.refused(&format!("view{arguments}"), 2, &[how]);
    }
}

#[test]
fn the_version_names_the_commit() {
    let bench = Bench::new();
    let version = bench.said("--version");
    let git = |arguments: &[&str]| {
        let mut git = std::process::Command::new("git");
        let git = git.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
        let output = git.output().ok().filter(|git| git.status.success())?;
        Some(String::from_utf8(output.stdout).unwrap())
    };
    // In a source package, which git does not track, it is the version alone.
    let tracked = git(&["ls-files", "--error-unmatch", "build.rs"]);
    let commit = tracked.and_then(|_| git(&["rev-parse", "--short=12", "HEAD"]));
    let commit = commit.map_or(String::new(), |commit| format!(" ({})", commit.trim()));
    let wanted = format!("revmap {}{commit}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(version, wanted);
}

/// Messages name the program as the documents do, whatever its file is called: on Windows `revmap.exe`.
#[test]
fn messages_name_the_program_alike() {
    let bench = Bench::new();
    let renamed = bench.path("renamed.exe");
    std::fs::copy(env!("CARGO_BIN_EXE_revmap"), &renamed).unwrap();
    for (arguments, wanted) in [
        ("rendr", "see `revmap --help`"),
        ("render", "see `revmap render --help`"),
        ("", "`revmap --help`"),
    ] {
        let mut command = std::process::Command::new(&renamed);
        command.args(arguments.split_whitespace());
        bench.refused_by(command.current_dir(bench.path("")), 2, &[wanted]);
    }
}
