//! Errors of pictures and drawings, each with its remedy.

use crate::error::{Error, ErrorKind};

/// The failure of a picture without anything dark.
pub(super) fn empty_fault(what: &str) -> Error {
    Error::new(
        ErrorKind::Content,
        format!(
            "the {what} is empty: nothing of the half right of the axis is darker than one half; draw the solid dark on \
             white, or set profile_threshold, profile_invert or profile_axis"
        ),
    )
}

/// The failure of a picture that is dark all over.
pub(super) fn full_fault(what: &str) -> Error {
    Error::new(
        ErrorKind::Content,
        format!(
            "the {what} is full: all of the half right of the axis is darker than one half; draw the solid dark on white \
             or set profile_threshold or profile_invert (a plain cylinder: use a polygon)"
        ),
    )
}
