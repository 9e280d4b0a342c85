//! Pictures and maps of the scenes that come with the program, as it is run: what it refuses, warns
//! of and says.

use crate::run::{Bench, asset, lines};
use revmap::frame::Frame;
use revmap::maps::{DisplacementMap, SlopeFilter};
use revmap_files::read_exr;

const PAWN: &str = "render @scenes/pawn.toml -q";

#[test]
fn a_search_that_does_not_apply_is_refused_in_one_line() {
    let bench = Bench::new();
    let render = |scene| format!("render @scenes/{scene}.toml --size 80x60 --solver cone -o a.png");
    bench.refused(&render("goblet"), 1, &["object.0.profile"]);
    bench.done(&render("sphere"));
}

#[test]
fn rays_out_of_steps_are_warned_of() {
    let bench = Bench::new();
    let said = |options: &str| {
        let render = format!("render @scenes/pawn.toml --size 160x120 -o pawn.png {options}");
        lines(&bench.done(&render)).join("\n")
    };
    let few = "--solver live --max-steps 3";
    assert!(said(few).contains("pixels ran out of steps"));
    assert_eq!(said(&format!("{few} --quiet")), "");
    let enough = said("--solver live");
    assert!(!enough.contains("out of steps"), "{enough}");
    let told = said("--solver live --verbose");
    assert!(told.contains("exhausted: 0"), "{told}");
    // The default has none to run out of.
    let default = said("--verbose");
    assert!(!default.contains("out of steps"), "{default}");
}

/// `bake` writes a displacement map that is the height map's; `render --verbose` says what maps
/// take.
#[test]
fn maps_are_written_and_weighed() {
    let bench = Bench::new();
    bench.done("bake @profiles/bottle.png -o bottle.png --height-map @heights/brick.png");
    let read = |file| revmap_files::displacement_map(file, SlopeFilter::default()).unwrap();
    let baked = read(bench.path("bottle.displacement.png"));
    let own = read(asset("heights/brick.png").into());
    assert_eq!(baked.size(), own.size());
    let values = |m: &DisplacementMap| m.levels[0].texels.concat();
    let (a, b) = (values(&baked), values(&own));
    let largest = b.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    let near = |(a, b): (&f32, &f32)| (a - b).abs() <= largest / 65_000.0;
    assert!(a.iter().zip(&b).all(near));

    let render = "render @gallery/bumps.toml -o bumps.png --size 64x20 --solver live --verbose";
    let said = lines(&bench.done(render));
    let bytes = |key: &str| -> u32 {
        let mut lines = said.iter().filter_map(|line| line.strip_prefix(key));
        lines.next().unwrap().parse().unwrap()
    };
    assert!((100_000..10_000_000).contains(&bytes("map_bytes: ")));
    assert!((1_000_000..4_000_000).contains(&bytes("texture_bytes: ")));
}

#[test]
fn silhouettes_are_smoothed_in_pictures_and_not_in_data() {
    let bench = Bench::new();
    let draw = |name: &str, options: &str| {
        bench.done(&format!("{PAWN} -o {name} --size 64x48 {options}"));
        bench.read(name)
    };
    for stage in ["fragment", "compute", "reference"] {
        let png = |how: &str| draw("picture.png", &format!("--stage {stage} {how}"));
        let [on, off] = ["--antialias on", "--antialias off"].map(png);
        assert!(on != off, "{stage}");
        let default = if stage == "reference" { &off } else { &on };
        assert!(png("") == *default, "{stage}");
        assert!(png("--samples 4") == png("--samples 4 --antialias off"));
    }
    let [plain, on] = ["", "--antialias on"].map(|how| draw("frame.exr", how));
    assert!(plain == draw("frame.exr", "--antialias off"));
    assert!(plain != on);
}

/// Samples change colours at edges, and no other channel.
#[test]
fn samples_average_colours_alone() {
    let bench = Bench::new();
    let draw = |options: &str| -> Frame {
        bench.done(&format!("{PAWN} -o a.exr --size 64x48 {options}"));
        read_exr(bench.path("a.exr")).unwrap()
    };
    let plain = draw("");
    for samples in ["4", "64", "adaptive --show-rays rays.png"] {
        let mut averaged = draw(&format!("--samples {samples}"));
        let pairs = averaged.color.iter().zip(&plain.color);
        let between = pairs.filter(|(a, b)| a != b).count();
        assert!(between > 100, "{between}");
        averaged.color = plain.color.clone();
        assert_eq!(averaged.first_difference(&plain), None);
    }
    let rays = image::open(bench.path("rays.png")).unwrap().to_luma8();
    assert!([0, 255].map(|level| rays.pixels().any(|p| p.0[0] == level)) == [true; 2]);
    for (options, words) in [
        ("--samples adaptive --stage reference", "on a device"),
        ("--samples adaptive --solver mesh:16x32", "of searches"),
        ("--show-rays rays.png", "--samples adaptive"),
    ] {
        bench.refused(&format!("{PAWN} -o a.png {options}"), 2, &[words]);
    }
}

/// A traced picture becomes a drawing of few curves.
#[test]
fn outlines_are_drawings_again() {
    let bench = Bench::new();
    let said = bench.said("profile @profiles/bottle.png -o clean.svg --tolerance 0.0001");
    let numbers: Vec<usize> = said.split(' ').filter_map(|w| w.parse().ok()).collect();
    let few = matches!(numbers[..], [lines, curves, points] if 5 * (lines + curves) < points);
    assert!(few, "{said}");
    bench.done("render clean.svg -o clean.png --size 64x48");
    bench.refuses(
        2,
        "profile @profiles/bottle.png -o a.png                     | a.png | .svg
         profile clean.svg -o clean.svg                            | clean.svg | is read as well
         profile clean.svg -o a.svg --tolerance 0                  | --tolerance | object units or more",
    );
    bench.refused("profile none.jpg -o a.svg", 1, &["none.jpg"]);
}
