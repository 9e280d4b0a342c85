//! How fine the mesh of a copy is: in a fixed number of quads, or within a tolerance on the screen.

use super::sight::{Shape, Sight};
use super::tessellation::Mesh;
use revmap::scene::{Object, Placement};
use revmap::surface::Contour;
use std::collections::BTreeMap;

/// How fine the mesh of a copy is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fineness {
    /// So many segments around the axis and at most so many rings along the outline.
    Quads {
        /// Steps around the axis.
        segments: u32,
        /// Most steps along the meridian; more if it has more corners.
        rings: u32,
    },
    /// Silhouettes within so many pixels, each copy by its size on the screen. Copies beside the
    /// picture are left out.
    Pixels(f64),
}

/// Levels in a factor of two of pixels per object unit.
const LEVELS: f64 = 2.0;
/// The finest level: 2^16 pixels per object unit. An eye nearer to a surface sees larger errors.
const FINEST: i32 = 32;

impl Fineness {
    /// The copies of an object by level.
    pub(super) fn by_level(
        self,
        object: &Object,
        shape: Shape,
        sight: &Sight,
    ) -> BTreeMap<i32, Vec<Placement>> {
        let mut all: BTreeMap<i32, Vec<Placement>> = BTreeMap::new();
        match self {
            _ if object.placements().is_empty() => {}
            Self::Quads { .. } => drop(all.insert(0, object.placements().to_vec())),
            Self::Pixels(_) => {
                for copy in object.placements() {
                    if let Some(pixels) = sight.pixels_per_unit(object, shape, copy) {
                        all.entry(self.level(pixels)).or_default().push(*copy);
                    }
                }
            }
        }
        all
    }

    /// The level at which an object unit takes so many pixels.
    pub(super) fn level(self, pixels: f64) -> i32 {
        match self {
            Self::Quads { .. } => 0,
            Self::Pixels(_) => ((LEVELS * pixels.log2()).ceil() as i32).clamp(0, FINEST),
        }
    }

    pub(super) fn mesh(self, contour: &Contour, level: i32) -> Mesh {
        match self {
            Self::Quads { segments, rings } => Mesh::new(contour, segments, rings),
            Self::Pixels(tolerance) => {
                let pixels = (f64::from(level) / LEVELS).exp2();
                Mesh::within(contour, tolerance / pixels)
            }
        }
    }
}

#[cfg(test)]
mod tests;
