//! Solids that are hard to draw for their outlines, their maps or the pictures on them.

use super::{MIDDLE, Scene, ball, eye, silhouette, spindle};
use crate::case::Step;
use revmap::maps::MapFormat;
use revmap::settings::Settings;
use revmap_compare::mosaic::painted;
use revmap_files::Picture;

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

/// A picture without jumps in which a texel more does not show, but a coarser level does.
pub(super) fn waves() -> Picture {
    let wave = |place: usize, all: u32, turns: f64| {
        let angle = std::f64::consts::TAU * turns * (place as f64 + 0.5) / f64::from(all);
        (160.0 + 90.0 * angle.sin()) as u8
    };
    painted([128, 64], |x, y| {
        [wave(x, 128, 1.0), wave(y, 64, 0.5), wave(x, 128, 2.0), 255]
    })
}

/// A scene whose settings are changed.
fn set(mut step: Step, change: impl FnOnce(&mut Settings)) -> Step {
    change(&mut step.settings);
    step
}

pub(super) const SCENES: &[Scene] = &[
    ("crossing-outline", |elevation| {
        let points = [[0.02, 0.23], [0.35, 0.1], [0.19, 0.14], [0.12, 0.36]];
        let eye = eye(elevation, 1.6);
        Step::through(eye, [0.0, 0.0, 0.25], 30.0)
            .solid(&points, "")
            .sized(400, 300)
    }),
    ("large-outline", |r| {
        let polygon = [[0.0, 0.1], [0.8 * r, 0.1], [0.6 * r, 0.9], [0.0, 0.9]];
        let eye = [1.5 * r, 0.6 * r, 0.6 * r + 0.5];
        Step::seen(eye, MIDDLE).solid(&polygon, &format!("radius = {r:?}"))
    }),
    ("picture-border", |rows| {
        let keys = format!("profile = \"border-{rows}.png\"\nprofile_axis = \"left\"");
        Step::seen(eye(25.0, 1.8), MIDDLE).object(&keys)
    }),
    ("cone-tip", |elevation| {
        // Numbers that 32 bits hold exactly: the middle pixel's ray goes through the tip.
        let cone = [[0.0, 0.25], [0.25, 0.25], [0.0, 0.75]];
        let (s, c) = elevation.to_radians().sin_cos();
        let eye = match elevation {
            0.0 => [2.0, 0.0, 0.75],
            90.0 => [0.0, 0.0, 2.75],
            _ => [2.0 * c, 0.0, 0.75 + 2.0 * s],
        };
        Step::seen(eye, [0.0, 0.0, 0.75])
            .solid(&cone, "")
            .sized(161, 121)
    }),
    ("shallow-lid", |climb| {
        // A jar, near the tip of its lid.
        let tip = 0.6 + climb;
        let jar = [[0.0, 0.1], [0.4, 0.1], [0.4, 0.6], [0.0, tip]];
        Step::through([-1.6, 0.7, 2.2], [0.0, 0.0, tip], 0.7)
            .solid(&jar, "")
            .sized(160, 120)
    }),
    ("thin-discs", |thick| {
        let disc = |k: u32| {
            let z = 0.1 + 0.1 * f64::from(k);
            [[0.05, z], [0.4, z], [0.4, z + thick], [0.05, z + thick]]
        };
        let mut points = vec![[0.0, 0.1]];
        points.extend((0..8).flat_map(disc));
        points.push([0.0, 0.8 + thick]);
        Step::seen([2.0, 0.4, 0.52], MIDDLE).solid(&points, "")
    }),
    ("thin-walls", |wall| {
        let (r, z) = (0.35 - wall, 0.1 + wall);
        let points = [
            [0.0, 0.1],
            [0.35, 0.1],
            [0.35, 0.9],
            [r, 0.9],
            [r, z],
            [0.0, z],
        ];
        Step::seen(eye(35.0, 1.9), MIDDLE).solid(&points, "")
    }),
    ("narrow-rim", |width| {
        // The rim is the last edge of a cell of seven patches that leans outwards as a whole.
        let rim = [0.420326 - 0.494 * width, 0.677196 + 0.869 * width];
        let points = [
            [0.0, 0.113918],
            [0.155462, 0.356134],
            [0.131933, 0.118276],
            [0.158050, 0.103708],
            [0.397365, 0.034788],
            [0.323659, 0.565625],
            [0.420326, 0.677196],
            rim,
            [0.247981, 0.760700],
            [0.111086, 0.883183],
            [0.067088, 0.862553],
            [0.048068, 0.801923],
            [0.030889, 0.580703],
            [0.033079, 0.557485],
        ];
        Step::through([1.393, 0.0, 2.115], [0.041, 0.408, 0.68], 8.0)
            .solid(&points, "")
            .sized(320, 240)
    }),
    ("wide-hollow", |width| {
        let points = [[width, 0.1], [0.2, 0.5], [0.0, 0.9]];
        Step::through([-3.0, 4.4, -2.3], MIDDLE, 8.0)
            .solid(&points, &format!("radius = {width:?}"))
            .sized(200, 150)
    }),
    ("grooves", |texels| {
        let period: f64 = texels / 512.0;
        let count = (0.5 / period).floor().min(128.0) as u32;
        let groove = |k: u32| {
            let z = 0.25 + period * f64::from(k);
            let [half, end] = [z + 0.5 * period, z + period];
            [[0.3, z], [0.3, half], [0.28, half], [0.28, end]]
        };
        let mut points = vec![[0.0, 0.25]];
        points.extend((0..count).flat_map(groove));
        points.push([0.0, 0.25 + period * f64::from(count)]);
        Step::seen(eye(15.0, 1.6), MIDDLE).solid(&points, "")
    }),
    ("bevel", |slope| {
        let depth = 0.2 / slope.max(1.0);
        let keys = format!("bevel = {slope:?}\nchamfer = {depth:?}");
        spindle(30.0, 2.2, &keys)
    }),
    ("extension", |by| {
        spindle(20.0, 2.6, &format!("extend = {by:?}"))
    }),
    ("budget", |n| {
        set(spindle(15.0, 1.9, ""), |s| s.max_steps = Some(n as u32))
    }),
    ("map-rows", |n| {
        set(spindle(15.0, 1.9, ""), |s| s.map_rows = Some(n as u32))
    }),
    ("map-bits", |bits| {
        let format = match bits as u32 {
            8 => MapFormat::Rgba8,
            16 => MapFormat::R16,
            _ => MapFormat::R32,
        };
        set(spindle(15.0, 1.9, ""), |s| s.map_format = format)
    }),
    ("binary-picture", |rows| {
        let keys = format!("profile = \"ball-{rows}.png\"\nprofile_axis = \"left\"");
        let step = Step::seen(eye(15.0, 1.9), MIDDLE).object(&keys);
        set(step, |s| s.map_source = Some(revmap_files::BINARY))
    }),
    ("seam-and-poles", |n| {
        let name = ["planar", "cylindrical", "spherical", "arc"][n as usize];
        let keys = format!("color_map = \"waves.png\"\nprojection = {name:?}\nspecular = 0.0");
        // The seam is at azimuth 180 degrees, a pole above.
        Step::seen([-1.2, 0.1, 1.6], MIDDLE)
            .solid(&ball(0.4), &keys)
            .sized(320, 240)
    }),
];
