//! Where solids and eyes are, and how large: what 32-bit numbers cannot tell apart.

use super::{MIDDLE, SPINDLE, ball, case, eye};
use crate::stability::case::{Case, Step, Text};

pub(super) fn cases() -> Vec<Case> {
    vec![
        far_from_origin(),
        far_camera(),
        tiny_and_far(),
        scales(),
        flat(),
        sub_pixel(),
        moved_by_a_thousandth(),
        creeping_offset(),
        many_frames(),
    ]
}

fn far_from_origin() -> Case {
    Case {
        steps: [1e2, 1e3, 1e4, 1e5, 1e6, 1e7]
            .into_iter()
            .map(|x| {
                let text = Text::seen([x + 1.6, x + 0.3, 1.1], [x, x, 0.5])
                    .solid(&SPINDLE, &format!("position = {:?}", [x, x, 0.0]));
                Step::new(x, text.done())
            })
            .collect(),
        ..case(
            "far-from-origin",
            "distance of eye and solid from the origin, units",
            "World coordinates in 32 bits resolve 2^-24 of their size: at 10^6 units a texel is below one step.",
            "The eye is subtracted from each position in 64 bits on the CPU; the device never sees a world coordinate.",
        )
    }
}

fn far_camera() -> Case {
    Case {
        steps: [1e1, 1e2, 1e3, 1e4, 1e5, 1e6]
            .into_iter()
            .map(|d| {
                let e = eye(25.0, d);
                let fov = 2.0 * (0.75 / d).atan().to_degrees();
                Step::new(d, Text::through(e, MIDDLE, fov).solid(&SPINDLE, "").done())
            })
            .collect(),
        ..case(
            "far-camera",
            "distance of the eye, units; the field of view shrinks with it",
            "A ray from a far eye is rounded to 2^-24 of the distance when it comes to the solid, and neighbouring pixels' directions \
             become equal.",
            "Rays start in a plane near the solid; where it is met is found in 64 bits on the CPU, for each instance.",
        )
    }
}

fn tiny_and_far() -> Case {
    Case {
        steps: [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 6e-6]
            .into_iter()
            .map(|s| {
                let e = eye(25.0, 2.0).map(|x| s * x);
                let text = Text::seen([1000.0 + e[0], e[1], e[2]], [1000.0, 0.0, 0.5 * s]).solid(
                    &SPINDLE,
                    &format!("position = [1000.0, 0.0, 0.0]\nscale = {:?}", [s; 3]),
                );
                Step::new(s, text.done())
            })
            .collect(),
        ..case(
            "tiny-and-far",
            "scale of a solid 1000 units from the origin",
            "A solid smaller than a step of its own 32-bit position cannot be placed.",
            "As for far-from-origin.",
        )
    }
}

fn scales() -> Case {
    Case {
        steps: [1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6]
            .into_iter()
            .map(|s| {
                let e = eye(25.0, 2.0).map(|x| s * x);
                let text = Text::seen(e, [0.0, 0.0, 0.5 * s])
                    .solid(&SPINDLE, &format!("scale = {:?}", [s; 3]));
                Step::new(s, text.done())
            })
            .collect(),
        ..case(
            "scale",
            "scale of a solid, its eye scaled alike",
            "Margins and epsilons in world units are too large for small solids and too small for large ones.",
            "Every margin is in object units or relative.",
        )
    }
}

fn flat() -> Case {
    Case {
        steps: [1.0, 10.0, 100.0, 1000.0]
            .into_iter()
            .map(|s| {
                let text = Text::seen([1.5 * s, 0.6 * s, 0.6 * s], [0.0, 0.0, 0.5])
                    .solid(&SPINDLE, &format!("scale = {:?}", [s, s, 1.0]));
                Step::new(s, text.done())
            })
            .collect(),
        ..case(
            "flat",
            "ratio of a solid's width to its height",
            "A ray's direction in object space is as lopsided as the scale: steps and margins taken along it are too long or too short.",
            "Bounds that hold for each axis alone; no direction is normalised.",
        )
    }
}

fn sub_pixel() -> Case {
    Case {
        steps: [2.0, 16.0, 64.0, 256.0, 512.0]
            .into_iter()
            .map(|d| {
                let mut text = Text::seen(eye(10.0, d), MIDDLE);
                // A field of balls, so that some centres of pixels meet one.
                for k in 0..25u32 {
                    let place = |n: u32| 0.08 * d * (f64::from(n) - 2.0);
                    let at = [0.0, place(k % 5), place(k / 5)];
                    text = text.solid(&ball(0.4), &format!("position = {at:?}"));
                }
                Step::new(d, text.done())
            })
            .collect(),
        ..case(
            "sub-pixel",
            "distance of 25 balls, units; from 230 on a ball is smaller than a pixel",
            "A box grown or cut by part of a pixel, or a rasteriser's fill rule, decides whether a small solid is seen.",
            "Rays alone decide; boxes are drawn a twentieth of a pixel too large.",
        )
    }
}

fn moved_by_a_thousandth() -> Case {
    Case {
        steps: (0..8)
            .map(|k| {
                let shift = f64::from(k) * 1e-3 * 0.72 * 2.0 / 120.0;
                let e = eye(20.0, 2.0);
                let text = Text::seen([e[0], e[1] + shift, e[2]], [0.0, shift, 0.5]);
                Step::new(f64::from(k), text.solid(&SPINDLE, "").done())
            })
            .collect(),
        motion: true,
        ..case(
            "creeping-camera",
            "movement of the camera, thousandths of a pixel",
            "A search with a threshold flickers where a thousandth of a pixel decides whether its last step ends within it.",
            "Roots are solved, not approached.",
        )
    }
}

fn creeping_offset() -> Case {
    Case {
        steps: (0..8)
            .map(|k| {
                let by = 1e-4 * f64::from(k);
                let keys = format!(
                    "extend = {:?}\nbevel = {:?}\nchamfer = 0.3",
                    0.02 + by,
                    0.2 + by
                );
                let text = Text::seen(eye(20.0, 2.2), MIDDLE).solid(&SPINDLE, &keys);
                Step::new(f64::from(k), text.done())
            })
            .collect(),
        motion: true,
        ..case(
            "creeping-offset",
            "growth of extension and bevel, ten-thousandths",
            "An outline that is made anew in every frame may be cut into other pieces, or close in one frame and not in the next.",
            "Each outline is exact: pieces that differ lie within the same tolerance.",
        )
    }
}

fn many_frames() -> Case {
    let text = Text::seen(eye(20.0, 2.0), MIDDLE)
        .solid(&SPINDLE, "")
        .done();
    Case {
        steps: [1u32, 10, 100]
            .into_iter()
            .map(|n| Step {
                frame: n,
                ..Step::new(f64::from(n), text.clone())
            })
            .collect(),
        motion: true,
        ..case(
            "many-frames",
            "frames of one renderer until the one that is judged",
            "What one frame leaves behind shows in a later one: a depth, a list, a table that was not made anew.",
            "All that a frame reads is written in it, or does not change.",
        )
    }
}
