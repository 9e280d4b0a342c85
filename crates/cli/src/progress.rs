//! Long work: its interruption, and a progress bar on standard error, only on a terminal, and only
//! for work of more than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use revmap::error::{Error, ErrorKind, Result};
use std::io::IsTerminal;
use std::path::Path;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(100);

/// Work in progress. Dropping it removes the bar from the screen.
pub struct Progress {
    bar: ProgressBar,
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Begins; `quiet` shows nothing.
    pub fn start(what: &str, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        bar.set_message(what.to_owned());
        // Until the first report its length is not known.
        if let Ok(style) = ProgressStyle::with_template("{msg} {spinner} {elapsed}") {
            bar.set_style(style);
        }
        let shown = !quiet && std::io::stderr().is_terminal();
        let watcher = shown.then(|| {
            let (sender, receiver) = channel();
            let bar = bar.clone();
            let wait = move || {
                if receiver.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(TICK);
                }
            };
            (sender, std::thread::spawn(wait))
        });
        Self { bar, watcher }
    }

    /// Changes the text before the bar.
    pub fn say(&self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    /// Reports the finished part; may be called from any thread.
    pub fn report(&self, done: usize, total: usize) {
        if self.bar.length() != Some(total as u64) {
            self.bar.set_length(total as u64);
            if let Ok(style) =
                ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} %, {eta} left")
            {
                self.bar.set_style(style);
            }
        }
        self.bar.set_position(done as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.watcher.take() {
            let _ = sender.send(());
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

/// True if a command reads the flag.
static HANDLED: AtomicBool = AtomicBool::new(false);
/// The flag that the first signal sets.
static STOP: AtomicBool = AtomicBool::new(false);
/// The exit code that shells give to a program ended by the last signal; 0 without one.
static CODE: AtomicU8 = AtomicU8::new(0);
static WATCHED: LazyLock<std::result::Result<(), String>> = LazyLock::new(signals::watch);

/// Watches for Ctrl-C and the signals TERM and HUP from now on: each removes unfinished files and ends
/// the program, but the first one leaves that to a command that called [`interrupt`].
pub fn watch() {
    // A command that needs it reports a failure.
    let _ = &*WATCHED;
}

/// The flag that the first of these signals sets after this call: long work ends early but cleanly.
pub fn interrupt() -> Result<&'static AtomicBool> {
    let set = WATCHED.as_ref().map_err(|why| {
        let message = format!("interrupts cannot be watched for ({why}); run it again");
        Error::new(ErrorKind::Other, message)
    });
    HANDLED.store(true, Ordering::SeqCst);
    set.map(|()| &STOP)
}

/// The exit code that shells give to a program ended by a signal, if one came.
pub fn ended_by_signal() -> Option<u8> {
    Some(CODE.load(Ordering::SeqCst)).filter(|code| *code != 0)
}

/// Notes a signal. Returns true if the program is to end at once.
fn ends(code: u8) -> bool {
    CODE.store(code, Ordering::SeqCst);
    let handled = HANDLED.load(Ordering::SeqCst);
    if !STOP.swap(true, Ordering::SeqCst) && handled {
        return false;
    }
    revmap_files::remove_unfinished();
    if handled {
        crate::output::complain(
            "ended at once by a second signal; its results are not complete, run the command again",
        );
    }
    true
}

/// The failure of a run that was ended early but keeps its results in the folder `out`, which the
/// command line may have `named`.
pub fn interrupted(out: &Path, named: bool) -> Error {
    let again = if named { " with --overwrite" } else { "" };
    let message = format!(
        "interrupted; it holds what was done until then, for all run the command again{again}"
    );
    Error::new(ErrorKind::Other, message).in_file(out)
}

#[cfg(unix)]
mod signals {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    /// Shells add this to the number of a signal.
    const SIGNALLED: i32 = 128;

    pub fn watch() -> Result<(), String> {
        let begin = || {
            // A file above the process's limit is an error of the write that passes it.
            signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)))?;
            let watched = [SIGINT, SIGTERM, SIGHUP].into_iter();
            let mut signals = Signals::new(watched.filter(|signal| !is_ignored(*signal)))?;
            let wait = move || {
                for signal in signals.forever() {
                    if super::ends(u8::try_from(SIGNALLED + signal).unwrap_or(0)) {
                        let _ = emulate_default_handler(signal);
                    }
                }
            };
            std::thread::Builder::new().spawn(wait)
        };
        begin().map(drop).map_err(|e| e.to_string())
    }

    /// Returns true for HUP under `nohup`, which is meant to be without effect.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mut lines = status.lines();
        let ignored = lines.find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
        signal == SIGHUP && ignored.is_some_and(|bits| bits >> (signal - 1) & 1 == 1)
    }
}

#[cfg(not(unix))]
mod signals {
    /// The exit code that shells give to a program ended by an interrupt.
    const INTERRUPTED: u8 = 130;

    pub fn watch() -> Result<(), String> {
        let stop = || {
            if super::ends(INTERRUPTED) {
                std::process::exit(INTERRUPTED.into());
            }
        };
        ctrlc::set_handler(stop).map_err(|e| e.to_string())
    }
}
