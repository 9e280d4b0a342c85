//! Maps: rows, bits, sources, budgets; and the pictures that cover solids.

use super::{MIDDLE, Scene, ball, eye, spindle};
use crate::mosaic::painted;
use crate::stability::case::Step;
use revmap::maps::MapFormat;
use revmap::settings::Settings;
use revmap_files::Picture;

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
