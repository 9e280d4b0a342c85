//! Objects come, go and change.

use super::entry::{Draw, Entry, ObjectId};
use super::output::Output;
use super::renderer::Renderer;
use crate::error::Result;
#[cfg(doc)]
use crate::error::Stage;
use crate::scene::{Copies, Lighting, Object, Offset, Placement};

impl Renderer {
    /// Adds an object; it is drawn from the next prepared frame on, after those that were there
    /// before.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key; [`Stage::Draw`] for more than 2^32
    /// instances.
    pub fn add(&mut self, object: Object) -> Result<ObjectId> {
        object.check()?;
        let instances = self.allocate_instances(object.placements().len())?;
        let free = self.entries.iter().position(Option::is_none);
        let number = free.unwrap_or(self.entries.len());
        if free.is_none() {
            self.entries.push(None);
            self.generations.push(0);
        }
        self.entries[number] = Some(Entry {
            object,
            wanted: None,
            grown: None,
            prepared: None,
            draw: Draw::default(),
            instances,
            stale: 0,
        });
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        self.order.push(number);
        self.changed.push(number);
        self.reordered();
        Ok(ObjectId {
            number,
            generation: self.generations[number as usize],
        })
    }

    /// Takes an object away. What frames in flight read of it is kept until they are done.
    ///
    /// # Errors
    /// [`Stage::Usage`] for an object that is not there.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.entry(id)?;
        let number = id.number as usize;
        self.generations[number] += 1;
        if let Some(entry) = self.entries[number].take() {
            self.instances.free_range(entry.instances.clone());
            self.retire(entry.prepared);
        }
        for list in [&mut self.order, &mut self.changed, &mut self.unplanned] {
            list.retain(|&n| n != id.number);
        }
        for slot in &mut self.frames {
            slot.stale.retain(|&n| n != id.number);
        }
        self.reordered();
        Ok(())
    }

    /// Gives an object other values, all of them. What is equal costs nothing.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key; [`Stage::Usage`] for an object that
    /// is not there.
    pub fn set(&mut self, id: ObjectId, object: Object) -> Result<()> {
        object.check()?;
        if self.entry(id)?.latest().same_look(&object) {
            if self.entry(id)?.latest().instances != object.instances {
                self.set_instances(id, object.instances)?;
            }
            return self.set_placement(id, object.placement);
        }
        let count = object.placements().len();
        if self.entry(id)?.placements_len() != count {
            self.resize_instances(id, count)?;
        }
        self.entry(id)?.wanted = Some(object);
        self.changed.push(id.number);
        Ok(())
    }

    /// Moves the surface of an object.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_offset(&mut self, id: ObjectId, offset: Offset) -> Result<()> {
        offset.check()?;
        let entry = self.entry(id)?;
        if entry.latest().offset == offset {
            return Ok(());
        }
        let (wanted, object) = (&mut entry.wanted, &entry.object);
        wanted.get_or_insert_with(|| object.clone()).offset = offset;
        self.changed.push(id.number);
        Ok(())
    }

    /// Moves an object that is one copy.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_placement(&mut self, id: ObjectId, placement: Placement) -> Result<()> {
        placement.check()?;
        let entry = self.entry(id)?;
        if entry.latest().placement == placement {
            return Ok(());
        }
        entry.object.placement = placement;
        if let Some(wanted) = &mut entry.wanted {
            wanted.placement = placement;
        }
        if let Some(grown) = &mut entry.grown {
            grown.object.placement = grown.growth.placement(&placement);
        }
        self.unplanned.push(id.number);
        Ok(())
    }

    /// Gives an object other copies; none: one, at its placement.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_instances(&mut self, id: ObjectId, instances: impl Into<Copies>) -> Result<()> {
        let instances = instances.into();
        instances.check(|all| all.iter().try_for_each(Placement::check))?;
        let count = instances.len().max(1);
        if self.entry(id)?.placements_len() != count {
            self.resize_instances(id, count)?;
        }
        let entry = self.entry(id)?;
        if let Some(wanted) = &mut entry.wanted {
            wanted.instances.clone_from(&instances);
        }
        if let Some(grown) = &mut entry.grown {
            let all = instances.iter().map(|p| grown.growth.placement(p));
            grown.object.instances = all.collect();
        }
        entry.object.instances = instances;
        self.unplanned.push(id.number);
        Ok(())
    }

    /// Sets lights and shadows for all objects.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key.
    pub fn set_lighting(&mut self, lighting: &Lighting) -> Result<()> {
        lighting.check()?;
        super::block::check_lights(lighting)?;
        let codes = |l: &Lighting| (l.lights.len(), l.shadow);
        if codes(lighting) != codes(&self.lighting) {
            self.changed.extend(&self.order);
        }
        self.lighting = lighting.clone();
        Ok(())
    }

    /// What depends on the order: depths that compute compares, shadows' lists.
    fn reordered(&mut self) {
        self.version += 1;
        if matches!(self.output, Output::Compute(_)) {
            self.unplanned.extend(&self.order);
        }
    }
}
