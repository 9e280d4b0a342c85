//! The measurements of a plan: views, settings, and which of them are measured against each other.

use super::entry::Measure;
use crate::plan::method::floor;
use crate::plan::method::{Edges, Method, MethodSettings};
use crate::plan::view::View;
use revmap::maps::MapFormat;
use revmap::settings::{DrawStage, Planes, Tolerance};
use revmap_figures::groups::grouped;
use revmap_searches::CIRCLE;

/// Most quads of all copies of a mesh: beyond, a frame takes many seconds.
const MOST_QUADS: u64 = 1 << 23;

/// One measurement: a view drawn in one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Index of the view.
    pub view: usize,
    /// How it is drawn.
    pub settings: MethodSettings,
    /// The plan's entries that it belongs to: bits, by their places in [`Plan::sweeps`].
    pub sweeps: u64,
}

impl Case {
    /// The picture that it shows: a view at a size.
    pub fn picture(&self) -> (usize, u32, u32) {
        (self.view, self.settings.width, self.settings.height)
    }
}

/// All that is measured in one run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The views.
    pub views: Vec<View>,
    /// The measurements, none twice.
    pub cases: Vec<Case>,
    /// Names of the entries, each once.
    pub sweeps: Vec<String>,
    /// True if all views of one size are drawn in turn, not each view by itself.
    pub mixed: bool,
    /// Rays per pixel of the picture that others are compared with: the default search's own, in the
    /// same stage; 1: the double-precision reference.
    pub truth_rays: u32,
    /// True if errors are measured in pixels too.
    pub pixel_errors: bool,
    /// True if times are those of the wall clock, also where the device has a clock.
    pub wall_clock: bool,
}

impl Plan {
    /// Views without measurements.
    pub fn new(views: Vec<View>) -> Self {
        Self {
            views,
            cases: Vec::new(),
            sweeps: Vec::new(),
            mixed: false,
            truth_rays: 1,
            pixel_errors: false,
            wall_clock: false,
        }
    }

    /// Adds a measurement; one that is there already becomes part of another entry.
    pub fn add(&mut self, view: usize, settings: MethodSettings, sweep: &str) {
        let known = self.sweeps.iter().position(|s| s == sweep);
        let place = known.unwrap_or_else(|| {
            self.sweeps.push(sweep.to_owned());
            self.sweeps.len() - 1
        });
        let sweeps = 1u64 << place.min(63);
        let same = |c: &&mut Case| (c.view, c.settings) == (view, settings);
        match self.cases.iter_mut().find(same) {
            Some(known) => known.sweeps |= sweeps,
            None => self.cases.push(Case {
                view,
                settings,
                sweeps,
            }),
        }
    }

    /// Adds every combination of an entry's lists for a view. `named` methods take the place of its
    /// searches.
    ///
    /// A list that a method does not read counts for it as one value.
    pub fn add_entry(&mut self, view: usize, measure: &Measure, named: &[Method]) {
        let seen = &self.views[view];
        if !(measure.views.is_empty() || measure.views.contains(&seen.group)) {
            return;
        }
        let mut all = Vec::new();
        for &(width, height) in &measure.sizes {
            for &stage in &measure.stages {
                // They are exact by default.
                let base = MethodSettings::default().storing(Planes::Color);
                let base = base.sized(width, height).in_stage(stage);
                let methods = measure.methods(named).into_iter();
                all.extend(methods.flat_map(|method| ways(seen, measure, base, method)));
            }
        }
        let solids = seen.solids() as u64;
        let fits = |s: &MethodSettings| match s.method {
            Method::Floor => floor::is_available() && floor::check(&seen.scene).is_ok(),
            mesh if mesh.is_mesh() && solids > 1 => mesh.quads() * solids <= MOST_QUADS,
            _ => true,
        };
        all.retain(fits);
        // The command line may name a mesh and compute: its row says why it was not drawn.
        let own = |s: &MethodSettings| s.stage == DrawStage::Fragment || named.contains(&s.method);
        all.retain(|s| own(s) || !(s.method.is_mesh() || s.edges == Edges::Msaa));
        for settings in all {
            self.add(view, settings, &measure.name);
        }
    }

    /// What is measured in turn, A B A B: one view and size, or one size in a mixed plan.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let key = |k: &usize| {
            let (view, width, height) = self.cases[*k].picture();
            (width, height, (!self.mixed).then_some(view))
        };
        let groups = grouped(0..self.cases.len(), key);
        groups.into_iter().map(|(_, group)| group).collect()
    }

    /// Those of the measurements that are compared with one picture.
    pub fn pictures(&self, group: &[usize]) -> Vec<Vec<usize>> {
        let rays = self.truth_rays > 1;
        let key = |k: &usize| {
            let case = &self.cases[*k];
            (case.picture(), rays.then_some(case.settings.stage))
        };
        let groups = grouped(group.iter().copied(), key);
        groups.into_iter().map(|(_, group)| group).collect()
    }
}

/// The settings of one method in an entry; `None`: the RBM baseline.
fn ways(
    view: &View,
    measure: &Measure,
    base: MethodSettings,
    method: Option<Method>,
) -> Vec<MethodSettings> {
    let base = match method {
        Some(method) => MethodSettings { method, ..base },
        None => rbm_baseline(view, &base),
    };
    let own = base.method;
    let reads = own.reads_map() || own.reads_own_table();
    if measure.readers_only && !reads {
        return Vec::new();
    }
    /// Every one with every value of a list; as they are where the list is empty or is not read.
    fn with<T: Copy>(
        all: Vec<MethodSettings>,
        (list, read): (&[T], bool),
        set: fn(&mut MethodSettings, T),
    ) -> Vec<MethodSettings> {
        if list.is_empty() || !read {
            return all;
        }
        let put = |mut one: MethodSettings, value: &T| {
            set(&mut one, *value);
            one
        };
        let of = |one| list.iter().map(move |value| put(one, value));
        all.into_iter().flat_map(of).collect()
    }
    let searched = method.is_some();
    let maps = searched && own.reads_map();
    let bounded = searched && own.default_steps(false) > 1;
    let toleranced = own.follows_tolerance();
    let m = measure;
    let all = with(vec![base], (&m.max_steps, bounded), |s, v| {
        s.max_steps = Some(v)
    });
    let all = with(all, (&m.map_rows, reads), |s, v| s.map_rows = Some(v));
    let all = with(all, (&m.map_sources, maps), |s, v| s.map_source = Some(v));
    let all = with(all, (&m.map_formats, maps), |s, v| s.map_format = v);
    let all = with(all, (&m.tolerances, toleranced), |s, v| s.tolerance = v);
    with(all, (&m.edges, searched), |s, v| s.edges = v)
}

/// The RBM baseline's name in reports.
pub const RBM_BASELINE: &str = "RBM baseline";

/// The loop of the papers at the stage and size of `settings`: circle tracing of 20 steps, under a
/// bevel of 25 and 10 halvings, on a binary image's distances in 8 bits.
pub fn rbm_baseline(view: &View, settings: &MethodSettings) -> MethodSettings {
    // The papers take more steps where the offset changes with height.
    let beveled = ["beveled", "chamfered", "mixed"].contains(&view.technique());
    MethodSettings {
        method: Method::Search(CIRCLE),
        max_steps: Some(if beveled { 25 } else { 20 }),
        map_source: Some(revmap_files::BINARY),
        map_format: MapFormat::Rgba8,
        map_rows: None,
        tolerance: Tolerance::EXACT,
        ..*settings
    }
}

/// A way of drawing apart from its size: what a summary over views and sizes is told by.
pub fn variant(settings: &MethodSettings) -> MethodSettings {
    settings.sized(0, 0).storing(Planes::Color)
}

/// True if settings are those of [`rbm_baseline`].
pub fn is_rbm_baseline(s: &MethodSettings) -> bool {
    s.method == CIRCLE
        && matches!(s.max_steps, Some(20 | 25))
        && s.map_source == Some(revmap_files::BINARY)
        && s.map_format == MapFormat::Rgba8
        && s.map_rows.is_none()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::Pick;
    use super::*;
    use crate::plan::view::tests::spindle;
    use revmap::maps::MapSource;

    fn entry() -> Measure {
        Measure {
            max_steps: vec![20, 48],
            sizes: vec![(64, 48), (32, 24)],
            map_sources: vec![revmap_files::BINARY, MapSource::EXACT],
            map_formats: vec![MapFormat::R16, MapFormat::Rgba8],
            methods: vec![Pick::Method(Method::Search(CIRCLE))],
            ..Measure::default()
        }
    }

    fn plan(views: usize, entries: &[Measure]) -> Plan {
        let mut plan = Plan::new(vec![spindle(); views]);
        for view in 0..views {
            for entry in entries {
                plan.add_entry(view, entry, &[]);
            }
        }
        plan
    }

    #[test]
    fn every_combination_is_there_once() {
        assert_eq!(plan(1, &[entry()]).cases.len(), 2 * 2 * 2 * 2 * 2);
        let twice = plan(2, &[entry(), entry()]);
        assert_eq!(twice.cases.len(), 64);
        // A measurement of two entries belongs to both.
        let named = |name: &str| Measure {
            name: name.to_owned(),
            ..entry()
        };
        let both = plan(1, &[named("a"), named("b")]);
        assert!(both.cases.iter().all(|c| c.sweeps == 3));
        assert_eq!(both.sweeps, ["a", "b"]);
    }

    #[test]
    fn groups_hold_what_shows_one_picture() {
        let mut plan = plan(2, &[entry()]);
        let groups = plan.groups();
        assert_eq!(groups.len(), 4);
        let mut seen: Vec<_> = groups.concat();
        seen.sort_unstable();
        assert_eq!(seen, (0..plan.cases.len()).collect::<Vec<_>>());
        for group in &groups {
            let picture = |i: usize| plan.cases[i].picture();
            assert!(group.iter().all(|&i| picture(i) == picture(group[0])));
            assert_eq!(plan.pictures(group).len(), 1);
        }
        plan.mixed = true;
        assert_eq!(plan.groups().len(), 2);
        // A truth of rays is that of its own stage.
        plan.truth_rays = 64;
        assert_eq!(plan.pictures(&plan.groups()[0]).len(), 4);
    }

    #[test]
    fn the_rbm_baseline_is_added_to_each_stage_and_size_once() {
        let baseline = Measure {
            methods: vec![Pick::Baseline],
            sizes: entry().sizes,
            ..Measure::default()
        };
        let mut plan = plan(1, &[entry(), baseline.clone(), baseline]);
        let found = plan.cases.iter().filter(|c| is_rbm_baseline(&c.settings));
        // The entry's own combinations hold it already: 20 steps, binary, in 8 bits.
        assert_eq!((found.count(), plan.cases.len()), (4, 32));
        plan.views[0].scene.objects[0].offset.bevel = 0.3;
        let settings = plan.cases[0].settings;
        assert_eq!(rbm_baseline(&plan.views[0], &settings).max_steps, Some(25));
    }
}
