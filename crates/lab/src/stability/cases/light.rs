//! Shadows, and objects in one place.

use super::{MIDDLE, SPINDLE, ball, case, cylinder, eye};
use crate::stability::case::{Case, Step, Text};

pub(super) fn cases() -> Vec<Case> {
    vec![soft(), low_light(), self_shadow(), coinciding()]
}

/// A round table of radius 1 whose top is at z = 0.
fn table(text: Text) -> Text {
    text.solid(
        &cylinder(0.5, 0.0, 1.0),
        "position = [0.0, 0.0, -0.1]\nscale = [2.0, 2.0, 0.1]\nspecular = 0.0",
    )
}

fn soft() -> Case {
    Case {
        steps: [1.0, 2.0, 3.0]
            .into_iter()
            .map(|n: f64| {
                let mut text =
                    table(Text::seen([1.3, -1.9, 1.7], [0.1, 0.1, 0.1]).with("shadow = \"soft\""));
                for k in 0..n as u32 {
                    let x = 0.5 * f64::from(k) - 0.3;
                    text = text.solid(
                        &SPINDLE,
                        &format!("position = {:?}\nscale = [0.7, 0.7, 0.7]", [x, -0.1, 0.0]),
                    );
                }
                Step::new(n, text.lit([0.55, 0.5, -0.6]).done())
            })
            .collect(),
        ..case(
            "soft-shadows",
            "solids on a table under a soft light; colours are compared between the stages, as rays to a disc have noise",
            "Objects are read in a loop that lanes leave one by one; a driver that runs them side by side must keep each lane's own.",
            "Loops over casters are the same for all lanes.",
        )
    }
}

fn low_light() -> Case {
    Case {
        steps: [60.0, 20.0, 5.0, 1.0]
            .into_iter()
            .map(|angle: f64| {
                let (s, c) = angle.to_radians().sin_cos();
                let text =
                    table(Text::seen([1.3, -1.9, 1.7], [0.1, 0.1, 0.1]).with("shadow = \"hard\""));
                let text = text.solid(&SPINDLE, "scale = [0.7, 0.7, 0.7]");
                Step::new(angle, text.lit([0.8 * c, 0.6 * c, -s]).done())
            })
            .collect(),
        ..case(
            "low-light",
            "elevation of the light, degrees",
            "A shadow's ray starts off the surface, or it meets the surface; how far moves the shadow by 1 / tan of the elevation.",
            "The start is lifted by roundings of its place, not by texels, where pieces are solved.",
        )
    }
}

fn self_shadow() -> Case {
    Case {
        steps: [1.0, 1e2, 1e4, 1e6]
            .into_iter()
            .map(|d: f64| {
                let fov = 2.0 * (0.75 / (2.0 * d)).atan().to_degrees();
                let text = Text::through(eye(25.0, 2.0 * d), MIDDLE, fov)
                    .with("shadow = \"hard\"")
                    .solid(&ball(0.45), "");
                Step::new(d, text.lit([-1.0, -0.1, -0.2]).done())
            })
            .collect(),
        ..case(
            "self-shadow",
            "distance of the eye, in units of 2; the field of view shrinks with it",
            "A shadow's ray that starts at a rounded point starts in the solid: the surface shades itself in speckles.",
            "Its start is counted from the solid, not from the eye.",
        )
    }
}

fn coinciding() -> Case {
    Case {
        steps: [2.0, 3.0, 4.0]
            .into_iter()
            .map(|n: f64| {
                let mut text = Text::seen(eye(25.0, 1.8), MIDDLE);
                for k in 0..n as u32 {
                    let color = [[0.9, 0.1, 0.1], [0.1, 0.9, 0.1], [0.1, 0.1, 0.9], [0.9; 3]]
                        [k as usize % 4];
                    text = text.solid(&SPINDLE, &format!("color = {color:?}"));
                }
                Step::new(n, text.done())
            })
            .collect(),
        ..case(
            "coinciding",
            "number of equal objects in one place, each of another colour",
            "Equal depths that are computed in two ways differ in the last bit: which object shows is decided pixel by pixel.",
            "The object that comes first in the scene wins.",
        )
    }
}
