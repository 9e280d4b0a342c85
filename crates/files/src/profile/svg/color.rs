//! Colours of CSS, as values of sRGB.

use super::value::{Value, radians, split_number};
use color::ColorSpaceTag as Tag;
use revmap::frame::linear_from_srgb;
use std::str::FromStr;

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
const REMEDY: &str = "write the colour as #rrggbb";

/// Reads a colour of CSS, such as `orange`, `#e0a030` or `rgb(224 160 48 / 50%)`, as linear red, green
/// and blue, not premultiplied, and alpha. `None` for other text.
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
    if let Some((head, _)) = split_at_word(text, &["icc-color(", "device-color("]) {
        return match color(head) {
            Value::Is(color) => Value::Near(color, "its sRGB colour counts, not the one after it"),
            other => other,
        };
    }
    if let Some((name, arguments)) = text.split_once('(') {
        let Some(arguments) = arguments.strip_suffix(')') else {
            return Value::Wrong;
        };
        return function(&name.to_ascii_lowercase(), arguments);
    }
    match text.to_ascii_lowercase().as_str() {
        "transparent" => return Value::Is([0.0; 4]),
        "rebeccapurple" => return Value::Is([0.4, 0.2, 0.6, 1.0]),
        "canvas" => return Value::Is([1.0; 4]),
        "canvastext" => return Value::Is(BLACK),
        name if SYSTEM.split(' ').any(|n| n == name) => return Value::Unread(REMEDY),
        _ => {}
    }
    // `svgtypes` reads trailing letters of a bad hexadecimal number as an end.
    let named = svgtypes::Color::from_str(text).ok();
    Value::from_option(
        named.map(|c| [c.red, c.green, c.blue, c.alpha].map(|v| f32::from(v) / 255.0)),
    )
}

fn split_at_word<'a>(text: &'a str, words: &[&str]) -> Option<(&'a str, &'a str)> {
    let small = text.to_ascii_lowercase();
    let at = words.iter().filter_map(|w| small.find(w)).min()?;
    (at > 0).then(|| (text[..at].trim(), &text[at..]))
}

/// One argument of a function: its number and its unit.
#[derive(Clone, Copy)]
struct Part<'a>(f64, &'a str);

impl Part<'_> {
    /// The value with percentages of `whole`.
    fn of(self, whole: f64) -> Option<f64> {
        match self.1 {
            "" => Some(self.0),
            "%" => Some(self.0 / 100.0 * whole),
            _ => None,
        }
    }

    fn degrees(self) -> Option<f64> {
        match self.1 {
            "" => Some(self.0),
            "deg" => Some(self.0),
            unit => radians(self.0, unit).map(f64::to_degrees),
        }
    }
}

fn function(name: &str, arguments: &str) -> Value<Color> {
    let [read, known] = FUNCTIONS.map(|list| list.split(' ').any(|known| known == name));
    let is_unread = arguments.contains('(') || arguments.trim_start().starts_with("from ");
    match (read, known) {
        (true, _) if !is_unread => {}
        (false, false) => return Value::Wrong,
        _ => return Value::Unread(REMEDY),
    }
    // Commas are of the older notation, which has no slash.
    let older = arguments.contains(',');
    let (body, alpha) = match arguments.split_once('/').filter(|_| !older) {
        Some((body, alpha)) => (body, Some(alpha.trim())),
        None => (arguments, None),
    };
    let mut words: Vec<&str> = match older {
        true => body.split(',').map(str::trim).collect(),
        false => body.split_ascii_whitespace().collect(),
    };
    let space = (name == "color" && !words.is_empty()).then(|| words.remove(0));
    let has_commas = matches!(name, "rgb" | "rgba" | "hsl" | "hsla");
    if (older && !has_commas) || (!older && words.len() != 3) {
        return Value::Wrong;
    }
    words.extend(alpha);
    let parts: Option<Vec<Part>> = words
        .iter()
        .map(|w| match *w {
            "none" if !older => Some(Part(0.0, "")),
            w => split_number(w).map(|(v, unit)| Part(v, unit)),
        })
        .collect();
    let Some(&[a, b, c, ref alpha @ ..]) = parts.as_deref() else {
        return Value::Wrong;
    };
    let even = match name.starts_with("rgb") {
        true => a.1 == b.1 && b.1 == c.1,
        false => b.1 == "%" && c.1 == "%",
    };
    if older && !even {
        return Value::Wrong;
    }
    let alpha = match alpha {
        [] => Some(1.0),
        [alpha] => alpha.of(1.0),
        _ => None,
    };
    let tag = match (name, space) {
        (_, Some("srgb")) | ("rgb" | "rgba", _) => Tag::Srgb,
        (_, Some("srgb-linear")) => Tag::LinearSrgb,
        (_, Some("display-p3")) => Tag::DisplayP3,
        (_, Some(_)) => return Value::Unread(REMEDY),
        ("hsl" | "hsla", _) => Tag::Hsl,
        ("hwb", _) => Tag::Hwb,
        ("lab", _) => Tag::Lab,
        ("lch", _) => Tag::Lch,
        ("oklab", _) => Tag::Oklab,
        ("oklch", _) => Tag::Oklch,
        _ => return Value::Wrong,
    };
    // What a hundred percent are.
    let read = match tag {
        Tag::Hsl | Tag::Hwb => [a.degrees(), b.of(100.0), c.of(100.0)],
        Tag::Lab => [a.of(100.0), b.of(125.0), c.of(125.0)],
        Tag::Lch => [a.of(100.0), b.of(150.0), c.degrees()],
        Tag::Oklab => [a.of(1.0), b.of(0.4), c.of(0.4)],
        Tag::Oklch => [a.of(1.0), b.of(0.4), c.degrees()],
        _ if space.is_none() => [a, b, c].map(|part| Some(part.of(255.0)? / 255.0)),
        _ => [a, b, c].map(|part| part.of(1.0)),
    };
    let ([Some(a), Some(b), Some(c)], Some(alpha)) = (read, alpha) else {
        return Value::Wrong;
    };
    let b = if tag == Tag::Hsl {
        b.clamp(0.0, 100.0)
    } else {
        b
    };
    let [r, g, b] = tag.convert(Tag::Srgb, [a, b, c].map(|v| v as f32));
    Value::Is([r, g, b, alpha as f32].map(|v| v.clamp(0.0, 1.0)))
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
