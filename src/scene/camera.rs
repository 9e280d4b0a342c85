//! Converts pixels to ray directions; the GPU's block and the reference share this code.

use super::{Camera, Cluster, Growth, Object, Placement, Scene};
use crate::error::{Error, ErrorKind, Result, content};
use glam::{DVec2, DVec3};
use std::f64::consts::SQRT_2;

/// The rays of a camera for pictures of one size.
///
/// Let `f = normalize(target - eye)`, `right = normalize(f x up)` and `up' = right x f`. The ray
/// through the centre of pixel `(i, j)` is `eye + t (f + x right + y up')`, with
/// `x = (2 (i + 1/2) / w - 1) tan(fov/2) w/h`, `y = (1 - 2 (j + 1/2) / h) tan(fov/2)`. The
/// direction is not normalised: `t` is the depth along `f`. Pixels are square, so `right` and `up`
/// are stored multiplied by the width of a pixel at depth 1, `2 tan(fov/2) / h`. A pixel's position
/// is the number of such steps from the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFrame {
    /// The eye, world units.
    pub eye: DVec3,
    /// Unit vector towards the target.
    pub forward: DVec3,
    /// Step of one pixel to the right, at depth 1.
    pub right: DVec3,
    /// Step of one pixel up, at depth 1.
    pub up: DVec3,
    /// The point of the picture in the view direction, in pixels from its upper left corner:
    /// `(w / 2, h / 2)` less the [shift](Camera::shift).
    pub middle: [f64; 2],
}

impl CameraFrame {
    /// The rays of `camera` for pictures of `width x height` pixels.
    ///
    /// If `up` points along the view, world y replaces it (or else world x), so a camera may look
    /// straight down.
    ///
    /// # Errors
    /// [`ErrorKind::Content`], with the key, if eye and target are one point, the field of view is
    /// not between 0 and 180 degrees, `up` is zero, or a number is not finite. [`ErrorKind::Usage`]
    /// if a side of the picture is 0.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Result<Self> {
        for (key, value) in [
            ("camera.eye", camera.eye),
            ("camera.target", camera.target),
            ("camera.up", camera.up),
        ] {
            if !value.is_finite() {
                return content(key, "is not finite; give three numbers");
            }
        }
        let fov = camera.fov_y;
        if !(fov > 0.0 && fov < 180.0) {
            let message = format!("is {fov:?} degrees; give more than 0 and less than 180");
            return content("camera.fov_y", message);
        }
        if width == 0 || height == 0 {
            let message = format!("a picture of {width}x{height} has no pixels; give at least 1x1");
            return Err(Error::new(ErrorKind::Usage, message));
        }
        if !camera.shift.iter().all(|s| s.is_finite()) {
            return content("camera.shift", "is not finite; give two numbers");
        }
        let Some(forward) = (camera.target - camera.eye).try_normalize() else {
            return content(
                "camera.target",
                "is where the eye is; look at some other point",
            );
        };
        let Some(up) = camera.up.try_normalize() else {
            return content("camera.up", "has no length; [0, 0, 1] is usual");
        };
        let right = [up, DVec3::Y, DVec3::X]
            .into_iter()
            .map(|up| forward.cross(up))
            .find(|side| side.length() > 1e-9)
            .map_or(DVec3::X, DVec3::normalize);
        let pixel = 2.0 * (camera.fov_y.to_radians() * 0.5).tan() / f64::from(height);
        Ok(Self {
            eye: camera.eye,
            forward,
            right: right * pixel,
            up: right.cross(forward) * pixel,
            middle: [
                f64::from(width) * 0.5 - camera.shift[0],
                f64::from(height) * 0.5 - camera.shift[1],
            ],
        })
    }

    /// Direction through the point `(x, y)` of the picture, in pixels from its upper left corner;
    /// depth 1 along `forward`.
    #[must_use]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.forward + self.right * (x - self.middle[0]) + self.up * (self.middle[1] - y)
    }

    /// Direction through the centre of pixel `(i, j)`.
    #[must_use]
    pub fn pixel(&self, i: u32, j: u32) -> DVec3 {
        self.direction(f64::from(i) + 0.5, f64::from(j) + 0.5)
    }

    /// The depth range that contains every box and hull before the eye; near is never closer than a
    /// ten-thousandth of far.
    pub(crate) fn depth_range(&self, scene: &Scene) -> [f64; 2] {
        let mut low = f64::INFINITY;
        let mut high: f64 = 0.0;
        for object in &scene.objects {
            // Corners of hulls extend a little beyond the box, corners of convex hulls by some texels
            // more.
            let growth = Growth::of(object);
            let side = object.profile.radius + growth.side;
            // The hull of a solid that its box cuts holds all of the solid.
            let shift = DVec2::from(object.axis_offset()).abs().max_element();
            let whole = object.widest().min(Object::WIDEST * side) + shift;
            let radius = 1.04 * whole.max(side) + 0.02;
            let half = DVec3::new(radius, radius, 0.5 * growth.height() + 0.002);
            let middle_z = 0.5 * (1.0 + growth.high - growth.low);
            let range = |p: &Placement| {
                let middle = p.position + p.rotation * (p.scale * DVec3::new(0.0, 0.0, middle_z));
                let depth = (middle - self.eye).dot(self.forward);
                let reach = (p.rotation.conjugate() * self.forward * p.scale)
                    .abs()
                    .dot(half);
                [depth - reach, depth + reach]
            };
            let farthest = [radius * SQRT_2, middle_z.abs() + half.z];
            let of = |cluster: &Cluster| cluster.around(self.eye, farthest).along(self.forward);
            // What is behind the eye must not cost precision.
            let nearest = |[near, far]: [f64; 2]| if far > 0.0 { near } else { f64::INFINITY };
            low = low.min(object.least_of_copies(|c| nearest(of(c)), |p| nearest(range(p))));
            high = high.max(-object.least_of_copies(|c| -of(c)[1], |p| -range(p)[1]));
        }
        if high <= 0.0 {
            return [1.0, 2.0];
        }
        let far = high * 1.001;
        [(low * 0.999).max(far * 1e-4), far]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            eye: DVec3::new(1.6, 0.3, 1.1),
            target: DVec3::new(0.0, 0.0, 0.5),
            up: DVec3::Z,
            fov_y: 40.0,
            shift: [0.0; 2],
            ray_width: 1.0,
        }
    }

    #[test]
    fn pixels_are_where_the_formula_says() {
        let (w, h) = (800, 600);
        let frame = CameraFrame::new(&camera(), w, h).unwrap();
        let c = camera();
        let forward = (c.target - c.eye).normalize();
        let right = forward.cross(c.up).normalize();
        let up = right.cross(forward);
        let tan = 20f64.to_radians().tan();
        for (i, j) in [(0, 0), (799, 0), (0, 599), (400, 300), (123, 456)] {
            let x = (2.0 * (f64::from(i) + 0.5) / 800.0 - 1.0) * tan * 800.0 / 600.0;
            let y = (1.0 - 2.0 * (f64::from(j) + 0.5) / 600.0) * tan;
            let expected = forward + right * x + up * y;
            assert!((frame.pixel(i, j) - expected).length() < 1e-14);
            assert!((frame.pixel(i, j).dot(frame.forward) - 1.0).abs() < 1e-14);
        }
        assert_eq!(frame.direction(400.0, 300.0), frame.forward);
        // Row 0 is on top, column 0 on the left.
        assert!(frame.pixel(400, 0).z > frame.pixel(400, 599).z);
        assert!((frame.pixel(799, 300) - frame.pixel(0, 300)).dot(right) > 0.0);
    }

    #[test]
    fn looking_along_up_still_gives_a_frame() {
        let looking = |eye, target, up| Camera {
            eye,
            target,
            up,
            ..camera()
        };
        for up in [DVec3::Z, -3.0 * DVec3::Z, DVec3::new(1e-13, 0.0, 1.0)] {
            let c = looking(3.0 * DVec3::Z, DVec3::ZERO, up);
            let frame = CameraFrame::new(&c, 64, 64).unwrap();
            assert!(frame.pixel(3, 60).is_finite());
            let (right, up) = (frame.right, frame.up);
            assert!(right.length() > 0.0 && up.dot(DVec3::Y) > 0.0, "{frame:?}");
        }
        let c = looking(DVec3::ZERO, DVec3::Y, DVec3::Y);
        assert!(CameraFrame::new(&c, 64, 64).unwrap().right.length() > 0.0);
    }

    #[test]
    fn impossible_cameras_are_named() {
        type Case = (&'static str, fn(&mut Camera));
        let cases: [Case; 9] = [
            ("target", |c| c.target = c.eye),
            ("fov_y", |c| c.fov_y = 0.0),
            ("fov_y", |c| c.fov_y = 180.0),
            ("fov_y", |c| c.fov_y = f64::NAN),
            ("up", |c| c.up = DVec3::ZERO),
            ("up", |c| c.up = DVec3::NAN),
            ("eye", |c| c.eye = DVec3::INFINITY),
            ("target", |c| c.target = DVec3::NAN),
            ("shift", |c| c.shift[1] = f64::NAN),
        ];
        for (key, spoil) in cases {
            let mut camera = camera();
            spoil(&mut camera);
            let error = CameraFrame::new(&camera, 8, 8).unwrap_err();
            assert_eq!(error.key, Some(format!("camera.{key}")));
        }
        assert_eq!(
            CameraFrame::new(&camera(), 0, 8).unwrap_err().kind,
            ErrorKind::Usage
        );
    }
}
