//! Ctrl-C: the first ends long work early but cleanly, the second ends the program at once.

use revmap::error::{Error, ErrorKind, Result};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// The exit code that shells give to a program ended by an interrupt.
const INTERRUPTED: i32 = 130;

/// The flag that an interrupt sets after this call.
pub fn flag() -> Result<&'static AtomicBool> {
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
