//! Changes that the command line makes in a plan.

use super::entry::{Measure, Pick};
use super::suite::Extent;
use crate::plan::method::Method;
use crate::plan::view::{Framing, View};
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{DrawStage, Tolerance};

/// Changes that the command line makes in a plan.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// True for a quick look.
    pub quick: bool,
    /// Scenes in place of the program's own solids.
    pub scenes: Vec<View>,
    /// Which of the program's own solids.
    pub solids: Option<Extent>,
    /// Degrees above the horizon.
    pub elevations: Vec<f64>,
    /// Framings.
    pub framings: Vec<Framing>,
    /// Searches and meshes, in place of the plan's.
    pub methods: Vec<Method>,
    /// Lists that take the place of every entry's, where they are not empty.
    pub lists: Lists,
    /// How many passes.
    pub passes: Option<usize>,
    /// How many rounds.
    pub rounds: Option<usize>,
    /// No pass begins that would end after so many seconds.
    pub max_seconds: Option<f64>,
}

/// Lists of an entry that the command line can replace.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)] // as in [`Measure`]
pub struct Lists {
    pub stages: Vec<DrawStage>,
    pub sizes: Vec<(u32, u32)>,
    pub max_steps: Vec<u32>,
    pub map_rows: Vec<u32>,
    pub map_sources: Vec<MapSource>,
    pub map_formats: Vec<MapFormat>,
    pub tolerances: Vec<Tolerance>,
}

impl Lists {
    /// True if bounds on steps or maps are named.
    pub(crate) fn combines(&self) -> bool {
        !(self.max_steps.is_empty()
            && self.map_rows.is_empty()
            && self.map_sources.is_empty()
            && self.map_formats.is_empty())
    }

    pub(crate) fn replace(&self, measure: &mut Measure) {
        fn put<T: Clone>(given: &[T], own: &mut Vec<T>) {
            if !given.is_empty() {
                own.clear();
                own.extend_from_slice(given);
            }
        }
        put(&self.stages, &mut measure.stages);
        put(&self.sizes, &mut measure.sizes);
        // The RBM baseline and the floor are what they are.
        let search = |pick: &Pick| !matches!(pick, Pick::Baseline | Pick::Method(Method::Floor));
        if !measure.methods.iter().any(search) {
            return;
        }
        put(&self.max_steps, &mut measure.max_steps);
        put(&self.map_rows, &mut measure.map_rows);
        put(&self.map_sources, &mut measure.map_sources);
        put(&self.map_formats, &mut measure.map_formats);
        put(&self.tolerances, &mut measure.tolerances);
    }
}
