//! Tolerances in pixels of a picture.

use glam::DVec3;
use revmap::scene::{Camera, Growth, Object, Placement};

/// The length in object units that is as long as `pixels` in the middle of a picture of `rows` rows,
/// on the copy of `object` where that is the shortest.
///
/// Copies are `distance` world units away from the eye; without one, each is as far as the nearest
/// point of its box. `None` if the eye is within a box, or if the lengths are not numbers above 0.
#[must_use]
pub fn pixel_tolerance(
    object: &Object,
    camera: &Camera,
    rows: u32,
    pixels: f64,
    distance: Option<f64>,
) -> Option<f64> {
    let a_pixel = 2.0 * (0.5 * camera.fov_y.to_radians()).tan() / f64::from(rows);
    let growth = Growth::of(object);
    let side = object.profile.radius + growth.side;
    let low = DVec3::new(-side, -side, -growth.low);
    let high = DVec3::new(side, side, 1.0 + growth.high);
    let length = |copy: &Placement| {
        // The eye in the axes of the copy, whose box is scaled.
        let eye = copy.rotation.normalize().inverse() * (camera.eye - copy.position);
        let [a, b] = [low, high].map(|corner| corner * copy.scale);
        let away = || eye.distance(eye.clamp(a.min(b), a.max(b)));
        distance.unwrap_or_else(away) / copy.scale.abs().max_element()
    };
    let nearest = object.placements().iter().map(length);
    let tolerance = pixels * a_pixel * nearest.fold(f64::INFINITY, f64::min);
    (tolerance > 0.0 && tolerance.is_finite()).then_some(tolerance)
}
