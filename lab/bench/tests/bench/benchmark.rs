//! How a benchmark goes about its plan, with a stand-in for the device.

use crate::stand_in::{Fault, LIMITS, StandIn, plan, run, run_plan};
use revmap_bench::measure::machine::Machine;
use revmap_bench::measure::{Observer, measure};
use revmap_bench::plan::TimeBudget;
use revmap_bench::plan::method::Method;
use revmap_bench::report::Run;
use revmap_bench::report::folder;
use revmap_bench::report::pictures::Album;
use revmap_bench::report::plan_file::embedded;
use revmap_bench::report::series_style::SeriesStyles;
use revmap_bench::report::table::Table;
use std::sync::atomic::AtomicBool;

/// A B C, C B A: nobody always follows the same neighbour; each pass makes all anew.
#[test]
fn samples_are_interleaved_and_passes_are_built_anew() {
    let mut bench = StandIn::new(Fault::None);
    let outcome = run(&mut bench, &AtomicBool::new(false)).unwrap();
    assert_eq!(bench.made, 6 * outcome.rows[0].passes.len());
    let frames = bench.frames.borrow();
    // One frame each to warm up, then the rounds of the first group.
    let rounds: Vec<&[Method]> = frames[3..3 + 6 * 3].chunks(3).collect();
    for pair in rounds.windows(2) {
        let back: Vec<Method> = pair[1].iter().rev().copied().collect();
        assert_eq!(pair[0], back.as_slice());
    }
    assert_ne!(rounds[0], rounds[1]);
}

/// A bout of other work makes a time of the first view unsure: passes are added to that view until
/// the time is resolved, A B C and back as all others, and the other view has no more than planned.
#[test]
fn passes_are_added_until_times_are_resolved() {
    let limits = TimeBudget {
        passes: (2, 3),
        ..LIMITS
    };
    let mut bench = StandIn::new(Fault::Bout);
    let outcome = run_plan(&plan(), &limits, &mut bench, &AtomicBool::new(false)).unwrap();
    let passes: Vec<usize> = outcome.rows.iter().map(|r| r.passes.len()).collect();
    // One slow pass of seven leaves an interval of 0.245 to either side, of six 0.301.
    assert_eq!(passes, [7, 7, 7, 3, 3, 3]);
    assert!(outcome.rows.iter().all(|r| r.resolved(limits.resolved)));
    let frames = bench.frames.borrow();
    // Steady times are known after five rounds.
    let last: Vec<&[Method]> = frames[frames.len() - 5 * 3..].chunks(3).collect();
    for pair in last.windows(2) {
        let back: Vec<Method> = pair[1].iter().rev().copied().collect();
        assert_eq!(pair[0], back.as_slice());
    }
}

/// A time that no number of passes resolves: the run ends at its limit, and says so.
#[test]
fn a_time_that_is_never_resolved_ends_at_the_limit() {
    let limits = TimeBudget {
        seconds: 0.05,
        limit: Some(0.4),
        passes: (2, 3),
        ..LIMITS
    };
    let mut bench = StandIn::new(Fault::Grows);
    let outcome = run_plan(&plan(), &limits, &mut bench, &AtomicBool::new(false)).unwrap();
    let live = &outcome.rows[0];
    assert!(live.passes.len() > 3 && !live.resolved(limits.resolved));
}

/// The reference is slow: it draws each view at each size once.
#[test]
fn no_truth_is_drawn_twice() {
    for mixed in [false, true] {
        let mut plan = plan();
        for case in plan.cases.clone() {
            let smaller = case.settings.sized(32, 24);
            plan.add(case.view, smaller, "");
        }
        plan.mixed = mixed;
        let mut bench = StandIn::new(Fault::None);
        run_plan(&plan, &LIMITS, &mut bench, &AtomicBool::new(false)).unwrap();
        let mut asked = bench.truths.clone();
        asked.sort();
        asked.dedup();
        assert_eq!((bench.truths.len(), asked.len()), (4, 4), "{mixed}");
    }
}

#[test]
fn an_interrupt_keeps_what_was_measured() {
    static STOP: AtomicBool = AtomicBool::new(false);
    let mut bench = StandIn::new(Fault::None);
    // In the second round of the first group.
    bench.stop_after = Some((7, &STOP));
    let outcome = run(&mut bench, &STOP).unwrap();
    assert!(outcome.interrupted);
    assert_eq!(outcome.rows.len(), 3);
    assert!(outcome.rows.iter().all(|r| !r.frame_ms().is_empty()));
    // Before anything is done there is nothing to keep.
    let error = run(&mut StandIn::new(Fault::None), &AtomicBool::new(true)).unwrap_err();
    assert!(error.to_string().contains("stopped before"), "{error}");
}

/// All files of a run; every row is in the page, which needs nothing from elsewhere.
#[test]
fn a_runs_folder_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let driver = "driver 1, with a comma";
    let machine = Machine::here("stand-in", "none", driver, "0", "revmap bench");
    let plan = plan();
    let styles = SeriesStyles::new(plan.cases.iter().map(|c| &c.settings));
    let mut album = Album::new(folder.path(), styles, true).unwrap();
    let mut observer = Observer {
        stop: &AtomicBool::new(false),
        progress: &|_, _, _| {},
        picture: &mut |seen| album.add(seen),
        passed: &mut |rows| {
            assert_eq!(rows.len(), 6, "after each pass every row is there");
            folder::write_rows(folder.path(), rows, &plan, &machine, 0.25)
        },
    };
    let mut bench = StandIn::new(Fault::ClockLies);
    let outcome = measure(&plan, &mut bench, &LIMITS, &mut observer).unwrap();
    folder::write(folder.path(), &plan, &outcome, &machine, 0.25).unwrap();
    // All tables and charts of both kinds of runs.
    let mut file = embedded::plan("usual").unwrap();
    file.show.extend(embedded::plan("chart").unwrap().show);
    let report = Run {
        file: &file,
        plan: &plan,
        measured: &outcome,
        machine: &machine,
        album: &album,
        flights: &[],
    };
    let text = report.write(folder.path(), None).unwrap();
    for wanted in ["RBM baseline", "2 pictures"] {
        assert!(text.contains(wanted), "{text}");
    }
    let samples: usize = outcome.rows.iter().map(|r| r.frame_ms().len()).sum();
    for (file, records) in [
        ("results.csv", 6),
        ("excluded.csv", 2),
        ("raw.csv", samples),
    ] {
        let table = Table::load(&folder.path().join(file)).unwrap();
        assert_eq!(table.records.len(), records, "{file}");
    }
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    for wanted in
        "stand-in|clocks disagree|<svg|data:image/png;base64,|revmap bench|href=\"#f1\"".split('|')
    {
        assert!(page.contains(wanted), "{wanted}");
    }
    for foreign in ["<script", "src=\"http", "href=\"http", "@import"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    let charts =
        "ratios summary error-side-48x36 times-side-48x36 summary-depth-error side-48x36-FLIP";
    for name in charts.split(' ') {
        let file = folder.path().join(format!("charts/{name}.svg"));
        assert!(file.exists(), "{name}");
    }
}
