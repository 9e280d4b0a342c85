//! Text of files in other encodings than UTF-8.

use revmap::error::Result;
use revmap::host_memory;

/// What needs memory, in messages.
pub(crate) const TEXT: &str = "the text of a file";

/// Takes a unit of UTF-16 from two bytes.
pub(crate) type ReadUnit = fn([u8; 2]) -> u16;

/// The text of UTF-16, `None` if it is damaged.
pub(crate) fn of_utf16(units: &[[u8; 2]], read: ReadUnit) -> Result<Option<String>> {
    let letters = char::decode_utf16(units.iter().map(|unit| read(*unit)));
    // A unit is at most three bytes of UTF-8.
    text(letters.map(|letter| letter.ok()), 3 * units.len())
}

/// The text of the first 256 letters of Unicode, one byte each.
pub(crate) fn of_latin1(bytes: &[u8]) -> Result<Option<String>> {
    text(bytes.iter().map(|b| Some(char::from(*b))), 2 * bytes.len())
}

/// The text of all letters, in UTF-8 of at most `most` bytes; `None` if one is damaged.
fn text(letters: impl Iterator<Item = Option<char>>, most: usize) -> Result<Option<String>> {
    let mut text = host_memory::reserved(most, TEXT)?;
    for letter in letters {
        let Some(letter) = letter else {
            return Ok(None);
        };
        text.extend_from_slice(letter.encode_utf8(&mut [0; 4]).as_bytes());
    }
    Ok(String::from_utf8(text).ok())
}
