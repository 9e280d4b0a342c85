//! A limit on the time of a frame that a folder's search draws. Vulkan cannot end a shader that
//! runs. A program that must end sets a [handler](set_handler), which says which search did not end,
//! and may begin again without that search.

use revmap::error::{Error, ErrorKind, Result};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, OnceLock};
use std::time::Duration;

/// The variable that sets another limit of a frame, and of a table's program, than ten seconds.
pub const LIMIT: &str = "REVMAP_TIME_LIMIT";

/// Ten seconds.
const USUAL_LIMIT: Duration = Duration::from_secs(10);

/// The limit.
#[must_use]
pub fn limit() -> Duration {
    set_limit().unwrap_or(USUAL_LIMIT)
}

/// The limit that the environment sets, or ten seconds.
///
/// # Errors
/// [`ErrorKind::Usage`] for a value that is no number of seconds.
pub fn set_limit() -> Result<Duration> {
    let Some(text) = std::env::var_os(LIMIT) else {
        return Ok(USUAL_LIMIT);
    };
    let text = text.to_string_lossy();
    parsed_limit(&text).ok_or_else(|| {
        let message = format!("{LIMIT} is {text:?}; give seconds from 0.001 to 1000000, as in 2.5");
        Error::new(ErrorKind::Usage, message)
    })
}

fn parsed_limit(text: &str) -> Option<Duration> {
    let seconds: f64 = text.trim().parse().ok()?;
    let is_limit = (1e-3..=1e6).contains(&seconds);
    is_limit.then(|| Duration::from_secs_f64(seconds))
}

/// The limit in words.
#[must_use]
pub fn limit_in_words() -> String {
    in_words(limit())
}

fn in_words(limit: Duration) -> String {
    match limit.as_secs_f64() {
        1.0 => "1 second".to_owned(),
        seconds => format!("{seconds} seconds"),
    }
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

/// Sets the handler. A frame that does not end blocks its thread, so a handler should end the program.
/// The library never does.
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

/// Draws a frame by the folder's search of this name, if it is drawn by one: the frame has a limit
/// of time, and a device that is lost counts as a frame that does not end. The
/// [handler](set_handler) hears of both.
///
/// # Errors
/// Those of `draw`; [`ErrorKind::Other`] for a frame that ended after the limit.
pub fn watched<T>(folder: Option<String>, draw: impl FnOnce() -> Result<T>) -> Result<T> {
    let Some(name) = folder else {
        return draw();
    };
    check(&name)?;
    limited(&name, limit(), draw)
}

fn limited<T>(name: &str, limit: Duration, draw: impl FnOnce() -> Result<T>) -> Result<T> {
    let (done, wait) = channel::<()>();
    let watch = move || {
        let ended = wait.recv_timeout(limit);
        (ended == Err(RecvTimeoutError::Timeout)).then(|| {
            let words = in_words(limit);
            let reason = format!(
                "a frame by {name} took more than {words}: its search does not end, or is too slow; bound its loop by most_steps(), or set {LIMIT}"
            );
            overrun(name, &reason);
            Error::new(ErrorKind::Other, reason)
        })
    };
    let (drawn, late) = std::thread::scope(|scope| {
        let watch = scope.spawn(watch);
        let drawn = draw();
        drop(done);
        (drawn, watch.join().ok().flatten())
    });
    match (drawn, late) {
        (_, Some(late)) => Err(late),
        (Err(error), None) if error.kind == ErrorKind::DeviceLost => {
            let reason = format!(
                "the device was lost while {name} drew: its search does not end, or reads what is not there ({})",
                error.message
            );
            overrun(name, &reason);
            Err(Error::new(ErrorKind::DeviceLost, reason))
        }
        (drawn, None) => drawn,
    }
}

fn overrun(name: &str, reason: &str) {
    if let Some(handler) = HANDLER.get() {
        handler(name, reason);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_seconds_with_fractions() {
        let words = |text| parsed_limit(text).map(in_words);
        assert_eq!(words("0.05").as_deref(), Some("0.05 seconds"));
        assert_eq!(words("1").as_deref(), Some("1 second"));
        assert_eq!(words("20").as_deref(), Some("20 seconds"));
        for bad in ["abc", "", "0", "-1", "nan", "inf", "1e9"] {
            assert_eq!(words(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_late_frame_and_a_lost_device_are_errors() {
        let limit = Duration::from_millis(1);
        let late = limited("slow", limit, || {
            std::thread::sleep(Duration::from_millis(50));
            Ok(())
        });
        let late = late.unwrap_err();
        assert_eq!(late.kind, ErrorKind::Other);
        let text = late.to_string();
        assert!(
            text.contains("a frame by slow took more than 0.001"),
            "{text}"
        );
        let limit = Duration::from_secs(100);
        let lost = || Err(Error::new(ErrorKind::DeviceLost, "gone"));
        let lost = limited::<()>("wild", limit, lost).unwrap_err();
        assert_eq!(lost.kind, ErrorKind::DeviceLost);
        assert!(lost.to_string().contains("while wild drew"), "{lost}");
        assert_eq!(limited("fine", limit, || Ok(7)), Ok(7));
        let other = Error::new(ErrorKind::Content, "bad");
        assert_eq!(
            limited::<()>("bad", limit, || Err(other.clone())),
            Err(other)
        );
    }
}
