//! `revmap stability`: the cases in which methods fail.

use super::options::{MethodParser, searches};
use super::output;
use super::progress::{Progress, interrupt, interrupted};
use super::run::Results;
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap::settings::Solver;
use revmap_bench::plan::method::Method;
use revmap_bench::report::folder;
use revmap_searches::CIRCLE;
use revmap_stability::case::SOLVERS as USUAL;
use revmap_stability::run::{Plan, run};
use revmap_stability::{cases, random, report};
use std::path::Path;
use std::sync::atomic::Ordering;

/// Draws the cases in which methods fail and holds every search to the reference; fails if the
/// default does
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap stability --quick --out out/stability\n  \
    revmap stability --random 1000 --seed 7")]
pub struct Stability {
    /// Names of cases [default: all]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// The searches, and folders of other searches [default: circle, live, quadric and the default]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = MethodParser)]
    solver: Vec<Method>,
    /// The first and the last scene of each case; without --solver, by circle and the default alone
    #[arg(long)]
    quick: bool,
    /// So many random scenes in place of the cases, by the default; a failing one is written as the
    /// smallest scene that still fails
    #[arg(long, value_name = "N", conflicts_with_all = ["cases", "solver", "quick"])]
    random: Option<u64>,
    /// The first random scene's seed; from 50000000 on, scenes are views along the axis
    #[arg(long, value_name = "S", default_value_t = 1, requires = "random")]
    seed: u64,
    #[command(flatten)]
    results: Results,
}

impl Stability {
    pub fn run(self) -> Result<()> {
        let chosen = cases::named(&self.cases)?;
        let solvers = self.solvers()?;
        let begun = self.results.begin(|| Ok(Vec::new()))?;
        let (out, stop) = (begun.out, begun.stop);
        if let Some(count) = self.random {
            return self.random(&begun.device, count, &out);
        }
        let progress = Progress::start("stability", self.results.quiet);
        let plan = Plan {
            cases: &chosen,
            solvers: &solvers,
            quick: self.quick,
            folder: &out.join("scenes"),
        };
        let outcome = run(&begun.device, &plan, &mut |what, done, all| {
            progress.say(what);
            progress.report(done, all);
            !stop.load(Ordering::Relaxed)
        })?;
        drop(progress);
        if outcome.trials.is_empty() && stop.load(Ordering::Relaxed) {
            folder::discard(&out, begun.made)?;
            let message = "interrupted before the first picture; nothing was kept";
            return Err(Error::new(ErrorKind::Other, message).in_file(out));
        }
        report::write(&out, &chosen, &solvers, &outcome, &begun.machine)?;
        let tables = [
            Some(report::table(&chosen, &solvers, &outcome)),
            report::flicker(&chosen, &solvers, &outcome),
        ];
        output::result(report::HEADLINE);
        for table in tables.iter().flatten() {
            let text = table.within(output::width(), "report.html");
            text.lines().for_each(output::result);
        }
        for line in report::errors(&chosen, &outcome) {
            output::warn(&line);
        }
        let (page, count) = (out.join("report.html"), outcome.trials.len());
        output::result(&format!("{}: {count} pictures", page.display()));
        let failures = report::failures(&chosen, &outcome);
        for line in &failures {
            output::result(line);
        }
        if stop.load(Ordering::Relaxed) {
            return Err(interrupted(&out, self.results.out.is_some()));
        }
        if !failures.is_empty() {
            let message = format!(
                "the default search failed {} pictures that are not known to fail; see report.html",
                failures.len()
            );
            return Err(Error::new(ErrorKind::Other, message).in_file(out));
        }
        Ok(())
    }

    fn random(&self, device: &Device, count: u64, out: &Path) -> Result<()> {
        let progress = Progress::start("random scenes", self.results.quiet);
        let stop = interrupt()?;
        let mut drawn = 0;
        let failures = random::run(device, (self.seed, count), out, &mut |done| {
            drawn = done;
            progress.report(done as usize, count as usize);
            !stop.load(Ordering::Relaxed)
        })?;
        drop(progress);
        for failure in &failures {
            let file = out.join(&failure.file);
            let (seed, what, file) = (failure.seed, &failure.what, file.display());
            output::result(&format!("seed {seed}: {what}; {file}"));
        }
        let stopped = stop.load(Ordering::Relaxed);
        let drawn = if stopped { drawn } else { count };
        output::result(&format!("{drawn} random scenes, {} failed", failures.len()));
        if failures.is_empty() && !stopped {
            return Ok(());
        }
        let message = match failures.len() {
            0 => "interrupted, without a failure until then; run it again".to_owned(),
            count => format!("{count} of {drawn} random scenes failed"),
        };
        Err(Error::new(ErrorKind::Other, message).in_file(out))
    }

    fn solvers(&self) -> Result<Vec<Solver>> {
        if self.solver.is_empty() {
            return Ok(match self.quick {
                true => vec![CIRCLE, Solver::DEFAULT],
                false => USUAL.to_vec(),
            });
        }
        searches(&self.solver)
    }
}
