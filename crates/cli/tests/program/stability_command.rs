//! `revmap stability`: its table, its files, its exit codes.

use crate::run::Bench;

#[test]
fn a_case_that_passes_leaves_a_report_and_its_scenes() {
    let bench = Bench::new();
    let table = bench.said("stability cone-tip --quick --solver hull --out kept --quiet");
    let names = table.contains("cone-tip") && table.contains("exact");
    assert!(names, "{table}");
    bench.has(&["kept/report.html", "kept/scenes/cone-tip-0.toml"]);
    bench.has(&["kept/charts/cone-tip.svg"]);
    let results = String::from_utf8(bench.read("kept/results.csv")).unwrap();
    // Two scenes in two stages, below the header.
    assert_eq!(results.lines().count(), 5, "{results}");
}

/// The papers' loop fails, but the default alone decides.
#[test]
fn other_searches_may_fail() {
    let bench = Bench::new();
    let said = bench.said("stability budget --quick --solver circle --out kept --quiet");
    assert!(said.contains("FAILED"));
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
