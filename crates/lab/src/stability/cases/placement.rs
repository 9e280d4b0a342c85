//! Where solids and eyes are, and how large: what 32-bit numbers cannot tell apart.

use super::{MIDDLE, SPINDLE, Scene, ball, eye, spindle};
use crate::stability::case::Step;

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
];
