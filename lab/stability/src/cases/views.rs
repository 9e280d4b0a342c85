//! Solids that are hard to draw for where they, their boxes, the eye or the lights are.

use super::{GLASS, MIDDLE, SPINDLE, Scene, ball, cylinder, eye, spindle};
use crate::case::Step;

/// A round table of radius 1 whose top is at z = 0, and a kind of shadow on it.
fn table(shadow: &str) -> Step {
    let keys = "position = [0.0, 0.0, -0.1]\nscale = [2.0, 2.0, 0.1]\nspecular = 0.0";
    Step::seen([1.3, -1.9, 1.7], [0.1, 0.1, 0.1])
        .with(&format!("shadow = {shadow:?}"))
        .solid(&cylinder(0.5, 0.0, 1.0), keys)
}

pub(super) const SCENES: &[Scene] = &[
    ("far-from-origin", |x| {
        Step::seen([x + 1.6, x + 0.3, 1.1], [x, x, 0.5])
            .solid(&SPINDLE, &format!("position = {:?}", [x, x, 0.0]))
    }),
    ("far-camera", |d| {
        let fov = 2.0 * (0.75 / d).atan().to_degrees();
        Step::through(eye(25.0, d), MIDDLE, fov).solid(&SPINDLE, "")
    }),
    ("tiny-and-far", |s| {
        let [x, y, z] = eye(25.0, 2.0).map(|x| s * x);
        let keys = format!("position = [1000.0, 0.0, 0.0]\nscale = {:?}", [s; 3]);
        Step::seen([1000.0 + x, y, z], [1000.0, 0.0, 0.5 * s]).solid(&SPINDLE, &keys)
    }),
    ("scale", |s| {
        let eye = eye(25.0, 2.0).map(|x| s * x);
        Step::seen(eye, [0.0, 0.0, 0.5 * s]).solid(&SPINDLE, &format!("scale = {:?}", [s; 3]))
    }),
    ("flat", |s| {
        Step::seen([1.5 * s, 0.6 * s, 0.6 * s], MIDDLE)
            .solid(&SPINDLE, &format!("scale = {:?}", [s, s, 1.0]))
    }),
    ("sub-pixel", |d| {
        // A field of balls, so that some centres of pixels meet one.
        let place = |n: u32| 0.08 * d * (f64::from(n) - 2.0);
        let at = |k: u32| format!("position = {:?}", [0.0, place(k % 5), place(k / 5)]);
        (0..25).fold(Step::seen(eye(10.0, d), MIDDLE), |step, k| {
            step.solid(&ball(0.4), &at(k))
        })
    }),
    ("creeping-camera", |k| {
        let shift = k * 1e-3 * 0.72 * 2.0 / 120.0;
        let [x, y, z] = eye(20.0, 2.0);
        Step::seen([x, y + shift, z], [0.0, shift, 0.5]).solid(&SPINDLE, "")
    }),
    ("creeping-offset", |k| {
        let (extend, bevel) = (0.02 + 1e-4 * k, 0.2 + 1e-4 * k);
        let keys = format!("extend = {extend:?}\nbevel = {bevel:?}\nchamfer = 0.3");
        spindle(20.0, 2.2, &keys)
    }),
    ("many-frames", |n| Step {
        frame: n as u32,
        ..spindle(20.0, 2.0, "")
    }),
    ("grazing-face", |angle| {
        let up = 2.0 * angle.to_radians().tan();
        let step = Step::through([2.0, 0.0, 0.6 + up], [0.0, 0.0, 0.6], 26.0);
        step.solid(&cylinder(0.4, 0.2, 0.6), "").sized(161, 121)
    }),
    ("grazing-flank", |angle| {
        // Along the flank of a cone of base 0.4 and height 0.8, `angle` degrees above it.
        let slope = (0.8f64 / 0.4).atan() - angle.to_radians();
        let eye = [0.4 + 2.0 * slope.cos(), 0.0, 0.1 - 2.0 * slope.sin()];
        let cone = [[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]];
        Step::through(eye, [0.2, 0.0, 0.5], 26.0)
            .solid(&cone, "")
            .sized(161, 121)
    }),
    ("grazing-rim", |delta| {
        // All pixels look past the rim, at most `delta` from it.
        let fov = 2.0 * (delta / 2.0).atan().to_degrees();
        Step::through([2.0, 0.4, 0.5], [0.0, 0.4, 0.5], fov).solid(&ball(0.4), "")
    }),
    ("along-axes", |n| {
        let eye = [
            [2.0, 0.0, 0.5],
            [0.0, -2.0, 0.5],
            [0.0, 0.0, 2.5],
            [0.0, 0.0, -1.5],
            [2.0, 0.0, 0.95],
            [2.0, 0.0, 0.05],
        ][n as usize];
        let target = if n > 3.0 { [0.0, 0.0, eye[2]] } else { MIDDLE };
        Step::seen(eye, target).solid(&SPINDLE, "").sized(161, 121)
    }),
    ("on-the-axis", |z| {
        Step::through([0.0, 0.0, z], [0.0; 3], 70.0)
            .solid(&GLASS, "")
            .sized(161, 121)
    }),
    ("eye-in-replicas", |n| {
        // Wider than its cell and as high: replicas are joined through borders, but for holes.
        let polygon = [
            [0.0, 0.0],
            [0.8, 0.0],
            [0.8, 1.0],
            [0.1, 1.0],
            [0.3, 0.5],
            [0.0, 0.2],
        ];
        let step = Step::through([-0.1, 0.02, 0.06], [1.0, 0.4, 0.5], 70.0);
        step.solid(&polygon, &format!("repeat = {:?}", [n as u32; 3]))
    }),
    ("eye-in-corner", |x| {
        Step::through([x, x, 0.5], [0.0, -0.45, 0.5], 80.0).solid(&cylinder(0.5, 0.1, 0.9), "")
    }),
    ("eye-near-surface", |d| {
        Step::through([0.3 + d, 0.0, 0.5], [0.0, 0.6, 0.5], 60.0).solid(&ball(0.3), "")
    }),
    ("eye-in-solid", |n| {
        let ring = vec![[0.15, 0.3], [0.4, 0.3], [0.4, 0.7], [0.15, 0.7]];
        let (eye, polygon) = match n as u32 {
            0 => (MIDDLE, ball(0.4)),
            1 => ([0.2, 0.1, 0.5], ball(0.4)),
            2 => ([0.02, 0.03, 0.5], ring),
            _ => ([0.05, 0.0, 0.8], GLASS.into()),
        };
        Step::through(eye, [1.0, 0.3, 0.6], 80.0).solid(&polygon, "")
    }),
    ("touching-replicas", |r| {
        let keys = "repeat = [2, 2, 2]\nmirror = [true, false, true]";
        Step::seen(eye(25.0, 2.0), MIDDLE).solid(&cylinder(r, 0.0, 0.8), keys)
    }),
    ("many-cells", |n| {
        let keys = format!("repeat = {:?}", [n as u32, n as u32, 2]);
        spindle(35.0, 1.9, &keys)
    }),
    ("axis-aside", |x| {
        spindle(25.0, 1.9, &format!("axis = {:?}", [x, 0.4]))
    }),
    ("soft-shadows", |n| {
        let keys = |k: u32| {
            let at = [0.5 * f64::from(k) - 0.3, -0.1, 0.0];
            format!("position = {at:?}\nscale = [0.7, 0.7, 0.7]")
        };
        let solids = (0..n as u32).fold(table("soft"), |step, k| step.solid(&SPINDLE, &keys(k)));
        solids.lit([0.55, 0.5, -0.6])
    }),
    ("low-light", |angle| {
        let (s, c) = angle.to_radians().sin_cos();
        let step = table("hard").solid(&SPINDLE, "scale = [0.7, 0.7, 0.7]");
        step.lit([0.8 * c, 0.6 * c, -s])
    }),
    ("self-shadow", |d| {
        let fov = 2.0 * (0.75 / (2.0 * d)).atan().to_degrees();
        let step = Step::through(eye(25.0, 2.0 * d), MIDDLE, fov).with("shadow = \"hard\"");
        step.solid(&ball(0.45), "").lit([-1.0, -0.1, -0.2])
    }),
    ("coinciding", |n| {
        let colors = [[0.9, 0.1, 0.1], [0.1, 0.9, 0.1], [0.1, 0.1, 0.9], [0.9; 3]];
        let empty = Step::seen(eye(25.0, 1.8), MIDDLE);
        colors[..n as usize].iter().fold(empty, |step, color| {
            step.solid(&SPINDLE, &format!("color = {color:?}"))
        })
    }),
];
