//! Sub-texel distances from anti-aliased edges.
//!
//! Gustavson & Strand 2011 estimate, for each edge pixel, how far the edge lies from its centre, and pass offsets on. Here the
//! edge itself is found again, a line per edge pixel ([`Interface`]), and distances to these lines are measured exactly:
//! nothing is lost on the way, and the map may have any resolution, whatever the picture's. A picture that is blurred, whose pixels
//! are no covered areas, is measured to the contour of one half instead.

use super::exact;
use super::nearest::for_each_texel;
use super::rounding::round_down;
use crate::profile::Raster;
use crate::profile::interface::Interface;
use glam::DVec2;

/// Signed distance of each texel's centre to the edge in the picture, object units.
pub(super) fn distances(raster: &Raster, columns: usize, rows: usize) -> Vec<f32> {
    let interface = Interface::of_profile(raster);
    if !interface.is_sharp() {
        return exact::distances(&raster.outline(), columns, rows);
    }
    let side = rows as f64;
    for_each_texel(
        &interface.segments(),
        columns,
        rows,
        |column, row, distance, _| {
            let r = (column as f64 + 0.5) / side;
            let z = 1.0 - (row as f64 + 0.5) / side;
            let inside = interface.contains(raster, DVec2::new(r, z));
            round_down(if inside { -distance } else { distance })
        },
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use crate::maps::accuracy::Disc;
    use crate::maps::{BakeOptions, MapSource, ShapeMap};
    use crate::profile::Shape;

    /// Root mean square and largest error of a disc's coverage map, after its image went through `change`.
    fn errors(rows: u32, change: impl Fn(&mut Raster)) -> (f64, f64) {
        let disc = Disc::default();
        let mut image = disc.image(rows).unwrap();
        let Shape::Raster(raster) = &mut image.shape else {
            panic!("an image is a raster")
        };
        change(raster);
        let map = ShapeMap::bake(&image, &BakeOptions::new(MapSource::Coverage, rows)).unwrap();
        let e = disc.measure(&map);
        (e.rms, e.max)
    }

    /// A box filter of 3 x 3, twice.
    fn blur(raster: &mut Raster) {
        for _ in 0..2 {
            let (w, h) = (raster.columns as usize, raster.rows as usize);
            let old = raster.coverage.clone();
            for j in 1..h - 1 {
                for i in 1..w - 1 {
                    let sum: f32 = (0..9)
                        .map(|k| old[(j + k / 3 - 1) * w + i + k % 3 - 1])
                        .sum();
                    raster.coverage[j * w + i] = sum / 9.0;
                }
            }
        }
    }

    #[test]
    fn blurred_edges_are_measured_to_their_middle() {
        let (rms, max) = errors(128, blur);
        assert!(rms < 0.05 && max < 0.25, "rms {rms}, max {max} texels");
    }

    #[test]
    fn noise_does_not_make_edges() {
        // As in a JPEG: a few percent up and down everywhere.
        let noisy = |raster: &mut Raster| {
            for (c, k) in raster.coverage.iter_mut().zip(0u32..) {
                let noise = (k.wrapping_mul(2_654_435_761) >> 16) as f32 / 65_536.0 - 0.5;
                *c = (*c + 0.08 * noise).clamp(0.0, 1.0);
            }
        };
        let (rms, max) = errors(128, noisy);
        assert!(rms < 0.05 && max < 0.3, "rms {rms}, max {max} texels");
    }

    #[test]
    fn grey_solids_have_edges_where_they_pass_one_half() {
        // A solid of 80 % on paper of 10 %.
        let (rms, max) = errors(128, |r| {
            r.coverage.iter_mut().for_each(|c| *c = 0.1 + 0.7 * *c)
        });
        assert!(rms < 0.15 && max < 0.6, "rms {rms}, max {max} texels");
    }
}
