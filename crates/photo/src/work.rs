//! The reduced picture that masks are looked for in: CIELAB, noise, gradients.

use crate::Photo;
use image::{ImageBuffer, Rgb, Rgba, RgbaImage, imageops};
use imageproc::filter::gaussian_blur_f32;
use palette::{FromColor, Lab, LinSrgb, Srgb};
use rayon::prelude::*;

/// Pixels of the reduced picture.
const PIXELS: f64 = 200_000.0;

/// A colour in CIELAB.
pub(crate) type Color = [f32; 3];
pub(crate) type Colors = ImageBuffer<Rgb<f32>, Vec<f32>>;

pub(crate) struct Work {
    pub width: usize,
    pub height: usize,
    /// Pixels of the picture to one of these.
    pub scale: f64,
    /// CIELAB, with noise blurred away.
    pub lab: Colors,
    /// Linear sRGB, blurred likewise.
    pub linear: Colors,
    /// Length of the gradient of CIELAB.
    pub gradient: Vec<f32>,
    /// Standard deviation of the noise in lightness, and of the blur.
    pub noise: f32,
    pub blur: f32,
    /// Alpha of every pixel.
    pub alpha: Vec<u8>,
}

pub(crate) fn lab_of(rgb: [u8; 3]) -> Color {
    let lab = Lab::from_color(Srgb::from(rgb).into_linear::<f32>());
    [lab.l, lab.a, lab.b]
}

pub(crate) fn linear_of([l, a, b]: Color) -> Color {
    let rgb = LinSrgb::from_color(Lab::new(l.clamp(0.0, 100.0), a, b));
    [rgb.red, rgb.green, rgb.blue].map(|v| v.max(0.0))
}

pub(crate) fn distance(a: Color, b: Color) -> f32 {
    let square = |i: usize| (a[i] - b[i]) * (a[i] - b[i]);
    (square(0) + square(1) + square(2)).sqrt()
}

pub(crate) fn median(values: &mut [f32]) -> f32 {
    let middle = values.len() / 2;
    match values.is_empty() {
        true => 0.0,
        false => *values.select_nth_unstable_by(middle, f32::total_cmp).1,
    }
}

impl Work {
    /// The part of the picture within `margin` (pixels to leave out: left, top, right, bottom).
    pub fn new(photo: &Photo, [left, top, right, bottom]: [u32; 4]) -> Option<Self> {
        let bytes = photo.rgba.as_flattened();
        let whole = ImageBuffer::<Rgba<u8>, &[u8]>::from_raw(photo.width, photo.height, bytes)?;
        let (w, h) = (photo.width - left - right, photo.height - top - bottom);
        let part = imageops::crop_imm(&whole, left, top, w, h);
        let scale = (f64::from(w) * f64::from(h) / PIXELS).sqrt();
        let small = |v: u32| ((f64::from(v) / scale).round() as u32).max(8);
        let reduced: RgbaImage = match scale > 1.0 {
            true => imageops::thumbnail(&*part, small(w), small(h)),
            false => imageops::resize(&*part, small(w), small(h), imageops::CatmullRom),
        };
        let (width, height) = (reduced.width() as usize, reduced.height() as usize);
        let pixels: Vec<[u8; 4]> = reduced.pixels().map(|p| p.0).collect();
        let sharp: Vec<f32> = pixels
            .par_iter()
            .flat_map_iter(|&[r, g, b, _]| lab_of([r, g, b]))
            .collect();
        let sharp = Colors::from_raw(width as u32, height as u32, sharp)?;
        let rough = gaussian_blur_f32(&sharp, 1.5);
        let mut away: Vec<f32> = sharp
            .pixels()
            .zip(rough.pixels())
            .map(|(a, b)| (a.0[0] - b.0[0]).abs())
            .collect();
        let noise = 1.48 * median(&mut away);
        let blur = match noise {
            n if n < 1.5 => 0.8,
            n if n < 3.0 => 1.6,
            _ => 2.2,
        };
        let lab = gaussian_blur_f32(&sharp, blur);
        let gradient = gradient(&gaussian_blur_f32(&sharp, blur.max(1.2)));
        let linear = lab.as_raw().par_chunks_exact(3);
        let linear = linear.flat_map_iter(|c| linear_of([c[0], c[1], c[2]]));
        let linear = Colors::from_raw(width as u32, height as u32, linear.collect())?;
        Some(Self {
            width,
            height,
            scale: f64::from(h) / height as f64,
            lab,
            linear,
            gradient,
            noise,
            blur,
            alpha: pixels.iter().map(|p| p[3]).collect(),
        })
    }

    /// The middle of the reduced picture.
    pub fn middle(&self) -> [f64; 2] {
        [0.5 * self.width as f64, 0.5 * self.height as f64]
    }

    pub fn color(&self, x: usize, y: usize) -> Color {
        self.lab.get_pixel(x as u32, y as u32).0
    }
}

fn gradient(lab: &Colors) -> Vec<f32> {
    let (w, h) = lab.dimensions();
    let at = |x: u32, y: u32| lab.get_pixel(x.min(w - 1), y.min(h - 1)).0;
    let rows = (0..h).into_par_iter().flat_map_iter(|y| {
        (0..w).map(move |x| {
            let across = distance(at(x + 1, y), at(x.saturating_sub(1), y));
            let down = distance(at(x, y + 1), at(x, y.saturating_sub(1)));
            0.5 * across.hypot(down)
        })
    });
    rows.collect()
}
