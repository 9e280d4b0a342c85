//! Rules of browsers, one line a case: drawn as a control, warned of, or refused by name.

use crate::drawings::{difference, drawn};
use std::time::{Duration, Instant};

/// The black square that most controls show.
const R: &str = r#"<rect x="20" y="20" width="20" height="20"/>"#;
/// A second black square, for drawings whose first square is hidden or white.
const K: &str = r#"<rect x="60" y="60" width="20" height="20"/>"#;

/// `R`, `K` and `W` stand for squares in the cases: `W(...)` is `R` with more attributes.
fn filled_in(case: &str) -> String {
    let mut text = case.replace("$R", R).replace("$K", K);
    while let Some((before, after)) = text.split_once("$W(") {
        let (more, rest) = after.split_once(")$").unwrap();
        text = format!(r#"{before}<rect x="20" y="20" width="20" height="20" {more}/>{rest}"#);
    }
    text
}

#[track_caller]
fn all_hold(cases: impl IntoIterator<Item = (String, Result<(), String>)>) {
    let failed = cases
        .into_iter()
        .filter_map(|(case, held)| held.err().map(|e| format!("{case}\n    {e}")));
    let failed: Vec<String> = failed.collect();
    assert!(
        failed.is_empty(),
        "{} cases:\n{}",
        failed.len(),
        failed.join("\n")
    );
}

fn is_drawn_as(case: &str, control: &str) -> Result<Vec<String>, String> {
    let got = drawn(&filled_in(case)).map_err(|e| e.to_string())?;
    let wanted = drawn(&filled_in(control)).map_err(|e| format!("control: {e}"))?;
    match difference(&got.outline, &wanted.outline) {
        off if off < 1e-4 => Ok(got.warnings),
        off => Err(format!("the pictures differ by {off}")),
    }
}

const DRAWN: &[(&str, &str)] = &[
    // Transforms that minifiers write.
    (
        "<rect width='20' height='20' transform='translate(40-10)'/>",
        "<rect x='40' y='-10' width='20' height='20'/>",
    ),
    (
        "<rect width='20' height='20' transform='rotate(90)translate(20-40)'/>",
        "$R",
    ),
    (
        "<rect x='40' y='40' width='40' height='40' transform='scale(.5.5)'/>",
        "$R",
    ),
    (
        "<rect width='40' height='40' y='-40' transform='matrix(.5-0-0 .5 20 40)'/>",
        "$R",
    ),
    (
        "<rect width='20' height='20' transform='translate(2e1,2e+1)'/>",
        "$R",
    ),
    (
        "<rect width='20' height='20' transform='translate (20 20) ,\n scale(1)'/>",
        "$R",
    ),
    // Attributes of other namespaces.
    (
        "<g xmlns:i='http://i' i:style='fill:#fff' i:class='w' i:id='q' i:fill='#fff'>$R</g><style>.w,#q {fill:#fff}</style>",
        "$R",
    ),
    (
        "<style>[label] {fill:#fff}</style><rect xmlns:i='http://i' i:label='a' x='20' y='20' width='20' height='20'/>",
        "$R",
    ),
    (
        "<style xmlns:i='http://i' i:type='text/plain'>.w {fill:#fff}</style>$W(class='w')$$K",
        "$K",
    ),
    (
        "<defs><g id='a'>$R</g><g id='b'>$K</g></defs><use href='#a' xlink:href='#b'/>",
        "$R",
    ),
    (
        "<defs><g id='a'>$R</g></defs><use xmlns:i='http://i' i:href='#b' xlink:href='#a'/>",
        "$R",
    ),
    (
        "<linearGradient id='a'><stop stop-color='#fff'/></linearGradient><linearGradient id='b'><stop/></linearGradient><linearGradient id='g' href='#b' xlink:href='#a'/>$W(fill='url(#g)')$",
        "$R",
    ),
    (
        "<x:style xmlns:x='http://a.b'>rect {fill:#fff}</x:style>$R",
        "$R",
    ),
    // Nesting of rules.
    (
        "<style>.a {&amp; rect {fill:#fff}}</style><g class='a'>$R</g>$K",
        "$K",
    ),
    (
        "<style>.a {rect {fill:#fff}}</style><g class='a'>$R</g>$K",
        "$K",
    ),
    (
        "<style>.a {> rect {fill:#fff}}</style><g class='a'>$R<g>$K</g></g>",
        "$K",
    ),
    (
        "<style>rect {&amp;:first-child {fill:#fff}}</style><g>$R$K</g>",
        "$K",
    ),
    (
        "<style>.a rect {color:red; @media screen {fill:#fff}}</style><g class='a'>$R</g>$K",
        "$K",
    ),
    (
        "<style>.a rect {@media print {fill:#fff}}</style><g class='a'>$R</g>",
        "$R",
    ),
    // The boxes of transforms and clips.
    (
        "<rect x='20' y='20' width='10' height='10' style='transform-box:fill-box;transform:scale(2)'/>",
        "$R",
    ),
    (
        "<g style='transform-box:fill-box;transform:scale(2)'><rect x='20' y='20' width='10' height='10' fill='none'/><rect x='25' y='25' width='5' height='5'/></g>",
        "<rect x='30' y='30' width='10' height='10'/>",
    ),
    (
        "<g style='transform-box:fill-box;transform:scale(2)'><rect x='20' y='20' width='10' height='10' visibility='hidden'/><rect x='25' y='25' width='5' height='5'/></g>",
        "<rect x='30' y='30' width='10' height='10'/>",
    ),
    (
        "<clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='.5' height='1'/></clipPath><g clip-path='url(#c)'><rect x='20' y='20' width='40' height='9' fill='none'/><rect x='20' y='20' width='30' height='20'/></g>",
        "$R",
    ),
    (
        "<clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='.5' height='1'/></clipPath><g clip-path='url(#c)'><rect x='20' y='20' width='40' height='9' opacity='0'/><rect x='20' y='20' width='30' height='20'/></g>",
        "$R",
    ),
    (
        "<marker id='m' markerWidth='90' markerHeight='90' overflow='visible'><rect width='40' height='5'/></marker><clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='1' height='1'/></clipPath><path d='M20 20h20v20h-20z' marker-start='url(#m)' clip-path='url(#c)'/>",
        "$R",
    ),
    // Names of vendors.
    (
        "<rect width='20' height='20' style='-webkit-transform:translate(20px,20px)'/>",
        "$R",
    ),
    (
        "<clipPath id='c'>$R</clipPath><rect width='90' height='90' style='-webkit-clip-path:url(#c)'/>",
        "$R",
    ),
    ("$W(style='-webkit-opacity:.2')$$K", "$K"),
    // Colours that are not valid.
    ("$W(style='fill:#000;fill:rgb(255, 255 255)')$", "$R"),
    ("$W(style='fill:#000;fill:rgb(255 255 255 1)')$", "$R"),
    ("$W(style='fill:#000;fill:lab(100, 0, 0)')$", "$R"),
    ("$W(style='fill:#000;fill:oklch(1, 0, 0)')$", "$R"),
    ("$W(style='fill:#000;fill:hwb(0, 100%, 0%)')$", "$R"),
    ("$W(style='fill:#000;fill:color(srgb, 1, 1, 1)')$", "$R"),
    ("$W(style='fill:#000;fill:rgb(100%, 255, 255)')$", "$R"),
    ("$W(style='fill:#000;fill:rgb(255,,255,255)')$", "$R"),
    ("$W(style='fill:#000;fill:rgb(255 255 255 / )')$", "$R"),
    ("$W(style='fill:#000;fill:rgb(none, 255, 255)')$", "$R"),
    ("$W(style='fill:#000;fill:hsl(0, 0, 100)')$", "$R"),
    ("$W(style='fill:#000;fill:rgb (255,255,255)')$", "$R"),
    ("$W(style='fill:#fff;fill:url(#a) url(#b)')$$K", "$K"),
    // Custom properties.
    (
        "<g style='--a:white;--b:var(--a)'><rect x='20' y='20' width='20' height='20' style='--a:black;fill:var(--b)'/></g>$K",
        "$K",
    ),
    ("$W(fill='white' style='--a:foo;fill:var(--a)')$", "$R"),
    (
        "<g fill='#fff'><rect x='20' y='20' width='20' height='20' style='--a:12px;fill:black;fill:var(--a)'/></g>$K",
        "$K",
    ),
    (
        "$W(style='--a:var(--b);--b:var(--a);fill:var(--a,white)')$$K",
        "$K",
    ),
    ("$W(style='fill:white;fill:var(--zz, foo)')$", "$R"),
    (
        "<g style='--c:black'>$W(style='--c:initial;fill:var(--c,white)')$</g>$K",
        "$K",
    ),
    // `all`.
    (
        "<style>.b {all:unset}</style>$W(class='b' fill='#fff')$$K",
        "$K",
    ),
    // Strokes.
    (
        "<circle cx='50' cy='50' r='5' stroke='#000' stroke-width='40'/>",
        "<circle cx='50' cy='50' r='25'/>",
    ),
    (
        "<ellipse cx='50' cy='50' rx='9' ry='4' fill='none' stroke='#000' stroke-width='40'/>",
        "<path d='M41 50h18' stroke='#000' stroke-width='0'/><ellipse cx='50' cy='50' rx='9' ry='4' stroke='#000' stroke-width='40'/>",
    ),
    (
        "<rect x='20' y='20' width='40' height='20' rx='5' fill='none' stroke='#000' stroke-width='2' stroke-dasharray='30 1000'/>",
        "<path d='M25 19h30v2h-30z'/>",
    ),
    (
        "<path d='M20 60V20H60' fill='none' stroke='#000' stroke-width='10' stroke-miterlimit='0.5'/>",
        "<path d='M20 60V20H60' fill='none' stroke='#000' stroke-width='10' stroke-linejoin='bevel'/>",
    ),
    // What is hidden is not refused.
    (
        "$W(display='none' style='mix-blend-mode:multiply')$$K",
        "$K",
    ),
    (
        "$W(opacity='0' style='mix-blend-mode:multiply;filter:blur(2px);clip-path:inset(1px);mask-image:none')$$K",
        "$K",
    ),
    (
        "$W(style='display:none;transform:rotateX(5deg);width:calc(1px);clip-path:inset(1px);filter:blur(1px)')$$K",
        "$K",
    ),
    (
        "$W(visibility='hidden' style='mix-blend-mode:multiply;filter:blur(2px);clip-path:inset(1px);mask-image:linear-gradient(red,red);transform:rotateX(1deg)')$$K",
        "$K",
    ),
    (
        "<g style='mix-blend-mode:multiply;filter:blur(2px);clip-path:inset(1px)'/><g style='mix-blend-mode:multiply'><g/></g>$K",
        "$K",
    ),
    (
        "<style>@media (min-width:9px) {.h {fill:#fff}} @supports (x:y) {.h {fill:#fff}}</style><rect class='h' display='none' width='5' height='5'/>$K",
        "$K",
    ),
    (
        "<text x='20' y='20'><title>a</title><desc>b</desc></text>$R",
        "$R",
    ),
    (
        "<clipPath id='c'/><image href='a.png' width='9' height='9' clip-path='url(#c)'/>$R",
        "$R",
    ),
    (
        "<g clip-path='url(#c)'><clipPath id='c'/><text>A</text></g>$R",
        "$R",
    ),
    (
        "<g transform='scale(0)'><image href='a.png' width='9' height='9'/></g>$R",
        "$R",
    ),
    (
        "<pattern id='p'/><g fill='url(#p)'><line x1='20' y1='30' x2='40' y2='30' stroke='#000' stroke-width='20'/></g>",
        "$R",
    ),
    (
        "<g fill='whte'><line x1='20' y1='30' x2='40' y2='30' stroke='#000' stroke-width='20'/></g>",
        "$R",
    ),
    // Addresses.
    (
        "<linearGradient id='a b'><stop/></linearGradient>$W(fill='url(#a%20b)')$",
        "$R",
    ),
    ("<defs><g id='ä'>$R</g></defs><use href='#%C3%A4'/>", "$R"),
    (
        "<linearGradient id='a.b'><stop stop-color='#fff'/></linearGradient>$W(fill='url(#a\\.b)')$$K",
        "$K",
    ),
    // Attributes that are read as values of CSS.
    ("$W(fill='/**/white')$$K", "$K"),
    ("$W(fill='white/* a */')$$K", "$K"),
    // Letters of keywords.
    (
        "$W(style='transform-origin:CENTER;transform:scale(1)')$",
        "$R",
    ),
    ("$W(style='mix-blend-mode:NORMAL;zoom:100%')$", "$R"),
    (
        "$W(style='zoom:normal;clip-path:NONE;filter:None;transform:NONE')$",
        "$R",
    ),
    (
        "<path style='d:path(evenodd, \"M20 20h20v20h-20z\")' fill='#000'/>$K",
        "$K",
    ),
    // What is not valid in CSS.
    ("$W(style='display:none;display:foo')$$K", "$K"),
    (
        "<style>.z {font-family:\"/*\"} .w {fill:#fff} /* */</style>$W(class='w')$$K",
        "$K",
    ),
    (
        "<style>.w {<!-- a -->fill:#fff}</style>$W(class='w')$$K",
        "$K",
    ),
    (
        "<style>@media screen {@media screen {@media screen {@media screen {@media screen {@media screen {@media screen {@media screen {@media screen {@media screen {.w {fill:#fff}}}}}}}}}}}</style>$W(class='w')$$K",
        "$K",
    ),
    ("<style>|rect {fill:#fff}</style>$R", "$R"),
    (
        "<line x1='20' y1='30' x2='40' y2='30' stroke='#000' stroke-width='20' style='x1:80px'/>",
        "$R",
    ),
    (
        "<svg viewBox='0 0 0 10' width='50' height='50'>$R</svg>$K",
        "$K",
    ),
    (
        "<style title='a'>.w {fill:#000}</style><style title='b'>.w {fill:#fff}</style>$W(class='w')$",
        "$R",
    ),
    ("<g fill='white'>$W(style='f\\69 ll:black')$</g>", "$R"),
    ("<linearGradient id='g'/>$W(fill='url(#g)')$$K", "$K"),
    ("$W(style='display:contents')$$K", "$K"),
];

#[test]
fn drawn_as_browsers_draw() {
    all_hold(DRAWN.iter().map(|(case, control)| {
        let held = is_drawn_as(case, control);
        ((*case).to_owned(), held.map(drop))
    }));
}

/// Cases that are drawn as a control, with the words of their one warning.
const WARNED: &[(&str, &str, &str)] = &[
    ("$W(transform='translate(5px)')$", "$R", "transform="),
    ("$W(transform='translateX(5)')$", "$R", "transform="),
    ("$W(transform='translate(5,,5)')$", "$R", "transform="),
    ("$W(transform='translate(,5)')$", "$R", "transform="),
    ("$W(transform='translate(5,)')$", "$R", "transform="),
    ("$W(transform='scale(50%)')$", "$R", "transform="),
    ("$W(transform='rotate(5 5)')$", "$R", "transform="),
    (
        "$W(style='transform:translate(5px 5px)')$",
        "$R",
        "transform: ",
    ),
    ("$W(style='transform:translate(5)')$", "$R", "transform: "),
    (
        "$W(style='transform:translate (5px)')$",
        "$R",
        "transform: ",
    ),
    (
        "$W(style='transform:rotate(5deg),scale(2)')$",
        "$R",
        "transform: ",
    ),
    ("$W(onload='run()')$", "$R", "script"),
    ("<defs><script>run()</script></defs>$R", "$R", "script"),
    ("<script href='a.js'/>$R", "$R", "script"),
    (
        "<script xmlns='http://www.w3.org/1999/xhtml'>run()</script>$R",
        "$R",
        "script",
    ),
    (
        "<animate href='#a' attributeName='x' to='5' dur='1s'/><rect id='a' x='20' y='20' width='20' height='20'/>",
        "$R",
        "animat",
    ),
    (
        "<clipPath id='c'><rect x='20' y='20' width='20' height='20'><animate attributeName='x' to='5'/></rect></clipPath><rect width='99' height='99' clip-path='url(#c)'/>",
        "$R",
        "animat",
    ),
    (
        "<defs>$R<animate href='#a'/></defs><rect id='a' x='20' y='20' width='20' height='20'/>",
        "$R",
        "animat",
    ),
    (
        "<link xmlns='http://www.w3.org/1999/xhtml' rel='stylesheet' href='a.css'/>$R",
        "$R",
        "style sheet",
    ),
    ("$W(style='-webkit-animation:a 1s')$", "$R", "animation"),
    (
        "<path d='M20 30H40' stroke='#000' stroke-width='20' stroke-dasharray='10,,5'/>",
        "$R",
        "stroke-dasharray",
    ),
    (
        "<svg viewBox='0 0 9 9 9' width='90' height='90'>$R</svg>",
        "$R",
        "viewBox",
    ),
];

#[test]
fn warned_of_by_name() {
    all_hold(WARNED.iter().map(|(case, control, words)| {
        let held = is_drawn_as(case, control).and_then(|warnings| match warnings.as_slice() {
            [one] if one.contains(words) => Ok(()),
            other => Err(format!("warnings: {other:?}")),
        });
        ((*case).to_owned(), held)
    }));
}

/// Cases that are refused, with words of the refusal.
const REFUSED: &[(&str, &str)] = &[
    ("$W(style='width:min(20px,5px)')$", "min(20px,5px)"),
    (
        "<path d='M20 20h9' stroke='#000' stroke-width='1e9'/>",
        "stroke",
    ),
    (
        "<g style='--c:white'>$W(style='--c:revert;fill:var(--c,black)')$</g>",
        "revert",
    ),
    (
        "<style>@property --x {syntax:\"*\";inherits:true;initial-value:white} rect {fill:var(--x,black)}</style>$R",
        "@property",
    ),
    ("<style>rect, rect::foo {fill:#fff}</style>$R", "rect::foo"),
    ("$W(style='all:revert-layer')$", "revert-layer"),
    ("$W(style='-webkit-filter:opacity(0)')$", "filter"),
    (
        "$W(style='-webkit-mask-image:linear-gradient(red,red)')$",
        "mask",
    ),
    (
        "$W(style='-webkit-mask-box-image:linear-gradient(red,red)')$",
        "mask",
    ),
    ("$W(style='fill:revert-layer')$", "revert-layer"),
    (
        "<path style='d:path(evenodd, \"M20 20h20v20h-20z\")'/>",
        "no shape",
    ),
    (
        "<path d='M0 50H100' stroke='#000' stroke-dasharray='.001 .001'/>",
        "dashes",
    ),
];

#[test]
fn refused_by_name() {
    all_hold(REFUSED.iter().map(|(case, words)| {
        let held = match drawn(&filled_in(case)) {
            Ok(p) => Err(format!("drawn, {:?}", p.warnings)),
            Err(e) if e.to_string().contains(words) => Ok(()),
            Err(e) => Err(e.to_string()),
        };
        ((*case).to_owned(), held)
    }));
}

fn many(count: usize, one: impl Fn(usize) -> String) -> String {
    (0..count).map(one).collect()
}

/// Drawings that took minutes, all memory or the stack.
#[test]
fn no_drawing_takes_long() {
    let spread = |i: usize| (i * 7919 % 9001) as f64 / 100.0;
    let nested = ":is(".repeat(5) + "x" + &" g)".repeat(5) + " rect";
    let clips = many(6, |i| {
        let inner = match i {
            0 => String::new(),
            _ => format!("clip-path='url(#c{})'", i - 1),
        };
        let rects = many(10, |k| {
            format!("<rect x='{k}' width='99' height='99' {inner}/>")
        });
        format!("<clipPath id='c{i}'>{rects}</clipPath>")
    });
    let cases = [
        (
            "fallbacks of fallbacks",
            format!(
                "<rect width='50' height='50' fill='{}'/>{R}",
                "url(#a) ".repeat(100_000)
            ),
            Some("no colour"),
        ),
        (
            "variables",
            {
                let chain = many(14, |i| {
                    format!("--v{i}:{};", format!("var(--v{})", i + 1).repeat(8))
                });
                format!("<rect width='50' height='50' style='{chain}--v14: ;fill:var(--v0) red'/>")
            },
            None,
        ),
        (
            "selectors",
            format!(
                "<style>{nested} {{fill:#fff}}</style>{}{R}{}",
                "<g>".repeat(190),
                "</g>".repeat(190)
            ),
            Some("selectors"),
        ),
        (
            "clips of clips",
            format!("{clips}<rect width='50' height='50' clip-path='url(#c5)'/>"),
            Some("elements"),
        ),
        (
            "a shared clip",
            format!(
                "<clipPath id='c'>{}</clipPath>{}",
                many(500, |i| format!(
                    "<circle cx='{}' cy='{}' r='2'/>",
                    spread(i),
                    spread(i * 31)
                )),
                many(500, |i| format!(
                    "<rect x='{}' y='{}' width='1' height='1' clip-path='url(#c)'/>",
                    spread(i),
                    spread(i * 17)
                ))
            ),
            None,
        ),
        (
            "round dots",
            "<path d='M0 50H100' stroke='#000' stroke-linecap='round' stroke-dasharray='0 .01'/>"
                .to_owned(),
            Some("dashes"),
        ),
        (
            "many lines",
            format!(
                "<rect width='9' height='9'/>\n{}",
                many(20_000, |i| format!(
                    "<rect x='{}' y='{}' width='.5' height='.5' stroke-width='1.2.3'/>\n",
                    i % 100,
                    i / 100 % 100
                ))
            ),
            None,
        ),
        (
            "many rules",
            format!(
                "<style>{}</style>{R}",
                many(20_000, |i| format!(".c{i} {{fill:#{}00}}\n", i % 10))
            ),
            None,
        ),
        (
            "many siblings",
            format!(
                "<style>circle ~ rect {{fill:#111}}</style>{}",
                many(10_000, |i| format!(
                    "<rect x='{}' y='{}' width='.5' height='.5'/>",
                    i % 100,
                    i / 100
                ))
            ),
            Some("selectors"),
        ),
        (
            "large translucent circles",
            many(1000, |i| {
                format!(
                    "<circle cx='{}' cy='{}' r='20' opacity='.1'/>",
                    spread(i),
                    spread(i * 31)
                )
            }),
            Some("translucent"),
        ),
        (
            "a tangle",
            format!(
                "<path fill-rule='evenodd' d='M50 50{}z'/>",
                many(3000, |i| format!(
                    "L{} {}",
                    spread(i * i + 7),
                    spread(i * 31)
                ))
            ),
            Some("cross"),
        ),
    ];
    all_hold(cases.into_iter().map(|(name, body, words)| {
        let start = Instant::now();
        let got = drawn(&body);
        let took = start.elapsed();
        let held = match (&got, words) {
            _ if took > Duration::from_secs(8) => Err(format!("{took:?}")),
            (Ok(_), None) => Ok(()),
            (Err(e), Some(words)) if e.to_string().contains(words) => Ok(()),
            (Err(e), _) => Err(e.to_string()),
            (Ok(_), _) => Err("drawn".to_owned()),
        };
        (name.to_owned(), held)
    }));
}
