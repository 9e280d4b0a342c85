//! How wide the words of charts are.

use crate::names::wrapped;

/// Advances of the letters from space to `~` in DejaVu Sans and Verdana, hundredths of the size.
const ADVANCES: [u8; 95] = [
    32, 40, 46, 84, 64, 95, 78, 27, 39, 39, 50, 84, 32, 36, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 53, 100, 68, 69, 70, 77, 63, 58, 77, 75, 29, 29, 66, 56, 86, 75,
    79, 60, 79, 69, 63, 61, 73, 68, 99, 69, 61, 69, 39, 34, 39, 84, 50, 50, 61, 63, 55, 63, 62, 35,
    63, 63, 28, 28, 58, 28, 97, 63, 61, 63, 63, 41, 52, 39, 63, 59, 82, 59, 59, 52, 64, 34, 64, 84,
];

/// The width of a word at a size, pixels. Other letters count as wide ones. An SVG states the width
/// with each word, so that no font makes words cover each other.
pub fn width(text: &str, size: f64) -> f64 {
    let advance = |letter: char| {
        let place = (letter as usize).checked_sub(0x20);
        let advance = place.and_then(|place| ADVANCES.get(place));
        f64::from(*advance.unwrap_or(&84))
    };
    size / 100.0 * text.chars().map(advance).sum::<f64>()
}

/// Cuts a text into lines no wider than `limit`, between words.
pub fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    wrapped(text.split_whitespace(), limit, |line| width(line, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_wide_as_their_letters() {
        assert!(width("iiii", 10.0) < width("WWWW", 10.0));
        assert!((width("ab", 20.0) - 2.0 * (width("a", 10.0) + width("b", 10.0))).abs() < 1e-9);
        assert_eq!(
            [" ", "~", "×"].map(|word| width(word, 100.0)),
            [32.0, 84.0, 84.0]
        );
    }

    #[test]
    fn lines_are_wrapped_between_words() {
        let lines = wrap("one two three four five", 10.0, width("three four", 10.0));
        assert_eq!(lines, ["one two", "three four", "five"]);
        assert_eq!(wrap("unbreakable", 10.0, 5.0), ["unbreakable"]);
    }
}
