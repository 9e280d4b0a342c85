//! The projection of a cluster of copies.

use super::bounds::{Cylinder, MARGIN, Projector, SLACK, ScreenBounds};
use super::cover::{first_pixel, last_pixel};
use crate::scene::Cluster;

impl Projector {
    /// A rectangle that contains the rectangles of all copies, and a lower bound of their depths.
    /// Returns none if no ray can meet a copy.
    pub fn cluster_bounds(&self, cluster: &Cluster, of: &Cylinder) -> Option<ScreenBounds> {
        let beside = of.axis.length() + of.radius;
        let around = cluster.around(self.eye, [beside, of.low.abs().max(of.high.abs())]);
        let [x, y, depth] = [0, 1, 2].map(|k| self.rows.row(k));
        let [near, far] = around.along(depth);
        if far <= 0.0 {
            return None;
        }
        let mut pixels = [0u16; 4];
        for (i, row) in [x, y].into_iter().enumerate() {
            let [first, last] = [self.low[i] - MARGIN, self.high[i] + MARGIN];
            let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
            if near > 1e-3 * far {
                // The projected middle, and the largest distance of any copy from it.
                let at = around.middle.dot(row) / around.middle.dot(depth);
                let off = around.along(row - depth * at)[1] / near + 2.0 * MARGIN;
                (low, high) = (at - off, at + off);
            } else if around.along(row - depth * first)[1] < 0.0
                || around.along(row - depth * last)[0] > 0.0
            {
                return None;
            }
            if low.is_nan() || high.is_nan() {
                return None;
            }
            let (low, high) = (
                first_pixel(low).max(self.ends[i]),
                last_pixel(high).min(self.ends[i + 2]),
            );
            // The cluster is between the centres of two pixels, so no copy's rectangle contains
            // one.
            if low > high {
                return None;
            }
            (pixels[i], pixels[i + 2]) = (low as u16, high as u16);
        }
        Some(ScreenBounds {
            pixels,
            near: (near * (1.0 - 2.0 * SLACK)).max(0.0) as f32,
        })
    }
}
