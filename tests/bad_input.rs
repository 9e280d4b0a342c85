//! Whatever is wrong with what the program is given: the exit code, one line that says where, and no output file.

#![cfg(feature = "cli")]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const CAMERA: &str = "[camera]\neye = [2, 0, 0.5]\ntarget = [0, 0, 0.5]\n";
const CONE: &str = "[[object]]\npolygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\n";

/// A folder with the files of one case, and runs of the program in it.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new() -> Self {
        let bench = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        bench.file("scene.toml", format!("{CAMERA}{CONE}"));
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// A scene of one object with the given lines.
    fn object(&self, lines: &str) {
        self.file("scene.toml", format!("{CAMERA}[[object]]\n{lines}\n"));
    }

    fn grey(&self, name: &str, width: u32, height: u32, shade: impl Fn(u32, u32) -> u8) {
        image::GrayImage::from_fn(width, height, |x, y| image::Luma([shade(x, y)]))
            .save(self.path(name))
            .unwrap();
    }

    fn command<I: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = I>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_revmap"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .env_remove("RUST_BACKTRACE")
            .env_remove("REVMAP_DEVICE");
        command
    }

    /// Names of all that lies in the folder.
    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs and wants `code`, exactly one line on standard error with all of `words`, nothing on standard output, and
    /// no file made.
    #[track_caller]
    fn refused(&self, arguments: &str, code: i32, words: &[&str]) {
        self.refused_by(&mut self.command(arguments.split(' ')), code, words);
    }

    #[track_caller]
    fn refused_by(&self, command: &mut Command, code: i32, words: &[&str]) {
        let before = self.names();
        let output = command.output().unwrap();
        let said = lines(&output);
        assert_eq!(output.status.code(), Some(code), "{said:?}");
        assert_eq!(said.len(), 1, "{said:?}");
        for word in words {
            assert!(said[0].contains(word), "no {word:?} in {:?}", said[0]);
        }
        assert!(!said[0].contains("a bug of revmap"), "{said:?}");
        assert!(output.stdout.is_empty());
        assert_eq!(self.names(), before);
    }

    #[track_caller]
    fn done(&self, arguments: &str) -> Output {
        let output = self.command(arguments.split(' ')).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
        output
    }
}

fn lines(output: &Output) -> Vec<String> {
    let text = String::from_utf8_lossy(&output.stderr);
    text.lines().map(str::to_owned).collect()
}

/// The reference, which needs no Vulkan: what is wrong here is wrong before any device is looked for.
const RENDER: &str = "render scene.toml -o out.png --stage reference --size 16x12";

#[test]
fn profiles_that_are_none() {
    let bench = Bench::new();
    let profile = |name: &str| bench.object(&format!("profile = {name:?}"));
    let refused =
        |words: &[&str]| bench.refused(RENDER, 1, &[&["object.0.profile"], words].concat());

    profile("missing.svg");
    refused(&["missing.svg"]);
    profile("missing.png");
    refused(&["missing.png"]);

    std::fs::create_dir(bench.path("folder")).unwrap();
    profile("folder");
    refused(&["folder"]);
    std::fs::create_dir(bench.path("folder.png")).unwrap();
    profile("folder.png");
    refused(&["folder.png"]);

    bench.grey("whole.png", 64, 64, |x, y| ((x * 37 + y * 101) % 256) as u8);
    let whole = std::fs::read(bench.path("whole.png")).unwrap();
    bench.file("truncated.png", &whole[..whole.len() / 2]);
    profile("truncated.png");
    refused(&["truncated.png"]);
    bench.file("header.png", &whole[..20]);
    profile("header.png");
    refused(&["header.png"]);
    bench.file("empty.png", []);
    profile("empty.png");
    refused(&["empty.png"]);
    bench.file("text.png", "this is no picture");
    profile("text.png");
    refused(&["text.png"]);

    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='10' height='20'></svg>";
    bench.file("empty.svg", svg);
    profile("empty.svg");
    refused(&["empty.svg"]);
    bench.file("broken.svg", &svg[..40]);
    profile("broken.svg");
    refused(&["broken.svg"]);

    bench.grey("white.png", 20, 20, |_, _| 255);
    profile("white.png");
    refused(&["white.png"]);
    bench.grey("black.png", 20, 20, |_, _| 0);
    profile("black.png");
    refused(&["black.png"]);
    for shade in [0, 255] {
        bench.grey("dot.png", 1, 1, |_, _| shade);
        profile("dot.png");
        refused(&["dot.png"]);
    }
}

#[test]
fn a_picture_too_large_is_refused_by_its_header() {
    let bench = Bench::new();
    const SIDE: u32 = 20_000;
    let file = std::fs::File::create(bench.path("large.png")).unwrap();
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), SIDE, SIDE);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    encoder.set_compression(png::Compression::Fastest);
    // White above, black below: its size is all that is wrong with it.
    let bytes = (SIDE * SIDE / 8) as usize;
    let pixels: Vec<u8> = (0..bytes)
        .map(|i| if i < bytes / 2 { 255 } else { 0 })
        .collect();
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&pixels)
        .unwrap();
    bench.object("profile = \"large.png\"");
    bench.refused(RENDER, 1, &["large.png", "object.0.profile", "20000"]);
    bench.object("polygon = [[0, 0.1], [0.3, 0.1], [0, 0.9]]\ncolor_map = \"large.png\"");
    bench.refused(RENDER, 1, &["large.png", "object.0.color_map", "20000"]);
}

#[test]
fn polygons_that_turn_into_nothing() {
    let bench = Bench::new();
    for points in [
        "[]",
        "[[0, 0], [0.3, 1]]",
        "[[0, 0], [nan, 0.5], [0, 1]]",
        "[[0, 0], [0.3, inf], [0, 1]]",
        "[[-0.2, 0.1], [0.3, 0.1], [0, 0.9]]",
        "[[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]",
    ] {
        bench.object(&format!("polygon = {points}"));
        bench.refused(RENDER, 1, &["scene.toml", "object.0.polygon"]);
    }
    bench.object("polygon = [[0, 0], [0.3], [0, 1]]");
    bench.refused(RENDER, 1, &["scene.toml", "object.0.polygon.1"]);
}

#[test]
fn scenes_with_slips() {
    let bench = Bench::new();
    for (lines, words) in [
        ("bevle = 1", ["object.0.bevle", "`bevel`"]),
        ("bevel = \"steep\"", ["object.0.bevel", "a number"]),
        ("bevel = -1", ["object.0.bevel", "-1"]),
        ("bevel = nan", ["object.0.bevel", "NaN"]),
        ("chamfer = 2", ["object.0.chamfer", "2"]),
        ("chamfer = -0.1", ["object.0.chamfer", "-0.1"]),
        ("chamfer = nan", ["object.0.chamfer", "NaN"]),
        ("bevel = inf", ["object.0.bevel", "inf"]),
        ("extend = inf", ["object.0.extend", "inf"]),
        ("extend = nan", ["object.0.extend", "NaN"]),
        ("bump = nan", ["object.0.bump", "NaN"]),
        ("bump_form = \"steep\"", ["object.0.bump_form", "papers"]),
        (
            "projection = \"conic\"",
            ["object.0.projection", "spherical"],
        ),
        ("texture_repeat = [0, 1]", ["object.0.texture_repeat", "0"]),
        (
            "texture_repeat = [1, -2]",
            ["object.0.texture_repeat", "-2"],
        ),
        ("axis = [1.5, 0.5]", ["object.0.axis", "1.5"]),
        ("axis = [nan, 0.5]", ["object.0.axis", "NaN"]),
        ("repeat = [2, -1, 1]", ["object.0.repeat", "-1"]),
        ("mirror = [1, 0, 0]", ["object.0.mirror", "true"]),
        ("repeat = [1, 1, 0]", ["object.0.repeat", "0"]),
        ("repeat = [10000, 1, 1]", ["object.0.repeat", "10000"]),
        ("scale = [1, 1, 0]", ["object.0.scale", "0"]),
        ("scale = [0, 0, 0]", ["object.0.scale", "0"]),
        ("scale = 0", ["object.0.scale", "3 numbers"]),
        ("map_rows = 0", ["object.0.map_rows", "0"]),
        (
            "rotation = [0, 0, 0, 0]",
            ["object.0.rotation", "quaternion"],
        ),
        (
            "height_map = \"none.png\"",
            ["object.0.height_map", "none.png"],
        ),
    ] {
        bench.file("scene.toml", format!("{CAMERA}{CONE}{lines}\n"));
        bench.refused(RENDER, 1, &words);
    }
    for (old, new, words) in [
        (
            "eye = [2, 0, 0.5]",
            "eye = [0, 0, 0.5]",
            ["camera.target", "eye"],
        ),
        ("eye = [2, 0, 0.5]", "", ["camera.eye", "missing"]),
        (
            "eye = [2, 0, 0.5]",
            "eye = [2, 0]",
            ["camera.eye", "3 numbers"],
        ),
        (
            "eye = [2, 0, 0.5]",
            "eye = [0, 0, 9]",
            ["camera.up", "parallel"],
        ),
        ("eye", "fov_y = 0\neye", ["camera.fov_y", "0"]),
        ("eye", "fov_y = 180\neye", ["camera.fov_y", "180"]),
        ("eye", "eyes = 2\neye", ["camera.eyes", "`eye`"]),
        ("[camera]", "[camera", ["line 1", "TOML"]),
        ("[camera]", "[[camera]]", ["camera", "a table"]),
    ] {
        bench.file(
            "scene.toml",
            format!("{CAMERA}{CONE}").replacen(old, new, 1),
        );
        bench.refused(RENDER, 1, &[&["scene.toml"], &words[..]].concat());
    }
    bench.file("scene.toml", [0xff, 0xfe, 0x00]);
    bench.refused(RENDER, 1, &["scene.toml"]);
    bench.refused(
        "render none.toml -o out.png --stage reference",
        1,
        &["none.toml"],
    );
    bench.refused("render . -o out.png --stage reference", 1, &["."]);
}

#[test]
fn wrong_usage() {
    let bench = Bench::new();
    for (arguments, words) in [
        ("render scene.toml -o a.png --size 0x0", ["--size", "0"]),
        (
            "render scene.toml -o a.png --size 100000x100000",
            ["--size", "100000"],
        ),
        (
            "render scene.toml -o a.png --size 16385x1",
            ["--size", "16385"],
        ),
        (
            "render scene.toml -o a.png --size 800",
            ["--size", "800x600"],
        ),
        (
            "render scene.toml -o a.png --stage vertex",
            ["--stage", "compute"],
        ),
        (
            "render scene.toml -o a.png --solver magic",
            ["--solver", "circle"],
        ),
        (
            "render scene.toml -o a.png --solver mesh:2x1",
            ["--solver", "3 segments"],
        ),
        (
            "render scene.toml -o a.png --solver mesh:99999999x9",
            ["--solver", "at most"],
        ),
        (
            "render scene.toml -o a.png --solver mesh:axb",
            ["--solver", "mesh:64x128"],
        ),
        (
            "render scene.toml -o a.png --map-format r8",
            ["--map-format", "rgba8"],
        ),
        (
            "render scene.toml -o a.png --map-source guess",
            ["--map-source", "coverage"],
        ),
        (
            "render scene.toml -o a.png --map-rows 0",
            ["--map-rows", "0"],
        ),
        (
            "render scene.toml -o a.png --max-steps 0",
            ["--max-steps", "0"],
        ),
        (
            "render scene.toml -o a.png --siez 1x1",
            ["--siez", "'--size'"],
        ),
        (
            "render scene.toml -o a.png --quiet --verbose",
            ["--quiet", "--verbose"],
        ),
        (
            "render scene.toml -o a.png --set bevel",
            ["--set", "key=value"],
        ),
        (
            "render scene.toml -o a.png --set object.7.bevel=1",
            ["--set object.7.bevel", "has 1"],
        ),
        ("render scene.toml -o a.gif", ["a.gif", ".png, .exr"]),
        ("render scene.toml -o a", ["--output", ".png, .exr"]),
        ("render scene.toml -o a.png -o a.png", ["a.png", "twice"]),
        ("render scene.toml", ["--output", "<FILE>"]),
        ("render -o a.png", ["<SCENE>", "--help"]),
        ("draw scene.toml", ["draw", "--help"]),
        ("bake", ["<PROFILE>", "--help"]),
        ("compare a.exr", ["<B>", "--help"]),
    ] {
        bench.refused(arguments, 2, &words);
    }
    bench.refused_by(&mut bench.command::<&str>([]), 2, &["render", "--help"]);
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
    let command =
        "render scene.toml -o first.png -o nowhere/out.exr --stage reference --size 16x12";
    bench.refused(command, 1, &["nowhere/out.exr"]);
    // A scene is looked at after its outputs, but before any is written.
    bench.object("polygon = 1");
    std::fs::write(bench.path("kept.png"), "as it was").unwrap();
    bench.refused(
        "render scene.toml -o kept.png --stage reference",
        1,
        &["object.0.polygon"],
    );
    assert_eq!(std::fs::read(bench.path("kept.png")).unwrap(), b"as it was");
}

#[test]
fn devices_that_are_not_there() {
    let bench = Bench::new();
    let render = "render scene.toml -o out.png --size 16x12";
    for device in ["99", "no-such-card"] {
        bench.refused(&format!("{render} --device {device}"), 2, &[device]);
        let mut command = bench.command(render.split(' '));
        bench.refused_by(command.env("REVMAP_DEVICE", device), 2, &[device]);
    }
    // Without any driver: that, and nothing else, is exit code 3.
    for arguments in [render, "devices"] {
        for stage in ["", " --stage compute"] {
            if arguments == "devices" && !stage.is_empty() {
                continue;
            }
            let mut command = bench.command(format!("{arguments}{stage}").split(' '));
            let nothing = Path::new("/nonexistent/driver.json");
            command
                .env("VK_DRIVER_FILES", nothing)
                .env("VK_ICD_FILENAMES", nothing);
            bench.refused_by(&mut command, 3, &["Vulkan"]);
        }
    }
}

#[test]
fn good_input_makes_what_was_asked_for() {
    let bench = Bench::new();
    let output = bench.done("render scene.toml -o a.png -o a.exr --stage reference --size 32x24");
    assert_eq!(
        image::image_dimensions(bench.path("a.png")).unwrap(),
        (32, 24)
    );
    let results = String::from_utf8(output.stdout.clone()).unwrap();
    let results: Vec<&str> = results.lines().collect();
    assert_eq!(results.len(), 2, "{results:?}");
    assert!(results[0].starts_with("a.png: 32x24, reference") && results[1].starts_with("a.exr: "));
    assert!(
        lines(&output)[0].starts_with("device: "),
        "{:?}",
        lines(&output)
    );
    assert_eq!(bench.names(), ["a.exr", "a.png", "scene.toml"]);

    // The same again is the same file, in place of the old one.
    let first = std::fs::read(bench.path("a.exr")).unwrap();
    let quiet = bench.done("render scene.toml -o a.exr --stage reference --size 32x24 --quiet");
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    assert_eq!(std::fs::read(bench.path("a.exr")).unwrap(), first);

    // A value set on the command line is a value in the file.
    bench.done("render scene.toml -o set.exr --stage reference --size 32x24 -q --set object.0.extend=0.1 --set camera.fov_y=50");
    bench.file(
        "same.toml",
        format!("{CAMERA}{CONE}extend = 0.1\n").replacen("[camera]", "[camera]\nfov_y = 50", 1),
    );
    bench.done("render same.toml -o same.exr --stage reference --size 32x24 -q");
    let set = std::fs::read(bench.path("set.exr")).unwrap();
    assert_eq!(set, std::fs::read(bench.path("same.exr")).unwrap());
    assert_ne!(set, first);
}

#[test]
fn baking_what_is_no_profile() {
    let bench = Bench::new();
    bench.grey(
        "half.png",
        20,
        40,
        |x, y| {
            if x < 12 && y > 5 { 0 } else { 255 }
        },
    );
    bench.grey("black.png", 20, 20, |_, _| 0);
    for (arguments, code, words) in [
        (
            "bake none.svg -o map.png",
            1,
            ["none.svg", "does not exist"],
        ),
        ("bake black.png -o map.png", 1, ["black.png", "white"]),
        ("bake scene.toml -o map.png", 1, ["scene.toml", "PNG"]),
        ("bake half.png -o map.bmp", 2, ["map.bmp", ".png, .exr"]),
        ("bake half.png -o half.png", 2, ["half.png", "another file"]),
        (
            "bake half.png -o no/map.png",
            1,
            ["no/map.png", "does not exist"],
        ),
        (
            "bake half.png -o map.png --map-rows 1",
            2,
            ["--map-rows", "1"],
        ),
        (
            "bake half.png -o map.png --map-source exact",
            1,
            ["half.png", "exact"],
        ),
        (
            "bake half.png -o map.arc.png --projection planar",
            2,
            ["map.arc.png", "--projection"],
        ),
        (
            "bake half.png -o map.png --projection mercator",
            2,
            ["--projection", "spherical"],
        ),
        (
            "bake half.png -o map.png --height-map none.png",
            1,
            ["none.png", "height"],
        ),
    ] {
        bench.refused(arguments, code, &words);
    }
}

#[test]
fn maps_are_baked_under_the_names_that_were_asked_for() {
    let bench = Bench::new();
    bench.grey(
        "half.png",
        20,
        40,
        |x, y| {
            if x < 12 && y > 5 { 0 } else { 255 }
        },
    );
    bench.grey("waves.png", 32, 16, |x, _| (x * 8) as u8);
    bench.done(
        "bake half.png -o map.png --profile-axis left --map-rows 80 --map-source binary --height-map waves.png \
         --projection spherical",
    );
    bench.done("bake half.png -o map.exr --profile-axis left --map-rows 80 -q");
    assert_eq!(
        bench.names(),
        [
            "half.png",
            "map.displacement.png",
            "map.exr",
            "map.spherical.png",
            "scene.toml",
            "waves.png"
        ]
    );
    let size = image::image_dimensions(bench.path("map.spherical.png")).unwrap();
    assert_eq!(size, (40, 80));
    let size = image::image_dimensions(bench.path("map.displacement.png")).unwrap();
    assert_eq!(size, (32, 16));
}

#[test]
fn comparing_what_is_no_frame() {
    let bench = Bench::new();
    bench.done("render scene.toml -o a.exr --stage reference --size 16x12 -q");
    bench.done("render scene.toml -o b.exr --stage reference --size 16x13 -q");
    bench.done(
        "render scene.toml -o c.exr --stage reference --size 16x12 -q --set object.0.extend=0.05",
    );
    let whole = std::fs::read(bench.path("a.exr")).unwrap();
    bench.file("half.exr", &whole[..whole.len() / 2]);
    for (arguments, code, words) in [
        ("compare a.exr none.exr", 1, ["none.exr", "EXR"]),
        ("compare a.exr half.exr", 1, ["half.exr", "EXR"]),
        ("compare a.exr b.exr", 1, ["b.exr", "16x13"]),
        ("compare a.exr scene.toml", 2, ["scene.toml", ".exr"]),
        ("compare a.exr c.exr --heat heat.jpg", 2, ["--heat", ".png"]),
        ("compare a.exr c.exr --texel 0", 2, ["--texel", "above 0"]),
    ] {
        bench.refused(arguments, code, &words);
    }
    let same = bench.done("compare a.exr a.exr --exact --heat heat.png");
    assert!(
        String::from_utf8(same.stdout)
            .unwrap()
            .contains("equal in every channel")
    );
    assert!(bench.path("heat.png").exists());
    // A difference is a result, unless equality was asked for.
    let other = bench.done("compare a.exr c.exr");
    assert!(
        String::from_utf8(other.stdout)
            .unwrap()
            .contains("differ, first in")
    );
    let output = bench
        .command(["compare", "a.exr", "c.exr", "--exact"])
        .output()
        .unwrap();
    assert_eq!((output.status.code(), lines(&output).len()), (Some(1), 1));
}

#[test]
fn paths_in_a_scene_are_relative_to_it() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("below")).unwrap();
    bench.file(
        "below/half.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='20' height='40'><path d='M0,5h12v35h-12z'/></svg>",
    );
    let scene = format!("{CAMERA}[[object]]\nprofile = \"half.svg\"\nprofile_axis = \"left\"\n");
    bench.file("below/s.toml", scene);
    bench.done("render below/s.toml -o out.png --stage reference --size 32x24 --quiet");
    let picture = image::open(bench.path("out.png")).unwrap().into_rgba8();
    assert_eq!(picture.get_pixel(16, 12).0[3], 255);
    assert_eq!(picture.get_pixel(0, 0).0[3], 0);
}

#[test]
fn help_and_version_are_no_failures() {
    let bench = Bench::new();
    for arguments in [
        "--help",
        "render --help",
        "bake --help",
        "compare --help",
        "devices --help",
        "--version",
    ] {
        let output = bench.done(arguments);
        assert!(
            output.stderr.is_empty() && !output.stdout.is_empty(),
            "{arguments}"
        );
    }
    let output = bench.done("render --help");
    let help = String::from_utf8(output.stdout).unwrap();
    for option in [
        "--size",
        "--stage",
        "--solver",
        "--max-steps",
        "--map-rows",
        "--map-source",
        "--map-format",
        "--device",
        "--set",
        "--quiet",
    ] {
        assert!(help.contains(option), "{option}");
    }
}
