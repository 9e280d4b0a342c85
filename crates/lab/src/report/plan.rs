//! What is to be measured: views, settings, and which of them are measured against each other.

use super::view::View;
use crate::floor;
use crate::method::{Method, MethodSettings};
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{DrawStage, Planes, Solver, Tolerance};
use revmap_searches::{CIRCLE, CONE};

/// Lists of values; a plan takes every combination of them. `None` leaves a choice to the solver or
/// the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Axes {
    /// Where rays are traced.
    pub stages: Vec<DrawStage>,
    /// The searches.
    pub methods: Vec<Method>,
    /// Bounds on their steps.
    pub max_steps: Vec<Option<u32>>,
    /// Widths and heights, pixels.
    pub sizes: Vec<(u32, u32)>,
    /// Rows of the shape maps.
    pub map_rows: Vec<Option<u32>>,
    /// Sources of distances.
    pub sources: Vec<Option<MapSource>>,
    /// Formats of the maps.
    pub formats: Vec<MapFormat>,
    /// Tolerances of searches on patches; all else is measured once.
    pub tolerances: Vec<Tolerance>,
}

impl Default for Axes {
    /// Both stages and every search at 800x600, all else as drawing takes it.
    fn default() -> Self {
        let settings = MethodSettings::default();
        Self {
            stages: vec![DrawStage::Fragment, DrawStage::Compute],
            methods: Method::ALL.to_vec(),
            max_steps: vec![settings.max_steps],
            sizes: vec![(settings.width, settings.height)],
            map_rows: vec![settings.map_rows],
            sources: vec![settings.map_source],
            formats: vec![settings.map_format],
            tolerances: vec![settings.tolerance],
        }
    }
}

impl Axes {
    /// Every combination, sizes slowest.
    #[must_use]
    pub fn combinations(&self) -> Vec<MethodSettings> {
        let mut all = Vec::new();
        for &(width, height) in &self.sizes {
            for &stage in &self.stages {
                for &method in &self.methods {
                    for &max_steps in &self.max_steps {
                        for &map_rows in &self.map_rows {
                            for &map_source in &self.sources {
                                for &map_format in &self.formats {
                                    let settings = MethodSettings {
                                        width,
                                        height,
                                        stage,
                                        method,
                                        max_steps,
                                        map_rows,
                                        map_source,
                                        map_format,
                                        planes: Planes::Color,
                                        tolerance: Tolerance::EXACT,
                                        antialias: false,
                                    };
                                    let follows = method.follows_tolerance();
                                    let given = if follows {
                                        &self.tolerances[..]
                                    } else {
                                        &[Tolerance::EXACT]
                                    };
                                    all.extend(given.iter().map(|&tolerance| MethodSettings {
                                        tolerance,
                                        ..settings
                                    }));
                                }
                            }
                        }
                    }
                }
            }
        }
        all
    }
}

/// One measurement: a view drawn in one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Index of the view.
    pub view: usize,
    /// How it is drawn.
    pub settings: MethodSettings,
}

/// All that is measured in one run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What is looked at.
    pub views: Vec<View>,
    /// The measurements, none twice.
    pub cases: Vec<Case>,
    /// Whether views are compared with each other: then all views of one size are drawn in turn,
    /// not each view by itself.
    pub mixed: bool,
}

impl Plan {
    /// Every view drawn in every way; a way that is named twice is taken once.
    #[must_use]
    pub fn new(views: Vec<View>, ways: &[MethodSettings]) -> Self {
        let mut plan = Self {
            views,
            cases: Vec::new(),
            mixed: false,
        };
        for view in 0..plan.views.len() {
            for settings in ways {
                plan.add(view, *settings);
            }
        }
        plan
    }

    /// Adds a measurement unless it is there.
    pub fn add(&mut self, view: usize, settings: MethodSettings) {
        let case = Case { view, settings };
        if view < self.views.len() && !self.cases.contains(&case) {
            self.cases.push(case);
        }
    }

    /// Adds, for every view, size and stage of the plan, the RBM baseline, to which speeds are put
    /// in proportion.
    pub fn add_rbm_baseline(&mut self) {
        for case in self.cases.clone() {
            let papers = rbm_baseline(&self.views[case.view], &case.settings);
            self.add(case.view, papers);
        }
    }

    /// Adds, for every view, size and stage of the plan, the floor, where the program holds it and it
    /// is made for the view.
    pub fn add_floors(&mut self) {
        for case in self.cases.clone() {
            self.add_floor(case.view, plain(&case.settings, Method::Floor));
        }
    }

    /// Adds the floor of a frame with these settings, where the program holds it and it is made for
    /// the view.
    pub fn add_floor(&mut self, view: usize, settings: MethodSettings) {
        if floor::is_available() && floor::check(&self.views[view].scene).is_ok() {
            let method = Method::Floor;
            self.add(view, MethodSettings { method, ..settings });
        }
    }

    /// Adds, for every view and size that is measured in the fragment stage, the rival in these
    /// segments and rings.
    pub fn add_meshes(&mut self, meshes: &[(u32, u32)]) {
        for case in self.cases.clone() {
            if case.settings.stage == DrawStage::Fragment {
                for &(segments, rings) in meshes {
                    let method = Method::Mesh { segments, rings };
                    self.add(case.view, plain(&case.settings, method));
                }
            }
        }
    }

    /// The measurements that are taken in turn, A B A B: those of one view and size, or of one size
    /// in a mixed plan.
    #[must_use]
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (index, case) in self.cases.iter().enumerate() {
            let same = |group: &&mut Vec<usize>| {
                group
                    .first()
                    .is_some_and(|&first| self.in_turn(&self.cases[first], case))
            };
            match groups.iter_mut().find(same) {
                Some(group) => group.push(index),
                None => groups.push(vec![index]),
            }
        }
        groups
    }
}

impl Plan {
    fn in_turn(&self, a: &Case, b: &Case) -> bool {
        let size = |c: &Case| (c.settings.width, c.settings.height);
        if self.mixed {
            size(a) == size(b)
        } else {
            together(a, b)
        }
    }
}

/// Whether two measurements show the same picture.
#[must_use]
pub fn together(a: &Case, b: &Case) -> bool {
    let key = |c: &Case| (c.view, c.settings.width, c.settings.height);
    key(a) == key(b)
}

/// The searches that a benchmark takes where none is named: those that somebody may want to choose
/// between. Equal steps are left to the whole sweep: they cost two to five times as much as the
/// rest and are beaten in time and error at once.
pub const USUAL: [Method; 5] = [
    Method::Search(CIRCLE),
    Method::Search(CONE),
    Method::Search(Solver::Live),
    Method::Search(Solver::Quadric),
    Method::Search(Solver::Exact),
];

/// The searches of a look: the RBM baseline is there anyhow.
pub const FEW: [Method; 3] = [
    Method::Search(Solver::Live),
    Method::Search(Solver::Quadric),
    Method::Search(Solver::Exact),
];

/// The tessellations that are measured where none is named, segments and rings: one that a game
/// would take, and finer ones up to the errors of exact patches. Each is a quarter as wrong as the
/// one before.
pub const MESHES: [(u32, u32); 3] = [(128, 256), (256, 512), (512, 1024)];

/// The tessellations of the whole sweep.
pub const ALL_MESHES: [(u32, u32); 5] = [(32, 64), (64, 128), (128, 256), (256, 512), (512, 1024)];

/// `solver` at the stage and size of `settings`, all else as drawing takes it.
#[must_use]
pub fn plain(settings: &MethodSettings, method: Method) -> MethodSettings {
    MethodSettings {
        width: settings.width,
        height: settings.height,
        stage: settings.stage,
        planes: settings.planes,
        method,
        ..MethodSettings::default()
    }
}

/// The loop of the papers at the stage and size of `settings`: circle tracing of 20 steps, under a
/// bevel of 25 and 10 halvings, on a binary image's distances in 8 bits.
#[must_use]
pub fn rbm_baseline(view: &View, settings: &MethodSettings) -> MethodSettings {
    MethodSettings {
        method: Method::Search(CIRCLE),
        max_steps: Some(if view.technique().is_beveled() {
            25
        } else {
            20
        }),
        map_source: Some(MapSource::Binary),
        map_format: MapFormat::Rgba8,
        map_rows: None,
        tolerance: Tolerance::EXACT,
        ..*settings
    }
}

/// A way of drawing apart from its size: what a summary over views and sizes is told by.
#[must_use]
pub fn variant(settings: &MethodSettings) -> MethodSettings {
    MethodSettings {
        width: 0,
        height: 0,
        planes: Planes::Color,
        ..*settings
    }
}

/// Names ways of drawing as briefly as tells them apart: what is the same in all of them is left
/// out.
#[derive(Clone, Debug)]
pub struct Labels {
    steps: bool,
    rows: bool,
    source: bool,
    format: bool,
    tolerance: bool,
}

impl Labels {
    /// Labels for these ways; the RBM baseline, meshes and the floor have their own names and do not count.
    #[must_use]
    pub fn new<'a>(ways: impl IntoIterator<Item = &'a MethodSettings>) -> Self {
        let own = |s: &MethodSettings| s.method.is_mesh() || s.method == Method::Floor;
        let counts = |s: &&MethodSettings| !is_rbm_baseline(s) && !own(s);
        let ways: Vec<_> = ways.into_iter().filter(counts).collect();
        fn differs<T: PartialEq>(
            ways: &[&MethodSettings],
            of: impl Fn(&MethodSettings) -> T,
        ) -> bool {
            ways.windows(2).any(|w| of(w[0]) != of(w[1]))
        }
        Self {
            steps: differs(&ways, |s| s.max_steps),
            rows: differs(&ways, |s| s.map_rows),
            source: differs(&ways, |s| s.map_source),
            format: differs(&ways, |s| s.map_format),
            tolerance: differs(&ways, |s| s.tolerance),
        }
    }

    /// The search and what else tells this way from the others, without the stage.
    #[must_use]
    pub fn way(&self, s: &MethodSettings) -> String {
        if is_rbm_baseline(s) {
            return RBM_BASELINE.to_owned();
        }
        let mut name = s.method.to_string();
        if s.method.is_mesh() || s.method == Method::Floor {
            return name; // which has neither steps nor a map
        }
        // A search without a loop has no bound to tell.
        if self.steps && s.method.default_steps(false) > 1 {
            let steps = s.max_steps.unwrap_or_else(|| s.method.default_steps(false));
            name += &format!(" {steps} steps");
        }
        if let (true, Some(rows)) = (self.rows, s.map_rows) {
            name += &format!(" {rows} rows");
        }
        if let (true, Some(source)) = (self.source, s.map_source) {
            name += &format!(" {}", source.name());
        }
        if self.format {
            name += &format!(" {}", s.map_format.name());
        }
        if self.tolerance && s.method.follows_tolerance() {
            name += &format!(" {} px", s.tolerance);
        }
        name
    }
}

/// What reports call the RBM baseline.
pub const RBM_BASELINE: &str = "RBM baseline";

/// Whether settings are those of [`rbm_baseline`].
#[must_use]
pub fn is_rbm_baseline(s: &MethodSettings) -> bool {
    s.method == CIRCLE
        && matches!(s.max_steps, Some(20 | 25))
        && s.map_source == Some(MapSource::Binary)
        && s.map_format == MapFormat::Rgba8
        && s.map_rows.is_none()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::view::tests::spindle;
    use super::*;

    fn axes() -> Axes {
        Axes {
            max_steps: vec![None, Some(48)],
            sizes: vec![(64, 48), (32, 24)],
            sources: vec![Some(MapSource::Binary), Some(MapSource::Exact)],
            formats: vec![MapFormat::R16, MapFormat::Rgba8],
            methods: vec![Method::Search(CIRCLE)],
            ..Axes::default()
        }
    }

    #[test]
    fn every_combination_is_there_once() {
        let all = axes().combinations();
        assert_eq!(all.len(), 2 * 2 * 2 * 2 * 2);
        for (i, a) in all.iter().enumerate() {
            assert!(!all[..i].contains(a));
        }
        let plan = Plan::new(vec![spindle(), spindle()], &[all.clone(), all].concat());
        assert_eq!(plan.cases.len(), 64);
    }

    #[test]
    fn groups_hold_what_shows_one_picture() {
        let plan = Plan::new(vec![spindle(), spindle()], &axes().combinations());
        let groups = plan.groups();
        assert_eq!(groups.len(), 4);
        let mut seen: Vec<_> = groups.concat();
        seen.sort_unstable();
        assert_eq!(seen, (0..plan.cases.len()).collect::<Vec<_>>());
        for group in groups {
            assert!(
                group
                    .iter()
                    .all(|&i| together(&plan.cases[i], &plan.cases[group[0]]))
            );
        }
    }

    #[test]
    fn the_rbm_baseline_is_added_to_each_stage_and_size_once() {
        let mut plan = Plan::new(vec![spindle()], &axes().combinations());
        plan.add_rbm_baseline();
        plan.add_rbm_baseline();
        let papers = plan
            .cases
            .iter()
            .filter(|c| is_rbm_baseline(&c.settings))
            .count();
        assert_eq!((papers, plan.cases.len()), (4, 36));
        let mut beveled = spindle();
        beveled.scene.objects[0].offset.bevel = 0.3;
        assert_eq!(
            rbm_baseline(&beveled, &plan.cases[0].settings).max_steps,
            Some(25)
        );
    }

    #[test]
    fn labels_tell_apart_and_say_no_more() {
        let ways = axes().combinations();
        let labels = Labels::new(&ways);
        assert_eq!(labels.way(&ways[0]), "circle 20 steps binary r16");
        assert_eq!(labels.way(&ways[7]), "circle 48 steps exact rgba8");
        let mut plan = Plan::new(vec![spindle()], &Axes::default().combinations());
        plan.add_rbm_baseline();
        let labels = Labels::new(plan.cases.iter().map(|c| &c.settings));
        assert_eq!(labels.way(&plan.cases[0].settings), Method::ALL[0].name());
        assert_eq!(
            labels.way(&plan.cases.last().unwrap().settings),
            RBM_BASELINE
        );
    }
}
