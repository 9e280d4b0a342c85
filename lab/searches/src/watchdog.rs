//! A limit on the time of a frame that a folder's search draws. Vulkan cannot end a shader that
//! runs, so a frame that does not end blocks its thread. The library only reports such a frame, by
//! [`wait`] and [`found`]: a program may then end, or begin again without the search.

use revmap::error::{Error, ErrorKind, Result};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The variable that sets another limit of a frame, and of a table's program, than ten seconds.
pub const LIMIT: &str = "REVMAP_TIME_LIMIT";

const USUAL_LIMIT: Duration = Duration::from_secs(10);

/// The limit.
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
pub fn limit_in_words() -> String {
    in_words(limit())
}

fn in_words(limit: Duration) -> String {
    match limit.as_secs_f64() {
        1.0 => "1 second".to_owned(),
        seconds => format!("{seconds} seconds"),
    }
}

/// Searches not to draw by, each with the reason.
static OUT: Mutex<Vec<(String, String)>> = Mutex::new(Vec::new());

/// Draws no more frames by the search of this name.
pub fn leave_out(name: String, reason: String) {
    if let Ok(mut out) = OUT.lock() {
        out.push((name, reason));
    }
}

/// Fails for a search that is [left out](leave_out).
///
/// # Errors
/// [`ErrorKind::Other`], with the reason.
pub fn check(name: &str) -> Result<()> {
    let out = OUT.lock().unwrap_or_else(PoisonError::into_inner);
    match out.iter().find(|(known, _)| known == name) {
        Some((_, reason)) => Err(Error::new(ErrorKind::Other, reason.clone())),
        None => Ok(()),
    }
}

/// A search whose frame did not end in time, or lost the device.
#[derive(Clone, Debug)]
pub struct Overrun {
    /// The search's name.
    pub name: String,
    /// The reason, for people.
    pub reason: String,
}

static FOUND: Mutex<Option<Overrun>> = Mutex::new(None);
static CHANGED: Condvar = Condvar::new();

fn lock() -> MutexGuard<'static, Option<Overrun>> {
    FOUND.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The first overrun so far.
pub fn found() -> Option<Overrun> {
    lock().clone()
}

/// Blocks until a frame overruns, and returns the first overrun. The frame may still be drawn, and may
/// block its thread for good.
pub fn wait() -> Overrun {
    let mut found = lock();
    loop {
        if let Some(overrun) = &*found {
            return overrun.clone();
        }
        found = CHANGED.wait(found).unwrap_or_else(PoisonError::into_inner);
    }
}

/// Draws a frame by the folder's search of this name, if it is drawn by one: the frame has a limit
/// of time, and a device that is lost counts as a frame that does not end. [`wait`] and [`found`]
/// report both.
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
            report(name, &reason);
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
            report(name, &reason);
            Err(Error::new(ErrorKind::DeviceLost, reason))
        }
        (drawn, None) => drawn,
    }
}

fn report(name: &str, reason: &str) {
    let [name, reason] = [name, reason].map(str::to_owned);
    lock().get_or_insert(Overrun { name, reason });
    CHANGED.notify_all();
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
    fn late_frames_and_lost_devices_are_errors_and_reported() {
        let limit = Duration::from_millis(1);
        let late = limited("slow", limit, || {
            // The frame is still being drawn when it is reported.
            assert_eq!(wait().name, "slow");
            Ok(())
        });
        let late = late.unwrap_err();
        assert_eq!(
            found().map(|found| found.reason),
            Some(late.message.clone())
        );
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
