//! `revmap render`: one frame, off screen.

use super::options::{self, Drawing, Surroundings, Tracing};
use super::progress::Progress;
use super::reading::ShownOutline;
use super::samples::Samples;
use super::{levels, output};
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::{Device, DeviceReport, INSTANCE_BYTES, ObjectCost};
use revmap::scene::{Object, Scene};
use revmap::settings::{Planes, Tolerance, name_of};
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_bench::plan::method::{Edges, Method, MethodSettings};
use revmap_files::SceneFile;
use revmap_offscreen::Times;
use revmap_offscreen::antialias;
use revmap_reference as reference;
use revmap_searches::folder;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Draws one frame of a scene, off screen
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap render assets/scenes/pawn.toml -o pawn.png\n  \
    revmap render assets/profiles/pawn.svg -o pawn.png --samples 16 --set object.0.extend=0.02\n  \
    revmap render assets/scenes/pawn.toml -o truth.exr --stage reference --size 400x300")]
pub struct Render {
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture, which is read with
    /// profile_read = "auto" and profile_smooth = "auto"
    scene: PathBuf,
    #[command(flatten)]
    outline: ShownOutline,
    /// Picture file: .png (8-bit sRGB) or .exr (float channels); may be given more than once
    #[arg(long, short, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    /// Also writes a picture of the level of patches that each pixel was drawn by: blue is exact,
    /// red the coarsest
    #[arg(long, value_name = "FILE.png")]
    levels: Option<PathBuf>,
    /// Also writes a picture of the rays of --samples adaptive: black pixels have one, white ones 65
    #[arg(long, value_name = "FILE.png")]
    show_rays: Option<PathBuf>,
    /// Print one JSON object on standard output in place of text: all that --verbose prints
    #[arg(long, conflicts_with = "quiet")]
    json: bool,
    #[command(flatten)]
    surroundings: Surroundings,
    #[command(flatten)]
    samples: Samples,
    #[command(flatten)]
    drawing: Drawing,
}

/// A picture and its cost.
struct Picture {
    frame: Frame,
    /// `None` for the reference.
    device: Option<DeviceReport>,
    times: Times,
    /// Mean number of adaptive rays of a pixel beside the first.
    extra_rays: Option<f64>,
    map_bytes: [u64; 2],
    notes: Vec<String>,
    costs: Vec<ObjectCost>,
    device_bytes: u64,
    warnings: Vec<String>,
}

impl Render {
    pub fn run(self) -> Result<()> {
        output::check(&self.output, "--output", &["png", "exr"], &[&self.scene])?;
        let pictures = self.output.iter().chain(&self.levels);
        output::check(pictures, "--levels", &["png", "exr"], &[&self.scene])?;
        output::check(&self.levels, "--levels", &["png"], &[])?;
        output::check(&self.show_rays, "--show-rays", &["png"], &[&self.scene])?;
        let reference = self.drawing.stage == Tracing::Reference;
        self.samples.check(reference, self.show_rays.is_some())?;
        self.outline.check(&self.scene)?;
        let begin = Instant::now();
        let progress = Progress::start(
            &format!("reading {}", self.scene.display()),
            self.drawing.quiet,
        );
        let mut file = SceneFile::open(&self.scene)?;
        let studio = self.surroundings.studio()?;
        let sets = self.surroundings.sets(&file, &self.drawing.set);
        let mut scene = file.scene(&sets)?;
        if let Some(mut studio) = studio {
            if file.chooses_camera(&sets) {
                studio.frame(&[(scene.clone(), 0.0)], self.drawing.aspect());
                studio.place_camera(&mut scene);
            }
            studio.furnish(&mut scene);
        }
        drop(progress);
        output::spare(file.files(), &self.output, "--output")?;
        output::spare(file.files(), &self.levels, "--levels")?;
        let silent = self.drawing.quiet || self.json;
        self.outline.finish(&file, &scene, silent)?;
        let loading = milliseconds(begin);
        let floats = self.output.iter().any(|f| output::has_ending(f, "exr"));
        // Searches that run out of steps are counted beside the planes; such pixels cause a
        // warning.
        let solver = self.drawing.solver;
        let other = solver.solver().filter(|s| folder::of(*s).is_some());
        let counted = (solver.may_run_out() || other.is_some()) && !self.drawing.quiet;
        let planes = match floats || self.drawing.verbose || self.json || counted {
            true => Planes::All,
            false => Planes::Color,
        };
        let mut settings = self.drawing.settings(planes);
        // Frames for comparison are exact by default.
        if floats && self.drawing.tolerance.is_none() {
            settings.tolerance = Tolerance::EXACT;
        }
        if self.samples.antialias(floats || reference) {
            settings.edges = Edges::Silhouettes;
        }
        let mut picture = match self.drawing.stage {
            Tracing::Reference => self.on_cpu(&scene, &settings)?,
            Tracing::Device(_) => self.on_gpu(&scene, &settings)?,
        };
        picture.warnings = self.drawing.warnings(&scene);
        picture
            .warnings
            .extend(revmap_files::scene::blank(&scene, &picture.frame));
        picture.warnings.extend(exhausted(&picture.frame));
        let faults = other.and_then(|s| folder::check_frame(s, &picture.frame).err());
        picture.warnings.extend(faults.map(|e| e.to_string()));
        let writing = Instant::now();
        for file in &self.output {
            write(&picture.frame, file)?;
        }
        let spent = [loading, milliseconds(writing), milliseconds(begin)];
        if self.json {
            self.tell_json(&scene, &settings, &picture, spent);
        } else if !self.drawing.quiet {
            self.tell(&scene, &settings, &picture, spent);
        }
        Ok(())
    }

    fn on_gpu(&self, scene: &Scene, settings: &MethodSettings) -> Result<Picture> {
        let (device, kept) = self.drawing.open()?;
        let report = device.report();
        let progress = Progress::start(&format!("drawing on {}", report.name), self.drawing.quiet);
        let drawn = self.drawn(&device, scene, settings, &progress);
        drop(progress);
        let drawn = drawn.map_err(|e| on(&report.name, e))?;
        kept.save(&device);
        Ok(drawn)
    }

    /// Draws the picture, after one whose time includes the driver's compiler. Times are for all
    /// rays together.
    fn drawn(
        &self,
        device: &Device,
        scene: &Scene,
        settings: &MethodSettings,
        progress: &Progress,
    ) -> Result<Picture> {
        let method_device = MethodDevice::new(device.clone())?;
        let mut renderer = method_device.renderer(scene, settings)?;
        let all = 1 + self.samples.count() as usize;
        renderer.draw()?;
        progress.report(1, all);
        let mut times = Vec::new();
        let mut frame = self.samples.draw(scene, |scene| {
            renderer.update(scene)?;
            times.push(renderer.draw()?);
            progress.report(1 + times.len(), all);
            renderer.read()
        })?;
        let mut extra_rays = None;
        if let Some(mut adaptive) = self.samples.adaptive(device, scene, settings)? {
            let refined = adaptive.refine(scene, &mut frame)?;
            times.push(refined.times);
            extra_rays = Some(refined.mean());
            if let Some(file) = &self.show_rays {
                revmap_files::write_png(&refined.picture(&frame), file)?;
            }
        }
        let costs = renderer.offscreen.renderer().object_costs();
        let device_bytes = renderer.device_bytes();
        if let Some(file) = &self.levels {
            // Colours encode levels and are not mixed.
            let settings = MethodSettings {
                edges: Edges::OneRay,
                ..*settings
            };
            let copies = renderer.offscreen.renderer().copy_levels();
            let painted = levels::painted(scene, &costs, &copies);
            let mut renderer = method_device.renderer(&painted, &settings)?;
            renderer.draw()?;
            revmap_files::write_png(&renderer.read()?, file)?;
        }
        device.check()?;
        Ok(Picture {
            frame,
            device: Some(device.report().clone()),
            extra_rays,
            times: Times {
                prepare_ms: times.iter().map(|t| t.prepare_ms).sum(),
                gpu_ms: times.iter().map(|t| t.gpu_ms).sum(),
                frame_ms: times.iter().map(|t| t.frame_ms).sum(),
                submissions: times.iter().map(|t| t.submissions).sum(),
            },
            map_bytes: renderer.map_bytes(),
            notes: renderer.offscreen.renderer().notes().to_vec(),
            costs,
            device_bytes,
            warnings: Vec::new(),
        })
    }

    fn on_cpu(&self, scene: &Scene, settings: &MethodSettings) -> Result<Picture> {
        let begin = Instant::now();
        let progress = Progress::start("drawing the reference", self.drawing.quiet);
        let drawn = settings.into();
        let frame = self.samples.draw(scene, |scene| {
            let mut frame =
                reference::draw(scene, &drawn, &|done, total| progress.report(done, total))?;
            if settings.edges == Edges::Silhouettes {
                antialias::silhouettes(scene, &mut frame)?;
            }
            Ok(frame)
        })?;
        Ok(Picture {
            frame,
            device: None,
            extra_rays: None,
            times: Times {
                frame_ms: milliseconds(begin),
                ..Times::default()
            },
            map_bytes: [0; 2],
            notes: Vec::new(),
            costs: Vec::new(),
            device_bytes: 0,
            warnings: Vec::new(),
        })
    }

    /// Prints the picture's content, device and times. This output comes at the end, so that a
    /// failure is one line.
    fn tell(&self, scene: &Scene, settings: &MethodSettings, picture: &Picture, spent: [f64; 3]) {
        match &picture.device {
            Some(device) => output::device(device),
            None => output::note("device: none, the reference is drawn on the CPU"),
        }
        if self.drawing.verbose {
            self.details(scene, settings, picture, spent);
        }
        picture.warnings.iter().for_each(|w| output::warn(w));
        let stage = name_of(&options::STAGES, &self.drawing.stage);
        let times = picture.times;
        let (how, cost) = match &picture.device {
            None => {
                let cost = format!("{:.0} ms on the CPU", times.frame_ms);
                (stage.to_owned(), cost)
            }
            Some(device) => {
                let cost = match times.gpu_ms {
                    Some(gpu) => format!("{gpu:.2} ms on {}", device.name),
                    None => format!("{:.2} ms with {}", times.frame_ms, device.name),
                };
                (format!("{stage}, {}", settings.method), cost)
            }
        };
        let rays = self.samples.text(picture.extra_rays);
        for file in &self.output {
            let (name, width, height) = (file.display(), settings.width, settings.height);
            output::result(&format!("{name}: {width}x{height}, {how}, {rays}{cost}"));
        }
    }

    /// The additional output of `--verbose`.
    fn details(
        &self,
        scene: &Scene,
        settings: &MethodSettings,
        picture: &Picture,
        [loading, writing, all]: [f64; 3],
    ) {
        for object in &scene.objects {
            let ([columns, rows], name) = (map_size(object, settings), &object.name);
            output::note(&format!("{name}: shape box of {columns} x {rows} texels"));
        }
        if picture.device.is_some() {
            let [shapes, textures] = picture.map_bytes.map(|bytes| bytes as f64 / 1e6);
            let ms = picture.times.frame_ms;
            output::note(&format!("{ms:.2} ms from submission to completion"));
            output::note(&format!(
                "on the device: shape maps (or meshes) {shapes:.2} MB, colour and displacement maps {textures:.2} MB"
            ));
            for (object, cost) in scene.objects.iter().zip(&picture.costs) {
                output::note(&format!("{}: {}", object.name, cost_line(cost)));
            }
            output::note(&format!(
                "on the device in all, without the target: {:.2} MB; {INSTANCE_BYTES} bytes a copy",
                picture.device_bytes as f64 / 1e6
            ));
            picture.notes.iter().for_each(|line| output::note(line));
            if settings.method.may_run_out() && picture.frame.exhausted == 0 {
                output::note("no pixel ran out of steps");
            }
        }
        if let Some(steps) = Steps::of(&picture.frame) {
            output::note(&format!(
                "{} pixels hit ({:.1} %), {:.2} steps each, {} at most",
                steps.hits,
                100.0 * steps.hits as f64 / picture.frame.pixels() as f64,
                steps.mean,
                steps.most
            ));
        }
        output::note(&format!(
            "scene read in {loading:.1} ms, files written in {writing:.1} ms, {all:.1} ms in all"
        ));
    }

    /// The content of [`details`](Self::details), for programs.
    fn tell_json(
        &self,
        scene: &Scene,
        settings: &MethodSettings,
        picture: &Picture,
        [loading, writing, all]: [f64; 3],
    ) {
        let device = picture.device.as_ref();
        let steps = Steps::of(&picture.frame);
        let objects = scene.objects.iter().enumerate().map(|(number, object)| {
            let [columns, rows] = map_size(object, settings);
            let mut all = json!({ "name": object.name, "columns": columns, "rows": rows });
            if let Some(cost) = picture.costs.get(number) {
                all["path"] = json!(format!("{:?}", cost.path).to_lowercase());
                all["level"] = json!(cost.level);
                all["error_pixels"] = json!(cost.error_pixels);
                all["patches"] = json!(cost.patches);
                all["table_bytes"] = json!(cost.table_bytes);
                all["map_bytes"] = json!(cost.map_bytes);
                all["instance_bytes"] = json!(cost.instance_bytes);
            }
            all
        });
        output::json(&json!({
            "files": self.output.iter().map(|f| f.to_string_lossy()).collect::<Vec<_>>(),
            "width": settings.width,
            "height": settings.height,
            "stage": name_of(&options::STAGES, &self.drawing.stage),
            "solver": device.map(|_| settings.method.to_string()),
            "samples": picture.extra_rays.map_or(json!(self.samples.count()), |extra| json!(1.0 + extra)),
            "antialias": settings.edges == Edges::Silhouettes,
            "device": device.map(|d| json!({ "name": d.name, "kind": d.kind, "driver": d.driver })),
            "gpu_ms": picture.times.gpu_ms,
            "frame_ms": picture.times.frame_ms,
            "read_ms": loading,
            "write_ms": writing,
            "total_ms": all,
            "map_bytes": picture.map_bytes[0],
            "texture_bytes": picture.map_bytes[1],
            "device_bytes": picture.device_bytes,
            "tolerance": settings.tolerance.pixels(),
            "objects": objects.collect::<Vec<_>>(),
            "pixels": picture.frame.pixels(),
            "hits": steps.as_ref().map_or(0, |s| s.hits),
            "steps_mean": steps.as_ref().map(|s| s.mean),
            "steps_max": steps.as_ref().map(|s| s.most),
            "exhausted": picture.frame.exhausted,
            "notes": picture.notes,
            "warnings": picture.warnings,
        }));
    }
}

fn write(frame: &Frame, file: &Path) -> Result<()> {
    match output::has_ending(file, "exr") {
        true => revmap_files::write_exr(frame, file),
        false => revmap_files::write_png(frame, file),
    }
}

/// A failure while drawing, with the device's name, since the device may be the reason.
fn on(device: &str, mut error: Error) -> Error {
    use ErrorKind::{DeviceLost, Other, OutOfDeviceMemory, Unsupported};
    if [DeviceLost, Other, OutOfDeviceMemory, Unsupported].contains(&error.kind) {
        error.message = format!("{} (on {device})", error.message);
    }
    error
}

/// An object's draw path and its memory on the device.
fn cost_line(cost: &ObjectCost) -> String {
    let path = format!("{:?}", cost.path).to_lowercase();
    let level = cost.level.map(|level| {
        let error = cost.error_pixels.map(|e| format!("{e:.4}"));
        let (error, patches) = (error.unwrap_or("any number of".into()), cost.patches);
        format!(", level {level} of {patches} patches, silhouettes within {error} pixels")
    });
    let (level, tables) = (level.unwrap_or_default(), cost.table_bytes);
    let (maps, copies) = (cost.map_bytes, cost.instance_bytes);
    format!("{path}{level}; {tables} bytes of tables, {maps} of maps, {copies} of copies")
}

/// Columns and rows of an object's shape box.
fn map_size(object: &Object, settings: &MethodSettings) -> [u32; 2] {
    let rows = settings.map_rows.unwrap_or(object.map_rows);
    [
        (object.profile.radius * f64::from(rows)).ceil() as u32,
        rows,
    ]
}

/// The number of pixels with a hit, and the steps of the search in them.
struct Steps {
    hits: usize,
    mean: f64,
    most: f32,
}

impl Steps {
    /// `None` if there is no hit.
    fn of(frame: &Frame) -> Option<Self> {
        let hits: Vec<f32> = (frame.steps.iter().zip(&frame.distance))
            .filter(|(_, distance)| distance.is_finite())
            .map(|(steps, _)| *steps)
            .collect();
        (!hits.is_empty()).then(|| Self {
            hits: hits.len(),
            mean: hits.iter().map(|s| f64::from(*s)).sum::<f64>() / hits.len() as f64,
            most: hits.iter().copied().fold(0.0, f32::max),
        })
    }
}

/// The number of pixels in which the search ran out of steps, and the remedy; `None` if there are
/// none.
fn exhausted(frame: &Frame) -> Option<String> {
    let (count, default) = (frame.exhausted, Method::DEFAULT.name());
    (count > 0).then(|| {
        format!("{count} pixels ran out of steps, and may be wrong; give more with --max-steps, or take --solver {default}")
    })
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
