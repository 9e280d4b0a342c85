//! Profiles from drawings and pictures.
//!
//! A warning belongs to what it needs to know:
//!
//! | about | made in |
//! |---|---|
//! | a feature that is drawn otherwise, by its line | [`revmap_drawing`] |
//! | gradients, thin strokes, edges of the page | `drawing` |
//! | tones, noise and transparency | `options`, `picture` |
//! | what a silhouette seems to be, its axis, its gaps | `seeming`, for drawings, pictures and polygons |
//! | the points of a polygon, and the box that cuts it | `scene::polygon` |
//! | a whole scene | [`scene::warnings`](crate::warnings) |

mod advice;
mod drawing;
mod noise;
mod options;
mod picture;
mod seeming;

pub(crate) use drawing::canvas::FLATNESS;
pub use noise::Smooth;
pub use options::{ProfileAxis, ProfileOptions, ProfileRead};
pub(crate) use picture::outline_over;
pub(crate) use seeming::gaps::hints as gap_hints;

use crate::Picture;
use crate::pixels::is_picture;
use crate::{content_fault, file_fault, read_bytes};
use advice::{Way, followed};
use revmap::error::Result;
use revmap::profile::Profile;
use std::path::Path;

/// Files that profiles are read from.
const KINDS: &str = "PNG, JPEG or SVG";

/// Reads a profile from a file, by its content: PNG, JPEG, or SVG (also gzip-compressed).
///
/// `options` are a [`ProfileAxis`] or all [`ProfileOptions`]. The top edge is `z = 1`, the bottom
/// edge `z = 0`. Everything darker than one half over white is solid, unless the options say
/// otherwise. Pictures are upright by their EXIF data, and traced as by [`trace`](crate::trace()). The curves of drawings are
/// flattened within 1e-5 of the height. `R` is width / height with the axis at the left, and half
/// of that with the axis in the middle.
///
/// ```no_run
/// let pawn = revmap_files::profile("pawn.svg", revmap_files::ProfileAxis::Center)?;
/// # Ok::<(), revmap::Error>(())
/// ```
///
/// # Errors
/// [`ErrorKind::File`](revmap::error::ErrorKind::File) for a file that is missing, a folder,
/// damaged, or neither picture nor drawing.
/// [`ErrorKind::Content`](revmap::error::ErrorKind::Content) for a picture of more than 16384 or
/// less than 2 pixels on a side, all light or all dark, or a drawing with parts that have no
/// outline (text, pictures, patterns, masks, filters). The error names the file in both cases.
pub fn profile(path: impl AsRef<Path>, options: impl Into<ProfileOptions>) -> Result<Profile> {
    let (path, options) = (path.as_ref(), options.into());
    let read = || profile_from_bytes(&read_file(path)?, options);
    read().map_err(|e| e.in_file(path))
}

/// Reads a profile from the bytes of a file, such as one embedded in the program; otherwise like
/// [`profile`].
///
/// # Errors
/// The errors of [`profile`], without a file name.
pub fn profile_from_bytes(bytes: &[u8], options: impl Into<ProfileOptions>) -> Result<Profile> {
    read(bytes, &options.into()).map(|(profile, _)| profile)
}

/// The profile, and the axis that was taken.
fn read(bytes: &[u8], options: &ProfileOptions) -> Result<(Profile, ProfileAxis)> {
    options.check()?;
    let is_drawing = revmap_drawing::is_markup(bytes);
    if is_drawing {
        options.for_drawing()?;
    }
    let by_way = |way: Way, read: ProfileRead| match is_drawing {
        true => drawing::profile(bytes, way, options.min_stroke),
        false => {
            let axis = way.axis;
            picture::profile(
                bytes,
                &ProfileOptions {
                    axis,
                    read,
                    ..*options
                },
            )
        }
    };
    match options.read {
        ProfileRead::Threshold => {
            let (axis, pale) = (options.axis, false);
            Ok((by_way(Way { axis, pale }, options.read)?, axis))
        }
        ProfileRead::Auto => {
            let first = Way {
                axis: options.axis,
                pale: false,
            };
            let read = |way| match way == first {
                true => by_way(way, ProfileRead::Auto),
                false => by_way(way, ProfileRead::Threshold),
            };
            followed(&read, first).map(|(profile, way)| (profile, way.axis))
        }
    }
}

/// The picture of a profile, with the outline that [`profile`] reads from it drawn over it.
///
/// # Errors
/// The errors of [`profile`]; [`ErrorKind::Content`](revmap::error::ErrorKind::Content) for a
/// drawing.
pub fn show_outline(path: impl AsRef<Path>, options: impl Into<ProfileOptions>) -> Result<Picture> {
    let (path, options) = (path.as_ref(), options.into());
    let read = || match read_file(path)? {
        bytes if is_picture(&bytes) => outline_over(&bytes, &options),
        _ => Err(content_fault(
            "is no picture; an outline is shown over pictures alone",
        )),
    };
    read().map_err(|e| e.in_file(path))
}

pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>> {
    if path.is_dir() {
        return Err(file_fault("is a folder; give a PNG, JPEG or SVG file"));
    }
    read_bytes(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => file_fault("does not exist; give a PNG, JPEG or SVG file"),
        std::io::ErrorKind::FileTooLarge => file_fault(format!("{e}; give a smaller file")),
        _ => file_fault(format!(
            "cannot be read ({e}); check the file's permissions"
        )),
    })
}

/// Returns true if the bytes are those of a picture or a drawing.
pub(crate) fn is_profile(bytes: &[u8]) -> bool {
    is_picture(bytes) || revmap_drawing::is_markup(bytes)
}
