//! The part of the window that the panel leaves free: the picture is drawn in it.

use revmap::scene::Camera;

/// Pixels of the window, and those at its left that the panel covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Framing {
    pub window: (u32, u32),
    pub left: u32,
}

impl Framing {
    /// A panel that covers most of the window covers the picture, too.
    pub fn new(window: (u32, u32), panel: u32) -> Self {
        let left = if panel > window.0 / 3 * 2 { 0 } else { panel };
        Self { window, left }
    }

    /// Pixels of the free part.
    pub fn free(&self) -> (u32, u32) {
        (self.window.0 - self.left, self.window.1)
    }

    /// The factor by which the picture shrinks: the shorter side of the window over that of the
    /// free part.
    fn shrinking(&self) -> f64 {
        let shorter = |(width, height): (u32, u32)| f64::from(width.min(height).max(1));
        shorter(self.window) / shorter(self.free())
    }

    /// The camera for pictures of the free part: a narrow one shows what the window would.
    pub fn camera(&self, camera: &Camera) -> Camera {
        let half = (camera.fov_y.to_radians() * 0.5).tan() * self.shrinking();
        Camera {
            fov_y: 2.0 * half.atan().to_degrees(),
            ..*camera
        }
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
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec3;
    use revmap::scene::CameraFrame;

    #[test]
    fn the_free_part_shows_what_the_window_would() {
        let camera = Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5));
        for (window, panel, wide) in [
            ((1200, 800), 300, 900),
            ((800, 600), 300, 500),
            ((1200, 800), 0, 1200),
            ((300, 600), 280, 300),
        ] {
            let framing = Framing::new(window, panel);
            assert_eq!(framing.free(), (wide, window.1));
            let frame = CameraFrame::new(&framing.camera(&camera), wide, window.1).unwrap();
            // A ray at the edge of the shorter side of the window is now at that of the free part.
            let before = CameraFrame::new(&camera, window.0, window.1).unwrap();
            let shorter = |(w, h): (u32, u32)| f64::from(w.min(h));
            let edge = |frame: &CameraFrame, side: f64| frame.up.length() * side;
            let (a, b) = (shorter(window), shorter(framing.free()));
            assert!((edge(&before, a) - edge(&frame, b)).abs() < 1e-12);
            // The free part is as wide as the picture of `aspect` that the unframed camera sees.
            let half = (0.5 * camera.fov_y.to_radians()).tan() * framing.aspect();
            assert!((2.0 * half / frame.up.length() - f64::from(wide)).abs() < 1e-9);
        }
    }
}
