//! Anti-aliasing: several rays in each pixel, or smoothed silhouettes.

use clap::Args;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap_lab::samples::averaged;

/// Smoothing of edges
#[derive(Args, Clone, Copy, Debug)]
pub struct Samples {
    /// Rays per pixel. Colours are averaged; all other channels come from the middle ray
    #[arg(long = "samples", value_name = "N", default_value = "1", value_parser = super::options::named(&COUNTS))]
    pub count: u32,
    /// Blends pixels that a silhouette cuts by the part beyond it; other channels than colour stay
    /// [default: on, but off with more than one ray per pixel, where an .exr is written, and in the
    /// stage reference]
    #[arg(long, value_name = "WHETHER", value_parser = super::options::named(&SWITCH))]
    pub antialias: Option<bool>,
}

const COUNTS: [(&str, u32); 4] = [("1", 1), ("4", 4), ("16", 16), ("64", 64)];
const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

impl Samples {
    /// Returns true if silhouettes are smoothed. With `exact`, for pictures that are compared with
    /// others, they are smoothed only if the option says so.
    pub fn antialias(self, exact: bool) -> bool {
        self.antialias.unwrap_or(self.count == 1 && !exact)
    }

    /// The errors of [`averaged`].
    ///
    /// # Errors
    /// The errors of `draw`.
    pub fn draw(self, scene: &Scene, draw: impl FnMut(&Scene) -> Result<Frame>) -> Result<Frame> {
        averaged(self.count, scene, draw)
    }
}
