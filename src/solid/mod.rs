//! A prepared solid: all data made from one outline under an offset, and its extent in its box. No
//! module here records Vulkan commands.

pub(crate) mod cache;
pub(crate) mod contour;
pub(crate) mod offset_surface;
pub(crate) mod proxy_hull;
pub(crate) mod tables;

use crate::scene::Object;

/// The radius that the map must cover. The result is the box's half side if the solid stays within
/// the box's inscribed cylinder about a centred axis. Otherwise the radius covers the part of the
/// solid that the box can hold.
pub(crate) fn reach(object: &Object, margin: f64) -> f64 {
    let radius = object.profile.radius;
    let solid = object.widest();
    if solid <= radius && object.axis_offset() == [0.0; 2] {
        return radius;
    }
    (solid + margin).min(farthest_corner(object)).max(radius)
}

/// Distance from the axis to the farthest vertical edge of the box.
pub(crate) fn farthest_corner(object: &Object) -> f64 {
    let [x, y] = object.axis_offset().map(f64::abs);
    (x + object.profile.radius).hypot(y + object.profile.radius)
}
