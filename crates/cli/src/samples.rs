//! Options of the rays of a pixel.

use super::options::named;
use super::output::usage;
use clap::Args;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::Settings;
use revmap_bench::plan::method::{Method, MethodSettings};
use revmap_offscreen::adaptive::Adaptive;
use revmap_offscreen::samples::averaged;

/// Smoothing of edges
#[derive(Args, Clone, Copy, Debug)]
pub struct Samples {
    /// Rays per pixel. Colours are averaged; all other channels come from the middle ray. adaptive: one
    /// ray, and up to 64 more in pixels whose colours they change [default: 1, but adaptive with
    /// --studio and for a moving picture]
    #[arg(long = "samples", value_name = "N", value_parser = named(&RAYS))]
    rays: Option<Rays>,
    /// Blends pixels that a silhouette cuts by the part beyond it; other channels than colour stay
    /// [default: on, but off with more than one ray per pixel, where an .exr is written, and in the
    /// stage reference]
    #[arg(long, value_name = "WHETHER", value_parser = named(&SWITCH))]
    pub antialias: Option<bool>,
}

/// The rays of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rays {
    /// So many in each.
    Each(u32),
    /// More where they change the colour.
    Adaptive,
}

const RAYS: [(&str, Rays); 5] = [
    ("1", Rays::Each(1)),
    ("4", Rays::Each(4)),
    ("16", Rays::Each(16)),
    ("64", Rays::Each(64)),
    ("adaptive", Rays::Adaptive),
];
const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

impl Samples {
    /// These, with adaptive rays if the option is not given, the picture is `shown`, and a search
    /// draws it.
    pub fn or_adaptive(self, shown: bool, method: Method) -> Self {
        let adaptive = shown && method.solver().is_some();
        let rays = self.rays.or(adaptive.then_some(Rays::Adaptive));
        Self { rays, ..self }
    }

    pub fn rays(self) -> Rays {
        self.rays.unwrap_or(Rays::Each(1))
    }

    /// Returns true if silhouettes are smoothed. With `exact`, for pictures that are compared with
    /// others, they are smoothed only if the option says so.
    pub fn antialias(self, exact: bool) -> bool {
        self.antialias
            .unwrap_or(self.rays() == Rays::Each(1) && !exact)
    }

    /// Refuses adaptive rays of the reference, and their picture (`shows`) without them.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage).
    pub fn check(self, reference: bool, shows: bool) -> Result<()> {
        if shows && self.rays() != Rays::Adaptive {
            return Err(usage(
                "--show-rays",
                "all pixels have as many rays; add --samples adaptive",
            ));
        }
        if reference && self.rays() == Rays::Adaptive {
            return Err(usage(
                "--samples",
                "adaptive rays are traced on a device; give 4, 16 or 64 in the stage reference",
            ));
        }
        Ok(())
    }

    /// The rays that each pixel has.
    pub fn count(self) -> u32 {
        match self.rays() {
            Rays::Each(count) => count,
            Rays::Adaptive => 1,
        }
    }

    /// Words for the rays of a picture; none for one ray. `extra`: mean number of adaptive rays.
    pub fn text(self, extra: Option<f64>) -> String {
        match (extra, self.count()) {
            (Some(extra), _) => format!("{:.1} rays per pixel, ", 1.0 + extra),
            (None, 1) => String::new(),
            (None, count) => format!("{count} rays per pixel, "),
        }
    }

    /// What draws more rays where pixels need them, if the option asks for it.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) for meshes; as [`Adaptive::new`].
    pub fn adaptive(
        self,
        device: &Device,
        scene: &Scene,
        settings: &MethodSettings,
    ) -> Result<Option<Adaptive>> {
        if self.rays() != Rays::Adaptive {
            return Ok(None);
        }
        if settings.method.solver().is_none() {
            return Err(usage(
                "--samples",
                "adaptive rays are of searches; give 4, 16 or 64",
            ));
        }
        Adaptive::new(device, scene, &Settings::from(settings)).map(Some)
    }

    /// The errors of [`averaged`].
    ///
    /// # Errors
    /// The errors of `draw`.
    pub fn draw(self, scene: &Scene, draw: impl FnMut(&Scene) -> Result<Frame>) -> Result<Frame> {
        averaged(self.count(), scene, draw)
    }
}
