//! The draw path of each object, and the memory that it takes on the device.

use super::Renderer;
use super::blocks::instance_block;
use crate::gpu::content::view_plan::PlannedObject;
use crate::plan::levels::COPY_LEVELS;
use crate::plan::{DrawPath, View};
use crate::shader::InstanceBlock;
use crate::solid::offset_surface::Part;

/// The draw path of an object in the last prepared frame, and its memory on the device.
///
/// Objects that show one profile under one offset share tables and maps. Every such object counts
/// the shared bytes in full.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectCost {
    /// The draw path.
    pub path: DrawPath,
    /// Level of the patches; 0 is the exact level. `None` for searches without patches. Objects
    /// with more than 64 copies have a level for each copy; this is the finest.
    pub level: Option<u32>,
    /// Upper bound on the shift of the silhouette by patches of this level, in pixels. `None` if
    /// the object reaches the eye, and for searches without patches.
    pub error_pixels: Option<f64>,
    /// Number of patches.
    pub patches: usize,
    /// Bytes of patches, trees and hulls.
    pub table_bytes: u64,
    /// Bytes of the shape map and the table of lengths.
    pub map_bytes: u64,
    /// Bytes of the copies, for one frame in flight.
    pub instance_bytes: u64,
}

/// Bytes of one copy of an object on the device, for one frame in flight.
pub const INSTANCE_BYTES: u64 = size_of::<InstanceBlock>() as u64;

impl Renderer {
    /// The costs of all objects in the last planned frame, in order.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        let Some(plan) = &self.content.plan else {
            return Vec::new();
        };
        let objects = plan.objects.iter().zip(&plan.frame.paths);
        let cost = |(object, path): (&PlannedObject, &DrawPath)| object.cost(*path, &plan.view);
        objects.map(cost).collect()
    }

    /// The level of each copy in the last planned frame, one list per object. A list is empty if all
    /// copies have the level of [`ObjectCost`].
    #[must_use]
    pub fn copy_levels(&self) -> Vec<Vec<u8>> {
        let objects = self.content.plan.iter().flat_map(|plan| {
            plan.objects.iter().map(|object| {
                let (levels, drawn) = (object.levels.as_ref()?, object.object.drawn());
                let level = |placement| {
                    let block = instance_block(drawn, placement, 0, &plan.view);
                    COPY_LEVELS[levels.of_block(&block)]
                };
                Some(drawn.placements().iter().map(level).collect())
            })
        });
        objects.map(Option::unwrap_or_default).collect()
    }

    /// Bytes of all buffers and images of the renderer on the device, and of the geometry that all
    /// renderers of the device share. Targets and pipelines are not counted.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        let slots: u64 = self.slots.iter().map(|slot| slot.bytes()).sum();
        let geometry = self.content.geometry.lock();
        let shared = geometry.map_or(0, |geometry| geometry.bytes());
        self.map_bytes().iter().sum::<u64>() + shared + slots
    }
}

impl PlannedObject {
    fn cost(&self, path: DrawPath, view: &View) -> ObjectCost {
        let (object, derived) = (&self.object, &self.object.derived);
        let follows = derived.solver.follows_tolerance();
        let fitted = self.surfaces.first().filter(|_| follows);
        let levels = self.levels.as_ref().filter(|_| self.surfaces.len() > 1);
        let of_coarser = levels.map_or(0.0, |levels| levels.error);
        let error = fitted.map(|_| object.error_pixels(self.level, view).max(of_coarser));
        let stored = self.surfaces.iter().flat_map(|surface| {
            let stored = move |part: &Part| surface.slot(*part).is_some();
            let stored = Part::ALL.into_iter().filter(stored);
            stored.map(move |part| 16 * surface.vectors(part).len() as u64)
        });
        let map = derived.map.as_ref().map(|map| map.texture.bytes());
        let arc = derived.arc.as_ref().map(|arc| arc.texture.bytes());
        ObjectCost {
            path,
            level: fitted.map(|_| u32::from(self.level)),
            error_pixels: error.filter(|e| e.is_finite()),
            patches: fitted.map_or(0, |surface| surface.patches()),
            table_bytes: stored.sum(),
            map_bytes: map.unwrap_or(0) + arc.unwrap_or(0),
            instance_bytes: INSTANCE_BYTES * object.instances.len() as u64,
        }
    }
}
