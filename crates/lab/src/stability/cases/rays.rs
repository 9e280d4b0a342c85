//! Rays that barely touch, and rays along axes.

use super::{GLASS, MIDDLE, SPINDLE, ball, case, cylinder};
use crate::stability::case::{Case, Step, Text};

pub(super) fn cases() -> Vec<Case> {
    vec![
        grazing_face(),
        grazing_flank(),
        grazing_ball(),
        along_axes(),
        on_the_axis(),
    ]
}

const ANGLES: [f64; 5] = [10.0, 1.0, 0.1, 0.01, 0.0];

fn grazing_face() -> Case {
    Case {
        steps: ANGLES
            .into_iter()
            .map(|angle: f64| {
                let up = 2.0 * angle.to_radians().tan();
                let text = Text::through([2.0, 0.0, 0.6 + up], [0.0, 0.0, 0.6], 26.0);
                Step::new(angle, text.solid(&cylinder(0.4, 0.2, 0.6), "").done()).sized(161, 121)
            })
            .collect(),
        ..case(
            "grazing-face",
            "angle between the view and a level face, degrees",
            "A search that steps by the distance takes about pi sqrt(2 rho / delta) steps to pass a surface at distance delta; along a \
             face the budget ends first.",
            "One quadratic for each piece: no steps.",
        )
    }
}

fn grazing_flank() -> Case {
    let flank = |angle: f64| {
        // Along the flank of a cone of base 0.4 and height 0.8, `angle` degrees above it.
        let slope = (0.8f64 / 0.4).atan() - angle.to_radians();
        [0.4 + 2.0 * slope.cos(), 0.0, 0.1 - 2.0 * slope.sin()]
    };
    Case {
        steps: ANGLES
            .into_iter()
            .map(|angle| {
                let text = Text::through(flank(angle), [0.2, 0.0, 0.5], 26.0);
                let cone = [[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]];
                Step::new(angle, text.solid(&cone, "").done()).sized(161, 121)
            })
            .collect(),
        ..case(
            "grazing-flank",
            "angle between the view and the flank of a cone, degrees",
            "As for grazing-face; and the two roots of the quadratic fall together.",
            "The root is taken in the form that does not cancel.",
        )
    }
}

fn grazing_ball() -> Case {
    Case {
        steps: [1.0, 0.1, 0.01, 0.001]
            .into_iter()
            .map(|delta: f64| {
                // All pixels look past the rim, at most `delta` from it.
                let fov = 2.0 * (delta / 2.0).atan().to_degrees();
                let text = Text::through([2.0, 0.4, 0.5], [0.0, 0.4, 0.5], fov);
                Step::new(delta, text.solid(&ball(0.4), "").done())
            })
            .collect(),
        ..case(
            "grazing-rim",
            "width of a picture of a ball's rim, units",
            "As for grazing-face: the nearer the rays are to the rim, the more steps they take.",
            "As for grazing-face.",
        )
    }
}

fn along_axes() -> Case {
    let eyes = [
        [2.0, 0.0, 0.5],
        [0.0, -2.0, 0.5],
        [0.0, 0.0, 2.5],
        [0.0, 0.0, -1.5],
        [2.0, 0.0, 0.95],
        [2.0, 0.0, 0.05],
    ];
    Case {
        steps: eyes
            .into_iter()
            .zip([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
            .map(|(e, n)| {
                let target = if n > 3.0 { [0.0, 0.0, e[2]] } else { MIDDLE };
                let text = Text::seen(e, target).solid(&SPINDLE, "").done();
                Step::new(n, text).sized(161, 121)
            })
            .collect(),
        ..case(
            "along-axes",
            "view: 0 along x, 1 along y, 2 down, 3 up, 4 and 5 level with a face",
            "A direction with a zero component divides by zero; a ray level with a face is in it or not by a rounding.",
            "Zero components are set apart; a level ray meets no level face.",
        )
    }
}

fn on_the_axis() -> Case {
    Case {
        steps: [2.0, 1.2, 0.96, 0.9, 0.7, 0.5]
            .into_iter()
            .map(|z| {
                let text = Text::through([0.0, 0.0, z], [0.0, 0.0, 0.0], 70.0);
                Step::new(z, text.solid(&GLASS, "").done()).sized(161, 121)
            })
            .collect(),
        ..case(
            "on-the-axis",
            "height of an eye on the axis that looks down into a glass",
            "On the axis r has no direction and 1 / r no value: steps and normals that divide by r fail.",
            "The quadratic is in r^2.",
        )
    }
}
