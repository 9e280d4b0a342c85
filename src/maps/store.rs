//! Shape maps as texels of the formats that the GPU reads.

use super::half::from_half;
use super::rounding::round_down_half;
use super::{MapFormat, ShapeMap};

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
    #[must_use]
    pub fn encode(&self, format: MapFormat) -> EncodedMap {
        let (scale, bytes) = match format {
            MapFormat::Rgba8 => self.encode_rgba8(),
            MapFormat::R16 => {
                let texels = self.distance.iter();
                let bytes = texels
                    .flat_map(|&d| round_down_half(d).to_ne_bytes())
                    .collect();
                (1.0, bytes)
            }
            MapFormat::R32 => (1.0, bytemuck::cast_slice(&self.distance).to_vec()),
        };
        EncodedMap {
            columns: self.columns,
            rows: self.rows,
            format,
            scale,
            bytes,
        }
    }

    /// The largest distance in the map, object units. The papers give extension and bevel in this
    /// scale.
    #[must_use]
    pub fn largest_distance(&self) -> f32 {
        self.distance
            .iter()
            .copied()
            .filter(|d| d.is_finite())
            .fold(0.0, f32::max)
    }

    fn encode_rgba8(&self) -> (f32, Vec<u8>) {
        let largest = self.largest_distance();
        // A map without any empty texel stores zeros for every scale.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let gradients = self.gradients();
        let bytes = self
            .distance
            .iter()
            .zip(&self.form)
            .zip(gradients)
            .flat_map(|((&d, &solid), [gr, gz])| {
                let pack = |g: f32| ((g * 0.5 + 0.5) * 255.0).round() as u8;
                [
                    pack(gr),
                    pack(gz),
                    pack_distance(d, scale),
                    if solid { 255 } else { 0 },
                ]
            })
            .collect();
        (scale, bytes)
    }

    /// Unit gradient `(g_r, g_z)` at each texel's centre: central differences of the distances
    /// (one-sided at the border, mirrored at the axis), 0 where they cancel.
    #[must_use]
    pub fn gradients(&self) -> Vec<[f32; 2]> {
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
        (0..columns * rows)
            .map(|k| {
                let (i, j) = (k % columns, k / columns);
                let (i1, j0, j1) = (
                    (i + 1).min(columns - 1),
                    j.saturating_sub(1),
                    (j + 1).min(rows - 1),
                );
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
            })
            .collect()
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
pub(super) fn unpack_distance(byte: u8, scale: f32) -> f32 {
    f32::from(byte) / 255.0 * scale
}
