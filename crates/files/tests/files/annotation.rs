//! Lines of technical drawings beside a filled shape: named, and left out by one key.

use crate::seeming::pictured;
use revmap::error::Result;
use revmap::profile::Profile;
use revmap_files::ProfileAxis::{self, Center, Left};
use revmap_files::{ProfileOptions, profile_from_bytes};

/// A whole silhouette about x = 50 and its right half, from y = 20 to y = 80.
const WHOLE: &str = "<path d='M40 20H60L54 45L70 80H30L46 45z'/>";
const HALF: &str = "<path d='M0 20H10L4 45L20 80H0z'/>";

/// A drawing of 100 x 100 whose second line is `shape` and whose third is `lines`.
fn svg(shape: &str, lines: &str) -> Vec<u8> {
    let head = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>";
    format!("{head}\n{shape}\n<g fill='none' stroke='#000' stroke-width='.4'>{lines}</g></svg>")
        .into_bytes()
}

fn read(bytes: &[u8], axis: ProfileAxis, min_stroke: f64) -> Result<Profile> {
    let options = ProfileOptions {
        axis,
        min_stroke,
        ..ProfileOptions::default()
    };
    profile_from_bytes(bytes, options)
}

/// Shape, lines, and the kinds in the drawing and in its picture.
const CASES: &str = "
whole | <rect x='4' y='4' width='92' height='92'/> | a frame | a frame
whole | <path d='M4 4H96M96 4V96M96 96H4M4 96V4'/> | a frame | a frame
half | <path d='M0 4H96V96H0'/> | a frame | a frame
whole | <path d='M50 5V95' stroke-dasharray='8 1.5 1 1.5'/> | a centre line | a centre line
whole | <path d='M50 5V95'/> | a centre line | a centre line
whole | <path d='M50 5V95M20 50H80'/> | a centre line | a centre line
half | <path d='M0 5V95' stroke-width='.8'/> | a centre line | a centre line
half | <path d='M10 20H45M20 80H45M42 20V80'/> | a dimension | a dimension
whole | <path d='M60 20H95M70 80H95M92 20V80'/> | a dimension | a dimension
whole | <path d='M30 80V95M70 80V95M30 92H70'/> | a dimension | a dimension
whole | <path d='M60 20L80 10'/> | a dimension |
whole | <path d='M70 30C80 30 90 40 90 50'/> | a thin line |
whole | <rect x='4' y='4' width='92' height='92'/><path d='M50 10V90M70 20C74 20 74 30 70 30'/> | a frame, a centre line, a thin line | a frame, a centre line
half | <path d='M10 20H45M20 80H45M42 20V80M0 8V90'/> | a centre line, a dimension | a centre line, a dimension";

/// Shape, axis, lines, and the kinds.
fn cases() -> impl Iterator<
    Item = (
        &'static str,
        ProfileAxis,
        &'static str,
        [Vec<&'static str>; 2],
    ),
> {
    CASES.lines().skip(1).map(|line| {
        let parts: Vec<&str> = line.split('|').map(str::trim).collect();
        let (shape, axis) = match parts[0] {
            "half" => (HALF, Left),
            _ => (WHOLE, Center),
        };
        let kinds = [parts[2], parts[3]].map(|kinds| kinds.split(", ").collect());
        (shape, axis, parts[1], kinds)
    })
}

/// Wants one warning for each kind, with `words`.
#[track_caller]
fn named(found: &[String], kinds: &[&str], words: &[&str]) {
    let is_named = |(text, kind): (&String, &&str)| {
        text.contains(*kind) && words.iter().all(|word| text.contains(word))
    };
    assert!(
        found.len() == kinds.len() && found.iter().zip(kinds).all(is_named),
        "{kinds:?}: {found:?}"
    );
}

#[test]
fn lines_beside_a_shape_are_named() {
    for (shape, axis, lines, [kinds, _]) in cases() {
        println!("{lines}");
        let found = read(&svg(shape, lines), axis, 0.0).unwrap().warnings;
        named(&found, &kinds, &["(line 3)", "profile_min_stroke = 0.00"]);
        let (_, rest) = found[0].split_once("min_stroke = ").unwrap();
        let min_stroke: f64 = rest.parse().unwrap();
        assert!(min_stroke > 0.004 && min_stroke < 0.01, "{min_stroke}");
        let without = read(&svg(shape, lines), axis, min_stroke).unwrap();
        let plain = read(&svg(shape, ""), axis, 0.0).unwrap();
        assert_eq!(without.outline, plain.outline);
        assert_eq!(without.warnings, [""; 0]);
    }
}

#[test]
fn lines_of_pictures_are_named() {
    for (shape, axis, lines, [_, kinds]) in cases().filter(|case| case.3[1] != [""]) {
        for side in [300, 800] {
            println!("{side} {lines}");
            // Lines of a third of a pixel would not show.
            let lines = match side == 300 && !lines.contains("stroke-width") {
                true => lines.replace("<path ", "<path stroke-width='.7' "),
                false => lines.to_owned(),
            };
            let picture = pictured(&svg(shape, &lines), side);
            let found = read(&picture, axis, 0.0).unwrap().warnings;
            named(&found, &kinds, &["erase it"]);
        }
    }
}

/// A line that stands for half of a part tells where its axis is.
#[test]
fn the_shape_without_its_lines_is_looked_at() {
    let lines = "<path d='M10 20H75M20 80H75M72 20V80'/>";
    for bytes in [svg(HALF, lines), pictured(&svg(HALF, lines), 800)] {
        let found = read(&bytes, Center, 0.0).unwrap().warnings;
        named(&found, &["a dimension", "set profile_axis = \"left\""], &[]);
    }
}

#[test]
fn hairlines_and_a_key_that_leaves_nothing() {
    let refusal =
        |bytes: &[u8], min_stroke: f64| read(bytes, Center, min_stroke).unwrap_err().to_string();
    let hairlines = svg(
        "",
        "<path d='M50 20H60L54 45L70 80H30L46 45L40 20z' stroke-width='.001'/>",
    );
    assert!(refusal(&hairlines, 0.0).contains("too thin to be solid; fill the shape"));
    let lines = svg("", "<path d='M40 20H60L54 45L70 80'/>");
    assert!(refusal(&lines, 0.01).contains("give a smaller profile_min_stroke"));
    for wrong in [-0.1, 1.0, f64::NAN] {
        assert!(refusal(&lines, wrong).contains("profile_min_stroke"));
    }
    let picture = pictured(&svg(WHOLE, ""), 64);
    assert!(refusal(&picture, 0.01).contains("counts for drawings alone"));
}
