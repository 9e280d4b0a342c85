//! The rows of pixels that a solid may cover: projections of cylinders about its axis that contain
//! it.

use super::bounds::{ProjectedAxes, first_pixel, last_pixel};
use crate::surface::Cylinders;
use glam::DVec2;
use std::f64::consts::SQRT_2;
use std::ops::Range;

/// Copies with fewer rows of pixels are listed by their rectangles.
const LEAST_ROWS: u32 = 6;
/// Corners of an octagon around the unit circle, in order.
const CORNERS: [(f64, f64); 8] = {
    const T: f64 = SQRT_2 - 1.0;
    [
        (1.0, -T),
        (1.0, T),
        (T, 1.0),
        (-T, 1.0),
        (-1.0, T),
        (-1.0, -T),
        (-T, -1.0),
        (T, -1.0),
    ]
};

/// Computes the ends, in pixels, of the span that may show the copy in each row of `within`.
/// Returns false if they are unknown. `margin`: object units by which the copy may be larger;
/// `high`: approximate number of rows of the whole copy.
pub(super) fn rows(
    outer: &Cylinders,
    axes: &ProjectedAxes,
    margin: f64,
    within: Range<u32>,
    high: u32,
    rows: &mut Vec<[f64; 2]>,
) -> bool {
    if high < LEAST_ROWS {
        return false;
    }
    rows.clear();
    rows.resize(within.len(), [f64::INFINITY, f64::NEG_INFINITY]);
    // Two sides of each octagon are parallel to the line of sight, so it is as wide as its disc.
    let towards = axes.eye.truncate().normalize_or(DVec2::X);
    let [a, b] = [towards, towards.perp()].map(|way| axes.along[0] * way.x + axes.along[1] * way.y);
    let ways = CORNERS.map(|(x, y)| a * x + b * y);
    for piece in outer.of(high) {
        let radius = piece.radius + margin;
        let mut rings = [[DVec2::ZERO; 8]; 2];
        let mut near = f64::INFINITY;
        for (ring, z) in (rings.iter_mut()).zip([piece.low - margin, piece.high + margin]) {
            let middle = axes.middle + axes.along[2] * z;
            for (corner, way) in ring.iter_mut().zip(&ways) {
                let p = middle + way * radius;
                near = near.min(p.z);
                *corner = p.truncate() / p.z;
            }
        }
        if near <= 0.0 {
            return false;
        }
        outline(&rings, within.start, rows);
    }
    true
}

/// Widens rows to the convex hull of the two ends of a cylinder. Most edges between their corners
/// are inside the hull.
fn outline(rings: &[[DVec2; 8]; 2], top: u32, rows: &mut [[f64; 2]]) {
    // True if two points are on different sides of the line through an edge.
    let parts = |p: DVec2, q: DVec2, [a, b]: [DVec2; 2]| {
        let side = |point: DVec2| (q - p).perp_dot(point - p);
        side(a) * side(b) < 0.0
    };
    for (ring, other) in [(&rings[0], &rings[1]), (&rings[1], &rings[0])] {
        // Rings seen from the side are flat, and many are between the centres of two rows of
        // pixels.
        let ends = |m: [f64; 2], p: &DVec2| [m[0].min(p.y), m[1].max(p.y)];
        let [low, high] = ring.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
        if first_pixel(low) > last_pixel(high) {
            continue;
        }
        for (k, &p) in ring.iter().enumerate() {
            let q = ring[(k + 1) % 8];
            if !parts(p, q, [ring[(k + 4) % 8], other[k]]) {
                mark(p, q, top, rows);
            }
        }
    }
    let [low, up] = rings;
    for k in 0..8 {
        if !parts(low[k], up[k], [low[(k + 1) % 8], low[(k + 7) % 8]]) {
            mark(low[k], up[k], top, rows);
        }
    }
}

/// Widens rows to the points at which an edge crosses the centres of their pixels.
fn mark(p: DVec2, q: DVec2, top: u32, rows: &mut [[f64; 2]]) {
    let (p, q) = if p.y < q.y { (p, q) } else { (q, p) };
    let top = top as i32;
    let first = first_pixel(p.y).max(top);
    let last = last_pixel(q.y).min(top + rows.len() as i32 - 1);
    if first > last {
        return;
    }
    let slope = (q.x - p.x) / (q.y - p.y);
    let mut x = p.x + (f64::from(first) + 0.5 - p.y) * slope;
    for row in &mut rows[(first - top) as usize..=(last - top) as usize] {
        *row = [row[0].min(x), row[1].max(x)];
        x += slope;
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::View;
    use crate::plan::tiles::{Cylinder, Projector};
    use crate::scene::{Camera, Placement};
    use glam::{DQuat, DVec3};

    /// A spindle on a plate: the rows contain points on and in it, and exclude much of the
    /// rectangle.
    #[test]
    fn rows_hold_the_solid_and_little_else() {
        let radius = |z: f64| if z < 0.1 { 0.4 } else { 0.05 + 0.1 * z };
        let radii = std::array::from_fn(|row| {
            radius((row + 1) as f64 / 64.0).max(radius(row as f64 / 64.0))
        });
        let outer = Cylinders::around(&radii);
        let camera = Camera::new(DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.0, 0.0, 0.4));
        let view = View::from_camera(&camera, (640, 480), [0.1, 100.0]).unwrap();
        let projector = Projector::new(&view, 0.0, 0.0);
        let shape = Cylinder {
            axis: DVec2::ZERO,
            radius: 0.4,
            low: 0.0,
            high: 1.0,
        };
        let mut covered = 0.0;
        for turn in 0..20 {
            let turn = f64::from(turn);
            let copy = Placement {
                position: DVec3::new(0.05 * turn - 0.5, 0.3, -0.2),
                rotation: DQuat::from_rotation_y(0.3 * turn) * DQuat::from_rotation_x(turn),
                scale: DVec3::new(0.5, 0.7, 0.4 + 0.02 * turn),
            };
            let axes = projector.axes(&copy, shape.axis);
            let pixels = projector
                .bounds(&copy, &shape)
                .unwrap()
                .pixels
                .map(u32::from);
            let margin = projector.margin(&axes, &shape);
            let mut rows = Vec::new();
            let within = pixels[1]..pixels[3] + 1;
            assert!(super::rows(&outer, &axes, margin, within, 100, &mut rows));
            let wide = rows.iter().map(|r| (r[1] - r[0]).max(0.0)).sum::<f64>();
            let all = f64::from((pixels[2] - pixels[0]) * (pixels[3] - pixels[1]));
            covered += wide / all;
            for k in 0..5000 {
                let part = |step: f64| (f64::from(k) * step).fract();
                let z = part(0.754_877_666);
                let around = DVec2::from_angle(std::f64::consts::TAU * part(0.569_840_291));
                let beside = around * radius(z);
                let at = copy.position + copy.rotation * (copy.scale * beside.extend(z));
                let pixel = view.project(at).0;
                // Ends are exact for the centre of the row, and edges may be steep.
                let Some(row) = rows.get((pixel.y as usize).wrapping_sub(pixels[1] as usize))
                else {
                    continue;
                };
                if (pixel.y.fract() - 0.5).abs() < 0.01 {
                    let off = (row[0] - pixel.x).max(pixel.x - row[1]);
                    assert!(off < 0.0, "{turn}: {off}");
                }
            }
        }
        assert!(covered < 0.7 * 20.0, "{covered}");
    }
}
