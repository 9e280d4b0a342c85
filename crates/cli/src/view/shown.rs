//! The state of the window: the values that the controls change and that can be undone.

use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings, Settings};

/// The quantity that the window shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inspected {
    /// The lit scene.
    Color,
    /// Distances from the eye: white is near, dark is far.
    Depth,
    /// World normals: red, green and blue are x, y and z, from -1 to 1.
    Normals,
    /// Look-ups or patches of each pixel's search.
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

/// The shown scene and its settings.
#[derive(Clone)]
pub struct Shown {
    pub scene: Scene,
    pub search: SearchSettings,
    pub stage: DrawStage,
    pub inspected: Inspected,
}

impl Shown {
    /// Settings of a frame of this size with what is inspected.
    pub fn settings(&self, (width, height): (u32, u32)) -> Settings {
        Settings {
            width,
            height,
            stage: self.stage,
            planes: match self.inspected {
                Inspected::Color => Planes::Color,
                _ => Planes::All,
            },
            ..Settings::from(&self.search)
        }
    }
}
