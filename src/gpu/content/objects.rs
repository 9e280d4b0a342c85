//! The objects of a renderer, and their identities.

use super::entry::{Entry, Last, LastValues, Stale};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::resources::textures::ObjectImages;
use crate::scene::Object;
use range_alloc::RangeAllocator;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// An object of one renderer; other renderers reject the id. The id names the same object whatever
/// is set, and no other object after the removal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(u64);

// From the highest bits: a million renderers of the process, a million objects in turn per entry, 16
// million objects at once. Identities of renderers repeat after that.
const RENDERER_BITS: u32 = 20;
const GENERATION_BITS: u32 = 20;
const NUMBER_BITS: u32 = 24;

/// Instances of a new renderer.
const FIRST_INSTANCES: u32 = 64;

/// Upper limit on entries of a renderer.
const MOST_NUMBERS: usize = 1 << NUMBER_BITS;

impl ObjectId {
    /// The first object that uses entry `number` of a renderer.
    const fn first(renderer: u32, number: u32) -> Self {
        Self((renderer as u64) << (GENERATION_BITS + NUMBER_BITS) | number as u64)
    }

    /// The next object that uses the same entry. After the last one the entry stays empty.
    fn next(self) -> Option<Self> {
        let next = self.0.wrapping_add(1 << NUMBER_BITS);
        (next >> NUMBER_BITS & ((1 << GENERATION_BITS) - 1) != 0).then_some(Self(next))
    }

    /// The object's number in pictures of [`Plane::Identity`](crate::settings::Plane::Identity). No
    /// two objects of a renderer have the same one at a time.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0 as u32 & (MOST_NUMBERS as u32 - 1)
    }

    /// The id as one number, never 0, for interfaces that carry plain numbers.
    #[must_use]
    pub const fn to_bits(self) -> u64 {
        self.0
    }

    /// The id that [`ObjectId::to_bits`] encoded. Any other number is the id of no object.
    #[must_use]
    pub const fn from_bits(bits: u64) -> Self {
        Self(bits)
    }
}

/// Entries by number, their order, and ranges of instances.
pub(crate) struct Objects {
    /// The renderer that ids name, not 0.
    pub renderer: u32,
    numbered: Vec<Numbered>,
    free: Vec<u32>,
    /// Objects in the order in which they were added, including dead ones.
    order: Vec<ObjectId>,
    /// The number of dead ones in `order`.
    dead: usize,
    instances: RangeAllocator<u32>,
    copies: u32,
    most_instances: u32,
    /// True if anything was changed since the last snapshot.
    pub stale: bool,
    /// True if values of the last frame are kept, for motion.
    keeps_last: bool,
}

/// An entry, and the last object that used it.
struct Numbered {
    id: ObjectId,
    entry: Option<Entry>,
}

impl Objects {
    /// No objects, for a new renderer. `most_instances`: limit of the device, at least 64.
    pub fn new(most_instances: u32, keeps_last: bool) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        Self {
            renderer: COUNT.fetch_add(1, Ordering::Relaxed) % ((1 << RENDERER_BITS) - 1) + 1,
            numbered: Vec::new(),
            free: Vec::new(),
            order: Vec::new(),
            dead: 0,
            instances: RangeAllocator::new(0..FIRST_INSTANCES),
            copies: 0,
            most_instances,
            stale: true,
            keeps_last,
        }
    }

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

    /// The entry of an object; `None` if the object does not exist.
    fn get(&self, id: ObjectId) -> Option<&Entry> {
        let numbered = self.numbered.get(id.number() as usize);
        numbered.filter(|n| n.id == id)?.entry.as_ref()
    }

    /// Returns the entry of an object, or an error if the object does not exist.
    pub fn entry(&self, id: ObjectId) -> Result<&Entry> {
        self.get(id).ok_or_else(|| gone(id))
    }

    /// The same error of an object's values, with the object's key and name; another error if there is
    /// no such object.
    pub fn named(&self, id: ObjectId, error: Error) -> Error {
        let position = self.ordered().position(|(number, _)| number == id.number());
        match (self.entry(id), position) {
            (Ok(entry), Some(position)) => named(error, position, &entry.set.object),
            _ => gone(id),
        }
    }

    /// Returns the entry of an object, with what must be made anew marked.
    pub fn change(&mut self, id: ObjectId, stale: Stale) -> Result<&mut Entry> {
        self.entry(id)?;
        self.stale = true;
        let keeps_last = self.keeps_last;
        let entry = self.at_mut(id.number()).ok_or_else(|| gone(id))?;
        if let (true, Last::Same) = (keeps_last, &entry.set.last) {
            entry.set.last = Last::Was(LastValues::of(&entry.set.object));
        }
        entry.mark(stale);
        Ok(entry)
    }

    /// All objects with their numbers, in the order in which they were added.
    pub fn ordered(&self) -> impl Iterator<Item = (u32, &Entry)> {
        self.order
            .iter()
            .filter_map(|&id| Some((id.number(), self.get(id)?)))
    }

    /// The mutable entry of a number; `None` if it is gone.
    pub fn at_mut(&mut self, number: u32) -> Option<&mut Entry> {
        self.numbered.get_mut(number as usize)?.entry.as_mut()
    }

    pub fn entries_mut(&mut self) -> impl Iterator<Item = &mut Entry> {
        self.numbered.iter_mut().filter_map(|n| n.entry.as_mut())
    }

    pub fn add(&mut self, object: Object) -> Result<ObjectId> {
        if self.free.is_empty() && self.numbered.len() == MOST_NUMBERS {
            let message = format!("more than {MOST_NUMBERS} objects; make copies instead");
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        let instances = self.allocate(object.placements().len());
        let instances = instances.map_err(|error| named(error, self.len(), &object))?;
        let number = self.free.pop().unwrap_or_else(|| {
            let number = self.numbered.len() as u32;
            let id = ObjectId::first(self.renderer, number);
            self.numbered.push(Numbered { id, entry: None });
            number
        });
        let numbered = &mut self.numbered[number as usize];
        numbered.entry = Some(Entry::new(object, ObjectImages::default(), instances));
        self.order.push(numbered.id);
        self.stale = true;
        Ok(numbered.id)
    }

    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.entry(id)?;
        let numbered = &mut self.numbered[id.number() as usize];
        let entry = numbered.entry.take();
        if let Some(next) = id.next() {
            numbered.id = next;
            self.free.push(id.number());
        }
        if let Some(entry) = entry {
            self.free_instances(entry.set.instances);
        }
        self.stale = true;
        self.dead += 1;
        if self.dead > self.order.len() / 2 {
            let mut order = std::mem::take(&mut self.order);
            order.retain(|id| self.get(*id).is_some());
            (self.order, self.dead) = (order, 0);
        }
        Ok(())
    }

    /// Ends a frame of all views: values set from now on move objects from the present ones.
    pub fn end_frame(&mut self) {
        for entry in self.numbered.iter_mut().filter_map(|n| n.entry.as_mut()) {
            if self.keeps_last && !matches!(entry.set.last, Last::Same) {
                entry.set.last = Last::Same;
                entry.mark(Stale::State);
                self.stale = true;
            }
        }
    }

    /// A free range of instances. Ranges of other objects move if there is room, but not in one
    /// piece.
    fn allocate(&mut self, count: usize) -> Result<Range<u32>> {
        let most = self.most_instances;
        let all = u32::try_from(count)
            .ok()
            .and_then(|n| self.copies.checked_add(n));
        let Some(all) = all.filter(|all| *all <= most) else {
            let message = format!(
                "{count} copies beside {} others; the device takes {most} at once: draw fewer",
                self.copies
            );
            return Err(Error::new(ErrorKind::TooLarge, message).at_key("instances"));
        };
        let count = all - self.copies;
        let end = self.instances();
        let mut range = self.instances.allocate_range(count);
        if range.is_err() && end < most {
            self.instances
                .grow_to(most.min(end.saturating_add(end.max(count))));
            range = self.instances.allocate_range(count);
        }
        if range.is_err() {
            self.compact(most);
            range = self.instances.allocate_range(count);
        }
        let none = |_| Error::new(ErrorKind::Other, "instances have gaps that no copy fits in");
        let range = range.map_err(none)?;
        self.copies = all;
        Ok(range)
    }

    fn free_instances(&mut self, range: Range<u32>) {
        self.copies -= range.len() as u32;
        self.instances.free_range(range);
    }

    /// Gives back the memory of instances if few of them are left.
    pub fn shrink(&mut self) {
        let wanted = self.copies.saturating_mul(2).max(FIRST_INSTANCES);
        if self.instances() / 8 >= wanted {
            self.compact(wanted);
        }
    }

    /// Moves all ranges to the front of `room` instances.
    fn compact(&mut self, room: u32) {
        self.stale = true;
        self.instances = RangeAllocator::new(0..room);
        let entries = self.numbered.iter_mut().filter_map(|n| n.entry.as_mut());
        for entry in entries.filter(|entry| !entry.set.instances.is_empty()) {
            let count = entry.set.instances.len() as u32;
            // All ranges fit, one after the other.
            if let Ok(range) = self.instances.allocate_range(count) {
                entry.set.instances = range;
                entry.mark(Stale::State);
            }
        }
    }

    /// Gives an object room for exactly this many copies.
    pub fn resize(&mut self, id: ObjectId, count: usize) -> Result<()> {
        if self.entry(id)?.set.instances.len() == count {
            return Ok(());
        }
        let entry = self.change(id, Stale::State)?;
        // The old range may be a part of the new one.
        let old = std::mem::take(&mut entry.set.instances);
        let kept = old.len();
        self.free_instances(old);
        let new = self.allocate(count);
        let (range, result) = match new {
            Ok(range) => (range, Ok(())),
            Err(error) => (self.allocate(kept)?, Err(self.named(id, error))),
        };
        self.change(id, Stale::State)?.set.instances = range;
        result
    }
}

fn gone(id: ObjectId) -> Error {
    let id = id.to_bits();
    let message = format!("the object {id} was removed, or is another renderer's");
    Error::new(ErrorKind::Usage, message)
}

/// The same error of an object's values, with the key `object.N`, and with the object's name or the
/// file of its profile. `position`: N.
pub(in crate::gpu) fn named(error: Error, position: usize, object: &Object) -> Error {
    let key = error.key.as_deref().unwrap_or("profile");
    let file = object.file.as_ref().filter(|_| key == "profile");
    let key = Some(format!("object.{position}.{key}"));
    match file {
        Some(file) => Error { key, ..error }.in_file(file),
        None => Error {
            key,
            message: format!("{} (object {:?})", error.message, object.name),
            ..error
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_ends_with_its_last_object() {
        let renderer = (1 << RENDERER_BITS) - 1;
        let number = MOST_NUMBERS as u32 - 1;
        let first = ObjectId::first(renderer, number);
        let second = first.next().unwrap();
        assert_eq!([first, second].map(ObjectId::number), [number; 2]);
        assert!(second > first && ObjectId::from_bits(second.to_bits()) == second);
        let last = ObjectId(u64::MAX);
        assert_eq!((last.number(), last.next()), (number, None));
        assert_ne!(
            ObjectId::first(Objects::new(64, false).renderer, 0).to_bits(),
            0
        );
        assert_ne!(
            Objects::new(64, false).renderer,
            Objects::new(64, false).renderer
        );
    }
}
