//! The objects of a renderer, and their identities: the renderer, its entry, and the object in that
//! entry.

use super::Content;
use super::entry::{Entry, History, LastValues};
use crate::error::{Error, ErrorKind, Result};
use crate::scene::Object;
use range_alloc::RangeAllocator;
use std::ops::Range;
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
    /// The object's number in pictures of [`Plane::Identity`](crate::settings::Plane::Identity). No
    /// two objects of a renderer have the same one at a time.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.number
    }

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

/// Entries by number, their order, and ranges of instances.
pub(crate) struct Objects {
    /// The renderer that ids name.
    pub renderer: u32,
    numbered: Vec<Numbered>,
    free: Vec<u32>,
    /// Numbers and generations in the order in which objects were added, including dead ones.
    order: Vec<(u32, u32)>,
    /// The number of dead ones in `order`.
    dead: usize,
    instances: RangeAllocator<u32>,
}

/// The entry that has a number now, and how many had it before.
#[derive(Default)]
struct Numbered {
    generation: u32,
    entry: Option<Entry>,
}

impl Objects {
    /// No objects, for the renderer of this identity.
    pub fn of(renderer: u32) -> Self {
        Self {
            renderer,
            numbered: Vec::new(),
            free: Vec::new(),
            order: Vec::new(),
            dead: 0,
            instances: RangeAllocator::new(0..64),
        }
    }

    /// The number of objects.
    pub fn len(&self) -> usize {
        self.order.len() - self.dead
    }

    /// One more than the largest number that an object has had.
    pub fn number_count(&self) -> usize {
        self.numbered.len()
    }

    /// One more than the number of the last instance.
    pub fn instances(&self) -> u32 {
        self.instances.initial_range().end
    }

    /// All objects with their numbers, in the order in which they were added.
    pub fn ordered(&self) -> impl Iterator<Item = (u32, &Entry)> {
        self.order.iter().filter_map(|&(number, generation)| {
            let numbered = &self.numbered[number as usize];
            let entry = numbered.entry.as_ref()?;
            (numbered.generation == generation).then_some((number, entry))
        })
    }

    /// The numbers of all objects, in the same order.
    pub fn numbers(&self) -> Vec<u32> {
        self.ordered().map(|(number, _)| number).collect()
    }

    /// The entry of a number; `None` if it is gone.
    pub fn at(&self, number: u32) -> Option<&Entry> {
        self.numbered.get(number as usize)?.entry.as_ref()
    }

    /// The mutable entry of a number; `None` if it is gone.
    pub fn at_mut(&mut self, number: u32) -> Option<&mut Entry> {
        self.numbered.get_mut(number as usize)?.entry.as_mut()
    }

    /// The position of an object in the order of all objects.
    pub fn position(&self, number: u32) -> usize {
        self.ordered().position(|(n, _)| n == number).unwrap_or(0)
    }

    pub fn add(&mut self, object: Object, version: u64) -> Result<ObjectId> {
        if self.free.is_empty() && self.numbered.len() == MOST_NUMBERS {
            let message = format!("more than {MOST_NUMBERS} objects; make copies instead");
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        let instances = self.allocate(object.placements().len())?;
        let number = self.free.pop().unwrap_or_else(|| {
            self.numbered.push(Numbered::default());
            self.numbered.len() as u32 - 1
        });
        let numbered = &mut self.numbered[number as usize];
        numbered.entry = Some(Entry::new(object, instances, version));
        self.order.push((number, numbered.generation));
        Ok(ObjectId {
            renderer: self.renderer,
            number,
            generation: numbered.generation,
        })
    }

    pub fn remove(&mut self, id: ObjectId) {
        let numbered = &mut self.numbered[id.number as usize];
        numbered.generation += 1;
        if let Some(entry) = numbered.entry.take() {
            self.instances.free_range(entry.instances);
        }
        if numbered.generation < MOST_GENERATIONS {
            self.free.push(id.number);
        }
        self.dead += 1;
        if self.dead > self.order.len() / 2 {
            let alive = |&(n, g): &(u32, u32)| self.numbered[n as usize].generation == g;
            self.order.retain(alive);
            self.dead = 0;
        }
    }

    fn allocate(&mut self, count: usize) -> Result<Range<u32>> {
        let many = || Error::new(ErrorKind::TooLarge, "more than 2^31 instances");
        let count = u32::try_from(count).map_err(|_| many())?;
        if let Ok(range) = self.instances.allocate_range(count) {
            return Ok(range);
        }
        let end = self.instances();
        let bigger = end.checked_add(end.max(count)).filter(|e| *e < 1 << 31);
        self.instances.grow_to(bigger.ok_or_else(many)?);
        self.instances.allocate_range(count).map_err(|_| many())
    }

    /// Gives an object another range of instances.
    pub fn resize(&mut self, number: u32, count: usize) -> Result<()> {
        let new = self.allocate(count)?;
        if let Some(entry) = self.at_mut(number) {
            let old = std::mem::replace(&mut entry.instances, new);
            self.instances.free_range(old);
        }
        Ok(())
    }
}

impl Content {
    /// Returns the entry of an object, or an error if the object does not exist.
    pub fn entry(&self, id: ObjectId) -> Result<&Entry> {
        let numbered = self.objects.numbered.get(id.number as usize);
        let numbered = numbered.filter(|numbered| {
            numbered.generation == id.generation && id.renderer == self.objects.renderer
        });
        numbered
            .and_then(|numbered| numbered.entry.as_ref())
            .ok_or_else(|| {
                let message = "the object was removed, or is another renderer's";
                Error::new(ErrorKind::Usage, message)
            })
    }

    /// Returns the entry of an object, marked as changed.
    pub fn change(&mut self, id: ObjectId) -> Result<&mut Entry> {
        self.entry(id)?;
        self.version += 1;
        let version = self.version;
        let gone = || Error::new(ErrorKind::Usage, "the object was removed");
        let entry = self.objects.at_mut(id.number).ok_or_else(gone)?;
        entry.version = version;
        if self.output.planes().has_motion() && matches!(entry.history, History::Still) {
            entry.history = History::Moved(LastValues::of(entry.latest()));
            self.moved.push(id.number);
        }
        Ok(entry)
    }

    /// Makes the present values those of the last frame.
    pub fn end_frame(&mut self) {
        let moved = std::mem::take(&mut self.moved);
        self.version += u64::from(!moved.is_empty());
        for number in moved {
            if let Some(entry) = self.objects.at_mut(number) {
                entry.history = History::Still;
                entry.version = self.version;
            }
        }
    }

    /// Gives an object room for exactly this many copies.
    pub fn resize(&mut self, id: ObjectId, count: usize) -> Result<()> {
        if self.entry(id)?.instances.len() != count {
            self.objects.resize(id.number, count)?;
            self.change(id)?;
        }
        Ok(())
    }
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
