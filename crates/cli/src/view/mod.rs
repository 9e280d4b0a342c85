//! `revmap view`: a window with live controls.

mod actions;
mod app;
mod controls;
mod framing;
mod keys;
mod legend;
mod orbit;
mod overlay;
mod picture;
mod saved;
mod screen;
mod search_reload;
mod shown;
mod times;

use clap::Args;
use eframe::egui::{ViewportBuilder, vec2};
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::{DrawStage, SearchSettings, Solver, Tolerance};
use revmap_files::SceneFile;
use std::path::PathBuf;
use std::sync::Arc;

/// Shows a scene in a window: drag to turn, drag with the right button to shift, turn the wheel to
/// go nearer; drop a file to see it; H shows all keys
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap view assets/profiles/rook.svg\n  \
    revmap view assets/profiles/king.svg --studio --color steelblue\n  \
    revmap view assets/scenes/pawn.toml --stage compute --show steps")]
pub struct View {
    #[command(flatten)]
    input: super::reading::Input,
    /// Pixels of the window, across and down
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1200x800", value_parser = super::options::size)]
    size: (u32, u32),
    /// Stage that traces rays
    #[arg(long, value_name = "STAGE", default_value = "fragment", value_parser = super::options::named(&DrawStage::NAMES))]
    stage: DrawStage,
    /// Search for the first hit along a ray; or the folder of another search, which is read again
    /// when a file of it changes
    #[arg(long, value_name = "NAME", default_value = "exact", value_parser = revmap_searches::named)]
    solver: Solver,
    /// Allowed error of silhouettes and depths in pixels; 0 is exact
    #[arg(long, value_name = "PIXELS", default_value = "0.25", value_parser = super::options::tolerance)]
    tolerance: Tolerance,
    #[command(flatten)]
    device: super::options::DeviceChoice,
    #[command(flatten)]
    surroundings: super::options::Surroundings,
    /// Quantity to show: color, depth, normals, steps, or error against the reference
    #[arg(long, value_name = "WHAT", default_value = "color", value_parser = super::options::named(&shown::Inspected::NAMES))]
    show: shown::Inspected,
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
        let scene_file = self.input.scene.clone();
        let outputs = self.input.outline.output();
        let outputs = outputs.and("--screenshot", &self.screenshot, &["png"]);
        let outputs = outputs.and("--times", &self.times, &["csv"]);
        outputs.check(&[&scene_file])?;
        let mut file = SceneFile::open(&scene_file)?;
        let aspect = framing::Framing::new(self.size, app::PANEL as u32).aspect();
        let (scene, studio) = self.surroundings.read(&mut file, &self.input.set, aspect)?;
        outputs.spare(file.files())?;
        self.input.outline.finish(&file, &scene, false)?;
        let search = SearchSettings {
            solver: self.solver,
            tolerance: self.tolerance,
            ..SearchSettings::default()
        };
        let shown = shown::Shown {
            scene,
            studio: studio.map(Arc::new),
            search,
            stage: self.stage,
            inspected: self.show,
        };
        let (title, (width, height)) = (app::title(&scene_file), self.size);
        let mut app = app::App::new(self, file, shown)?;
        let window = eframe::NativeOptions {
            viewport: ViewportBuilder::default()
                .with_title(title)
                .with_inner_size(vec2(width as f32, height as f32)),
            event_loop_builder: screen::event_loop(),
            ..Default::default()
        };
        let shown = &mut app;
        let creator: eframe::AppCreator = Box::new(|cc| {
            shown.begin(&cc.egui_ctx);
            Ok(Box::new(shown))
        });
        eframe::run_native("revmap", window, creator).map_err(|e| {
            let message = screen::refusal(&e.to_string());
            Error::new(ErrorKind::Unsupported, message)
        })?;
        app.end()
    }
}
