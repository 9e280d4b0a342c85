#![allow(clippy::unwrap_used)]
use super::*;
use crate::{png_bytes, profile_from_bytes};
use image::{GrayImage, Luma};

/// The half width of a bottle at a depth from 0 to 1.
fn bottle(depth: f64) -> f64 {
    match depth {
        0.05..0.3 => 0.08,
        0.3..0.5 => 0.08 + 0.6 * (depth - 0.3),
        0.5..0.95 => 0.2,
        _ => -1.0,
    }
}

/// Warnings about a picture of 200 x 200 pixels, solid where `form` says so.
fn warnings(axis: ProfileAxis, form: impl Fn(f64, f64) -> bool) -> Vec<String> {
    let at = |k: u32| (f64::from(k) + 0.5) / 200.0;
    let shade = |x, y| Luma([if form(at(x), at(y)) { 30 } else { 240 }]);
    let bytes = png_bytes(GrayImage::from_fn(200, 200, shade));
    profile_from_bytes(&bytes, axis).unwrap().warnings
}

#[track_caller]
fn warned(axis: ProfileAxis, words: &str, form: impl Fn(f64, f64) -> bool) {
    let found = warnings(axis, form);
    assert!(found.len() == 1 && found[0].contains(words), "{found:?}");
}

#[test]
fn a_solid_about_the_axis_is_as_it_should_be() {
    let none = [""; 0];
    let whole = |x: f64, y: f64| (x - 0.5).abs() < bottle(y);
    assert_eq!(warnings(ProfileAxis::Center, whole), none);
    assert_eq!(warnings(ProfileAxis::Left, |x, y| x < bottle(y)), none);
    // Half a pixel and a column of pixels beside it is what cropping leaves.
    assert_eq!(
        warnings(ProfileAxis::Center, |x, y| whole(x + 0.004, y)),
        none
    );
    // A hollow cup, a solid whose sides the picture cuts, a tube.
    let cup = |x: f64, y: f64| {
        (0.15..0.2).contains(&(x - 0.5).abs()) && y > 0.2 || whole(x, y) && y > 0.9
    };
    assert_eq!(warnings(ProfileAxis::Center, cup), none);
    assert_eq!(warnings(ProfileAxis::Center, |_, y| y > 0.4), none);
    let tube = |x: f64, y: f64| (0.3..0.7).contains(&x) && (0.1..0.9).contains(&y);
    assert_eq!(warnings(ProfileAxis::Left, tube), none);
}

#[test]
fn a_solid_beside_the_axis_is_named_and_put_right() {
    for middle in [0.62, 0.47, 0.485] {
        let form = |x: f64, y: f64| (x - middle).abs() < bottle(y);
        warned(
            ProfileAxis::Center,
            &format!("profile_axis = {middle}"),
            form,
        );
        assert_eq!(warnings(ProfileAxis::At(middle), form), [""; 0]);
    }
}

#[test]
fn tilted_pictures_and_uneven_halves_are_named() {
    // The shoulders of a tilted bottle take half a degree from the larger angle.
    for (degrees, words) in [
        (-6.0f64, "tilted by 5."),
        (1.5, "tilted by 1."),
        (3.0, "tilted by "),
    ] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        warned(ProfileAxis::Center, words, |x, y| {
            let (x, y) = (x - 0.5, y - 0.5);
            (x * cos - y * sin).abs() < bottle(x * sin + y * cos + 0.5)
        });
    }
    warned(ProfileAxis::Center, "halves of the solid differ", |x, y| {
        let side = if x < 0.5 {
            bottle(y)
        } else {
            0.3 - 0.5 * bottle(y)
        };
        bottle(y) > 0.0 && (x - 0.5).abs() < side
    });
}

#[test]
fn half_and_whole_profiles_are_told_apart() {
    let center = ProfileAxis::Center;
    warned(center, "profile_axis = \"left\"", |x, y| {
        x < 4.0 * bottle(y)
    });
    warned(center, "profile_axis = 0.1", |x, y| {
        (0.1..0.1 + 3.0 * bottle(y)).contains(&x)
    });
    warned(center, "mirror it", |x, y| 1.0 - x < 4.0 * bottle(y));
    warned(ProfileAxis::Left, "profile_axis = \"center\"", |x, y| {
        (x - 0.5).abs() < bottle(y)
    });
}

fn outline(loops: &[&[[f64; 2]]]) -> Outline {
    let points = |l: &&[[f64; 2]]| l.iter().map(|&p| DVec2::from(p)).collect();
    Outline {
        loops: loops.iter().map(points).collect(),
    }
}

#[test]
fn outline_drawings_are_told_from_vessels() {
    let wall = |t: f64| {
        outline(&[&[
            [0.0, 0.1],
            [0.3, 0.1],
            [0.3, 0.9],
            [0.0, 0.9],
            [0.0, 0.9 - t],
            [0.3 - t, 0.9 - t],
            [0.3 - t, 0.1 + t],
            [0.0, 0.1 + t],
        ]])
    };
    assert!(is_shell(&wall(0.003)));
    assert!(is_shell(&wall(0.03)));
    assert!(!is_shell(&wall(0.1)));
    // Open at the top: a cup.
    let cup = outline(&[&[
        [0.0, 0.1],
        [0.3, 0.1],
        [0.3, 0.9],
        [0.29, 0.9],
        [0.29, 0.11],
        [0.0, 0.11],
    ]]);
    assert!(!is_shell(&cup));
    // A ring has no hollow of its own.
    let ring = outline(&[&[[0.3, 0.4], [0.31, 0.4], [0.31, 0.5], [0.3, 0.5]]]);
    assert!(!is_shell(&ring));
    let solid = outline(&[&[[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]]]);
    assert!(!is_shell(&solid));
}
