//! Colours of CSS, as values of sRGB.

use super::value::{Value, is_in};
use ::color::{ColorSpaceTag, Srgb, parse_color};
use revmap::frame::linear_from_srgb;

/// Red, green, blue and alpha from 0 to 1; not premultiplied.
pub(super) type Color = [f32; 4];

pub(super) const BLACK: Color = [0.0, 0.0, 0.0, 1.0];

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

/// Reads a colour of CSS, such as `orange`, `#e0a030` or `rgb(224 160 48 / 50%)`, as linear red,
/// green and blue, not premultiplied, and alpha. `None` for other text.
///
/// ```
/// assert_eq!(revmap_files::css_color("lime"), Some([0.0, 1.0, 0.0, 1.0]));
/// assert_eq!(revmap_files::css_color("greenish"), None);
/// ```
#[must_use]
pub fn css_color(text: &str) -> Option<[f32; 4]> {
    let Value::Is([r, g, b, alpha]) = color(text.trim()) else {
        return None;
    };
    let [r, g, b] = [r, g, b].map(|v| linear_from_srgb(f64::from(v.clamp(0.0, 1.0))) as f32);
    Some([r, g, b, alpha])
}

/// Reads a colour. `currentColor` is left to the caller.
pub(super) fn color(text: &str) -> Value<Color> {
    let small = text.to_ascii_lowercase();
    let profile = ["icc-color(", "device-color("].iter();
    if let Some(at) = profile
        .filter_map(|word| small.find(word))
        .min()
        .filter(|at| *at > 0)
    {
        return match color(text[..at].trim()) {
            Value::Is(color) => Value::Near(color, "its sRGB colour counts, not the one after it"),
            other => other,
        };
    }
    match (small.as_str(), small.split_once('(')) {
        (_, Some((name, arguments))) => match function(name, arguments) {
            Value::Is(()) => {}
            Value::Unread(remedy) => return Value::Unread(remedy),
            _ => return Value::Wrong,
        },
        ("canvas", _) => return Value::Is([1.0; 4]),
        ("canvastext", _) => return Value::Is(BLACK),
        (name, _) if is_in(SYSTEM, name) => return Value::Unread(REMEDY),
        _ => {}
    }
    let Ok(mut read) = parse_color(&small) else {
        return Value::Wrong;
    };
    if read.cs == ColorSpaceTag::Hsl {
        read.components[1] = read.components[1].min(100.0);
    }
    let components = read.to_alpha_color::<Srgb>().components;
    Value::Is(components.map(|v| v.clamp(0.0, 1.0)))
}

/// Checks what `parse_color` is lax about.
fn function(name: &str, arguments: &str) -> Value<()> {
    let Some(arguments) = arguments.strip_suffix(')') else {
        return Value::Wrong;
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
        (false, false) => return Value::Wrong,
        _ => return Value::Unread(REMEDY),
    }
    if name == "color" && !SPACES.contains(&space) {
        return Value::Unread(REMEDY);
    }
    // Commas are of the older notation.
    let parts: Vec<bool> = arguments
        .split(',')
        .map(|part| part.trim().ends_with('%'))
        .collect();
    Value::from_option(match parts[..] {
        [_] => Some(()),
        _ if arguments.contains("none") => None,
        [a, b, c, ..] if name.starts_with("rgb") => (a == b && b == c).then_some(()),
        [_, b, c, ..] => (b && c).then_some(()),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    // rebeccapurple, #663399, as the examples of CSS Color 4 give it.
    const ONE: &str = "rebeccapurple|RebeccaPurple|#639|#663399|#663399ff|rgb(102, 51, 153)|rgb(40% 20% 60%)|\
        rgba(102 51 153 / 100%)|hsl(270, 50%, 40%)|hsl(0.75turn 50% 40%)|hwb(270 20% 40%)|\
        lab(32.39% 38.43 -47.69)|lch(32.39% 61.25 308.87)|oklab(44.03% 0.088 -0.134)|\
        oklch(44.03% 0.1603 303.37)|color(srgb 0.4 0.2 0.6)|color(srgb-linear 0.1329 0.0331 0.3185)|\
        color(display-p3 0.3738 0.2103 0.5785)";
    const WRONG: &str = "whte|#12345|#xyz|rgb(1 2)|rgb(1, 2 3)|rgb(1 2 3 1)|rgb(1, 2%, 3)|rgb(1,,2,3)|\
        rgb(1 2 3 /)|hsl(1, 2, 3)|lab(1, 2, 3)|color(srgb, 1, 1, 1)|rgb(1 2 3|undefined|fill(1)|";
    const UNREAD: &str = "color-mix(in srgb, red, blue)|light-dark(red, blue)|ButtonFace|rgb(from red r g b)|\
        color(rec2020 1 1 1)|rgb(calc(1 + 1) 0 0)";

    #[test]
    fn colours_in_every_notation() {
        for text in ONE.split('|') {
            let got = color(text).ok().unwrap_or_default();
            for (got, wanted) in got.into_iter().zip([0.4, 0.2, 0.6, 1.0]) {
                assert!((got - wanted).abs() < 0.01, "{text}: {got} for {wanted}");
            }
        }
        assert_eq!(color("transparent"), Value::Is([0.0; 4]));
        assert_eq!(color("rgb(0 0 0 / 50%)"), Value::Is([0.0, 0.0, 0.0, 0.5]));
        let white = color("oklch(1 none none)").ok().unwrap();
        assert_eq!(white.map(f32::round), [1.0; 4]);
        for wrong in WRONG.split('|') {
            assert_eq!(color(wrong), Value::Wrong, "{wrong}");
        }
        for unread in UNREAD.split('|') {
            assert!(matches!(color(unread), Value::Unread(_)), "{unread}");
        }
        let near = color("#fff icc-color(a, 1, 1, 1)");
        assert!(matches!(near, Value::Near([1.0, 1.0, 1.0, 1.0], _)));
    }
}
