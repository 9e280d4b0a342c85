#![allow(clippy::unwrap_used)]
use super::*;
use std::f64::consts::PI;

/// A drawing of 100 x 100 with the axis at its left, so that one user unit is 0.01 object units.
fn drawn(body: &str) -> Result<Outline> {
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">{body}</svg>"##
    );
    profile(text.as_bytes(), ProfileAxis::Left, 0.0).map(|p| p.outline)
}

/// Asserts the area of the drawn solid, square user units.
#[track_caller]
fn covers(body: &str, wanted: f64) {
    let area = drawn(body).unwrap().area() * 1e4;
    assert!(
        (area - wanted).abs() < 2e-3 * wanted,
        "{body}: {area} for {wanted}"
    );
}

#[test]
fn a_circle_is_flattened_within_the_tolerance() {
    let o = drawn(r#"<circle cx="50" cy="50" r="40"/>"#).unwrap();
    let points = o.segments().flat_map(|s| [s.a, s.b, 0.5 * (s.a + s.b)]);
    for radius in points.map(|p| p.distance(DVec2::splat(0.5))) {
        // A circle of four cubics, which is what drawings have, is itself off by 2.7e-4 of its
        // radius at most.
        assert!(
            (0.4 - FLATNESS..0.4 * (1.0 + 2.8e-4)).contains(&radius),
            "{radius}"
        );
    }
    // Chords of sagitta 1e-5 on this circle: 444.
    assert!(o.loops[0].len() < 600, "{}", o.loops[0].len());
}

#[test]
fn paint_lies_over_paint() {
    let square = "<rect x='10' y='10' width='40' height='40'/>";
    let hole = "<rect x='20' y='20' width='10' height='20' fill='#fff'/>";
    let dot = "<rect x='24' y='24' width='2' height='2' fill='navy'/>";
    covers(&format!("{square}{hole}"), 1400.0);
    covers(&format!("{hole}{square}"), 1600.0);
    covers(&format!("{square}{hole}{dot}"), 1404.0);
    let twice = "<path d='M10,10h40v40h-40z M20,20h10v10h-10z'";
    covers(&format!("{twice}/>"), 1600.0);
    covers(&format!("{twice} fill-rule='evenodd'/>"), 1500.0);
    covers(
        "<rect width='10' height='40' transform='scale(2 0.5)skewX(30)'/>",
        400.0,
    );
    // Out of the viewport on all sides: cut to it.
    covers("<rect x='50' y='-500' width='5000' height='550'/>", 2500.0);
    covers(
        "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath><g clip-path='url(#c)'><rect width='50' height='100'/></g>",
        PI * 200.0,
    );
}

#[test]
fn strokes_with_caps_joins_and_dashes() {
    for (more, area) in [
        ("", 400.0),
        ("stroke-linecap='square'", 500.0),
        ("stroke-linecap='round'", 400.0 + PI * 25.0),
        ("stroke-dasharray='10 5'", 300.0),
        ("transform='scale(1 0.5)'", 200.0),
    ] {
        covers(
            &format!("<path d='M20,50H60' stroke='#000' stroke-width='10' {more}/>"),
            area,
        );
    }
    // Two bars of 40 x 10 share a quarter of the corner; what the join adds is the quarter across
    // from it.
    for (join, area) in [
        ("miter", 800.0),
        ("bevel", 775.0 + 12.5),
        ("round", 775.0 + PI * 6.25),
    ] {
        covers(
            &format!(
                "<path fill='none' stroke='#000' stroke-width='10' stroke-linejoin='{join}' d='M20,60V20H60'/>"
            ),
            area,
        );
    }
    // Fill below stroke: a light border takes its half from the dark inside.
    for (order, area) in [("", 900.0), ("paint-order='stroke'", 1600.0)] {
        covers(
            &format!(
                "<rect x='20' y='20' width='40' height='40' stroke='#fff' stroke-width='10' {order}/>"
            ),
            area,
        );
    }
}

#[test]
fn opacity_and_groups() {
    let two = |a: &str, x: u32, b: &str| {
        format!(
            "<rect x='10' y='10' width='40' height='40' {a}/><rect x='{x}' y='10' width='40' height='40' {b}/>"
        )
    };
    let clear = "fill-opacity='0.4'";
    // Two layers that are each light are dark together.
    covers(&two(clear, 20, clear), 30.0 * 40.0);
    // Half-transparent white over black: grey, still dark below 0.5.
    covers(&two("", 30, "fill='#fff' fill-opacity='0.4'"), 1600.0);
    covers(&two("", 30, "fill='#fff' fill-opacity='0.6'"), 800.0);
    // In a group of that opacity two layers stay light.
    assert!(drawn(&format!("<g opacity='0.4'>{}</g>", two("", 20, ""))).is_err());
}

#[test]
fn shapes_that_abut_leave_no_crack() {
    // The common edge at x = 30.1 comes out of two transforms that round differently.
    let abutting = "<rect x='10' y='10' width='20.1' height='30'/>\
         <g transform='translate(30.1 10) scale(0.3)'><rect y='3' width='70' height='90'/></g>";
    assert_eq!(drawn(abutting).unwrap().loops.len(), 1);
    // A hole thinner than the flattening: gone. A hole just thicker than the flattening: kept.
    for (width, loops) in [(0.001, 1), (0.01, 2)] {
        let slit = format!("<rect x='20' y='12' width='{width}' height='20' fill='#fff'/>");
        let body = format!("<rect x='10' y='10' width='30' height='30'/>{slit}");
        assert_eq!(drawn(&body).unwrap().loops.len(), loops, "{width}");
    }
}

#[test]
fn the_right_half_of_a_silhouette() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 0 20 40"><circle cx="0" cy="20" r="8"/></svg>"#;
    let p = profile(text.as_bytes(), ProfileAxis::Center, 0.0).unwrap();
    let b = p.outline.bounds().unwrap();
    assert_eq!((p.radius, b.r_min), (0.25, 0.0));
    for (found, wanted) in [(b.r_max, 0.2), (b.z_min, 0.3), (b.z_max, 0.7)] {
        assert!((found - wanted).abs() < 1e-5, "{b:?}");
    }
    let o = p.outline;
    assert_eq!(o.segments().count() - o.surface_segments().count(), 1);
}

#[test]
fn a_page_that_is_dark_all_over_is_refused() {
    let text = drawn("<rect width='100' height='100'/>").unwrap_err();
    assert!(text.to_string().contains("is full"), "{text}");
}
