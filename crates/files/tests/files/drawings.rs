//! Drawings of many programs: drawn as browsers draw them, warned of, or refused by name.

use crate::random::Random;
use revmap::error::Result;
use revmap::profile::{FillRule, Grid, Outline, Profile, Region};
use revmap_files::{ProfileAxis, profile_from_bytes};

fn file(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/drawings");
    std::fs::read(std::path::Path::new(folder).join(name)).unwrap()
}

fn read(name: &str) -> Result<Profile> {
    profile_from_bytes(&file(name), ProfileAxis::Center)
}

/// A drawing of 100 x 100 with the axis at its left.
pub fn drawn(body: &str) -> Result<Profile> {
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">{body}</svg>"##
    );
    profile_from_bytes(text.as_bytes(), ProfileAxis::Left)
}

/// Area that one of two outlines has and the other has not.
pub fn difference(a: &Outline, b: &Outline) -> f64 {
    let grid = Grid::for_extent(2.0);
    let [a, b] = [a, b].map(|o| Region::enclosed(grid, &o.loops, FillRule::NonZero));
    let area = |r: Region| r.outline(grid).area();
    area(a.difference(&b)) + area(b.difference(&a))
}

/// The rows of the table under a heading of `docs/drawings.md`: example and outcome.
fn rows(heading: &str) -> Vec<(String, String)> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/drawings.md");
    let page = std::fs::read_to_string(page).unwrap();
    let part = page
        .split("\n## ")
        .find(|p| p.starts_with(heading))
        .unwrap();
    let rows = part.lines().filter(|l| l.starts_with("| ")).skip(1);
    let cell = |text: &str| text.trim().trim_matches('`').to_owned();
    let found: Vec<(String, String)> = rows
        .map(|row| {
            let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
            assert_eq!(cells.len(), 3, "{row}");
            (cell(cells[1]), cell(cells[2]))
        })
        .collect();
    assert!(found.len() > 9, "{heading}");
    found
}

#[test]
fn the_page_lists_what_is_drawn() {
    for (example, same) in rows("Drawn") {
        let got = drawn(&example).unwrap_or_else(|e| panic!("{example}: {e}"));
        assert!(got.warnings.is_empty(), "{example}: {:?}", got.warnings);
        let wanted = drawn(&same).unwrap();
        let off = difference(&got.outline, &wanted.outline);
        assert!(off < 2e-5, "{example}: {off}");
    }
}

#[test]
fn the_page_lists_what_is_warned_of() {
    for (example, words) in rows("Warned") {
        let got = drawn(&example).unwrap_or_else(|e| panic!("{example}: {e}"));
        assert_eq!(got.warnings.len(), 1, "{example}: {:?}", got.warnings);
        assert!(
            got.warnings[0].contains(&words),
            "{example}: {:?}",
            got.warnings
        );
    }
}

#[test]
fn the_page_lists_what_is_refused() {
    for (example, words) in rows("Refused") {
        let refusal = drawn(&example).expect_err(&example).to_string();
        assert!(refusal.contains(&words), "{example}: {refusal}");
        assert!(
            refusal.contains("; ") && !refusal.contains('\n'),
            "{refusal}"
        );
    }
}

#[test]
fn files_are_drawn_as_their_controls() {
    for name in ["unknown-colour", "vector-effect", "large-coordinates"] {
        let (case, control) = (
            read(&format!("{name}.svg")),
            read(&format!("{name}-control.svg")),
        );
        let off = difference(&case.unwrap().outline, &control.unwrap().outline);
        assert!(off < 1e-5, "{name}: {off}");
    }
    // Areas of the half in square units of the drawing, by hand.
    let circle = std::f64::consts::PI * 25.0;
    for (name, area) in [
        ("dots", 800.0 + 2.0 * circle),
        ("css-transform", 800.0 + 300.0),
        ("selectors", 800.0),
        ("symbol-size", 800.0 + circle),
        ("hidden-layers", 1600.0),
    ] {
        let got = read(&format!("{name}.svg")).unwrap().outline.area() * 1e4;
        assert!((got - area).abs() < 1e-3 * area, "{name}: {got} for {area}");
    }
    assert!(read("encodings.svg").unwrap().warnings.is_empty());
    for (name, words) in [
        ("recursion", "a pattern (line 1)"),
        ("clip-shapes", "clip-path=\"inset(10px)\""),
        ("dropped-parts", "parts.svg#knob"),
    ] {
        let refusal = read(&format!("{name}.svg")).unwrap_err().to_string();
        assert!(refusal.contains(words), "{refusal}");
    }
}

#[test]
fn many_translucent_shapes_are_resolved() {
    let start = std::time::Instant::now();
    let got = read("translucent.svg").unwrap();
    // 0.2 s on one core; before tiles, 32 s. The area is that of another program's picture.
    assert!(start.elapsed().as_secs_f64() < 10.0);
    assert!(got.outline.contains(glam::DVec2::new(0.1, 0.5)));
    assert!((got.outline.area() - 0.2329).abs() < 1e-3);
}

#[test]
fn a_gap_of_rounding_at_the_axis_is_closed() {
    let at_axis = |name: &str| profile_from_bytes(&file(name), ProfileAxis::Left).unwrap();
    let (gap, control) = (at_axis("axis-gap.svg"), at_axis("axis-gap-control.svg"));
    let surface = |p: &Profile| p.outline.surface_segments().count();
    assert_eq!(surface(&gap), surface(&control));
    assert!(difference(&gap.outline, &control.outline) < 1e-6);
}

#[test]
fn a_drawing_says_what_it_seems_to_be() {
    let warning = |name: &str| read(name).unwrap().warnings.join("\n");
    assert!(warning("outline-drawing.svg").contains("fill the shape"));
    assert!(
        warning("axis.svg").contains("x = 50.0000") && warning("axis.svg").contains("x = 58.0000")
    );
}

/// A highlight from white to transparent over black is light in part, though all of its stops are
/// light over white.
#[test]
fn gradients_are_judged_with_what_is_below_them() {
    let highlight = |opacity: &str| {
        format!(
            "<linearGradient id='g'><stop stop-color='#fff' stop-opacity='{opacity}'/>\
             <stop offset='1' stop-color='#fff' stop-opacity='0'/></linearGradient>\
             <rect x='20' y='20' width='40' height='40'/><rect x='30' y='30' width='9' height='9' fill='url(#g)'/>"
        )
    };
    assert!(
        drawn(&highlight("1"))
            .unwrap_err()
            .to_string()
            .contains("a gradient")
    );
    let faint = drawn(&highlight(".4")).unwrap();
    assert!((faint.outline.area() - 0.16).abs() < 1e-6);
    // A gradient that later paint covers makes no difference.
    let covered = highlight("1") + "<rect x='25' y='25' width='20' height='20'/>";
    assert!((drawn(&covered).unwrap().outline.area() - 0.16).abs() < 1e-6);
}

#[test]
fn drawings_of_many_programs_bring_no_false_alarm() {
    for name in [
        "affinity",
        "ai_clip",
        "ai_rook",
        "cb_queen",
        "corel",
        "figma_bishop",
        "figma_iso",
        "ink_clone",
        "ink_pawn",
    ] {
        let got = read(&format!("chess-{name}.svg")).unwrap();
        assert!(got.warnings.is_empty(), "{name}: {:?}", got.warnings);
    }
    for (name, words) in [
        ("figma_mask", "a mask"),
        ("figma_shadow", "a filter"),
        ("ink_grad", "a gradient"),
    ] {
        let refusal = read(&format!("chess-{name}.svg")).unwrap_err().to_string();
        assert!(refusal.contains(words), "{refusal}");
    }
    for name in ["bishop", "king", "pawn", "rook"] {
        let path = crate::asset("profiles").join(format!("{name}.svg"));
        let got = revmap_files::profile(path, ProfileAxis::Center).unwrap();
        assert!(got.warnings.is_empty(), "{name}: {:?}", got.warnings);
    }
}

/// References in a circle and deep nesting overflow no stack, not even a small one.
#[test]
fn circles_and_depth_are_refused() {
    let run = || {
        let rect = "<rect width='9' height='9'/>";
        let chain = |element: &str, property: &str, tail: &str| -> String {
            let one = |i: usize| {
                let next = (i + 1) % 3;
                format!(
                    "<{element} id='e{i}'><rect width='9' height='9' {property}='url(#e{next})'/></{element}>"
                )
            };
            (0..3).map(one).collect::<String>() + tail
        };
        let used = |property: &str| format!("<rect width='50' height='50' {property}='url(#e0)'/>");
        for (element, property) in [
            ("pattern", "fill"),
            ("clipPath", "clip-path"),
            ("mask", "mask"),
            ("pattern", "stroke"),
        ] {
            assert!(
                drawn(&chain(element, property, &used(property))).is_err(),
                "{element}"
            );
        }
        let clips: String = (0..3)
            .map(|i| {
                format!(
                    "<clipPath id='e{i}' clip-path='url(#e{})'>{rect}</clipPath>",
                    (i + 1) % 3
                )
            })
            .collect();
        assert!(drawn(&(clips + &used("clip-path"))).is_err());
        let markers = "<marker id='m'><path d='M0 0H9' marker-end='url(#m)'/></marker><path d='M0 0H9' marker-end='url(#m)'/>";
        assert!(drawn(markers).is_err());
        let uses: String = (0..3)
            .map(|i| format!("<g id='e{i}'>{rect}<use href='#e{}'/></g>", (i + 1) % 3))
            .collect();
        assert!(
            drawn(&uses)
                .unwrap_err()
                .to_string()
                .contains("contains itself")
        );
        let gradients = "<linearGradient id='a' href='#b'/><linearGradient id='b' href='#a'/><rect width='50' height='50' fill='url(#a)'/>";
        assert!(drawn(gradients).is_err());
        let deep = "<g>".repeat(100_000) + rect + &"</g>".repeat(100_000);
        assert!(drawn(&deep).unwrap_err().to_string().contains("nested"));
        let deep = "<text>".to_owned()
            + &"<tspan>".repeat(100_000)
            + "a"
            + &"</tspan>".repeat(100_000)
            + "</text>";
        assert!(drawn(&deep).is_err());
        let chain = "rect + ".repeat(20_000) + "rect";
        let siblings = rect.repeat(20_000);
        for selector in [&chain, &format!(":is({chain})")] {
            let long = drawn(&format!(
                "<style>{selector} {{fill:#fff}}</style>{siblings}"
            ));
            assert!(long.unwrap_err().to_string().contains("rect + rect"));
        }
        let nested = "<g opacity='.999'>".repeat(190) + rect + &"</g>".repeat(190);
        assert!(drawn(&nested).is_ok());
        let links: String = (0..100_000)
            .map(|i| format!("<g id='g{i}'><use href='#g{}'/></g>", i + 1))
            .collect();
        assert!(drawn(&links).is_err());
        // Each level draws the one before it ten times.
        let many = |i: usize| {
            format!(
                "<g id='m{}'>{}</g>",
                i + 1,
                format!("<use href='#m{i}'/>").repeat(10)
            )
        };
        let bomb: String = (0..9).map(many).collect();
        let bomb = format!("<defs><g id='m0'>{rect}</g>{bomb}</defs><use href='#m9'/>");
        assert!(drawn(&bomb).unwrap_err().to_string().contains("200000"));
    };
    let small = std::thread::Builder::new().stack_size(1 << 20);
    small.spawn(run).unwrap().join().unwrap();
}

/// Drawings with random changes are drawn or refused. `REVMAP_MUTATE_SECONDS` runs for longer.
#[test]
fn mutated_drawings_neither_panic_nor_take_long() {
    let seconds = std::env::var("REVMAP_MUTATE_SECONDS")
        .ok()
        .and_then(|s| s.parse().ok());
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/drawings");
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    names.sort();
    let mut seeds: Vec<Vec<u8>> = names.iter().map(|p| std::fs::read(p).unwrap()).collect();
    for heading in ["Drawn", "Warned", "Refused"] {
        let wrap = |(body, _): (String, String)| {
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>")
                .into_bytes()
        };
        seeds.extend(rows(heading).into_iter().map(wrap));
    }
    seeds.retain(|s| s.len() < 6000);
    let pieces: Vec<&str> = "1e9 -1 0 1e-9 NaN 1e38 99999999999 % px em url(#a) url(#e0) none inherit var(--a) <use href='#a'/> id='a' \
        <g> </g> opacity='.5' transform='matrix(1e9,0,0,1e-9,0,0)' transform='scale(0)' clip-path='url(#c)' stroke-dasharray='0' \
        stroke-dasharray='1e-9' stroke-width='1e9' d='M0 0A1 1e9 0 1 1 5 5' A0 0 0 0 0 0 0 C viewBox='0 0 1e9 1' width='0' \
        marker-mid='url(#m)' vector-effect='non-scaling-stroke' <svg> </svg> :nth-child(-n) { } @media ; fill='#fff' stroke='#000'"
        .split_ascii_whitespace()
        .collect();
    let start = std::time::Instant::now();
    let (mut random, mut runs) = (Random(start.elapsed().as_nanos() as u64 | 1), 0);
    if seconds.is_none() {
        random = Random(7);
    }
    loop {
        let mut bytes = seeds[random.below(seeds.len())].clone();
        for _ in 0..=random.below(6) {
            let at = random.below(bytes.len());
            match random.below(5) {
                0 => bytes[at] = random.below(256) as u8,
                1 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
                2 => {
                    let piece = pieces[random.below(pieces.len())];
                    bytes.splice(at..at, piece.bytes());
                }
                3 => {
                    let other = &seeds[random.below(seeds.len())];
                    let from = random.below(other.len());
                    let part = other[from..(from + random.below(80)).min(other.len())].to_vec();
                    bytes.splice(at..at, part);
                }
                _ => {
                    // A number becomes another one.
                    let digit = bytes.iter().skip(at).position(u8::is_ascii_digit);
                    if let Some(k) = digit {
                        bytes[at + k] = b'0' + random.below(10) as u8;
                    }
                }
            }
            if bytes.is_empty() {
                bytes.push(b'<');
            }
        }
        let one = std::time::Instant::now();
        let axis = [ProfileAxis::Left, ProfileAxis::Center][random.below(2)];
        if seconds.is_some() {
            let name = std::env::temp_dir().join("revmap-mutated.svg");
            std::fs::write(name, &bytes).unwrap();
        }
        let _ = profile_from_bytes(&bytes, axis);
        assert!(
            one.elapsed().as_secs() < 60,
            "{}",
            String::from_utf8_lossy(&bytes)
        );
        if seconds.is_some() && one.elapsed().as_secs() > 4 {
            eprintln!("{:?}: {}", one.elapsed(), String::from_utf8_lossy(&bytes));
        }
        runs += 1;
        match seconds {
            None if runs >= 500 => break,
            Some(s) if start.elapsed().as_secs() >= s => break,
            _ => {}
        }
    }
    eprintln!("{runs} drawings");
}
