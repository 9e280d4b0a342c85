//! Rules of browsers, as `browser_rules.txt` lists them, and drawings that must not take long.

use crate::drawings::{difference, drawn};
use std::time::{Duration, Instant};

const RULES: &str = include_str!("browser_rules.txt");
const R: &str = r#"<rect x="20" y="20" width="20" height="20"/>"#;
const K: &str = r#"<rect x="60" y="60" width="20" height="20"/>"#;

/// A case with the shapes that `$` stands for.
fn filled_in(case: &str) -> String {
    let mut text = case.replace("$R", R).replace("$K", K).replace("$N", "\n");
    while let Some((before, after)) = text.split_once("$W(") {
        let (more, rest) = after.split_once(")$").unwrap();
        text = format!(r#"{before}<rect x="20" y="20" width="20" height="20" {more}/>{rest}"#);
    }
    text
}

/// Elements that selectors are tried with, and whether each is a square.
const SELECTED: &str = "<g id='a' class='x y'>$0<rect/>$1<circle/>$2<circle name='Red-1'/></g>\
    <g id='b'><a href='#'>$3<path/></a>$4<circle id='c1'/></g>$5<rect/>";

/// The drawing of selectors, with a rule for `selector` and without the elements at these places.
fn selected(selector: &str, without: &str) -> String {
    let mut text = SELECTED.to_owned();
    for k in 0..6 {
        let at = 10 + 12 * k;
        let (before, after) = text.split_once(&format!("${k}<")).unwrap();
        let (tag, rest) = after.split_once('/').unwrap();
        let shape = match tag.split(' ').next() {
            Some("rect") => format!("x='{at}' y='{at}' width='9' height='9'"),
            Some("circle") => format!("cx='{at}' cy='{at}' r='5'"),
            _ => format!("d='M{at} {at}h9v9z'"),
        };
        let gone = without.split(' ').any(|place| place == k.to_string());
        let shape = if gone { "" } else { &shape };
        text = format!("{before}<{tag} {shape} /{rest}");
    }
    format!(
        "<style>{selector} {{fill:#fff}}</style>{text}<path d='M90 90h5v5h-5z' style='fill:#000'/>"
    )
}

fn holds(rule: &str) -> Result<(), String> {
    if let Some((selector, places)) = rule.split_once(" ?") {
        let [case, control] = [selected(selector, ""), selected("none", places)];
        return holds(&format!("{case} => {control}"));
    }
    let (drawing, words) = match rule.split_once(" ! ") {
        Some((drawing, words)) if !drawing.contains('<') && !drawing.contains('$') => {
            (selected(drawing, ""), Some(words))
        }
        Some((drawing, words)) => (filled_in(drawing), Some(words)),
        None => (filled_in(rule), None),
    };
    if let Some((drawing, area)) = drawing.rsplit_once(" = ") {
        let got = drawn(drawing).map_err(|e| e.to_string())?.outline.area() * 1e4;
        let wanted: f64 = area.parse().map_err(|_| "no area")?;
        let is_near = (got - wanted).abs() < 2e-3 * wanted;
        return is_near.then_some(()).ok_or(format!("its area is {got}"));
    }
    let Some((case, control)) = drawing.split_once(" => ") else {
        return match drawn(&drawing) {
            Ok(p) => Err(format!("drawn, {:?}", p.warnings)),
            Err(e) if e.to_string().contains(words.unwrap()) => Ok(()),
            Err(e) => Err(e.to_string()),
        };
    };
    let got = drawn(case).map_err(|e| e.to_string())?;
    let wanted = drawn(control).map_err(|e| format!("control: {e}"))?;
    let off = difference(&got.outline, &wanted.outline);
    match (got.warnings.as_slice(), words) {
        _ if off >= 1e-4 => Err(format!("the pictures differ by {off}")),
        (_, None) => Ok(()),
        ([one], Some(words)) if one.contains(words) => Ok(()),
        (other, Some(_)) => Err(format!("warnings: {other:?}")),
    }
}

#[test]
fn rules_of_browsers_hold() {
    let rules = RULES
        .lines()
        .filter(|l| !l.is_empty() && !l.starts_with("# "));
    assert_eq!(rules.clone().count(), 264);
    let failed = rules.filter_map(|rule| Some(format!("{rule}\n    {}", holds(rule).err()?)));
    let failed: Vec<String> = failed.collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

fn many(count: usize, one: impl Fn(usize) -> String) -> String {
    (0..count).map(one).collect()
}

/// Wants a drawing within seconds, or its refusal with `words`.
#[track_caller]
fn is_quick(body: String, words: Option<&str>) {
    let start = Instant::now();
    let got = drawn(&body).map_err(|e| e.to_string());
    let took = start.elapsed();
    assert!(took < Duration::from_secs(8), "{took:?}");
    match (got, words) {
        (Ok(_), None) => {}
        (Err(e), Some(words)) if e.contains(words) => {}
        (got, _) => panic!("{words:?}: {:?}", got.map(|p| p.warnings)),
    }
}

/// Drawings that took minutes, all memory or the stack.
#[test]
fn no_drawing_takes_long() {
    let spread = |i: usize| (i * 7919 % 9001) as f64 / 100.0;
    let place = |i: usize, step: usize| (spread(i), spread(i * step));
    // Fallbacks of fallbacks.
    let fill = "url(#a) ".repeat(100_000);
    let body = format!("<rect width='50' height='50' fill='{fill}'/>{R}");
    is_quick(body, Some("no colour"));
    let variables = many(14, |i| {
        format!("--v{i}:{};", format!("var(--v{})", i + 1).repeat(8))
    });
    let style = variables + "--v14: ;fill:var(--v0) red";
    is_quick(
        format!("<rect width='50' height='50' style='{style}'/>"),
        None,
    );
    let nested = ":is(".repeat(5) + "x" + &" g)".repeat(5) + " rect";
    let style = ["rect {", "}"]
        .map(|part| part.repeat(40))
        .join("fill:#fff");
    is_quick(format!("<style>{style}</style>{R}"), Some("not read"));
    let deep = ":is(".repeat(1000) + "a" + &")".repeat(1000);
    let body = format!("<style>{deep} {{fill:#fff}}</style>{R}");
    is_quick(body, Some("not read"));
    let groups = ["<g>", "</g>"].map(|tag| tag.repeat(190)).join(R);
    let body = format!("<style>{nested} {{fill:#fff}}</style>{groups}");
    is_quick(body, Some("selectors"));
    let clips = many(6, |i| {
        let inner = match i {
            0 => String::new(),
            _ => format!("clip-path='url(#c{})'", i - 1),
        };
        let rect = |k| format!("<rect x='{k}' width='99' height='99' {inner}/>");
        format!("<clipPath id='c{i}'>{}</clipPath>", many(10, rect))
    });
    let body = format!("{clips}<rect width='50' height='50' clip-path='url(#c5)'/>");
    is_quick(body, Some("elements"));
    // A shared clip.
    let circles = many(500, |i| {
        let (x, y) = place(i, 31);
        format!("<circle cx='{x}' cy='{y}' r='2'/>")
    });
    let clipped = many(500, |i| {
        let (x, y) = place(i, 17);
        format!("<rect x='{x}' y='{y}' width='1' height='1' clip-path='url(#c)'/>")
    });
    is_quick(
        format!("<clipPath id='c'>{circles}</clipPath>{clipped}"),
        None,
    );
    let dots =
        "<path d='M0 50H100' stroke='#000' stroke-linecap='round' stroke-dasharray='0 .01'/>";
    is_quick(dots.to_owned(), Some("dashes"));
    let small = |i: usize, more: &str| {
        let (x, y) = (i % 100, i / 100 % 100);
        format!("<rect x='{x}' y='{y}' width='.5' height='.5'{more}/>")
    };
    let lines = many(20_000, |i| small(i, " stroke-width='1.2.3'") + "\n");
    is_quick(format!("<rect width='9' height='9'/>\n{lines}"), None);
    let rules = many(20_000, |i| format!(".c{i} {{fill:#{}00}}\n", i % 10));
    is_quick(format!("<style>{rules}</style>{R}"), None);
    let siblings = many(10_000, |i| small(i, ""));
    let body = format!("<style>circle ~ rect {{fill:#111}}</style>{siblings}");
    is_quick(body, Some("selectors"));
    let translucent = many(1000, |i| {
        let (x, y) = place(i, 31);
        format!("<circle cx='{x}' cy='{y}' r='20' opacity='.1'/>")
    });
    is_quick(translucent, Some("translucent"));
    let tangle = many(3000, |i| {
        format!("L{} {}", spread(i * i + 7), spread(i * 31))
    });
    let body = format!("<path fill-rule='evenodd' d='M50 50{tangle}z'/>");
    is_quick(body, Some("cross"));
}
