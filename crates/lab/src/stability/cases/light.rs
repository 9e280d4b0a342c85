//! Shadows, and objects in one place.

use super::{MIDDLE, SPINDLE, Scene, ball, cylinder, eye};
use crate::stability::case::Step;

/// A round table of radius 1 whose top is at z = 0, and a kind of shadow on it.
fn table(shadow: &str) -> Step {
    let keys = "position = [0.0, 0.0, -0.1]\nscale = [2.0, 2.0, 0.1]\nspecular = 0.0";
    Step::seen([1.3, -1.9, 1.7], [0.1, 0.1, 0.1])
        .with(&format!("shadow = {shadow:?}"))
        .solid(&cylinder(0.5, 0.0, 1.0), keys)
}

pub(super) const SCENES: &[Scene] = &[
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
