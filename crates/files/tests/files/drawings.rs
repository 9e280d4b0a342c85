//! Drawings of many programs: drawn as browsers draw them, warned of, or refused by name.

use crate::holds;
use crate::random::Random;
use revmap::error::Result;
use revmap::profile::{FillRule, Grid, Outline, Profile, Region};
use revmap_files::{ProfileAxis, profile_from_bytes};

fn file(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/drawings");
    std::fs::read(std::path::Path::new(folder).join(name)).unwrap()
}

#[track_caller]
fn silent(profile: &Profile, name: &str) {
    assert_eq!(profile.warnings, [""; 0], "{name}");
}

#[track_caller]
fn refused(drawing: Result<Profile>, words: &str) {
    holds(drawing.unwrap_err(), words);
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
        silent(&got, &example);
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
        holds(&got.warnings[0], &words);
    }
}

#[test]
fn the_page_lists_what_is_refused() {
    for (example, words) in rows("Refused") {
        let refusal = drawn(&example).expect_err(&example).to_string();
        holds(&refusal, &words);
        holds(&refusal, "; ");
        assert!(!refusal.contains('\n'), "{refusal}");
    }
}

#[test]
fn files_are_drawn_as_their_controls() {
    for name in ["unknown-colour", "vector-effect", "large-coordinates"] {
        let [case, control] =
            ["", "-control"].map(|part| read(&format!("{name}{part}.svg")).unwrap().outline);
        let off = difference(&case, &control);
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
    silent(&read("encodings.svg").unwrap(), "encodings");
    for (name, words) in [
        ("recursion", "a pattern (line 1)"),
        ("clip-shapes", "clip-path=\"inset(10px)\""),
        ("dropped-parts", "parts.svg#knob"),
    ] {
        refused(read(&format!("{name}.svg")), words);
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
    holds(warning("outline-drawing.svg"), "fill the shape");
    for words in ["x = 50.0000", "x = 58.0000"] {
        holds(warning("axis.svg"), words);
    }
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
    refused(drawn(&highlight("1")), "a gradient");
    let faint = drawn(&highlight(".4")).unwrap();
    assert!((faint.outline.area() - 0.16).abs() < 1e-6);
    // A gradient that later paint covers makes no difference.
    let covered = highlight("1") + "<rect x='25' y='25' width='20' height='20'/>";
    assert!((drawn(&covered).unwrap().outline.area() - 0.16).abs() < 1e-6);
}

#[test]
fn drawings_of_many_programs_bring_no_false_alarm() {
    let sound = "affinity ai_clip ai_rook cb_queen corel figma_bishop figma_iso ink_clone ink_pawn";
    for name in sound.split(' ') {
        silent(&read(&format!("chess-{name}.svg")).unwrap(), name);
    }
    for (name, words) in [
        ("figma_mask", "a mask"),
        ("figma_shadow", "a filter"),
        ("ink_grad", "a gradient"),
    ] {
        refused(read(&format!("chess-{name}.svg")), words);
    }
    for name in ["bishop", "king", "pawn", "rook"] {
        let path = crate::asset("profiles").join(format!("{name}.svg"));
        let got = revmap_files::profile(path, ProfileAxis::Center).unwrap();
        silent(&got, name);
    }
}

/// References in a circle and deep nesting overflow no stack, not even a small one.
#[test]
fn circles_and_depth_are_refused() {
    let run = || {
        let rect = "<rect width='9' height='9'/>";
        // Three elements, each of which refers to the next.
        let circle = |one: &str| -> String {
            let each = |i: usize| {
                one.replace("$i", &i.to_string())
                    .replace("$next", &((i + 1) % 3).to_string())
            };
            (0..3).map(each).collect()
        };
        let used = |property: &str| format!("<rect width='50' height='50' {property}='url(#e0)'/>");
        for (element, property) in [
            ("pattern", "fill"),
            ("clipPath", "clip-path"),
            ("mask", "mask"),
            ("pattern", "stroke"),
        ] {
            let inner = format!("<rect width='9' height='9' {property}='url(#e$next)'/>");
            let chain = circle(&format!("<{element} id='e$i'>{inner}</{element}>"));
            assert!(drawn(&(chain + &used(property))).is_err(), "{element}");
        }
        let clip = format!("<clipPath id='e$i' clip-path='url(#e$next)'>{rect}</clipPath>");
        let clips = circle(&clip);
        assert!(drawn(&(clips + &used("clip-path"))).is_err());
        let markers = "<marker id='m'><path d='M0 0H9' marker-end='url(#m)'/></marker><path d='M0 0H9' marker-end='url(#m)'/>";
        assert!(drawn(markers).is_err());
        let uses = circle(&format!("<g id='e$i'>{rect}<use href='#e$next'/></g>"));
        refused(drawn(&uses), "contains itself");
        let gradients = "<linearGradient id='a' href='#b'/><linearGradient id='b' href='#a'/><rect width='50' height='50' fill='url(#a)'/>";
        assert!(drawn(gradients).is_err());
        let nested = |n: usize, [open, close]: [&str; 2], inner: &str| {
            open.repeat(n) + inner + &close.repeat(n)
        };
        let deep = nested(100_000, ["<g>", "</g>"], rect);
        refused(drawn(&deep), "nested");
        let deep = nested(100_000, ["<tspan>", "</tspan>"], "a");
        assert!(drawn(&format!("<text>{deep}</text>")).is_err());
        let chain = "rect + ".repeat(20_000) + "rect";
        let siblings = rect.repeat(20_000);
        for selector in [&chain, &format!(":is({chain})")] {
            let style = format!("<style>{selector} {{fill:#fff}}</style>");
            refused(drawn(&(style + &siblings)), "rect + rect");
        }
        let groups = nested(190, ["<g opacity='.999'>", "</g>"], rect);
        assert!(drawn(&groups).is_ok());
        let links: String = (0..100_000)
            .map(|i| format!("<g id='g{i}'><use href='#g{}'/></g>", i + 1))
            .collect();
        assert!(drawn(&links).is_err());
        // Each level draws the one before it ten times.
        let many = |i: usize| {
            let ten = format!("<use href='#m{i}'/>").repeat(10);
            format!("<g id='m{}'>{ten}</g>", i + 1)
        };
        let bomb: String = (0..9).map(many).collect();
        let bomb = format!("<defs><g id='m0'>{rect}</g>{bomb}</defs><use href='#m9'/>");
        refused(drawn(&bomb), "200000");
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
        let text = String::from_utf8_lossy(&bytes);
        assert!(one.elapsed().as_secs() < 60, "{text}");
        if seconds.is_some() && one.elapsed().as_secs() > 4 {
            eprintln!("{:?}: {text}", one.elapsed());
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
