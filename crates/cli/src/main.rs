//! The `revmap` program: solids of revolution drawn from flat outlines.
//!
//! Exit codes: 0 done, 1 failed, 2 wrong usage, 3 no Vulkan device or one that lacks a needed
//! feature; 4 claims that are not judged (`bench --repeats`). A failure is one line on standard
//! error.

mod animate;
mod bake;
mod bench;
mod compare;
mod devices;
mod failure;
mod last_resort;
mod levels;
mod lists;
mod mesh;
mod moving;
mod options;
mod output;
mod overrun;
mod profile;
mod progress;
mod reading;
mod render;
mod run;
mod samples;
mod searches;
mod shaders;
mod shading;
mod shell;
mod stability;
mod studio;
mod submit;
mod times;
mod vary;
#[cfg(feature = "viewer")]
mod view;
#[cfg(not(feature = "viewer"))]
#[path = "no_view.rs"]
mod view;

use clap::{CommandFactory, Parser, Subcommand};
use revmap::error::{Error, ErrorKind};
use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Revolution mapping: draws solids of revolution from flat outlines, without a stored mesh.
#[derive(Parser)]
#[command(name = "revmap", bin_name = "revmap", version = output::VERSION, max_term_width = 110, after_help = AFTER_HELP)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "Examples:\n  \
    revmap render assets/profiles/pawn.svg -o pawn.png\n  \
    revmap bench --quick\n  \
    revmap render --help\n\n\
    Exit codes: 0 done; 1 failed; 2 wrong usage; 3 no Vulkan device, or one that lacks a needed \
feature; 4 claims that are not judged (bench --repeats); 128 + N ended by the signal N. A failure is one line on standard error.";

macro_rules! commands {
    ($($name:ident: $type:ty,)*) => {
        #[derive(Subcommand)]
        enum Command {
            $($name($type),)*
            Completions(shell::Completions),
            Man(shell::Man),
        }

        impl Command {
            fn run(self) -> revmap::Result<()> {
                match self {
                    $(Self::$name(command) => command.run(),)*
                    Self::Completions(command) => command.run(Program::command()),
                    Self::Man(command) => command.run(Program::command()),
                }
            }
        }
    };
}
commands! {
    Render: render::Render,
    Animate: animate::Animate,
    Bake: bake::Bake,
    Mesh: mesh::Mesh,
    Profile: profile::Profile,
    Bench: bench::Bench,
    Chart: bench::Chart,
    Stability: stability::Stability,
    Submit: submit::Submit,
    Shaders: shaders::Shaders,
    Searches: searches::Searches,
    Shading: shading::Shading,
    Devices: devices::Devices,
    Compare: compare::Compare,
    View: view::View,
}

/// A panic is a bug of the program, reported in one line like every failure.
const FAILED: u8 = 1;

/// The words of the command line, each negative number joined to the option before it: clap takes
/// `--turn -.5` and `--size -5x5` for two options.
fn words() -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    for word in std::env::args_os() {
        let text = word.to_string_lossy();
        let number = text.strip_prefix('-').unwrap_or_default();
        let number = number.strip_prefix('.').unwrap_or(number);
        let option = words.last_mut().filter(|last| {
            let last = last.to_string_lossy();
            last.starts_with("--") && last.len() > 2 && !last.contains('=')
        });
        match option.filter(|_| number.starts_with(|c: char| c.is_ascii_digit())) {
            Some(option) => option.push(format!("={text}")),
            None => words.push(word),
        }
    }
    words
}

fn no_threads(error: rayon::ThreadPoolBuildError) -> Error {
    let message =
        format!("no threads can be begun ({error}); give more memory, or allow more threads");
    Error::new(ErrorKind::OutOfHostMemory, message)
}

fn main() -> ExitCode {
    let program = match Program::try_parse_from(words()) {
        Ok(program) => program,
        Err(error) => return failure::wrong_usage(&error),
    };
    progress::watch();
    overrun::watch();
    // If RUST_BACKTRACE is set, the usual panic message is kept. Otherwise a bug is one line too,
    // below.
    if std::env::var_os("RUST_BACKTRACE").is_none() {
        std::panic::set_hook(Box::new(|_| ()));
    }
    let run = || {
        // Threads need memory, so all crates' threads are begun while there is some.
        rayon::ThreadPoolBuilder::new()
            .build_global()
            .map_err(no_threads)?;
        revmap_searches::watchdog::set_limit()?;
        program.command.run()
    };
    let ended = catch_unwind(AssertUnwindSafe(run));
    overrun::settle();
    match ended {
        Ok(Ok(())) => output::end(),
        Ok(Err(error)) => failure::report(error),
        Err(cause) => {
            let text = cause.downcast_ref::<String>().map(String::as_str);
            let text = text
                .or_else(|| cause.downcast_ref::<&str>().copied())
                .unwrap_or("no message");
            output::complain(&format!(
                "a bug of revmap: {text}; please report it, with what RUST_BACKTRACE=1 prints"
            ));
            ExitCode::from(FAILED)
        }
    }
}
