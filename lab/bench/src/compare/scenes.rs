//! Whether two runs drew the same scenes.

use super::run::Run;
use crate::measure::drawn;

/// How the scenes and settings of two runs differ.
#[derive(Default)]
pub(super) struct Scenes {
    /// The views that have one name in both, and different scenes.
    others: Vec<String>,
    /// A clause on these views, if there are any: `different scenes as vase: camera.eye (...)`.
    pub(super) told: Option<String>,
    /// Warnings, each of one line.
    pub(super) warnings: Vec<String>,
}

impl Scenes {
    pub(super) fn of(old: &Run, new: &Run) -> Self {
        let (Some(before), Some(after)) = (&old.drawn, &new.drawn) else {
            let who = match (&old.drawn, &new.drawn) {
                (None, None) => "both runs",
                (None, _) => "the old run",
                (_, _) => "the new run",
            };
            let file = drawn::FILE;
            return Self {
                warnings: vec![format!(
                    "no {file} in {who}, of an earlier version: views of one name are taken for one scene"
                )],
                ..Self::default()
            };
        };
        let others = before.other_scenes(after);
        let told = drawn::told(&others);
        let scenes = told.iter();
        let scenes =
            scenes.map(|told| format!("the runs drew {told}; rows of such views are not compared"));
        let settings = before.other_settings(after).into_iter();
        let settings =
            settings.map(|s| format!("the runs differ in {s}; times or errors depend on it"));
        Self {
            warnings: scenes.chain(settings).collect(),
            others: others.into_keys().map(str::to_owned).collect(),
            told,
        }
    }

    /// True if the runs drew different scenes as a view of this name.
    pub(super) fn differ(&self, view: &str) -> bool {
        self.others.iter().any(|other| other == view)
    }
}
