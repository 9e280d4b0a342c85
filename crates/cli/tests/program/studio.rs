//! `--studio`, and the options of plain colours.

use crate::run::{Bench, CAMERA, CONE, SVG, table};
use image::RgbaImage;

fn draw(bench: &Bench, arguments: &str) -> RgbaImage {
    bench.done(&format!("render {arguments} -o a.png"));
    bench.picture("a.png")
}

/// Parts of the picture that are not transparent: left, right, top, bottom.
fn bounds(picture: &RgbaImage) -> [f64; 4] {
    let solid = picture.enumerate_pixels().filter(|(.., p)| p.0[3] > 127);
    let mut all = [1.0f64, 0.0, 1.0, 0.0];
    for (x, y, _) in solid {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (width, height) = picture.dimensions();
        let at = [x / f64::from(width), y / f64::from(height)];
        for k in 0..2 {
            all[2 * k] = all[2 * k].min(at[k]);
            all[2 * k + 1] = all[2 * k + 1].max(at[k]);
        }
    }
    all
}

const PLATE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 40'><path d='M5 10H95L60 20H40z'/></svg>";

#[test]
fn a_thing_fills_four_fifths_of_the_picture() {
    let bench = Bench::new();
    bench.file("plate.svg", PLATE);
    for row in table(
        "@profiles/pawn.svg --size 200x150 | high
         @profiles/pawn.svg --size 100x300 | wide
         plate.svg --size 200x150          | wide
         @profiles/pawn.svg --set object.0.rotation=[1,0,0,1] --size 200x100 | high
         @profiles/pawn.svg --set object.0.extend=0.2 --size 200x150         | high
         plate.svg --set object.0.position=[3,-2,7] --size 150x150           | wide",
    ) {
        let (thing, wide) = (row[0], row[1] == "wide");
        let picture = draw(
            &bench,
            &format!("{thing} --studio --background transparent"),
        );
        let [left, right, top, bottom] = bounds(&picture);
        let [low, high] = if wide { [left, right] } else { [top, bottom] };
        let fills = (low - 0.1).abs() < 0.012 && (high - 0.9).abs() < 0.012;
        assert!(fills, "{thing}: {low} {high}");
        let other = if wide { bottom - top } else { right - left };
        assert!(other < 0.8, "{thing}: {other}");
    }
}

/// The sweep's largest shape fills the picture, and the camera stays.
#[test]
fn a_film_is_framed_as_a_whole() {
    let bench = Bench::new();
    bench.file("a.svg", SVG);
    let film = "animate a.svg --frames 4 --size 120x90 --studio --background transparent -o f";
    bench.done(&format!("{film} --vary object.0.extend=0:0.3"));
    let high = |n: u32| {
        let [.., top, bottom] = bounds(&bench.picture(&format!("f/frame-000{n}.png")));
        bottom - top
    };
    let (first, last) = (high(0), high(3));
    assert!(first < 0.7 && last > 0.75 && last < 0.82, "{first} {last}");
}

#[test]
fn a_camera_of_ones_own_stays() {
    let bench = Bench::new();
    bench.file("mine.toml", format!("{CAMERA}{CONE}"));
    bench.file("a.svg", SVG);
    let camera = "--set camera.eye=[3,1,2]";
    for thing in ["mine.toml".to_owned(), format!("a.svg {camera}")] {
        let of = |more: &str| bounds(&draw(&bench, &format!("{thing} --size 80x60 {more}")));
        assert_eq!(of(""), of("--studio --background transparent"), "{thing}");
    }
}

/// The ground fades into the background: no row of pixels beside the thing differs much from the
/// next.
#[test]
fn the_ground_has_a_soft_edge() {
    let bench = Bench::new();
    let render = "@profiles/pawn.svg --studio --size 96x96 --antialias off";
    for stage in ["fragment", "compute", "reference"] {
        let colors = "--ground rgb(200,60,60) --background rgb(60,60,200)";
        let picture = draw(&bench, &format!("{render} --stage {stage} {colors}"));
        let column = |x: u32| (0..96).map(move |y| (x, y));
        let at = |(x, y): (u32, u32)| picture.get_pixel(x, y).0;
        assert_eq!(at((4, 0)), [60, 60, 200, 255], "{stage}");
        let foot = at((64, 92));
        assert!(foot[0] > 190 && foot[2] < 80, "{stage}: {foot:?}");
        let step = |y: u32| at((4, y))[0].abs_diff(at((4, y + 1))[0]);
        let largest = (0..95).map(step).max();
        assert!(largest < Some(30), "{stage}: {largest:?}");
        assert!(column(4).all(|p| at(p)[3] == 255));
    }
}

/// With a background alone, picture and ground are one colour, and a shadow is on it.
#[test]
fn one_colour_all_round() {
    let bench = Bench::new();
    for stage in ["fragment", "compute", "reference"] {
        let render = "@profiles/pawn.svg --studio --size 96x96 --antialias off";
        let picture = draw(
            &bench,
            &format!("{render} --background #cccccc --stage {stage}"),
        );
        // Above the thing, and right of it before the ground: no shadow reaches there.
        let edge = (0..96).map(|x| (x, 0)).chain((70..96).map(|x| (x, 95)));
        for (x, y) in edge {
            let [v, ..] = picture.get_pixel(x, y).0;
            assert!(v.abs_diff(0xcc) < 3, "{stage}: {v} at {x} {y}");
        }
        let shaded = picture.pixels().filter(|p| p.0[0] < 0xcc - 40).count();
        assert!((60..3000).contains(&shaded), "{stage}: {shaded}");
    }
}

/// Light from behind: the edge away from the key is brighter than the shade beside it.
#[test]
fn a_rim_of_light_is_on_the_dark_side() {
    let bench = Bench::new();
    let ring = "@gallery/ring.svg --studio --size 200x200 --background transparent";
    let picture = draw(&bench, ring);
    let row = (0..200).map(|x| picture.get_pixel(x, 90).0);
    let row: Vec<u8> = row.filter(|p| p[3] == 255).map(|p| p[0]).collect();
    let darkest = *row.iter().min().unwrap();
    let rim = *row[row.len() - 8..].iter().max().unwrap();
    assert!(rim > darkest + 25, "{rim} {darkest}");
}

#[test]
fn colours_are_those_of_css() {
    let bench = Bench::new();
    bench.file("a.svg", SVG);
    bench.file(
        "two.toml",
        format!("{CAMERA}{CONE}{CONE}position = [0, 0, 3]\n"),
    );
    let tint = |arguments: &str| {
        let picture = draw(&bench, &format!("{arguments} --size 40x30"));
        let [r, g, b, _] = picture.get_pixel(20, 15).0;
        (r > g.saturating_add(30), b > g.saturating_add(30))
    };
    let red = "a.svg --studio --color hsl(0,100%,50%)";
    assert_eq!(tint(red), (true, false));
    assert_eq!(tint("two.toml --color blue"), (false, true));
    // A key that is set says more.
    let set = tint("a.svg --color blue --set object.0.color=[1,0,0]");
    assert_eq!(set, (true, false));
    let teal = draw(&bench, "a.svg --size 40x30 --background teal");
    assert_eq!(teal.get_pixel(0, 0).0, [0, 128, 128, 255]);
    bench.refuses(
        2,
        "render a.svg -o b.png --studio --set shadow=off                   | --set shadow | --studio
         render a.svg -o b.png --studio --set background=[0,0,0,1]         | --set background | --studio
         animate a.svg --frames 2 --studio --vary ambient.0=0:1            | ambient | --studio
         render a.svg -o b.png --color greenish                            | --color | greenish | rgb(
         render a.svg -o b.png --color transparent                         | --color | transparent
         render a.svg -o b.png --ground red                                | --studio
         render a.svg -o b.png --studio --ground red --background #fff8    | --ground | --background",
    );
}
