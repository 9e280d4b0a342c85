//! How far a solid reaches, by the circles that its outline's points run on.

use glam::{DVec2, DVec3};
use revmap::scene::{GrownProfiles, Object, Placement};
use revmap::surface::ContourSource;

/// The hull of an object's solid, offset included, about its own axis.
///
/// Where a face of the box or of a cell cuts the solid, the reach along a slanted direction may be
/// that of the part that is cut off. Along the axis it is exact.
pub struct Extent<'a> {
    object: &'a Object,
    /// Radius and height of the circles, object units.
    circles: Vec<DVec2>,
    /// Radius of the box, and heights of its faces.
    radius: f64,
    heights: [f64; 2],
}

impl<'a> Extent<'a> {
    /// The extent of an object in its own units. It has no circles if the offset leaves nothing, or
    /// for a profile that is not drawn either.
    #[must_use]
    pub fn of(object: &'a Object) -> Self {
        let grown = GrownProfiles::default().grown(object);
        let growth = grown.as_ref().map(|g| g.growth).unwrap_or_default();
        let drawn = grown.as_ref().map_or(object, |g| &g.object);
        let contour = ContourSource::new(&drawn.profile.outline)
            .and_then(|source| source.contour(&drawn.offset))
            .unwrap_or_default();
        // From units of the grown box to those of the object.
        let own = |p: &DVec2| *p * growth.height() - DVec2::new(0.0, growth.low);
        let chains = contour.chains.iter();
        Self {
            object,
            circles: hull(chains.flat_map(|c| c.points.iter().map(own)).collect()),
            radius: object.profile.radius + growth.side,
            heights: [-growth.low, 1.0 + growth.high],
        }
    }

    /// The largest coordinate along `axis` of the copy at `place`, world units; minus infinity for
    /// a solid of which nothing is left.
    #[must_use]
    pub fn reach(&self, place: &Placement, axis: DVec3) -> f64 {
        let v = place.rotation.conjugate() * axis * place.scale;
        let cells = self.object.repeat.map(f64::from);
        let part = v / DVec3::from(cells);
        let [low, high] = self.heights;
        let upwards = |v: f64| if v > 0.0 { v * high } else { v * low };
        let of_box = self.radius * (v.x.abs() + v.y.abs()) + upwards(v.z);
        // The axes of the cells.
        let beside = |k: usize| {
            let place = |(cell, mirrored): (f64, bool)| {
                let axis = self.object.axis[k];
                let axis = if mirrored { 1.0 - axis } else { axis };
                (2.0 * (cell + axis) - cells[k]) * part[k] * self.object.profile.radius
            };
            largest(self.ends(k).map(place))
        };
        let around = DVec2::new(part.x, part.y).length();
        let of_layer = |(cell, mirrored): (f64, bool)| {
            let (from, sense) = if mirrored { (1.0, -1.0) } else { (0.0, 1.0) };
            let circle = |p: &DVec2| p.x * around + (cell + from + sense * p.y) * part.z;
            largest(self.circles.iter().map(circle))
        };
        let solid = beside(0) + beside(1) + largest(self.ends(2).map(of_layer));
        place.position.dot(axis) + solid.min(of_box)
    }

    /// Height of the flat face on top of an upright copy, and its radius about the object's axis,
    /// world units. `None` for replicas, and for a copy that is turned over or has a round or
    /// pointed top.
    pub(super) fn top(&self, place: &Placement) -> Option<[f64; 2]> {
        let upright = (place.rotation * DVec3::Z).z > 1.0 - 1e-9;
        let last = self
            .circles
            .last()
            .filter(|_| upright && self.object.repeat == [1; 3])?;
        let flat = self.circles.iter().filter(|p| last.y - p.y < 1e-6);
        let radius = flat.map(|p| p.x).fold(0.0, f64::max);
        let scale = place.scale.x.min(place.scale.y);
        (radius > 0.0).then(|| [self.reach(place, DVec3::Z), radius * scale])
    }

    /// The cells at both ends of a row along an axis of the box, and whether they are mirrored.
    fn ends(&self, k: usize) -> impl Iterator<Item = (f64, bool)> {
        let (count, mirror) = (self.object.repeat[k], self.object.mirror[k]);
        let at_end = move |n: &u32| *n < 2 || n + 2 >= count;
        let all = (0..count).filter(at_end);
        all.map(move |n| (f64::from(n), mirror && n % 2 == 1))
    }
}

/// Lifts or lowers every copy of an object until its lowest point is at the height of its position.
pub(super) fn stand(object: &mut Object) {
    let extent = Extent::of(object);
    let standing = |place: &Placement| {
        let lowest = -extent.reach(place, -DVec3::Z);
        let mut place = *place;
        if lowest.is_finite() {
            place.position.z -= lowest - place.position.z;
        }
        place
    };
    let placement = standing(&object.placement);
    let instances = object.instances.iter().map(standing).collect();
    (object.placement, object.instances) = (placement, instances);
}

fn largest(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(f64::NEG_INFINITY, f64::max)
}

/// The points of the convex hull that face away from the axis, in the order of their heights
/// (Andrew's chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
    let mut hull: Vec<DVec2> = Vec::new();
    for p in points {
        while let [.., a, b] = hull[..]
            && (b - a).perp_dot(p - b) <= 0.0
        {
            hull.pop();
        }
        hull.push(p);
    }
    hull
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DQuat;
    use revmap::profile::Profile;
    use revmap::scene::Clip;
    use std::sync::Arc;

    /// A cone on a page with a margin: its foot is a circle of radius 0.4 at the height 0.2.
    fn cone() -> Object {
        let corners = [[0.0, 0.2], [0.4, 0.2], [0.1, 0.9], [0.0, 0.9]];
        let mut cone = Object::new("cone", Arc::new(Profile::polygon(&corners, 0.5).unwrap()));
        cone.placement.scale = DVec3::new(1.0, 1.0, 2.0);
        cone
    }

    fn lowest(change: impl Fn(&mut Object)) -> f64 {
        let mut object = cone();
        change(&mut object);
        -Extent::of(&object).reach(&object.placement, -DVec3::Z)
    }

    #[track_caller]
    fn near(found: f64, wanted: f64) {
        assert!((found - wanted).abs() < 1e-6, "{found} for {wanted}");
    }

    #[test]
    fn the_lowest_point_is_that_of_the_solid() {
        near(lowest(|_| ()), 0.4);
        near(lowest(|o| o.placement.position.z = 3.0), 3.4);
        let about = DQuat::from_rotation_x(1.0);
        let rim = about * DVec3::new(0.0, -0.4, 0.4);
        near(lowest(|o| o.placement.rotation = about), rim.z);
        let down = DQuat::from_rotation_x(std::f64::consts::PI);
        near(lowest(|o| o.placement.rotation = down), -1.8);
        near(lowest(|o| o.offset.extend = 0.5), -0.6);
        // An inset moves a corner farther than its faces.
        near(lowest(|o| o.offset.extend = -0.05), 0.5);
        near(
            lowest(|o| (o.offset.extend, o.clip) = (0.5, Clip::Box)),
            0.0,
        );
        assert_eq!(lowest(|o| o.offset.extend = -0.6), f64::INFINITY);
    }

    #[test]
    fn every_copy_stands_at_its_own_height() {
        let mut object = cone();
        let copies = (0..5).map(|n| Placement {
            position: DVec3::new(0.0, 0.0, f64::from(n)),
            rotation: DQuat::from_rotation_y(0.7 * f64::from(n)),
            scale: DVec3::new(1.0, 2.0, 0.5 + f64::from(n)),
        });
        object.instances = copies.collect();
        stand(&mut object);
        for (n, place) in object.instances.iter().enumerate() {
            near(-Extent::of(&object).reach(place, -DVec3::Z), n as f64);
        }
        assert_eq!(Extent::of(&object).top(&object.instances[1]), None);
        let [height, radius] = Extent::of(&object).top(&object.instances[0]).unwrap();
        near(height, 0.35);
        near(radius, 0.1);
    }

    #[test]
    fn replicas_reach_as_far_as_their_outer_cells() {
        let repeated = |o: &mut Object| o.repeat = [3, 1, 4];
        near(lowest(repeated), 0.1);
        let mirrored = |o: &mut Object| (o.repeat, o.mirror) = ([1, 1, 2], [false, false, true]);
        near(lowest(mirrored), 0.2);
        let mut object = cone();
        (object.repeat, object.mirror, object.axis) = ([2, 1, 1], [true, false, false], [0.4, 0.5]);
        let extent = Extent::of(&object);
        // Axes at -0.3 and 0.3; each solid is half as wide.
        near(extent.reach(&object.placement, DVec3::X), 0.5);
        near(extent.reach(&object.placement, DVec3::Y), 0.4);
        object.mirror = [false; 3];
        near(Extent::of(&object).reach(&object.placement, -DVec3::X), 0.5);
        near(Extent::of(&object).reach(&object.placement, DVec3::X), 0.4);
    }
}
