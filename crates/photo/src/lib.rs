//! Reads the half profile of a turned thing from a photograph.
//!
//! The photograph shows one thing that is alike on both sides of an upright axis, before a ground
//! that changes smoothly or from row to row. [`read`] finds ground, thing and axis, turns a tilt of
//! up to 8 degrees upright, and returns radii from the top to the bottom. [`is_drawing`] tells a
//! drawing, which needs no such search.
//!
//! ```
//! use revmap_photo::{Photo, is_drawing, read};
//!
//! // A pale ball before a blue wall, lit from the left. As in all photographs, edges are soft.
//! let pixel = |x: i32, y: i32| {
//!     let of_ball = (40.5 - f64::from(x - 60).hypot(f64::from(y - 80))).clamp(0.0, 1.0);
//!     let mixed = |ball: i32, wall: i32| wall + (of_ball * f64::from(ball - x - wall)) as i32;
//!     [mixed(230, 60) as u8, mixed(215, 80) as u8, mixed(190, 130) as u8, 255]
//! };
//! let rgba: Vec<_> = (0..160 * 120).map(|i| pixel(i % 120, i / 120)).collect();
//! let photo = Photo { width: 120, height: 160, rgba: &rgba };
//! assert!(!is_drawing(&photo));
//! let reading = read(&photo).map_err(|fault| fault.to_string())?;
//! assert!((reading.radii[reading.radii.len() / 2] - 0.25).abs() < 0.01); // 40 of 160 pixels
//! # Ok::<(), String>(())
//! ```

mod above;
mod choice;
mod cutout;
mod drawing;
mod edge;
mod foot;
mod form;
mod frame;
mod ground;
mod mask;
mod reading;
mod words;
mod work;

pub use drawing::is_drawing;
pub use edge::Half;
pub use ground::Ground;
pub use reading::{Doubt, End, Fault, LeftOut, Reading, Tone, read};

use image::{ImageBuffer, Rgba};
use imageproc::drawing::draw_filled_circle_mut;

/// A picture: sRGB with straight alpha, 8 bits each, row 0 on top.
#[derive(Clone, Copy, Debug)]
pub struct Photo<'a> {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width * height` pixels.
    pub rgba: &'a [[u8; 4]],
}

/// Draws closed loops over a picture of this width, as red lines.
pub fn draw(rgba: &mut [[u8; 4]], width: u32, loops: &[Vec<[f64; 2]>]) {
    let height = rgba.len() as u32 / width.max(1);
    let radius = (width.max(height) / 700) as i32;
    let pixels = rgba.as_flattened_mut();
    let Some(mut canvas) = ImageBuffer::<Rgba<u8>, _>::from_raw(width, height, pixels) else {
        return;
    };
    for points in loops {
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            let steps = (a[0] - b[0]).hypot(a[1] - b[1]).ceil().max(1.0);
            for k in 0..steps as u32 {
                let t = f64::from(k) / steps;
                let at = [0, 1].map(|i| (a[i] + t * (b[i] - a[i])) as i32);
                draw_filled_circle_mut(
                    &mut canvas,
                    (at[0], at[1]),
                    radius,
                    Rgba([255, 0, 64, 255]),
                );
            }
        }
    }
}
