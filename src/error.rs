//! Errors: every failure has a kind, which says what a program can do about it, and the file and
//! key that caused it.
//!
//! Every function that calls Vulkan can fail with [`ErrorKind::DeviceLost`],
//! [`ErrorKind::OutOfDeviceMemory`], [`ErrorKind::OutOfHostMemory`] and, for a driver's fault,
//! [`ErrorKind::Other`]. Their docs say "of Vulkan".

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

/// The result of every function in this crate that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Kinds of failure, by what a program can do about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorKind {
    /// Fix the call: its arguments, or the order of calls, are invalid.
    Usage,
    /// Fix the values of a scene, a profile or a map; [`Error::key`] names the value.
    Content,
    /// Check the file, which cannot be read or written; [`Error::file`] names it.
    File,
    /// Use another device: there is none, or it lacks a feature, a format or an extension.
    Unsupported,
    /// Request less: pixels, texels, copies or tables exceed the limits of the device or of this
    /// crate.
    TooLarge,
    /// Request less, or free host memory.
    OutOfHostMemory,
    /// Request less, or free device memory. A memory budget, if one was set, may be raised.
    OutOfDeviceMemory,
    /// Drop everything that was made on the device, and open it again.
    DeviceLost,
    /// Report it: a driver or this crate is at fault.
    Other,
}

/// A failure in one sentence: place, cause and remedy.
///
/// ```
/// use revmap::error::{Error, ErrorKind};
/// let e = Error::new(ErrorKind::Content, "the scale has a zero; give positive numbers")
///     .at_key("object.0.scale")
///     .in_file("board.toml");
/// assert_eq!(e.to_string(), "board.toml: object.0.scale: the scale has a zero; give positive numbers");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The kind, by what a program can do about it.
    pub kind: ErrorKind,
    /// The file concerned.
    pub file: Option<PathBuf>,
    /// The value concerned: a key of the scene file, or a setting.
    pub key: Option<String>,
    /// The cause and the remedy.
    pub message: String,
}

impl Error {
    /// A failure of a kind; `message` gives the cause and the remedy. Line breaks from other
    /// libraries' messages become spaces.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        let mut message: String = message.into();
        if message.contains('\n') {
            let lines: Vec<_> = message.lines().map(str::trim).collect();
            message = lines.join(" ");
        }
        Self {
            kind,
            file: None,
            key: None,
            message,
        }
    }

    /// Adds the file, unless the error already has one.
    #[must_use]
    pub fn in_file(mut self, file: impl AsRef<Path>) -> Self {
        self.file.get_or_insert_with(|| file.as_ref().to_path_buf());
        self
    }

    /// Adds the key, unless the error already has one.
    #[must_use]
    pub fn at_key(mut self, key: impl Into<String>) -> Self {
        self.key.get_or_insert_with(|| key.into());
        self
    }
}

/// Locks a value that threads share.
pub(crate) fn lock<T>(shared: &Mutex<T>) -> Result<MutexGuard<'_, T>> {
    let message = "a lock is poisoned: another thread panicked while it held it";
    let poisoned = |_| Error::new(ErrorKind::Other, message);
    shared.lock().map_err(poisoned)
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}: ", file.display())?;
        }
        if let Some(key) = &self.key {
            write!(f, "{key}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

/// Fails at a key: the call is wrong.
pub(crate) fn usage<T>(key: &str, message: impl Into<String>) -> Result<T> {
    Err(Error::new(ErrorKind::Usage, message).at_key(key))
}

/// Fails at a key: the value is wrong.
pub(crate) fn content<T>(key: &str, message: impl Into<String>) -> Result<T> {
    Err(Error::new(ErrorKind::Content, message).at_key(key))
}
