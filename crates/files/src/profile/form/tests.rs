#![allow(clippy::unwrap_used)]
use super::*;
use crate::{png_bytes, profile_from_bytes};
use image::{GrayImage, Luma};

/// Warnings about a picture of 200 x 200 pixels, solid where `form` says so.
fn warnings(axis: ProfileAxis, form: &dyn Fn(f64, f64) -> bool) -> Vec<String> {
    let at = |k: u32| (f64::from(k) + 0.5) / 200.0;
    let shade = |x, y| Luma([if form(at(x), at(y)) { 30 } else { 240 }]);
    let bytes = png_bytes(GrayImage::from_fn(200, 200, shade));
    profile_from_bytes(&bytes, axis).map_or_else(|e| vec![e.to_string()], |p| p.warnings)
}

/// A bottle, its axis at this part of the width.
fn is_bottle(middle: f64, x: f64, y: f64) -> bool {
    let half_width = match y {
        0.05..0.3 => 0.08,
        0.3..0.5 => 0.08 + 0.6 * (y - 0.3),
        0.5..0.95 => 0.2,
        _ => -1.0,
    };
    (x - middle).abs() < half_width
}

#[test]
fn forms_about_the_axis_bring_no_warning() {
    type Solid<'a> = &'a dyn Fn(f64, f64) -> bool;
    let usual: [(ProfileAxis, Solid); 6] = [
        (ProfileAxis::Center, &|x, y| is_bottle(0.5, x, y)),
        (ProfileAxis::Left, &|x, y| is_bottle(0.0, x, y)),
        // Half a pixel and a column of pixels beside it is what cropping leaves.
        (ProfileAxis::Center, &|x, y| is_bottle(0.496, x, y)),
        // A hollow cup, a solid whose sides the picture cuts, a tube.
        (ProfileAxis::Center, &|x, y| {
            (0.15..0.2).contains(&(x - 0.5).abs()) && y > 0.2 || is_bottle(0.5, x, y) && y > 0.9
        }),
        (ProfileAxis::Center, &|_, y| y > 0.4),
        (ProfileAxis::Left, &|x, y| {
            (0.3..0.7).contains(&x) && (0.1..0.9).contains(&y)
        }),
    ];
    for (number, (axis, form)) in usual.into_iter().enumerate() {
        assert_eq!(warnings(axis, form), [""; 0], "{number}");
    }
    for middle in [0.62, 0.47, 0.485] {
        let form = |x: f64, y: f64| is_bottle(middle, x, y);
        let found = warnings(ProfileAxis::Center, &form);
        let words = format!("profile_axis = {middle}");
        assert!(found.len() == 1 && found[0].contains(&words), "{found:?}");
        assert_eq!(warnings(ProfileAxis::At(middle), &form), [""; 0]);
    }
}

#[test]
fn hollow_halves_on_the_left_border_name_their_axis() {
    for name in ["vase", "plate", "jewel"] {
        let file = format!(
            "{}/../../assets/gallery/{name}.svg",
            env!("CARGO_MANIFEST_DIR")
        );
        let read = |axis: ProfileAxis| crate::profile(&file, axis).unwrap().warnings;
        let found = read(ProfileAxis::Center);
        assert_eq!(found.len(), 1, "{name}: {found:?}");
        assert!(found[0].contains("profile_axis = \"left\""), "{found:?}");
        assert_eq!(read(ProfileAxis::Left), [""; 0], "{name}");
    }
    // A jug whose handle ends at the left border is no half.
    let jug = |x: f64, y: f64| {
        let handle = (x - 0.25).hypot(y - 0.6);
        (x - 0.5).hypot(y - 0.6) < 0.3
            || (x - 0.5).abs() < 0.1 && (0.2..0.6).contains(&y)
            || (0.17..0.25).contains(&handle)
    };
    let found = warnings(ProfileAxis::Center, &jug);
    assert!(found[0].contains("halves of the solid differ"), "{found:?}");
}

#[test]
fn outline_drawings_are_told_from_vessels() {
    // Height and outer radius of a box, thickness of its wall, and whether it is open at the top.
    let vessel = |t: f64, open: bool| {
        let roof = if open { 0.9 } else { 0.9 - t };
        let r = 0.3 - t;
        let outside = [[0.0, 0.1], [0.3, 0.1], [0.3, 0.9]];
        let lid = [[0.0, 0.9], [0.0, roof]];
        let inside = [[r, roof], [r, 0.1 + t], [0.0, 0.1 + t]];
        let lid = if open { &[][..] } else { &lid };
        [&outside[..], lid, &inside].concat()
    };
    for (points, is_one) in [
        (vessel(0.003, false), true),
        (vessel(0.03, false), true),
        (vessel(0.1, false), false),
        (vessel(0.01, true), false),
        // A ring has no hollow of its own.
        (
            vec![[0.3, 0.4], [0.31, 0.4], [0.31, 0.5], [0.3, 0.5]],
            false,
        ),
        (vec![[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]], false),
    ] {
        let loops = vec![points.iter().map(|&p| DVec2::from(p)).collect()];
        assert_eq!(is_shell(&Outline { loops }), is_one, "{points:?}");
    }
}
