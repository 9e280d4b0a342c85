//! Shape maps as texels of the formats that the GPU reads, and the roundings of distances, which
//! never make a stored distance exceed the true one.

use super::{MapFormat, ShapeMap};
use crate::error::Result;
use crate::host_memory::reserved;

/// What needs memory, in messages.
const TEXELS: &str = "the texels of a map";

/// A shape map's texels, row by row from the top, tightly packed, native byte order.
///
/// | format | texel | distance in object units |
/// |---|---|---|
/// | [`MapFormat::Rgba8`] | `R8G8B8A8_UNORM`: R, G = unit gradient `(g_r, g_z) * 0.5 + 0.5`; B = unsigned distance; A = form, 255 solid, 0 empty (papers) | `B * scale` |
/// | [`MapFormat::R16`] | `R16_SFLOAT`, signed | as stored (`scale` = 1) |
/// | [`MapFormat::R32`] | `R32_SFLOAT`, signed | as stored (`scale` = 1) |
///
/// A stored distance, read back as the fields below define, never exceeds the map's. The format
/// rgba8 guarantees this only for distances that are not negative; it stores the others as 0.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedMap {
    /// Texels along `r`.
    pub columns: u32,
    /// Texels along `z`; row 0 is the top.
    pub rows: u32,
    /// The format of the bytes.
    pub format: MapFormat,
    /// Object units that a stored 1 represents.
    pub scale: f32,
    /// The texels.
    pub bytes: Vec<u8>,
}

impl MapFormat {
    /// Bytes per texel.
    #[must_use]
    pub fn texel_bytes(self) -> usize {
        match self {
            Self::Rgba8 | Self::R32 => 4,
            Self::R16 => 2,
        }
    }
}

impl EncodedMap {
    /// The distances as a shader reads them, object units.
    #[must_use]
    pub fn distances(&self) -> Vec<f32> {
        let half = |t: &[u8]| from_half(u16::from_ne_bytes([t[0], t[1]]));
        let single = |t: &[u8]| f32::from_ne_bytes([t[0], t[1], t[2], t[3]]);
        let texels = self.bytes.chunks_exact(self.format.texel_bytes());
        match self.format {
            MapFormat::Rgba8 => texels.map(|t| unpack_distance(t[2], self.scale)).collect(),
            MapFormat::R16 => texels.map(half).collect(),
            MapFormat::R32 => texels.map(single).collect(),
        }
    }
}

impl ShapeMap {
    /// The map's texels in one of the GPU's formats.
    ///
    /// # Errors
    /// [`ErrorKind::OutOfHostMemory`](crate::error::ErrorKind::OutOfHostMemory).
    pub fn encode(&self, format: MapFormat) -> Result<EncodedMap> {
        let mut bytes = reserved(self.distance.len() * format.texel_bytes(), TEXELS)?;
        let mut scale = 1.0;
        match format {
            MapFormat::Rgba8 => scale = self.encode_rgba8(&mut bytes),
            MapFormat::R16 => {
                let halves = self.distance.iter().map(|&d| round_down_half(d));
                bytes.extend(halves.flat_map(u16::to_ne_bytes));
            }
            MapFormat::R32 => bytes.extend_from_slice(bytemuck::cast_slice(&self.distance)),
        }
        Ok(EncodedMap {
            columns: self.columns,
            rows: self.rows,
            format,
            scale,
            bytes,
        })
    }

    /// The largest distance in the map, object units. The papers give extension and bevel in this
    /// scale.
    #[must_use]
    pub fn largest_distance(&self) -> f32 {
        let finite = self.distance.iter().copied().filter(|d| d.is_finite());
        finite.fold(0.0, f32::max)
    }

    /// Appends the papers' texels, and returns their scale.
    fn encode_rgba8(&self, bytes: &mut Vec<u8>) -> f32 {
        let largest = self.largest_distance();
        // A map without any empty texel stores zeros for every scale.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let pack = |g: f32| ((g * 0.5 + 0.5) * 255.0).round() as u8;
        for (texel, (&d, &solid)) in self.distance.iter().zip(&self.form).enumerate() {
            let [gr, gz] = self.gradient(texel);
            let form = if solid { 255 } else { 0 };
            bytes.extend([pack(gr), pack(gz), pack_distance(d, scale), form]);
        }
        scale
    }

    /// Unit gradient `(g_r, g_z)` at a texel's centre: central differences of the distances
    /// (one-sided at the border, mirrored at the axis), 0 where they cancel. Texels are counted row by
    /// row from the top.
    fn gradient(&self, k: usize) -> [f32; 2] {
        let (columns, rows) = (self.columns as usize, self.rows as usize);
        let at = |i: usize, j: usize| f64::from(self.distance[j * columns + i]);
        let slope = |low: f64, high: f64, steps: usize| {
            let difference = high - low;
            if difference.is_finite() {
                difference / steps.max(1) as f64
            } else {
                0.0
            }
        };
        let (i, j) = (k % columns, k / columns);
        let i1 = (i + 1).min(columns - 1);
        let (j0, j1) = (j.saturating_sub(1), (j + 1).min(rows - 1));
        // The map is mirrored left of the first texel, one texel away.
        let (i0, across) = if i == 0 { (0, 2) } else { (i - 1, i1 + 1 - i) };
        let gr = slope(at(i0, j), at(i1, j), across);
        let gz = slope(at(i, j1), at(i, j0), j1 - j0);
        let length = gr.hypot(gz);
        if length > 0.0 {
            [(gr / length) as f32, (gz / length) as f32]
        } else {
            [0.0; 2]
        }
    }

    /// Unit gradients `(g_r, g_z)` at the texels' centres, row by row from the top: central differences
    /// of the distances (one-sided at the border, mirrored at the axis), 0 where they cancel.
    pub fn gradients(&self) -> impl ExactSizeIterator<Item = [f32; 2]> {
        (0..self.distance.len()).map(|texel| self.gradient(texel))
    }
}

/// The largest byte whose distance, as a shader computes it, is not above `d`.
fn pack_distance(d: f32, scale: f32) -> u8 {
    let mut byte = (d.max(0.0) / scale * 255.0).min(255.0) as u8;
    while byte > 0 && unpack_distance(byte, scale) > d {
        byte -= 1;
    }
    byte
}

/// The distance that a byte of the channel B represents, as a shader computes it from the
/// normalised value.
fn unpack_distance(byte: u8, scale: f32) -> f32 {
    f32::from(byte) / 255.0 * scale
}

/// The largest 32-bit float that is not above `v`.
#[must_use]
pub fn round_down(v: f64) -> f32 {
    let nearest = v as f32;
    if f64::from(nearest) > v {
        nearest.next_down()
    } else {
        nearest
    }
}

/// The bits of the largest 16-bit float that is not above `v`. Values beyond the range become the
/// largest float or `-inf`.
fn round_down_half(v: f32) -> u16 {
    let nearest = to_half(v);
    if from_half(nearest) <= v || v.is_nan() {
        return nearest;
    }
    // The next lower value: one less in magnitude above zero, one more below.
    match nearest {
        0x0000 => 0x8001,
        0x8000.. => nearest + 1,
        _ => nearest - 1,
    }
}

/// The bits of the nearest 16-bit float (IEEE 754 binary16), ties to even; an infinity beyond the range.
pub(super) fn to_half(v: f32) -> u16 {
    let sign = (v.to_bits() >> 16) as u16 & 0x8000;
    let bits = v.to_bits() & 0x7fff_ffff;
    sign | match bits {
        0x7f80_0001.. => 0x7e00, // no number
        0x477f_f000.. => 0x7c00, // half way from the largest to the next power, or more
        0x3880_0000.. => {
            // Magnitudes from 2^-14: the exponent loses 112, the mantissa its last 13 bits.
            let odd = (bits >> 13) & 1;
            ((bits - 0x3800_0000 + 0xfff + odd) >> 13) as u16
        }
        _ => (f32::from_bits(bits) / TINY).round_ties_even() as u16,
    }
}

/// The value of the bits of a 16-bit float.
fn from_half(half: u16) -> f32 {
    let bits = u32::from(half & 0x7fff);
    let v = match bits {
        0x7c00.. => f32::from_bits(0x7f80_0000 | (bits << 13)),
        0x0400.. => f32::from_bits((bits << 13) + 0x3800_0000),
        _ => bits as f32 * TINY,
    };
    if half & 0x8000 == 0 { v } else { -v }
}

/// The smallest 16-bit float above 0: 2^-24.
const TINY: f32 = f32::from_bits(0x3380_0000);

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn never_above_and_next_would_be(v in prop_oneof![-2.0f64..2.0, -1e-7f64..1e-7, -1e5f64..1e5]) {
            let single = round_down(v);
            prop_assert!(f64::from(single) <= v && f64::from(single.next_up()) > v);
            let half = round_down_half(single);
            prop_assert!(from_half(half) <= single);
            let above = from_half(match half {
                0x8000 => 0x0001,
                0x8001.. => half - 1,
                _ => half + 1,
            });
            prop_assert!(above > single, "{} for {single}, {above} would do", from_half(half));
        }

        /// No other 16-bit float is nearer, and the even one is used of two that are equally near.
        #[test]
        fn the_nearest_is_taken(v in prop_oneof![-2.0f32..2.0, -1e-6f32..1e-6, -65_519.0f32..65_519.0]) {
            let half = to_half(v);
            let error = (f64::from(from_half(half)) - f64::from(v)).abs();
            for other in [half.wrapping_add(1), half.wrapping_sub(1)] {
                let theirs = (f64::from(from_half(other)) - f64::from(v)).abs();
                if theirs.is_finite() {
                    prop_assert!(error < theirs || (error == theirs && half & 1 == 0));
                }
            }
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(round_down_half(f32::INFINITY), 0x7c00);
        assert_eq!(round_down_half(1e6), 0x7bff);
        assert_eq!(round_down_half(-1e6), 0xfc00);
        assert_eq!(round_down_half(0.0), 0);
        assert_eq!(round_down_half(-1e-30), 0x8001);
        assert_eq!(round_down_half(1e-30), 0);
        assert!(from_half(round_down_half(f32::NAN)).is_nan());
    }

    #[test]
    fn every_half_comes_back() {
        for bits in 0..=u16::MAX {
            let v = from_half(bits);
            assert_eq!(v.is_nan(), bits & 0x7fff > 0x7c00, "{bits:#x}");
            if !v.is_nan() {
                assert_eq!(to_half(v), bits);
            }
        }
        assert_eq!(from_half(0x3c00), 1.0);
        assert_eq!(from_half(0xc000), -2.0);
        assert_eq!(from_half(0x7bff), 65_504.0);
        assert_eq!(from_half(0x0001), 2f32.powi(-24));
        assert_eq!(to_half(f32::NAN) & 0x7fff, 0x7e00);
        assert_eq!((to_half(65_519.9), to_half(65_520.0)), (0x7bff, 0x7c00));
        assert_eq!((to_half(TINY * 0.5), to_half(TINY * 0.500_001)), (0, 1));
    }
}
