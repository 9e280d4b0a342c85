//! The content of a renderer, as the host has set it.

use revmap::gpu::{HostImage, ObjectId, Renderer};
use revmap::scene::{Lighting, Object};
use std::collections::BTreeSet;

/// An object, as the host has set it.
#[derive(Clone)]
pub struct Thing {
    pub id: ObjectId,
    pub object: Object,
    pub mask: u32,
    pub color: Option<HostImage>,
    /// An image of slopes, or of heights if true.
    pub relief: Option<(HostImage, bool)>,
    /// The values at the last `end_frame`; `None` if the object was added since.
    pub last: Option<Object>,
}

impl Thing {
    pub fn new(id: ObjectId, object: Object) -> Self {
        Self {
            id,
            object,
            mask: u32::MAX,
            color: None,
            relief: None,
            last: None,
        }
    }
}

/// All objects in order, and lights.
#[derive(Clone, Default)]
pub struct Model {
    pub things: Vec<Thing>,
    pub lighting: Lighting,
}

impl Model {
    pub fn end_frame(&mut self) {
        for thing in &mut self.things {
            thing.last = Some(thing.object.clone());
        }
    }

    /// Adds everything to an empty renderer, moved from the last values to the present ones.
    pub fn add_to(&self, renderer: &mut Renderer) -> revmap::Result<Vec<ObjectId>> {
        renderer.set_lighting(&self.lighting)?;
        let mut ids = Vec::new();
        for thing in &self.things {
            let first = thing.last.as_ref().unwrap_or(&thing.object);
            let id = renderer.add(first.clone())?;
            renderer.set_mask(id, thing.mask)?;
            renderer.set_color_image(id, thing.color.clone())?;
            if let Some((image, heights)) = thing.relief.clone() {
                match heights {
                    true => renderer.set_height_image(id, Some(image))?,
                    false => renderer.set_slope_image(id, Some(image))?,
                }
            }
            ids.push(id);
        }
        renderer.end_frame();
        for (thing, id) in self.things.iter().zip(&ids) {
            if thing.last.is_some() {
                renderer.set(*id, thing.object.clone())?;
            }
        }
        Ok(ids)
    }

    /// What pipelines depend on, and parameters, places and numbers do not change.
    pub fn techniques(&self) -> BTreeSet<String> {
        let all = (self.lighting.shadow, self.lighting.environment.is_some());
        let of = |thing: &Thing| {
            let look = &thing.object.texturing;
            let colors = thing.color.is_some() || look.color_map.is_some();
            let heights = thing.relief.as_ref().map(|relief| relief.1);
            let bumps = (heights, look.displacement_map.is_some(), look.bump_form);
            let replicas = thing.object.repeat != [1; 3];
            format!("{:?}", (all, replicas, colors, bumps, look.projection))
        };
        self.things.iter().map(of).collect()
    }

    /// The numbers of the objects, in order.
    pub fn numbers(&self) -> Vec<u32> {
        self.things.iter().map(|t| t.id.number()).collect()
    }

    /// The number of copies of all objects.
    pub fn copies(&self) -> usize {
        self.things
            .iter()
            .map(|t| t.object.placements().len())
            .sum()
    }
}
