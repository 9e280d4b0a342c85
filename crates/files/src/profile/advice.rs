//! Advice of the reader itself, followed for [`ProfileRead::Auto`](super::ProfileRead::Auto): pale
//! paint is solid if nothing is dark, and the axis is where the file has one.

use super::ProfileAxis;
use revmap::error::Result;
use revmap::profile::Profile;

/// Advice to set another axis, up to the key's value.
pub(super) const SET_AXIS: &str = "set profile_axis = ";
/// How the refusal of a drawing without dark paint begins.
pub(super) const EMPTY: &str = "the drawing is empty: ";
/// Advice for it.
pub(super) const PAINT_DARK: &str =
    "; paint it dark if it is solid, or set profile_read = \"auto\"";

/// Another way to read a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Way {
    /// Where the axis is.
    pub axis: ProfileAxis,
    /// All paint but white is solid.
    pub pale: bool,
}

impl Way {
    /// The way that a message advises, and the observation that leads to it.
    fn advised(self, message: &str) -> Option<(Self, String)> {
        if let Some((cause, _)) = message.split_once(PAINT_DARK) {
            let way = Self { pale: true, ..self };
            let cause = cause.trim_start_matches(EMPTY);
            return Some((way, format!("{cause}; all paint but white is solid")));
        }
        let (cause, value) = message.split_once(&format!("; {SET_AXIS}"))?;
        if self.axis != ProfileAxis::Center {
            return None;
        }
        let value = value.split([',', ';', ' ']).next()?;
        let axis = value.trim_matches('"').parse().ok()?;
        Some((
            Self { axis, ..self },
            format!("{cause}; read with profile_axis = {value}"),
        ))
    }
}

/// Reads a file in a way, then as the warnings or the refusal advise. A way in which the file is
/// refused is not taken.
pub(super) fn followed(read: &dyn Fn(Way) -> Result<Profile>, way: Way) -> Result<(Profile, Way)> {
    let found = read(way);
    let advised = match &found {
        // A photograph, whose axis and ground are found.
        Ok(profile) if !profile.notes.is_empty() => None,
        Ok(profile) => profile.warnings.iter().find_map(|w| way.advised(w)),
        Err(e) => way.advised(&e.message),
    };
    if let Some((next, note)) = advised
        && let Ok((mut profile, way)) = followed(read, next)
    {
        profile.notes.insert(0, note);
        return Ok((profile, way));
    }
    found.map(|profile| (profile, way))
}
