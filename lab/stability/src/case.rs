//! A case of the catalogue.

use revmap::error::Result;
use revmap::scene::Scene;
use revmap::settings::{Settings, Solver};
use revmap_files::SceneFile;
use revmap_searches::CIRCLE;
use serde::Deserialize;
use std::fmt::Write;
use std::path::Path;

/// One way in which methods break, swept over the parameter that decides.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Its name on the command line.
    pub name: String,
    /// What is swept, with its unit.
    pub parameter: String,
    /// What breaks, and why.
    pub why: String,
    /// What cures it.
    pub cure: String,
    /// The values of the parameter, in order.
    pub values: Vec<f64>,
    /// What the default is known to fail, each with its reason.
    #[serde(default)]
    pub known: Vec<Known>,
    /// Whether its scenes are the frames of a motion, between which no pixel may flicker.
    #[serde(default)]
    pub motion: bool,
}

/// One scene of a case.
#[derive(Clone, Debug)]
pub struct Step {
    /// The scene as TOML; paths are relative to the folder that holds the case's files.
    pub scene: String,
    /// How it is drawn, but for stage and solver.
    pub settings: Settings,
    /// Which of its frames is judged: the first, or a later one of the same renderer.
    pub frame: u32,
}

/// Part of a case that the default is known to fail, in both stages.
#[derive(Clone, Debug, Deserialize, PartialEq)]
pub struct Known {
    /// The values of the parameter for which it fails, both ends included.
    pub values: [f64; 2],
    /// Why it is not cured.
    pub reason: String,
}

impl Case {
    /// Whether the default is known to fail at a value of the parameter.
    pub fn is_known(&self, value: f64) -> bool {
        let mut known = self.known.iter().map(|k| k.values[0]..=k.values[1]);
        known.any(|values| values.contains(&value))
    }
}

impl Step {
    /// A scene in a picture of 160 x 120 pixels, drawn exactly.
    pub fn new(scene: String) -> Self {
        Self {
            scene,
            settings: Settings {
                width: 160,
                height: 120,
                ..Settings::exact()
            },
            frame: 1,
        }
    }

    /// A scene with a camera at `eye` that looks at `target`, field of view 40 degrees.
    pub fn seen(eye: [f64; 3], target: [f64; 3]) -> Self {
        Self::through(eye, target, 40.0)
    }

    /// The same with a vertical field of view in degrees.
    pub fn through(eye: [f64; 3], target: [f64; 3], fov_y: f64) -> Self {
        let mut text = format!("[camera]\neye = {eye:?}\ntarget = {target:?}\nfov_y = {fov_y:?}\n");
        // Straight down or up: any other direction will do.
        if (eye[0] - target[0]).hypot(eye[1] - target[1]) < 1e-6 * (eye[2] - target[2]).abs() {
            text.push_str("up = [0.0, 1.0, 0.0]\n");
        }
        Self::new(text)
    }

    /// With a line before the first table, as for `shadow`.
    pub fn with(mut self, line: &str) -> Self {
        self.scene.insert_str(0, &format!("{line}\n"));
        self
    }

    /// With a light that travels along `direction`.
    pub fn lit(mut self, direction: [f64; 3]) -> Self {
        let _ = writeln!(self.scene, "[[light]]\ndirection = {direction:?}");
        self
    }

    /// With an object of a polygon in a box of radius 0.5; `keys` are further lines.
    pub fn solid(self, polygon: &[[f64; 2]], keys: &str) -> Self {
        self.object(&format!("polygon = {polygon:?}\n{keys}"))
    }

    /// With an object of these lines.
    pub fn object(mut self, keys: &str) -> Self {
        let _ = writeln!(self.scene, "[[object]]\n{keys}");
        self
    }

    /// In a picture of another size.
    pub fn sized(mut self, width: u32, height: u32) -> Self {
        (self.settings.width, self.settings.height) = (width, height);
        self
    }

    /// The scene; `folder` holds the files that it names.
    pub fn read(&self, folder: &Path) -> Result<Scene> {
        SceneFile::parse(&self.scene, folder)?.scene(&[])
    }
}

/// The searches compared: the RBM baseline, the map search, the exact search, the default.
pub const SOLVERS: [Solver; 4] = [CIRCLE, Solver::Live, Solver::Quadric, Solver::DEFAULT];
