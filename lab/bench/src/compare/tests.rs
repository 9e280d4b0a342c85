#![allow(clippy::unwrap_used)]
use super::*;
use crate::measure::drawn::{self, Drawn};
use crate::measure::row::Row;
use crate::measure::row::tests::{self, papers, row};
use crate::plan::Plan;
use crate::plan::method::{Edges, Method};
use crate::plan::view::tests::spindle;
use crate::report::columns::tests::csv_of;
use crate::report::folder::{raw, write_text};
use revmap::settings::DrawStage;

/// The folder of a run of these rows.
pub(super) fn folder_of(rows: &[Row], device: &str, driver: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let results = csv_of(rows, device, driver);
    write_text(&folder.path().join("results.csv"), &results.csv()).unwrap();
    write_text(&folder.path().join("raw.csv"), &raw(rows).csv()).unwrap();
    folder
}

fn run(rows: &[Row]) -> tempfile::TempDir {
    folder_of(rows, "device, with a comma", "driver")
}

fn verdicts(found: &Against) -> Vec<Verdict> {
    found.pairs.iter().map(|pair| pair.verdict).collect()
}

fn timed(times: [f64; 4], stage: DrawStage) -> Row {
    let pass = |t: f64| [(0.99 * t, t), (t, 1.01 * t), (0.98 * t, t)];
    let passes = times.map(|t| pass(t).map(|(gpu, frame)| (Some(gpu), frame)));
    row(&passes.each_ref().map(|p| p.as_slice())).set(|s| s.stage = stage)
}

#[test]
fn planted_changes_are_found() {
    let old = run(&[
        timed([10.0, 10.2, 9.9, 10.1], DrawStage::Fragment),
        timed([20.0, 21.0, 19.0, 20.5], DrawStage::Compute),
    ]);
    let mut slow = timed([12.0, 12.2, 11.9, 12.1], DrawStage::Fragment);
    slow.errors.missed = 40;
    let new = run(&[slow, timed([20.4, 20.0, 21.0, 19.5], DrawStage::Compute)]);
    let found = compare(&[old.path(), new.path()]).unwrap();
    assert_eq!(verdicts(&found), [Verdict::Slower, Verdict::Even]);
    assert!((found.pairs[0].time.unwrap().value - 1.2).abs() < 0.01);
    assert_eq!(found.pairs[0].changed, [("missed", 0.0, 40.0)]);
    let text = as_text(&found, None);
    assert!(text.contains("1 slower, 0 faster, 1 within"), "{text}");
    for line in [
        "slower: fragment: 1.2 (",
        "less exact: fragment: missed 0 to 40",
    ] {
        assert!(text.contains(&format!("\n{line}")), "{text}");
    }
    let back = compare(&[new.path(), old.path()]).unwrap();
    assert_eq!(back.pairs[0].verdict, Verdict::Faster);
    assert_eq!(back.pairs[0].changed, [("missed", 40.0, 0.0)]);
}

/// One run had a machine of half the speed: the RBM baseline tells so.
#[test]
fn a_slower_machine_is_told_from_a_slower_search() {
    let papers = |times| papers(timed(times, DrawStage::Fragment));
    let search =
        |times, steps| timed(times, DrawStage::Fragment).set(|s| s.max_steps = Some(steps));
    let old = run(&[
        papers([10.0, 10.2, 9.9, 10.1]),
        search([5.0, 5.1, 4.9, 5.0], 30),
        search([5.0, 5.1, 4.9, 5.0], 40),
    ]);
    let new = run(&[
        papers([20.0, 20.4, 19.8, 20.2]),
        search([10.0, 10.2, 9.8, 10.0], 30),
        search([15.0, 15.2, 14.8, 15.0], 40),
    ]);
    let found = compare(&[old.path(), new.path()]).unwrap();
    let wanted = [Verdict::Even, Verdict::Even, Verdict::Slower];
    assert_eq!(verdicts(&found), wanted);
    assert!((found.pairs[2].relative.unwrap().value - 1.5).abs() < 0.02);
    assert!(as_text(&found, None).contains("the RBM baseline itself differs"));
}

/// Forty measurements of one program, each run with a drift of its own: nothing is named in nineteen of
/// twenty comparisons, and a change by a fifth in every one.
#[test]
fn a_run_against_itself_names_nothing() {
    let mut random = crate::random::Random(1);
    let mut normal = || (0..12).map(|_| random.next()).sum::<f64>() - 6.0;
    let mut rows = |changed: f64| -> Vec<Row> {
        let row = |steps: u32| {
            let own = 10.0 * (0.02 * normal()).exp() * if steps == 7 { changed } else { 1.0 };
            let times = [0; 4].map(|_| own * (0.02 * normal()).exp());
            timed(times, DrawStage::Fragment).set(|s| s.max_steps = Some(steps + 1))
        };
        (0..40).map(row).collect()
    };
    let (mut silent, mut found) = (0, 0);
    for _ in 0..40 {
        let old = run(&rows(1.0));
        let [same, slow] = [run(&rows(1.0)), run(&rows(1.35))];
        let changed = |new: &tempfile::TempDir| {
            let verdicts = verdicts(&compare(&[old.path(), new.path()]).unwrap());
            let named = (0..verdicts.len()).filter(|k| verdicts[*k] != Verdict::Even);
            named.collect::<Vec<_>>()
        };
        silent += usize::from(changed(&same).is_empty());
        found += usize::from(changed(&slow).contains(&7));
    }
    assert!(silent >= 38 && found >= 38, "{silent} {found}");
}

#[test]
fn a_rejected_clock_gives_no_verdict() {
    let fine = run(&[timed([10.0; 4], DrawStage::Fragment)]);
    let mut lies = timed([10.0; 4], DrawStage::Fragment);
    let samples = lies.passes.iter_mut().flatten();
    samples.for_each(|s| s.gpu_ms = Some(0.036));
    let lies = run(&[lies]);
    let found = compare(&[fine.path(), lies.path()]).unwrap();
    assert_eq!(verdicts(&found), [Verdict::Unresolved]);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let a = run(&[timed([10.0; 4], DrawStage::Fragment)]);
    let b = run(&[timed([10.0; 4], DrawStage::Compute)]);
    let refused = || compare(&[a.path(), b.path()]).unwrap_err().to_string();
    assert!(refused().contains("in common"));
    let empty = tempfile::tempdir().unwrap();
    let error = compare(&[a.path(), empty.path()]).unwrap_err();
    assert!(error.file.unwrap().ends_with("results.csv"));
    std::fs::write(b.path().join("results.csv"), "scene,solver\nx,y\n").unwrap();
    assert!(refused().contains("other columns"));
}

/// Rows that only a tolerance or the treatment of edges tells apart are compared with their own.
#[test]
fn tolerances_and_edges_are_told_apart() {
    let with = |tolerance, edges, ms| {
        timed([ms; 4], DrawStage::Fragment).set(|s| {
            s.method = Method::DEFAULT;
            s.tolerance = revmap::settings::Tolerance::new(tolerance).unwrap();
            s.edges = edges;
        })
    };
    let (one, four) = (Edges::OneRay, Edges::Rays(4));
    let run = run(&[
        with(0.0, one, 10.0),
        with(0.25, one, 5.0),
        with(0.0, four, 40.0),
    ]);
    let found = compare(&[run.path(), run.path()]).unwrap();
    assert_eq!(verdicts(&found), [Verdict::Even; 3]);
    let ratios: Vec<f64> = found.pairs.iter().map(|p| p.time.unwrap().value).collect();
    assert_eq!(ratios, [1.0; 3]);
    let ways: Vec<&[String]> = found.table.records.iter().map(|r| &r[3..5]).collect();
    assert_eq!(ways, [["0", "1 ray"], ["0.25", "1 ray"], ["0", "4 rays"]]);
}

/// The default takes `ms` of the RBM baseline's 20 in some pictures of a driver.
fn of_driver(driver: &str, pictures: &[(&str, DrawStage, f64)]) -> tempfile::TempDir {
    let rows = pictures.iter().flat_map(|&(scene, stage, ms)| {
        let mut ours = tests::drawn(Method::DEFAULT, stage, &[ms, ms], 0.01);
        ours.scene = scene.to_owned();
        ours.errors.missed = 48;
        let mut papers = papers(ours.clone());
        papers.passes = tests::timed(&[20.0, 20.0]).passes;
        [ours, papers]
    });
    folder_of(&rows.collect::<Vec<_>>(), "device", driver)
}

/// Three runs: a column for each driver, a row for each technique and way, over common pictures.
#[test]
fn each_driver_has_a_column_and_each_technique_a_row() {
    let (fragment, compute) = (DrawStage::Fragment, DrawStage::Compute);
    let pictures = |factor: f64| {
        [
            ("vase-revolution", fragment, factor * 5.0),
            ("pawn-revolution:close", fragment, factor * 20.0),
            ("vase-textured", fragment, factor * 8.0),
            ("vase-e0.25-box", fragment, factor * 30.0),
            ("vase-e0.25-box", compute, factor * 30.0),
        ]
    };
    let runs = [
        of_driver("one 1.2", &pictures(1.0)),
        of_driver("two", &pictures(2.0)),
        of_driver("three", &pictures(4.0)[..3]),
    ];
    let found = compare(&runs.each_ref().map(|run| run.path())).unwrap();
    let own = found.table.records.iter().filter(|r| r[1] == "exact");
    let own: Vec<String> = own.map(|r| r.join(", ")).collect();
    let wanted = [
        "revolution, exact, fragment, 0.5 (0.5 to 0.5); 0.01; 96, 1 (1 to 1); 0.01; 96, 2 (2 to 2); 0.01; 96",
        "textured, exact, fragment, 0.4 (0.4 to 0.4); 0.01; 48, 0.8 (0.8 to 0.8); 0.01; 48, 1.6 (1.6 to 1.6); 0.01; 48",
        "revolution, cut by the box, exact, fragment, –, –, –",
        "revolution, cut by the box, exact, compute, –, –, –",
    ];
    assert_eq!(own, wanted);
    assert!(found.table.header[3].starts_with("one 1.2: time / RBM baseline"));
    assert!(found.pairs.is_empty() && found.warnings[0].starts_with("no drawn.toml in "));
    // Different scenes under one name are not compared.
    for (run, eye) in runs.iter().zip([2.0, 2.0, 2.5]) {
        let mut view = spindle();
        view.name = "vase-revolution".to_owned();
        view.scene.camera.eye.x = eye;
        let text = Drawn::of(&Plan::new(vec![view])).text().unwrap();
        std::fs::write(run.path().join(drawn::FILE), text).unwrap();
    }
    let found = compare(&runs.each_ref().map(|run| run.path())).unwrap();
    let wanted = "the runs drew different scenes as vase-revolution: camera.eye (old [2.0, ";
    assert!(
        found.warnings.iter().any(|w| w.starts_with(wanted)),
        "{:?}",
        found.warnings
    );
    assert!(
        found.table.records[0][3].starts_with("1 (1 to 1)"),
        "{:?}",
        found.table
    );
}
