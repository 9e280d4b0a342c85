//! A drawn picture, pixel by pixel: the planes of a frame.

use crate::error::{Error, ErrorKind, Result};
use crate::host_memory::{filled, zeroed};
use std::ops::Range;
use std::slice::{from_mut, from_ref};

/// Largest number of pixels in a frame: 16384 x 8192. A pixel of all planes takes 68 bytes, so this
/// is 9 GB.
pub const MAX_PIXELS: u64 = 1 << 27;

/// What needs memory, in messages.
const PLANES: &str = "the pixels of a picture";

/// All planes of a drawn picture; each has `width * height` values, row 0 on top.
///
/// In pixels without a hit `color` is the background, `distance` is `+inf`, and the other values
/// are 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Linear RGBA; the colour is not multiplied by alpha.
    pub color: Vec<[f32; 4]>,
    /// Distance from the eye along the ray, world units; `+inf` without a hit.
    pub distance: Vec<f32>,
    /// Unit world normal of the surface, without bump.
    pub normal: Vec<[f32; 3]>,
    /// The normal that was shaded.
    pub shading_normal: Vec<[f32; 3]>,
    /// Colour of the surface before light, linear.
    pub albedo: Vec<[f32; 3]>,
    /// Texture coordinates before the texture's repetition and offset.
    pub uv: Vec<[f32; 2]>,
    /// Look-ups that the search made.
    pub steps: Vec<f32>,
    /// Number of pixels in which a search with bounded steps used them up; their values are
    /// guesses. Files do not store this number. 0 if it was not counted
    /// ([`Planes::Color`](crate::settings::Planes::Color), the reference).
    pub exhausted: usize,
}

/// The first difference of two frames, in reading order of the pixels and, within a pixel, in the
/// order of the channels.
#[derive(Clone, Debug, PartialEq)]
pub enum Difference {
    /// The frames have different sizes: `(width, height)` of each.
    Size([u32; 2], [u32; 2]),
    /// A value differs in at least one bit.
    Value {
        /// The channel, by its name in an EXR file.
        channel: &'static str,
        /// Column, from the left.
        x: u32,
        /// Row, from the top.
        y: u32,
        /// The value in the first frame and in the second.
        values: [f32; 2],
    },
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Size(a, b) => write!(f, "sizes differ: {}x{} and {}x{}", a[0], a[1], b[0], b[1]),
            Self::Value {
                channel,
                x,
                y,
                values: [a, b],
            } => write!(f, "{channel} at pixel ({x}, {y}): {a:?} and {b:?}"),
        }
    }
}

/// Names of a frame's channels in an EXR file, in the order in which [`Frame::pixel`] gives them.
pub const CHANNELS: [&str; 17] = [
    "R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "Ns.X", "Ns.Y", "Ns.Z", "albedo.R", "albedo.G",
    "albedo.B", "u", "v", "steps",
];

impl Frame {
    /// A frame in which nothing is hit.
    ///
    /// # Errors
    /// The errors of [`pixel_count`]; [`ErrorKind::OutOfHostMemory`].
    pub fn new(width: u32, height: u32, background: [f32; 4]) -> Result<Self> {
        let pixels = pixel_count(width, height)?;
        Ok(Self {
            width,
            height,
            color: filled(pixels, background, PLANES)?,
            distance: filled(pixels, f32::INFINITY, PLANES)?,
            normal: zeroed(pixels, PLANES)?,
            shading_normal: zeroed(pixels, PLANES)?,
            albedo: zeroed(pixels, PLANES)?,
            uv: zeroed(pixels, PLANES)?,
            steps: zeroed(pixels, PLANES)?,
            exhausted: 0,
        })
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.distance.len()
    }

    /// Returns true if pixel number `index` shows a solid.
    #[must_use]
    pub fn hits(&self, index: usize) -> bool {
        self.distance.get(index).is_some_and(|z| z.is_finite())
    }

    /// All channels of pixel number `index` (`y * width + x`), in the order of [`CHANNELS`]; zeros
    /// past the end.
    #[must_use]
    pub fn pixel(&self, index: usize) -> [f32; 17] {
        if index >= self.pixels() {
            return [0.0; 17];
        }
        let channels: [&[f32]; 7] = [
            &self.color[index],
            from_ref(&self.distance[index]),
            &self.normal[index],
            &self.shading_normal[index],
            &self.albedo[index],
            &self.uv[index],
            from_ref(&self.steps[index]),
        ];
        let mut values = channels.into_iter().flatten().copied();
        std::array::from_fn(|_| values.next().unwrap_or_default())
    }

    /// Sets all channels of pixel number `index`; does nothing past the end.
    pub fn set_pixel(&mut self, index: usize, value: [f32; 17]) {
        if index >= self.pixels() {
            return;
        }
        let channels: [&mut [f32]; 7] = [
            &mut self.color[index],
            from_mut(&mut self.distance[index]),
            &mut self.normal[index],
            &mut self.shading_normal[index],
            &mut self.albedo[index],
            &mut self.uv[index],
            from_mut(&mut self.steps[index]),
        ];
        for (channel, value) in channels.into_iter().flatten().zip(value) {
            *channel = value;
        }
    }

    /// The first bit difference of `self` and `other`, or `None` if they are equal in all channels.
    ///
    /// `steps` counts if all other channels are equal: searches that hit the same points differ in it.
    /// Bits are compared, so `0.0` and `-0.0` differ and a NaN equals itself.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<Difference> {
        if (self.width, self.height) != (other.width, other.height) {
            return Some(Difference::Size(
                [self.width, self.height],
                [other.width, other.height],
            ));
        }
        let differing = |channels: Range<usize>| {
            (0..self.pixels()).find_map(|index| {
                let (a, b) = (self.pixel(index), other.pixel(index));
                let mut channels = channels.clone();
                let channel = channels.find(|&c| a[c].to_bits() != b[c].to_bits())?;
                Some(Difference::Value {
                    channel: CHANNELS[channel],
                    x: (index % self.width as usize) as u32,
                    y: (index / self.width as usize) as u32,
                    values: [a[channel], b[channel]],
                })
            })
        };
        let steps = CHANNELS.len() - 1;
        differing(0..steps).or_else(|| differing(steps..CHANNELS.len()))
    }
}

/// Number of pixels of a frame of this size, if that is within the limit.
///
/// # Errors
/// [`ErrorKind::Usage`] if a side is 0, [`ErrorKind::TooLarge`] beyond [`MAX_PIXELS`].
pub fn pixel_count(width: u32, height: u32) -> Result<usize> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        let message = format!("a picture of {width}x{height} has no pixels; give at least 1x1");
        return Err(Error::new(ErrorKind::Usage, message));
    }
    if pixels > MAX_PIXELS {
        let message = format!(
            "a picture of {width}x{height} is too large; at most {MAX_PIXELS} pixels (16384x8192) can be drawn"
        );
        return Err(Error::new(ErrorKind::TooLarge, message));
    }
    Ok(pixels as usize)
}

/// The sRGB code value in `[0, 1]` of a linear one (IEC 61966-2-1).
#[must_use]
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// The linear value of an sRGB code value in `[0, 1]`.
#[must_use]
pub fn linear_from_srgb(code: f64) -> f64 {
    if code <= 0.040_45 {
        code / 12.92
    } else {
        ((code + 0.055) / 1.055).powf(2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_frame_hits_nothing_and_shows_the_background() {
        let frame = Frame::new(3, 2, [0.1, 0.2, 0.3, 0.4]).unwrap();
        assert_eq!(frame.pixels(), 6);
        for index in 0..6 {
            assert!(!frame.hits(index));
            let mut expected = [0.0; 17];
            expected[..5].copy_from_slice(&[0.1, 0.2, 0.3, 0.4, f32::INFINITY]);
            assert_eq!(frame.pixel(index), expected);
        }
    }

    #[test]
    fn impossible_sizes_are_refused() {
        for (w, h) in [
            (0, 0),
            (0, 5),
            (5, 0),
            (100_000, 100_000),
            (u32::MAX, u32::MAX),
            (16385, 8192),
        ] {
            let error = Frame::new(w, h, [0.0; 4]).unwrap_err();
            let none = w == 0 || h == 0;
            let wanted = if none {
                ErrorKind::Usage
            } else {
                ErrorKind::TooLarge
            };
            assert_eq!(error.kind, wanted, "{error}");
            assert!(error.to_string().contains(&format!("{w}x{h}")), "{error}");
        }
    }

    #[test]
    fn every_channel_is_compared_bit_for_bit() {
        let base = Frame::new(4, 3, [0.0; 4]).unwrap();
        assert_eq!(base.first_difference(&base), None);
        for (channel, name) in CHANNELS.iter().enumerate() {
            let mut other = base.clone();
            let mut value = other.pixel(6);
            value[channel] = f32::from_bits(value[channel].to_bits() ^ 1);
            other.set_pixel(6, value);
            let found = base.first_difference(&other).unwrap();
            let Difference::Value {
                channel,
                x,
                y,
                values,
            } = &found
            else {
                panic!("{found}")
            };
            assert_eq!((*channel, *x, *y), (*name, 2, 1));
            assert_ne!(values[0].to_bits(), values[1].to_bits());
        }
        let mut other = base.clone();
        other.normal[0][1] = -0.0;
        assert_eq!(
            base.first_difference(&other).unwrap().to_string(),
            "N.Y at pixel (0, 0): 0.0 and -0.0"
        );
        // A pixel with other steps is before it.
        let mut searched = base.clone();
        (searched.steps[0], searched.distance[6]) = (1.0, 2.0);
        let found = base.first_difference(&searched).unwrap().to_string();
        assert!(found.starts_with("Z at pixel (2, 1)"), "{found}");
        // Beyond the end there are no pixels.
        let beyond = base.pixels();
        other.clone_from(&base);
        other.set_pixel(beyond, [1.0; 17]);
        assert_eq!((other.pixel(beyond), &other), ([0.0; 17], &base));
        let wide = Frame::new(5, 3, [0.0; 4]).unwrap();
        assert_eq!(
            base.first_difference(&wide).unwrap().to_string(),
            "sizes differ: 4x3 and 5x3"
        );
    }
}
