//! Selection of the objects that can be drawn by proxies of cells.

use super::view::View;
use crate::scene::{Object, Placement};
use crate::solid::offset_surface::OffsetSurface;
use crate::surface::ProxyHull;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Least distance of an eye from a shell, and of a shell from the near plane, in object units.
const CLEARANCE: f64 = 1e-3;

/// The radius up to which the box's sides cut nothing that is seen.
fn uncut_radius(object: &Object, surface: &OffsetSurface) -> f64 {
    let [x, y] = object.axis_offset();
    // The part of a coarse level that bulges beyond the box may be seen.
    object.profile.radius - x.abs().max(y.abs()) + surface.slack()
}

/// True if rays to all of an object's copies begin outside of the solid, and the box cuts nothing
/// of it.
pub(crate) fn is_seen_from_outside(object: &Object, surface: &OffsetSurface, view: &View) -> bool {
    let is_whole = object.repeat == [1; 3] && surface.extent()[0] <= uncut_radius(object, surface);
    is_whole && is_apart_from_all(object, surface, view)
}

/// True if rays to all of an object's copies begin outside of the solid, as it is before its box cuts
/// it.
pub(crate) fn is_apart_from_all(object: &Object, surface: &OffsetSurface, view: &View) -> bool {
    let [r_max, z_min, z_max] = surface.extent();
    let apart = |copy: &Placement| {
        // A ball about the eye, in which rays begin, is clear of the solid's bounding cylinder.
        let far = CLEARANCE + view.farthest_start() / copy.scale.min_element();
        let eye = flat(seen_from(object, copy, view).0);
        eye.x > r_max + far || eye.y < z_min - far || eye.y > z_max + far
    };
    !view.parallel && object.placements().iter().all(apart)
}

/// The eye, relative to the axis, and the direction of sight, both in object space. The depth of a
/// point `p` there is `(p - eye) . forward`.
fn seen_from(object: &Object, placement: &Placement, view: &View) -> (DVec3, DVec3) {
    let [x, y] = object.axis_offset();
    let turn = placement.rotation.conjugate();
    let eye = turn * (view.eye - placement.position) / placement.scale - DVec3::new(x, y, 0.0);
    (eye, turn * view.forward * placement.scale)
}

/// True if cells may pay for an object in a view: it covers enough pixels, and does not fill its
/// box, where most rays enter the box within the solid, and most of the cells would be outside of
/// the box.
pub(crate) fn may_pay(
    object: &Object,
    surface: &OffsetSurface,
    view: &View,
    least_pixels: u32,
) -> bool {
    let least = u64::from(least_pixels) * object.placements().len() as u64;
    let fills_box = surface.extent()[0] > Object::WIDEST * object.profile.radius;
    covered_pixels(object, view) >= least && !fills_box
}

/// The frusta of `object`'s cells: of those that the box's sides cut, and of those that are whole.
/// Returns none unless they show all that the box shows from this camera: the eye is outside all
/// shells, and the near plane cuts none.
/// Returns none also if the object is too small on the screen for its triangles to pay, or if it
/// fills its box.
pub(crate) fn frusta(
    object: &Object,
    surface: &OffsetSurface,
    view: &View,
    least_pixels: u32,
) -> Option<[Vec<Range<u32>>; 2]> {
    let made = surface.hull().filter(|hull| !hull.touches)?;
    if !may_pay(object, surface, view, least_pixels) {
        return None;
    }
    let (hull, copies) = (&made.hull, object.placements());
    let seen: Vec<_> = (copies.iter())
        .map(|copy| seen_from(object, copy, view))
        .collect();
    let eyes: Vec<DVec2> = seen.iter().map(|&(eye, _)| flat(eye)).collect();
    let uncut = uncut_radius(object, surface);
    let cut = hull.runs(|cell| hull.reaches[cell] > uncut);
    // Parallel rays have no common eye, and a cut opens cavities.
    let whole = match view.parallel || !cut.is_empty() {
        true => hull.runs(|cell| hull.reaches[cell] <= uncut),
        false => hull.seen_from(&eyes),
    };
    let frusta = [cut, whole];
    let drawn: usize = frusta.iter().flatten().map(ExactSizeIterator::len).sum();
    let least = u64::from(least_pixels) * (copies.len() * drawn) as u64;
    let pays = covered_pixels(object, view) >= least;
    let in_front = |&of: &(DVec3, DVec3)| is_in_front(hull, of, view);
    (pays && seen.iter().all(in_front)).then_some(frusta)
}

/// A point in the coordinates of the half-plane.
fn flat(p: DVec3) -> DVec2 {
    DVec2::new(p.truncate().length(), p.z)
}

/// True if the eye is in none of a copy's shells, and all of them are in front of the near plane.
fn is_in_front(hull: &ProxyHull, (eye, forward): (DVec3, DVec3), view: &View) -> bool {
    let (aside, nearest) = (forward.truncate(), view.near + CLEARANCE * forward.length());
    let all_ahead = hull.extents.iter().all(|&[_, r, low, high]| {
        let lowest = (forward.z * (low - eye.z)).min(forward.z * (high - eye.z));
        lowest - aside.dot(eye.truncate()) - r * aside.length() >= nearest
    });
    // Parallel rays begin in the near plane, and everything is in front of that plane.
    all_ahead && (view.parallel || hull.clear_of(flat(eye), CLEARANCE))
}

/// Pixels in the rectangles around the boxes of all copies.
fn covered_pixels(object: &Object, view: &View) -> u64 {
    let copies = object.placements().iter();
    let of_copy = |copy| pixels_of_copy(view, object.profile.radius, copy);
    copies.map(of_copy).sum()
}

/// Pixels in the rectangle around a copy's box; 0 if the box is behind the eye or outside of the
/// picture.
fn pixels_of_copy(view: &View, radius: f64, copy: &Placement) -> u64 {
    let corners: [_; 8] = std::array::from_fn(|corner| {
        let side = |bit: usize| [-radius, radius][corner >> bit & 1];
        let p = DVec3::new(side(0), side(1), (corner >> 2) as f64);
        view.project(copy.position + copy.rotation * (copy.scale * p))
    });
    let farthest = corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c.1));
    if farthest <= 0.0 {
        return 0;
    }
    let [mut low, mut high] = view.corners();
    // A box around the eye, or beside it, has no rectangular projection.
    if corners.iter().all(|&(_, depth)| depth > 1e-9 * farthest) {
        low = low.max(corners.iter().fold(DVec2::INFINITY, |m, c| m.min(c.0)));
        high = high.min(corners.iter().fold(DVec2::NEG_INFINITY, |m, c| m.max(c.0)));
    }
    let size = (high - low).max(DVec2::ZERO);
    (size.x * size.y) as u64
}
