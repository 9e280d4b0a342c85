//! `revmap view`: a window with live controls.

mod actions;
mod app;
mod change;
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

use super::output;
use super::reading::ShownOutline;
use super::studio::Studio;
use clap::Args;
use eframe::egui::{ViewportBuilder, vec2};
use revmap::error::{Error, ErrorKind, Result};
use revmap::scene::Scene;
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
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture, which is read with
    /// profile_read = "auto" and profile_smooth = "auto"
    scene: PathBuf,
    #[command(flatten)]
    outline: ShownOutline,
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
    /// Any key of the scene, as in object.0.bevel=0.4; may be given more than once
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
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
    /// The scene of a file, and the studio around it. The camera is chosen as `render --studio`
    /// chooses it, for the free part of the window.
    fn read(
        &self,
        file: &mut SceneFile,
        sets: &[String],
        framing: &framing::Framing,
    ) -> Result<(Scene, Option<Arc<Studio>>)> {
        let sets = self.surroundings.sets(file, sets);
        let mut scene = file.scene(&sets)?;
        let mut studio = self.surroundings.studio()?;
        if let Some(studio) = studio.as_mut().filter(|_| file.chooses_camera(&sets)) {
            studio.frame(&[(scene.clone(), 0.0)], framing.aspect());
            studio.place_camera(&mut scene);
        }
        Ok((scene, studio.map(Arc::new)))
    }

    pub fn run(self) -> Result<()> {
        output::check(&self.screenshot, "--screenshot", &["png"], &[&self.scene])?;
        let mut file = SceneFile::open(&self.scene)?;
        let framing = framing::Framing::new(self.size, app::PANEL as u32);
        let (scene, studio) = self.read(&mut file, &self.set, &framing)?;
        output::spare(file.files(), &self.screenshot, "--screenshot")?;
        output::check(&self.times, "--times", &["csv"], &[&self.scene])?;
        output::spare(file.files(), &self.times, "--times")?;
        self.outline.check(&self.scene)?;
        self.outline.finish(&file, &scene, false)?;
        let search = SearchSettings {
            solver: self.solver,
            tolerance: self.tolerance,
            ..SearchSettings::default()
        };
        let shown = shown::Shown {
            scene,
            studio,
            search,
            stage: self.stage,
            inspected: self.show,
        };
        let (title, (width, height)) = (app::title(&self.scene), self.size);
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
            let message = format!("no screen ({e}); {}", screen::remedy());
            Error::new(ErrorKind::Unsupported, message)
        })?;
        app.end()
    }
}
