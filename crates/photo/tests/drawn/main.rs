//! Pictures drawn here, with a known outline: ground, light, shadow, tilt, bands, handles, cuts.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use revmap_photo::{
    Doubt, End, Fault, Ground, Half, LeftOut, Photo, Reading, Tone, is_drawing, read,
};

mod scene;

use scene::{Color, SIZE, Scene, changed, photo, radius};

/// Intersection over union of a reading and the baluster, each over its own height.
fn likeness(reading: &Reading) -> f64 {
    let (mut both, mut either) = (0.0, 0.0);
    for k in 0..400 {
        let part = (f64::from(k) + 0.5) / 400.0;
        let row = ((1.0 - part) * reading.radii.len() as f64) as usize;
        let (a, b) = (
            reading.radii[row] / (reading.top - reading.bottom),
            radius(part),
        );
        both += a.min(b);
        either += a.max(b);
    }
    both / either
}

#[track_caller]
fn assert_read(pixels: &[[u8; 4]], least: f64) -> Reading {
    assert!(!is_drawing(&photo(pixels)));
    let reading = read(&photo(pixels)).unwrap();
    let found = likeness(&reading);
    assert!(found >= least, "{found}: {reading}");
    reading
}

#[track_caller]
fn assert_sure(pixels: &[[u8; 4]], least: f64) -> Reading {
    let reading = assert_read(pixels, least);
    assert_eq!(reading.doubts, []);
    reading
}

/// A dark rim about the foot in the ground's hue is a shadow; one in the thing's hue is a plinth.
#[test]
fn a_contact_shadow_is_no_plinth() {
    let scene = changed(|s| s.color = [0.1, 0.2, 0.6]);
    let foot = |rim: Color| {
        let drawn = |[u, z]: [f64; 2], inside: bool, color: Color| {
            let is_rim = !inside && (0.0..0.02).contains(&z) && u.abs() < radius(z) + 0.04;
            if is_rim { rim } else { color }
        };
        let reading = read(&photo(&scene.draw(drawn))).unwrap();
        let last = &reading.radii[reading.radii.len() - 8..];
        last.iter().copied().fold(0.0, f64::max) / (reading.top - reading.bottom)
    };
    let (shadow, plinth) = (foot([0.24, 0.234, 0.222]), foot([0.07, 0.14, 0.42]));
    assert!(shadow < radius(0.02) + 0.012, "{shadow}");
    assert!(plinth > radius(0.02) + 0.025, "{plinth}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_tilted_lit_and_shadowed_thing_comes_back(
        axis in 0.4..0.6,
        tilt in -6.0..6.0,
        pale in any::<bool>(),
        dark in 0.1..0.4,
        light in 0.6..1.0,
    ) {
        let scene = Scene {
            axis,
            tilt,
            color: if pale { [0.95, 0.9, 0.8] } else { [0.25, 0.2, 0.3] },
            ground: if pale { [0.4, 0.42, 0.5] } else { [0.8, 0.78, 0.74] },
            light: [1.0, light],
            shadow: Some((0.16, dark)),
            ..Scene::default()
        };
        let reading = read(&photo(&scene.plain())).unwrap();
        prop_assert!(likeness(&reading) > 0.94, "{}: {}", likeness(&reading), reading);
        prop_assert!((reading.tilt - tilt).abs() < 0.4, "{} for {}", reading.tilt, tilt);
        prop_assert!((reading.axis - axis).abs() < 0.02);
        prop_assert_eq!(reading.doubts, []);
    }
}

#[test]
fn tones_and_grounds_are_named() {
    let dark = assert_sure(&Scene::default().plain(), 0.96);
    assert_eq!(
        (dark.tone, dark.half, &dark.left_out[..]),
        (Tone::Darker, Half::Both, &[][..])
    );
    let pale = changed(|s| (s.color, s.ground) = ([0.9, 0.86, 0.8], [0.2, 0.2, 0.22]));
    assert_eq!(assert_sure(&pale.plain(), 0.96).tone, Tone::Lighter);
    let hue = changed(|s| (s.color, s.ground) = ([0.62, 0.35, 0.35], [0.34, 0.42, 0.34]));
    assert_sure(&hue.plain(), 0.96);
    let table = changed(|s| (s.table, s.color) = (Some([0.4, 0.3, 0.2]), [0.3, 0.4, 0.6]));
    let table = assert_sure(&table.plain(), 0.95).to_string();
    assert!(table.starts_with("read as a photograph: "), "{table}");
}

#[test]
fn what_is_left_out_is_named() {
    let shadowed = changed(|s| s.shadow = Some((0.2, 0.35)));
    let shadowed = assert_sure(&shadowed.plain(), 0.95);
    assert!(shadowed.left_out.contains(&LeftOut::Shadow), "{shadowed}");
    let scene = Scene::default();
    let handle = scene.draw(|[u, z], _, color| {
        let ring = (u - 0.2).hypot(z - 0.5);
        let is = u > 0.0 && (0.09..0.13).contains(&ring);
        if is { scene.color } else { color }
    });
    let handle = assert_sure(&handle, 0.95);
    assert!(handle.left_out.contains(&LeftOut::OneSide), "{handle}");
    let second = scene.draw(|[u, z], _, color| match (u - 0.42).hypot(z - 0.1) < 0.09 {
        true => [0.3, 0.4, 0.5],
        false => color,
    });
    let second = assert_sure(&second, 0.95);
    assert!(second.left_out.contains(&LeftOut::Things(1)), "{second}");
    let mut framed = scene.plain();
    for (i, pixel) in framed.iter_mut().enumerate() {
        let (x, y) = (i % SIZE[0], i / SIZE[0]);
        let rim = x.min(y).min(SIZE[0] - 1 - x).min(SIZE[1] - 1 - y);
        *pixel = if rim < 5 { [12, 12, 12, 255] } else { *pixel };
    }
    let framed = assert_sure(&framed, 0.95);
    assert!(framed.left_out.contains(&LeftOut::Frame), "{framed}");
}

#[test]
fn bands_of_the_grounds_colour_belong_to_the_thing() {
    let scene = Scene::default();
    let banded = scene.draw(
        |[_, z], inside, color| match inside && (z * 9.0) as i32 % 2 == 1 {
            true => [0.74, 0.71, 0.66].map(|v| v * color[0] / scene.color[0]),
            false => color,
        },
    );
    assert_read(&banded, 0.93);
}

#[test]
fn a_half_that_the_edge_cuts_is_not_used() {
    let scene = changed(|s| s.axis = 0.12);
    let cut = assert_sure(&scene.plain(), 0.93);
    assert_eq!((cut.half, cut.cut), (Half::Right, true));
    assert!(
        cut.to_string().contains("edge of the picture cuts"),
        "{cut}"
    );
}

#[test]
fn transparency_is_the_ground() {
    let scene = Scene::default();
    let mut pixels = scene.plain();
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let [u, z] = scene.place((i % SIZE[0]) as f64 + 0.5, (i / SIZE[0]) as f64 + 0.5);
        pixel[3] = match (u.abs() < radius(z), (u - 0.1).abs() < radius(z)) {
            (true, _) => 255,
            (_, true) => 90,
            _ => 0,
        };
    }
    let reading = assert_sure(&pixels, 0.95);
    assert_eq!(reading.ground, Ground::Transparent);
}

#[test]
fn a_cut_out_may_fill_its_picture_and_be_as_clear_as_glass() {
    let scene = Scene::default();
    let coverage = |[u, z]: [f64; 2]| (200.0 * (radius(z) - u.abs()) + 0.5).clamp(0.0, 1.0);
    for (opaque, background) in [(255.0, [0, 0, 0]), (70.0, [255, 255, 255])] {
        let mut pixels = scene.plain();
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let place = scene.place((i % SIZE[0]) as f64 + 0.5, (i / SIZE[0]) as f64 + 0.5);
            pixel[3] = (opaque * coverage(place)) as u8;
            // Colours are those of the ground: only the transparency tells.
            pixel[..3].copy_from_slice(&background);
        }
        let columns = |x: &usize| (0..SIZE[1]).any(|y| pixels[y * SIZE[0] + x][3] > 20);
        let rows = |y: &usize| (0..SIZE[0]).any(|x| pixels[y * SIZE[0] + x][3] > 20);
        let (left, right) = ((0..SIZE[0]).find(columns), (0..SIZE[0]).rfind(columns));
        let (top, bottom) = ((0..SIZE[1]).find(rows), (0..SIZE[1]).rfind(rows));
        let (across, down) = (
            left.unwrap()..right.unwrap() + 1,
            top.unwrap()..bottom.unwrap() + 1,
        );
        let tight: Vec<[u8; 4]> = down
            .clone()
            .flat_map(|y| pixels[y * SIZE[0]..][across.clone()].to_vec())
            .collect();
        let photo = Photo {
            width: across.len() as u32,
            height: down.len() as u32,
            rgba: &tight,
        };
        let whole = read(&self::photo(&pixels)).unwrap();
        let reading = read(&photo).unwrap();
        assert_eq!(
            (reading.ground, reading.half, &*reading.doubts),
            (Ground::Transparent, Half::Both, &[][..])
        );
        let widest = |r: &Reading| r.radii.iter().copied().fold(0.0, f64::max);
        let expected = widest(&whole) * SIZE[1] as f64 / down.len() as f64;
        assert!(
            (widest(&reading) - expected).abs() < 0.004,
            "{} {expected}",
            widest(&reading)
        );
        assert!(
            reading.top > 0.99 && reading.bottom < 0.01,
            "{} {}",
            reading.top,
            reading.bottom
        );
        assert!((reading.axis - 0.5).abs() < 0.01, "{}", reading.axis);
    }
}

#[test]
fn a_thing_that_the_lower_edge_cuts_is_told() {
    let scene = changed(|s| s.noise = 0.004);
    let pixels = scene.plain();
    let from = SIZE[0] * (SIZE[1] * 3 / 5);
    let cut = read(&Photo {
        width: SIZE[0] as u32,
        height: (SIZE[1] * 3 / 5) as u32,
        rgba: &pixels[..from],
    });
    assert_eq!(cut.unwrap().doubts, [Doubt::Cut(End::Lower)]);
}

#[test]
fn a_tip_is_no_foot_seen_from_above() {
    // A light bulb: wide above, a thread, and a contact that is a flat arc.
    let bulb = |z: f64| match z {
        0.35.. => (0.33f64.powi(2) - (z - 0.67).powi(2)).max(0.0).sqrt(),
        0.04.. => 0.13,
        _ => 0.03 * (1.0 - ((0.04 - z) / 0.04).powi(2)).max(0.0).sqrt(),
    };
    let scene = Scene::default();
    let mut pixels = scene.plain();
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let [u, z] = scene.place((i % SIZE[0]) as f64 + 0.5, (i / SIZE[0]) as f64 + 0.5);
        *pixel = [
            0,
            0,
            0,
            if u.abs() < bulb(z) && z < 1.0 && z > 0.0 {
                255
            } else {
                0
            },
        ];
    }
    let reading = read(&photo(&pixels)).unwrap();
    assert_eq!(reading.elevation, None, "{reading}");
}

#[test]
fn a_faint_edge_is_doubted() {
    let scene = changed(|s| (s.color, s.noise) = (s.ground, 0.004));
    // The light falls from the left: only the right side is darker than the ground.
    let faint = scene.draw(|[u, z], inside, color| match inside {
        true => scene
            .ground
            .map(|v| v * (1.0 - 0.25 * (u / radius(z)).max(0.0))),
        false => color,
    });
    match read(&photo(&faint)) {
        Ok(reading) => assert!(
            reading.doubts.iter().any(|d| matches!(d, Doubt::Faint(_))),
            "{} {reading} {:?}",
            likeness(&reading),
            reading.doubts
        ),
        Err(fault) => assert_ne!(fault, Fault::NoSymmetry),
    }
}

#[test]
fn a_thing_that_may_go_on_below_a_tables_edge_is_doubted() {
    let scene = changed(|s| (s.color, s.ground) = ([0.9, 0.75, 0.55], [0.89, 0.85, 0.77]));
    let before = |table: Color, grain: f64| {
        let pixels = scene.draw(|[u, z], inside, color| match inside || z > 0.62 {
            true => color,
            false => {
                let rings = 170.0 * z + 6.0 * (3.0 * u).sin() + 2.0 * (9.0 * z).sin();
                table.map(|v| v * (1.0 + grain * rings.sin()))
            }
        });
        read(&photo(&pixels)).unwrap()
    };
    // The head alone is found: the thing and the table are of one wood.
    for grain in [0.03, 0.06] {
        let reading = before([0.77, 0.64, 0.49], grain);
        assert!(likeness(&reading) < 0.5, "{reading}");
        assert_eq!(reading.doubts, [Doubt::Part]);
    }
    let whole = before([0.8, 0.7, 0.55], 0.03);
    assert!(likeness(&whole) > 0.97, "{whole}");
    assert_eq!(whole.doubts, []);
}

#[test]
fn things_that_were_not_turned_are_refused_or_doubted() {
    let scene = Scene::default();
    // A flag on a pole, and a stair.
    let flag = |[u, z]: [f64; 2]| {
        (u + 0.3).abs() < 0.02 && z < 1.0 || u > -0.3 && u < 0.3 && (0.5..1.0).contains(&z)
    };
    let stair = |[u, z]: [f64; 2]| {
        u > -0.35 && u < 0.35 && z > 0.0 && z < ((u + 0.35) * 8.0).floor() / 6.0 + 0.1
    };
    for is in [&flag as &dyn Fn([f64; 2]) -> bool, &stair] {
        let pixels = scene.draw(|p, inside, color| match (is(p), inside) {
            (true, _) => scene.color,
            (false, true) => scene.ground,
            _ => color,
        });
        match read(&photo(&pixels)) {
            Err(fault) => assert_eq!(fault, Fault::NoSymmetry),
            Ok(reading) => assert!(
                reading.doubts.iter().any(|d| matches!(d, Doubt::Uneven(_))),
                "{reading}"
            ),
        }
    }
    let nothing = vec![[200, 190, 180, 255]; SIZE[0] * SIZE[1]];
    assert_eq!(read(&photo(&nothing)).unwrap_err(), Fault::Nothing);
}

#[test]
fn drawings_are_told_from_photographs() {
    let scene = changed(|s| (s.color, s.ground, s.noise) = ([0.1; 3], [0.9; 3], 0.02));
    let flat = scene.draw(|_, inside, _| if inside { scene.color } else { scene.ground });
    assert!(is_drawing(&photo(&flat)));
    let colored = scene.draw(|_, inside, _| match inside {
        true => [0.1, 0.1, 0.4],
        false => scene.ground,
    });
    assert!(!is_drawing(&photo(&colored)));
    let lit = Scene {
        light: [1.0, 0.88],
        ..scene
    };
    assert!(!is_drawing(&photo(&lit.plain())));
}
