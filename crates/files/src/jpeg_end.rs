//! Finds JPEG files that were cut off: decoders draw the missing part grey without an error.

use revmap::error::Result;
use revmap::host_memory;

/// Second bytes of markers, each after a byte 0xff.
const END_OF_IMAGE: u8 = 0xd9;
const START_OF_SCAN: u8 = 0xda;

/// The file with more data before the marker that ends the picture; `None` if there is no such
/// marker.
///
/// A decoder that has all data makes no use of more, so that its picture stays the same. If a
/// program has put the marker behind a file that was cut off, the picture changes.
pub(crate) fn lengthened(bytes: &[u8]) -> Result<Option<Vec<u8>>> {
    const MORE: [u8; 64] = [0x5a; 64];
    let Some(end) = end(bytes) else {
        return Ok(None);
    };
    let (before, end) = bytes.split_at(end);
    let mut longer = host_memory::reserved(bytes.len() + MORE.len(), "the bytes of a JPEG")?;
    for part in [before, &MORE, end] {
        longer.extend_from_slice(part);
    }
    Ok(Some(longer))
}

/// The position of the marker that ends the picture.
fn end(bytes: &[u8]) -> Option<usize> {
    let mut at = 2; // after the marker that begins the picture
    loop {
        // Bytes between segments are passed over, as decoders do.
        at += bytes.get(at..)?.iter().position(|&b| b == 0xff)?;
        let marker = *bytes.get(at + 1)?;
        match marker {
            END_OF_IMAGE => return Some(at),
            // A fill byte, a byte of a scan, and markers without a length.
            0xff => at += 1,
            0 | 1 | 0xd0..=0xd8 => at += 2,
            _ => {
                let length = bytes.get(at + 2..)?.first_chunk::<2>()?;
                at += 2 + usize::from(u16::from_be_bytes(*length));
                if marker == START_OF_SCAN {
                    at = scan_end(bytes, at)?;
                }
            }
        }
    }
}

/// The position of the first marker at or after `at` that ends a scan.
fn scan_end(bytes: &[u8], at: usize) -> Option<usize> {
    let pairs = bytes.get(at..)?.windows(2);
    let ends = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7 | 0xff);
    pairs
        .enumerate()
        .find(|(_, pair)| ends(pair))
        .map(|(k, _)| at + k)
}
