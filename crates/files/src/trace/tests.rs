#![allow(clippy::unwrap_used)]
use super::*;
use crate::raster::{rasterize, with_levels};
use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::scene::Offset;
use revmap::surface::ContourSource;
use revmap_compare::map_accuracy::Disc;

fn picture(columns: u32, rows: u32, coverage: impl Fn(f64, f64) -> f64) -> Raster {
    let at = |k: u32| coverage(f64::from(k % columns) + 0.5, f64::from(k / columns) + 0.5);
    Raster {
        columns,
        rows,
        coverage: (0..columns * rows).map(|k| at(k) as f32).collect(),
    }
}

/// The covered part of the pixel around `(x, y)`, where `distance < 0` is solid.
fn area(x: f64, y: f64, distance: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |k: u32| f64::from(k) / 16.0 - 0.5 + 1.0 / 32.0;
    let solid = |k: &u32| distance(x + at(k % 16), y + at(k / 16)) < 0.0;
    (0..256).filter(solid).count() as f64 / 256.0
}

/// Coverage at a signed distance, texels, from an edge: sharper than areas at a slant.
fn ramp(distance: f64) -> f64 {
    (0.5 - distance).clamp(0.0, 1.0)
}

/// Traces a picture and checks properties of every outline: it is within the box, has an area, and
/// surfaces can be made of it.
#[track_caller]
fn traced(raster: &Raster) -> Outline {
    let profile = trace(raster.clone()).unwrap();
    check(&profile);
    profile.outline
}

#[track_caller]
fn check(profile: &Profile) {
    let b = profile.outline.bounds().unwrap();
    assert!(b.r_min >= 0.0 && b.r_max <= profile.radius, "{b:?}");
    assert!(b.z_min >= 0.0 && b.z_max <= 1.0, "{b:?}");
    assert!(profile.outline.area() > 0.0);
    let source = ContourSource::new(&profile.outline).unwrap();
    source.contour(&Offset::default()).unwrap();
}

/// Root mean square and largest error, texels, of the distances to a disc of 128 rows, after its
/// picture went through `change`.
fn disc_errors(change: impl Fn(&mut Raster)) -> (f64, f64) {
    let disc = Disc::default();
    let polygon = disc.polygon(1 << 14).unwrap();
    let mut raster = with_levels(rasterize(&polygon.outline, 128, 128).unwrap(), 256);
    change(&mut raster);
    let profile = trace(raster).unwrap();
    let map = ShapeMap::bake(&profile, &BakeOptions::new(MapSource::EXACT, 128)).unwrap();
    let e = disc.measure(&map).unwrap();
    (e.rms, e.max)
}

/// A box filter of 3 x 3.
fn blur(raster: &mut Raster) {
    let (w, h) = (raster.columns as usize, raster.rows as usize);
    let old = raster.coverage.clone();
    for j in 1..h.saturating_sub(1) {
        for i in 1..w.saturating_sub(1) {
            let sum: f32 = (0..9)
                .map(|k| old[(j + k / 3 - 1) * w + i + k % 3 - 1])
                .sum();
            raster.coverage[j * w + i] = sum / 9.0;
        }
    }
}

/// Blur twice, noise as JPEG has it (a few percent up and down everywhere), and a solid of 80 % on
/// paper of 10 %: edges stay where they pass one half.
#[test]
fn changed_pictures_have_the_same_edges() {
    type Change<'a> = &'a dyn Fn(&mut Raster);
    let noise = |raster: &mut Raster| {
        for (c, k) in raster.coverage.iter_mut().zip(0u32..) {
            let noise = (k.wrapping_mul(2_654_435_761) >> 16) as f32 / 65_536.0 - 0.5;
            *c = (*c + 0.08 * noise).clamp(0.0, 1.0);
        }
    };
    let cases: [(Change, [f64; 2]); 3] = [
        (&|raster| (0..2).for_each(|_| blur(raster)), [0.05, 0.25]),
        (&noise, [0.05, 0.4]),
        (
            &|raster| raster.coverage.iter_mut().for_each(|c| *c = 0.1 + 0.7 * *c),
            [0.15, 0.6],
        ),
    ];
    for (number, (change, limits)) in cases.into_iter().enumerate() {
        let (rms, max) = disc_errors(change);
        let near = rms < limits[0] && max < limits[1];
        assert!(near, "{number}: rms {rms}, max {max} texels");
    }
}

/// A ring of #404040 on white, hard and anti-aliased: no pixel of it is full.
#[test]
fn a_grey_ring_is_a_ring() {
    for soft in [false, true] {
        let ring = picture(64, 64, |x, y| {
            let covered = area(x, y, |x, y| ((x - 32.0).hypot(y - 32.0) - 16.0).abs() - 6.0);
            0.75 * if soft { covered } else { covered.round() }
        });
        let outline = traced(&ring);
        assert_eq!(outline.loops.len(), 2);
        let area = std::f64::consts::PI * (22.0f64.powi(2) - 10.0f64.powi(2)) / 64.0f64.powi(2);
        assert!(
            (outline.area() / area - 1.0).abs() < 0.05,
            "{soft}: {}",
            outline.area() / area
        );
    }
}

/// A drop: round but for one corner, wherever the loop begins.
#[test]
fn a_ring_with_one_corner_keeps_it() {
    for turn in 0..16 {
        let to = DVec2::from_angle(f64::from(turn) * std::f64::consts::TAU / 16.0);
        // A disc of radius 28, and the wedge of 90 degrees that touches it.
        let drop = |x: f64, y: f64| {
            let p = DVec2::new(x - 64.0, y - 64.0);
            let (along, across) = (p.dot(to), p.perp_dot(to).abs());
            if along > across {
                (along + across) * std::f64::consts::FRAC_1_SQRT_2 - 28.0
            } else {
                p.length() - 28.0
            }
        };
        let drop = picture(128, 128, |x, y| area(x, y, drop));
        let outline = traced(&drop);
        let tip = DVec2::new(64.0, 64.0) + to * 28.0 * std::f64::consts::SQRT_2;
        let tip = DVec2::new(tip.x, 128.0 - tip.y) / 128.0;
        let miss = outline.nearest(tip).unwrap().distance(tip) * 128.0;
        assert!(outline.loops.len() == 1 && miss < 0.6, "{turn}: {miss}");
    }
}

/// Solids that touch the right border end there: the wall is on the box, and not beyond.
#[test]
fn the_border_of_the_picture_is_a_boundary() {
    let square = traced(&picture(16, 16, |x, y| {
        f64::from(u8::from(x > 6.0 && y > 3.0 && y < 13.0))
    }));
    let b = square.bounds().unwrap();
    assert!((b.r_max, b.z_min) == (1.0, 3.0 / 16.0), "{b:?}");
    assert!((square.area() - 100.0 / 256.0).abs() < 1e-9);
    for radius in [6.0, 7.5, 9.0] {
        for soft in [false, true] {
            let disc = traced(&picture(16, 16, |x, y| {
                let covered = area(x, y, |x, y| (x - 11.0).hypot(y - 8.0) - radius);
                if soft { covered } else { covered.round() }
            }));
            let r_max = disc.bounds().unwrap().r_max;
            assert!(r_max > 1.0 - 0.1 / 16.0, "{radius}: {r_max}");
        }
    }
    let full = traced(&picture(4, 8, |_, _| 1.0));
    assert!((full.area() - 0.5).abs() < 0.02, "{}", full.area());
}

/// An axis through the middle of a column and one at the left edge of a finer picture are the same
/// axis.
#[test]
fn a_column_on_the_axis_counts_half() {
    let ball = |shift: f64| {
        picture(32, 64, |x, y| {
            area(x, y, |x, y| (x - shift).hypot(y - 32.0) - 20.0)
        })
    };
    let half = trace_split(ball(0.5), true).unwrap();
    check(&half);
    assert_eq!((half.radius, &half.raster), (31.5 / 64.0, &None));
    let middle = DVec2::new(0.0, 0.5);
    for outline in [half.outline, traced(&ball(0.0))] {
        assert_eq!(outline.bounds().unwrap().r_min, 0.0);
        for s in outline.surface_segments() {
            let miss = s.a.distance(middle) * 64.0 - 20.0;
            assert!(miss.abs() < 0.05, "{miss} at {}", s.a);
        }
    }
}

/// All pictures of 3 x 3 pixels in two greys.
#[test]
fn every_pattern_of_pixels_has_an_outline() {
    for bits in 1u32..512 {
        let grey = |k: u32| if bits >> k & 1 == 1 { 0.9 } else { 0.2 };
        traced(&Raster {
            columns: 3,
            rows: 3,
            coverage: (0..9).map(grey).collect(),
        });
    }
}

/// Noise, rings, thin lines, single rows and columns, in few and in many greys, blurred or not.
#[test]
fn random_pictures_are_traced_or_refused() {
    let mut state = 1u32;
    let mut random = move |n: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % n
    };
    for number in 0..400 {
        let [columns, rows] = match number % 8 {
            0 => [1, 1 + random(60)],
            1 => [1 + random(60), 1],
            _ => [2 + random(70), 2 + random(70)],
        };
        let [w, h] = [columns, rows].map(f64::from);
        let mut share = || f64::from(random(1000)) / 1000.0;
        let (x0, y0, size, wide) = (w * share(), h * share(), w.max(h) * share(), 4.0 * share());
        let (dark, way) = (0.5 + 0.5 * share(), DVec2::from_angle(7.0 * share()));
        let mut raster = picture(columns, rows, |x, y| {
            let p = DVec2::new(x - x0, y - y0);
            dark * match number % 5 {
                0 => 0.0,
                1 => ramp((p.length() - size).abs() - wide),
                2 => ramp(p.dot(way).abs() - wide),
                3 => ramp(p.length() - size),
                _ => ramp(p.perp_dot(way).abs().max(p.dot(way).abs()) - size),
            }
        });
        let noise = if number % 5 == 0 {
            1000
        } else {
            random(400) * random(2)
        };
        for c in &mut raster.coverage {
            *c = (*c + random(noise + 1) as f32 / 1000.0 * if noise == 1000 { 1.0 } else { 0.3 })
                .min(1.0);
        }
        for _ in 0..random(3) {
            blur(&mut raster);
        }
        let raster = with_levels(raster, [2, 3, 16, 256][number % 4]);
        for split in [false, true] {
            match trace_split(raster.clone(), split) {
                Ok(profile) => check(&profile),
                Err(_) => assert!(
                    raster.coverage.iter().all(|&c| c <= 0.5),
                    "picture {number}"
                ),
            }
        }
    }
}

#[test]
fn a_list_of_another_length_is_refused() {
    let short = Raster {
        columns: 5,
        ..picture(4, 4, |_, _| 1.0)
    };
    let text = trace(short).unwrap_err().to_string();
    assert!(text.contains("16 coverages"), "{text}");
}
