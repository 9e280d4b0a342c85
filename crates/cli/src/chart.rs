//! `revmap chart`: speed against accuracy.

use super::bench::Session;
use super::lists::Lists;
use super::output;
use super::progress::Progress;
use clap::Args;
use revmap::error::Result;
use revmap_lab::method::{Method, MethodSettings};
use revmap_lab::report::measure::{RenderedCase, TimeBudget};
use revmap_lab::report::plan::{Axes, Plan, is_rbm_baseline};
use revmap_lab::report::suite::Extent;
use revmap_lab::report::sweep::Sweep;
use revmap_lab::report::{curves, folder, map_error, text};
use std::path::PathBuf;

/// Charts speed against accuracy: every search over its budget and its maps
///
/// Steps, rows, sources and formats of maps are swept one at a time; where one of their lists is
/// given, every combination of the lists is measured instead.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap chart --quick --out out/chart\n  \
    revmap chart assets/scenes/vase.toml --solver circle,live --max-steps 10,20,40,80")]
pub struct Chart {
    #[command(flatten)]
    lists: Lists,
    /// A look: one solid unless scenes are named, one stage, small pictures, few values
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// The whole suite from three elevations, many values: takes hours on two cores
    #[arg(long)]
    full: bool,
}

impl Chart {
    pub fn run(self) -> Result<()> {
        self.lists.check()?;
        let (mut sweep, budget, extent, elevations): (_, _, _, &[f64]) = if self.quick {
            (Sweep::quick(), TimeBudget::QUICK, Extent::One, &[25.0])
        } else if self.full {
            (
                Sweep::full(),
                TimeBudget::FULL,
                Extent::All,
                &[0.0, 25.0, 60.0],
            )
        } else {
            (Sweep::new(), TimeBudget::CHART, Extent::Three, &[25.0])
        };
        let views = self.lists.views(extent, elevations)?;
        let lists = &self.lists;
        let given = [
            lists.max_steps.len(),
            lists.map_rows.len(),
            lists.map_source.len(),
            lists.map_format.len(),
        ];
        let axes = lists.axes(&Axes {
            stages: sweep.stages.clone(),
            sizes: vec![sweep.size],
            ..Axes::default()
        });
        let mut plan = if given.iter().any(|n| *n > 0) {
            Plan::new(views, &axes.combinations())
        } else {
            sweep.stages = axes.stages;
            sweep.methods = axes.methods;
            if !lists.solver.is_empty() {
                sweep.meshes.clear();
            }
            let mut all = Plan {
                views,
                cases: Vec::new(),
                mixed: false,
            };
            for size in axes.sizes {
                sweep.size = size;
                all.cases.extend(sweep.plan(all.views.clone()).cases);
            }
            all
        };
        plan.add_rbm_baseline();
        plan.add_floors();
        let session = Session::open(lists)?;
        let size = plan
            .cases
            .first()
            .map_or(sweep.size, |c| (c.settings.width, c.settings.height));
        let mut truths = map_error::Truths::default();
        let mut keep = |seen: &RenderedCase| {
            if (seen.truth.width, seen.truth.height) == size {
                truths.keep(seen.case.view, seen.truth);
            }
        };
        let (measured, album) = session.measure(
            &plan,
            &lists.time_budget(&budget),
            worth_a_picture,
            &mut keep,
        )?;
        let alone = if measured.interrupted {
            Vec::new()
        } else {
            let progress = Progress::start("errors of the maps alone", lists.quiet);
            map_error::measure(&plan, size, &truths, &mut |done, all| {
                progress.report(done, all)
            })?
        };
        folder::write(&session.out, &plan, &measured, &session.machine)?;
        curves::write(
            &session.out,
            &plan,
            &measured,
            &session.machine,
            &album,
            &alone,
        )?;
        let summary: PathBuf = session.out.join("charts").join("summary-depth-error.png");
        for line in text::summary(&measured.rows).lines() {
            output::result(line);
        }
        output::result(&summary.display().to_string());
        session.finish(&plan, &measured)
    }
}

/// Of a sweep only searches as they are drawn by default, and at one middling budget.
fn worth_a_picture(settings: &MethodSettings) -> bool {
    let plain = settings.map_rows.is_none()
        && settings.map_source.is_none()
        && settings.map_format == MethodSettings::default().map_format;
    let drawn = settings.method != Method::Floor;
    is_rbm_baseline(settings) || (drawn && plain && matches!(settings.max_steps, None | Some(64)))
}
