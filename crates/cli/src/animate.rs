//! `revmap animate`: a turntable, or changing parameters, as numbered pictures with the time of
//! every frame.

use super::options::{Drawing, Samples, Tracing};
use super::output::{self, usage};
use super::progress::Progress;
use clap::Args;
use glam::{DQuat, DVec3};
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap::scene::{Camera, Scene};
use revmap::settings::Planes;
use revmap_bench::method::Edges;
use revmap_bench::renderer::{MethodDevice, MethodRenderer};
use revmap_files::SceneFile;
use revmap_files::scene::blank;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Draws a turntable or a sweep of parameters: numbered pictures, and what each frame took
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap animate pawn.svg --frames 36 --turn 360 -o out/pawn\n  \
    revmap animate assets/scenes/pawn.toml --frames 240 --vary object.0.extend=0:0.1")]
pub struct Animate {
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture, which is read with
    /// profile_smooth = "auto"
    scene: PathBuf,
    /// Number of frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// Turns the camera about its target by so many degrees in all
    #[arg(long, value_name = "DEGREES")]
    turn: Option<f64>,
    /// Moves a key of the scene from one value to another, as in object.0.extend=0:0.1; numbers or
    /// lists of numbers; may be given more than once
    #[arg(long, value_name = "KEY=FROM:TO")]
    vary: Vec<String>,
    /// The folder that frame-0000.png and so on go into; it is made if it is not there
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace the frames that the folder of --output holds
    #[arg(long, requires = "output")]
    overwrite: bool,
    /// A CSV file for the times of each frame
    #[arg(long, value_name = "FILE")]
    times: Option<PathBuf>,
    #[command(flatten)]
    samples: Samples,
    #[command(flatten)]
    drawing: Drawing,
}

/// A key whose value changes from frame to frame.
struct Vary {
    key: String,
    from: Vec<f64>,
    to: Vec<f64>,
    list: bool,
}

/// A line of the times.
#[derive(Default)]
struct Row {
    prepare_ms: f64,
    gpu_ms: Option<f64>,
    frame_ms: f64,
    compiled: u64,
    rebuilt: u64,
}

/// The number of a frame that shows nothing, and why.
type Blank = (u32, String);

impl Animate {
    pub fn run(self) -> Result<()> {
        let Tracing::Device(_) = self.drawing.stage else {
            return Err(usage(
                "--stage",
                "the reference draws no animations; give fragment or compute",
            ));
        };
        if self.turn.is_some_and(|turn| !turn.is_finite()) {
            return Err(usage("--turn", "is no angle; give degrees"));
        }
        let moving = ["gif", "webp", "apng", "png", "mp4", "webm", "avi"];
        let ending = self.output.as_ref().and_then(|path| path.extension());
        let mut moving = moving.iter();
        if ending.is_some_and(|ending| moving.any(|name| ending.eq_ignore_ascii_case(name))) {
            let message = "is no folder; give one for frame-0000.png and so on, and join these with another program";
            return Err(usage("--output", message));
        }
        output::check(&self.times, "--times", &["csv"], &[&self.scene])?;
        let varied: Vec<_> = (self.vary.iter())
            .map(|text| Vary::parse(text))
            .collect::<Result<_>>()?;
        let mut file = SceneFile::open(&self.scene)?;
        let first = self.scene_at(&mut file, &varied, 0)?;
        let mut written: Vec<PathBuf> = self.times.iter().cloned().collect();
        written.extend((0..self.frames).filter_map(|n| self.picture(n)));
        let old = self.output.as_deref().map_or(Vec::new(), frames_in);
        output::spare(file.files(), written.iter().chain(&old), "--output")?;
        let (device, kept) = self.drawing.open()?;
        if let Some(folder) = &self.output {
            claim(folder, &old, self.overwrite)?;
        }
        let what = format!("drawing on {}", device.report().name);
        let progress = Progress::start(&what, self.drawing.quiet);
        let (rows, blanks) = self.draw(&device, &mut file, &varied, &first, &progress)?;
        drop(progress);
        device.check()?;
        kept.save(&device);
        if let Some(path) = &self.times {
            write_times(path, &rows)?;
        }
        if !self.drawing.quiet {
            let mut warnings = self.drawing.warnings(&first);
            if self.samples.count > 1 && self.output.is_none() {
                warnings.push("--samples: no pictures are kept, and one ray per pixel is drawn; name a folder with --output".to_owned());
            }
            let moves = |v: &Vary| v.from != v.to;
            if self.frames > 1 && self.turn.unwrap_or(0.0) == 0.0 && !varied.iter().any(moves) {
                warnings.push(
                    "nothing moves, so all frames are equal; give --turn or --vary".to_owned(),
                );
            }
            if let Some((n, why)) = blanks.first() {
                let (count, all) = (blanks.len(), self.frames);
                warnings.push(format!(
                    "{count} of {all} frames are empty, the first is frame {n}: {why}"
                ));
            }
            warnings.iter().for_each(|w| output::warn(w));
        }
        self.tell(&device, &rows);
        Ok(())
    }

    /// Draws every frame: the scene is updated and drawn, and it is read back after its times were
    /// measured. Returns the times, and a warning for each frame that was read and shows nothing.
    fn draw(
        &self,
        device: &Device,
        file: &mut SceneFile,
        varied: &[Vary],
        first: &Scene,
        progress: &Progress,
    ) -> Result<(Vec<Row>, Vec<Blank>)> {
        let mut settings = self.drawing.settings(Planes::Color);
        // Silhouettes are smoothed only if pictures are written.
        if self.samples.antialias(false) && self.output.is_some() {
            settings.edges = Edges::Silhouettes;
        }
        let methods = MethodDevice::new(device.clone())?;
        let mut renderer = methods.renderer(first, &settings)?;
        renderer.offscreen.prewarm()?;
        let (mut rows, mut blanks) = (Vec::new(), Vec::new());
        let (mut compiled, mut rebuilt) = (device.pipelines_compiled(), 0);
        for n in 0..self.frames {
            let scene = self.scene_at(file, varied, n)?;
            let mut row = Row {
                gpu_ms: Some(0.0),
                ..Row::default()
            };
            let mut draw = |renderer: &mut MethodRenderer, scene: &Scene| {
                let start = Instant::now();
                renderer.update(scene)?;
                row.prepare_ms += start.elapsed().as_secs_f64() * 1e3;
                let times = renderer.draw()?;
                row.prepare_ms += times.prepare_ms;
                row.gpu_ms = row.gpu_ms.zip(times.gpu_ms).map(|(a, b)| a + b);
                row.frame_ms += times.frame_ms;
                Ok(())
            };
            match self.picture(n) {
                Some(picture) => {
                    let frame = self.samples.draw(&scene, |scene| {
                        draw(&mut renderer, scene)?;
                        renderer.read()
                    })?;
                    revmap_files::write_png(&frame, picture)?;
                    blanks.extend(blank(&scene, &frame).map(|why| (n, why)));
                }
                None => {
                    draw(&mut renderer, &scene)?;
                    if n == 0 {
                        blanks.extend(blank(&scene, &renderer.read()?).map(|why| (n, why)));
                    }
                }
            }
            let counts = (device.pipelines_compiled(), renderer.rebuild_count());
            (row.compiled, row.rebuilt) = (counts.0 - compiled, counts.1 - rebuilt);
            (compiled, rebuilt) = counts;
            rows.push(row);
            progress.report(n as usize + 1, self.frames as usize);
        }
        Ok((rows, blanks))
    }

    /// The file of frame `n`, if pictures are written.
    fn picture(&self, n: u32) -> Option<PathBuf> {
        let folder = self.output.as_ref()?;
        // Numbers of one width: names are in the order of the frames.
        let width = (self.frames - 1).to_string().len().max(4);
        Some(folder.join(format!("frame-{n:0width$}.png")))
    }

    fn scene_at(&self, file: &mut SceneFile, varied: &[Vary], n: u32) -> Result<Scene> {
        let last = (self.frames - 1).max(1);
        let part = f64::from(n) / f64::from(last);
        let mut sets = self.drawing.set.clone();
        sets.extend(varied.iter().map(|v| v.at(part)));
        let mut scene = file.scene(&sets).map_err(|mut e| {
            let key = e.key.as_deref().filter(|_| e.kind == ErrorKind::Usage);
            if let Some(v) = varied.iter().find(|v| key == Some(&v.key)) {
                e.key = Some(format!("--vary {}", v.key));
            }
            e
        })?;
        if let Some(turn) = self.turn {
            // The last frame is one step before the first is repeated.
            let angle = (turn * f64::from(n) / f64::from(self.frames)).to_radians();
            turn_about_target(&mut scene.camera, angle);
        }
        Ok(scene)
    }

    fn tell(&self, device: &Device, rows: &[Row]) {
        if self.drawing.quiet {
            return;
        }
        output::device(device.report());
        let whole = |r: &Row| r.prepare_ms + r.frame_ms;
        let settled = &rows[rows.len().min(10)..];
        let measured = if settled.is_empty() { rows } else { settled };
        let mut all: Vec<f64> = measured.iter().map(whole).collect();
        all.sort_by(f64::total_cmp);
        let (median, most) = (all[all.len() / 2], all[all.len() - 1]);
        let late: u64 = settled.iter().map(|r| r.compiled).sum();
        let compiled = device.pipelines_compiled();
        let rebuilt: u64 = rows.iter().map(|r| r.rebuilt).sum();
        let (after, of_them) = match settled {
            [] => ("", String::new()),
            _ => (
                " after the tenth",
                format!(", {late} of them after the tenth"),
            ),
        };
        let kept = match self.output {
            Some(_) => "",
            None => "; no pictures are kept (--output DIR keeps them)",
        };
        output::result(&format!(
            "frames: {}; median {median:.2} ms, slowest{after} {most:.2} ms ({:.2} of the median); pipelines compiled: {compiled}{of_them}; surfaces made: {rebuilt}{kept}",
            rows.len(),
            most / median,
        ));
    }
}

/// Turns a camera about its target by an angle in radians.
pub fn turn_about_target(camera: &mut Camera, angle: f64) {
    let about = DQuat::from_axis_angle(camera.up.normalize_or(DVec3::Z), angle);
    camera.eye = camera.target + about * (camera.eye - camera.target);
}

/// Frames in a folder, `frame-` and a number of four digits or more, in order.
fn frames_in(folder: &Path) -> Vec<PathBuf> {
    let is_frame = |path: &PathBuf| {
        let name = path.file_name().and_then(OsStr::to_str);
        let number = name.and_then(|n| n.strip_prefix("frame-")?.strip_suffix(".png"));
        number.is_some_and(|n| n.len() >= 4 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut frames: Vec<_> = paths.filter(is_frame).collect();
    frames.sort();
    frames
}

/// Makes the folder of frames. A folder with frames of an earlier run, `old`, is refused, unless
/// `overwrite`: then they are removed.
fn claim(folder: &Path, old: &[PathBuf], overwrite: bool) -> Result<()> {
    let fail = |message: String| Error::new(ErrorKind::File, message).in_file(folder);
    if !old.is_empty() && !overwrite {
        let message = format!(
            "holds {} frames of an earlier run; choose another folder, or give --overwrite to replace them",
            old.len()
        );
        return Err(usage("--output", message).in_file(folder));
    }
    std::fs::create_dir_all(folder)
        .map_err(|e| fail(format!("cannot be made ({e}); choose another folder")))?;
    let removed = old.iter().try_for_each(std::fs::remove_file);
    removed.map_err(|e| {
        fail(format!(
            "an earlier frame cannot be removed ({e}); choose another folder"
        ))
    })
}

impl Vary {
    fn parse(text: &str) -> Result<Self> {
        let wrong = |what: &str| {
            let example = "write KEY=FROM:TO, as in object.0.extend=0:0.1";
            usage("--vary", format!("{text:?} {what}; {example}"))
        };
        let parts = text.split_once('=');
        let (key, range) = parts.ok_or_else(|| wrong("names no values"))?;
        let parts = range.split_once(':');
        let (from, to) = parts.ok_or_else(|| wrong("has no second value"))?;
        let list = from.trim().starts_with('[');
        let numbers = |text: &str| {
            let inner = text.trim().trim_start_matches('[').trim_end_matches(']');
            let number = |n: &str| n.trim().parse().ok().filter(|n: &f64| n.is_finite());
            let parsed: Option<Vec<f64>> = inner.split(',').map(number).collect();
            parsed.ok_or_else(|| wrong("holds what is no number"))
        };
        let (from, to) = (numbers(from)?, numbers(to)?);
        if from.len() != to.len() {
            return Err(wrong("has lists of two lengths"));
        }
        if !list && from.len() != 1 {
            return Err(wrong(
                "has a comma outside of brackets, and numbers have points",
            ));
        }
        Ok(Self {
            key: key.trim().to_owned(),
            from,
            to,
            list,
        })
    }

    /// The assignment at the fraction `part`, 0 to 1.
    fn at(&self, part: f64) -> String {
        let pairs = self.from.iter().zip(&self.to);
        let values: Vec<f64> = pairs.map(|(a, b)| a + (b - a) * part).collect();
        // Keys of whole numbers take no 10.0.
        let whole = |x: &f64| x.fract() == 0.0 && x.abs() < 1e15;
        let texts = values.iter().map(|x| match whole(x) {
            true => format!("{x}"),
            false => format!("{x:?}"),
        });
        let bare = texts.collect::<Vec<_>>().join(", ");
        let list = format!("[{bare}]");
        format!("{}={}", self.key, if self.list { list } else { bare })
    }
}

fn write_times(path: &Path, rows: &[Row]) -> Result<()> {
    let mut text =
        String::from("frame,prepare_ms,gpu_ms,frame_ms,pipelines_compiled,surfaces_rebuilt\n");
    for (n, row) in rows.iter().enumerate() {
        let gpu = row.gpu_ms.map_or_else(String::new, |ms| format!("{ms:.4}"));
        text += &format!(
            "{n},{:.4},{gpu},{:.4},{},{}\n",
            row.prepare_ms, row.frame_ms, row.compiled, row.rebuilt
        );
    }
    revmap_files::write_bytes(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn keys_move_from_value_to_value() {
        let one = Vary::parse("object.0.extend=0:0.1").unwrap();
        assert_eq!(one.at(0.5), "object.0.extend=0.05");
        let three = Vary::parse("camera.eye=[1, 2, -3]:[0,0,0]").unwrap();
        assert_eq!(three.at(0.0), "camera.eye=[1, 2, -3]");
        for bad in [
            "a",
            "a=1",
            "a=1:b",
            "a=[1,2]:3",
            "a=nan:1",
            "a=0,1:0,2",
            "a=0:0,2",
        ] {
            let error = Vary::parse(bad).err().unwrap();
            assert_eq!(error.kind, ErrorKind::Usage, "{bad}");
        }
    }
}
