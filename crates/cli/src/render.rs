//! `revmap render`: one frame, off screen.

use super::options::{self, Drawing, Surroundings, Tracing};
use super::progress::Progress;
use super::reading::Input;
use super::samples::Samples;
use super::{levels, output};
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::{Device, DeviceReport, ObjectCost};
use revmap::scene::Scene;
use revmap::settings::{Planes, Tolerance, name_of};
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_bench::plan::method::{Edges, Method, MethodSettings};
use revmap_files::SceneFile;
use revmap_offscreen::Times;
use revmap_offscreen::antialias;
use revmap_reference as reference;
use revmap_searches::folder;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

/// Draws one frame of a scene, off screen
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap render assets/scenes/pawn.toml -o pawn.png\n  \
    revmap render assets/profiles/pawn.svg -o pawn.png --samples 16 --set object.0.extend=0.02\n  \
    revmap render assets/scenes/pawn.toml -o truth.exr --stage reference --size 400x300")]
pub struct Render {
    #[command(flatten)]
    input: Input,
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
    work: DeviceWork,
}

/// What the device did for a picture, and the memory that it took.
#[derive(Default)]
struct DeviceWork {
    /// Mean number of adaptive rays of a pixel beside the first.
    extra_rays: Option<f64>,
    map_bytes: [u64; 2],
    notes: Vec<String>,
    costs: Vec<ObjectCost>,
    device_bytes: u64,
}

impl Render {
    pub fn run(mut self) -> Result<()> {
        let outputs = self.input.outline.output();
        let outputs = outputs
            .and("--output", &self.output, &["png", "exr"])
            .and("--levels", &self.levels, &["png"])
            .and("--show-rays", &self.show_rays, &["png"]);
        outputs.check(&[&self.input.scene])?;
        let reference = self.drawing.stage == Tracing::Reference;
        let floats = self.output.iter().any(|f| output::has_ending(f, "exr"));
        let shown = self.surroundings.studio && !reference && !floats;
        self.samples = self.samples.or_adaptive(shown, self.drawing.solver);
        self.samples.check(reference, self.show_rays.is_some())?;
        let begin = Instant::now();
        let reading = format!("reading {}", self.input.scene.display());
        let progress = Progress::start(&reading, self.drawing.quiet);
        let mut file = SceneFile::open(&self.input.scene)?;
        let (sets, aspect) = (&self.input.set, self.drawing.aspect());
        let (mut scene, studio) = self.surroundings.read(&mut file, sets, aspect)?;
        if let Some(studio) = studio {
            studio.furnish(&mut scene);
        }
        drop(progress);
        outputs.spare(file.files())?;
        let silent = self.drawing.quiet || self.json;
        self.input.outline.finish(&file, &scene, silent)?;
        let loading = milliseconds(begin);
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
        let picture = match self.drawing.stage {
            Tracing::Reference => self.on_cpu(&scene, &settings)?,
            Tracing::Device(_) => self.on_gpu(&scene, &settings)?,
        };
        let mut warnings = self.drawing.warnings(&scene);
        warnings.extend(revmap_files::scene::blank(&scene, &picture.frame));
        warnings.extend(exhausted(&picture.frame));
        let faults = other.and_then(|s| folder::check_frame(s, &picture.frame).err());
        warnings.extend(faults.map(|e| e.to_string()));
        let writing = Instant::now();
        for file in &self.output {
            match output::has_ending(file, "exr") {
                true => revmap_files::write_exr(&picture.frame, file)?,
                false => revmap_files::write_png(&picture.frame, file)?,
            }
        }
        let spent = [loading, milliseconds(writing), milliseconds(begin)];
        let facts = || self.facts(&scene, &settings, &picture, spent);
        if self.json {
            let mut facts = facts();
            facts["warnings"] = json!(warnings);
            output::json(&facts);
        } else if !self.drawing.quiet {
            match &picture.device {
                Some(device) => output::device(device),
                None => output::note("device: none, the reference is drawn on the CPU"),
            }
            if self.drawing.verbose {
                details(&facts());
            }
            warnings.iter().for_each(|w| output::warn(w));
            self.tell(&settings, &picture);
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
        let (mut times, mut count) = (Times::default(), 1);
        let mut frame = self.samples.draw(scene, |scene| {
            renderer.update(scene)?;
            times.add(renderer.draw()?);
            count += 1;
            progress.report(count, all);
            renderer.read()
        })?;
        let mut extra_rays = None;
        if let Some(mut adaptive) = self.samples.adaptive(device, scene, settings)? {
            let refined = adaptive.refine(scene, &mut frame)?;
            times.add(refined.times);
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
            times,
            work: DeviceWork {
                extra_rays,
                map_bytes: renderer.map_bytes(),
                notes: renderer.offscreen.renderer().notes().to_vec(),
                costs,
                device_bytes,
            },
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
        let times = Times {
            frame_ms: milliseconds(begin),
            ..Times::default()
        };
        Ok(Picture {
            frame,
            device: None,
            times,
            work: DeviceWork::default(),
        })
    }

    /// Prints a line for each file: its size, how it was drawn, and the time of that.
    fn tell(&self, settings: &MethodSettings, picture: &Picture) {
        let stage = name_of(&options::STAGES, &self.drawing.stage);
        let times = picture.times;
        let (method, cost) = match (&picture.device, times.gpu_ms) {
            (None, _) => (
                String::new(),
                format!("{:.0} ms on the CPU", times.frame_ms),
            ),
            (Some(device), gpu) => {
                let cost = match gpu {
                    Some(gpu) => format!("{gpu:.2} ms on {}", device.name),
                    None => format!("{:.2} ms with {}", times.frame_ms, device.name),
                };
                (format!(", {}", settings.method), cost)
            }
        };
        let rays = self.samples.text(picture.work.extra_rays);
        let (width, height) = (settings.width, settings.height);
        for file in &self.output {
            let name = file.display();
            output::result(&format!(
                "{name}: {width}x{height}, {stage}{method}, {rays}{cost}"
            ));
        }
    }

    /// What `--json` and `--verbose` print.
    fn facts(
        &self,
        scene: &Scene,
        settings: &MethodSettings,
        picture: &Picture,
        [loading, writing, all]: [f64; 3],
    ) -> Value {
        let (device, work) = (picture.device.as_ref(), &picture.work);
        let steps = Steps::of(&picture.frame);
        let objects = scene.objects.iter().enumerate().map(|(number, object)| {
            let rows = settings.map_rows.unwrap_or(object.map_rows);
            // Of the shape box.
            let columns = (object.profile.radius * f64::from(rows)).ceil() as u32;
            let mut all = json!({ "name": object.name, "columns": columns, "rows": rows });
            if let Some(cost) = work.costs.get(number) {
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
        json!({
            "files": self.output.iter().map(|f| f.to_string_lossy()).collect::<Vec<_>>(),
            "width": settings.width,
            "height": settings.height,
            "stage": name_of(&options::STAGES, &self.drawing.stage),
            "solver": device.map(|_| settings.method.to_string()),
            "samples": work.extra_rays.map_or(json!(self.samples.count()), |extra| json!(1.0 + extra)),
            "antialias": settings.edges == Edges::Silhouettes,
            "device": device.map(|d| json!({ "name": d.name, "kind": d.kind, "driver": d.driver })),
            "gpu_ms": picture.times.gpu_ms,
            "frame_ms": picture.times.frame_ms,
            "read_ms": loading,
            "write_ms": writing,
            "total_ms": all,
            "map_bytes": work.map_bytes[0],
            "texture_bytes": work.map_bytes[1],
            "device_bytes": work.device_bytes,
            "tolerance": settings.tolerance.pixels(),
            "objects": objects.collect::<Vec<_>>(),
            "pixels": picture.frame.pixels(),
            "hits": steps.as_ref().map_or(0, |s| s.hits),
            "steps_mean": steps.as_ref().map(|s| s.mean),
            "steps_max": steps.as_ref().map(|s| s.most),
            "exhausted": picture.frame.exhausted,
            "notes": work.notes,
        })
    }
}

/// Prints facts in lines, and each member of a list in a line of its own.
fn details(facts: &Value) {
    for (key, value) in facts.as_object().into_iter().flatten() {
        let alone = std::slice::from_ref(value);
        let members = value.as_array().map_or(alone, Vec::as_slice);
        for one in members {
            output::note(&format!("{key}: {one}"));
        }
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

/// The number of pixels with a hit, and the steps of the search in them.
pub struct Steps {
    hits: usize,
    pub mean: f64,
    most: f32,
}

impl Steps {
    /// `None` if there is no hit.
    pub fn of(frame: &Frame) -> Option<Self> {
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
