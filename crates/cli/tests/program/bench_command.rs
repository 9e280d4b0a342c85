//! `revmap bench` and `revmap chart` as they are run: files, columns, exit codes, an interrupt. On
//! a real device, small and brief.

use crate::run::{Bench, CAMERA, CONE, holds, lines};
use revmap_bench::report::columns;
use revmap_bench::report::table::Table;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The measured scene.
const SPHERE: &str = "@scenes/sphere.toml";

fn load(bench: &Bench, file: &str) -> Table {
    Table::load(&bench.path(file)).unwrap()
}

#[test]
fn a_brief_run_measures_every_combination() {
    let bench = Bench::new();
    let said = bench.said(&format!(
        "bench {SPHERE} --quick --size 96x72,64x48 --solver circle,live,mesh:16x32 --map-rows 128 --elevation 10 \
         --passes 4 --out a/b"
    ));
    let results = load(&bench, "a/b/results.csv");
    assert_eq!(results.header, columns::results().collect::<Vec<_>>());
    // Sizes x stages x searches, a mesh at each size, and the RBM baseline and the floor at each size
    // and stage.
    let floors = if cfg!(feature = "shaderc") { 2 * 2 } else { 0 };
    assert_eq!(results.records.len(), 2 * 2 * 2 + 2 + 2 * 2 + floors);
    let marked = load(&bench, "a/b/excluded.csv");
    for (number, record) in results.records.iter().enumerate() {
        let field = |name: &str| record[results.column(name).unwrap()].as_str();
        let value = |name: &str| {
            let number = field(name).parse::<f64>();
            number.unwrap_or_else(|_| panic!("{name}: {:?}", field(name)))
        };
        assert_eq!((field("scene"), field("objects")), ("sphere@10", "1"));
        if field("solver") == "mesh:16x32" {
            let none = "max_steps map_rows map_source map_format steps_mean steps_max";
            assert!(none.split(' ').all(|name| field(name).is_empty()));
            assert!(value("frame_ms_median") > 0.0 && value("depth_p99_texels") >= 0.0);
            continue;
        }
        assert!(!field("map_source").is_empty());
        assert!(value("frame_ms_median") > 0.0 && value("depth_p99_texels") >= 0.0);
        assert_eq!(value("steps_mean") > 0.0, field("solver") != "floor");
        assert!((value("fps") * value("frame_ms_median") / 1e3 - 1.0).abs() < 1e-3);
        // A clock that is told agrees; one that does not is told to have been left out.
        match field("gpu_ms_median").parse::<f64>() {
            Ok(gpu) => {
                // The wall clock includes submission.
                let wall = value("frame_ms_median");
                assert!((-0.151 * wall..0.151 * wall + 0.151).contains(&(wall - gpu)));
            }
            Err(_) => {
                let number = (number + 1).to_string();
                assert!(marked.records.iter().any(|r| r[0] == number));
            }
        }
    }
    let compute = |r: &&Vec<String>| r[3] == "mesh:16x32" && r[2] == "compute";
    let reason = marked.records.iter().find(compute).unwrap();
    holds(&reason[4], &["give the stage fragment"]);
    let raw = load(&bench, "a/b/raw.csv").records.len();
    let passes = 4 * 2 * results.records.len();
    assert!(raw >= passes, "four passes of two rounds");
    bench.has(&["a/b/report.html", "a/b/pictures/sphere@10.png"]);
    let version = bench.said("--version");
    holds(
        &bench.text("a/b/machine.txt"),
        &[&format!("\nprogram: {version}")],
    );
    holds(&said, &["RBM baseline"]);

    // It is there to stay, unless it may be replaced; and a scene within it is no place for
    // results.
    for command in ["bench", "chart"] {
        let again = format!("{command} {SPHERE} --quick --size 64x48 --out a/b");
        bench.refused(&again, 2, &["a/b", "--overwrite"]);
    }

    // Against itself nothing has changed.
    let said = bench.said("bench --compare a/b a/b");
    holds(&said, &[" 0 slower, 0 faster,"]);
}

#[test]
fn a_brief_chart_has_its_pages() {
    let bench = Bench::new();
    let command = format!("chart {SPHERE} --quick --size 64x48 --solver circle --out c");
    bench.done(&command);
    let chart = "c/charts/sphere-64x48-rows-depth.svg";
    bench.has(&["c/report.html", "c/results.csv", chart]);
    // Charts of times need clocks that agree, and frames this small are easily timed wrongly.
    let left_out = load(&bench, "c/excluded.csv").records;
    let summary = bench.path("c/charts/summary-depth-error.svg");
    assert!(summary.exists() || !left_out.is_empty());
}

/// A mesh draws no colour map, so nothing of it is left.
#[test]
fn a_method_that_no_scene_can_have_is_named() {
    let bench = Bench::new();
    bench.grey("rings.png", 8, 8, |_, y| 30 * y as u8);
    let scene = format!("{CAMERA}{CONE}color_map = \"rings.png\"\n");
    bench.file("rings.toml", scene);
    let command = "bench rings.toml --quick --size 64x48 --solver exact,mesh:8x8 --out c";
    let said = lines(&bench.done(command)).join("\n");
    holds(&said, &["mesh:8x8 was left out", "draws no colour map"]);
    assert!(!said.contains("exact was left out"));
}

/// A plan of one's own: one of the program's, changed; and faults in it.
#[test]
fn a_plan_of_ones_own_is_measured() {
    let bench = Bench::new();
    let listed = bench.said("bench --list");
    let names = "usual quick full tables scaling budget crowds antialiasing chart";
    for name in names.split(' ') {
        let line = format!("{name} ");
        assert!(listed.lines().any(|l| l.starts_with(&line)), "{name}");
    }
    let mut own = bench.said("bench --list quick");
    for (from, to) in [
        ("\"live\", \"quadric\", \"exact\"", "exact"),
        ("\"baseline\", \"floor\"", "baseline"),
        ("\"mesh:0.25px\"", "mesh:8x16"),
    ] {
        let to = format!("methods = [\"{to}\"]\nsizes = [\"64x48\"]");
        own = own.replace(&format!("methods = [{from}]"), &to);
    }
    bench.file("mine.toml", &own);
    bench.done("bench --plan mine.toml --passes 2 --rounds 1 --out p");
    // Two stages by the search, exact and within a tolerance, and the RBM baseline; one mesh.
    assert_eq!(load(&bench, "p/results.csv").records.len(), 7);
    bench.file("bad.toml", own.replace("methods", "method"));
    bench.refuses(
        1,
        "bench --plan bad.toml | bad.toml: line | unknown field `method` | expected one of",
    );
}

#[test]
fn wrong_usage_is_told_in_one_line() {
    let bench = Bench::new();
    bench.refuses(
        2,
        "bench --stage reference        | --stage: reference is what all others are compared with
         bench --solver circle,nothing  | nothing
         bench --solver circle,mesh:0x0 | mesh:0x0
         bench --size 64x48,0x3         | 0x3
         bench --elevation 100          | -90 to 90
         bench --quick --full           | --full
         bench --framing near           | near
         bench --tables --scaling       | --scaling
         bench --list nothing           | give one of usual, quick
         bench --compare a              | --compare
         bench --repeats exact          | --compare",
    );
    bench.refuses(
        1,
        "bench --plan none.toml       | none.toml: cannot be read
         bench --compare a b          | results.csv: cannot be read
         bench --compare a b --repeats exact | results.csv: cannot be read
         bench missing.toml --quick   | missing.toml
         chart missing.toml --quick   | missing.toml",
    );
}

/// Ends a run by a signal once a file of its folder is there. Returns what it said, and its exit
/// code.
fn ended(bench: &Bench, command: &str, signal: &str, file: &str) -> (String, Option<i32>) {
    let mut command = bench.heeding_signals(&format!("{command} --out kept"));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let results = bench.path("kept").join(file);
    let begin = Instant::now();
    while !results.exists() {
        let runs = child.try_wait().unwrap().is_none();
        assert!(
            runs && begin.elapsed().as_secs() < 600,
            "nothing was measured"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    let mut kill = Command::new("kill");
    let sent = kill.args([signal, &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    let out = child.wait_with_output().unwrap();
    (lines(&out).join(" "), out.status.code())
}

/// Ctrl-C in the middle, and the signals by which systems end programs: what was measured is kept,
/// and the exit code, that of shells, says that it is not all.
#[test]
fn a_run_that_is_ended_keeps_what_was_measured() {
    for (signal, wanted) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let bench = Bench::new();
        // After the first of many passes there are results.
        let command = format!(
            "bench {SPHERE} --size 320x240 --solver circle --stage fragment --passes 100 --rounds 50"
        );
        let (said, code) = ended(&bench, &command, signal, "results.csv");
        assert_eq!(code, Some(wanted), "{said}");
        holds(&said, &["interrupted", "--overwrite"]);
        let rows = 2 + usize::from(cfg!(feature = "shaderc"));
        assert_eq!(load(&bench, "kept/results.csv").records.len(), rows);
        holds(&bench.text("kept/report.html"), &["was interrupted"]);
        bench.has(&["kept/machine.txt", "kept/excluded.csv"]);
    }
}

/// A run that is ended before its first result leaves no folder, so that the same command works again.
#[test]
fn a_run_without_a_result_leaves_no_folder() {
    let bench = Bench::new();
    let measured = format!("{SPHERE} --size 800x600 --solver circle");
    for command in [
        format!("bench {measured}"),
        format!("chart {measured}"),
        "stability".to_owned(),
    ] {
        // A first result may be there before the signal comes.
        let interrupted = (0..10).find_map(|_| {
            let (said, code) = ended(&bench, &command, "-INT", "");
            assert_eq!(code, Some(130), "{command}: {said}");
            let early = !said.contains("it holds what was done");
            (!early).then(|| std::fs::remove_dir_all(bench.path("kept")).unwrap());
            early.then_some(said)
        });
        let said = interrupted.unwrap_or_else(|| panic!("{command} was too fast"));
        assert!(!bench.path("kept").exists(), "{command}: {said}");
    }
}
