//! What each object is drawn by, and the memory that it takes on the device.

use super::blocks::InstanceBlock;
use super::entry::Entry;
use super::levels;
use super::plan::{DrawPath, Work};
use super::renderer::Renderer;
use super::table_slot::Part;
use super::view::View;

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
    /// What each object is drawn by and takes, in order.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        let cost = |entry: &Entry| entry.cost(self.view.as_ref());
        self.ordered().map(cost).collect()
    }

    /// Bytes of all buffers and images of the renderer on the device; a target and the pipelines
    /// are not among them.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        let slots: u64 = self.frames.iter().map(|slot| slot.bytes()).sum();
        self.map_bytes().iter().sum::<u64>() + self.arena.buffer.bytes + self.corners.bytes + slots
    }
}

impl Entry {
    fn cost(&self, view: Option<&View>) -> ObjectCost {
        let prepared = self.prepared.as_ref();
        let fitted = prepared.and_then(|p| Some((p.level, p.fitted()?)));
        let error = view.zip(fitted).map(|(view, (level, _))| {
            let seen = self.pixels_per_unit(view, false);
            levels::bound(level) * seen
        });
        let searched = prepared.and_then(|p| p.surface.as_ref());
        let surface = searched.or(prepared.and_then(|p| p.proxy.as_ref()));
        let tables = [Part::Tables, Part::Frusta, Part::Patches].map(|part| {
            let placed = surface.filter(|s| s.slot(part).is_some());
            placed.map_or(0, |s| 16 * s.vectors(part).len() as u64)
        });
        let map = prepared.and_then(|p| Some(p.map.as_ref()?.texture.bytes()));
        let arc = prepared.and_then(|p| Some(p.arc.as_ref()?.texture.bytes()));
        ObjectCost {
            path: self
                .draw
                .work
                .as_ref()
                .map_or(DrawPath::Nothing, Work::path),
            level: fitted.map(|(level, _)| u32::from(level)),
            error_pixels: error.filter(|e| e.is_finite()),
            patches: fitted.map_or(0, |(_, surface)| surface.patches()),
            table_bytes: tables.iter().sum(),
            map_bytes: map.unwrap_or(0) + arc.unwrap_or(0),
            instance_bytes: INSTANCE_BYTES * u64::from(self.instances.end - self.instances.start),
        }
    }
}
