//! Boxes: eyes in them, replicas in them, solids as wide as they are.

use super::{GLASS, MIDDLE, Scene, ball, cylinder, eye, spindle};
use crate::stability::case::Step;

pub(super) const SCENES: &[Scene] = &[
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
        spindle(
            35.0,
            1.9,
            &format!("repeat = {:?}", [n as u32, n as u32, 2]),
        )
    }),
    ("axis-aside", |x| {
        spindle(25.0, 1.9, &format!("axis = {:?}", [x, 0.4]))
    }),
];
