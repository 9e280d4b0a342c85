//! Options that take several values, of which every combination is measured.

use super::options::{MethodParser, STAGES, Tracing, named, size, tolerance};
use super::output::usage;
use super::run::Results;
use clap::Args;
use revmap::error::Result;
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{Tolerance, name_of};
use revmap_bench::plan::method::Method;
use revmap_bench::plan::suite::Extent;
use revmap_bench::plan::view::{Framing, View};
use revmap_bench::plan::{self, Overrides};
use revmap_files::SceneFile;
use std::path::{Path, PathBuf};

/// Views and ways of drawing; lists are separated by commas
#[derive(Args, Clone, Debug)]
pub struct Lists {
    /// The scenes, TOML files [default: solids that the program carries]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Pixels across and down [default: 800x600]
    #[arg(long, value_name = "WIDTHxHEIGHT,...", value_delimiter = ',', value_parser = size)]
    pub size: Vec<(u32, u32)>,
    /// Stages in which rays are traced [default: fragment,compute]
    #[arg(long, value_name = "STAGE,...", value_delimiter = ',', value_parser = named(&STAGES))]
    pub stage: Vec<Tracing>,
    /// The searches, meshes among them, and folders of other searches [default: those worth choosing
    /// between; all with --full]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = MethodParser)]
    pub solver: Vec<Method>,
    /// Bounds on the searches' steps [default: each solver's own]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub max_steps: Vec<u32>,
    /// Rows of every shape map [default: each object's map_rows]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=16384))]
    pub map_rows: Vec<u32>,
    /// Sources of distances [default: exact]
    #[arg(long, value_name = "SOURCE,...", value_delimiter = ',', value_parser = named(&revmap_files::MAP_SOURCES))]
    pub map_source: Vec<MapSource>,
    /// How distances are stored on the device [default: r32]
    #[arg(long, value_name = "FORMAT,...", value_delimiter = ',', value_parser = named(&MapFormat::NAMES))]
    pub map_format: Vec<MapFormat>,
    /// Allowed errors of silhouettes and depths in pixels, of searches on patches; 0 is exact
    /// [default: 0 where a plan names none]
    #[arg(long, value_name = "PIXELS,...", value_delimiter = ',', value_parser = tolerance)]
    pub tolerance: Vec<Tolerance>,
    /// Degrees above the horizon from which each scene is looked at [default: a scene's own camera]
    #[arg(long, value_name = "DEGREES,...", value_delimiter = ',', value_parser = elevation)]
    pub elevation: Vec<f64>,
    /// Framing of the views. Whole: as the camera stands; the program's own solids fill 9 to 23 % of
    /// the picture. Close: a narrower field of view, in which the solid's box is a quarter larger
    /// than a picture of 4:3 (44 to 81 %). A close picture takes two to four times as long
    /// [default: whole]
    #[arg(long, value_name = "FRAMING,...", value_delimiter = ',', value_parser = named(&Framing::NAMES))]
    pub framing: Vec<Framing>,
    /// How many of the solids that the program carries: one, three, upright (the first eight) or all
    /// [default: three; one with --quick, all with --full]
    #[arg(long, value_name = "EXTENT", conflicts_with = "scenes", value_parser = named(&Extent::NAMES))]
    pub suite: Option<&'static Extent>,
    /// Passes over all pictures, each with everything made anew: intervals are Student's over them
    /// [default: as time allows, 4 or more, but 2 or more on drivers that compile slowly]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=100))]
    pub passes: Option<u16>,
    /// Frames of each row in a pass [default: as time allows, at least 2]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub rounds: Option<u16>,
    /// No pass begins that would end after so many seconds [default: the plan's limit, else twice the time
    /// that it means to take]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_seconds: Option<u32>,
    /// Any key of the scenes, as in object.0.bevel=0.4; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", requires = "scenes")]
    pub set: Vec<String>,
    #[command(flatten)]
    pub results: Results,
}

impl Lists {
    /// The named values, for a plan to apply.
    ///
    /// # Errors
    /// A scene cannot be read.
    pub fn overrides(&self, quick: bool) -> Result<Overrides> {
        let device = |stage: &Tracing| match stage {
            Tracing::Device(stage) => Some(*stage),
            Tracing::Reference => None, // refused by `check`
        };
        Ok(Overrides {
            quick,
            scenes: self.views()?,
            solids: self.suite.cloned(),
            elevations: self.elevation.clone(),
            framings: self.framing.clone(),
            methods: self.solver.clone(),
            lists: plan::Lists {
                stages: self.stage.iter().filter_map(device).collect(),
                sizes: self.size.clone(),
                max_steps: self.max_steps.clone(),
                map_rows: self.map_rows.clone(),
                map_sources: self.map_source.clone(),
                map_formats: self.map_format.clone(),
                tolerances: self.tolerance.clone(),
            },
            passes: self.passes.map(usize::from),
            rounds: self.rounds.map(usize::from),
            max_seconds: self.max_seconds.map(f64::from),
        })
    }

    /// The files of the scenes, over which no results are written.
    pub fn files(&self) -> Result<Vec<PathBuf>> {
        let mut inputs = Vec::new();
        // A pipe was read already.
        for scene in self.scenes.iter().filter(|scene| scene.is_file()) {
            let mut file = SceneFile::open(scene)?;
            file.scene(&self.set)?;
            inputs.extend(file.files().map(Path::to_path_buf));
        }
        Ok(inputs)
    }

    /// The scenes named, as their cameras are.
    fn views(&self) -> Result<Vec<View>> {
        let mut views = Vec::new();
        for file in &self.scenes {
            let mut read = SceneFile::open(file)?;
            let scene = read.scene(&self.set)?;
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let twin = |other: &PathBuf| other != file && other.file_stem() == file.file_stem();
            // The same name in two folders: the paths tell them apart.
            let name = match self.scenes.iter().any(twin) {
                true => file.to_string_lossy(),
                false => stem,
            };
            let view = View::new(name, scene);
            // A profile whose name is no text has no scene as text.
            views.push(match read.text(&self.set) {
                Ok(text) => view.of_file(&text),
                Err(_) => view,
            });
        }
        Ok(views)
    }

    /// Refuses the reference as a stage beside a picture that it would be compared with.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage).
    pub fn check(&self) -> Result<()> {
        if self.stage.contains(&Tracing::Reference) {
            let name = name_of(&STAGES, &Tracing::Reference);
            let message =
                format!("{name} is what all others are compared with; give fragment or compute");
            return Err(usage("--stage", message));
        }
        Ok(())
    }
}

fn elevation(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if (-90.0..=90.0).contains(&degrees) => Ok(degrees),
        _ => Err("give degrees from -90 to 90".to_owned()),
    }
}
