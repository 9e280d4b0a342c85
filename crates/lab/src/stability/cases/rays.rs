//! Rays that barely touch, and rays along axes.

use super::{GLASS, MIDDLE, SPINDLE, Scene, ball, cylinder};
use crate::stability::case::Step;

pub(super) const SCENES: &[Scene] = &[
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
];
