#![allow(clippy::unwrap_used)]
use super::*;
use crate::measure::row::tests::{drawn, papers, row, timed};
use crate::plan::method::Method;

/// Passes of the default and of the baseline in two views: 5 ms over 20 and 20 over 20.
fn two_views(passes: [usize; 2]) -> Vec<Row> {
    let rows = |(view, ours): (usize, f64)| {
        let mut rows = [vec![ours; passes[view]], vec![20.0; passes[view]]]
            .map(|times| timed(&times))
            .map(|row| Row { view, ..row });
        rows[1] = papers(rows[1].clone());
        rows
    };
    [(0, 5.0), (1, 20.0)].into_iter().flat_map(rows).collect()
}

/// A machine that slows down to a third within a pass and between passes changes no ratio.
#[test]
fn drift_of_the_machine_cancels() {
    let ours = row(&[&[(None, 10.0), (None, 30.0)], &[(None, 20.0), (None, 11.0)]]);
    let theirs = row(&[&[(None, 20.0), (None, 60.0)], &[(None, 40.0), (None, 22.0)]]);
    let rows = [ours, papers(theirs)];
    let ratios = over(&rows, Over::Baseline);
    assert_eq!(ratios.len(), 2);
    let time = ratios[0].time;
    assert!((time.value - 0.5).abs() < 1e-12, "{time:?}");
    assert!((time.high - time.low) < 1e-9, "{time:?}");
    assert!((ratios[1].time.value - 1.0).abs() < 1e-12);
}

#[test]
fn views_are_averaged_geometrically() {
    let rows = two_views([2, 2]);
    let ratio = &over(&rows, Over::Baseline)[0];
    assert!((ratio.time.value - 0.5).abs() < 1e-12);
    assert!((ratio.range.0 - 0.25).abs() < 1e-12 && (ratio.range.1 - 1.0).abs() < 1e-12);
    assert_eq!(ratio.pairs.len(), 2);
}

#[test]
fn what_cannot_be_trusted_counts_for_nothing() {
    let lies = row(&[&[(Some(0.04), 20.0)]]);
    let fine = papers(row(&[&[(Some(20.0), 20.0)]]));
    let rows = [lies.clone(), fine.clone()];
    let ratios = over(&rows, Over::Baseline);
    assert_eq!(ratios.len(), 1, "only the RBM baseline itself");
    // A baseline that lies leaves nothing to compare with; one serves both stages.
    assert!(over(&[timed(&[20.0]), papers(lies)], Over::Baseline).is_empty());
    let compute = timed(&[20.0]).set(|s| s.stage = DrawStage::Compute);
    assert_eq!(over(&[compute, fine], Over::Baseline).len(), 2);
}

/// 8 ms against 20 where 5 go without a search: 3 of the 20 are above the floor.
#[test]
fn the_floor_is_taken_off() {
    let timed = |ms: f64| timed(&[ms, ms]);
    let floor = timed(5.0).set(|s| s.method = Method::Floor);
    let compute = timed(6.0).set(|s| s.stage = DrawStage::Compute);
    let rows = [timed(8.0), floor, papers(timed(20.0)), compute];
    let above = |k: usize| above_floor(&rows, &rows[k]).map(|ms| ms.round());
    assert_eq!([0, 1, 2, 3].map(above), [Some(3.0), None, Some(15.0), None]);
}

/// A picture that lacks a pass must not shift the mean.
#[test]
fn a_pass_that_was_ended_early_is_left_out() {
    let rows = two_views([2, 1]);
    let time = over(&rows, Over::Baseline)[0].time;
    assert!((time.value - 0.5).abs() < 1e-12 && time.high == f64::INFINITY);
}

/// The ratio that counts is that to the coarsest mesh which is not wrong.
#[test]
fn the_default_search_is_held_against_meshes() {
    let timed = |method, ms: f64, p99| drawn(method, DrawStage::Fragment, &[ms, ms], p99);
    let mesh = |n| Method::mesh(n, 2 * n).unwrap();
    let rows = [
        timed(Method::DEFAULT, 9.0, 0.01),
        timed(mesh(64), 6.0, 0.5),
        timed(mesh(512), 36.0, 0.009),
        timed(mesh(256), 18.0, 0.01),
    ];
    let duels = over(&rows, Over::Mesh);
    let percent = |d: &Ratio| (d.time.value * 100.0).round();
    let told = duels.iter().map(|d| (d.mesh, percent(d), d.no_worse()));
    let wanted = [
        (Some(64), 150.0, 0),
        (Some(512), 25.0, 1),
        (Some(256), 50.0, 1),
        (None, 50.0, 1),
    ];
    let wanted = wanted.map(|(n, ratio, no_worse)| (n.map(mesh), ratio, no_worse));
    assert_eq!(told.collect::<Vec<_>>(), wanted);
    // Without a mesh that errs no more, or without the default search, there is no such ratio.
    assert_eq!(over(&rows[..2], Over::Mesh).len(), 1);
    assert!(over(&rows[1..], Over::Mesh).is_empty());
}

/// 10 ms over 20 in the fragment stage, 8 over 16 in compute: both times are put over the 20 of the
/// fragment stage, whichever baseline is drawn first. Without it they are put over the 16.
#[test]
fn both_stages_are_put_over_one_baseline() {
    let timed = |ms: f64, stage| timed(&[ms, ms]).set(|s| s.stage = stage);
    use DrawStage::{Compute, Fragment};
    let rows = [
        papers(timed(16.0, Compute)),
        timed(10.0, Fragment),
        papers(timed(20.0, Fragment)),
        timed(8.0, Compute),
    ];
    let found = |rows: &[Row]| -> Vec<f64> {
        let ratios = over(rows, Over::Baseline).into_iter();
        ratios.map(|r| (r.time.value * 1e6).round() / 1e6).collect()
    };
    assert_eq!(baseline_stage(&rows), Fragment);
    assert_eq!(found(&rows), [0.5, 1.0, 0.8, 0.4]);
    let compute = [rows[0].clone(), rows[3].clone()];
    assert_eq!(baseline_stage(&compute), Compute);
    assert_eq!(found(&compute), [1.0, 0.5]);
    // The same way in the other stage.
    let stages = over(&rows, Over::Fragment);
    let found: Vec<f64> = stages.iter().map(|r| r.time.value).collect();
    assert_eq!(found, [0.8, 0.8]);
    assert!((mean_ms(&[&rows[0], &rows[1]]).unwrap().value - 160f64.sqrt()).abs() < 1e-9);
}
