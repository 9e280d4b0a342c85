//! Lines of technical drawings beside a filled shape: named, and left out by one key.

use crate::seeming::pictured;
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

/// Warnings about a drawing.
fn warnings(bytes: &[u8], axis: ProfileAxis, min_stroke: f64) -> Vec<String> {
    let options = ProfileOptions {
        axis,
        min_stroke,
        ..ProfileOptions::default()
    };
    profile_from_bytes(bytes, options).unwrap().warnings
}

const DIMENSION: &str = "a dimension or extension line";

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

/// The cases, each kind by its whole name.
fn cases() -> Vec<(&'static str, &'static str, [Vec<&'static str>; 2])> {
    let kinds = |text: &'static str| -> Vec<&str> {
        let names = text
            .split(',')
            .map(str::trim)
            .filter(|name| !name.is_empty());
        names
            .map(|name| {
                if name == "a dimension" {
                    DIMENSION
                } else {
                    name
                }
            })
            .collect()
    };
    let case = |line: &'static str| {
        let parts: Vec<&str> = line.split('|').map(str::trim).collect();
        let shape = if parts[0] == "half" { HALF } else { WHOLE };
        (shape, parts[1], [kinds(parts[2]), kinds(parts[3])])
    };
    CASES.lines().skip(1).map(case).collect()
}

fn axis_of(shape: &str) -> ProfileAxis {
    if shape == HALF { Left } else { Center }
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
    for (shape, lines, [kinds, _]) in cases() {
        println!("{lines}");
        let found = warnings(&svg(shape, lines), axis_of(shape), 0.0);
        named(&found, &kinds, &["(line 3)", "profile_min_stroke = 0.00"]);
        let (_, rest) = found[0].split_once("min_stroke = ").unwrap();
        let min_stroke: f64 = rest.parse().unwrap();
        assert!(min_stroke > 0.004 && min_stroke < 0.01, "{min_stroke}");
        let options = ProfileOptions {
            axis: axis_of(shape),
            min_stroke,
            ..ProfileOptions::default()
        };
        let without = profile_from_bytes(&svg(shape, lines), options).unwrap();
        let plain = profile_from_bytes(&svg(shape, ""), axis_of(shape)).unwrap();
        assert_eq!(without.outline, plain.outline);
        assert_eq!(without.warnings, [""; 0]);
    }
}

#[test]
fn lines_of_pictures_are_named() {
    for (shape, lines, [_, kinds]) in cases() {
        for side in [300, 800] {
            println!("{side} {lines}");
            // Lines of a third of a pixel would not show.
            let lines = match side {
                300 => lines.replace("<path ", "<path stroke-width='.7' "),
                _ => lines.to_owned(),
            };
            let lines = lines.replace(
                "stroke-width='.7' d='M0 5V95' stroke-width='.8'",
                "d='M0 5V95' stroke-width='.8'",
            );
            let picture = pictured(&svg(shape, &lines), side);
            let found = warnings(&picture, axis_of(shape), 0.0);
            if kinds.is_empty() {
                continue;
            }
            named(&found, &kinds, &["erase it"]);
        }
    }
}

/// A line that stands for half of a part tells where its axis is.
#[test]
fn the_shape_without_its_lines_is_looked_at() {
    let lines = "<path d='M10 20H75M20 80H75M72 20V80'/>";
    for bytes in [svg(HALF, lines), pictured(&svg(HALF, lines), 800)] {
        let found = warnings(&bytes, Center, 0.0);
        named(&found, &[DIMENSION, "set profile_axis = \"left\""], &[]);
    }
}

#[test]
fn good_drawings_with_thin_strokes_bring_no_warning() {
    let stroke = |d: &str, width: f64| {
        format!("<path d='{d}' fill='none' stroke='#000' stroke-width='{width}'/>")
    };
    let fins: String = (22..78)
        .step_by(2)
        .map(|y| format!("<path d='M20 {y}H80v1H20z'/>"))
        .collect();
    for (number, shape) in [
        // An outline of the shape itself, light lines and dark ones within it.
        WHOLE.replace("<path ", "<path stroke='#000' stroke-width='.5' "),
        format!("{WHOLE}{}", stroke("M40 20H60L54 45L70 80H30L46 45z", 0.5)),
        format!("{WHOLE}<path d='M32 78H68' stroke='#fff' stroke-width='.3'/>"),
        format!("{WHOLE}{}", stroke("M34 75H66M50 22V78", 0.4)),
        // A light line beside the shape, and one that is clipped away or covered.
        format!("{WHOLE}<path d='M4 4H96V96H4z' fill='none' stroke='#ddd' stroke-width='.5'/>"),
        format!(
            "{}<path d='M0 0H100V100H0z' fill='#fff'/>{WHOLE}",
            stroke("M4 4H96V96H4z", 0.4)
        ),
        // A cross on top, of strokes of 3 % of the height; thin fins that are filled.
        format!("{WHOLE}{}", stroke("M50 21V8M44 12H56", 3.0)),
        format!("{WHOLE}{fins}"),
    ]
    .iter()
    .enumerate()
    {
        let bytes = svg(shape, "");
        assert_eq!(warnings(&bytes, Center, 0.0), [""; 0], "{number}");
        assert_eq!(
            warnings(&pictured(&bytes, 300), Center, 0.0),
            [""; 0],
            "{number}"
        );
    }
}

/// Thin walls, legs and spires of a picture are parts of the solid.
#[test]
fn good_pictures_with_thin_parts_bring_no_warning() {
    for (number, shape) in [
        // A glass on a foot, a table, a tower with a spire, a bell jar, a wheel on a thick axle.
        "<path d='M35 90H65V80H35zM30 20h.6v60h38.8v-60h.6v61h-40z'/>",
        "<path d='M20 20H80v.7H20zM25 20h.7v60h-.7zM74.3 20h.7v60h-.7zM20 80H80v10H20z'/>",
        "<path d='M49.7 5h.6v30h-.6zM40 35H60V90H40z'/>",
        "<path d='M30 90H70V84H30zM35 84V30A15 20 0 0 1 65 30V84h-.7V30A14.3 19.3 0 0 0 35.7 30V84z'/>",
        "<path d='M30 30H70V70H30zM49 10h2v80h-2z'/>",
    ]
    .into_iter()
    .enumerate()
    {
        for side in [300, 800] {
            let picture = pictured(&svg(shape, ""), side);
            let found = warnings(&picture, Center, 0.0);
            assert!(!found.iter().any(|w| w.contains("erase it")), "{number}: {found:?}");
        }
    }
}

#[test]
fn hairlines_and_a_key_that_leaves_nothing() {
    let refusal = |bytes: &[u8], min_stroke: f64| {
        let options = ProfileOptions {
            min_stroke,
            ..ProfileOptions::default()
        };
        profile_from_bytes(bytes, options).unwrap_err().to_string()
    };
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
