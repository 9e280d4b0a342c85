//! `revmap searches`: all searches, and folders for new ones.

use super::output;
use super::render::Steps;
use clap::{Args, Subcommand};
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap::settings::{DrawStage, Solver};
use revmap_bench::plan::method::MethodSettings;
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_bench::report::glossary;
use revmap_compare::{CompareOptions, compare};
use revmap_files::SceneFile;
use revmap_searches::ALL;
use revmap_searches::folder::{self, Folder};
use revmap_searches::manifest::Manifest;
use std::path::{Path, PathBuf};

/// Lists all searches: what each reads, its steps, its parameters, where it comes from
///
/// With a folder: checks its search.toml, compiles its GLSL, and draws a vase in both stages, compared
/// with the reference.
#[derive(Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "Examples:\n  \
    revmap searches\n  \
    revmap searches new mine && revmap searches ./mine\n  \
    revmap render assets/scenes/vase.toml --solver ./mine -o vase.png"
)]
pub struct Searches {
    /// Folders of searches, with values of parameters as in ./mine:omega=1.2
    #[arg(value_name = "FOLDER")]
    folders: Vec<String>,
    /// The Vulkan device that draws [default: the variable REVMAP_DEVICE, else discrete before
    /// integrated before virtual before CPU]
    #[arg(long, value_name = "INDEX_OR_PART_OF_NAME", requires = "folders")]
    device: Option<String>,
    #[command(subcommand)]
    command: Option<New>,
}

#[derive(Subcommand)]
enum New {
    /// Writes a folder to start from: a search that draws, with its description
    New {
        /// The folder; its last part names the search
        name: PathBuf,
    },
}

/// The files of a new folder.
const TEMPLATE: [(&str, &str); 2] = [
    ("search.toml", include_str!("searches/search.toml")),
    ("search.glsl", include_str!("searches/search.glsl")),
];

impl Searches {
    pub fn run(self) -> Result<()> {
        if let Some(New::New { name }) = &self.command {
            return new(name);
        }
        if self.folders.is_empty() {
            for solver in ALL.into_iter().rev() {
                describe(solver)
                    .iter()
                    .for_each(|line| output::result(line));
            }
            return Ok(());
        }
        let mut solvers = Vec::new();
        for name in &self.folders {
            let here = format!("./{name}");
            let solver = folder::load(if folder::is_named(name) { name } else { &here })?;
            folder::compile(solver)?;
            solvers.push(solver);
        }
        let device = MethodDevice::new(Device::open(self.device.as_deref())?)?;
        let mut described: Vec<&Path> = Vec::new();
        for solver in solvers {
            // A folder by other parameters needs no other description.
            let path = folder::of(solver).map(|folder| folder.path.as_path());
            let is_known = path.is_some_and(|path| described.contains(&path));
            described.extend(path);
            let lines = describe(solver);
            let count = if is_known { 1 } else { lines.len() };
            lines[..count].iter().for_each(|line| output::result(line));
            for stage in [DrawStage::Fragment, DrawStage::Compute] {
                let (line, warnings) = try_out(&device, solver, stage)?;
                output::result(&format!("  {:<11} {line}", "drawn"));
                warnings.iter().for_each(|line| output::warn(line));
            }
        }
        Ok(())
    }
}

/// Draws a small picture in one stage. Returns a line about it, and warnings.
fn try_out(
    device: &MethodDevice,
    solver: Solver,
    stage: DrawStage,
) -> Result<(String, Vec<String>)> {
    let text = include_str!("../../../assets/scenes/vase.toml");
    let scene = SceneFile::parse(text, ".")?.scene(&[])?;
    let settings = MethodSettings::default().by(solver).in_stage(stage);
    let settings = settings.sized(320, 240);
    let frame = device.draw(&scene, &settings)?;
    folder::check_frame(solver, &frame)?;
    let truth = revmap_reference::draw(&scene, &(&settings).into(), &|_, _| {})?;
    let errors = compare(&truth, &frame, &CompareOptions::of(1.0 / 512.0))?;
    let mut found = format!(
        "{}, a vase: {} of {} pixels missed, {} beside it",
        stage.name(),
        errors.missed,
        errors.hits,
        errors.ghost,
    );
    let mut warnings = Vec::new();
    if let Some(depth) = errors.depth {
        found += &format!(", depth within {:.2} texels in 99 %", depth.p99);
    } else {
        warnings.push(format!(
            "{solver} hits nothing in the test picture of the {} stage; see which values search returns",
            stage.name()
        ));
        found += "; hits nothing";
    }
    if let Some(steps) = Steps::of(&frame) {
        found += &format!("; {:.1} steps each", steps.mean);
    }
    let most = solver.steps().map(|steps| steps.default);
    let taken = frame.steps.iter().fold(0.0f32, |most, n| most.max(*n));
    if let Some(most) = most.filter(|most| taken > (most + BEYOND) as f32) {
        warnings.push(format!(
            "{solver} made {taken} look-ups for a pixel in the {} stage, but most_steps() is {most}: bound the loop by it",
            stage.name()
        ));
    }
    let line = format!("{found}, {} pixels out of steps", frame.exhausted);
    Ok((line, warnings))
}

/// Look-ups beyond the limit on steps that a search may make, such as those of a last refinement.
const BEYOND: u32 = 32;

/// The lines about a search.
fn describe(solver: Solver) -> Vec<String> {
    let folder = folder::of(solver);
    let published = folder::published(solver);
    let own = folder.map(|f| &f.manifest).or(published.as_ref());
    let reads = own.map_or(if solver.reads_map() { "map" } else { "patches" }, |m| {
        m.reads.name()
    });
    let mut lines = vec![format!("{solver}: {}", glossary::meaning(solver.into()))];
    let mut add = |key: &str, text: String| lines.push(format!("  {key:<11} {text}"));
    add("reads", reads.to_owned());
    if let Some(steps) = solver.steps() {
        let [default, beveled] = [false, true].map(|beveled| steps.of(beveled));
        let bevel = format!(", {beveled} with a bevel");
        let bevel = if beveled == default { "" } else { &bevel };
        add("steps", format!("{default}{bevel}; {} at most", steps.most));
    }
    if let Some(manifest) = own {
        add("draws", draws(manifest));
        for (name, p) in &manifest.parameters {
            let [low, high] = p.range;
            let value = folder
                .and_then(|f| f.values.get(name))
                .unwrap_or(&p.default);
            add(
                "parameter",
                format!("{name} = {value} ({low} to {high}): {}", p.about),
            );
        }
        add("source", manifest.source.clone());
        add("licence", manifest.licence.clone());
    }
    add("from", origin(folder, own.is_some()));
    lines
}

fn draws(manifest: &Manifest) -> String {
    let all = [
        (manifest.bevels, "bevels"),
        (manifest.unsigned, "maps of unsigned distances"),
        (manifest.inside, "eyes inside the solid"),
    ];
    let known = all.iter().filter(|(is, _)| *is).map(|(_, what)| *what);
    match known.collect::<Vec<_>>().join(", ") {
        none if none.is_empty() => "solids without a bevel, from outside".to_owned(),
        known => format!("also {known}"),
    }
}

fn origin(folder: Option<&Folder>, published: bool) -> String {
    match folder {
        Some(f) => format!("the folder {}, files {:016x}", f.path.display(), f.hash),
        None if published => "revmap, for comparison (lab/searches/published)".to_owned(),
        None => "revmap's own (docs/searches.md)".to_owned(),
    }
}

/// Writes a folder to start from.
fn new(path: &Path) -> Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let error = |kind, message: &str| Err(Error::new(kind, message).in_file(path));
    let files = TEMPLATE.map(|(file, text)| (file, text.replace("NAME", &name)));
    if let Err(message) = Manifest::parse(&files[0].1, false) {
        return error(ErrorKind::Usage, &message);
    }
    if ALL.iter().any(|solver| solver.name() == name) {
        let message = format!("{name} is a search of revmap; take another name");
        return error(ErrorKind::Usage, &message);
    }
    if path.exists() {
        return error(ErrorKind::Usage, "exists already; take another name");
    }
    if let Err(e) = std::fs::create_dir_all(path) {
        let message = format!("cannot be made ({e}); choose another place");
        return error(ErrorKind::File, &message);
    }
    for (file, text) in files {
        revmap_files::write_bytes(&path.join(file), text.as_bytes())?;
    }
    let shown = path.display();
    let shown = if path.components().count() > 1 {
        shown.to_string()
    } else {
        format!("./{shown}")
    };
    output::result(&format!(
        "{shown}: a search to start from; draw by it with --solver {shown}"
    ));
    Ok(())
}
