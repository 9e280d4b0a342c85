//! Shape boxes that grow with the offset, so that they cut nothing off the solid ([`Clip::None`]),
//! and that shrink to a solid which is small in its box.
//!
//! A grown box is drawn like any other. The outline is put into a larger box, and the whole is
//! scaled so that this box is one unit high again. Offset, axis and placement are transformed to
//! match. Let `k = 1 / (1 + low + high)` and `z' = k (z + low)`. The depth is
//! `u = 1 - z = u' / k - high`, so the offset keeps its form: `k w = k (e - b high) + b min(u', k
//! (c + high))`.

use super::{Clip, Object, Placement};
use crate::profile::{Bounds, Outline, Profile, Raster};
use crate::surface::Offset;
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::{Arc, Weak};

/// Enlargement of a shape box over the profile's, object units; negative where a box shrinks.
///
/// Sizes are multiples of one sixteenth, so that a changing offset rarely changes the box. Those of
/// a box that shrinks are multiples of a sixteenth of a power of two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth {
    /// Below `z = 0`.
    pub low: f64,
    /// Above `z = 1`.
    pub high: f64,
    /// Beyond `R`.
    pub side: f64,
}

/// Sizes of boxes are multiples of this, object units.
const STEP: f64 = 1.0 / 16.0;
/// Largest growth of a box, object units; the part that offsets add beyond it is cut.
pub const MOST_GROWTH: f64 = 64.0;
/// Least distance that an offset leaves to a grown box's faces, object units.
const MARGIN: f64 = 1e-3;
/// A box shrinks to a solid whose height and diameter are below this part of the box's height.
/// Patches are fitted and stored in units of the box: without this a solid of a thousandth of its
/// box, such as one in millimetres for metres, would have normals off by 13 degrees.
const SMALL: f64 = 1.0 / 8.0;

impl Growth {
    /// The growth that `object` needs; none if its box cuts, or if its offset stays within the box.
    pub fn of(object: &Object) -> Self {
        let bounds = object.profile.outline.bounds();
        let Some(bounds) = bounds.filter(|_| object.clip == Clip::None && object.repeat == [1; 3])
        else {
            return Self::default();
        };
        let Offset {
            extend,
            bevel,
            chamfer,
        } = object.offset;
        // A bevel is at least 0, so the offset is largest at the bottom, and at most e from z = 1
        // on.
        let largest = extend + bevel * chamfer;
        if let Some(shrunk) = Self::shrunk(object, &bounds, largest.max(0.0)) {
            return shrunk;
        }
        let pixel = object.profile.raster.as_ref().map(|r| f64::from(r.rows));
        let needed = |offset: f64, room: f64| {
            let least = offset - room.max(0.0);
            if least <= 0.0 {
                return 0.0;
            }
            let steps = (((least + MARGIN) / STEP).ceil() * STEP).min(MOST_GROWTH);
            // Rounds up to whole pixels of a picture.
            pixel.map_or(steps, |rows| (steps * rows).ceil() / rows)
        };
        Self {
            low: needed(largest, bounds.z_min),
            high: needed(
                largest.min(extend + bevel * (1.0 - bounds.z_max).max(0.0)),
                1.0 - bounds.z_max,
            ),
            side: needed(largest, object.profile.radius - bounds.r_max),
        }
    }

    /// The box around a small solid and its offset; none for a large one, for one whose axis is not
    /// in the middle, which the box's sides may cut, and for a picture, whose pixels fill the box.
    fn shrunk(object: &Object, bounds: &Bounds, offset: f64) -> Option<Self> {
        let height = bounds.z_max - bounds.z_min + 2.0 * offset;
        let size = height.max(2.0 * (bounds.r_max + offset));
        let fits = object.axis == [0.5; 2] && object.profile.raster.is_none();
        if !(fits && size > 0.0 && size < SMALL) {
            return None;
        }
        let step = size.log2().ceil().exp2() * STEP;
        let margin = offset + MARGIN * size;
        let low = ((bounds.z_min - margin) / step).floor() * step;
        let high = ((bounds.z_max + margin) / step).ceil() * step;
        let side = ((bounds.r_max + margin) / step).ceil() * step;
        Some(Self {
            low: -low,
            high: high - 1.0,
            side: side - object.profile.radius,
        })
    }

    /// Returns true if the box is the profile's own.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Height of the grown box, object units.
    pub fn height(&self) -> f64 {
        1.0 + self.low + self.high
    }

    fn profile(&self, profile: &Profile) -> Profile {
        let scale = 1.0 / self.height();
        let moved = |p: &DVec2| (*p + DVec2::new(0.0, self.low)) * scale;
        let loops = profile.outline.loops.iter();
        Profile {
            outline: Outline {
                loops: loops.map(|l| l.iter().map(moved).collect()).collect(),
            },
            radius: (profile.radius + self.side) * scale,
            raster: profile.raster.as_ref().map(|raster| self.raster(raster)),
            warnings: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The picture with empty pixels around it.
    fn raster(&self, raster: &Raster) -> Raster {
        let pixels = |length: f64| (length * f64::from(raster.rows)).round() as u32;
        let columns = raster.columns + pixels(self.side);
        let mut coverage = vec![0.0; (pixels(self.high) * columns) as usize];
        for row in raster.coverage.chunks_exact(raster.columns as usize) {
            coverage.extend_from_slice(row);
            coverage.resize(coverage.len() + pixels(self.side) as usize, 0.0);
        }
        coverage.resize(coverage.len() + (pixels(self.low) * columns) as usize, 0.0);
        Raster {
            columns,
            rows: raster.rows + pixels(self.low) + pixels(self.high),
            coverage,
        }
    }

    fn offset(&self, offset: &Offset) -> Offset {
        let scale = 1.0 / self.height();
        if offset.chamfer + self.high <= 0.0 {
            // All of a box that has shrunk is deeper than the chamfer.
            return Offset {
                extend: (offset.extend + offset.bevel * offset.chamfer) * scale,
                bevel: 0.0,
                chamfer: offset.chamfer,
            };
        }
        Offset {
            extend: (offset.extend - offset.bevel * self.high) * scale,
            bevel: offset.bevel,
            chamfer: (offset.chamfer + self.high) * scale,
        }
    }

    /// The placement of the grown box that leaves the solid at `placement`.
    pub fn placement(&self, placement: &Placement) -> Placement {
        let down = DVec3::new(0.0, 0.0, -self.low * placement.scale.z);
        Placement {
            position: placement.position + placement.rotation.normalize() * down,
            rotation: placement.rotation,
            scale: placement.scale * self.height(),
        }
    }
}

/// An object in a grown box.
#[derive(Clone, Debug)]
pub struct GrownObject {
    /// The solid in units of the grown box.
    pub object: Object,
    /// Enlargement of the box.
    pub growth: Growth,
}

impl GrownObject {
    /// The same solid with the placements of `object`, which are those of a box that has not grown.
    pub fn placed_as(&self, object: &Object) -> Self {
        let of = |p: &Placement| self.growth.placement(p);
        Self {
            object: Object {
                placement: of(&object.placement),
                instances: object.instances.iter().map(of).collect(),
                ..self.object.clone()
            },
            growth: self.growth,
        }
    }
}

/// Cache of grown profiles, one for each profile and growth in use.
#[derive(Debug, Default)]
pub struct GrownProfiles {
    /// The key has the profile's address; the weak reference in the value prevents reuse of the
    /// address.
    known: HashMap<(usize, [u64; 3]), [Weak<Profile>; 2]>,
}

impl GrownProfiles {
    /// `object` in a box that cuts nothing off it; `None` if it keeps its own box.
    pub fn grown(&mut self, object: &Object) -> Option<GrownObject> {
        let growth = Growth::of(object);
        if growth.is_none() {
            return None;
        }
        let numbers = [growth.low, growth.high, growth.side].map(f64::to_bits);
        let key = (Arc::as_ptr(&object.profile) as usize, numbers);
        let known = self.known.get(&key).and_then(|[_, grown]| grown.upgrade());
        let profile = known.unwrap_or_else(|| {
            self.known.retain(|_, [_, grown]| grown.strong_count() > 0);
            let grown = Arc::new(growth.profile(&object.profile));
            let weak = [Arc::downgrade(&object.profile), Arc::downgrade(&grown)];
            self.known.insert(key, weak);
            grown
        });
        let axis = object.axis.map(|o| {
            let scale = 1.0 / growth.height();
            let place = (2.0 * o - 1.0) * object.profile.radius * scale;
            0.5 * (place / profile.radius + 1.0)
        });
        let drawn = Object {
            profile,
            offset: growth.offset(&object.offset),
            axis,
            ..object.clone()
        };
        let unplaced = GrownObject {
            object: drawn,
            growth,
        };
        Some(unplaced.placed_as(object))
    }
}
