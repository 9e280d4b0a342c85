//! Long work: its interruption, and a progress bar on standard error, only on a terminal, and only
//! for work of more than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use revmap::error::{Error, ErrorKind, Result};
use std::io::IsTerminal;
use std::sync::atomic::AtomicBool;
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

/// The flag that Ctrl-C and the signals TERM and HUP set after this call: long work ends early but
/// cleanly. A second one ends the program at once.
pub fn interrupt() -> Result<&'static AtomicBool> {
    let set = interrupt::flag().as_ref().copied();
    set.map_err(|why| {
        let message = format!("interrupts cannot be watched for ({why}); run it again");
        Error::new(ErrorKind::Other, message)
    })
}

/// The exit code that shells give to a program ended by TERM or HUP, if one came. Ctrl-C leaves the
/// code of a failure.
pub fn ended_by_signal() -> Option<u8> {
    interrupt::code()
}

#[cfg(unix)]
mod interrupt {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::sync::LazyLock;
    use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

    /// Shells add this to the number of a signal.
    const SIGNALLED: i32 = 128;

    static STOP: AtomicBool = AtomicBool::new(false);
    /// The last of the signals.
    static SIGNAL: AtomicI32 = AtomicI32::new(0);
    static SET: LazyLock<Result<&'static AtomicBool, String>> =
        LazyLock::new(|| watch().map(|()| &STOP).map_err(|e| e.to_string()));

    pub fn flag() -> &'static Result<&'static AtomicBool, String> {
        &SET
    }

    pub fn code() -> Option<u8> {
        let signal = SIGNAL.load(Ordering::SeqCst);
        let signal = Some(signal).filter(|s| [SIGTERM, SIGHUP].contains(s))?;
        u8::try_from(SIGNALLED + signal).ok()
    }

    /// The first signal sets the flag, a second one ends the program.
    fn watch() -> std::io::Result<()> {
        let watched = [SIGINT, SIGTERM, SIGHUP].into_iter();
        let mut signals = Signals::new(watched.filter(|signal| !is_ignored(*signal)))?;
        let wait = move || {
            for signal in signals.forever() {
                SIGNAL.store(signal, Ordering::SeqCst);
                if STOP.swap(true, Ordering::SeqCst) {
                    revmap_files::remove_unfinished();
                    signal_hook::low_level::exit(SIGNALLED + signal);
                }
            }
        };
        std::thread::Builder::new().spawn(wait).map(drop)
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
mod interrupt {
    use std::sync::LazyLock;
    use std::sync::atomic::{AtomicBool, Ordering};

    /// The exit code that shells give to a program ended by an interrupt.
    const INTERRUPTED: i32 = 130;

    static STOP: AtomicBool = AtomicBool::new(false);
    static SET: LazyLock<Result<&'static AtomicBool, String>> = LazyLock::new(|| {
        let stop = || {
            if STOP.swap(true, Ordering::Relaxed) {
                revmap_files::remove_unfinished();
                std::process::exit(INTERRUPTED);
            }
        };
        ctrlc::set_handler(stop).map_err(|e| e.to_string())?;
        Ok(&STOP)
    });

    pub fn flag() -> &'static Result<&'static AtomicBool, String> {
        &SET
    }

    pub fn code() -> Option<u8> {
        None
    }
}
