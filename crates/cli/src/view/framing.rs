//! The part of the window that the panel leaves free: the scene is centred in it.

use revmap::scene::Camera;
use revmap_files::Picture;

/// Pixels of the window, and those at its left that the panel covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Framing {
    pub window: (u32, u32),
    left: u32,
}

impl Framing {
    /// A panel that covers most of the window covers the picture, too.
    pub fn new(window: (u32, u32), panel: u32) -> Self {
        let left = if panel > window.0 / 3 * 2 { 0 } else { panel };
        Self { window, left }
    }

    /// Pixels of the free part.
    fn free(&self) -> (u32, u32) {
        (self.window.0 - self.left, self.window.1)
    }

    /// The factor by which the picture shrinks: the shorter side of the window over that of the
    /// free part.
    fn shrinking(&self) -> f64 {
        let shorter = |(width, height): (u32, u32)| f64::from(width.min(height).max(1));
        shorter(self.window) / shorter(self.free())
    }

    /// The camera for pictures of the window's size divided by `side`: its target is drawn in the
    /// middle of the free part.
    pub fn camera(&self, camera: &Camera, side: u32) -> Camera {
        let mut framed = *camera;
        let half = (camera.fov_y.to_radians() * 0.5).tan() * self.shrinking();
        framed.fov_y = 2.0 * half.atan().to_degrees();
        framed.shift[0] -= f64::from(self.left) * 0.5 / f64::from(side);
        framed
    }

    /// Width over height of the part of the unframed camera's picture that the free part shows.
    pub fn aspect(&self) -> f64 {
        let (width, _) = self.free();
        self.shrinking() * f64::from(width) / f64::from(self.window.1.max(1))
    }

    /// The height that the field of view of the unframed camera has in the window, pixels.
    pub fn height(&self) -> f64 {
        f64::from(self.window.1) / self.shrinking()
    }

    /// The free part of the window, shown by a picture whose pixels have `side` of the window's
    /// pixels at each side.
    pub fn crop(&self, picture: &Picture, side: u32) -> Picture {
        let (width, height) = self.free();
        let pixel = |n: u32| {
            let (x, y) = ((self.left + n % width) / side, n / width / side);
            picture.rgba[(y * picture.width + x) as usize]
        };
        Picture {
            width,
            height,
            rgba: (0..width * height).map(pixel).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec3;
    use revmap::scene::CameraFrame;

    #[test]
    fn the_target_is_in_the_middle_of_the_free_part() {
        let camera = Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5));
        for (window, panel, middle) in [
            ((1200, 800), 300, 750.0),
            ((800, 600), 300, 550.0),
            ((1200, 800), 0, 600.0),
            ((300, 600), 280, 150.0),
        ] {
            let framing = Framing::new(window, panel);
            let framed = framing.camera(&camera, 1);
            let frame = CameraFrame::new(&framed, window.0, window.1).unwrap();
            assert_eq!(frame.middle, [middle, f64::from(window.1) * 0.5]);
            // A ray at the edge of the shorter side of the window is now at that of the free part.
            let before = CameraFrame::new(&camera, window.0, window.1).unwrap();
            let shorter = |(w, h): (u32, u32)| f64::from(w.min(h));
            let edge = |frame: &CameraFrame, side: f64| frame.up.length() * side;
            let (a, b) = (shorter(window), shorter(framing.free()));
            assert!((edge(&before, a) - edge(&frame, b)).abs() < 1e-12);
            // The free part is as wide as the picture of `aspect` that the unframed camera sees.
            let half = (0.5 * camera.fov_y.to_radians()).tan() * framing.aspect();
            let wide = 2.0 * half / frame.up.length();
            assert!((wide - f64::from(framing.free().0)).abs() < 1e-9);
            let half = framing.camera(&camera, 2);
            assert_eq!(2.0 * half.shift[0], framed.shift[0]);
        }
    }

    #[test]
    fn a_picture_is_cut_to_the_free_part() {
        let rgba = (0..12).map(|n| [n, 0, 0, 255]).collect();
        let picture = Picture {
            width: 6,
            height: 2,
            rgba,
        };
        let reds = |framing: Framing, side| {
            let cut = framing.crop(&picture, side);
            assert_eq!((cut.width, cut.height), framing.free());
            cut.rgba.iter().map(|p| p[0]).collect::<Vec<_>>()
        };
        assert_eq!(reds(Framing::new((6, 2), 4), 1), [4, 5, 10, 11]);
        assert_eq!(
            reds(Framing::new((12, 3), 8), 2),
            [4, 4, 5, 5, 4, 4, 5, 5, 10, 10, 11, 11]
        );
    }
}
