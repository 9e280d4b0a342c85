//! The state of the window: the values that the controls change and that can be undone.

use crate::studio::Studio;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, SearchSettings, Settings};
use std::sync::Arc;

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
    /// The scene without the studio.
    pub scene: Scene,
    /// The studio in which the scene is drawn.
    pub studio: Option<Arc<Studio>>,
    pub search: SearchSettings,
    pub stage: DrawStage,
    pub inspected: Inspected,
}

impl Shown {
    /// This state as it is drawn: the scene has the ground and the lights of its studio, which follow
    /// the camera.
    pub fn furnished(&self) -> Self {
        let mut drawn = self.clone();
        if let Some(studio) = &self.studio {
            studio.furnish(&mut drawn.scene);
        }
        drawn
    }

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

/// A change that continues over several frames, and is undone at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// A drag with a button held: of a slider, or of the camera.
    Held,
    /// Turns of the wheel, until another value changes.
    Wheel,
}
