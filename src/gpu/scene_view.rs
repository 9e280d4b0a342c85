//! The view of a scene's camera.

use crate::error::Result;
use crate::plan::View;
use crate::scene::{CameraFrame, Cluster, Growth, Placement, Scene};
use glam::DVec3;
use std::f64::consts::SQRT_2;

/// The view of a scene's camera, with a depth range that contains every box.
pub(crate) fn view_of(scene: &Scene, size: (u32, u32)) -> Result<View> {
    let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
    View::from_camera(&scene.camera, size, depth_range(scene, &camera))
}

/// The depth range that contains every box; near is never closer than a ten-thousandth of far.
fn depth_range(scene: &Scene, camera: &CameraFrame) -> [f64; 2] {
    let mut low = f64::INFINITY;
    let mut high: f64 = 0.0;
    for object in &scene.objects {
        // Corners of hulls extend a little beyond the box, corners of convex hulls by some texels
        // more.
        let growth = Growth::of(object);
        let radius = 1.04 * (object.profile.radius + growth.side) + 0.02;
        let half = DVec3::new(radius, radius, 0.5 * growth.height() + 0.002);
        let middle_z = 0.5 * (1.0 + growth.high - growth.low);
        let range = |p: &Placement| {
            let middle = p.position + p.rotation * (p.scale * DVec3::new(0.0, 0.0, middle_z));
            let depth = (middle - camera.eye).dot(camera.forward);
            let reach = (p.rotation.conjugate() * camera.forward * p.scale)
                .abs()
                .dot(half);
            [depth - reach, depth + reach]
        };
        let farthest = [radius * SQRT_2, middle_z.abs() + half.z];
        let of = |cluster: &Cluster| cluster.around(camera.eye, farthest).along(camera.forward);
        low = low.min(object.least_of_copies(|c| of(c)[0], |p| range(p)[0]));
        high = high.max(-object.least_of_copies(|c| -of(c)[1], |p| -range(p)[1]));
    }
    if high <= 0.0 {
        return [1.0, 2.0];
    }
    let far = high * 1.001;
    [(low * 0.999).max(far * 1e-4), far]
}
