//! `revmap animate`: a turntable, or changing parameters, as numbered pictures or one that moves, with
//! the time of every frame.

use super::moving::{ENDINGS, Format, Playing, Stillness, claim, frames_in, remedy};
use super::options::{Drawing, Surroundings, Tracing};
use super::output::{self, usage};
use super::progress::Progress;
use super::reading::Input;
use super::samples::{Rays, Samples};
use super::studio::Studio;
use super::times::{self, Row};
use super::vary::Vary;
use clap::Args;
use glam::{DQuat, DVec3};
use revmap::error::{ErrorKind, Result};
use revmap::gpu::Device;
use revmap::scene::{Camera, Scene};
use revmap::settings::Planes;
use revmap_bench::plan::method::Edges;
use revmap_bench::plan::method::renderer::{MethodDevice, MethodRenderer};
use revmap_files::scene::blank;
use revmap_files::{Picture, SceneFile};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Draws a turntable or a sweep of parameters, as a moving picture or numbered ones
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap animate pawn.svg --frames 50 --vary object.0.extend=0:0.05 --bounce --studio -o pawn.gif\n  \
    revmap animate pawn.svg --frames 50 --turn 360 --vary object.0.bevel=0:1 --bounce -o pawn.webp\n  \
    revmap animate assets/scenes/chess.toml --frames 36 --turn 360 --turntable -o out/chess\n  \
    revmap animate assets/scenes/pawn.toml --frames 240 --vary object.0.extend=0:0.1")]
pub struct Animate {
    #[command(flatten)]
    input: Input,
    /// Number of frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: u32,
    /// Turns the camera about its target by so many degrees in all. The lights stay where they are
    /// in the scene; those of --studio stay with the camera
    #[arg(long, value_name = "DEGREES")]
    turn: Option<f64>,
    /// Turns the scene in place of the camera: all lights stay with the camera. Once around unless
    /// --turn says otherwise
    #[arg(long)]
    turntable: bool,
    /// Moves a key of the scene from one value to another, as in object.0.extend=0:0.1; numbers or
    /// lists of numbers; may be given more than once
    #[arg(long, value_name = "KEY=FROM:TO")]
    vary: Vec<String>,
    /// There and back: the values of --vary return to the first, and so does a --turn that is no
    /// whole number of turns. The last frame is one step before the first
    #[arg(long)]
    bounce: bool,
    /// One moving picture, which ends in .gif, .webp or .apng; or the folder that frame-0000.png
    /// and so on go into, which is made if it is not there
    #[arg(long, short, value_name = "FILE_OR_DIR")]
    output: Option<PathBuf>,
    /// Replace the frames that the folder of --output holds
    #[arg(long, requires = "output")]
    overwrite: bool,
    #[command(flatten)]
    playing: Playing,
    /// A CSV file for the times of each frame
    #[arg(long, value_name = "FILE")]
    times: Option<PathBuf>,
    #[command(flatten)]
    surroundings: Surroundings,
    #[command(flatten)]
    samples: Samples,
    #[command(flatten)]
    drawing: Drawing,
}

/// Frames of a film by which the studio's camera is chosen.
const FRAMED: u32 = 24;

/// What makes a frame of the file's scene: the keys that vary, and the studio.
type Film<'a> = (&'a [Vary], Option<&'a Studio>);

/// Where pictures go: a moving picture in this format, or a folder.
#[derive(Clone, Copy)]
struct Target<'a> {
    path: &'a Path,
    format: Option<Format>,
}

/// What was drawn.
#[derive(Default)]
struct Drawn {
    rows: Vec<Row>,
    /// Numbers of frames that were read and show nothing, each with the reason.
    blanks: Vec<(u32, String)>,
    /// Frames of a moving picture.
    pictures: Vec<Picture>,
    /// Of the frames that are kept.
    stillness: Stillness,
}

impl Animate {
    pub fn run(self) -> Result<()> {
        let Tracing::Device(_) = self.drawing.stage else {
            return Err(usage(
                "--stage",
                "the reference draws no animations; give fragment or compute",
            ));
        };
        if self.turned().is_some_and(|turn| !turn.is_finite()) {
            return Err(usage("--turn", "is no angle; give degrees"));
        }
        let target = self.destination()?;
        let scene_file = &self.input.scene;
        let outputs = self.input.outline.output();
        let mut outputs = outputs.and("--times", &self.times, &["csv"]);
        let (mut frames, mut old) = (Vec::new(), Vec::new());
        match target {
            Some(Target { format: None, path }) => {
                frames.extend((0..self.frames).map(|n| self.picture(path, n)));
                old = frames_in(path);
            }
            _ => outputs = outputs.and("--output", &self.output, &ENDINGS),
        }
        outputs.check(&[scene_file])?;
        let varied = self.vary.iter().map(|text| Vary::parse(text));
        let varied: Vec<_> = varied.collect::<Result<_>>()?;
        let mut file = SceneFile::open(scene_file)?;
        let studio = self.studio(&mut file, &varied)?;
        let film: Film = (&varied, studio.as_ref());
        let first = self.scene_at(&mut file, film, 0)?;
        let outputs = outputs.and("--output", frames.iter().chain(&old), &[]);
        outputs.spare(file.files())?;
        self.input
            .outline
            .finish(&file, &first, self.drawing.quiet)?;
        let (device, kept) = self.drawing.open()?;
        if let Some(Target { format: None, path }) = target {
            claim(path, &old, self.overwrite)?;
        }
        let what = format!("drawing on {}", device.report().name);
        let progress = Progress::start(&what, self.drawing.quiet);
        let drawn = self.draw(&device, &mut file, film, &first, target, &progress)?;
        device.check()?;
        kept.save(&device);
        if let Some(path) = &self.times {
            times::write(path, &drawn.rows)?;
        }
        if let Some((format, path)) = target.and_then(|t| Some((t.format?, t.path))) {
            progress.say(&format!("writing {}", path.display()));
            self.playing.write(format, path, &drawn.pictures)?;
        }
        drop(progress);
        if !self.drawing.quiet {
            let warnings = self.warnings(&first, &varied, &drawn, target);
            warnings.iter().for_each(|w| output::warn(w));
            self.tell(&device, &drawn.rows, target);
        }
        Ok(())
    }

    /// Checks the output, before any work.
    fn destination(&self) -> Result<Option<Target<'_>>> {
        let path = self.output.as_deref();
        let format = self.playing.check(path, self.frames, self.drawing.size)?;
        let other = ["png", "mp4", "webm", "avi", "mov", "mkv"];
        let is = |ending: &&str| path.is_some_and(|path| output::has_ending(path, ending));
        if other.iter().any(is) {
            let message = format!(
                "is no folder; a moving picture ends in .{}, and a folder of frames is what other programs take",
                ENDINGS.join(", .")
            );
            return Err(usage("--output", message));
        }
        Ok(path.map(|path| Target { path, format }))
    }

    fn warnings(
        &self,
        first: &Scene,
        varied: &[Vary],
        drawn: &Drawn,
        target: Option<Target>,
    ) -> Vec<String> {
        let blanks = &drawn.blanks;
        let mut warnings = self.drawing.warnings(first);
        if self.samples.rays() != Rays::Each(1) && self.output.is_none() {
            warnings.push("--samples: no pictures are kept, and one ray per pixel is drawn; name a folder with --output".to_owned());
        }
        let turn = self.turned().unwrap_or(0.0);
        if self.frames > 1 && turn == 0.0 && !varied.iter().any(Vary::moves) {
            warnings
                .push("nothing moves, so all frames are equal; give --turn or --vary".to_owned());
        } else if self.frames > 1 && blanks.is_empty() && drawn.stillness.stands_still() {
            let step = turn / f64::from(self.frames);
            let turntable = self.turntable && !self.surroundings.studio;
            warnings.push(remedy(first, step, varied, turntable));
        }
        if let Some((n, why)) = blanks.first() {
            let (count, all) = (blanks.len(), self.frames);
            warnings.push(format!(
                "{count} of {all} frames are empty, the first is frame {n}: {why}"
            ));
        }
        let format = target.and_then(|target| target.format);
        if format == Some(Format::Gif) && first.background[3] < 1.0 {
            warnings.push("background: a GIF has no soft edges, so white is behind what is transparent; give another with --set background=[r,g,b,1], or write .webp".to_owned());
        }
        warnings
    }

    /// Draws every frame: the scene is updated and drawn, and it is read back after its times were
    /// measured. Frames of a moving picture are returned.
    fn draw(
        &self,
        device: &Device,
        file: &mut SceneFile,
        film: Film,
        first: &Scene,
        target: Option<Target>,
        progress: &Progress,
    ) -> Result<Drawn> {
        let mut settings = self.drawing.settings(Planes::Color);
        let shown = self.surroundings.studio || target.is_some_and(|t| t.format.is_some());
        let samples = self.samples.or_adaptive(shown, self.drawing.solver);
        // Silhouettes are smoothed only if pictures are written.
        if samples.antialias(false) && target.is_some() {
            settings.edges = Edges::Silhouettes;
        }
        let methods = MethodDevice::new(device.clone())?;
        let mut renderer = methods.renderer(first, &settings)?;
        renderer.offscreen.prewarm()?;
        let adaptive = target.map(|_| samples.adaptive(device, first, &settings));
        let mut adaptive = adaptive.transpose()?.flatten();
        let mut drawn = Drawn::default();
        let (mut compiled, mut rebuilt) = (device.pipelines_compiled(), 0);
        for n in 0..self.frames {
            let scene = self.scene_at(file, film, n)?;
            let mut row = Row::default();
            let mut draw = |renderer: &mut MethodRenderer, scene: &Scene| {
                let start = Instant::now();
                renderer.update(scene)?;
                row.times.prepare_ms += start.elapsed().as_secs_f64() * 1e3;
                row.times.add(renderer.draw()?);
                Ok(())
            };
            if let Some(Target { path, format }) = target {
                let mut frame = samples.draw(&scene, |scene| {
                    draw(&mut renderer, scene)?;
                    renderer.read()
                })?;
                if let Some(adaptive) = &mut adaptive {
                    row.times.add(adaptive.refine(&scene, &mut frame)?.times);
                }
                let picture = match format {
                    Some(format) => format.picture(&frame)?,
                    None => Picture::of(&frame)?,
                };
                drawn.stillness.add(&picture);
                if format.is_some() {
                    drawn.pictures.push(picture);
                } else {
                    let path = self.picture(path, n);
                    picture.write_png(&path).map_err(|e| e.in_file(path))?;
                }
                let why = blank(&scene, &frame);
                drawn.blanks.extend(why.map(|why| (n, why)));
            } else {
                draw(&mut renderer, &scene)?;
                if n == 0 {
                    let why = blank(&scene, &renderer.read()?);
                    drawn.blanks.extend(why.map(|why| (n, why)));
                }
            }
            let counts = (device.pipelines_compiled(), renderer.rebuild_count());
            (row.compiled, row.rebuilt) = (counts.0 - compiled, counts.1 - rebuilt);
            (compiled, rebuilt) = counts;
            drawn.rows.push(row);
            progress.report(n as usize + 1, self.frames as usize);
        }
        Ok(drawn)
    }

    /// The file of frame `n` in a folder.
    fn picture(&self, folder: &Path, n: u32) -> PathBuf {
        // Numbers of one width: names are in the order of the frames.
        let width = (self.frames - 1).to_string().len().max(4);
        folder.join(format!("frame-{n:0width$}.png"))
    }

    /// Degrees by which the camera turns in all.
    fn turned(&self) -> Option<f64> {
        self.turn.or(self.turntable.then_some(360.0))
    }

    /// The studio, if there is one. Its camera sees what a profile becomes in all frames.
    fn studio(&self, file: &mut SceneFile, varied: &[Vary]) -> Result<Option<Studio>> {
        let Some(mut studio) = self.surroundings.studio()? else {
            return Ok(None);
        };
        let keys = varied.iter().map(|v| v.at(0.0));
        let sets: Vec<_> = self.input.set.iter().cloned().chain(keys).collect();
        if file.chooses_camera(&sets) {
            let step = self.frames.div_ceil(FRAMED);
            let frames = (0..self.frames).step_by(step as usize);
            let last = self.frames / if self.bounce { 2 } else { 1 };
            let frames = frames.chain([last.min(self.frames - 1)]);
            let mut scene = |n| self.scene_before_turn(file, varied, n);
            let scenes: Vec<_> = frames.map(&mut scene).collect::<Result<_>>()?;
            studio.frame(&scenes, self.drawing.aspect());
        }
        Ok(Some(studio))
    }

    /// The scene of frame `n`, and the angle by which it turns, radians.
    fn scene_before_turn(
        &self,
        file: &mut SceneFile,
        varied: &[Vary],
        n: u32,
    ) -> Result<(Scene, f64)> {
        // The last frame of a loop is one step before the first is repeated.
        let around = f64::from(n) / f64::from(self.frames);
        let part = match self.bounce {
            true => 1.0 - (1.0 - 2.0 * around).abs(),
            false => f64::from(n) / f64::from((self.frames - 1).max(1)),
        };
        let varying = varied.iter().map(|v| v.at(part));
        let sets: Vec<String> = self.input.set.iter().cloned().chain(varying).collect();
        let sets = self.surroundings.sets(file, &sets);
        let scene = sets.and_then(|sets| file.scene(&sets)).map_err(|mut e| {
            let key = e.key.as_deref().filter(|_| e.kind == ErrorKind::Usage);
            if let Some(v) = varied.iter().find(|v| key == Some(&v.key)) {
                e.key = Some(format!("--vary {}", v.key));
            }
            e
        })?;
        let turn = self.turned().unwrap_or(0.0);
        let returns = self.bounce && turn % 360.0 != 0.0;
        let angle = (turn * if returns { part } else { around }).to_radians();
        Ok((scene, angle))
    }

    fn scene_at(&self, file: &mut SceneFile, (varied, studio): Film, n: u32) -> Result<Scene> {
        let (mut scene, angle) = self.scene_before_turn(file, varied, n)?;
        if let Some(studio) = studio {
            studio.place_camera(&mut scene);
        }
        if self.turned().is_some() {
            let about = turn_about_target(&mut scene.camera, angle);
            if self.turntable {
                let lights = scene.lights.iter_mut();
                lights.for_each(|light| light.direction = about * light.direction);
            }
        }
        if let Some(studio) = studio {
            studio.furnish(&mut scene);
        }
        Ok(scene)
    }

    fn tell(&self, device: &Device, rows: &[Row], target: Option<Target>) {
        output::device(device.report());
        let [times, costs] = times::told(rows, device.pipelines_compiled());
        if self.drawing.verbose {
            output::note(&format!("{times}{costs}"));
        }
        let frames = match rows.len() {
            1 => "1 frame".to_owned(),
            count => format!("{count} frames"),
        };
        output::result(&match target {
            Some(Target { path, format }) if format.is_some() => {
                let bytes = std::fs::metadata(path).map_or(0, |m| m.len());
                let (seconds, size) = (self.playing.seconds(self.frames), size(bytes));
                format!(
                    "{frames}, {seconds:.1} s{}, {size}: {}",
                    self.round(),
                    path.display()
                )
            }
            Some(Target { path, .. }) => format!("{frames}: {}", path.display()),
            None => format!(
                "{frames}, {times}; no pictures are kept (--output FILE.webp or DIR keeps them)"
            ),
        });
    }

    /// What a film shows once, after its length.
    fn round(&self) -> &'static str {
        match self.turned() {
            Some(turn) if turn.abs() == 360.0 => " a turn",
            _ if self.bounce => " there and back",
            _ => "",
        }
    }
}

/// A file's size in words.
fn size(bytes: u64) -> String {
    match bytes {
        0..1000 => format!("{bytes} bytes"),
        1000..1_000_000 => format!("{:.0} KB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// Turns a camera about its target by an angle in radians; returns the turn.
pub fn turn_about_target(camera: &mut Camera, angle: f64) -> DQuat {
    let about = DQuat::from_axis_angle(camera.up.normalize_or(DVec3::Z), angle);
    camera.eye = camera.target + about * (camera.eye - camera.target);
    about
}
