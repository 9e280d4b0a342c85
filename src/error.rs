//! What can go wrong, and where: every failure names its stage, and the file and the key it came
//! from.

use std::fmt;
use std::path::{Path, PathBuf};

/// The result of everything in this crate that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// The stage in which a failure arose. It decides the program's exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Options or arguments that make no sense (exit code 2).
    Usage,
    /// Reading a scene file or checking its values.
    Scene,
    /// Reading a profile: image, drawing or polygon.
    Profile,
    /// Baking, saving or loading a map.
    Map,
    /// Finding a Vulkan device, or one that has what is needed (exit code 3).
    Device,
    /// A Vulkan call, or work on the GPU.
    Draw,
    /// Writing or reading a frame.
    Frame,
    /// Measuring, or writing and reading what was measured.
    Report,
}

/// A failure in one sentence: where, what, and what to do about it.
///
/// ```
/// use revmap::error::{Error, Stage};
/// let e = Error::new(Stage::Scene, "the scale has a zero; give positive numbers")
///     .at_key("object.0.scale")
///     .in_file("board.toml");
/// assert_eq!(e.to_string(), "board.toml: object.0.scale: the scale has a zero; give positive numbers");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// Where in the flow of data it happened.
    pub stage: Stage,
    /// The file concerned.
    pub file: Option<PathBuf>,
    /// The key of the scene file, or the option, concerned.
    pub key: Option<String>,
    /// What is wrong, and the remedy.
    pub message: String,
}

impl Error {
    /// A failure of `stage`; `message` says what is wrong and what would be right. What other
    /// libraries say in several lines is told in one.
    pub fn new(stage: Stage, message: impl Into<String>) -> Self {
        let mut message: String = message.into();
        if message.contains('\n') {
            let lines: Vec<_> = message.lines().map(str::trim).collect();
            message = lines.join(" ");
        }
        Self {
            stage,
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

    /// The program's exit code: 2 wrong usage, 3 no usable device, 1 all else.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self.stage {
            Stage::Usage => 2,
            Stage::Device => 3,
            _ => 1,
        }
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
