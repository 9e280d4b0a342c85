//! Programs in C and C++: built against what `scripts/install-c` installs, and run.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use tempfile::TempDir;

/// What every program is compiled with.
pub const STRICT: [&str; 4] = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Stops a program at the first byte out of place, freed twice or read uninitialised by its types'
/// rules.
pub const SANITIZED: [&str; 2] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];

/// A new folder that is removed with the value.
pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Runs a command and gives its standard output. If it fails, so does the test, with all that it
/// said.
pub fn run(command: &mut Command) -> String {
    let out = command.output();
    let out = out.unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (said, failed) = (text(&out.stdout), text(&out.stderr));
    assert!(out.status.success(), "{command:?}\n{said}{failed}");
    said
}

/// Where the libraries of this build are installed.
pub fn prefix() -> &'static Path {
    // A static is never dropped: the folder goes with the target folder's own.
    static PREFIX: OnceLock<PathBuf> = OnceLock::new();
    PREFIX.get_or_init(|| {
        let program = std::env::current_exe().unwrap();
        let prefix = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi-prefix");
        let mut install = Command::new(root().join("scripts/install-c"));
        run(install.args([prefix.as_path(), program.parent().unwrap()]));
        prefix
    })
}

/// What pkg-config says of the installed library.
fn pkg_config(what: &str) -> Vec<String> {
    let said = run(Command::new("pkg-config")
        .env("PKG_CONFIG_PATH", prefix().join("lib/pkgconfig"))
        .args([what, "revmap"]));
    said.split_whitespace().map(str::to_owned).collect()
}

/// A compiler of C or C++, strict, that finds the library's headers. The first folder with a header
/// counts, so those of `flags` come before.
pub fn compiler(name: &str, standard: &str, flags: &[&str]) -> Command {
    let mut compiler = Command::new(name);
    compiler.arg(format!("-std={standard}")).args(flags);
    compiler.args(STRICT).args(pkg_config("--cflags"));
    compiler
}

/// Compiles C files to a program. The library is found by pkg-config.
pub fn compile(standard: &str, flags: &[&str], sources: &[PathBuf], to: &Path) {
    let mut cc = compiler("cc", standard, flags);
    cc.arg("-I").arg(root().join("examples/c")).args(sources);
    cc.args(pkg_config("--libs"));
    run(cc.args(["-lvulkan", "-o"]).arg(to));
}

/// A command that runs a program of ours, with the validation layers on.
pub fn validated(program: &Path) -> Command {
    let mut command = Command::new(program);
    command
        .env("LD_LIBRARY_PATH", prefix().join("lib"))
        .env("REVMAP_VALIDATION", "1")
        // What drivers keep until a process ends; our own leaks are found by counting over cycles.
        .env("ASAN_OPTIONS", "detect_leaks=0");
    command
}

#[test]
fn the_sanitizers_stop_a_planted_fault() {
    let folder = folder();
    let (source, program) = (folder.path().join("fault.c"), folder.path().join("fault"));
    let text = "#include <stdlib.h>\nint main(void)\n{\n\tchar *p = calloc(4, 1);\n\tint byte = p[atoi(\"4\")];\n\tfree(p);\n\treturn byte;\n}\n";
    std::fs::write(&source, text).unwrap();
    compile("c99", &SANITIZED, &[source], &program);
    let out = validated(&program).output().unwrap();
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(
        !out.status.success() && said.contains("heap-buffer-overflow"),
        "{said}"
    );
}

/// Memory and handles of 2,000 cycles, by the C library's own count.
#[test]
fn two_thousand_cycles_leave_nothing_behind() {
    let folder = folder();
    let program = folder.path().join("cycles");
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c/cycles.c");
    let sources = [own, root().join("examples/c/host.c")];
    compile("gnu11", &[], &sources, &program);
    let mut command = Command::new(&program);
    command.env("LD_LIBRARY_PATH", prefix().join("lib"));
    command.env_remove("REVMAP_VALIDATION"); // the layers keep a record of what was
    command.env("MALLOC_ARENA_MAX", "1"); // the C library counts one arena alone
    let said = run(command.arg(root().join("assets/profiles/pawn.svg")));
    println!("{said}");
}

/// The header of an earlier release by its table: the present one without later members, and
/// assertions of all sizes, places, numbers and types of functions that the table has.
fn header_of(table: &str, present: &str) -> String {
    let (mut header, mut claims) = (present.to_owned(), String::new());
    let mut claim = |what: String| claims += &format!("_Static_assert({what}, \"release\");\n");
    let mut functions = String::new();
    for line in table.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let pairs = |from: usize| {
            words[from..]
                .iter()
                .map(|word| word.split_once(':').unwrap())
        };
        match words[0] {
            "struct" => {
                let (name, bytes) = (words[1], words[2]);
                let begin = header.find(&format!("struct {name} {{\n")).unwrap();
                let end = begin + header[begin..].find("\n}").unwrap();
                let is_kept = |line: &&str| {
                    let member = line
                        .trim_end_matches(';')
                        .rsplit([' ', '*'])
                        .next()
                        .unwrap();
                    let member = member.split('[').next().unwrap();
                    let named = || pairs(3).any(|(name, _)| name == member);
                    // A structure without a size never grows.
                    words[3] != "size:0+4" || !line.ends_with(';') || named()
                };
                let kept: Vec<&str> = header[begin..end].lines().filter(is_kept).collect();
                let kept = kept.join("\n");
                header.replace_range(begin..end, &kept);
                claim(format!("sizeof({name}) == {bytes}"));
                for (member, place) in pairs(3) {
                    let (at, bytes) = place.split_once('+').unwrap();
                    claim(format!("offsetof({name}, {member}) == {at}"));
                    claim(format!("sizeof((({name} *)0)->{member}) == {bytes}"));
                }
            }
            "numbers" => pairs(1).for_each(|(name, number)| claim(format!("{name} == {number}"))),
            _ => functions += &format!("{line};\n"),
        }
    }
    format!("{header}{claims}{functions}")
}

/// The tables of earlier releases, each with its name.
fn releases() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c/releases");
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        (name, std::fs::read_to_string(entry.path()).unwrap())
    });
    entries.collect()
}

fn present_header() -> String {
    std::fs::read_to_string(root().join("crates/capi/include/revmap.h")).unwrap()
}

/// A member, a number, a structure without a size and a function that changed since a release.
#[test]
fn planted_changes_since_a_release_are_found() {
    let (folder, header) = (folder(), present_header());
    let (_, table) = releases().remove(0);
    let compiles = |header: &str| {
        let file = folder.path().join("release.h");
        std::fs::write(&file, header_of(&table, header)).unwrap();
        let mut command = compiler("cc", "c11", &["-fsyntax-only", "-x", "c"]);
        command.arg(file).output().unwrap().status.success()
    };
    assert!(compiles(&header));
    for (from, to) in [
        ("    double fov_y;", "    float fov_y;"),
        ("REVMAP_SOLVER_EXACT = 9", "REVMAP_SOLVER_EXACT = 10"),
        (
            "    double direction[3];\n} RevmapRay;",
            "    double direction[3];\n    double far;\n} RevmapRay;",
        ),
        ("uint32_t revmap_abi(void)", "uint64_t revmap_abi(void)"),
    ] {
        assert!(header.contains(from), "{from}");
        assert!(!compiles(&header.replace(from, to)), "{to}");
    }
}

/// A program that was compiled with the header of an earlier release does what it does with the
/// present one.
#[test]
fn programs_of_earlier_releases_do_the_same() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c");
    let folder = folder();
    let said = |name: &str, flags: &[&str]| {
        let program = folder.path().join(name);
        let flags = [flags, &SANITIZED].concat();
        compile("c11", &flags, &[own.join("kept.c")], &program);
        run(&mut validated(&program))
    };
    let present = said("present", &[]);
    let releases = releases();
    assert!(!releases.is_empty());
    for (name, table) in releases {
        let include = folder.path().join(format!("include-{name}"));
        std::fs::create_dir(&include).unwrap();
        let header = header_of(&table, &present_header());
        std::fs::write(include.join("revmap.h"), header).unwrap();
        let flag = format!("-I{}", include.display());
        let earlier = said(&format!("program-{name}"), &[&flag]);
        assert_eq!(earlier, present, "{name}");
    }
}

/// The examples of `docs/embedding.md` are whole files.
#[test]
fn the_documents_examples_compile() {
    let folder = folder();
    let text = std::fs::read_to_string(root().join("docs/embedding.md")).unwrap();
    for (fence, name, standard) in [("c", "cc", "c99"), ("cpp", "c++", "c++17")] {
        let begin = format!("```{fence}\n");
        let rest = text.split(&begin).nth(1);
        let example = rest.and_then(|rest| rest.split("```").next());
        let file = folder.path().join(format!("example.{fence}"));
        std::fs::write(&file, example.unwrap()).unwrap();
        run(compiler(name, standard, &["-fsyntax-only"]).arg(&file));
    }
}
