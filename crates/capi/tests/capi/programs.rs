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

/// A compiler of C or C++, strict, that finds the library's headers.
fn compiler(name: &str, standard: &str) -> Command {
    let mut compiler = Command::new(name);
    compiler.arg(format!("-std={standard}")).args(STRICT);
    compiler.args(pkg_config("--cflags"));
    compiler
}

/// Compiles C files to a program. The library is found by pkg-config.
pub fn compile(standard: &str, flags: &[&str], sources: &[PathBuf], to: &Path) {
    // The first folder with a header counts.
    run(Command::new("cc")
        .arg(format!("-std={standard}"))
        .args(flags)
        .args(STRICT)
        .args(pkg_config("--cflags"))
        .arg("-I")
        .arg(root().join("examples/c"))
        .args(sources)
        .args(pkg_config("--libs"))
        .args(["-lvulkan", "-o"])
        .arg(to));
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
fn the_headers_alone_compile_in_every_standard() {
    let folder = folder();
    for (name, standard, header) in [
        ("cc", "c99", "revmap.h"),
        ("cc", "c11", "revmap.h"),
        ("cc", "c17", "revmap.h"),
        ("c++", "c++17", "revmap.h"),
        ("c++", "c++17", "revmap.hpp"),
    ] {
        let source = if name == "cc" { "one.c" } else { "one.cpp" };
        let [file, object] = [source, "one.o"].map(|name| folder.path().join(name));
        let text = format!("#include <{header}>\nint main(void) {{ return 0; }}\n");
        std::fs::write(&file, text).unwrap();
        run(compiler(name, standard)
            .arg("-c")
            .arg(&file)
            .arg("-o")
            .arg(object));
    }
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

/// A program that was compiled with the header of an earlier release does what it does with the
/// present one.
#[test]
fn programs_with_kept_headers_do_the_same() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c");
    let folder = folder();
    let said = |name: &str, flags: &[&str]| {
        let program = folder.path().join(name);
        let flags = [flags, &SANITIZED].concat();
        compile("c11", &flags, &[own.join("kept.c")], &program);
        run(&mut validated(&program))
    };
    let present = said("present", &[]);
    let headers = std::fs::read_dir(own.join("headers")).unwrap();
    let headers: Vec<PathBuf> = headers.map(|entry| entry.unwrap().path()).collect();
    assert!(!headers.is_empty());
    for header in headers {
        let include = folder.path().join(header.file_stem().unwrap());
        std::fs::create_dir(&include).unwrap();
        std::fs::copy(&header, include.join("revmap.h")).unwrap();
        let flag = format!("-I{}", include.display());
        let name = header.file_name().unwrap().to_str().unwrap();
        let program = format!("program-{name}");
        assert_eq!(said(&program, &[&flag]), present, "{name}");
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
        run(compiler(name, standard).arg("-fsyntax-only").arg(&file));
    }
}
