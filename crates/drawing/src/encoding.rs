//! The bytes of a drawing as text: gzip, UTF-8, UTF-16 and the encodings of one byte per letter.

use crate::notes::{Fault, Result};
use flate2::read::GzDecoder;
use std::borrow::Cow;
use std::io::Read;

/// Most bytes that a compressed drawing may unpack to.
const MOST_UNPACKED: u64 = 1 << 28;
/// The first bytes of a gzip file.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Returns true if the bytes are XML in any encoding, after blanks and a byte order mark, or gzip.
#[must_use]
pub fn is_markup(bytes: &[u8]) -> bool {
    let first = match wide(bytes) {
        Some((read, mark)) => {
            let mut units = bytes[mark..].as_chunks().0.iter().map(|unit| read(*unit));
            units.find(|unit| !matches!(unit, 9 | 10 | 12 | 13 | 32))
        }
        None => {
            let mut letters = unmarked(bytes).iter();
            letters
                .find(|b| !b.is_ascii_whitespace())
                .map(|b| u16::from(*b))
        }
    };
    bytes.starts_with(&GZIP) || first == Some(u16::from(b'<'))
}

/// The bytes of a drawing, unpacked if they are gzip.
pub(crate) fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>> {
    if !bytes.starts_with(&GZIP) {
        return Ok(Cow::Borrowed(bytes));
    }
    let mut unpacked = Vec::new();
    let mut reader = GzDecoder::new(bytes).take(MOST_UNPACKED + 1);
    let read = reader.read_to_end(&mut unpacked);
    read.map_err(|e| Fault::damaged(&e))?;
    if unpacked.len() as u64 > MOST_UNPACKED {
        let message = "the drawing unpacks to more than 256 MiB; save it smaller";
        return Err(Fault::new(message));
    }
    Ok(Cow::Owned(unpacked))
}

/// The text of bytes in UTF-8, or in UTF-16 with a byte order mark or as XML; without the mark. `None`
/// for other bytes.
#[must_use]
pub fn decoded(bytes: &[u8]) -> Option<Cow<'_, str>> {
    let Some((read, mark)) = wide(bytes) else {
        return std::str::from_utf8(unmarked(bytes)).ok().map(Cow::Borrowed);
    };
    let (units, rest) = bytes[mark..].as_chunks();
    let letters = char::decode_utf16(units.iter().map(|unit| read(*unit)));
    let text: std::result::Result<String, _> = letters.collect();
    text.ok().filter(|_| rest.is_empty()).map(Cow::Owned)
}

fn unmarked(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The text of a drawing.
pub(crate) fn text(bytes: &[u8]) -> Result<Cow<'_, str>> {
    if let Some(text) = decoded(bytes) {
        return Ok(text);
    }
    let bytes = unmarked(bytes);
    match declared(bytes).as_deref() {
        _ if wide(bytes).is_some() => Err(not_utf8("is damaged UTF-16")),
        // These encodings differ from Unicode in 0x80 to 0x9f and eight letters, which occur only
        // in names and comments.
        Some(
            "iso-8859-1" | "iso8859-1" | "latin1" | "latin-1" | "us-ascii" | "windows-1252"
            | "cp1252" | "iso-8859-15",
        ) => Ok(bytes.iter().map(|b| char::from(*b)).collect()),
        Some(other) if !other.starts_with("utf-8") => {
            Err(not_utf8(&format!("is written in {other}")))
        }
        _ => {
            let wrong = std::str::from_utf8(bytes).map_or_else(|e| e.valid_up_to(), str::len);
            Err(not_utf8(&format!("is not UTF-8 (byte {wrong})")))
        }
    }
}

/// Takes a unit of UTF-16 from two bytes.
type ReadUnit = fn([u8; 2]) -> u16;

/// How a unit of UTF-16 is read, and the bytes of the mark.
fn wide(bytes: &[u8]) -> Option<(ReadUnit, usize)> {
    match bytes {
        [0xff, 0xfe, ..] => Some((u16::from_le_bytes, 2)),
        [0xfe, 0xff, ..] => Some((u16::from_be_bytes, 2)),
        [b'<', 0, _, 0, ..] => Some((u16::from_le_bytes, 0)),
        [0, b'<', 0, _, ..] => Some((u16::from_be_bytes, 0)),
        _ => None,
    }
}

/// The encoding that the XML declaration names, in small letters.
fn declared(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(256)]).to_ascii_lowercase();
    let declaration = head.split("?>").next()?;
    let value = declaration.split("encoding").nth(1)?;
    let mut quoted = value.split(['"', '\'']);
    quoted.nth(1).map(str::to_owned)
}

fn not_utf8(what: &str) -> Fault {
    Fault::new(format!("the drawing {what}; save it as UTF-8"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn encodings_are_read_or_named() {
        let plain = "<svg>\u{e9}</svg>";
        let wide = |order: fn(u16) -> [u8; 2], mark: &[u8]| -> Vec<u8> {
            let units = plain.encode_utf16().flat_map(order);
            mark.iter().copied().chain(units).collect()
        };
        for bytes in [
            plain.as_bytes().to_vec(),
            [b"\xef\xbb\xbf", plain.as_bytes()].concat(),
            wide(u16::to_le_bytes, b"\xff\xfe"),
            wide(u16::to_be_bytes, b"\xfe\xff"),
            wide(u16::to_le_bytes, b""),
            wide(u16::to_be_bytes, b""),
        ] {
            assert!(is_markup(&bytes));
            assert_eq!(text(&bytes).unwrap(), plain);
        }
        let latin = b"<?xml version='1.0' encoding='ISO-8859-1'?><svg>\xe9</svg>";
        assert!(text(latin).unwrap().ends_with(plain));
        let message = |bytes: &[u8]| text(bytes).unwrap_err().to_string();
        assert!(message(b"<?xml encoding='Shift_JIS'?><svg>\x83</svg>").contains("shift_jis"));
        assert!(message(b"<svg>\xe9</svg>").contains("byte 5"));
        assert!(message(&[0xff, 0xfe, b'<', 0, 0, 0xd8]).contains("UTF-16"));
        assert!(!is_markup(b"\x89PNG") && !is_markup(b"BM not a picture"));
    }
}
