//! A limit on the time of a frame that a folder's search draws. Vulkan cannot end a shader that
//! runs, so the program must end itself: it says which search did not end, and may begin again
//! without that search.

use crate::folder;
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::Solver;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

/// The variable that sets another limit of a frame, and of a table's program, than ten seconds.
pub const LIMIT: &str = "REVMAP_TIME_LIMIT";

/// The limit.
#[must_use]
pub fn limit() -> Duration {
    let set = std::env::var(LIMIT).ok().and_then(|text| text.parse().ok());
    Duration::from_secs(set.unwrap_or(10))
}

/// The variable that names searches not to draw by, a line each: a name, a tab, the reason.
pub const LEFT_OUT: &str = "REVMAP_LEFT_OUT";

/// Called with a search's name and the reason when its frame does not end.
pub type Handler = fn(&str, &str);

static HANDLER: OnceLock<Handler> = OnceLock::new();

/// Searches not to draw by, each with the reason.
static OUT: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Draws no more frames by the search of this name.
pub fn leave_out(name: String, reason: String) {
    if let Ok(mut out) = OUT.lock() {
        out.push((name, reason));
    }
}

/// Sets the handler, which should not return. Without one the process ends with exit code 1.
pub fn set_handler(handler: Handler) {
    let _ = HANDLER.set(handler);
}

/// Fails for a search that is [left out](leave_out), or that [`LEFT_OUT`] names.
///
/// # Errors
/// [`ErrorKind::Other`], with the reason.
pub fn check(name: &str) -> Result<()> {
    let named = std::env::var(LEFT_OUT).unwrap_or_default();
    let mut lines = named.lines().filter_map(|line| line.split_once('\t'));
    let named = lines.find(|(known, _)| *known == name);
    let reason = named.map(|(_, reason)| reason.to_owned()).or_else(|| {
        let out = OUT.lock().ok()?;
        let found = out.iter().find(|(known, _)| known == name);
        found.map(|(_, reason)| reason.clone())
    });
    match reason {
        Some(reason) => Err(Error::new(ErrorKind::Other, reason)),
        None => Ok(()),
    }
}

/// Draws a frame. If a folder's search draws it, the frame has a limit of time, and a device that
/// is lost counts as a frame that does not end.
///
/// # Errors
/// Those of `draw`.
pub fn watched<T>(solver: Option<Solver>, draw: impl FnOnce() -> Result<T>) -> Result<T> {
    let Some(folder) = solver.and_then(folder::of) else {
        return draw();
    };
    let name = folder.name();
    check(&name)?;
    let (done, wait) = channel::<()>();
    let own = name.clone();
    let watch = std::thread::spawn(move || {
        let ended = wait.recv_timeout(limit());
        if ended == Err(RecvTimeoutError::Timeout) {
            overrun(
                &own,
                &format!(
                    "a frame by {own} took more than {} seconds: its search does not end, or is too slow; bound its loop by most_steps(), or set {LIMIT}",
                    limit().as_secs()
                ),
            );
        }
    });
    let drawn = draw();
    drop(done);
    let _ = watch.join();
    if let Err(error) = &drawn
        && error.kind == ErrorKind::DeviceLost
    {
        overrun(
            &name,
            &format!(
                "the device was lost while {name} drew: its search does not end, or reads what is not there ({})",
                error.message
            ),
        );
    }
    drawn
}

fn overrun(name: &str, reason: &str) {
    match HANDLER.get() {
        Some(handler) => handler(name, reason),
        None => {
            eprintln!("{reason}");
            std::process::exit(1);
        }
    }
}
