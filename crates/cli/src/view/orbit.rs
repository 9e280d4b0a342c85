//! Camera control by the pointer: the left button turns it about its target, the middle or right
//! one shifts both, the wheel moves it nearer.

use glam::{DQuat, DVec3};
use revmap::scene::Camera;

/// Radians of a turn for each pixel.
const TURN: f64 = 0.008;
/// The smallest angle between the view and the upright, radians.
const UPRIGHT: f64 = 0.02;
/// Factor of the distance per step of the wheel.
const STEP: f64 = 0.9;

/// Turns the camera about its target, for a drag in pixels to the right and down.
pub fn turn(camera: &mut Camera, [right, down]: [f64; 2]) {
    let up = camera.up.normalize_or(DVec3::Z);
    let from = camera.eye - camera.target;
    let across = up.cross(from).normalize_or(DVec3::X);
    let angle = from.angle_between(up);
    let least = UPRIGHT.min(angle);
    let most = (std::f64::consts::PI - UPRIGHT).max(angle);
    let lower = (angle - TURN * down).clamp(least, most) - angle;
    let turned = DQuat::from_axis_angle(up, -TURN * right) * DQuat::from_axis_angle(across, lower);
    camera.eye = camera.target + turned * from;
}

/// Shifts the camera and its target so that the point at the target follows the pointer. `height`
/// is that of the picture in pixels.
pub fn shift(camera: &mut Camera, [right, down]: [f64; 2], height: f64) {
    let from = camera.eye - camera.target;
    let forward = -from.normalize_or(DVec3::X);
    let across = forward.cross(camera.up).normalize_or(DVec3::Y);
    let upwards = across.cross(forward);
    let pixel = 2.0 * (camera.fov_y.to_radians() * 0.5).tan() * from.length() / height.max(1.0);
    let by = (upwards * down - across * right) * pixel;
    camera.eye += by;
    camera.target += by;
}

/// Moves the camera nearer by `steps` of the wheel, or farther.
pub fn zoom(camera: &mut Camera, steps: f64) {
    let from = camera.eye - camera.target;
    let distance = (from.length() * STEP.powf(steps)).clamp(1e-3, 1e6);
    camera.eye = camera.target + from.normalize_or(DVec3::X) * distance;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5))
    }

    #[test]
    fn turning_keeps_the_distance_and_stays_off_the_upright() {
        let mut turned = camera();
        turn(&mut turned, [100.0, 0.0]);
        assert!(
            (turned.eye.z - 0.5).abs() < 1e-12 && turned.eye.y < -1.0,
            "{turned:?}"
        );
        // A downward drag makes the camera look from above.
        turn(&mut turned, [0.0, 50.0]);
        assert!(turned.eye.z > 1.0);
        turn(&mut turned, [0.0, 1e6]);
        let from = turned.eye - turned.target;
        assert!((from.length() - 2.0).abs() < 1e-9);
        assert!((from.angle_between(DVec3::Z) - UPRIGHT).abs() < 1e-6);
    }

    #[test]
    fn what_is_at_the_target_follows_the_pointer() {
        let (mut shifted, height) = (camera(), 600.0);
        shift(&mut shifted, [0.0, height], height);
        // A drag over a whole picture downwards moves the view up by the height visible at the
        // target.
        let seen = 4.0 * 20f64.to_radians().tan();
        assert!((shifted.target.z - 0.5 - seen).abs() < 1e-9, "{shifted:?}");
        let mut near = camera();
        zoom(&mut near, 1.0);
        assert!((near.eye.x - 2.0 * STEP).abs() < 1e-12);
        zoom(&mut near, -1.0);
        assert!((near.eye - camera().eye).length() < 1e-12);
    }
}
