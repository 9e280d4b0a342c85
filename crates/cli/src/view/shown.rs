//! What the window shows, and how: what the controls change and what is undone.

use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings, Settings};

/// What the window shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inspected {
    /// The scene as it is lit.
    Color,
    /// Distances from the eye: white is near, dark is far.
    Depth,
    /// World normals: red, green and blue are x, y and z, from -1 to 1.
    Normals,
    /// Look-ups or patches that each pixel's search made.
    Steps,
    /// Errors of depth and silhouette against the double-precision reference.
    Error,
}

impl Inspected {
    /// Names in the controls and of the option `--show`.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("color", Self::Color),
        ("depth", Self::Depth),
        ("normals", Self::Normals),
        ("steps", Self::Steps),
        ("error", Self::Error),
    ];
}

/// What is shown, and how.
#[derive(Clone)]
pub struct Shown {
    pub scene: Scene,
    pub search: SearchSettings,
    pub stage: DrawStage,
    pub inspected: Inspected,
}

impl Shown {
    /// The scene as it is lit, by the fragment stage.
    pub fn new(scene: Scene, search: SearchSettings) -> Self {
        Self {
            scene,
            search,
            stage: DrawStage::Fragment,
            inspected: Inspected::Color,
        }
    }

    /// Settings of an off-screen frame of it.
    pub fn settings(&self, (width, height): (u32, u32), planes: Planes) -> Settings {
        Settings {
            width,
            height,
            stage: self.stage,
            planes,
            ..Settings::from(&self.search)
        }
    }
}
