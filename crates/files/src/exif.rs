//! The orientation of a photograph, which cameras store beside the pixels (Exif 2.32, tag 274).

use revmap::error::Result;
use revmap::host_memory;

/// A way to turn stored pixels into the upright picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Orientation {
    /// Columns and rows change places, before the mirrors.
    swapped: bool,
    /// Left and right change places.
    mirrored: bool,
    /// Top and bottom change places.
    flipped: bool,
}

impl Orientation {
    /// The orientation in EXIF data, a TIFF file of one directory or more. Data that cannot be read
    /// turns nothing.
    pub fn of_exif(exif: &[u8]) -> Self {
        Self::of_tag(tag(exif).unwrap_or(1))
    }

    /// The orientation of the tag's value, 1 to 8.
    fn of_tag(value: u16) -> Self {
        let [swapped, mirrored, flipped] = match value {
            2 => [false, true, false],
            3 => [false, true, true],
            4 => [false, false, true],
            5 => [true, false, false],
            6 => [true, true, false],
            7 => [true, true, true],
            8 => [true, false, true],
            _ => [false; 3],
        };
        Self {
            swapped,
            mirrored,
            flipped,
        }
    }

    /// Width and height of the upright picture.
    pub fn turned_size(self, [width, height]: [u32; 2]) -> [u32; 2] {
        match self.swapped {
            true => [height, width],
            false => [width, height],
        }
    }

    /// The upright picture's samples, `channels` a pixel, from the stored ones.
    pub fn turned<T: Copy>(self, size: [u32; 2], channels: usize, stored: &[T]) -> Result<Vec<T>> {
        let [width, height] = self.turned_size(size).map(|n| n as usize);
        let from = |k: usize, count: usize, reversed: bool| match reversed {
            true => count - 1 - k,
            false => k,
        };
        let mut turned = host_memory::reserved(stored.len(), "the pixels of an upright picture")?;
        for y in 0..height {
            for x in 0..width {
                let (x, y) = (from(x, width, self.mirrored), from(y, height, self.flipped));
                let (column, row) = if self.swapped { (y, x) } else { (x, y) };
                let pixel = row * size[0] as usize + column;
                turned.extend(stored.iter().skip(pixel * channels).take(channels));
            }
        }
        Ok(turned)
    }
}

/// The value of the tag `Orientation` in the first directory.
fn tag(exif: &[u8]) -> Option<u16> {
    const ORIENTATION: u16 = 274;
    let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
    let little = match exif.get(..4)? {
        b"II*\0" => true,
        b"MM\0*" => false,
        _ => return None,
    };
    let bytes = |at: usize| exif.get(at..)?.first_chunk::<2>();
    let short = |at: usize| match little {
        true => bytes(at).map(|b| u16::from_le_bytes(*b)),
        false => bytes(at).map(|b| u16::from_be_bytes(*b)),
    };
    let offset = exif.get(4..)?.first_chunk::<4>()?;
    let directory = match little {
        true => u32::from_le_bytes(*offset),
        false => u32::from_be_bytes(*offset),
    } as usize;
    // An entry has 12 bytes: tag, type, count, and the value if it fits into 4 bytes.
    let entries = 0..usize::from(short(directory)?);
    let mut places = entries.map(|k| directory.saturating_add(2 + 12 * k));
    let found = places.find(|&at| short(at) == Some(ORIENTATION))?;
    short(found + 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// EXIF data with one other tag before the orientation.
    fn exif(little: bool, value: u16) -> Vec<u8> {
        let short = |v: u16| {
            if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            }
        };
        let long = |v: u32| {
            if little {
                v.to_le_bytes()
            } else {
                v.to_be_bytes()
            }
        };
        let mut all = if little { b"II*\0" } else { b"MM\0*" }.to_vec();
        all.extend(long(8));
        all.extend(short(2));
        for (tag, value) in [(256, 7), (274, value)] {
            all.extend([short(tag), short(3)].concat());
            all.extend(long(1));
            all.extend([short(value), short(0)].concat());
        }
        all
    }

    #[test]
    fn the_tag_is_read_in_both_byte_orders() {
        for little in [false, true] {
            for value in 1..=8 {
                let bytes = exif(little, value);
                assert_eq!(tag(&bytes), Some(value));
                assert_eq!(tag(&[b"Exif\0\0", bytes.as_slice()].concat()), Some(value));
                for cut in 0..bytes.len() - 4 {
                    assert_eq!(tag(&bytes[..cut]), None, "{cut}");
                }
            }
            assert_eq!(
                Orientation::of_exif(&exif(little, 9)),
                Orientation::default()
            );
        }
        assert_eq!(tag(b"II*\0\xff\xff\xff\xff"), None);
    }
}
