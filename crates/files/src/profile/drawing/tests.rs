#![allow(clippy::unwrap_used, clippy::panic)]
use super::*;
use std::f64::consts::PI;

/// A drawing of 100 x 100 with the axis at its left, so that one user unit is 0.01 object units.
fn drawn(body: &str) -> Result<Outline> {
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="100" height="100">{body}</svg>"##
    );
    profile(text.as_bytes(), ProfileAxis::Left).map(|p| p.outline)
}

/// Area of the drawn solid in square user units.
fn area(body: &str) -> f64 {
    drawn(body).unwrap().area() * 1e4
}

fn message(body: &str) -> String {
    drawn(body).unwrap_err().to_string()
}

#[track_caller]
fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 2e-3 * b.max(1.0), "{a} for {b}");
}

#[test]
fn a_circle_is_flattened_within_the_tolerance() {
    let o = drawn(r#"<circle cx="50" cy="50" r="40"/>"#).unwrap();
    let middle = DVec2::new(0.5, 0.5);
    let (mut low, mut high) = (f64::INFINITY, 0.0f64);
    for s in o.segments() {
        for p in [s.a, s.b, 0.5 * (s.a + s.b)] {
            low = low.min(p.distance(middle));
            high = high.max(p.distance(middle));
        }
    }
    // A circle of four cubics, which is what drawings have, is itself off by 2.7e-4 of its radius
    // at most.
    assert!(
        low > 0.4 - FLATNESS && high < 0.4 * (1.0 + 2.8e-4),
        "{low} {high}"
    );
    // Chords of sagitta 1e-5 on this circle: 444.
    assert!(o.loops[0].len() < 600, "{}", o.loops[0].len());
}

#[test]
fn later_paint_covers_earlier_paint() {
    let square = "<rect x='10' y='10' width='40' height='40'/>";
    let hole = "<rect x='20' y='20' width='10' height='20' fill='#fff'/>";
    let dot = "<rect x='24' y='24' width='2' height='2' fill='navy'/>";
    let twice = format!("<g id='a'>{square}</g><use xlink:href='#a' x='45'/>");
    for (body, wanted) in [
        (square.to_owned(), 1600.0),
        (format!("{square}{hole}"), 1400.0),
        (format!("{hole}{square}"), 1600.0),
        (format!("{square}{hole}{dot}"), 1404.0),
        (twice, 3200.0),
    ] {
        near(area(&body), wanted);
    }
}

#[test]
fn fill_rules_and_transforms() {
    for (body, wanted) in [
        ("<path d='M10,10h40v40h-40z M20,20h10v10h-10z'/>", 1600.0),
        (
            "<path fill-rule='evenodd' d='M10,10h40v40h-40z M20,20h10v10h-10z'/>",
            1500.0,
        ),
        (
            "<g transform='translate(10 10) scale(2 0.5)'><rect width='10' height='40' transform='skewX(30)'/></g>",
            400.0,
        ),
        // Out of the viewport on all sides: cut to it.
        ("<rect x='50' y='-500' width='5000' height='550'/>", 2500.0),
    ] {
        near(area(body), wanted);
    }
}

#[test]
fn strokes_with_caps_joins_and_dashes() {
    let line = |more: &str| {
        area(&format!(
            "<path d='M20,50H60' stroke='#000' stroke-width='10' {more}/>"
        ))
    };
    near(line(""), 400.0);
    near(line("stroke-linecap='square'"), 500.0);
    near(line("stroke-linecap='round'"), 400.0 + PI * 25.0);
    near(line("stroke-dasharray='10 5'"), 300.0);
    near(line("transform='scale(1 0.5)'"), 200.0);
    let angle = |join: &str| {
        area(&format!(
            "<path fill='none' stroke='#000' stroke-width='10' stroke-linejoin='{join}' d='M20,60V20H60'/>"
        ))
    };
    // Two bars of 40 x 10 share a quarter of the corner; what the join adds is the quarter across
    // from it.
    near(angle("miter"), 800.0);
    near(angle("bevel"), 775.0 + 12.5);
    near(angle("round"), 775.0 + PI * 25.0 / 4.0);
    // Fill below stroke: a light border takes its half from the dark inside.
    let bordered = |order: &str| {
        area(&format!(
            "<rect x='20' y='20' width='40' height='40' stroke='#fff' stroke-width='10' {order}/>"
        ))
    };
    near(bordered(""), 900.0);
    near(bordered("paint-order='stroke'"), 1600.0);
}

#[test]
fn opacity_and_groups() {
    let square =
        |x: u32, more: &str| format!("<rect x='{x}' y='10' width='40' height='40' {more}/>");
    let two = |a: &str, x, b: &str| square(10, a) + &square(x, b);
    let translucent = "fill-opacity='0.4'";
    for (body, wanted) in [
        (square(10, "fill-opacity='0.6'"), 1600.0),
        // Two layers that are each light are dark together.
        (two(translucent, 20, translucent), 30.0 * 40.0),
        // Half-transparent white over black: grey, still dark below 0.5.
        (two("", 30, "fill='#fff' fill-opacity='0.4'"), 1600.0),
        (two("", 30, "fill='#fff' fill-opacity='0.6'"), 800.0),
    ] {
        near(area(&body), wanted);
    }
    assert!(drawn(&square(10, "opacity='0.4'")).is_err());
    // In a group of that opacity two layers stay light.
    let group = format!("<g opacity='0.4'>{}</g>", two("", 20, ""));
    assert!(drawn(&group).is_err());
}

#[test]
fn shapes_that_abut_leave_no_crack() {
    // The common edge at x = 30.1 comes out of two transforms that round differently.
    let o = drawn(
        "<rect x='10' y='10' width='20.1' height='30'/>\
         <g transform='translate(30.1 10) scale(0.3)'><rect y='3' width='70' height='90'/></g>",
    )
    .unwrap();
    assert_eq!(o.loops.len(), 1);
    // A hole thinner than the flattening: gone. A hole just thicker than the flattening: kept.
    let slit = |width: f64| {
        let slit = format!("<rect x='20' y='12' width='{width}' height='20' fill='#fff'/>");
        drawn(&format!(
            "<rect x='10' y='10' width='30' height='30'/>{slit}"
        ))
        .unwrap()
        .loops
        .len()
    };
    assert_eq!((slit(0.001), slit(0.01)), (1, 2));
}

#[test]
fn clip_paths() {
    let clip = "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath>";
    let body = format!("{clip}<g clip-path='url(#c)'><rect width='50' height='100'/></g>");
    near(area(&body), PI * 200.0);
}

#[test]
fn the_right_half_of_a_silhouette() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 0 20 40"><circle cx="0" cy="20" r="8"/></svg>"#;
    let p = profile(text.as_bytes(), ProfileAxis::Center).unwrap();
    assert_eq!(p.radius, 0.25);
    let b = p.outline.bounds().unwrap();
    assert!((b.r_max - 0.2).abs() < 1e-5 && b.r_min == 0.0);
    assert!((b.z_min - 0.3).abs() < 1e-5 && (b.z_max - 0.7).abs() < 1e-5);
    let o = p.outline;
    assert_eq!(o.segments().count() - o.surface_segments().count(), 1);
}

#[test]
fn gradients_by_their_mean_or_refused() {
    let gradient = |a: &str, b: &str| {
        format!(
            "<linearGradient id='g'><stop stop-color='{a}'/><stop offset='1' stop-color='{b}'/></linearGradient>\
             <rect x='10' y='10' width='40' height='40' fill='url(#g)'/>"
        )
    };
    near(area(&gradient("black", "navy")), 1600.0);
    assert!(message(&gradient("black", "white")).contains("gradient from dark to light"));
}

#[test]
fn faults_are_named() {
    assert!(message("").contains("no shape"));
    assert!(message("<rect width='50' height='50' fill='#fff'/>").contains("empty"));
    assert!(message("<rect width='100' height='100'/>").contains("full"));
    assert!(message("<text x='10' y='10'>A</text>").contains("convert it to paths"));
    assert!(message("<image href='a.png' width='9' height='9'/>").contains("trace"));
    assert!(message("<rect width='9'").contains("damaged"));
    let hidden = "<g style='display: none'><text>A</text></g><rect width='9' height='9'/>";
    near(area(hidden), 81.0);
    let mask = "<mask id='m'><rect width='50' height='50' fill='#fff'/></mask><rect mask='url(#m)' width='9' height='9'/>";
    assert!(message(mask).contains("mask"));
    for text in [message(""), message("<rect width='9'")] {
        assert!(!text.contains('\n'));
    }
}
