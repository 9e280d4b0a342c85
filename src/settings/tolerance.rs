use crate::error::{Error, ErrorKind, Result};
use std::fmt;
use std::str::FromStr;

/// Allowed error of silhouettes and depths, in pixels of the drawn view.
///
/// Surfaces are fitted at several **levels**, each with a proven bound on its distance from the
/// exact surface. An object uses the coarsest level whose bound, seen at the object's nearest
/// point, is at most a sixteenth of the tolerance. A silhouette therefore moves by at most a
/// sixteenth of the tolerance. The depth error along the ray is larger at grazing rays. The factor
/// of 16 keeps 99.9 % of the pixels within the tolerance (measured).
///
/// Searches on patches ([`Solver::Exact`](super::Solver::Exact),
/// [`Solver::Quadric`](super::Solver::Quadric)) use the tolerance; all others ignore it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Tolerance(f64);

impl Tolerance {
    /// No error beyond that of the finest level.
    pub const EXACT: Self = Self(0.0);
    /// A quarter of a pixel.
    pub const DEFAULT: Self = Self(0.25);
    /// The largest, pixels.
    pub const MOST: f64 = 64.0;

    /// A tolerance in pixels, 0 to [`Tolerance::MOST`]; 0 is [`Tolerance::EXACT`].
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for any other number.
    pub fn new(pixels: f64) -> Result<Self> {
        if (0.0..=Self::MOST).contains(&pixels) {
            // Adding 0.0 turns -0.0 into 0.0.
            return Ok(Self(pixels + 0.0));
        }
        let message = format!(
            "{pixels} is no tolerance in pixels; give 0 to {}, 0 for exact",
            Self::MOST
        );
        Err(Error::new(ErrorKind::Usage, message).at_key("tolerance"))
    }

    /// The tolerance in pixels.
    #[must_use]
    pub const fn pixels(self) -> f64 {
        self.0
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The inverse of [`Display`](fmt::Display).
///
/// ```
/// use revmap::settings::Tolerance;
/// assert_eq!("0.25".parse(), Ok(Tolerance::DEFAULT));
/// assert!("-1".parse::<Tolerance>().is_err() && "nan".parse::<Tolerance>().is_err());
/// ```
impl FromStr for Tolerance {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::new(text.parse().unwrap_or(f64::NAN))
    }
}
