//! Colours of CSS, as values of sRGB.

use super::value::{Value, radians, split_number};
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
    if space.is_some_and(|s| !matches!(s, "srgb" | "srgb-linear" | "display-p3")) {
        return Value::Unread(REMEDY);
    }
    let rgb = match name {
        "rgb" | "rgba" => {
            all([a.of(255.0), b.of(255.0), c.of(255.0)]).map(|v| v.map(|v| v / 255.0))
        }
        "hsl" | "hsla" => all([a.degrees(), b.of(100.0), c.of(100.0)]).map(hsl),
        "hwb" => all([a.degrees(), b.of(100.0), c.of(100.0)]).map(hwb),
        "lab" => all([a.of(100.0), b.of(125.0), c.of(125.0)]).map(lab),
        "lch" => all([a.of(100.0), b.of(150.0), c.degrees()]).map(|v| lab(from_polar(v))),
        "oklab" => all([a.of(1.0), b.of(0.4), c.of(0.4)]).map(oklab),
        "oklch" => all([a.of(1.0), b.of(0.4), c.degrees()]).map(|v| oklab(from_polar(v))),
        _ => all([a.of(1.0), b.of(1.0), c.of(1.0)]).map(|v| match space {
            Some("srgb-linear") => v.map(encoded),
            Some("display-p3") => from_display_p3(v),
            _ => v,
        }),
    };
    Value::from_option(
        rgb.zip(alpha)
            .map(|([r, g, b], alpha)| [r, g, b, alpha].map(|v| v.clamp(0.0, 1.0) as f32)),
    )
}

fn all(parts: [Option<f64>; 3]) -> Option<[f64; 3]> {
    Some([parts[0]?, parts[1]?, parts[2]?])
}

fn from_polar([lightness, chroma, degrees]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [lightness, chroma * cos, chroma * sin]
}

/// CSS Color 4, section 7.1.
fn hsl([hue, saturation, lightness]: [f64; 3]) -> [f64; 3] {
    let (s, l) = ((saturation / 100.0).clamp(0.0, 1.0), lightness / 100.0);
    let channel = |n: f64| {
        let k = (n + hue / 30.0).rem_euclid(12.0);
        l - s * l.min(1.0 - l) * (k - 3.0).min(9.0 - k).clamp(-1.0, 1.0)
    };
    [channel(0.0), channel(8.0), channel(4.0)]
}

/// CSS Color 4, section 8.1.
fn hwb([hue, white, black]: [f64; 3]) -> [f64; 3] {
    let (white, black) = (white / 100.0, black / 100.0);
    if white + black >= 1.0 {
        return [white / (white + black); 3];
    }
    hsl([hue, 100.0, 50.0]).map(|v| v * (1.0 - white - black) + white)
}

/// CIE L*a*b* under D50, adapted to D65 (CSS Color 4, section 18).
fn lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let f1 = (l + 16.0) / 116.0;
    let back = |f: f64| match f.powi(3) {
        cube if cube > 216.0 / 24389.0 => cube,
        _ => (116.0 * f - 16.0) / (24389.0 / 27.0),
    };
    let xyz = [
        back(f1 + a / 500.0) * 0.964_295_676,
        back(f1),
        back(f1 - b / 200.0) * 0.825_104_603,
    ];
    product(
        [
            [3.134_136, -1.617_386, -0.490_662],
            [-0.978_796, 1.916_254, 0.033_443],
            [0.071_955, -0.228_977, 1.405_386],
        ],
        xyz,
    )
    .map(encoded)
}

/// Ottosson 2020.
fn oklab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let cones = product(
        [
            [1.0, 0.396_337_777_4, 0.215_803_757_3],
            [1.0, -0.105_561_345_8, -0.063_854_172_8],
            [1.0, -0.089_484_177_5, -1.291_485_548],
        ],
        [l, a, b],
    );
    product(
        [
            [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
            [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
            [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701],
        ],
        cones.map(|v| v.powi(3)),
    )
    .map(encoded)
}

fn from_display_p3(p3: [f64; 3]) -> [f64; 3] {
    product(
        [
            [1.224_940_18, -0.224_940_18, 0.0],
            [-0.042_056_955, 1.042_056_955, 0.0],
            [-0.019_637_555, -0.078_636_046, 1.098_273_6],
        ],
        p3.map(linear),
    )
    .map(encoded)
}

fn product(rows: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    rows.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// The transfer function of sRGB.
fn encoded(v: f64) -> f64 {
    match v.abs() {
        small if small <= 0.003_130_8 => 12.92 * v,
        large => (1.055 * large.powf(1.0 / 2.4) - 0.055).copysign(v),
    }
}

fn linear(v: f64) -> f64 {
    match v.abs() {
        small if small <= 0.040_45 => v / 12.92,
        large => ((large + 0.055) / 1.055).powf(2.4).copysign(v),
    }
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
