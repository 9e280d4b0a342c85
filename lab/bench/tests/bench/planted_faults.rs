//! The benchmark itself on trial: planted faults that it must find, with a stand-in for the device.

use crate::stand_in::{Fault, StandIn, measured, plan, run};
use revmap::error::ErrorKind;
use revmap::settings::Solver;
use revmap_bench::measure::TRIES;
use revmap_bench::measure::machine::Machine;
use revmap_bench::measure::ratios::{Over, Ratio, over};
use revmap_bench::measure::row::{Clocks, Row};
use revmap_bench::plan::is_rbm_baseline;
use revmap_bench::plan::method::Method;
use revmap_bench::report::columns::{Context, results_table};
use revmap_bench::report::exhibit;
use revmap_bench::report::folder;
use revmap_figures::chart::front::front;
use revmap_searches::CIRCLE;
use std::sync::atomic::AtomicBool;

fn of(rows: &[Row], method: Method) -> Vec<&Row> {
    rows.iter()
        .filter(|r| r.settings.method == method && !is_rbm_baseline(&r.settings))
        .collect()
}

/// The live search over the RBM baseline.
fn live(rows: &[Row]) -> Ratio<'_> {
    let mut ratios = over(rows, Over::Baseline).into_iter();
    ratios.find(|r| r.settings.method == Solver::Live).unwrap()
}

/// Places of (time, error) on a chart and which of them are on the front, of the first view.
fn on_front(rows: &[Row]) -> Vec<Method> {
    let first: Vec<&Row> = rows.iter().filter(|r| r.view == 0).collect();
    let place = |r: &&Row| {
        let error = r.errors.depth.map_or(f64::NAN, |d| d.p99);
        (r.time().map_or(f64::NAN, |t| t.value), error)
    };
    let points: Vec<_> = first.iter().map(place).collect();
    let best = front(&points, 1.0).into_iter();
    best.map(|i| first[i].settings.method).collect()
}

#[test]
fn without_a_fault_all_is_as_it_was_planted() {
    let outcome = measured(Fault::None);
    let counts = (outcome.rows.len(), outcome.left_out.len());
    assert_eq!((counts, outcome.interrupted), ((6, 0), false));
    let live = live(&outcome.rows);
    assert!(
        (live.time.value - 0.5).abs() < 0.03 && live.pairs.len() == 2,
        "{live:?}"
    );
    assert_eq!(live.wrong(), 0.0);
    let p99 = |(row, _): &(&Row, &Row)| row.errors.depth.unwrap().p99;
    assert!(live.pairs.iter().all(|pair| p99(pair) < 0.01));
    assert!(on_front(&outcome.rows).contains(&Method::Search(Solver::Live)));
}

#[test]
fn a_search_that_sleeps_is_charted_slower() {
    let outcome = measured(Fault::Sleeps);
    let live = live(&outcome.rows);
    let time = live.time;
    assert!(
        (time.value - 1.5).abs() < 0.08 && time.low > 1.0,
        "{time:?}"
    );
    let slept = of(&outcome.rows, Method::Search(Solver::Live));
    let other = of(&outcome.rows, Method::Search(CIRCLE));
    for (slept, other) in slept.iter().zip(&other) {
        assert!(slept.time().unwrap().low > other.time().unwrap().high);
    }
    // In the chart its marker stands further right; the plot's markers come before the legend's.
    let rows: Vec<&Row> = outcome.rows.iter().filter(|r| r.view == 0).collect();
    let machine = Machine::here("stand-in", "none", "none", "0", "revmap bench");
    let plan = plan();
    let all: Vec<&Row> = outcome.rows.iter().collect();
    let context = Context::new(&all, &plan, &machine, 0.25);
    let charts = exhibit::all(&[]).unwrap();
    let chart = &charts.iter().find(|e| e.name == "error").unwrap().chart[0];
    let figures = chart.figures(&context, &rows);
    let figure = figures.unwrap().remove(0);
    let dots = figure.shapes();
    assert!(dots[0][0] > dots[1][0] + 20.0, "{dots:?}");
}

#[test]
fn a_search_that_returns_the_boxs_face_is_charted_wrong() {
    let outcome = measured(Fault::BoxFace);
    for row in of(&outcome.rows, Method::Search(Solver::Live)) {
        assert!(row.errors.ghost > 100, "{:?}", row.errors);
        assert!(row.errors.depth.unwrap().p99 > 10.0 && row.errors.normal.unwrap().rms > 10.0);
        assert!(row.errors.wrong() > 0.2);
    }
    // It must not stand on the front.
    assert_eq!(on_front(&outcome.rows), [Method::Search(CIRCLE)]);
    assert!(over(&outcome.rows, Over::Baseline)[0].wrong() > 0.2);
}

#[test]
fn a_clock_that_lies_is_rejected() {
    let outcome = measured(Fault::ClockLies);
    for row in of(&outcome.rows, Method::Search(Solver::Live)) {
        assert!(matches!(row.clocks(), Clocks::Disagree { .. }));
        assert_eq!(row.time(), None);
    }
    let ratios = over(&outcome.rows, Over::Baseline);
    assert!(ratios.iter().all(|r| r.settings.method != Solver::Live));
    assert!(!on_front(&outcome.rows).contains(&Method::Search(Solver::Live)));
    let marked = folder::excluded(&plan(), &outcome);
    assert_eq!(marked.records.len(), 2);
    let first = &marked.records[0];
    assert!(first[4].contains("more than 15 % apart"), "{first:?}");
    // In results.csv the lie is not told.
    let machine = Machine::here("stand-in", "none", "none", "0", "revmap bench");
    let results = results_table(&outcome.rows, &plan(), &machine, 0.25).unwrap();
    let [method, gpu, frame] =
        ["solver", "gpu_ms_median", "frame_ms_median"].map(|c| results.column(c).unwrap());
    for record in &results.records {
        assert_eq!(record[gpu].is_empty(), record[method] == "live");
        assert!(!record[frame].is_empty());
    }
}

/// A pass in which another program had the processor is measured again, and a clock that always lies
/// a bounded number of times.
#[test]
fn a_disturbed_pass_is_measured_again() {
    let frames = |fault| {
        let mut bench = StandIn::new(fault);
        let outcome = run(&mut bench, &AtomicBool::new(false)).unwrap();
        let told = outcome.rows.iter().filter(|r| r.time().is_some()).count();
        let kept: usize = outcome.rows.iter().map(|r| r.frame_ms().len()).sum();
        (told, kept, bench.frames.borrow().len())
    };
    // Four passes of six rounds, and one frame to warm up, of six rows.
    let (kept, warm_up) = (6 * 4 * 6, 6 * 4);
    assert_eq!(frames(Fault::None), (6, kept, kept + warm_up));
    assert_eq!(frames(Fault::Disturbed), (6, kept, kept + 3 * 6 + warm_up));
    assert_eq!(frames(Fault::ClockLies), (4, kept, TRIES * kept + warm_up));
}

#[test]
fn what_does_not_apply_is_left_out_with_its_reason() {
    let outcome = measured(Fault::Refuses);
    assert_eq!((outcome.rows.len(), outcome.left_out.len()), (4, 2));
    assert!(outcome.left_out[0].1.contains("does not apply"));
    let mut lost = StandIn::new(Fault::DeviceLost);
    let error = run(&mut lost, &AtomicBool::new(false)).unwrap_err();
    assert_eq!(error.kind, ErrorKind::DeviceLost);
}
