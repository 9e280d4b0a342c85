//! What people feed the program besides drawings: names, photographs, tables, numbers, links. Every
//! case is done right, or refused or warned about by name.

use crate::run::{Bench, CAMERA, CONE, SVG, lines};
use std::path::PathBuf;

const SMALL: &str = "--size 32x24";

/// A file of `tests/inputs`, copied into the folder of a case.
fn input(bench: &Bench, name: &str) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
    bench.file(name, std::fs::read(folder.join(name)).unwrap());
}

/// Wants one warning with these words.
#[track_caller]
fn warned(bench: &Bench, arguments: &str, words: &str) {
    let said = lines(&bench.done(arguments));
    let warnings: Vec<_> = said.iter().filter(|l| l.starts_with("warning: ")).collect();
    assert!(
        warnings.len() == 1 && warnings[0].contains(words),
        "{said:?}"
    );
}

/// Size of a map that `bake` wrote.
fn size(bench: &Bench, map: &str) -> (u32, u32) {
    image::image_dimensions(bench.path(map)).unwrap()
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
    let mut command = bench.command(&format!(
        "render {SMALL} --json --set object.0.profile_axis=left"
    ));
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
    for name in ["vase.jfif", "vase", "vase.toml"] {
        bench.file(name, &picture);
        bench.done(&format!("render {name} -o out.png {SMALL}"));
    }
    for name in ["scene", "scene.txt", "scene.png"] {
        bench.file(name, &scene);
        bench.done(&format!("render {name} -o out.png {SMALL}"));
    }
    // As a byte order mark of UTF-16 and PowerShell write it.
    let wide = String::from_utf8(scene).unwrap();
    let wide = wide.encode_utf16().flat_map(u16::to_le_bytes);
    bench.file(
        "wide.toml",
        [0xff, 0xfe].into_iter().chain(wide).collect::<Vec<u8>>(),
    );
    bench.done(&format!("render wide.toml -o out.png {SMALL}"));
    bench.file("words.svg", "no drawing");
    bench.refused(
        "render words.svg -o no.png",
        1,
        &["words.svg", "PNG, JPEG or SVG"],
    );
    bench.file("noise", [0xff, 0x80, 0x81]);
    bench.refused("render noise -o no.png", 1, &["noise", "TOML", "JPEG"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_pipe_is_read_once() {
    use std::io::Write;
    let bench = Bench::new();
    let arguments =
        format!("render /dev/stdin -o out.png {SMALL} --set object.0.profile_axis=left");
    let mut command = bench.command(&arguments);
    let piped = command.stdin(std::process::Stdio::piped());
    let mut child = piped.stderr(std::process::Stdio::piped()).spawn().unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(SVG.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{:?}", lines(&output));
}

#[test]
fn photographs_are_upright_and_whole() {
    let bench = Bench::new();
    for name in ["exif.jpg", "vase.jpg", "cut-off.jpg"] {
        input(&bench, name);
    }
    bench.done("bake exif.jpg -o turned.png");
    bench.done("bake vase.jpg -o stored.png");
    assert_eq!(size(&bench, "turned.png"), size(&bench, "stored.png"));
    bench.refused(
        "bake cut-off.jpg -o no.png",
        1,
        &["cut-off.jpg", "the image is damaged"],
    );
    bench.object("profile = \"vase.jpg\"\nprofile_smooth = \"auto\"\ncolor_map = \"cut-off.jpg\"");
    let words = ["cut-off.jpg", "object.0.color_map", "the image is damaged"];
    bench.refused("render scene.toml -o no.png", 1, &words);
}

#[test]
fn cut_outs_and_axes_are_named() {
    let bench = Bench::new();
    input(&bench, "band.png");
    warned(
        &bench,
        "bake band.png -o map.png",
        "transparency has another form",
    );
    let bottle = |x: u32, y: u32| match y {
        10..40 => x.abs_diff(62) < 6,
        40..90 => x.abs_diff(62) < 25,
        _ => false,
    };
    bench.grey(
        "aside.png",
        100,
        100,
        |x, y| if bottle(x, y) { 0 } else { 255 },
    );
    warned(
        &bench,
        "bake aside.png -o map.png",
        "set --profile-axis 0.625",
    );
    warned(
        &bench,
        &format!("render aside.png -o out.png {SMALL}"),
        "object.0.profile: the middle of the solid",
    );
    for done in [
        "bake aside.png -o map.png --profile-axis 0.625".to_owned(),
        format!("render aside.png -o out.png {SMALL} --set object.0.profile_axis=.625"),
    ] {
        assert!(
            !lines(&bench.done(&done)).join(" ").contains("warning"),
            "{done}"
        );
    }
    bench.refused(
        "bake aside.png -o no.png --profile-axis 1.5",
        1,
        &["--profile-axis", "1.5"],
    );
    bench.refused(
        "bake aside.png -o no.png --profile-axis middle",
        2,
        &["--profile-axis", "0.62"],
    );
}

#[test]
fn points_beyond_the_box_and_insets_that_leave_nothing_are_named() {
    let bench = Bench::new();
    bench.object("polygon = [[0, -10], [40, -10], [20, 88]]");
    let render = format!("render scene.toml -o out.png {SMALL}");
    warned(
        &bench,
        &format!("{render} --set camera.eye=[200,0,100]"),
        "object.0.polygon: points outside",
    );
    bench.file("scene.toml", format!("{CAMERA}{CONE}"));
    warned(
        &bench,
        &format!("{render} --set object.0.extend=-0.9"),
        "object.0.extend: the inset of 0.9",
    );
}

/// Where a colour map is transparent, the object's colour shows.
#[test]
fn transparent_texels_show_the_color() {
    let bench = Bench::new();
    input(&bench, "band-colors.png");
    bench.file("a.svg", SVG);
    bench.object("profile = \"a.svg\"\nprofile_axis = \"left\"\ncolor = [1, 0, 0]\ncolor_map = \"band-colors.png\"");
    let light = "background=[0,0,0,1] --set ambient=[1,1,1] --set light=[]";
    bench.done(&format!(
        "render scene.toml -o out.png --size 64x48 --antialias off --set {light}"
    ));
    let picture = image::open(bench.path("out.png")).unwrap().to_rgba8();
    // Above and below the band, whose texels in between are blue.
    for y in [13, 37] {
        assert_eq!(picture.get_pixel(32, y).0, [255, 0, 0, 255]);
    }
    let blue = picture.pixels().filter(|p| p.0[2] > 200 && p.0[0] < 100);
    assert!(blue.count() > 5);
}

#[test]
fn headings_say_which_column_is_which() {
    let bench = Bench::new();
    bench.file(
        "scene.toml",
        format!("{CAMERA}{CONE}instances = \"copies.csv\"\n"),
    );
    let drawn = |text: &str| {
        bench.file("copies.csv", text);
        bench.done(&format!("render scene.toml -o out.png {SMALL}"));
        bench.read("out.png")
    };
    let usual = drawn("x,y,z,qx,qy,qz,qw,sx,sy,sz\n0,0.2,0.1,0,0,0,1,1,1,0.5\n");
    let other = drawn("qw,qx,qy,qz,x,z,y,sx,sy,sz\n1,0,0,0,0,0.1,0.2,1,1,0.5\n");
    assert!(usual == other);
    for (text, words) in [
        ("#x,y,z,w,qx,qy,qz,sx,sy,sz\n", "\"w\""),
        ("x,y,z,qx,qy,qz,w,sx,sy,sz\n", "\"w\""),
        ("x,y,z,sx,sy,sz\n", "lacks qx, qy, qz, qw"),
        ("x;y;z\n", "commas"),
    ] {
        bench.file("copies.csv", text);
        bench.refused(
            "render scene.toml -o no.png",
            1,
            &["copies.csv", "line 1", words],
        );
    }
}

#[test]
fn frames_of_an_earlier_turntable_are_not_mixed_with_new_ones() {
    let bench = Bench::new();
    let animate = |frames: u32| format!("animate scene.toml --frames {frames} {SMALL} -o t");
    bench.done(&animate(3));
    bench.file("t/own.png", "kept");
    bench.refused(
        &animate(2),
        2,
        &["t", "--output", "3 frames", "--overwrite"],
    );
    bench.done(&format!("{} --overwrite", animate(2)));
    let mut names: Vec<_> = std::fs::read_dir(bench.path("t"))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["frame-0000.png", "frame-0001.png", "own.png"]);
    // A frame that the scene reads is not removed.
    bench.half("t/frame-0001.png");
    bench.object("profile = \"t/frame-0001.png\"\nprofile_axis = \"left\"");
    bench.refused(
        &format!("{} --overwrite", animate(1)),
        2,
        &["frame-0001.png", "is read as well"],
    );
    bench.has(&["t/frame-0000.png", "t/frame-0001.png"]);
}

#[cfg(unix)]
#[test]
fn outputs_keep_their_mode_follow_links_and_spare_inputs() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let bench = Bench::new();
    let mode = |name: &str| {
        std::fs::metadata(bench.path(name))
            .unwrap()
            .permissions()
            .mode()
            & 0o777
    };
    bench.file("out.png", "");
    std::fs::set_permissions(bench.path("out.png"), PermissionsExt::from_mode(0o600)).unwrap();
    bench.done(&format!("render scene.toml -o out.png {SMALL}"));
    assert_eq!(mode("out.png"), 0o600);
    symlink("later.png", bench.path("link.png")).unwrap();
    bench.refused(
        "render scene.toml -o link.png -o later.png",
        2,
        &["later.png", "named twice"],
    );
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
fn numbers_are_read_as_people_type_them() {
    let bench = Bench::new();
    let set =
        |value: &str| format!("render scene.toml -o out.png {SMALL} --set object.0.extend={value}");
    let drawn = |value: &str| {
        bench.done(&set(value));
        bench.read("out.png")
    };
    let wanted = drawn("0.05");
    assert!(drawn(".05") == wanted && drawn("+.050") == wanted && drawn("5.e-2") == wanted);
    bench.done(&format!("{} --set object.0.color=[.5,.5,1.]", set("01.")));
    let no = "render scene.toml -o no.png --set object.0.extend=0,05";
    bench.refused(no, 1, &["object.0.extend", "write 0.05"]);
    for option in [
        "--tolerance 0,05",
        "--turn 0,05",
        "--vary object.0.extend=0:0,1",
    ] {
        let (command, frames) = if option.starts_with("--tol") {
            ("render", "-o no.png")
        } else {
            ("animate", "--frames 2")
        };
        bench.refused(&format!("{command} scene.toml {frames} {option}"), 2, &[]);
    }
}

#[test]
fn a_number_is_the_index_of_a_device() {
    let bench = Bench::new();
    let render = |device: &str| format!("render scene.toml -o no.png {SMALL} --device {device}");
    // The name of the software driver has a 5, a 6 and 256.
    for device in ["5", "6", "256", "99"] {
        bench.refused(
            &render(device),
            2,
            &[&format!(
                "--device: there is no device {device}; there are: 0 "
            )],
        );
    }
    bench.refused(
        &render("amd-nvidia"),
        2,
        &["no device is called 'amd-nvidia'"],
    );
    let mut command = bench.command(&render("0").replace(" --device 0", ""));
    bench.refused_by(
        command.env("REVMAP_DEVICE", "5"),
        2,
        &["revmap: REVMAP_DEVICE: there is no device 5"],
    );
}
