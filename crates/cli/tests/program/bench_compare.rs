//! `revmap bench --compare` with planted runs.

use crate::run::{Bench, lines};
use revmap_lab::report::columns;
use revmap_lab::report::table::Table;

/// A folder with a run of one row.
fn run(bench: &Bench, folder: &str, driver: &str, processor: &str) {
    let value = |name: &str| match name {
        "scene" => "vase".to_owned(),
        "device" => "card".to_owned(),
        "driver" => driver.to_owned(),
        _ => String::new(),
    };
    let row = columns::results().map(value).collect();
    let raw = ["row", "pass", "gpu_ms", "frame_ms"];
    let times = ["1", "1", "", "20"].map(str::to_owned).to_vec();
    std::fs::create_dir(bench.path(folder)).unwrap();
    let file = |name: &str, text: String| bench.file(&format!("{folder}/{name}"), text);
    file(
        "results.csv",
        Table::new(columns::results(), vec![row]).csv(),
    );
    file("raw.csv", Table::new(raw, vec![times]).csv());
    file(
        "machine.txt",
        format!("device: card\nprocessor: {processor}\n"),
    );
}

#[test]
fn runs_of_two_machines_bring_warnings() {
    let bench = Bench::new();
    run(&bench, "old", "driver 1", "Xeon, 2 threads");
    run(&bench, "same", "driver 1", "Xeon, 2 threads");
    run(&bench, "other", "driver 2", "EPYC, 2 threads");
    assert!(lines(&bench.done("bench --compare old same")).is_empty());
    let said = lines(&bench.done("bench --compare old other"));
    assert_eq!(said.len(), 2, "{said:?}");
    for (line, words) in said.iter().zip([
        ["driver", "driver 1", "driver 2"],
        ["processor", "Xeon, 2 threads", "EPYC, 2 threads"],
    ]) {
        let [name, old, new] = words;
        let start = format!("warning: the runs differ in {name}: old {old:?}, new {new:?}");
        assert!(line.starts_with(&start), "{line}");
    }
}
