//! What the system does to a run: full disks, limits, signals, pipes, links and the rights of files.

use crate::run::{Bench, lines};
use std::fs::{OpenOptions, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RENDER: &str = "render scene.toml --stage reference --size 16x12";

#[track_caller]
fn succeeds(command: &mut Command) {
    assert!(command.status().unwrap().success());
}

/// Standard output that takes nothing fails a command; a reader that has gone does not.
#[test]
fn results_must_reach_standard_output() {
    let bench = Bench::new();
    bench.done(&format!("{RENDER} -o a.exr"));
    let render = format!("{RENDER} -o b.png --json");
    let others = "searches|man|devices|completions bash|compare a.exr a.exr|bench --list|\
        bench --list quick|--help|render --help|-V";
    for arguments in others.split('|').chain([&*render]) {
        let full = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = bench.command(arguments).stdout(full).output().unwrap();
        let said = lines(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments}: {said:?}");
        let last = said.last().unwrap();
        assert!(last.starts_with("revmap: standard output: "), "{said:?}");

        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = bench.command(arguments).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments}: {output:?}");
    }
}

#[test]
fn limits_and_signals_leave_no_parts() {
    let bench = Bench::new();
    let arguments = format!("{RENDER} -o out.exr");
    let mut command = bench.launched(&["prlimit", "--fsize=500"], &arguments);
    bench.refused_by(&mut command, 1, &["out.exr: cannot be written"]);

    // A signal comes at any place of a file's writing.
    for round in 0..12 {
        let signal = ["-TERM", "-HUP", "-INT"][round % 3];
        let arguments =
            "animate scene.toml --frames 100000 --turn 360 --size 64x48 -o t --overwrite";
        let mut command = bench.heeding_signals(arguments);
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        let begin = Instant::now();
        while !bench.path("t/frame-00005.png").exists() {
            assert!(begin.elapsed() < Duration::from_secs(120));
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(Duration::from_millis(3 * round as u64));
        succeeds(Command::new("kill").args([signal, &child.id().to_string()]));
        assert!(!child.wait().unwrap().success());
        let entries = std::fs::read_dir(bench.path("t")).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        let parts: Vec<_> = names.filter(|name| !name.starts_with("frame-")).collect();
        assert!(parts.is_empty(), "{signal}: {parts:?}");
        std::fs::remove_dir_all(bench.path("t")).unwrap();
    }
}

#[test]
fn outputs_that_are_more_than_plain_files() {
    let bench = Bench::new();
    symlink("circle.png", bench.path("circle.png")).unwrap();
    bench.file("kept.png", "as it was");
    std::fs::set_permissions(bench.path("kept.png"), Permissions::from_mode(0o444)).unwrap();
    for (name, words) in [
        ("circle.png", "cannot be written"),
        ("kept.png", "is read-only"),
    ] {
        let words = [name, "--output", words];
        bench.refused(&format!("{RENDER} -o {name}"), 1, &words);
    }
    assert!(bench.path("circle.png").is_symlink());
    assert_eq!(bench.read("kept.png"), b"as it was");

    for name in ["-", "/dev/stdout"] {
        bench.refused(&format!("{RENDER} -o {name}"), 2, &[name, ".png, .exr"]);
    }
}
