//! Which budgets, maps and searches a chart of speed against accuracy sweeps over.

use super::plan::{Axes, Plan, plain, rbm_baseline};
use super::view::View;
use crate::method::{Method, MethodSettings};
use revmap::maps::{MapFormat, MapSource};
use revmap::settings::{DrawStage, Solver};
use revmap_searches::CIRCLE;

/// The values that are swept, one axis at a time, the others staying at what drawing takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Where rays are traced. Maps are swept in the first stage alone: they cost and err alike in
    /// both.
    pub stages: Vec<DrawStage>,
    /// The searches.
    pub methods: Vec<Method>,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Bounds on steps.
    pub steps: Vec<u32>,
    /// Rows of maps.
    pub rows: Vec<u32>,
    /// Segments and rings of meshes, in the fragment stage.
    pub meshes: Vec<(u32, u32)>,
}

impl Sweep {
    /// The default: both stages, every search.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stages: vec![DrawStage::Fragment, DrawStage::Compute],
            methods: Method::ALL.to_vec(),
            size: (800, 600),
            steps: vec![8, 16, 32, 64, 128, 256],
            rows: vec![64, 128, 256, 512, 1024],
            meshes: doubled(16, 512),
        }
    }

    /// A look: one stage, few values, small pictures.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            stages: vec![DrawStage::Fragment],
            size: (400, 300),
            steps: vec![16, 64, 256],
            rows: vec![128, 512],
            meshes: doubled(32, 128),
            ..Self::new()
        }
    }

    /// Everything.
    #[must_use]
    pub fn full() -> Self {
        Self {
            steps: vec![4, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 512],
            rows: vec![32, 64, 128, 256, 512, 1024, 2048],
            meshes: doubled(8, 1024),
            ..Self::new()
        }
    }

    /// The plan over these views: for each view the sweeps over steps, over rows with every source,
    /// and over formats, over meshes, and the RBM baseline.
    #[must_use]
    pub fn plan(&self, views: Vec<View>) -> Plan {
        let mut plan = Plan {
            views,
            cases: Vec::new(),
            mixed: false,
        };
        for view in 0..plan.views.len() {
            for (number, &stage) in self.stages.iter().enumerate() {
                let base = MethodSettings {
                    stage,
                    width: self.size.0,
                    height: self.size.1,
                    ..Axes::default()
                        .combinations()
                        .first()
                        .copied()
                        .unwrap_or_default()
                };
                for &method in &self.methods {
                    let steps = |max_steps| MethodSettings {
                        method,
                        max_steps,
                        ..base
                    };
                    let rows = |&rows: &u32| MethodSettings {
                        method,
                        map_rows: Some(rows),
                        ..base
                    };
                    let ways: Vec<_> = if has_rows(method) {
                        self.rows.iter().map(rows).collect()
                    } else {
                        let budgets = budgets(method, &self.steps);
                        budgets.into_iter().map(steps).collect()
                    };
                    for settings in ways {
                        plan.add(view, settings);
                    }
                    if number > 0 || !sweeps_maps(method, &self.methods) {
                        continue;
                    }
                    let ample = ample(method, &self.steps);
                    for &rows in &self.rows {
                        for source in [MapSource::Binary, MapSource::Coverage, MapSource::Exact] {
                            let settings = MethodSettings {
                                method,
                                max_steps: ample,
                                map_rows: Some(rows),
                                map_source: Some(source),
                                ..base
                            };
                            plan.add(view, settings);
                        }
                    }
                    for map_format in [MapFormat::Rgba8, MapFormat::R16, MapFormat::R32] {
                        plan.add(
                            view,
                            MethodSettings {
                                method,
                                max_steps: ample,
                                map_format,
                                ..base
                            },
                        );
                    }
                }
                for &(segments, rings) in &self.meshes {
                    if stage == DrawStage::Fragment {
                        plan.add(view, plain(&base, Method::Mesh { segments, rings }));
                    }
                }
                let papers = rbm_baseline(&plan.views[view], &base);
                plan.add(view, papers);
            }
        }
        plan
    }
}

impl Default for Sweep {
    fn default() -> Self {
        Self::new()
    }
}

/// Meshes of `from` segments to `to`, each twice as fine as the one before; twice as many rings.
fn doubled(from: u32, to: u32) -> Vec<(u32, u32)> {
    std::iter::successors(Some(from), |n| Some(2 * n))
        .take_while(|n| *n <= to)
        .map(|n| (n, 2 * n))
        .collect()
}

/// The bounds on steps worth trying: a search without a loop has none, one that ends by itself is
/// cut short to see what the cut costs.
#[must_use]
pub fn budgets(method: Method, steps: &[u32]) -> Vec<Option<u32>> {
    if has_budget(method) {
        steps.iter().copied().map(Some).collect()
    } else {
        vec![None]
    }
}

/// Whether a bound on steps means anything to a search.
#[must_use]
pub fn has_budget(method: Method) -> bool {
    method.default_steps(false) > 1
}

/// Whether a search has a table of as many rows as a map has, made from the boundary itself: these
/// rows are its budget.
#[must_use]
pub fn has_rows(method: Method) -> bool {
    method.reads_own_table()
}

/// Maps are swept with `circle` and with `live`, the most exact of those that read them, or with
/// what is named in place of both: the others read the same maps in the same way. The default reads
/// none.
fn sweeps_maps(method: Method, all: &[Method]) -> bool {
    let usual = [Method::Search(CIRCLE), Method::Search(Solver::Live)];
    method.reads_map() && (usual.contains(&method) || !all.iter().any(|s| usual.contains(s)))
}

/// A budget with which what is wrong is the map's fault rather than the search's.
fn ample(method: Method, steps: &[u32]) -> Option<u32> {
    let most = steps.iter().copied().max();
    if has_budget(method) {
        most.max(Some(method.default_steps(false)))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan::is_rbm_baseline;
    use super::super::view::tests::spindle;
    use super::*;
    use revmap_searches::CONE;

    #[test]
    fn a_sweep_moves_one_axis_at_a_time() {
        let sweep = Sweep {
            methods: vec![Method::Search(CIRCLE), Method::Search(Solver::Quadric)],
            ..Sweep::new()
        };
        let plan = sweep.plan(vec![spindle()]);
        let of = |method| {
            plan.cases
                .iter()
                .filter(move |c| c.settings.method == method && !is_rbm_baseline(&c.settings))
        };
        // Steps in both stages, rows x sources and formats in one; a format that is the default is
        // there already.
        let circle = of(Method::Search(CIRCLE)).count();
        assert_eq!(circle, 6 * 2 + 5 * 3 + 2);
        assert!(of(Method::Search(Solver::Quadric)).all(|c| c.settings.max_steps.is_none()));
        assert_eq!(
            plan.cases
                .iter()
                .filter(|c| is_rbm_baseline(&c.settings))
                .count(),
            2
        );
        assert_eq!(plan.groups().len(), 1);
        let meshes = plan.cases.iter().filter(|c| c.settings.method.is_mesh());
        assert!(
            meshes
                .clone()
                .all(|c| c.settings.stage == DrawStage::Fragment)
        );
        assert_eq!(meshes.count(), 6);
    }

    #[test]
    fn rows_of_cones_are_swept_in_every_stage() {
        let sweep = Sweep {
            methods: vec![Method::Search(CONE)],
            ..Sweep::new()
        };
        let plan = sweep.plan(vec![spindle()]);
        let cones = plan.cases.iter().map(|c| c.settings);
        let cones: Vec<_> = cones.filter(|s| s.method == CONE).collect();
        assert_eq!(cones.len(), 2 * sweep.rows.len());
        assert!(
            cones
                .iter()
                .all(|s| s.map_source.is_none() && s.max_steps.is_none())
        );
    }
}
