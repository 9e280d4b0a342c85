//! A **profile**: the solid region of the meridian half-plane that is turned about the axis.
//!
//! Coordinates are `(r, z)` in object units. The axis is `r = 0`; the shape box extends from
//! `z = 0` to `z = 1` and to the radius `R`. A profile comes from a picture, a drawing or a
//! polygon. Every profile holds one [`Outline`]. Maps, arc lengths, surfaces, meshes and the
//! reference are all computed from this outline.

mod area;
#[cfg(feature = "drawing")]
mod drawing;
mod faults;
pub(crate) mod image;
mod noise;
mod outline;
#[cfg(feature = "drawing")]
mod paint;
mod polygon;
mod raster;
mod reading;
mod region;
mod smooth;
#[cfg(feature = "drawing")]
mod svg;
mod trace;

pub use noise::Smooth;
pub use outline::Segment;
pub use reading::ProfileOptions;

use crate::error::{Error, ErrorKind, Result};
use glam::DVec2;
use std::path::Path;

/// The part of the picture that is the half-plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProfileAxis {
    /// The axis is the left edge: the picture is a half profile.
    Left,
    /// The axis is the middle: the picture is a whole silhouette, and its right half is used.
    #[default]
    Center,
}

/// The solid's boundary as closed chains of straight segments.
///
/// The loops do not cross. The solid is on the **left** of every segment: outer loops run
/// counter-clockwise in `(r, z)`, holes clockwise. All points have `r >= 0`. Segments along `r = 0`
/// close a loop on the axis. They are inside the turned solid and not part of its surface (see
/// [`Outline::surface_segments`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Closed loops; the last point joins the first.
    pub loops: Vec<Vec<DVec2>>,
}

/// Solid fraction of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Pixels along `r`; the axis is the left edge of column 0.
    pub columns: u32,
    /// Pixels along `z`; row 0 is the top.
    pub rows: u32,
    /// Solid fraction in `[0, 1]`, row by row from the top; `columns * rows` values.
    pub coverage: Vec<f32>,
}

/// A solid region of the half-plane and the radius of its shape box.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The region's boundary.
    pub outline: Outline,
    /// `R`: the shape box is `[-R, R]^2 x [0, 1]`.
    pub radius: f64,
    /// The pixels of the picture that the outline was traced from, for the map source `binary`.
    /// `None` for drawings and polygons, and for pictures whose axis is the middle of a column of
    /// pixels.
    pub raster: Option<Raster>,
    /// Features of the picture that look unintended: one sentence each, with the key that changes
    /// it.
    pub warnings: Vec<String>,
}

impl Profile {
    /// Reads a profile from a file, by its content: PNG, JPEG, or SVG (feature `drawing`; also
    /// gzip-compressed).
    ///
    /// `options` are a [`ProfileAxis`] or all [`ProfileOptions`]. The top edge is `z = 1`, the
    /// bottom edge `z = 0`. Everything darker than one half over white is solid, unless the options
    /// say otherwise. Pictures are traced as by [`Profile::traced`]. The curves of drawings are
    /// flattened within 1e-5 of the height. `R` is width / height with the axis at the left, and
    /// half of that with the axis in the middle.
    ///
    /// # Errors
    /// [`ErrorKind::File`] for a file that is missing, a folder, damaged, or neither picture nor
    /// drawing. [`ErrorKind::Content`] for a picture of more than 16384 or less than 2 pixels on a
    /// side, all light or all dark, or a drawing with parts that have no outline (text, pictures,
    /// patterns, masks, filters). The error names the file in both cases.
    pub fn load(path: impl AsRef<Path>, options: impl Into<ProfileOptions>) -> Result<Self> {
        let (path, options) = (path.as_ref(), options.into());
        let read = || Self::from_bytes(&read_file(path)?, options);
        read().map_err(|e| e.in_file(path))
    }

    /// Reads a profile from the bytes of a file, such as one embedded in the program; otherwise
    /// like [`Profile::load`].
    ///
    /// # Errors
    /// The errors of `load`, without a file name.
    pub fn from_bytes(bytes: &[u8], options: impl Into<ProfileOptions>) -> Result<Self> {
        let options = options.into();
        options.check()?;
        if is_drawing(bytes) {
            drawing_profile(bytes, &options)
        } else {
            image::profile(bytes, &options)
        }
    }

    /// A profile from a closed polygon of `[r, z]` points, object units, `radius` being the `R` of
    /// its box.
    ///
    /// The last point joins the first; both directions of travel are accepted. If the polygon
    /// crosses or covers itself, the solid is everything that it winds round (non-zero rule). The
    /// polygon may extend past its box; drawing cuts it there.
    ///
    /// ```
    /// let cone = revmap::profile::Profile::polygon(&[[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]], 0.5)?;
    /// assert_eq!(cone.radius, 0.5);
    /// # Ok::<(), revmap::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`ErrorKind::Content`], with the key `polygon` or `radius`, for fewer than 3 points, a
    /// coordinate that is not finite or beyond 10,000, a point with `r < 0`, no area, or a radius
    /// that is not positive.
    pub fn polygon(points: &[[f64; 2]], radius: f64) -> Result<Self> {
        polygon::profile(points, radius)
    }

    /// A profile with a known outline. The loops are used unchanged; [`Outline`] lists their
    /// requirements.
    #[must_use]
    pub fn new(outline: Outline, radius: f64) -> Self {
        Self {
            outline,
            radius,
            raster: None,
            warnings: Vec::new(),
        }
    }

    /// A profile from the right half of a picture, `R` = columns / rows.
    ///
    /// The outline is the curve at which coverage passes one half. Pixel noise is removed and
    /// corners are restored. The outline stays within the picture. Everything beyond the picture's
    /// upper, lower and right border is empty.
    ///
    /// # Errors
    /// [`ErrorKind::Content`]: no pixel is more than half covered, or the list of coverages has not
    /// `columns * rows` values.
    pub fn traced(raster: Raster) -> Result<Self> {
        trace::profile(raster, false)
    }
}

/// A file's bytes, or an error that names the file.
fn read_file(path: &Path) -> Result<Vec<u8>> {
    let fault = |message: String| Error::new(ErrorKind::File, message);
    if path.is_dir() {
        return Err(fault("is a folder; give a PNG, JPEG or SVG file".into()));
    }
    std::fs::read(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => {
            fault("does not exist; give a PNG, JPEG or SVG file".into())
        }
        _ => fault(format!(
            "cannot be read ({e}); check the file's permissions"
        )),
    })
}

/// Returns true if the bytes are XML, after blanks and a byte order mark, or gzip.
fn is_drawing(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let first = text.iter().find(|b| !b.is_ascii_whitespace());
    first == Some(&b'<') || bytes.starts_with(&[0x1f, 0x8b])
}

#[cfg(feature = "drawing")]
fn drawing_profile(bytes: &[u8], options: &ProfileOptions) -> Result<Profile> {
    drawing::profile(bytes, options.for_drawing()?)
}

#[cfg(not(feature = "drawing"))]
fn drawing_profile(_: &[u8], _: &ProfileOptions) -> Result<Profile> {
    Err(Error::new(
        ErrorKind::Content,
        "is an SVG drawing, and this build lacks the feature `drawing`; build with it, or give a PNG",
    ))
}
