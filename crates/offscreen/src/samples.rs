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
        for (sum, [r, g, b, a]) in sums.iter_mut().zip(draw(&shifted)?.color) {
            for (sum, part) in sum.iter_mut().zip([r * a, g * a, b * a, a]) {
                *sum += part;
            }
        }
    }
    for (color, [r, g, b, a]) in frame.color.iter_mut().zip(sums) {
        let weight = if a > 0.0 { a.recip() } else { 0.0 };
        *color = [r * weight, g * weight, b * weight, a / count as f32];
    }
    Ok(frame)
}

/// Point `i` of `n`, as pixels from the middle: a Hammersley set. Each of `n` columns and, `n`
/// being a power of two, each of `n` rows holds one point.
fn point(i: u32, n: u32) -> [f64; 2] {
    let inverse = f64::from(i.reverse_bits()) / 2f64.powi(32);
    let half = 0.5 / f64::from(n);
    [
        f64::from(i) / f64::from(n) + half - 0.5,
        inverse + half - 0.5,
    ]
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
}
