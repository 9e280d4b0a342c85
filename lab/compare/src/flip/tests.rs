#![allow(clippy::unwrap_used)]
use super::*;
use revmap::frame::linear_from_srgb;

const SIZE: (u32, u32) = (64, 48);

/// Test pictures as sRGB codes, by formula.
fn code(kind: u32, x: u32, y: u32) -> [u8; 3] {
    let checks = |x: u32| {
        if (x / 4 + y / 4).is_multiple_of(2) {
            [200; 3]
        } else {
            [50; 3]
        }
    };
    match kind {
        0 => [
            (f64::from(x) / 64.0 * 255.0) as u8,
            (f64::from(y) / 48.0 * 255.0) as u8,
            ((x * 7 + y * 3) % 256) as u8,
        ],
        1 if x.abs_diff(30).pow(2) + y.abs_diff(20).pow(2) < 100 => [255, 40, 30],
        1 => code(0, x, y),
        2 => checks(x),
        3 => checks(x + 1),
        4 => [0, 255, 0],
        5 => [0, 0, 255],
        6 => [0; 3],
        7 => [255; 3],
        8 => [128; 3],
        _ => [132, 128, 128],
    }
}

fn picture(kind: u32) -> Frame {
    let mut frame = Frame::new(SIZE.0, SIZE.1, [0.0; 4]).unwrap();
    for (k, c) in frame.color.iter_mut().enumerate() {
        let k = k as u32;
        let linear = code(kind, k % SIZE.0, k / SIZE.0)
            .map(|v| linear_from_srgb(f64::from(v) / 255.0) as f32);
        *c = [linear[0], linear[1], linear[2], 1.0];
    }
    frame
}

/// What the authors' own program (nv-flip 0.1.2, in single precision) finds: pictures, pixels per
/// degree, mean, and the pixels (0, 0), (30, 20) and (50, 40).
#[allow(clippy::type_complexity)]
const AUTHORS: [(u32, u32, f64, f64, [f64; 3]); 14] = [
    (0, 1, 67.0206, 0.116933, [0.000000, 0.964261, 0.000000]),
    (0, 1, 30.0, 0.103703, [0.000000, 0.958689, 0.000000]),
    (2, 3, 67.0206, 0.237712, [0.034935, 0.173211, 0.174063]),
    (2, 3, 30.0, 0.364498, [0.000000, 0.221943, 0.221943]),
    (4, 5, 67.0206, 1.000000, [1.000000, 1.000000, 1.000000]),
    (4, 5, 30.0, 1.000000, [1.000000, 1.000000, 1.000000]),
    (6, 7, 67.0206, 0.967386, [0.967386, 0.967386, 0.967386]),
    (6, 7, 30.0, 0.967384, [0.967384, 0.967384, 0.967384]),
    (8, 9, 67.0206, 0.065329, [0.065329, 0.065329, 0.065329]),
    (8, 9, 30.0, 0.065321, [0.065321, 0.065321, 0.065321]),
    (0, 2, 67.0206, 0.829331, [0.976938, 0.676420, 0.589633]),
    (0, 2, 30.0, 0.899608, [0.965285, 0.902737, 0.517432]),
    (1, 0, 67.0206, 0.116933, [0.000000, 0.964261, 0.000000]),
    (1, 0, 30.0, 0.103703, [0.000000, 0.958689, 0.000000]),
];

#[test]
fn the_authors_figures_come_out() {
    for (a, b, ppd, expected, pixels) in AUTHORS {
        let map = flip_map(&picture(a), &picture(b), ppd);
        let found = [
            mean_flip(&map),
            map[0].into(),
            map[20 * 64 + 30].into(),
            map[40 * 64 + 50].into(),
        ];
        let wanted = [expected, pixels[0], pixels[1], pixels[2]];
        for (f, w) in found.into_iter().zip(wanted) {
            assert!(
                (f - w).abs() < 1e-4,
                "pictures {a} and {b} at {ppd}: {found:?}, not {wanted:?}"
            );
        }
    }
}

#[test]
fn equal_pictures_do_not_differ_and_order_does_not_matter() {
    let map = flip_map(&picture(0), &picture(0), 67.0);
    assert!(map.iter().all(|&v| v == 0.0));
    let [there, back] = [(0, 1), (1, 0)].map(|(a, b)| flip_map(&picture(a), &picture(b), 67.0));
    assert_eq!(there, back);
}

#[test]
fn a_planted_blot_shows_where_it_is() {
    let map = flip_map(&picture(0), &picture(1), 67.0);
    for (k, &v) in map.iter().enumerate() {
        let (x, y) = (k as f64 % 64.0 - 30.0, (k / 64) as f64 - 20.0);
        let r = x.hypot(y);
        // The filters reach 10 pixels.
        if r > 10.0 + 15.0 {
            assert_eq!(v, 0.0, "pixel {k}");
        } else if r < 8.0 {
            assert!(v > 0.2, "pixel {k}: {v}");
        }
    }
}

#[test]
fn odd_values_give_numbers() {
    let mut odd = picture(0);
    odd.color[5] = [f32::NAN, f32::INFINITY, -1.0, f32::NAN];
    let map = flip_map(&odd, &picture(1), 67.0);
    assert!(map.iter().all(|v| v.is_finite()));
    assert!(flip_map(&odd, &Frame::new(3, 3, [0.0; 4]).unwrap(), 67.0).is_empty());
}
