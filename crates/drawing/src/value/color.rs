//! Colours of CSS, as values of sRGB.

use crate::element::is_in;
use crate::value::Unusable::{Unread, Wrong};
use crate::value::Value;
use ::color::{ColorSpaceTag, Srgb, parse_color};

/// Red, green, blue and alpha from 0 to 1; not premultiplied.
pub(crate) type Color = [f32; 4];

pub(crate) const BLACK: Color = [0.0, 0.0, 0.0, 1.0];

/// Colours of the user's system, other than the page's own.
const SYSTEM: &str = "accentcolor accentcolortext activetext buttonborder buttonface buttontext field fieldtext \
    graytext highlight highlighttext linktext mark marktext selecteditem selecteditemtext visitedtext windowtext \
    window menu";
/// Functions of CSS that give a colour; the second list is not read.
const FUNCTIONS: [&str; 2] = [
    "rgb rgba hsl hsla hwb lab lch oklab oklch color",
    "color-mix light-dark device-cmyk contrast-color var env",
];
/// Spaces of `color()` that are read.
const SPACES: [&str; 3] = ["srgb", "srgb-linear", "display-p3"];
const REMEDY: &str = "write the colour as #rrggbb";

/// Premultiplied red, green, blue and alpha, in the drawing's own (sRGB) values.
pub type Rgba = [f32; 4];

pub(crate) fn premultiplied([r, g, b, alpha]: Color, opacity: f32) -> Rgba {
    let a = alpha * opacity;
    [r * a, g * a, b * a, a]
}

/// Luminance of an sRGB colour in its own values: the weights of Rec. 709, which sRGB shares.
#[must_use]
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    // Grey comes out exactly as it went in.
    g + 0.2126 * (r - g) + 0.0722 * (b - g)
}

/// Reads a colour of CSS, such as `orange`, `#e0a030` or `rgb(224 160 48 / 50%)`, as red, green,
/// blue and alpha from 0 to 1 in sRGB, not premultiplied. `None` for other text.
///
/// ```
/// assert_eq!(revmap_drawing::css_color("lime"), Some([0.0, 1.0, 0.0, 1.0]));
/// assert_eq!(revmap_drawing::css_color("greenish"), None);
/// ```
#[must_use]
pub fn css_color(text: &str) -> Option<[f32; 4]> {
    let text = text.trim();
    let color = color(text).ok();
    color.filter(|_| before_profile(text).is_none())
}

/// The colour of sRGB before one of a profile.
pub(crate) fn before_profile(text: &str) -> Option<&str> {
    let small = text.to_ascii_lowercase();
    let places = ["icc-color(", "device-color("].map(|word| small.find(word));
    let at = places.into_iter().flatten().min().filter(|at| *at > 0)?;
    Some(text[..at].trim())
}

/// Reads a colour. `currentColor` is left to the caller.
pub(crate) fn color(text: &str) -> Value<Color> {
    if let Some(before) = before_profile(text) {
        return color(before);
    }
    let small = text.to_ascii_lowercase();
    match (small.as_str(), small.split_once('(')) {
        (_, Some((name, arguments))) => function(name, arguments)?,
        ("canvas", _) => return Ok([1.0; 4]),
        ("canvastext", _) => return Ok(BLACK),
        (name, _) if is_in(SYSTEM, name) => return Err(Unread(REMEDY)),
        _ => {}
    }
    let mut read = parse_color(&small).map_err(|_| Wrong)?;
    if read.cs == ColorSpaceTag::Hsl {
        read.components[1] = read.components[1].min(100.0);
    }
    let components = read.to_alpha_color::<Srgb>().components;
    Ok(components.map(|v| v.clamp(0.0, 1.0)))
}

/// Checks what `parse_color` is lax about.
fn function(name: &str, arguments: &str) -> Value<()> {
    let Some(arguments) = arguments.strip_suffix(')') else {
        return Err(Wrong);
    };
    let [read, known] = FUNCTIONS.map(|list| is_in(list, name));
    let ends = |c: char| c.is_ascii_whitespace() || c == ',';
    let space = arguments
        .trim_start()
        .split(ends)
        .next()
        .unwrap_or_default();
    let is_unread = arguments.contains('(') || space == "from";
    match (read, known) {
        (true, _) if !is_unread => {}
        (false, false) => return Err(Wrong),
        _ => return Err(Unread(REMEDY)),
    }
    if name == "color" && !SPACES.contains(&space) {
        return Err(Unread(REMEDY));
    }
    // Commas are of the older notation.
    let parts: Vec<bool> = arguments
        .split(',')
        .map(|part| part.trim().ends_with('%'))
        .collect();
    let is_valid = match parts[..] {
        [_] => true,
        _ if arguments.contains("none") => false,
        [a, b, c, ..] if name.starts_with("rgb") => a == b && b == c,
        [_, b, c, ..] => b && c,
        _ => false,
    };
    is_valid.then_some(()).ok_or(Wrong)
}
