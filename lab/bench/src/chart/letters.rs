//! The charts' letters: how wide words are. The font travels with the program and with each page.

use ttf_parser::Face;

/// The font's file: DejaVu Sans reduced to what charts need.
pub const FONT: &[u8] = include_bytes!("../../../../assets/fonts/DejaVuSans-subset.ttf");

/// The font's name in pages.
pub const FAMILY: &str = "revmap DejaVu Sans";

/// A width that serves where the font cannot be read: that of a wide letter.
const WIDE: f64 = 0.7;

pub(super) fn face() -> Option<Face<'static>> {
    Face::parse(FONT, 0).ok()
}

fn advance(face: &Face, letter: char) -> f64 {
    let glyph = face.glyph_index(letter);
    let units = glyph.and_then(|glyph| face.glyph_hor_advance(glyph));
    let em = f64::from(face.units_per_em());
    units.map_or(WIDE, |units| f64::from(units) / em)
}

/// The width of a word at a size, pixels.
pub fn width(text: &str, size: f64) -> f64 {
    match face() {
        Some(face) => size * text.chars().map(|c| advance(&face, c)).sum::<f64>(),
        None => size * WIDE * text.chars().count() as f64,
    }
}

/// Cuts a text into lines no wider than `limit`, between words.
pub fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}"), size) <= limit => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_wide_as_their_letters() {
        assert!(width("iiii", 10.0) < width("WWWW", 10.0));
        assert!((width("ab", 20.0) - 2.0 * (width("a", 10.0) + width("b", 10.0))).abs() < 1e-9);
        // Every sign that charts use is in the font: none has the width of what is missing.
        let glyph = |sign| face().and_then(|f| f.glyph_index(sign));
        let signs = "aZ09 .,:;()%/<>=×–≤≥≈·°⁻⁰¹²³⁴⁵⁶⁷⁸⁹µ…→";
        for sign in signs.chars() {
            assert!(glyph(sign).is_some(), "{sign}");
        }
    }

    #[test]
    fn lines_are_wrapped_between_words() {
        let lines = wrap("one two three four five", 10.0, width("three four", 10.0));
        assert_eq!(lines, ["one two", "three four", "five"]);
        assert_eq!(wrap("unbreakable", 10.0, 5.0), ["unbreakable"]);
    }
}
