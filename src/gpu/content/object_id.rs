//! Identities of objects: the renderer, its entry, and the object in that entry.

use std::sync::atomic::{AtomicU32, Ordering};

/// An object of one renderer; other renderers reject the id. The id names the same object whatever
/// is set, and no other object after the removal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId {
    pub(in crate::gpu) renderer: u32,
    pub(in crate::gpu) generation: u32,
    pub(in crate::gpu) number: u32,
}

// 64 bits hold 16 million objects at once, a million objects in turn per entry, and a million
// renderers of the process. Identities of renderers repeat after that.
const NUMBER_BITS: u32 = 24;
const GENERATION_BITS: u32 = 20;
const RENDERER_BITS: u32 = 20;

/// Upper limit on entries of a renderer.
pub(in crate::gpu) const MOST_NUMBERS: usize = 1 << NUMBER_BITS;
/// Upper limit on objects that use one entry in turn. The entry then stays empty.
pub(in crate::gpu) const MOST_GENERATIONS: u32 = 1 << GENERATION_BITS;

impl ObjectId {
    /// The id as one number, never 0, for interfaces that carry plain numbers.
    #[must_use]
    pub const fn to_bits(self) -> u64 {
        let renderer = (self.renderer as u64) << (NUMBER_BITS + GENERATION_BITS);
        renderer | (self.generation as u64) << NUMBER_BITS | self.number as u64
    }

    /// The id that [`ObjectId::to_bits`] encoded. Any other number is the id of no object.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // each part is masked
    pub const fn from_bits(bits: u64) -> Self {
        Self {
            renderer: (bits >> (NUMBER_BITS + GENERATION_BITS)) as u32,
            generation: (bits >> NUMBER_BITS) as u32 & (MOST_GENERATIONS - 1),
            number: bits as u32 & (MOST_NUMBERS as u32 - 1),
        }
    }
}

/// The identity of a new renderer, which is not 0.
pub(in crate::gpu) fn next_renderer() -> u32 {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    COUNT.fetch_add(1, Ordering::Relaxed) % ((1 << RENDERER_BITS) - 1) + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_id_comes_back_from_its_bits() {
        let (most, last) = ((1 << RENDERER_BITS) - 1, MOST_GENERATIONS - 1);
        for renderer in [1, 2, most] {
            for generation in [0, 1, last] {
                for number in [0, 1, MOST_NUMBERS as u32 - 1] {
                    let id = ObjectId {
                        renderer,
                        generation,
                        number,
                    };
                    assert_ne!(id.to_bits(), 0);
                    assert_eq!(ObjectId::from_bits(id.to_bits()), id);
                }
            }
        }
        assert_ne!(next_renderer(), next_renderer());
    }
}
