//! Why a drawing is refused.

use std::fmt::{Display, Formatter};

/// Why a drawing is refused, in one line: the feature, its line in the file and a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(pub(crate) String);

/// A value, or why the drawing is refused.
pub type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// The fault of a file that cannot be parsed.
    pub(crate) fn damaged(e: &dyn Display) -> Self {
        let text = e.to_string().replace('\n', " ");
        Self(format!(
            "the drawing is damaged ({text}); save it again as plain SVG"
        ))
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Fault {}
