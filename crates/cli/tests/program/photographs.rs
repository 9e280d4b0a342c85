//! Photographs in place of a scene, and as profiles.

use crate::run::{Bench, SVG, holds, lines};
use image::{Rgb, RgbImage};

/// A pale vase before a dark wall, at 0.45 of the width; with `flag`, a flag on a pole.
fn photograph(bench: &Bench, name: &str, flag: bool) {
    let picture = RgbImage::from_fn(150, 200, |x, y| {
        let (u, v) = (f64::from(x) + 0.5 - 67.5, f64::from(y) + 0.5);
        let radius = 22.0 + 10.0 * (0.04 * v).sin();
        let vase = (20.0..180.0).contains(&v) && u.abs() < radius;
        let pole = (20.0..180.0).contains(&v) && u.abs() < 5.0;
        let banner = (20.0..90.0).contains(&v) && (0.0..60.0).contains(&u);
        let solid = if flag { pole || banner } else { vase };
        let grain = ((x * 7 + y * 13) % 5) as u8;
        match solid {
            true => Rgb([215 + grain - (x / 4) as u8, 205 - (x / 4) as u8, 190]),
            false => Rgb([60 + grain + (y / 10) as u8, 70, 84]),
        }
    });
    picture.save(bench.path(name)).unwrap();
}

/// Lines on standard error but those about the device.
fn said(bench: &Bench, arguments: &str) -> Vec<String> {
    let all = lines(&bench.done(arguments)).into_iter();
    all.filter(|line| !line.starts_with("device: ")).collect()
}

#[test]
fn one_line_says_what_was_taken_and_a_picture_shows_it() {
    let bench = Bench::new();
    photograph(&bench, "vase.png", false);
    for arguments in [
        "profile vase.png -o a.svg --show-outline over.png",
        "mesh vase.png -o a.stl --show-outline over.png",
        "render vase.png -o a.png --size 32x24 --show-outline over.png",
        "animate vase.png --frames 1 --size 32x24 --show-outline over.png",
    ] {
        let found = said(&bench, arguments);
        let words = "vase.png: read as a photograph: light on a darker ground";
        assert!(found.len() == 1 && found[0].starts_with(words), "{found:?}");
        assert!(found[0].contains("axis at 0.45"), "{found:?}");
        let [vase, over] = ["vase.png", "over.png"].map(|f| bench.picture(f));
        let changed = vase.pixels().zip(over.pixels()).filter(|(a, b)| a != b);
        let changed: Vec<_> = changed.map(|(_, b)| b.0).collect();
        assert!((300..900).contains(&changed.len()), "{}", changed.len());
        assert!(changed.iter().all(|c| *c == [255, 0, 64, 255]));
        std::fs::remove_file(bench.path("over.png")).unwrap();
    }
    assert_eq!(said(&bench, "profile vase.png -o b.svg --quiet"), [""; 0]);
    // The outline in the picture's own units: radius, and the picture's height.
    holds(&bench.text("b.svg"), &["<svg"]);
    let again = said(&bench, "profile b.svg -o c.svg");
    assert_eq!(again, [""; 0]);
}

#[test]
fn a_scene_and_keys_of_the_threshold_keep_their_meaning() {
    let bench = Bench::new();
    photograph(&bench, "vase.png", false);
    let inverted = "warning: object.0.profile: the picture looks like a light solid";
    let light = |arguments: &str| {
        let found = said(&bench, arguments);
        assert_eq!(found.len(), 1, "{found:?}");
        holds(&found[0], &[inverted]);
    };
    bench.object("profile = \"vase.png\"");
    light("render scene.toml -o a.png --size 32x24");
    light("render vase.png -o a.png --size 32x24 --set object.0.profile_threshold=0.5");
    let auto = "render scene.toml -o a.png --size 32x24 --set object.0.profile_read=auto";
    let found = said(&bench, auto);
    assert_eq!(found.len(), 1, "{found:?}");
    holds(&found[0], &["read as a photograph"]);
    let found = said(&bench, "profile vase.png -o a.svg --profile-read threshold");
    let warn = found.iter().all(|line| line.starts_with("warning: "));
    assert!(warn && !found.is_empty(), "{found:?}");
    let profile = "profile vase.png -o no.svg --profile-read";
    bench.refused(
        &format!("{profile} auto --profile-invert"),
        1,
        &["--profile-read"],
    );
    bench.refused(&format!("{profile} both"), 2, &["threshold", "auto"]);
}

#[test]
fn what_shows_no_turned_thing_is_refused_by_name() {
    let bench = Bench::new();
    photograph(&bench, "flag.png", true);
    let words = ["flag.png", "axis of symmetry", "profile-read"];
    bench.refused("profile flag.png -o no.svg", 1, &words);
    bench.file("a.svg", SVG);
    let a_drawing = "profile a.svg -o no.svg --show-outline no.png";
    bench.refused(a_drawing, 1, &["a.svg", "pictures alone"]);
    bench.refuses(
        2,
        "mesh a.svg -o no.stl --show-outline no.png      | --show-outline | for pictures | leave it out
         mesh flag.png -o no.stl --show-outline flag.png | flag.png | is read as well",
    );
}
