//! What each object is drawn by, and the memory that it takes on the device.

use crate::gpu::entry::Entry;
use crate::gpu::frame::planned::PlannedObject;
use crate::gpu::renderer::Renderer;
use crate::gpu::resources::blocks::InstanceBlock;
use crate::plan::{DrawPath, View};
use crate::solid::table_slot::Part;

/// How an object was drawn in the last prepared frame, and what it takes on the device.
///
/// Objects that show one profile under one offset share tables and maps: each counts them as its
/// own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectCost {
    /// How it was drawn.
    pub path: DrawPath,
    /// Level of its patches; 0 is the exact one. None of searches that have no patches.
    pub level: Option<u32>,
    /// The most that the patches of this level move its silhouette, pixels; none where it reaches
    /// the eye.
    pub error_pixels: Option<f64>,
    /// Number of patches.
    pub patches: usize,
    /// Bytes of patches, trees and hulls.
    pub table_bytes: u64,
    /// Bytes of its shape map and its table of lengths.
    pub map_bytes: u64,
    /// Bytes of its copies, for one frame in flight.
    pub instance_bytes: u64,
}

/// Bytes of one copy of an object on the device, for one frame in flight.
pub const INSTANCE_BYTES: u64 = size_of::<InstanceBlock>() as u64;

impl Renderer {
    /// What each object is drawn by and takes, in order, in the last planned frame.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        let Some(planned) = &self.planned else {
            return Vec::new();
        };
        let objects = planned.objects.iter().zip(&planned.plan.paths);
        let cost = |(object, path): (&PlannedObject, &DrawPath)| {
            let entry = self.objects.at(object.number)?;
            Some(entry.cost(object, *path, &planned.view))
        };
        objects.filter_map(cost).collect()
    }

    /// Bytes of all buffers and images of the renderer on the device, and of the geometry that all
    /// renderers of the device share; a target and the pipelines are not among them.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        let slots: u64 = self.slots.iter().map(|slot| slot.bytes()).sum();
        let shared = self.geometry.lock().map_or(0, |geometry| geometry.bytes());
        self.map_bytes().iter().sum::<u64>() + shared + slots
    }
}

impl Entry {
    fn cost(&self, object: &PlannedObject, path: DrawPath, view: &View) -> ObjectCost {
        let prepared = self.prepared.as_ref();
        let follows = prepared.is_some_and(|p| p.solver.follows_tolerance());
        let fitted = object.surface.as_ref().filter(|_| follows);
        let error = fitted.map(|_| self.error_pixels(object.level, view));
        let tables = [Part::Tables, Part::Frusta, Part::Patches].map(|part| {
            let placed = object.surface.as_ref().filter(|s| s.slot(part).is_some());
            placed.map_or(0, |s| 16 * s.vectors(part).len() as u64)
        });
        let map = prepared.and_then(|p| Some(p.map.as_ref()?.texture.bytes()));
        let arc = prepared.and_then(|p| Some(p.arc.as_ref()?.texture.bytes()));
        ObjectCost {
            path,
            level: fitted.map(|_| u32::from(object.level)),
            error_pixels: error.filter(|e| e.is_finite()),
            patches: fitted.map_or(0, |surface| surface.patches()),
            table_bytes: tables.iter().sum(),
            map_bytes: map.unwrap_or(0) + arc.unwrap_or(0),
            instance_bytes: INSTANCE_BYTES * u64::from(self.instances.end - self.instances.start),
        }
    }
}
