//! The charts' letters: how wide words are, and their outlines where no program draws them for us.
//!
//! The font travels with the program (and within each page), so that what is measured here is what
//! is seen everywhere.

use ttf_parser::{Face, OutlineBuilder};

/// The font's file: DejaVu Sans reduced to what charts need.
pub const FONT: &[u8] = include_bytes!("../../../../../assets/fonts/DejaVuSans-subset.ttf");

/// The font's name in pages.
pub const FAMILY: &str = "revmap DejaVu Sans";

/// A width that serves where the font cannot be read: that of a wide letter.
const WIDE: f64 = 0.7;

fn face() -> Option<Face<'static>> {
    Face::parse(FONT, 0).ok()
}

fn advance(face: &Face, letter: char) -> f64 {
    face.glyph_index(letter)
        .and_then(|glyph| face.glyph_hor_advance(glyph))
        .map_or(WIDE, |units| {
            f64::from(units) / f64::from(face.units_per_em())
        })
}

/// The width of a word at a size, pixels.
#[must_use]
pub fn width(text: &str, size: f64) -> f64 {
    match face() {
        Some(face) => size * text.chars().map(|c| advance(&face, c)).sum::<f64>(),
        None => size * WIDE * text.chars().count() as f64,
    }
}

/// Cuts a text into lines no wider than `limit`, between words.
#[must_use]
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

/// A part of a letter's outline, the word's start on the base line being the origin, `y` downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stroke {
    /// Begins a contour.
    Move(f64, f64),
    /// A straight line.
    Line(f64, f64),
    /// A quadratic curve: control point, end.
    Curve(f64, f64, f64, f64),
    /// Ends a contour.
    Close,
}

/// The outlines of a word at a size.
#[must_use]
pub fn outline(text: &str, size: f64) -> Vec<Stroke> {
    let Some(face) = face() else {
        return Vec::new();
    };
    let mut pen = Pen {
        strokes: Vec::new(),
        left: 0.0,
        scale: size / f64::from(face.units_per_em()),
    };
    for letter in text.chars() {
        if let Some(glyph) = face.glyph_index(letter) {
            face.outline_glyph(glyph, &mut pen);
        }
        pen.left += size * advance(&face, letter);
    }
    pen.strokes
}

struct Pen {
    strokes: Vec<Stroke>,
    left: f64,
    scale: f64,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> (f64, f64) {
        (
            self.left + f64::from(x) * self.scale,
            -f64::from(y) * self.scale,
        )
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.strokes.push(Stroke::Move(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.strokes.push(Stroke::Line(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (a, b) = self.place(x1, y1);
        let (x, y) = self.place(x, y);
        self.strokes.push(Stroke::Curve(a, b, x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        // TrueType has no cubic curves; the nearest quadratic one would do if it had.
        self.quad_to((x1 + x2) / 2.0, (y1 + y2) / 2.0, x, y);
    }

    fn close(&mut self) {
        self.strokes.push(Stroke::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_wide_as_their_letters() {
        assert!(width("iiii", 10.0) < width("WWWW", 10.0));
        assert!((width("ab", 20.0) - 2.0 * (width("a", 10.0) + width("b", 10.0))).abs() < 1e-9);
        // Every sign that charts use is in the font: none has the width of what is missing.
        let face = face();
        for sign in "aZ09 .,:;()%/<>=×–≤≥≈·°⁻⁰¹²³⁴⁵⁶⁷⁸⁹µ…→".chars()
        {
            assert!(
                face.as_ref().is_some_and(|f| f.glyph_index(sign).is_some()),
                "{sign}"
            );
        }
    }

    #[test]
    fn outlines_stay_within_the_words_box() {
        let strokes = outline("Apx", 100.0);
        assert!(strokes.iter().filter(|s| **s == Stroke::Close).count() >= 5);
        let limit = width("Apx", 100.0);
        for stroke in strokes {
            if let Stroke::Move(x, y) | Stroke::Line(x, y) | Stroke::Curve(_, _, x, y) = stroke {
                assert!(
                    (0.0..=limit).contains(&x) && (-76.0..=24.0).contains(&y),
                    "{x} {y}"
                );
            }
        }
    }

    #[test]
    fn lines_are_wrapped_between_words() {
        let lines = wrap("one two three four five", 10.0, width("three four", 10.0));
        assert_eq!(lines, ["one two", "three four", "five"]);
        assert_eq!(wrap("unbreakable", 10.0, 5.0), ["unbreakable"]);
    }
}
