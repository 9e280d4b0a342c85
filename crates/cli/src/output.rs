//! Standard output, standard error, and output files of the program.

use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::DeviceReport;
use revmap_bench::measure::machine::Machine;
use revmap_files::{check_writable, destination};
use std::io::ErrorKind::BrokenPipe;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::OnceLock;

/// The version, and the commit of a program that was built from a git checkout.
pub const VERSION: &str = env!("REVMAP_VERSION");

/// The first fault of standard output.
static FAULT: OnceLock<std::io::Error> = OnceLock::new();

/// The exit code in place of 0.
static CODE: OnceLock<u8> = OnceLock::new();

/// Prints a line of results on standard output.
pub fn result(line: &str) {
    keep_fault(writeln!(std::io::stdout(), "{line}"));
}

/// The characters in a line of the terminal that shows standard output, 80 if it does not tell;
/// none for a file or a pipe.
pub fn width() -> Option<usize> {
    let terminal = console::Term::stdout();
    terminal.is_term().then(|| terminal.size().1.into())
}

/// Notes a fault of standard output for [`end`]. A reader that closes the pipe early, such as
/// `head`, causes none.
pub fn keep_fault(written: std::io::Result<()>) {
    if let Some(fault) = written.err().filter(|e| e.kind() != BrokenPipe) {
        let _ = FAULT.set(fault);
    }
}

/// Chooses the exit code of a command that is done and has more to say by it than 0.
pub fn end_with(code: u8) {
    let _ = CODE.set(code);
}

/// The exit code of a command that is done: its results must have reached standard output.
pub fn end() -> ExitCode {
    keep_fault(std::io::stdout().flush());
    let Some(fault) = FAULT.get() else {
        return ExitCode::from(CODE.get().copied().unwrap_or(0));
    };
    complain(&format!("standard output: cannot be written ({fault})"));
    ExitCode::FAILURE
}

/// Prints results for programs: one JSON value, indented.
pub fn json(value: &serde_json::Value) {
    result(&format!("{value:#}"));
}

/// Prints a line beside the results, on standard error.
pub fn note(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", flat(line));
}

/// Prints the device in use.
pub fn device(device: &DeviceReport) {
    let DeviceReport {
        name, kind, driver, ..
    } = device;
    note(&format!("device: {name} ({kind}), driver {driver}"));
}

/// The note on this machine for the results of a command.
pub fn machine(device: &DeviceReport, command: &str) -> Machine {
    Machine::here(&device.name, device.kind, &device.driver, VERSION, command)
}

/// Prints a warning; the exit code stays the same.
pub fn warn(message: &str) {
    note(&format!("warning: {message}"));
}

/// Prints a failure: the one line on standard error.
pub fn complain(message: &str) {
    note(&format!("revmap: {message}"));
}

/// File names may hold line breaks; messages may not.
fn flat(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// Wrong usage of an option.
pub fn usage(option: &str, message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Usage, message).at_key(option)
}

/// The output files of a command, each with the option that names it and the endings that it may
/// have; without endings it may have any.
#[derive(Default)]
pub struct Outputs<'a>(Vec<(&'static str, &'a Path, &'a [&'a str])>);

impl<'a> Outputs<'a> {
    /// The files of another option, too.
    pub fn and(
        mut self,
        option: &'static str,
        files: impl IntoIterator<Item = &'a PathBuf>,
        endings: &'a [&'a str],
    ) -> Self {
        let files = files.into_iter();
        self.0
            .extend(files.map(|file| (option, file.as_path(), endings)));
        self
    }

    /// Checks the files before any work. None may be named twice or be one of the `inputs`, and
    /// each must be writable.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for the names, [`ErrorKind::File`] for files that cannot be written.
    pub fn check(&self, inputs: &[&Path]) -> Result<()> {
        for (n, (option, file, endings)) in self.0.iter().enumerate() {
            if !endings.is_empty() && !endings.iter().any(|ending| has_ending(file, ending)) {
                let message = format!("ends in none of .{}; name it so", endings.join(", ."));
                return Err(usage(option, message).in_file(file));
            }
            let real = destination(file);
            if self.0[..n].iter().any(|(_, o, _)| destination(o) == real) {
                let message = "is named twice; name each file once";
                return Err(usage(option, message).in_file(file));
            }
            check_writable(file).map_err(|e| e.at_key(*option).in_file(file))?;
        }
        self.spare(inputs.iter().copied())
    }

    /// Refuses to write any of the files over an input.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`], with the file's name.
    pub fn spare<'b>(&self, inputs: impl Iterator<Item = &'b Path>) -> Result<()> {
        let inputs: Vec<_> = inputs.map(destination).collect();
        let over = |(_, file, _): &&(_, &Path, _)| inputs.contains(&destination(file));
        self.0
            .iter()
            .find(over)
            .map_or(Ok(()), |(option, file, _)| {
                Err(usage(option, "is read as well; write to another file").in_file(file))
            })
    }
}

/// Returns true if `file` ends in `.ending`, in upper or lower case.
pub fn has_ending(file: &Path, ending: &str) -> bool {
    file.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(ending))
}
