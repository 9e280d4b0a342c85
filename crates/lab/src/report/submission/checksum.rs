//! Checksums against damage, and of pictures.

use crate::method::MethodSettings;
use crate::report::measure::RenderedCase;
use revmap_files::Picture;

/// FNV-1a of 64 bits (Fowler, Noll, Vo).
pub(super) fn fnv1a_64(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Checksums of the pictures of a run: 64 bits over the colours of all pixels, four bytes each, as a
/// PNG stores them.
#[derive(Default)]
pub struct Pictures(Vec<(usize, MethodSettings, u64)>);

impl Pictures {
    /// Takes a picture.
    pub fn add(&mut self, seen: &RenderedCase) {
        let rgba = Picture::of(seen.frame).rgba.concat();
        self.0
            .push((seen.case.view, seen.case.settings, fnv1a_64(&rgba)));
    }

    /// The checksum of a view drawn in one way, in hexadecimal; empty if it was not drawn.
    pub(super) fn of(&self, view: usize, settings: &MethodSettings) -> String {
        let mut all = self.0.iter();
        let found = all.find(|(v, s, _)| (*v, s) == (view, settings));
        found.map_or(String::new(), |(_, _, sum)| format!("{sum:016x}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of <http://www.isthe.com/chongo/tech/comp/fnv/>.
    #[test]
    fn the_published_vectors() {
        for (text, sum) in [
            ("", 0xcbf2_9ce4_8422_2325),
            ("a", 0xaf63_dc4c_8601_ec8c),
            ("foobar", 0x8594_4171_f739_67e8),
        ] {
            assert_eq!(fnv1a_64(text.as_bytes()), sum, "{text}");
        }
    }
}
