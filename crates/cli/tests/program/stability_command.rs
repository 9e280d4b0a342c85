//! `revmap stability`: its table, its files, its exit codes.

use crate::run::Bench;

#[test]
fn a_case_that_passes_leaves_a_report_and_its_scenes() {
    let bench = Bench::new();
    let output = bench.done("stability cone-tip --quick --solver hull --out kept --quiet");
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        table.contains("cone-tip") && table.contains("exact"),
        "{table}"
    );
    for file in [
        "results.csv",
        "report.html",
        "scenes/cone-tip-0.toml",
        "charts/cone-tip.svg",
    ] {
        assert!(bench.path("kept").join(file).exists(), "{file}");
    }
    let results = std::fs::read_to_string(bench.path("kept/results.csv")).unwrap();
    // Two scenes in two stages, below the header.
    assert_eq!(results.lines().count(), 5, "{results}");
}

/// The papers' loop fails, but the default alone decides.
#[test]
fn other_searches_may_fail() {
    let bench = Bench::new();
    let output = bench.done("stability budget --quick --solver circle --out kept --quiet");
    assert!(String::from_utf8_lossy(&output.stdout).contains("FAILED"));
}

#[test]
fn random_scenes_are_counted() {
    let bench = Bench::new();
    let output = bench.done("stability --random 3 --seed 5 --out kept --quiet");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("3 random scenes, 0 failed"), "{said}");
}

#[test]
fn unknown_cases_and_meshes_are_wrong_usage() {
    let bench = Bench::new();
    bench.refused("stability cone-tips", 2, &["cone-tips", "cone-tip"]);
    bench.refused("stability cone-tip --solver mesh:8x8", 2, &["--solver"]);
    bench.refused("stability cone-tip --random 5", 2, &["--random"]);
}
