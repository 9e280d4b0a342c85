//! Boxes: eyes in them, replicas in them, solids as wide as they are.

use super::{GLASS, MIDDLE, SPINDLE, ball, case, cylinder, eye};
use crate::stability::case::{Case, Step, Text};

pub(super) fn cases() -> Vec<Case> {
    vec![
        eye_in_replicas(),
        corner(),
        eye_near_surface(),
        eye_in_solid(),
        replicas(),
        many_cells(),
        axis_aside(),
    ]
}

fn eye_in_replicas() -> Case {
    Case {
        steps: [1.0, 2.0, 3.0, 4.0]
            .into_iter()
            .map(|n: f64| {
                // Wider than its cell and as high: replicas are joined through the borders of their
                // cells, but for holes in them.
                let keys = format!("repeat = {:?}", [n as u32, n as u32, n as u32]);
                let polygon = [
                    [0.0, 0.0],
                    [0.8, 0.0],
                    [0.8, 1.0],
                    [0.1, 1.0],
                    [0.3, 0.5],
                    [0.0, 0.2],
                ];
                let text = Text::through([-0.1, 0.02, 0.06], [1.0, 0.4, 0.5], 70.0);
                Step::new(n, text.solid(&polygon, &keys).done())
            })
            .collect(),
        ..case(
            "eye-in-replicas",
            "replicas along each axis, around an eye in the solid",
            "A ray that begins in the solid looks for the way out; where two replicas are solid at their border, the border is none.",
            "At a border the next cell is asked whether it is solid there; a wall is drawn only where it is not.",
        )
    }
}

fn corner() -> Case {
    Case {
        steps: [0.3, 0.45, 0.49, 0.499]
            .into_iter()
            .map(|x| {
                let text = Text::through([x, x, 0.5], [0.0, -0.45, 0.5], 80.0);
                Step::new(x, text.solid(&cylinder(0.5, 0.1, 0.9), "").done())
            })
            .collect(),
        ..case(
            "eye-in-corner",
            "x and y of an eye in the corner of the box beside a solid as wide as the box",
            "A search from a box's corner starts within a step of the solid it looks along.",
            "Rays that begin in the box are asked whether they begin in the solid.",
        )
    }
}

fn eye_near_surface() -> Case {
    Case {
        steps: [0.1, 1e-2, 1e-3, 1e-4, 1e-5]
            .into_iter()
            .map(|d| {
                let text = Text::through([0.3 + d, 0.0, 0.5], [0.0, 0.6, 0.5], 60.0);
                Step::new(d, text.solid(&ball(0.3), "").done())
            })
            .collect(),
        ..case(
            "eye-near-surface",
            "distance of the eye from the surface, units",
            "An eye nearer than a texel begins within the tolerance of a search, and hits at once.",
            "Roots are asked for signs, not for nearness.",
        )
    }
}

fn eye_in_solid() -> Case {
    let places = [
        [0.0, 0.0, 0.5],
        [0.2, 0.1, 0.5],
        [0.02, 0.03, 0.5],
        [0.05, 0.0, 0.8],
    ];
    Case {
        steps: places
            .into_iter()
            .zip([0.0, 1.0, 2.0, 3.0])
            .map(|(e, n)| {
                let text = Text::through(e, [1.0, 0.3, 0.6], 80.0);
                let text = match n {
                    0.0 | 1.0 => text.solid(&ball(0.4), ""),
                    2.0 => text.solid(&[[0.15, 0.3], [0.4, 0.3], [0.4, 0.7], [0.15, 0.7]], ""),
                    _ => text.solid(&GLASS, ""),
                };
                Step::new(n, text.done())
            })
            .collect(),
        ..case(
            "eye-in-solid",
            "eye: 0 in the middle of a ball, 1 aside, 2 in the hole of a ring, 3 in a glass",
            "Unsigned distances know no inside; a hull has no front faces around its eye.",
            "The solid's back is seen from within; hulls step back for the box.",
        )
    }
}

fn replicas() -> Case {
    Case {
        steps: [0.3, 0.45, 0.49, 0.5]
            .into_iter()
            .map(|r| {
                let keys = "repeat = [2, 2, 2]\nmirror = [true, false, true]";
                let text = Text::seen(eye(25.0, 2.0), MIDDLE);
                Step::new(r, text.solid(&cylinder(r, 0.0, 0.8), keys).done())
            })
            .collect(),
        ..case(
            "touching-replicas",
            "radius of a solid in cells of half-width 0.5, mirrored along x and z",
            "A step across a cell's border reads the neighbour's distance; where solids touch the border a gap or a wall shows.",
            "Rays go from cell to cell.",
        )
    }
}

fn many_cells() -> Case {
    Case {
        steps: [2.0, 8.0, 32.0]
            .into_iter()
            .map(|n: f64| {
                let keys = format!("repeat = {:?}", [n as u32, n as u32, 2]);
                let text = Text::seen(eye(35.0, 1.9), MIDDLE).solid(&SPINDLE, &keys);
                Step::new(n, text.done())
            })
            .collect(),
        ..case(
            "many-cells",
            "replicas along x and y",
            "A ray that grazes the lattice passes many cells, each with a rounding at its border.",
            "Cells are counted, not added up.",
        )
    }
}

fn axis_aside() -> Case {
    Case {
        steps: [0.5, 0.4, 0.25, 0.1, 0.0]
            .into_iter()
            .map(|x: f64| {
                let keys = format!("axis = {:?}", [x, 0.4]);
                let text = Text::seen(eye(25.0, 1.9), MIDDLE).solid(&SPINDLE, &keys);
                Step::new(x, text.done())
            })
            .collect(),
        ..case(
            "axis-aside",
            "place of the axis in the box, 0.5 in the middle",
            "A solid that its box cuts is open there: the rays that enter in it find no surface.",
            "The cut is closed by the box's face.",
        )
    }
}
