//! The transfer function of 8-bit targets, for clear values that the CPU computes.

use crate::frame::srgb_from_linear;

/// Packs linear RGBA into the same sRGB word as `pack_srgb` of `stores.glsl`.
pub(crate) fn pack_srgb(color: [f32; 4]) -> u32 {
    let byte = |v: f64| (v.clamp(0.0, 1.0) * 255.0).round() as u32;
    let [r, g, b] = [0, 1, 2].map(|i| byte(srgb_from_linear(f64::from(color[i]))));
    r | g << 8 | b << 16 | byte(f64::from(color[3])) << 24
}
