//! `revmap render`: one frame, off screen.

use super::options::{self, Drawing, Tracing};
use super::progress::Progress;
use super::{output, pipelines};
use clap::Args;
use revmap::error::{Error, Result, Stage};
use revmap::frame::{self, Frame};
use revmap::scene::Scene;
use revmap::scene::file::SceneFile;
use revmap::settings::Planes;
use revmap_lab::method::{Method, MethodSettings};
use revmap_lab::renderer::MethodDevice;
use revmap_reference as reference;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Draws one frame of a scene, off screen
#[derive(Args)]
pub struct Render {
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture
    scene: PathBuf,
    /// Where the picture goes: .png (8-bit sRGB) or .exr (float channels); may be given more than once
    #[arg(long, short, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    #[command(flatten)]
    drawing: Drawing,
}

/// A picture and the words about it.
struct Picture {
    frame: Frame,
    device: String,
    cost: String,
    details: Vec<String>,
}

impl Render {
    pub fn run(self) -> Result<()> {
        output::check(&self.output, "--output", &["png", "exr"], &[&self.scene])?;
        let begin = Instant::now();
        let mut file = SceneFile::open(&self.scene)?;
        let scene = file.scene(&self.drawing.set)?;
        output::spare(file.files(), &self.output, "--output")?;
        let loading = milliseconds(begin);
        let floats = self
            .output
            .iter()
            .any(|file| output::has_ending(file, "exr"));
        // What a search leaves undone is counted beside the planes; that is worth a warning.
        let counted = self.drawing.solver.may_run_out() && !self.drawing.quiet;
        let planes = if floats || self.drawing.verbose || counted {
            Planes::All
        } else {
            Planes::Color
        };
        let settings = self.drawing.settings(planes);
        let picture = match self.drawing.stage {
            Tracing::Reference => self.on_cpu(&scene, &settings)?,
            Tracing::Device(_) => self.on_gpu(&scene, &settings)?,
        };
        let writing = Instant::now();
        for file in &self.output {
            write(&picture.frame, file)?;
        }
        self.tell(&scene, &settings, &picture);
        if self.drawing.verbose {
            output::note(&format!(
                "scene read in {loading:.1} ms, files written in {:.1} ms, {:.1} ms in all",
                milliseconds(writing),
                milliseconds(begin)
            ));
        }
        Ok(())
    }

    fn on_gpu(&self, scene: &Scene, settings: &MethodSettings) -> Result<Picture> {
        let (device, kept) = pipelines::open(self.drawing.device.as_deref())?;
        let report = device.report();
        let progress = Progress::start(&format!("drawing on {}", report.name), self.drawing.quiet);
        let drawn = MethodDevice::new(device.clone())
            .and_then(|device| device.draw(scene, settings))
            .map_err(|e| on(&report.name, e))?;
        drop(progress);
        kept.save(&device);
        Ok(Picture {
            device: format!(
                "{} ({}), driver {}",
                report.name, report.kind, report.driver
            ),
            cost: match drawn.times.gpu_ms {
                Some(gpu) => format!("{gpu:.2} ms on {}", report.name),
                None => format!("{:.2} ms with {}", drawn.times.frame_ms, report.name),
            },
            details: [
                format!(
                    "{:.2} ms from submission to completion",
                    drawn.times.frame_ms
                ),
                format!(
                    "on the device: shape maps (or meshes) {:.2} MB, colour and displacement maps {:.2} MB",
                    drawn.map_bytes[0] as f64 / 1e6,
                    drawn.map_bytes[1] as f64 / 1e6
                ),
            ]
            .into_iter()
            .chain(drawn.notes)
            .collect(),
            frame: drawn.frame,
        })
    }

    fn on_cpu(&self, scene: &Scene, settings: &MethodSettings) -> Result<Picture> {
        let begin = Instant::now();
        let progress = Progress::start("drawing the reference", self.drawing.quiet);
        let frame = reference::draw(scene, &settings.into(), &|done, total| {
            progress.report(done, total)
        })?;
        Ok(Picture {
            frame,
            device: "none, the reference is drawn on the CPU".to_owned(),
            cost: format!("{:.0} ms on the CPU", milliseconds(begin)),
            details: Vec::new(),
        })
    }

    /// What was drawn, on which device, how fast. Said when it is done, so that a failure stays one line.
    fn tell(&self, scene: &Scene, settings: &MethodSettings, picture: &Picture) {
        if self.drawing.quiet {
            return;
        }
        output::note(&format!("device: {}", picture.device));
        if self.drawing.verbose {
            for object in &scene.objects {
                let rows = settings.map_rows.unwrap_or(object.map_rows);
                let columns = (object.profile.radius * f64::from(rows)).ceil();
                output::note(&format!(
                    "{}: shape box of {columns} x {rows} texels",
                    object.name
                ));
            }
            for line in &picture.details {
                output::note(line);
            }
            if let Some(line) = steps(&picture.frame) {
                output::note(&line);
            }
        }
        let drawn = self.drawing.stage != Tracing::Reference;
        let bounded = drawn && settings.method.may_run_out();
        if let Some(line) = exhausted(&picture.frame, bounded && self.drawing.verbose) {
            output::note(&line);
        }
        let stage = options::name_of(&options::STAGES, &self.drawing.stage);
        let how = match self.drawing.stage {
            Tracing::Reference => stage.to_owned(),
            Tracing::Device(_) => format!("{stage}, {}", settings.method),
        };
        for file in &self.output {
            let (name, width, height) = (file.display(), settings.width, settings.height);
            output::result(&format!(
                "{name}: {width}x{height}, {how}, {}",
                picture.cost
            ));
        }
    }
}

fn write(frame: &Frame, file: &Path) -> Result<()> {
    if output::has_ending(file, "exr") {
        frame::write_exr(frame, file)
    } else {
        frame::write_png(frame, file)
    }
}

/// A failure while drawing, with the device's name, which may be the reason.
fn on(device: &str, mut error: Error) -> Error {
    if error.stage == Stage::Draw {
        error.message = format!("{} (on {device})", error.message);
    }
    error
}

/// How many pixels were hit, and what the search spent on them.
fn steps(frame: &Frame) -> Option<String> {
    let hits: Vec<f32> = (frame.steps.iter().zip(&frame.distance))
        .filter(|(_, distance)| distance.is_finite())
        .map(|(steps, _)| *steps)
        .collect();
    if hits.is_empty() {
        return None;
    }
    let share = 100.0 * hits.len() as f64 / frame.distance.len() as f64;
    let mean = hits.iter().map(|s| f64::from(*s)).sum::<f64>() / hits.len() as f64;
    let most = hits.iter().copied().fold(0.0, f32::max);
    Some(format!(
        "{} pixels hit ({share:.1} %), {mean:.2} steps each, {most} at most",
        hits.len()
    ))
}

/// In how many pixels the search ran out of steps, and what helps; without `always`, only where there are any.
fn exhausted(frame: &Frame, always: bool) -> Option<String> {
    match frame.exhausted {
        0 if always => Some("no pixel ran out of steps".to_owned()),
        0 => None,
        count => Some(format!(
            "warning: {count} pixels ran out of steps, and may be wrong; give more with --max-steps, or take --solver {}",
            Method::DEFAULT.name()
        )),
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
