//! What people feed the program besides drawings: names, photographs, tables, numbers, links. Every
//! case is done right, or refused or warned about by name.

use crate::run::{Bench, SVG, lines};
use std::path::PathBuf;
#[cfg(target_os = "linux")]
use std::process::Stdio;

const SMALL: &str = "--size 32x24";

/// A file of `tests/inputs`, copied into the folder of a case.
fn input(bench: &Bench, name: &str) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
    bench.file(name, std::fs::read(folder.join(name)).unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_are_no_text_are_names() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let bench = Bench::new();
    let name = |bytes: &[u8]| PathBuf::from(OsStr::from_bytes(bytes));
    let (read, written) = (name(b"in\xff.svg"), name(b"out\xff.png"));
    std::fs::write(bench.path("").join(&read), SVG).unwrap();
    let left = "--set object.0.profile_axis=left";
    let mut command = bench.command(&format!("render {SMALL} --json {left}"));
    let output = command.arg(&read).arg("-o").arg(&written).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(said["files"][0], "out\u{fffd}.png");
    assert!(bench.path("").join(written).exists());
}

#[test]
fn files_are_told_by_their_content() {
    let bench = Bench::new();
    input(&bench, "vase.jpg");
    let picture = bench.read("vase.jpg");
    let scene = bench.read("scene.toml");
    // As a byte order mark of UTF-16 and PowerShell write it.
    let text = bench.text("scene.toml");
    let wide = text.encode_utf16().flat_map(u16::to_le_bytes);
    let wide: Vec<u8> = [0xff, 0xfe].into_iter().chain(wide).collect();
    let pictures = ["vase.jfif", "vase", "vase.toml"].map(|name| (name, &picture));
    let scenes = ["scene", "scene.txt", "scene.png"].map(|name| (name, &scene));
    for (name, bytes) in pictures
        .into_iter()
        .chain(scenes)
        .chain([("wide.toml", &wide)])
    {
        bench.file(name, bytes);
        bench.done(&format!("render {name} -o out.png {SMALL}"));
    }
    bench.file("words.svg", "no drawing");
    bench.file("noise", [0xff, 0x80, 0x81]);
    bench.refuses(
        1,
        "render words.svg -o no.png | words.svg | PNG, JPEG or SVG
         render noise -o no.png     | noise     | TOML | JPEG",
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_is_read_once() {
    use std::io::Write;
    let bench = Bench::new();
    let left = "--set object.0.profile_axis=left";
    let mut command = bench.command(&format!("render /dev/stdin -o out.png {SMALL} {left}"));
    let piped = command.stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut child = piped.spawn().unwrap();
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all(SVG.as_bytes()).unwrap();
    drop(pipe);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
}

/// Where a colour map is transparent, the object's colour shows.
#[test]
fn transparent_texels_show_the_color() {
    let bench = Bench::new();
    input(&bench, "band-colors.png");
    bench.file("a.svg", SVG);
    bench.object("profile = \"a.svg\"\nprofile_axis = \"left\"\ncolor = [1, 0, 0]\ncolor_map = \"band-colors.png\"");
    let light = "background=[0,0,0,1] --set ambient=[1,1,1] --set light=[]";
    let render = "render scene.toml -o out.png --size 64x48 --antialias off";
    bench.done(&format!("{render} --set {light}"));
    let picture = bench.picture("out.png");
    // Above and below the band, whose texels in between are blue.
    for y in [13, 37] {
        assert_eq!(picture.get_pixel(32, y).0, [255, 0, 0, 255]);
    }
    let blue = picture.pixels().filter(|p| p.0[2] > 200 && p.0[0] < 100);
    assert!(blue.count() > 5);
}

#[test]
fn frames_of_an_earlier_turntable_are_not_mixed_with_new_ones() {
    let bench = Bench::new();
    let animate = |frames: u32| format!("animate scene.toml --frames {frames} {SMALL} -o t");
    bench.done(&animate(3));
    bench.file("t/own.png", "kept");
    let words = ["t", "--output", "3 frames", "--overwrite"];
    bench.refused(&animate(2), 2, &words);
    bench.done(&format!("{} --overwrite", animate(2)));
    let entries = std::fs::read_dir(bench.path("t")).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["frame-0000.png", "frame-0001.png", "own.png"]);
    // A frame that the scene reads is not removed.
    bench.half("t/frame-0001.png");
    bench.object("profile = \"t/frame-0001.png\"\nprofile_axis = \"left\"");
    let again = format!("{} --overwrite", animate(1));
    bench.refused(&again, 2, &["frame-0001.png", "is read as well"]);
    bench.has(&["t/frame-0000.png", "t/frame-0001.png"]);
}

#[cfg(unix)]
#[test]
fn outputs_follow_links_and_spare_inputs() {
    use std::os::unix::fs::symlink;
    let bench = Bench::new();
    symlink("later.png", bench.path("link.png")).unwrap();
    let twice = "render scene.toml -o link.png -o later.png";
    bench.refused(twice, 2, &["later.png", "named twice"]);
    bench.done(&format!("render scene.toml -o link.png {SMALL}"));
    assert!(bench.path("link.png").is_symlink() && bench.read("later.png").len() > 50);

    bench.half("half.png");
    bench.file("copies.csv", "0,0,0,0,0,0,1,1,1,1\n");
    symlink("half.png", bench.path("other.png")).unwrap();
    symlink("copies.csv", bench.path("times.csv")).unwrap();
    bench.done(&format!("render scene.toml -o frame.exr {SMALL}"));
    symlink("frame.exr", bench.path("heat.png")).unwrap();
    bench.object("profile = \"half.png\"\nprofile_axis = \"left\"\ninstances = \"copies.csv\"");
    for arguments in [
        "render scene.toml -o other.png",
        "render scene.toml -o no.png --levels other.png",
        "render scene.toml -o no.png --samples adaptive --show-rays other.png",
        "render half.png -o other.png",
        "bake half.png -o other.png",
        "bake @profiles/bottle.png -o other.png --height-map half.png",
        "animate scene.toml --frames 1 --times times.csv",
        "compare frame.exr frame.exr --heat heat.png",
    ] {
        bench.refused(arguments, 2, &["is read as well"]);
    }
}

#[test]
fn commas_in_numbers_are_refused_with_the_remedy() {
    let bench = Bench::new();
    let no = "render scene.toml -o no.png --set object.0.extend=0,05";
    bench.refused(no, 1, &["object.0.extend", "write 0.05"]);
    bench.refuses(
        2,
        "render scene.toml -o no.png --tolerance 0,05
         animate scene.toml --frames 2 --turn 0,05
         animate scene.toml --frames 2 --vary object.0.extend=0:0,1",
    );
}

#[test]
fn a_number_is_the_index_of_a_device() {
    let bench = Bench::new();
    let render = |device: &str| format!("render scene.toml -o no.png {SMALL} --device {device}");
    // The name of the software driver has a 5, a 6 and 256.
    for device in ["5", "6", "256", "99"] {
        let words = format!("--device: there is no device {device}; there are: 0 ");
        bench.refused(&render(device), 2, &[&words]);
    }
    let words = "no device is called 'amd-nvidia'";
    bench.refused(&render("amd-nvidia"), 2, &[words]);
    for (device, words) in [
        ("5", "revmap: REVMAP_DEVICE: there is no device 5"),
        ("no-such-card", "no-such-card"),
    ] {
        let mut command = bench.command(&render("0").replace(" --device 0", ""));
        bench.refused_by(command.env("REVMAP_DEVICE", device), 2, &[words]);
    }
}
