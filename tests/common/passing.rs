//! Checks that a picture's hits are first hits. Counts surfaces that a search has missed by more
//! than a texel, and hits that do not exist.

use super::{device, reference, updated};
use rayon::prelude::*;
use revmap::frame::Frame;
use revmap::scene::{CameraFrame, Scene};
use revmap::settings::Settings;
use revmap_offscreen::Offscreen;
use revmap_reference::{Ray, Reference};
use std::iter::Sum;

/// Pixels counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// Hit by the reference.
    pub hits: usize,
    /// Hit by the reference only.
    pub missed: usize,
    /// Hit by the picture only.
    pub ghost: usize,
    /// The ray goes through more than a texel of solid before the picture's hit, or without one.
    pub passed: usize,
    /// The picture's hit is more than a texel off the solid.
    pub made_up: usize,
}

impl Sum for Count {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            hits: a.hits + b.hits,
            missed: a.missed + b.missed,
            ghost: a.ghost + b.ghost,
            passed: a.passed + b.passed,
            made_up: a.made_up + b.made_up,
        })
    }
}

/// Compares a drawn frame with the reference's, pixel by pixel. `texel` is in object units, for
/// solids of scale 1; eyes must be outside of them.
pub fn count(scene: &Scene, truth: &Frame, frame: &Frame, texel: f64) -> Count {
    let solids = Reference::new(scene).unwrap();
    let camera = CameraFrame::new(&scene.camera, truth.width, truth.height).unwrap();
    // F changes along a ray by at most 1 + b per unit of length, with b below 3 here, times the
    // number of cells along an axis of the box.
    let cells = scene.objects.iter().flat_map(|o| o.repeat).max();
    let near = 0.25 * texel / f64::from(cells.unwrap_or(1));
    (0..truth.pixels())
        .into_par_iter()
        .map(|index| {
            let (hit, drawn) = (truth.hits(index), frame.hits(index));
            let mut one = Count {
                hits: usize::from(hit),
                missed: usize::from(hit && !drawn),
                ghost: usize::from(drawn && !hit),
                ..Count::default()
            };
            let (z, z_drawn) = (truth.distance[index], frame.distance[index]);
            if z == z_drawn || f64::from((z - z_drawn).abs()) < near {
                return one;
            }
            let (x, y) = (index as u32 % truth.width, index as u32 / truth.width);
            let ray = Ray {
                origin: scene.camera.eye,
                direction: camera.pixel(x, y).normalize(),
            };
            let t = f64::from(z_drawn);
            let least = solids.clearance_within(ray, [0.0, t], 0.05 * texel);
            one.passed = usize::from(least < -texel);
            if drawn {
                let there = solids.clearance_within(ray, [t, t], 0.05 * texel);
                one.made_up = usize::from(there > texel);
            }
            one
        })
        .sum()
}

/// Counts for scenes that differ only in parameters. Each is drawn with each of the settings, from
/// maps made once, for the first scene.
pub fn counts<const N: usize>(
    scenes: &[Scene],
    settings: [&Settings; N],
    texel: f64,
) -> Vec<[Count; N]> {
    let mut renderers = settings.map(|s| Offscreen::new(device(), &scenes[0], s).unwrap());
    let all = scenes.iter().map(|scene| {
        let truth = reference(scene, settings[0]);
        let frames = renderers.each_mut().map(|r| updated(r, scene));
        frames.map(|frame| count(scene, &truth, &frame, texel))
    });
    let all = all.collect();
    drop(renderers);
    device().check().unwrap();
    all
}
