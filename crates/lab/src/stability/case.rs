//! A case of the catalogue.

use revmap::error::Result;
use revmap::maps::{MapFormat, MapSource};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Solver};
use revmap_files::SceneFile;
use revmap_searches::CIRCLE;
use std::fmt::Write;
use std::path::Path;

/// One way in which methods break, swept over the parameter that decides.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is swept, with its unit.
    pub parameter: &'static str,
    /// What breaks, and why.
    pub why: &'static str,
    /// What cures it.
    pub cure: &'static str,
    /// Its scenes, in the order of the parameter.
    pub steps: Vec<Step>,
    /// What the default is known to fail, each with its reason.
    pub known: Vec<Known>,
    /// Whether its scenes are the frames of a motion, between which no pixel may flicker.
    pub motion: bool,
}

/// One scene of a case.
#[derive(Clone, Debug)]
pub struct Step {
    /// The parameter's value.
    pub value: f64,
    /// The scene as TOML; paths are relative to the folder that holds the case's files.
    pub scene: String,
    /// Pixels across and down.
    pub size: (u32, u32),
    /// Bound on the steps of searches; `None`: each solver's own.
    pub max_steps: Option<u32>,
    /// Rows of shape maps; `None`: each object's own.
    pub map_rows: Option<u32>,
    /// Source of distances.
    pub map_source: Option<MapSource>,
    /// Storage of distances.
    pub map_format: MapFormat,
    /// Which of its frames is judged: the first, or a later one of the same renderer.
    pub frame: u32,
}

/// Part of a case that the default is known to fail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// The stage; `None`: both.
    pub stage: Option<DrawStage>,
    /// The values of the parameter for which it fails, both ends included.
    pub values: [f64; 2],
    /// Why it is not cured.
    pub reason: &'static str,
}

impl Case {
    /// What is known of the default in a stage, at a value of the parameter.
    #[must_use]
    pub fn known(&self, stage: DrawStage, value: f64) -> Option<&Known> {
        self.known.iter().find(|k| {
            k.stage.is_none_or(|s| s == stage) && (k.values[0]..=k.values[1]).contains(&value)
        })
    }
}

impl Step {
    /// A scene in a picture of 160 x 120 pixels, drawn with default settings.
    #[must_use]
    pub fn new(value: f64, scene: impl Into<String>) -> Self {
        Self {
            value,
            scene: scene.into(),
            size: (160, 120),
            max_steps: None,
            map_rows: None,
            map_source: None,
            map_format: MapFormat::R32,
            frame: 1,
        }
    }

    /// In a picture of another size.
    #[must_use]
    pub fn sized(mut self, width: u32, height: u32) -> Self {
        self.size = (width, height);
        self
    }

    /// The scene; `folder` holds the files that it names.
    ///
    /// # Errors
    /// As [`SceneFile::parse`] and [`SceneFile::scene`].
    pub fn read(&self, folder: &Path) -> Result<Scene> {
        SceneFile::parse(&self.scene, folder)?.scene(&[])
    }
}

/// The text of a scene, built line by line.
#[derive(Clone, Debug, Default)]
pub struct Text(String);

impl Text {
    /// A scene with a camera at `eye` that looks at `target`, field of view 40 degrees.
    #[must_use]
    pub fn seen(eye: [f64; 3], target: [f64; 3]) -> Self {
        Self::through(eye, target, 40.0)
    }

    /// The same with a vertical field of view in degrees.
    #[must_use]
    pub fn through(eye: [f64; 3], target: [f64; 3], fov_y: f64) -> Self {
        let mut text = String::new();
        let _ = writeln!(
            text,
            "[camera]\neye = {eye:?}\ntarget = {target:?}\nfov_y = {fov_y:?}"
        );
        // Straight down or up: any other direction will do.
        if (eye[0] - target[0]).hypot(eye[1] - target[1]) < 1e-6 * (eye[2] - target[2]).abs() {
            text.push_str("up = [0.0, 1.0, 0.0]\n");
        }
        Self(text)
    }

    /// With a line before the first table, as for `shadow`.
    #[must_use]
    pub fn with(self, line: &str) -> Self {
        Self(format!("{line}\n{}", self.0))
    }

    /// With a light that travels along `direction`.
    #[must_use]
    pub fn lit(mut self, direction: [f64; 3]) -> Self {
        let _ = writeln!(self.0, "[[light]]\ndirection = {direction:?}");
        self
    }

    /// With an object of a polygon in a box of radius 0.5; `keys` are further lines.
    #[must_use]
    pub fn solid(self, polygon: &[[f64; 2]], keys: &str) -> Self {
        self.object(&format!("polygon = {polygon:?}\n{keys}"))
    }

    /// With an object of these lines.
    #[must_use]
    pub fn object(mut self, keys: &str) -> Self {
        let _ = writeln!(self.0, "[[object]]\n{keys}");
        self
    }

    /// The whole text.
    #[must_use]
    pub fn done(self) -> String {
        self.0
    }
}

/// The searches that the catalogue compares: the RBM baseline, the map search, the exact search,
/// the default.
pub const SOLVERS: [Solver; 4] = [CIRCLE, Solver::Live, Solver::Quadric, Solver::DEFAULT];
