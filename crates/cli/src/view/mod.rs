//! `revmap view`: a window with live controls.

mod actions;
mod app;
mod barriers;
mod controls;
mod frames;
mod framing;
mod inspect;
mod keys;
mod legend;
mod memory;
mod orbit;
mod overlay;
mod redraw;
#[cfg(feature = "shaderc")]
mod reload;
mod saved;
mod scene_renderer;
mod screen;
mod screenshot;
mod shown;
mod stage;
mod swapchain;
mod times;
mod traced;
mod vulkan;

use super::output;
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::{DrawStage, SearchSettings, Solver, Tolerance};
use revmap_files::SceneFile;
use std::path::PathBuf;
use winit::event_loop::EventLoop;

/// Shows a scene in a window: drag to turn, drag with the right button to shift, turn the wheel to
/// go nearer; drop a file to see it; H shows all keys
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap view assets/profiles/rook.svg\n  \
    revmap view assets/scenes/pawn.toml --stage compute --show steps")]
pub struct View {
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture, which is read with
    /// profile_smooth = "auto"
    scene: PathBuf,
    /// Pixels of the window, across and down
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1200x800", value_parser = super::options::size)]
    size: (u32, u32),
    /// Stage that traces rays
    #[arg(long, value_name = "STAGE", default_value = "fragment", value_parser = super::options::named(&DrawStage::NAMES))]
    stage: DrawStage,
    /// Search for the first hit along a ray
    #[arg(long, value_name = "NAME", default_value = "exact", value_parser = revmap_searches::named)]
    solver: Solver,
    /// Allowed error of silhouettes and depths in pixels; 0 is exact
    #[arg(long, value_name = "PIXELS", default_value = "0.25", value_parser = super::options::tolerance)]
    tolerance: Tolerance,
    /// The Vulkan device [default: the variable REVMAP_DEVICE, else discrete before integrated
    /// before virtual before CPU]
    #[arg(long, value_name = "INDEX_OR_PART_OF_NAME")]
    device: Option<String>,
    /// Any key of the scene, as in object.0.bevel=0.4; may be given more than once
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Quantity to show: color, depth, normals, steps, or error against the reference
    #[arg(long, value_name = "WHAT", default_value = "color", value_parser = super::options::named(&shown::Inspected::NAMES))]
    show: shown::Inspected,
    /// Draw with the GLSL files of a folder, and with what becomes of them while the window is open
    /// [default folder: that of the source tree]
    #[cfg(feature = "shaderc")]
    #[arg(long, value_name = "DIR", num_args = 0..=1, require_equals = true, default_missing_value = reload::FOLDER)]
    watch_shaders: Option<PathBuf>,
    /// Show so many frames and end
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,
    /// Write the last of these frames as a PNG, with panel and words (the key P writes without)
    #[arg(long, value_name = "FILE", requires = "frames")]
    screenshot: Option<PathBuf>,
    /// Write what each frame cost as CSV when the window closes
    #[arg(long, value_name = "FILE")]
    times: Option<PathBuf>,
}

impl View {
    pub fn run(self) -> Result<()> {
        let files: Vec<_> = self.screenshot.iter().cloned().collect();
        output::check(&files, "--screenshot", &["png"], &[&self.scene])?;
        let mut file = SceneFile::open(&self.scene)?;
        let scene = file.scene(&self.set)?;
        output::spare(file.files(), &files, "--screenshot")?;
        let times: Vec<_> = self.times.iter().cloned().collect();
        output::check(&times, "--times", &["csv"], &[&self.scene])?;
        let search = SearchSettings {
            solver: self.solver,
            tolerance: self.tolerance,
            ..SearchSettings::default()
        };
        let screen = |e| {
            Error::new(
                ErrorKind::Unsupported,
                format!("no screen ({e}); set DISPLAY or WAYLAND_DISPLAY"),
            )
        };
        let events = EventLoop::new().map_err(screen)?;
        let mut shown = shown::Shown::new(scene, search);
        (shown.stage, shown.inspected) = (self.stage, self.show);
        let mut app = app::App::new(self, file, shown, events.create_proxy());
        events.run_app(&mut app).map_err(screen)?;
        app.end()
    }
}
