//! `revmap bench --compare` with planted runs.

use crate::run::{Bench, CAMERA, CONE, holds, lines};
use revmap_bench::plan::suite::{self, Extent};
use revmap_bench::report::columns;
use revmap_bench::report::table::Table;

/// A folder with a run of one row, and a note on its machine.
fn run(bench: &Bench, folder: &str, driver: &str, note: &str) {
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
    file("drawn.toml", "[settings]\n".to_owned());
    file("machine.txt", format!("device: card\n{note}"));
}

/// Drivers, processors, variables and niceness change times.
#[test]
fn runs_of_other_machines_and_in_other_surroundings_bring_warnings() {
    let bench = Bench::new();
    let xeon = "processor: Xeon, 2 threads\nniceness: 0\nvariable: none\n";
    let epyc = "processor: EPYC, 2 threads\nniceness: 10\nvariable: GALLIVM_PERF=nopt\n";
    run(&bench, "old", "driver 1", xeon);
    run(&bench, "same", "driver 1", xeon);
    run(&bench, "other", "driver 2", epyc);
    assert!(lines(&bench.done("bench --compare old same")).is_empty());
    let said = lines(&bench.done("bench --compare old other"));
    let wanted = [
        "driver (old \"driver 1\", new \"driver 2\")",
        "processor (old \"Xeon, 2 threads\", new \"EPYC, 2 threads\")",
        "GALLIVM_PERF (old not set, new \"nopt\")",
        "niceness (old \"0\", new \"10\")",
    ];
    assert_eq!(said.len(), wanted.len(), "{said:?}");
    for (line, wanted) in said.iter().zip(wanted) {
        let start = format!("warning: the runs differ in {wanted}");
        assert!(line.starts_with(&start), "{line}");
    }
}

/// A file of the repository.
fn of_repository(name: &str) -> String {
    format!("{}/../../{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The kept run that the README quotes and the methods that it claims something of, as
/// `scripts/replicate` has them.
fn claimed() -> (String, String) {
    let script = std::fs::read_to_string(of_repository("scripts/replicate")).unwrap();
    let value = |start: &str, end: &str| {
        let line = script.lines().find_map(|line| line.strip_prefix(start));
        line.unwrap().strip_suffix(end).unwrap().to_owned()
    };
    let (kept, methods) = (value("kept=${KEPT:-", "}"), value("methods=", ""));
    let readme = std::fs::read_to_string(of_repository("README.md")).unwrap();
    assert!(readme.contains(&kept), "{kept}");
    (of_repository(&kept), format!("{methods},baseline"))
}

/// The claims of a kept run, judged by a new one: the lines, and the exit code.
fn judged(bench: &Bench, kept: &str, new: &str, methods: &str) -> (Vec<String>, Option<i32>) {
    let command = format!("bench --compare {kept} {new} --repeats {methods}");
    let output = bench.command(&command).output().unwrap();
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    // The kept run may be of a version that did not say what it drew.
    let said_of_it = lines(&output)
        .into_iter()
        .filter(|line| !line.contains("no drawn.toml"));
    let failed = output.status.code() == Some(1);
    assert_eq!(said_of_it.count(), usize::from(failed), "{said}");
    let said = said.lines().map(str::to_owned).collect();
    (said, output.status.code())
}

/// A copy of the kept run with another text in some fields of its results.
fn copied(bench: &Bench, folder: &str, kept: &str, column: &str, change: impl Fn(&str) -> String) {
    std::fs::create_dir(bench.path(folder)).unwrap();
    let read = |name: &str| std::fs::read_to_string(format!("{kept}/{name}")).unwrap();
    let mut results = Table::parse(&read("results.csv")).unwrap();
    let [solver, column] = ["solver", column].map(|name| results.column(name).unwrap());
    for record in results.records.iter_mut().filter(|r| r[solver] == "exact") {
        record[column] = change(&record[column]);
    }
    bench.file(&format!("{folder}/results.csv"), results.csv());
    bench.file(&format!("{folder}/raw.csv"), read("raw.csv"));
}

/// The kept run repeats itself. One changed figure is not repeated, and pictures of other names judge
/// nothing: each has an exit code.
#[test]
fn a_run_that_contradicts_is_told_from_one_that_judges_nothing() {
    let bench = Bench::new();
    let (kept, methods) = claimed();
    let (said, code) = judged(&bench, &kept, &kept, &methods);
    assert_eq!(code, Some(0), "{said:?}");
    let (claims, sum) = said.split_at(said.len() - 2);
    let all = claims.len();
    let repeated = |line: &String| line.starts_with("repeated ");
    assert!(claims.iter().all(repeated), "{said:?}");
    assert_eq!(sum[1], format!("{all} of {all} claims repeated"));

    copied(&bench, "other", &kept, "depth_p99_texels", |depth| {
        (2.0 * depth.parse::<f64>().unwrap()).to_string()
    });
    let (said, code) = judged(&bench, &kept, "other", &methods);
    assert_eq!(code, Some(1), "{said:?}");
    let contradicted = |line: &&String| line.starts_with("NOT repeated  exact, ");
    assert_eq!(said.iter().filter(contradicted).count(), 2, "{said:?}");
    let sum = format!("{} of {all} claims repeated, 2 NOT repeated", all - 2);
    assert_eq!(said.last(), Some(&sum));

    copied(&bench, "renamed", &kept, "scene", |scene| {
        format!("my-{scene}")
    });
    let (said, code) = judged(&bench, &kept, "renamed", "exact");
    assert_eq!(code, Some(4), "{said:?}");
    let open = |line: &&String| line.starts_with("not judged    exact, ");
    assert_eq!(said.iter().filter(open).count(), 6, "{said:?}");
    assert_eq!(said.last().unwrap(), "0 of 6 claims repeated, 6 not judged");
}

/// The suite has every picture of the kept run, and a short run of it on this device repeats the
/// errors of the default search. Its times may be those of a busy machine.
#[test]
fn a_short_run_is_judged_by_the_kept_run_of_the_readme() {
    let bench = Bench::new();
    let (kept, methods) = claimed();
    let results = Table::load(format!("{kept}/results.csv").as_ref()).unwrap();
    let suite = suite::views(&Extent::ALL, &[25.0]).unwrap();
    for record in &results.records {
        let scene = record[0].trim_end_matches(":close");
        assert!(suite.iter().any(|view| view.name == scene), "{scene}");
    }
    bench.done(
        "bench --suite all --framing whole --elevation 25 --size 800x600 --passes 2 --rounds 1 \
         --stage fragment --solver exact --quiet --out new",
    );
    let (said, code) = judged(&bench, &kept, "new", &methods);
    let contradicted = said.iter().any(|line| line.starts_with("NOT repeated"));
    assert_eq!(code, Some(if contradicted { 1 } else { 4 }), "{said:?}");
    for error in ["wrong pixels", "h/512 of depth error"] {
        let is_own = |line: &&String| line.contains("exact, fragment: ") && line.contains(error);
        let line = said.iter().find(is_own).unwrap();
        assert!(line.starts_with("repeated "), "{line}");
        assert!(line.contains(" of the kept run's "), "{line}");
    }
    let open = "not judged    exact, compute: wrong pixels in 0 of the kept run's ";
    assert!(said.iter().any(|line| line.starts_with(open)), "{said:?}");
}

/// A scene that has changed between two runs, and another --set: rows of such views are not compared,
/// and the key that differs is told.
#[test]
fn runs_of_different_scenes_are_not_compared() {
    let bench = Bench::new();
    bench.file("other.toml", bench.read("scene.toml"));
    let measure = |out: &str, more: &str| {
        let brief = "--quick --size 64x48 --passes 2 --rounds 1 --quiet";
        let by = "--solver exact --stage fragment";
        bench.done(&format!(
            "bench scene.toml other.toml {brief} {by} --out {out} {more}"
        ));
    };
    measure("old", "");
    measure("set", "--set camera.fov_y=30");
    holds(
        &bench.text("set/drawn.toml"),
        &["[view.file.camera]", "fov_y = 30"],
    );
    let told = "different scenes as other and 1 other view: camera.fov_y (old 40.0, new 30.0)";
    let words = ["set: drew ", told, "measure the same scenes"];
    bench.refused("bench --compare old set", 1, &words);

    bench.file(
        "scene.toml",
        format!("{CAMERA}{}", CONE.replace("0.9", "0.8")),
    );
    measure("new", "");
    let told = "warning: the runs drew different scenes as scene: object.0.profile (old \"";
    bench.warned_once("bench --compare old new", &[told]);
    let said = bench.said("bench --compare old new");
    let common = (2..=4).any(|n| said.contains(&format!("{n} in common")));
    assert!(common, "{said}");
    let (code, said) = bench.ended("bench --compare old set --repeats exact");
    assert_eq!(code, Some(4));
    holds(&said[0], &["camera.fov_y"]);

    // A run of an earlier version does not say what it drew.
    std::fs::remove_file(bench.path("old/drawn.toml")).unwrap();
    bench.warned_once("bench --compare old set", &["no drawn.toml in "]);
}

/// A pipe has the whole table, and a terminal the columns that fit and the names of the others.
#[cfg(target_os = "linux")] // `script`, a part of util-linux, makes the terminal
#[test]
fn a_table_fits_the_terminal() {
    let bench = Bench::new();
    run(&bench, "old", "driver 1", "");
    let piped = bench.said("bench --compare old old");
    let head = "old: ms; depth; wrong  new: ms; depth; wrong  new / old\n";
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
    let narrow = shown(50);
    let wanted = "old: ms; depth; wrong  new: ms; depth; wrong\n20                                        20\n\
        wider than the terminal; a pipe, such as `| less\n-S`, also has: new / old\n";
    assert!(narrow.contains(wanted), "{narrow}");
}
