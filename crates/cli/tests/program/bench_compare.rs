//! `revmap bench --compare` with planted runs.

use crate::run::{Bench, lines};
use revmap_bench::columns;
use revmap_bench::table::Table;

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

/// Variables, niceness and allowed processors change times.
#[test]
fn runs_in_other_surroundings_bring_warnings() {
    let bench = Bench::new();
    let note = |folder: &str, lines: &str| {
        run(&bench, folder, "driver 1", "Xeon, 2 threads");
        let note = format!("device: card\nprocessor: Xeon, 2 threads\n{lines}");
        bench.file(&format!("{folder}/machine.txt"), note);
    };
    note("plain", "niceness: 0\nvariable: none\n");
    note("other", "niceness: 10\nvariable: GALLIVM_PERF=nopt\n");
    assert!(lines(&bench.done("bench --compare plain plain")).is_empty());
    let said = lines(&bench.done("bench --compare plain other"));
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said[0].contains("differ in GALLIVM_PERF: old not set, new \"nopt\""),
        "{said:?}"
    );
    assert!(
        said[1].contains("differ in niceness: old \"0\", new \"10\""),
        "{said:?}"
    );
}

/// The kept run of the README, judged by itself; then a copy of it with one changed figure.
#[test]
fn a_changed_figure_of_a_kept_run_is_not_repeated() {
    let bench = Bench::new();
    let kept = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../results/2026-11-24-lavapipe-22.3.6-3"
    );
    let methods = "exact,mesh:64x128,mesh:512x1024,baseline";
    let judge = |old: &str| format!("bench --compare {old} {kept} --repeats {methods}");
    let said = bench.said(&judge(kept));
    assert!(
        said.contains("repeated      exact, fragment: takes 0.562"),
        "{said}"
    );
    assert!(
        said.contains("17 of 17 claims repeated") && !said.contains("NOT"),
        "{said}"
    );

    std::fs::create_dir(bench.path("copy")).unwrap();
    let copy = |name: &str, text: String| bench.file(&format!("copy/{name}"), text);
    let read = |name: &str| std::fs::read_to_string(format!("{kept}/{name}")).unwrap();
    let mut results = Table::parse(&read("results.csv")).unwrap();
    let (solver, p99) = (
        results.column("solver").unwrap(),
        results.column("depth_p99_texels").unwrap(),
    );
    for record in results.records.iter_mut().filter(|r| r[solver] == "exact") {
        record[p99] = (2.0 * record[p99].parse::<f64>().unwrap()).to_string();
    }
    copy("results.csv", results.csv());
    copy("raw.csv", read("raw.csv"));
    let output = bench.command(&judge("copy")).output().unwrap();
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("NOT repeated  exact, fragment: depth errors of"),
        "{said}"
    );
    assert!(said.contains("15 of 17 claims repeated"), "{said}");
    assert!(lines(&output)[0].contains("does not repeat"));
}

/// A pipe has the whole table, and a terminal the columns that fit and the names of the others.
#[cfg(target_os = "linux")] // `script`, a part of util-linux, makes the terminal
#[test]
fn a_table_fits_the_terminal() {
    let bench = Bench::new();
    run(&bench, "old", "driver 1", "Xeon, 2 threads");
    let piped = bench.said("bench --compare old old");
    let head = "measurement  new / old  95 % interval\n";
    assert!(piped.contains(head), "{piped}");
    let shown = |columns: u32| {
        let program = env!("CARGO_BIN_EXE_revmap");
        let line = format!("stty rows 24 cols {columns}; {program} bench --compare old old");
        let mut terminal = std::process::Command::new("script");
        terminal.args(["-qec", &line, "/dev/null"]);
        let output = terminal.current_dir(bench.path("")).output().unwrap();
        String::from_utf8(output.stdout).unwrap().replace('\r', "")
    };
    assert_eq!(shown(80), piped);
    let narrow = shown(30);
    let wanted = "measurement  new / old\nvase                 1\n\
        wider than the terminal; a pipe, such as `| less -S`, also has: 95 % interval\n";
    assert!(narrow.contains(wanted), "{narrow}");
}
