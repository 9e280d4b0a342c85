//! Profiles for tests, each with a different difficulty.

use glam::DVec2;
use revmap::profile::{Outline, Profile};
use revmap::scene::Offset;
use std::f64::consts::{PI, TAU};

pub const fn offset(extend: f64, bevel: f64, chamfer: f64) -> Offset {
    Offset {
        extend,
        bevel,
        chamfer,
    }
}

fn polygon(points: &[[f64; 2]], radius: f64) -> Profile {
    Profile::polygon(points, radius).unwrap()
}

/// A ball of radius 0.4, 96 segments from pole to pole.
pub fn sphere() -> Profile {
    let points: Vec<_> = (0..=96)
        .map(|k| {
            let angle = PI * (f64::from(k) / 96.0 - 0.5);
            let r = if k % 96 == 0 { 0.0 } else { 0.4 * angle.cos() };
            [r, 0.5 + 0.4 * angle.sin()]
        })
        .collect();
    polygon(&points, 0.5)
}

pub fn cone() -> Profile {
    polygon(&[[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]], 0.5)
}

pub fn torus() -> Profile {
    let points: Vec<_> = (0..64)
        .map(|k| {
            let angle = f64::from(k) * TAU / 64.0;
            [0.28 + 0.12 * angle.cos(), 0.5 + 0.12 * angle.sin()]
        })
        .collect();
    polygon(&points, 0.5)
}

/// Smooth, with a waist and a lip.
pub fn vase() -> Profile {
    let mut points = vec![[0.0, 0.05]];
    points.extend((0..=80).map(|k| {
        let z = f64::from(k) / 80.0;
        let r = 0.24 + 0.1 * (5.2 * z + 0.3).sin() + 0.03 * z;
        [r, 0.05 + 0.9 * z]
    }));
    points.push([0.0, 0.95]);
    polygon(&points, 0.5)
}

/// A thin-walled glass with foot and stem: walls of 0.015.
pub fn glass() -> Profile {
    polygon(&GLASS, 0.5)
}

/// The glass's points; the seventh is the widest.
pub const GLASS: [[f64; 2]; 12] = [
    [0.0, 0.04],
    [0.26, 0.04],
    [0.26, 0.06],
    [0.04, 0.1],
    [0.035, 0.4],
    [0.18, 0.5],
    [0.3, 0.7],
    [0.28, 0.95],
    [0.265, 0.95],
    [0.285, 0.7],
    [0.17, 0.52],
    [0.0, 0.44],
];

/// Nineteen thin discs on a spindle.
pub fn discs() -> Profile {
    let mut points = vec![[0.0, 0.04]];
    for k in 0..19 {
        let z = 0.05 + 0.9 * f64::from(k) / 19.0;
        points.extend([[0.05, z], [0.36, z], [0.36, z + 0.015], [0.05, z + 0.015]]);
    }
    points.extend([[0.05, 0.96], [0.0, 0.96]]);
    polygon(&points, 0.5)
}

/// A column with forty ridges from top to bottom.
pub fn column() -> Profile {
    let mut points = vec![[0.0, 0.05]];
    for k in 0..40 {
        let z = 0.05 + 0.9 * f64::from(k) / 40.0;
        points.extend([[0.25, z], [0.29, z + 0.011]]);
    }
    points.extend([[0.25, 0.95], [0.0, 0.95]]);
    polygon(&points, 0.5)
}

/// A cut stone: flat facets, sharp girdle, off the box's middle.
pub fn jewel() -> Profile {
    let girdle = [[0.38, 0.58], [0.4, 0.61], [0.38, 0.64]];
    let points = [&[[0.0, 0.1]][..], &girdle, &[[0.26, 0.82], [0.0, 0.82]]];
    polygon(&points.concat(), 0.5)
}

/// All eight profiles, by name.
pub fn all() -> Vec<(&'static str, Profile)> {
    vec![
        ("sphere", sphere()),
        ("cone", cone()),
        ("torus", torus()),
        ("vase", vase()),
        ("glass", glass()),
        ("discs", discs()),
        ("column", column()),
        ("jewel", jewel()),
    ]
}

/// A plain column of this radius.
pub fn column_of(radius: f64) -> Profile {
    polygon(&[[0.0, 0.0], [radius, 0.0], [radius, 1.0], [0.0, 1.0]], 0.5)
}

/// Two cylinders, one inside the other, each with its own loop: the middle is solid twice.
pub fn crossing() -> Profile {
    let rectangle = |r0: f64, r1: f64, z1: f64| {
        [(r0, 0.0), (r1, 0.0), (r1, z1), (r0, z1)]
            .map(DVec2::from)
            .to_vec()
    };
    let loops = vec![rectangle(0.0, 0.3, 0.4), rectangle(0.1, 0.2, 0.8)];
    Profile::new(Outline { loops }, 0.5)
}
