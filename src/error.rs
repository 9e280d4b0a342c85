//! What can go wrong: every failure has a kind, which says what a program can do about it, and
//! names the file and the key that it came from.
//!
//! Every function that calls Vulkan can fail with [`ErrorKind::DeviceLost`],
//! [`ErrorKind::OutOfDeviceMemory`], [`ErrorKind::OutOfHostMemory`] and, for a driver's fault,
//! [`ErrorKind::Other`]. Docs of such functions say "of Vulkan".

use std::fmt;
use std::path::{Path, PathBuf};

/// The result of everything in this crate that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// What a program can do about a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ErrorKind {
    /// Mend the call: its arguments, or the order of calls, make no sense.
    Usage,
    /// Mend the values of a scene, a profile or a map; [`Error::key`] names the value.
    Content,
    /// Look at the file, which cannot be read or written; [`Error::file`] names it.
    File,
    /// Take another device: there is none, or it lacks a feature, a format or an extension.
    Unsupported,
    /// Ask for less: pixels, texels, copies or tables are more than the device or this crate takes.
    TooLarge,
    /// Ask for less, or free memory of the host.
    OutOfHostMemory,
    /// Ask for less, or free memory of the device. Its budget, where one was set, may be larger.
    OutOfDeviceMemory,
    /// Drop all that was made on the device, and open it again.
    DeviceLost,
    /// Report it: a driver or this crate is at fault.
    Other,
}

/// A failure in one sentence: where, what, and what to do about it.
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
    /// What can be done about it.
    pub kind: ErrorKind,
    /// The file concerned.
    pub file: Option<PathBuf>,
    /// The value concerned: a key of the scene file, or a setting.
    pub key: Option<String>,
    /// What is wrong, and the remedy.
    pub message: String,
}

impl Error {
    /// A failure of a kind; `message` says what is wrong and what would be right. Line breaks, as
    /// other libraries write them, become spaces.
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

    /// Adds the file, unless a deeper place named one already.
    #[must_use]
    pub fn in_file(mut self, file: impl AsRef<Path>) -> Self {
        self.file.get_or_insert_with(|| file.as_ref().to_path_buf());
        self
    }

    /// Adds the key, unless a deeper place named one already.
    #[must_use]
    pub fn at_key(mut self, key: impl Into<String>) -> Self {
        self.key.get_or_insert_with(|| key.into());
        self
    }
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
