//! The objects of a renderer: added, removed and changed.

use super::Content;
use super::entry::Entry;
use super::object_id::{MOST_GENERATIONS, MOST_NUMBERS, ObjectId};
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::renderer::Renderer;
use crate::scene::{Copies, Lighting, Object, Offset, Placement};
use range_alloc::RangeAllocator;
use std::ops::Range;

/// Entries by number, their order, and ranges of instances.
pub(crate) struct Objects {
    /// The renderer that ids name.
    pub renderer: u32,
    places: Vec<Place>,
    free: Vec<u32>,
    /// Numbers and generations in the order in which objects were added, including dead ones.
    order: Vec<(u32, u32)>,
    /// The number of dead ones in `order`.
    dead: usize,
    instances: RangeAllocator<u32>,
}

#[derive(Default)]
struct Place {
    generation: u32,
    entry: Option<Entry>,
}

impl Objects {
    /// An empty list, for the renderer of this identity.
    pub fn of(renderer: u32) -> Self {
        Self {
            renderer,
            places: Vec::new(),
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
    pub fn places(&self) -> usize {
        self.places.len()
    }

    /// One more than the number of the last instance.
    pub fn instances(&self) -> u32 {
        self.instances.initial_range().end
    }

    /// All objects with their numbers, in the order in which they were added.
    pub fn ordered(&self) -> impl Iterator<Item = (u32, &Entry)> {
        self.order.iter().filter_map(|&(number, generation)| {
            let place = &self.places[number as usize];
            let entry = place.entry.as_ref()?;
            (place.generation == generation).then_some((number, entry))
        })
    }

    /// The numbers of all objects, in the same order.
    pub fn numbers(&self) -> Vec<u32> {
        self.ordered().map(|(number, _)| number).collect()
    }

    /// The entry of a number; `None` if it is gone.
    pub fn at(&self, number: u32) -> Option<&Entry> {
        self.places.get(number as usize)?.entry.as_ref()
    }

    /// The mutable entry of a number; `None` if it is gone.
    pub fn at_mut(&mut self, number: u32) -> Option<&mut Entry> {
        self.places.get_mut(number as usize)?.entry.as_mut()
    }

    /// The position of an object in the order of all objects.
    pub fn position(&self, number: u32) -> usize {
        self.ordered().position(|(n, _)| n == number).unwrap_or(0)
    }

    fn add(&mut self, object: Object, version: u64) -> Result<ObjectId> {
        if self.free.is_empty() && self.places.len() == MOST_NUMBERS {
            let message = format!("more than {MOST_NUMBERS} objects; make copies instead");
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        let instances = self.allocate(object.placements().len())?;
        let number = self.free.pop().unwrap_or_else(|| {
            self.places.push(Place::default());
            self.places.len() as u32 - 1
        });
        let place = &mut self.places[number as usize];
        place.entry = Some(Entry::new(object, instances, version));
        self.order.push((number, place.generation));
        Ok(ObjectId {
            renderer: self.renderer,
            number,
            generation: place.generation,
        })
    }

    fn remove(&mut self, id: ObjectId) {
        let place = &mut self.places[id.number as usize];
        place.generation += 1;
        if let Some(entry) = place.entry.take() {
            self.instances.free_range(entry.instances);
        }
        if place.generation < MOST_GENERATIONS {
            self.free.push(id.number);
        }
        self.dead += 1;
        if self.dead > self.order.len() / 2 {
            let alive = |&(n, g): &(u32, u32)| self.places[n as usize].generation == g;
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

impl Renderer {
    /// Adds an object, which is drawn from the next prepared frame on, after all earlier objects.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for values out of range, with the key; [`ErrorKind::TooLarge`] for
    /// more than 2^31 instances or 2^24 objects.
    pub fn add(&mut self, object: Object) -> Result<ObjectId> {
        object.check()?;
        self.content.version += 1;
        let id = self.content.objects.add(object, self.content.version)?;
        self.content.changed.push(id.number);
        Ok(id)
    }

    /// Removes an object. Frames that were prepared earlier keep it until they are done.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for an object that does not exist.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.content.entry(id)?;
        self.content.objects.remove(id);
        self.content.version += 1;
        Ok(())
    }

    /// The values of an object that were set last.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for an object that does not exist.
    pub fn object(&self, id: ObjectId) -> Result<&Object> {
        Ok(self.content.entry(id)?.latest())
    }

    /// Sets all values of an object. Equal values cost nothing.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for values out of range, with the key; [`ErrorKind::Usage`] for an
    /// object that does not exist.
    pub fn set(&mut self, id: ObjectId, object: Object) -> Result<()> {
        object.check()?;
        let latest = self.content.entry(id)?.latest();
        if latest.same_look(&object) {
            if latest.instances != object.instances {
                self.set_instances(id, object.instances)?;
            }
            return self.set_placement(id, object.placement);
        }
        self.content.resize(id, object.placements().len())?;
        self.content.change(id)?.wanted = Some(object);
        self.content.changed.push(id.number);
        Ok(())
    }

    /// Moves the surface of an object.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_offset(&mut self, id: ObjectId, offset: Offset) -> Result<()> {
        offset.check()?;
        if self.content.entry(id)?.latest().offset == offset {
            return Ok(());
        }
        let entry = self.content.change(id)?;
        let (wanted, object) = (&mut entry.wanted, &entry.object);
        wanted.get_or_insert_with(|| object.clone()).offset = offset;
        self.content.changed.push(id.number);
        Ok(())
    }

    /// Moves an object that has one copy.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_placement(&mut self, id: ObjectId, placement: Placement) -> Result<()> {
        placement.check()?;
        if self.content.entry(id)?.latest().placement == placement {
            return Ok(());
        }
        let entry = self.content.change(id)?;
        entry.object.placement = placement;
        if let Some(wanted) = &mut entry.wanted {
            wanted.placement = placement;
        }
        if let Some(grown) = &mut entry.grown {
            grown.object.placement = grown.growth.placement(&placement);
        }
        Ok(())
    }

    /// Sets the copies of an object. An empty list gives one copy, at the object's placement.
    ///
    /// # Errors
    /// Same as [`Renderer::set`].
    pub fn set_instances(&mut self, id: ObjectId, instances: impl Into<Copies>) -> Result<()> {
        let instances = instances.into();
        instances.check(|all| all.iter().try_for_each(Placement::check))?;
        self.content.resize(id, instances.len().max(1))?;
        let entry = self.content.change(id)?;
        if let Some(wanted) = &mut entry.wanted {
            wanted.instances.clone_from(&instances);
        }
        if let Some(grown) = &mut entry.grown {
            let all = instances.iter().map(|p| grown.growth.placement(p));
            grown.object.instances = all.collect();
        }
        entry.object.instances = instances;
        Ok(())
    }

    /// Sets lights and shadows for all objects.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for values out of range, with the key.
    pub fn set_lighting(&mut self, lighting: &Lighting) -> Result<()> {
        lighting.check()?;
        crate::gpu::resources::block::check_lights(lighting)?;
        let codes = |l: &Lighting| (l.lights.len(), l.shadow);
        if codes(lighting) != codes(&self.content.lighting) {
            self.content.changed.extend(self.content.objects.numbers());
            self.content.version += 1;
        }
        if codes(lighting) == codes(&self.content.lit) {
            self.content.lit = lighting.clone();
        }
        self.content.lighting = lighting.clone();
        Ok(())
    }
}

impl Content {
    /// Returns the entry of an object, or an error if the object does not exist.
    fn entry(&self, id: ObjectId) -> Result<&Entry> {
        let place = self.objects.places.get(id.number as usize);
        let place = place.filter(|place| {
            place.generation == id.generation && id.renderer == self.objects.renderer
        });
        place.and_then(|place| place.entry.as_ref()).ok_or_else(|| {
            let message = "the object was removed, or is another renderer's";
            Error::new(ErrorKind::Usage, message)
        })
    }

    /// Returns the entry of an object, marked as changed.
    fn change(&mut self, id: ObjectId) -> Result<&mut Entry> {
        self.entry(id)?;
        self.version += 1;
        let version = self.version;
        let gone = || Error::new(ErrorKind::Usage, "the object was removed");
        let entry = self.objects.at_mut(id.number).ok_or_else(gone)?;
        entry.version = version;
        Ok(entry)
    }

    /// Gives an object room for exactly this many copies.
    fn resize(&mut self, id: ObjectId, count: usize) -> Result<()> {
        if self.entry(id)?.instances.len() != count {
            self.objects.resize(id.number, count)?;
            self.change(id)?;
        }
        Ok(())
    }
}
