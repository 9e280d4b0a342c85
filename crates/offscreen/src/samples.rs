//! Supersampling: several rays in each pixel, spread evenly over its area.

use revmap::error::Result;
use revmap::frame::Frame;
use revmap::host_memory;
use revmap::scene::Scene;

/// Draws the scene through the middle of each pixel by `draw`; where `count`, a power of two, is
/// above 1, with the mean of the colours through so many points, linear and weighted by alpha.
pub fn averaged(
    count: u32,
    scene: &Scene,
    mut draw: impl FnMut(&Scene) -> Result<Frame>,
) -> Result<Frame> {
    let mut frame = draw(scene)?;
    if count == 1 {
        return Ok(frame);
    }
    let mut sums = host_memory::filled(frame.pixels(), [0.0f32; 4], "the sums of samples")?;
    let mut shifted = scene.clone();
    shifted.camera.ray_width = f64::from(count).sqrt().recip();
    for i in 0..count {
        let [x, y] = point(i, count);
        shifted.camera.shift = [scene.camera.shift[0] + x, scene.camera.shift[1] + y];
        for (sum, color) in sums.iter_mut().zip(draw(&shifted)?.color) {
            add(sum, color);
        }
    }
    for (color, sum) in frame.color.iter_mut().zip(sums) {
        *color = weighted(sum, count);
    }
    Ok(frame)
}

/// Adds a colour, weighted by alpha.
pub(crate) fn add(sum: &mut [f32; 4], [r, g, b, a]: [f32; 4]) {
    for (sum, part) in sum.iter_mut().zip([r * a, g * a, b * a, a]) {
        *sum += part;
    }
}

/// The mean of so many colours, from their sum weighted by alpha.
pub(crate) fn weighted([r, g, b, a]: [f32; 4], count: u32) -> [f32; 4] {
    let weight = if a > 0.0 { a.recip() } else { 0.0 };
    [r * weight, g * weight, b * weight, a / count as f32]
}

/// Point `i` of `n`, a power of two, as pixels from the middle, in the order of Sobol (1967). Each of
/// `n` columns and each of `n` rows holds one point, and so it is for the first 4, 16, ... of them.
pub(crate) fn point(i: u32, n: u32) -> [f64; 2] {
    // The direction numbers of the second coordinate: those of the polynomial x + 1.
    let (mut y, mut direction) = (0u32, 1u32 << 31);
    for bit in 0..32 {
        y ^= if i >> bit & 1 == 1 { direction } else { 0 };
        direction ^= direction >> 1;
    }
    [i.reverse_bits(), y].map(|v| f64::from(v) / 2f64.powi(32) + 0.5 / f64::from(n) - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_and_column_of_a_pixel_holds_one_point() {
        for n in [1, 4, 16, 64] {
            for axis in 0..2 {
                let mut places: Vec<f64> = (0..n).map(|i| point(i, n)[axis]).collect();
                places.sort_by(f64::total_cmp);
                for (k, place) in places.iter().enumerate() {
                    let wanted = (k as f64 + 0.5) / f64::from(n) - 0.5;
                    assert!((place - wanted).abs() < 1e-12, "{n}: {places:?}");
                }
            }
        }
        assert_eq!(point(0, 1), [0.0, 0.0]);
    }

    /// Each of 4 x 4 parts of a pixel holds one of the first 16 points, and 4 of 64.
    #[test]
    fn parts_of_a_pixel_hold_equal_numbers_of_points() {
        for (n, each) in [(16, 1), (64, 4)] {
            let mut counts = [0; 16];
            for i in 0..n {
                let [x, y] = point(i, 64).map(|v| ((v + 0.5) * 4.0) as usize);
                counts[4 * y + x] += 1;
            }
            assert_eq!(counts, [each; 16], "{n}");
        }
    }
}
