//! The transfer function of 8-bit targets, for what the CPU reads from or clears them with.

use crate::frame::srgb_from_linear;

/// Linear value of an 8-bit sRGB value (IEC 61966-2-1).
pub(crate) fn linear_from_srgb(byte: u8) -> f32 {
    let s = f32::from(byte) / 255.0;
    if s <= 0.040_45 {
        s / 12.92
    } else {
        ((s + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear RGBA as the packed sRGB word that `srgb.glsl` makes of it.
pub(crate) fn pack_srgb(color: [f32; 4]) -> u32 {
    let byte = |v: f64| (v.clamp(0.0, 1.0) * 255.0).round() as u32;
    let [r, g, b] = [0, 1, 2].map(|i| byte(srgb_from_linear(f64::from(color[i]))));
    r | g << 8 | b << 16 | byte(f64::from(color[3])) << 24
}
