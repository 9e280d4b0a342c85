//! How far apart two silhouettes are.

use rayon::prelude::*;
use revmap::frame::Frame;

/// Hausdorff distance of the silhouettes in pixels: the farthest that a pixel of one lies from the
/// nearest of the other.
///
/// A silhouette is made of the pixels that hit and have a neighbour (left, right, above, below)
/// that does not; holes have one too, and beyond the picture nothing hits. 0 when neither frame
/// hits anything, `+inf` when only one does.
pub fn silhouette_hausdorff(a: &Frame, b: &Frame) -> f64 {
    let (edge_a, edge_b) = (silhouette(a), silhouette(b));
    match (edge_a.contains(&true), edge_b.contains(&true)) {
        (false, false) => return 0.0,
        (true, true) => {}
        _ => return f64::INFINITY,
    }
    let nearest = |from: &[bool], to: &[bool]| ways(from, to, a.width as usize);
    let all = [nearest(&edge_a, &edge_b), nearest(&edge_b, &edge_a)].concat();
    all.iter().fold(0.0, |most, (_, way)| way.max(most))
}

/// Whether each pixel belongs to the silhouette.
pub(super) fn silhouette(frame: &Frame) -> Vec<bool> {
    let (w, h) = (frame.width as usize, frame.height as usize);
    (0..frame.pixels())
        .map(|k| {
            let (x, y) = (k % w, k / w);
            let within = |ok: bool, n: usize| ok && frame.hits(n);
            let surrounded = within(x > 0, k.wrapping_sub(1))
                && within(x + 1 < w, k + 1)
                && within(y > 0, k.wrapping_sub(w))
                && within(y + 1 < h, k + w);
            frame.hits(k) && !surrounded
        })
        .collect()
}

/// The pixels that are marked in `from` and not in `to`, each with its distance to the nearest that
/// is marked in `to`. Silhouettes that are alike differ in few pixels.
pub(super) fn ways(from: &[bool], to: &[bool], width: usize) -> Vec<(usize, f64)> {
    let marked = (0..to.len()).filter(|&k| to[k]);
    let places: Vec<[i32; 2]> = marked.map(|k| place(k, width)).collect();
    let square = |[x, y]: [i32; 2], [i, j]: &[i32; 2]| (x - i).pow(2) + (y - j).pow(2);
    let apart = (0..from.len())
        .into_par_iter()
        .filter(|&k| from[k] && !to[k]);
    let nearest = |k| {
        let squares = places.iter().map(|other| square(place(k, width), other));
        squares.min().map(|square| (k, f64::from(square).sqrt()))
    };
    apart.filter_map(nearest).collect()
}

fn place(k: usize, width: usize) -> [i32; 2] {
    [(k % width) as i32, (k / width) as i32]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn frame(solid: impl Fn(i32, i32) -> bool) -> Frame {
        let mut frame = Frame::new(60, 40, [0.0; 4]).unwrap();
        for k in 0..frame.pixels() {
            if solid(k as i32 % 60, k as i32 / 60) {
                frame.distance[k] = 1.0;
            }
        }
        frame
    }

    fn block(x: i32, y: i32) -> bool {
        (10..30).contains(&x) && (10..25).contains(&y)
    }

    #[test]
    fn planted_shifts_are_measured() {
        let base = frame(block);
        assert_eq!(silhouette_hausdorff(&base, &base), 0.0);
        for (dx, dy) in [(1, 0), (0, 2), (3, 4), (-5, 2)] {
            let moved = frame(|x, y| block(x - dx, y - dy));
            let expected = f64::from(dx * dx + dy * dy).sqrt();
            assert!((silhouette_hausdorff(&base, &moved) - expected).abs() < 1e-12);
            assert_eq!(
                silhouette_hausdorff(&base, &moved),
                silhouette_hausdorff(&moved, &base)
            );
        }
        // One ghost, 7 to the right of the block and 3 below it.
        let spot = frame(|x, y| block(x, y) || (x, y) == (36, 27));
        assert!((silhouette_hausdorff(&base, &spot) - 58f64.sqrt()).abs() < 1e-12);
        // A hole in the middle: its rim lies 7 from the nearest edge, less one.
        let holed = frame(|x, y| block(x, y) && (x, y) != (20, 17));
        assert!((silhouette_hausdorff(&base, &holed) - 7.0).abs() <= 1.0);
    }

    #[test]
    fn empty_and_full_pictures() {
        let (none, all) = (frame(|_, _| false), frame(|_, _| true));
        assert_eq!(silhouette_hausdorff(&none, &none), 0.0);
        assert_eq!(silhouette_hausdorff(&all, &all), 0.0);
        assert_eq!(silhouette_hausdorff(&all, &none), f64::INFINITY);
        assert_eq!(
            silhouette(&all).iter().filter(|&&s| s).count(),
            2 * 60 + 2 * 38
        );
    }
}
