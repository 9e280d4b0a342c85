//! Anti-aliasing: several rays in each pixel, or smoothed silhouettes.

use clap::Args;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap_lab::samples::averaged;

/// How edges are smoothed
#[derive(Args, Clone, Copy, Debug)]
pub struct Samples {
    /// Rays per pixel. Colours are averaged; all other channels come from the middle ray
    #[arg(long = "samples", value_name = "N", default_value = "1", value_parser = super::options::named(&COUNTS))]
    pub count: u32,
    /// Whether pixels that a silhouette cuts are blended by the part that lies beyond it; other
    /// channels than colour stay [default: on, but off with more than one ray per pixel, where an
    /// .exr is written, and in the stage reference]
    #[arg(long, value_name = "WHETHER", value_parser = super::options::named(&SWITCH))]
    pub antialias: Option<bool>,
}

const COUNTS: [(&str, u32); 4] = [("1", 1), ("4", 4), ("16", 16), ("64", 64)];
const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

impl Samples {
    /// Whether silhouettes are smoothed; `exact`: in pictures that others are compared with only
    /// when told.
    pub fn antialias(self, exact: bool) -> bool {
        self.antialias.unwrap_or(self.count == 1 && !exact)
    }

    /// As [`averaged`].
    ///
    /// # Errors
    /// Of `draw`.
    pub fn draw(self, scene: &Scene, draw: impl FnMut(&Scene) -> Result<Frame>) -> Result<Frame> {
        averaged(self.count, scene, draw)
    }
}
