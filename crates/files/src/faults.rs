//! Failures of pictures and drawings of which no solid is made.

use crate::content_fault;
use revmap::error::Error;

/// The failure of a picture without anything dark.
pub fn empty_fault(what: &str) -> Error {
    content_fault(format!(
        "the {what} is empty: nothing of the half right of the axis is darker than one half; draw the solid dark on \
         white, or set {}",
        keys(what)
    ))
}

/// The failure of a solid that is left of the axis, with its place.
pub fn half_empty_fault(aside: &str) -> Error {
    content_fault(format!("the half right of the axis is empty: {aside}"))
}

/// Keys that may help. Drawings do not have those of tones.
fn keys(what: &str) -> &'static str {
    match what {
        "drawing" => "profile_axis",
        _ => "profile_threshold, profile_invert or profile_axis",
    }
}

/// The failure of a picture that is dark all over.
pub fn full_fault(what: &str) -> Error {
    content_fault(format!(
        "the {what} is full: all of the half right of the axis is darker than one half; draw the solid dark on white \
         or set {} (a plain cylinder: use a polygon)",
        keys(what)
    ))
}
