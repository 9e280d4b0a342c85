//! `revmap stability`: its table, its files, its exit codes.

use crate::run::{Bench, holds, lines};

#[test]
fn a_case_that_passes_leaves_a_report_and_its_scenes() {
    let bench = Bench::new();
    let table = bench.said("stability cone-tip --quick --solver hull --out kept --quiet");
    holds(&table, &["cone-tip", "exact"]);
    bench.has(&["kept/report.html", "kept/scenes/cone-tip-0.toml"]);
    bench.has(&["kept/charts/cone-tip.svg"]);
    let results = bench.text("kept/results.csv");
    // Two scenes in two stages, below the header.
    assert_eq!(results.lines().count(), 5, "{results}");
}

/// The papers' loop fails, but the default alone decides.
#[test]
fn other_searches_may_fail() {
    let bench = Bench::new();
    let said = bench.said("stability budget --quick --solver circle --out kept --quiet");
    assert!(said.contains("FAILED"));
    assert!(said.starts_with("worst share of wrong pixels over hit pixels; "));
}

#[test]
fn random_scenes_are_counted() {
    let bench = Bench::new();
    let said = bench.said("stability --random 3 --seed 5 --out kept --quiet");
    assert!(said.contains("3 random scenes, 0 failed"), "{said}");
}

#[test]
fn unknown_cases_and_meshes_are_wrong_usage() {
    let bench = Bench::new();
    bench.refuses(
        2,
        "stability cone-tips                  | cone-tips | cone-tip
         stability cone-tip --solver mesh:8x8 | --solver
         stability cone-tip --random 5        | --random",
    );
}

/// A scene that is too large for every map is no fault of the search.
#[test]
fn a_case_whose_map_is_too_large_is_named() {
    let bench = Bench::new();
    let relief = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../lab/searches/published/relief"
    );
    let said = lines(&bench.done(&format!(
        "stability large-outline --quick --solver {relief} --out kept --quiet"
    )));
    let warned =
        "warning: large-outline at 10000 is not drawn by relief (folder): its map is too large";
    assert!(said.iter().any(|l| l.starts_with(warned)), "{said:?}");
    assert!(!said.iter().any(|l| l.contains("failed")), "{said:?}");
}
