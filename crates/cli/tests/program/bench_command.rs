//! `revmap bench` and `revmap chart` as they are run: files, columns, exit codes, an interrupt. On
//! a real device, small and brief.

use revmap_lab::report::columns;
use revmap_lab::report::table::Table;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../assets/scenes/sphere.toml"
);

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_revmap"));
    command
        .args(arguments)
        .current_dir(folder)
        .env_remove("RUST_BACKTRACE")
        .stdin(Stdio::null());
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_brief_run_measures_every_combination() {
    let folder = tempfile::tempdir().unwrap();
    let out = run(
        folder.path(),
        &[
            "bench",
            SCENE,
            "--quick",
            "--size",
            "96x72,64x48",
            "--solver",
            "circle,live",
            "--map-rows",
            "128",
            "--elevation",
            "10",
            "--passes",
            "4",
            "--out",
            "a/b",
        ],
    );
    assert!(out.status.success(), "{}", text(&out.stderr));
    let made = folder.path().join("a/b");
    let results = Table::load(&made.join("results.csv")).unwrap();
    assert_eq!(results.header, columns::results().collect::<Vec<_>>());
    // Sizes x stages x searches, and the RBM baseline and the floor at each size and stage.
    let floors = if cfg!(feature = "shaderc") { 2 * 2 } else { 0 };
    assert_eq!(results.records.len(), 2 * 2 * 2 + 2 * 2 + floors);
    let marked = Table::load(&made.join("excluded.csv")).unwrap();
    for (number, record) in results.records.iter().enumerate() {
        let field = |name: &str| record[results.column(name).unwrap()].as_str();
        let value = |name: &str| {
            field(name)
                .parse::<f64>()
                .unwrap_or_else(|_| panic!("{name}: {:?}", field(name)))
        };
        assert_eq!(
            (
                field("scene"),
                field("objects"),
                field("map_source").is_empty()
            ),
            ("sphere@10", "1", false)
        );
        assert!(
            value("frame_ms_median") > 0.0
                && (value("steps_mean") > 0.0) == (field("solver") != "floor")
                && value("depth_p99_texels") >= 0.0
        );
        assert!((value("fps") * value("frame_ms_median") / 1e3 - 1.0).abs() < 1e-3);
        // A clock that is told agrees; one that does not is told to have been left out.
        match field("gpu_ms_median").parse::<f64>() {
            Ok(gpu) => assert!((gpu / value("frame_ms_median") - 1.0).abs() <= 0.151),
            Err(_) => assert!(
                marked
                    .records
                    .iter()
                    .any(|r| r[0] == (number + 1).to_string())
            ),
        }
    }
    let raw = Table::load(&made.join("raw.csv")).unwrap();
    assert!(
        raw.records.len() >= results.records.len() * 4 * 2,
        "four passes of two rounds"
    );
    for file in ["report.html", "machine.txt", "pictures/sphere@10.png"] {
        assert!(made.join(file).exists(), "{file}");
    }
    let version = text(&run(folder.path(), &["--version"]).stdout);
    let note = std::fs::read_to_string(made.join("machine.txt")).unwrap();
    assert!(note.contains(&format!("\nprogram: {version}")), "{note}");
    assert!(
        text(&out.stdout).contains("RBM baseline"),
        "{}",
        text(&out.stdout)
    );

    // It is there to stay, unless it may be replaced; and a scene within it is no place for
    // results.
    let again = ["bench", SCENE, "--quick", "--size", "64x48", "--out", "a/b"];
    for command in ["bench", "chart"] {
        let out = run(folder.path(), &[&[command], &again[1..]].concat());
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{said}");
        assert!(
            said.contains("a/b") && said.contains("--overwrite"),
            "{said}"
        );
    }

    // Against itself nothing has changed.
    let out = run(folder.path(), &["bench", "--compare", "a/b", "a/b"]);
    assert!(out.status.success(), "{}", text(&out.stderr));
    assert!(
        text(&out.stdout).contains(" 0 slower, 0 faster,"),
        "{}",
        text(&out.stdout)
    );
}

/// A mesh has neither a budget nor a map, and no place in compute.
#[test]
fn a_mesh_stands_beside_the_searches() {
    let folder = tempfile::tempdir().unwrap();
    let solvers = "circle,mesh:16x32";
    let arguments = [
        "bench", SCENE, "--quick", "--size", "64x48", "--solver", solvers, "--out", "m",
    ];
    let out = run(folder.path(), &arguments);
    assert!(out.status.success(), "{}", text(&out.stderr));
    let made = folder.path().join("m");
    let results = Table::load(&made.join("results.csv")).unwrap();
    let rows: Vec<_> = results
        .records
        .iter()
        .filter(|r| r[results.column("solver").unwrap()] == "mesh:16x32")
        .collect();
    assert_eq!(rows.len(), 1);
    for (column, empty) in [
        ("max_steps", true),
        ("map_rows", true),
        ("map_source", true),
        ("map_format", true),
        ("steps_mean", true),
        ("steps_max", true),
        ("frame_ms_median", false),
        ("depth_p99_texels", false),
        ("missed", false),
    ] {
        let field = &rows[0][results.column(column).unwrap()];
        assert_eq!(field.is_empty(), empty, "{column}: {field:?}");
    }
    let out = Table::load(&made.join("excluded.csv")).unwrap();
    // The row that was drawn may be there too: frames this small are easily timed wrongly.
    let compute = |r: &&Vec<String>| r[3] == "mesh:16x32" && r[2] == "compute";
    let reason = out.records.iter().find(compute).unwrap();
    assert!(reason[4].contains("give the stage fragment"), "{reason:?}");
}

/// A close picture is one of its own: named so, and summed up by itself as well as with the others.
#[test]
fn close_pictures_are_measured_beside_whole_ones() {
    let folder = tempfile::tempdir().unwrap();
    let options = "--quick --size 64x48 --solver hull --stage fragment --framing close,whole \
                   --passes 2 --rounds 1 --out f";
    let arguments: Vec<&str> = (["bench", SCENE].into_iter())
        .chain(options.split(' '))
        .collect();
    let out = run(folder.path(), &arguments);
    assert!(out.status.success(), "{}", text(&out.stderr));
    let said = text(&out.stdout);
    for wanted in [
        "all together: 2 pictures",
        "whole: 1 picture",
        "close: 1 picture",
    ] {
        assert!(said.contains(wanted), "{said}");
    }
    let made = folder.path().join("f");
    let results = Table::load(&made.join("results.csv")).unwrap();
    let solver = results.column("solver").unwrap();
    let searches = results.records.iter().filter(|r| r[solver] != "floor");
    let mut scenes: Vec<&str> = searches.map(|r| r[0].as_str()).collect();
    scenes.sort_unstable();
    assert_eq!(scenes, ["sphere", "sphere", "sphere:close", "sphere:close"]);
    // Charts need clocks that agree, and frames this small are easily timed wrongly.
    assert!(made.join("pictures/sphere-close.png").exists());
}

#[test]
fn a_brief_chart_has_its_pages() {
    let folder = tempfile::tempdir().unwrap();
    let out = run(
        folder.path(),
        &[
            "chart", SCENE, "--quick", "--size", "64x48", "--solver", "circle", "--out", "c",
        ],
    );
    assert!(out.status.success(), "{}", text(&out.stderr));
    let made = folder.path().join("c");
    for file in [
        "report.html",
        "results.csv",
        "charts/sphere-64x48-rows-depth.svg",
    ] {
        assert!(made.join(file).exists(), "{file}");
    }
    // Charts of times need clocks that agree, and frames this small are easily timed wrongly.
    let left_out = Table::load(&made.join("excluded.csv")).unwrap().records;
    let summary = made.join("charts/summary-depth-error.png");
    assert!(summary.exists() || !left_out.is_empty());
}

/// A plan of one's own: one of the program's, changed; and faults in it.
#[test]
fn a_plan_of_ones_own_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let listed = run(folder.path(), &["bench", "--list"]);
    for name in [
        "usual",
        "quick",
        "full",
        "tables",
        "scaling",
        "budget",
        "crowds",
        "antialiasing",
        "chart",
    ] {
        let line = format!("{name} ");
        assert!(
            text(&listed.stdout).lines().any(|l| l.starts_with(&line)),
            "{name}"
        );
    }
    let own = text(&run(folder.path(), &["bench", "--list", "quick"]).stdout);
    let own = own.replace(
        "methods = [\"live\", \"quadric\", \"exact\"]",
        "methods = [\"exact\"]\nsizes = [\"64x48\"]",
    );
    let own = own.replace(
        "methods = [\"baseline\", \"floor\"]",
        "methods = [\"baseline\"]\nsizes = [\"64x48\"]",
    );
    let own = own.replace(
        "methods = [\"mesh:128x256\"]",
        "methods = [\"mesh:8x16\"]\nsizes = [\"64x48\"]",
    );
    std::fs::write(folder.path().join("mine.toml"), &own).unwrap();
    let arguments = [
        "bench",
        "--plan",
        "mine.toml",
        "--passes",
        "2",
        "--rounds",
        "1",
        "--out",
        "p",
    ];
    let out = run(folder.path(), &arguments);
    assert!(out.status.success(), "{}", text(&out.stderr));
    let results = Table::load(&folder.path().join("p/results.csv")).unwrap();
    // Two stages by the search and the RBM baseline, one mesh.
    assert_eq!(results.records.len(), 5);
    std::fs::write(
        folder.path().join("bad.toml"),
        own.replace("methods", "method"),
    )
    .unwrap();
    let out = run(folder.path(), &["bench", "--plan", "bad.toml"]);
    let said = text(&out.stderr);
    assert_eq!(
        (out.status.code(), said.lines().count()),
        (Some(1), 1),
        "{said}"
    );
    for wanted in [
        "bad.toml: line ",
        "unknown field `method`",
        "expected one of",
    ] {
        assert!(said.contains(wanted), "{said}");
    }
}

#[test]
fn wrong_usage_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, code, wanted) in [
        (
            &["bench", "--stage", "reference"][..],
            2,
            "--stage: reference is what all others are compared with",
        ),
        (&["bench", "--solver", "circle,nothing"], 2, "nothing"),
        (&["bench", "--solver", "circle,mesh:0x0"], 2, "mesh:0x0"),
        (&["bench", "--size", "64x48,0x3"], 2, "0x3"),
        (&["bench", "--elevation", "100"], 2, "-90 to 90"),
        (&["bench", "--quick", "--full"], 2, "--full"),
        (&["bench", "--framing", "near"], 2, "near"),
        (&["bench", "--tables", "--scaling"], 2, "--scaling"),
        (
            &["bench", "--list", "nothing"],
            2,
            "give one of usual, quick",
        ),
        (
            &["bench", "--plan", "none.toml"],
            1,
            "none.toml: cannot be read",
        ),
        (&["bench", "--compare", "a"], 2, "--compare"),
        (
            &["bench", "--compare", "a", "b"],
            1,
            "results.csv: cannot be read",
        ),
        (&["bench", "missing.toml", "--quick"], 1, "missing.toml"),
        (&["chart", "missing.toml", "--quick"], 1, "missing.toml"),
    ] {
        let out = run(folder.path(), arguments);
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(
            said.contains(wanted) && said.lines().count() == 1,
            "{arguments:?}: {said}"
        );
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{arguments:?} leaves nothing behind"
        );
    }
}

/// Ctrl-C in the middle: what was measured is kept, and the exit code says that it is not all.
#[test]
fn an_interrupt_keeps_what_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = command(
        folder.path(),
        &[
            "bench", SCENE, "--size", "800x600", "--solver", "circle", "--out", "kept",
        ],
    )
    .stdout(Stdio::piped())
    .stderr(Stdio::piped())
    .spawn()
    .unwrap();
    // After the first pass of five or more there are results.
    let results = folder.path().join("kept/results.csv");
    let begin = Instant::now();
    while !results.exists() {
        assert!(
            begin.elapsed() < Duration::from_secs(600) && child.try_wait().unwrap().is_none(),
            "nothing was measured"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let out = child.wait_with_output().unwrap();
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(1), "{said}");
    assert!(said.contains("interrupted"), "{said}");
    let floors = if cfg!(feature = "shaderc") { 2 } else { 0 };
    assert_eq!(Table::load(&results).unwrap().records.len(), 4 + floors);
    assert!(
        std::fs::read_to_string(folder.path().join("kept/report.html"))
            .unwrap()
            .contains("was interrupted")
    );
}
