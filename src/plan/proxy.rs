//! Selection of the objects that can be drawn by proxies of cells.

use super::view::View;
use crate::scene::{Clip, Object, Placement};
use crate::solid::offset_surface::OffsetSurface;
use crate::surface::ProxyHull;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Least distance of an eye from a shell, and of a shell from the near plane, in object units.
const CLEARANCE: f64 = 1e-3;

/// True if the box shows no more than the boundary's patches: it cuts nothing of the solid and
/// holds no replicas.
pub(crate) fn is_whole(object: &Object, surface: &OffsetSurface) -> bool {
    let radius = object.profile.radius;
    let [x, y] = object.axis_offset();
    let side_face = radius - x.abs().max(y.abs());
    // The part of a coarse level that bulges beyond the box may be seen.
    object.repeat == [1; 3] && surface.extent()[0] <= side_face + surface.slack()
}

/// True if the box's sides cut the solid, or may cut it under another offset.
pub(crate) fn may_be_cut(object: &Object) -> bool {
    let widest = object.profile.outline.bounds().map_or(0.0, |b| b.r_max);
    object.clip == Clip::Box || object.axis_offset() != [0.0; 2] || widest > object.profile.radius
}

/// True if rays to all of an object's copies begin outside of the solid, and the box cuts nothing
/// of it.
pub(crate) fn is_seen_from_outside(object: &Object, surface: &OffsetSurface, view: &View) -> bool {
    !view.parallel && is_whole(object, surface) && is_outside(object, surface, view)
}

fn is_outside(object: &Object, surface: &OffsetSurface, view: &View) -> bool {
    let apart = |copy| is_apart(surface, seen_from(object, copy, view).0);
    object.placements().iter().all(apart)
}

/// True if a point of object space, relative to the axis, is clear of the solid's bounding
/// cylinder.
pub(crate) fn is_apart(surface: &OffsetSurface, point: DVec3) -> bool {
    let [r_max, z_min, z_max] = surface.extent();
    let point = flat(point);
    point.x > r_max + CLEARANCE || point.y < z_min - CLEARANCE || point.y > z_max + CLEARANCE
}

/// The eye, relative to the axis, and the direction of sight, both in object space. The depth of a
/// point `p` there is `(p - eye) . forward`.
fn seen_from(object: &Object, placement: &Placement, view: &View) -> (DVec3, DVec3) {
    let [x, y] = object.axis_offset();
    let turn = placement.rotation.conjugate();
    let eye = turn * (view.eye - placement.position) / placement.scale - DVec3::new(x, y, 0.0);
    (eye, turn * view.forward * placement.scale)
}

/// Largest ratio of a box's sides, in the world, at which hulls are drawn. Hull rays start in the
/// plane through the box's middle. In a flat box that is up to this many heights from their hit.
/// The error is 32 roundings of 2^-24 each, times the 8 of a root: a twelfth of a texel.
const LOPSIDED: f64 = 32.0;

/// True if a copy's box, twice `radius` wide, is too flat or too slender for its hull.
pub(crate) fn is_lopsided(radius: f64, copy: &Placement) -> bool {
    let sides = copy.scale * DVec3::new(2.0 * radius, 2.0 * radius, 1.0);
    sides.max_element() > LOPSIDED * sides.min_element()
}

/// Largest width of shells that a box's sides cut, over half the box's side. Interpolated depths
/// are too rough for triangles that reach far beyond their visible part. Shells 60 times as wide as
/// the box lost a pixel.
const WIDEST_CUT: f64 = 8.0;

/// Number of copies that are sampled to estimate how much of the screen all copies cover.
const SAMPLES: usize = 64;

/// The frusta of `object`'s cells, and true if the box's sides cut the object. Returns none unless
/// the frusta show all that the box shows from this camera: the eye is outside all shells, and the
/// near plane cuts none. Returns none also if the object is too small on the screen for its
/// triangles to pay.
pub(crate) fn frusta(
    object: &Object,
    surface: &OffsetSurface,
    view: &View,
    least_pixels: u32,
) -> Option<(Vec<Range<u32>>, bool)> {
    if object.repeat != [1; 3] {
        return None;
    }
    let cut = !is_whole(object, surface);
    let hull = &surface.hull().hull;
    let copies = object.placements();
    if cut && hull.extent()[1] > WIDEST_CUT * object.profile.radius {
        return None;
    }
    if surface.hull().touches
        || copies
            .iter()
            .any(|copy| is_lopsided(object.profile.radius, copy))
    {
        return None;
    }
    let sampled = copies.iter().step_by(copies.len().div_ceil(SAMPLES).max(1));
    let count = sampled.len().max(1);
    let covered: u64 = sampled
        .clone()
        .filter_map(|copy| rectangle(view, object.profile.radius, copy))
        .map(Rectangle::area)
        .sum();
    let eyes: Vec<DVec2> = sampled
        .map(|copy| flat(seen_from(object, copy, view).0))
        .collect();
    // Parallel rays have no common eye, and a cut opens cavities.
    let frusta = if eyes.len() == copies.len() && !view.parallel && !cut {
        hull.seen_from(&eyes)
    } else {
        std::iter::once(0..hull.frusta.len() as u32).collect()
    };
    let drawn: usize = frusta.iter().map(ExactSizeIterator::len).sum();
    if covered < u64::from(least_pixels) * (drawn * count) as u64 {
        return None;
    }
    let seen = |copy| is_in_front(object, hull, seen_from(object, copy, view), view, cut);
    copies.iter().all(seen).then_some((frusta, cut))
}

/// A point in the coordinates of the half-plane.
fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.truncate().length(), p.z)
}

/// True if the eye is in none of a copy's shells and the drawn part of them is in front of the near
/// plane. The drawn part is everything, or the part between the box's sides.
fn is_in_front(
    object: &Object,
    hull: &ProxyHull,
    (eye, forward): (DVec3, DVec3),
    view: &View,
    cut: bool,
) -> bool {
    let ahead = |middle: DVec2, reach: f64, low: f64, high: f64| {
        let lowest = (forward.z * (low - eye.z)).min(forward.z * (high - eye.z));
        let across = forward.truncate().dot(middle - eye.truncate()) - reach;
        lowest + across >= view.near + CLEARANCE * forward.length()
    };
    if cut {
        let radius = object.profile.radius;
        let [_, _, low, high] = hull.extent();
        let reach = radius * (forward.x.abs() + forward.y.abs());
        let middle = -DVec2::from(object.axis_offset());
        return ahead(middle, reach, low, high);
    }
    let aside = forward.truncate().length();
    let all_ahead = hull
        .extents
        .iter()
        .all(|&[_, r, low, high]| ahead(DVec2::ZERO, r * aside, low, high));
    // Parallel rays begin in the near plane, and everything is in front of that plane.
    all_ahead && (view.parallel || hull.clear_of(flat(eye), CLEARANCE))
}

/// A rectangle of pixels, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Rectangle {
    low: (u32, u32),
    high: (u32, u32),
}

impl Rectangle {
    /// Number of pixels.
    fn area(self) -> u64 {
        u64::from(self.high.0 - self.low.0 + 1) * u64::from(self.high.1 - self.low.1 + 1)
    }
}

/// The pixels that a box may touch. Returns none if the box is behind the eye or outside of the
/// picture.
fn rectangle(view: &View, radius: f64, placement: &Placement) -> Option<Rectangle> {
    // Pixel and depth are linear except for one division. The linear part is computed for the
    // middle and for half of each side, not for each corner.
    let rows = [view.dir_x, view.dir_y].map(|d| d / d.length_squared());
    let from = rows.map(|row| {
        0.5 - if view.parallel {
            0.0
        } else {
            row.dot(view.dir_00)
        }
    });
    let rows = [rows[0], rows[1], view.forward];
    let Placement {
        position,
        rotation,
        scale,
    } = *placement;
    let up = rotation * DVec3::new(0.0, 0.0, 0.5 * scale.z);
    let sides = [
        rotation * DVec3::new(radius * scale.x, 0.0, 0.0),
        rotation * DVec3::new(0.0, radius * scale.y, 0.0),
        up,
    ]
    .map(|side| rows.map(|row| row.dot(side)));
    let middle = rows.map(|row| row.dot(position + up - view.eye));
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    let mut farthest = f64::NEG_INFINITY;
    for corner in 0..8 {
        let sign = |bit: u32| if corner & (1 << bit) == 0 { -1.0 } else { 1.0 };
        let along = |k: usize| {
            let ways = (0u32..).zip(&sides);
            ways.fold(middle[k], |sum, (bit, side)| sum + sign(bit) * side[k])
        };
        let depth = along(2);
        let over = if view.parallel { 1.0 } else { depth };
        let pixel = DVec2::new(along(0) / over + from[0], along(1) / over + from[1]);
        nearest = nearest.min(depth);
        farthest = farthest.max(depth);
        low = low.min(pixel);
        high = high.max(pixel);
    }
    if farthest <= 0.0 {
        return None;
    }
    let [corner, full] = view.corners();
    if nearest <= 1e-9 * farthest {
        // A box around the eye, or beside it, has no rectangular projection.
        (low, high) = (corner, full);
    }
    low = (low - 1.0).max(corner);
    high = (high + 1.0).min(full - 1.0);
    if low.x > high.x || low.y > high.y || !(low.is_finite() && high.is_finite()) {
        return None;
    }
    Some(Rectangle {
        low: (low.x as u32, low.y as u32),
        high: (high.x as u32, high.y as u32),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::Camera;
    use glam::DQuat;

    #[test]
    fn a_rectangle_holds_the_corners_of_its_box() {
        let camera = Camera::new(DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.0, 0.0, 0.4));
        let view = View::from_camera(&camera, (640, 480), [0.1, 100.0]).unwrap();
        for turn in 0..20 {
            let turn = f64::from(turn);
            let copy = Placement {
                position: DVec3::new(0.05 * turn - 0.5, 0.3, -0.2),
                rotation: DQuat::from_rotation_y(0.3 * turn) * DQuat::from_rotation_x(turn),
                scale: DVec3::new(0.5, 0.7, 0.4 + 0.02 * turn),
            };
            let found = rectangle(&view, 0.6, &copy).unwrap();
            let corners = (0..8).map(|k| {
                let side = |bit: u32, low: f64| if k & bit == 0 { low } else { 0.6 };
                let p = DVec3::new(
                    side(1, -0.6),
                    side(2, -0.6),
                    f64::from(u8::from(k & 4 != 0)),
                );
                view.project(copy.position + copy.rotation * (copy.scale * p))
                    .0
            });
            let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
                (a.min(p), b.max(p))
            });
            let grown = [low.x - 1.0, low.y - 1.0, high.x + 1.0, high.y + 1.0];
            let kept = grown.map(|v| v.max(0.0) as u32);
            assert_eq!([kept[0], kept[1]], [found.low.0, found.low.1]);
            assert_eq!(
                [kept[2].min(639), kept[3].min(479)],
                [found.high.0, found.high.1]
            );
        }
    }
}
