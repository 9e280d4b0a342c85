//! Outlines that are hard to follow.

use super::{MIDDLE, SPINDLE, case, eye, silhouette};
use crate::stability::case::{Case, Step, Text};
use revmap_files::Picture;

pub(super) fn cases() -> Vec<Case> {
    vec![
        crossing(),
        large(),
        border(),
        tip(),
        thin_discs(),
        thin_walls(),
        grooves(),
        bevels(),
        extensions(),
    ]
}

/// Rows of the pictures that cases name.
pub(super) const PICTURE_ROWS: [u32; 4] = [8, 16, 32, 64];

/// A half profile that is solid up to its right border.
pub(super) fn bordered(rows: u32) -> Picture {
    silhouette(rows / 2, rows, |_, y| y >= rows / 8 && y < rows - rows / 8)
}

/// A half profile of a ball, without grey.
pub(super) fn binary_ball(rows: u32) -> Picture {
    let middle = f64::from(rows) / 2.0;
    silhouette(rows / 2, rows, |x, y| {
        let (dx, dy) = (f64::from(x) + 0.5, f64::from(y) + 0.5 - middle);
        dx.hypot(dy) < 0.8 * middle
    })
}

fn crossing() -> Case {
    let points = [[0.02, 0.23], [0.35, 0.1], [0.19, 0.14], [0.12, 0.36]];
    Case {
        steps: [0.0, 10.0, 25.0, 60.0]
            .into_iter()
            .map(|elevation| {
                let text = Text::through(eye(elevation, 1.6), [0.0, 0.0, 0.25], 30.0);
                Step::new(elevation, text.solid(&points, "").done()).sized(400, 300)
            })
            .collect(),
        ..case(
            "crossing-outline",
            "elevation of the eye, degrees",
            "Where an outline crosses itself, two parts of the solid meet in one circle; a shell that ends in a wall there leaves a \
             sliver between the parts.",
            "Cells whose ends touch another part are found and drawn by the box.",
        )
    }
}

fn large() -> Case {
    Case {
        steps: [1.0, 10.0, 100.0, 1000.0, 10_000.0]
            .into_iter()
            .map(|r| {
                let polygon = [[0.0, 0.1], [0.8 * r, 0.1], [0.6 * r, 0.9], [0.0, 0.9]];
                let text = Text::seen([1.5 * r, 0.6 * r, 0.6 * r + 0.5], MIDDLE);
                Step::new(r, text.solid(&polygon, &format!("radius = {r:?}")).done())
            })
            .collect(),
        ..case(
            "large-outline",
            "radius of the solid, its height being 1",
            "The boundary is solved as a r^2 + k0 + k1 z + k2 z^2: with r of 1000 the terms are 10^6 and cancel to 1.",
            "Pieces are kept about their own middle.",
        )
    }
}

fn border() -> Case {
    Case {
        steps: PICTURE_ROWS
            .into_iter()
            .map(|rows| {
                let keys = format!("profile = \"border-{rows}.png\"\nprofile_axis = \"left\"");
                Step::new(
                    f64::from(rows),
                    Text::seen(eye(25.0, 1.8), MIDDLE).object(&keys).done(),
                )
            })
            .collect(),
        ..case(
            "picture-border",
            "rows of the picture",
            "A smoothed outline bulges past the border of its picture; the box cuts it, and the outer wall is lost.",
            "The outline of a picture is held within the picture's border.",
        )
    }
}

fn tip() -> Case {
    // Numbers that 32 bits hold exactly, in a picture with a middle pixel: its ray goes through the
    // tip to the last bit.
    let cone = [[0.0, 0.25], [0.25, 0.25], [0.0, 0.75]];
    Case {
        steps: [0.0, 30.0, 60.0, 90.0]
            .into_iter()
            .map(|elevation: f64| {
                let (s, c) = elevation.to_radians().sin_cos();
                let e = match elevation {
                    0.0 => [2.0, 0.0, 0.75],
                    90.0 => [0.0, 0.0, 2.75],
                    _ => [2.0 * c, 0.0, 0.75 + 2.0 * s],
                };
                let text = Text::seen(e, [0.0, 0.0, 0.75]).solid(&cone, "").done();
                Step::new(elevation, text).sized(161, 121)
            })
            .collect(),
        ..case(
            "cone-tip",
            "elevation of the eye, degrees; the middle pixel looks at the tip",
            "At the tip of a cone the gradient is zero, and a zero vector has no direction: its normal is NaN.",
            "Where the gradient is zero the normal looks back along the ray.",
        )
    }
}

fn thin_discs() -> Case {
    Case {
        steps: [0.05, 0.02, 0.01, 0.005, 0.002, 0.0005]
            .into_iter()
            .map(|thick| {
                let mut points = vec![[0.0, 0.1]];
                for k in 0..8 {
                    let z = 0.1 + 0.1 * f64::from(k);
                    points.extend([[0.05, z], [0.4, z], [0.4, z + thick], [0.05, z + thick]]);
                }
                points.push([0.0, 0.8 + thick]);
                Step::new(
                    thick,
                    Text::seen([2.0, 0.4, 0.52], MIDDLE)
                        .solid(&points, "")
                        .done(),
                )
            })
            .collect(),
        ..case(
            "thin-discs",
            "thickness of eight discs seen edge on, units",
            "Equal steps go over discs thinner than a step; a map without a texel in a disc does not know it.",
            "The boundary itself is solved: thickness does not matter.",
        )
    }
}

fn thin_walls() -> Case {
    Case {
        steps: [0.1, 0.03, 0.01, 0.003, 0.001, 0.0003]
            .into_iter()
            .map(|wall| {
                let points = [
                    [0.0, 0.1],
                    [0.35, 0.1],
                    [0.35, 0.9],
                    [0.35 - wall, 0.9],
                    [0.35 - wall, 0.1 + wall],
                    [0.0, 0.1 + wall],
                ];
                Step::new(
                    wall,
                    Text::seen(eye(35.0, 1.9), MIDDLE).solid(&points, "").done(),
                )
            })
            .collect(),
        ..case(
            "thin-walls",
            "thickness of a cup's wall, units; a texel is 0.002",
            "A wall thinner than two texels leaves no negative distance in the map: rays go through.",
            "As for thin-discs.",
        )
    }
}

fn grooves() -> Case {
    Case {
        steps: [16.0, 8.0, 4.0, 2.0, 1.0]
            .into_iter()
            .map(|texels| {
                let period: f64 = texels / 512.0;
                let count = (0.5 / period).floor().min(128.0) as u32;
                let mut points = vec![[0.0, 0.25]];
                for k in 0..count {
                    let z = 0.25 + period * f64::from(k);
                    points.extend([[0.3, z], [0.3, z + 0.5 * period]]);
                    points.extend([[0.28, z + 0.5 * period], [0.28, z + period]]);
                }
                points.push([0.0, 0.25 + period * f64::from(count)]);
                Step::new(
                    texels,
                    Text::seen(eye(15.0, 1.6), MIDDLE).solid(&points, "").done(),
                )
            })
            .collect(),
        ..case(
            "grooves",
            "period of rectangular grooves, texels of 512 rows",
            "Grooves narrower than a texel are not in the map.",
            "As for thin-discs; where more than the tables hold is asked, the object falls back to a map and says so.",
        )
    }
}

fn bevels() -> Case {
    Case {
        steps: [0.25, 0.5, 1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|slope: f64| {
                let keys = format!("bevel = {slope:?}\nchamfer = {:?}", 0.2 / slope.max(1.0));
                Step::new(
                    slope,
                    Text::seen(eye(30.0, 2.2), MIDDLE)
                        .solid(&SPINDLE, &keys)
                        .done(),
                )
            })
            .collect(),
        ..case(
            "bevel",
            "slope of a chamfer",
            "A bevelled surface is steeper than distances tell: a step of the distance goes through it.",
            "The offset outline is found exactly.",
        )
    }
}

fn extensions() -> Case {
    Case {
        steps: [-0.2, -0.1, -0.05, 0.0, 0.05, 0.2, 0.6]
            .into_iter()
            .map(|by: f64| {
                let keys = format!("extend = {by:?}");
                Step::new(
                    by,
                    Text::seen(eye(20.0, 2.6), MIDDLE)
                        .solid(&SPINDLE, &keys)
                        .done(),
                )
            })
            .collect(),
        ..case(
            "extension",
            "extension of the surface, units; below -0.17 nothing is left",
            "A solid that grows past its map is cut by it; one that shrinks to nothing leaves an outline without an inside.",
            "The box grows with the offset; an empty outline draws nothing.",
        )
    }
}
