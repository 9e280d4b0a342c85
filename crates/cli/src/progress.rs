//! Long work: its interruption, and a progress bar on standard error, only on a terminal, and only
//! for work of more than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use revmap::error::{Error, ErrorKind, Result};
use std::io::IsTerminal;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
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

/// The exit code that shells give to a program ended by an interrupt.
const INTERRUPTED: i32 = 130;

/// The flag that Ctrl-C sets after this call: long work ends early but cleanly. A second one ends the
/// program at once.
pub fn interrupt() -> Result<&'static AtomicBool> {
    static STOP: AtomicBool = AtomicBool::new(false);
    static SET: OnceLock<std::result::Result<(), String>> = OnceLock::new();
    let set = SET.get_or_init(|| {
        ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
        })
        .map_err(|e| e.to_string())
    });
    match set {
        Ok(()) => Ok(&STOP),
        Err(why) => Err(Error::new(
            ErrorKind::Other,
            format!("interrupts cannot be watched for ({why}); run it again"),
        )),
    }
}
