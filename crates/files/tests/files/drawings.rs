//! Drawings of many programs: drawn as browsers draw them, warned of, or refused by name.

use crate::holds;
use revmap::error::Result;
use revmap::profile::{FillRule, Grid, Outline, Profile, Region};
use revmap_files::{ProfileAxis, css_color, profile_from_bytes};

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

/// A drawing of 100 x 100.
fn page(body: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 100 100'>{body}</svg>"
    )
}

/// A drawing of 100 x 100 with the axis at its left.
pub fn drawn(body: &str) -> Result<Profile> {
    profile_from_bytes(page(body).as_bytes(), ProfileAxis::Left)
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
fn a_drawing_says_what_it_seems_to_be() {
    let warning = |name: &str| read(name).unwrap().warnings.join("\n");
    holds(warning("outline-drawing.svg"), "fill the shape");
    for words in ["x = 50.0000", "x = 58.0000"] {
        holds(warning("axis.svg"), words);
    }
}

/// Every notation of rebeccapurple, #663399, as the examples of CSS Color 4 give it.
#[test]
fn colours_in_every_notation() {
    const ONE: &str = "rebeccapurple|RebeccaPurple|#639|#663399|#663399ff|rgb(102, 51, 153)|rgb(40% 20% 60%)|\
        rgba(102 51 153 / 100%)|hsl(270, 50%, 40%)|hsl(0.75turn 50% 40%)|hwb(270 20% 40%)|\
        lab(32.39% 38.43 -47.69)|lch(32.39% 61.25 308.87)|oklab(44.03% 0.088 -0.134)|\
        oklch(44.03% 0.1603 303.37)|color(srgb 0.4 0.2 0.6)|color(srgb-linear 0.1329 0.0331 0.3185)|\
        color(display-p3 0.3738 0.2103 0.5785)";
    for text in ONE.split('|') {
        let got = css_color(text).unwrap();
        for (got, wanted) in got.into_iter().zip([0.1329, 0.0331, 0.3185, 1.0]) {
            assert!((got - wanted).abs() < 6e-3, "{text}: {got} for {wanted}");
        }
    }
    assert_eq!(css_color("transparent"), Some([0.0; 4]));
    assert_eq!(css_color("rgb(0 0 0 / 50%)"), Some([0.0, 0.0, 0.0, 0.5]));
    let white = css_color("oklch(1 none none)").unwrap();
    assert_eq!(white.map(f32::round), [1.0; 4]);
}

#[test]
fn a_circle_is_flattened_within_the_tolerance() {
    let o = drawn("<circle cx='50' cy='50' r='40'/>").unwrap().outline;
    let points = o.segments().flat_map(|s| [s.a, s.b, 0.5 * (s.a + s.b)]);
    for radius in points.map(|p| p.distance(glam::DVec2::splat(0.5))) {
        assert!((0.4 - 1e-5..0.4 + 1e-6).contains(&radius), "{radius}");
    }
    // Chords of sagitta 1e-5 on this circle: 444.
    assert!(o.loops[0].len() < 600, "{}", o.loops[0].len());
}

#[test]
fn shapes_that_abut_leave_no_crack() {
    // The common edge at x = 30.1 comes out of two transforms that round differently.
    let abutting = "<rect x='10' y='10' width='20.1' height='30'/>\
         <g transform='translate(30.1 10) scale(0.3)'><rect y='3' width='70' height='90'/></g>";
    let loops = |body: &str| drawn(body).unwrap().outline.loops.len();
    assert_eq!(loops(abutting), 1);
    // A hole thinner than the flattening: gone. A hole just thicker than the flattening: kept.
    for (width, count) in [(0.001, 1), (0.01, 2)] {
        let slit = format!("<rect x='20' y='12' width='{width}' height='20' fill='#fff'/>");
        let body = format!("<rect x='10' y='10' width='30' height='30'/>{slit}");
        assert_eq!(loops(&body), count, "{width}");
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

/// The drawings of the folder and of the page, without large ones.
pub fn seeds() -> Vec<Vec<u8>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/drawings");
    let files = std::fs::read_dir(folder).unwrap();
    let files = files.map(|entry| std::fs::read(entry.unwrap().path()).unwrap());
    let bodies = ["Drawn", "Warned", "Refused"].into_iter().flat_map(rows);
    let of_page = bodies.map(|(body, _)| page(&body).into_bytes());
    files
        .chain(of_page)
        .filter(|bytes| bytes.len() < 6000)
        .collect()
}
