//! Two PNG pictures side by side, where no depth is kept: a picture of a document and a new one.

use crate::output;
use revmap::error::{Error, ErrorKind, Result};
use revmap_files::Picture;
use serde_json::json;
use std::path::Path;

/// A difference of an 8-bit channel that is none for the eye, and the share of channels that may exceed
/// it in pictures that are alike. Drivers round differently, and a silhouette may fall to either side
/// of a pixel's centre.
const ALIKE: (u8, f64) = (3, 0.002);

/// Compares `b` with `a`; `exact` and `alike` fail if they differ in a byte, or visibly.
///
/// # Errors
/// Those of reading; [`ErrorKind::Content`] for pictures of two sizes; [`ErrorKind::Other`] for
/// pictures that differ more than they may.
pub fn run([a, b]: [&Path; 2], (exact, alike): (bool, bool), json: bool) -> Result<()> {
    let (one, other) = (Picture::read(a)?, Picture::read(b)?);
    let size = |p: &Picture| format!("{}x{}", p.width, p.height);
    if (one.width, one.height) != (other.width, other.height) {
        let message = format!(
            "has {} pixels, the other picture {}; draw both at one size",
            size(&other),
            size(&one)
        );
        return Err(Error::new(ErrorKind::Content, message).in_file(b));
    }
    let channels = one.rgba.as_flattened().iter();
    let apart = || channels.clone().zip(other.rgba.as_flattened());
    let count = |most: u8| apart().filter(|(a, b)| a.abs_diff(**b) > most).count();
    let (differ, far) = (count(0), count(ALIKE.0));
    let largest = apart().map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    let all = one.rgba.len() * 4;
    if json {
        output::json(&json!({
            "channels": all,
            "differ": differ,
            "differ_visibly": far,
            "largest_difference": largest,
        }));
    } else {
        output::result(&format!(
            "{differ} of {all} channels differ, {far} by more than {} of 255; the largest difference is {largest}",
            ALIKE.0
        ));
    }
    let message = match (exact && differ > 0, far as f64 > ALIKE.1 * all as f64) {
        (true, _) => "the pictures differ; draw them again or leave out --exact",
        (_, true) if alike => "the pictures differ visibly; draw them again or leave out --alike",
        _ => return Ok(()),
    };
    Err(Error::new(ErrorKind::Other, message).in_file(b))
}
