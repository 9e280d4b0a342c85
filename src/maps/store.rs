//! Shape maps as texels of the formats that the GPU reads, and the roundings of distances, which
//! never make a stored distance exceed the true one.

use super::rounding::{from_half, round_down_half};
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
