//! Frames that do not end. The program says which search is to blame. A run that measures several
//! searches begins again without it, since nothing else ends a shader that runs.

use super::output;
use revmap_searches::folder;
use revmap_searches::watchdog::{self, Overrun};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Once, OnceLock};

/// Commands that begin again: they measure other searches too.
const RUNS: [&str; 3] = ["bench", "chart", "stability"];

/// The variable that names searches not to draw by, a line each: a name, a tab, the reason.
const LEFT_OUT: &str = "REVMAP_LEFT_OUT";

/// The folder of results.
static OUT: OnceLock<PathBuf> = OnceLock::new();

/// Watches over frames from now on.
pub fn watch() {
    let named = std::env::var(LEFT_OUT).unwrap_or_default();
    for (name, reason) in named.lines().filter_map(|line| line.split_once('\t')) {
        watchdog::leave_out(name.to_owned(), reason.to_owned());
    }
    // Without the thread, a frame that ends late is still an error.
    let waits = || handle(&watchdog::wait());
    let _ = std::thread::Builder::new().spawn(waits);
}

/// Ends the program, or begins the run again, if a frame has overrun. The waiting thread does the
/// same; the first of both acts.
pub fn settle() {
    if let Some(overrun) = watchdog::found() {
        handle(&overrun);
    }
}

/// Notes the folder of results, which a run that begins again uses.
pub fn keep_folder(out: &Path) {
    let _ = OUT.set(out.to_owned());
}

/// Draws a small picture by each search of a folder that was named, in a process of its own. A search
/// that fails there, or whose shader makes the driver crash, is left out of the run.
pub fn try_out(device: Option<&str>) {
    for folder in folder::all() {
        if watchdog::check(&folder.name()).is_err() {
            continue;
        }
        let program = std::env::current_exe();
        let mut command = program.map_or_else(|_| Command::new("revmap"), Command::new);
        command
            .args(["searches", &folder.spec])
            .stdin(Stdio::null());
        if let Some(device) = device {
            command.args(["--device", device]);
        }
        let Ok(output) = command.output() else {
            continue; // the run itself finds what is wrong
        };
        let all = String::from_utf8_lossy(&output.stderr);
        let warnings = all
            .lines()
            .filter_map(|line| line.strip_prefix("warning: "));
        warnings.for_each(output::warn);
        let said = all.lines().last().unwrap_or_default();
        let reason = match output.status.code() {
            Some(0) => continue,
            Some(_) => said.trim_start_matches("revmap: ").to_owned(),
            None => format!(
                "the driver crashed ({}) over a test picture by it; simplify its loop, or take another driver",
                output.status
            ),
        };
        watchdog::leave_out(folder.name(), reason);
    }
}

/// True if this run began again, so that its folder of results may hold files of the first try.
pub fn is_again() -> bool {
    std::env::var_os(LEFT_OUT).is_some()
}

fn handle(overrun: &Overrun) {
    static ENDING: Once = Once::new();
    ENDING.call_once(|| end(overrun));
}

fn end(Overrun { name, reason }: &Overrun) -> ! {
    let words: Vec<_> = std::env::args_os().collect();
    let runs = words.get(1).and_then(|word| word.to_str());
    if !runs.is_some_and(|word| RUNS.contains(&word)) {
        output::complain(reason);
        leave();
    }
    output::warn(&format!("{reason}; the run begins again without {name}"));
    let mut left_out = std::env::var(LEFT_OUT).unwrap_or_default();
    left_out += &format!("{name}\t{}\n", reason.replace(['\n', '\t'], " "));
    let mut command = match std::env::current_exe() {
        Ok(program) => Command::new(program),
        Err(_) => Command::new(&words[0]),
    };
    command.args(&words[1..]).env(LEFT_OUT, left_out);
    let given = |word: &std::ffi::OsString| {
        let word = word.to_string_lossy();
        word.starts_with("--out") || word.starts_with("-o")
    };
    if let Some(out) = OUT.get().filter(|_| !words.iter().any(given)) {
        command.arg("--out").arg(out);
    }
    let error = replace(command);
    output::complain(&format!("cannot begin again ({error})"));
    leave();
}

/// Ends this process without the driver's exit handlers: these free the code that its threads run, so
/// the process may end by a signal.
fn leave() -> ! {
    let _ = std::io::stdout().flush();
    #[cfg(unix)]
    signal_hook::low_level::exit(1);
    #[cfg(not(unix))]
    std::process::exit(1);
}

/// Ends this process, whose device still draws, in favour of another.
#[cfg(unix)]
fn replace(mut command: Command) -> std::io::Error {
    use std::os::unix::process::CommandExt;
    command.exec()
}

#[cfg(not(unix))]
fn replace(mut command: Command) -> std::io::Error {
    match command.status() {
        Ok(status) => std::process::exit(status.code().unwrap_or(1)),
        Err(error) => error,
    }
}
