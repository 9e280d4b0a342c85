//! How far apart two silhouettes are.

use revmap::frame::Frame;
use revmap::maps::transform::{Surroundings, squared_to_other};

/// Hausdorff distance of the silhouettes in pixels: the farthest that a pixel of one lies from the
/// nearest of the other.
///
/// A silhouette is made of the pixels that hit and have a neighbour (left, right, above, below)
/// that does not; holes have one too, and beyond the picture nothing hits. 0 when neither frame
/// hits anything, `+inf` when only one does.
#[must_use]
pub fn silhouette_hausdorff(a: &Frame, b: &Frame) -> f64 {
    let (edge_a, edge_b) = (silhouette(a), silhouette(b));
    match (edge_a.contains(&true), edge_b.contains(&true)) {
        (false, false) => return 0.0,
        (true, true) => {}
        _ => return f64::INFINITY,
    }
    let farthest = |from: &[bool], to: &[bool]| {
        let squares = squares_to(to, a.width as usize);
        let own = from.iter().zip(squares).filter(|(is, _)| **is);
        own.fold(0.0, |m: f64, (_, s)| m.max(s))
    };
    let both = farthest(&edge_a, &edge_b).max(farthest(&edge_b, &edge_a));
    both.sqrt()
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

/// Square of the distance of every pixel to the nearest marked one, exact.
pub(super) fn squares_to(marked: &[bool], width: usize) -> Vec<f64> {
    let around = Surroundings {
        left: false,
        others: false,
    };
    let squares = squared_to_other(marked, width, around);
    let own = |(is_marked, square): (&bool, u32)| if *is_marked { 0.0 } else { square.into() };
    marked.iter().zip(squares).map(own).collect()
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
            let found = silhouette_hausdorff(&base, &moved);
            assert!((found - expected).abs() < 1e-12);
            assert_eq!(found, silhouette_hausdorff(&moved, &base));
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
        let rim = silhouette(&all).iter().filter(|&&s| s).count();
        assert_eq!(rim, 2 * 60 + 2 * 38);
    }

    #[test]
    fn the_transform_is_exact() {
        let (w, h) = (23, 17);
        for seed in 0u32..20 {
            let hash = |k: usize| {
                (k as u32)
                    .wrapping_mul(2_654_435_761)
                    .wrapping_add(seed * 977)
            };
            let is_marked = |k| hash(k).is_multiple_of(29 + seed);
            let marked: Vec<bool> = (0..w * h).map(is_marked).collect();
            if !marked.contains(&true) {
                continue;
            }
            for (k, found) in squares_to(&marked, w).into_iter().enumerate() {
                let best = (0..w * h)
                    .filter(|&m| marked[m])
                    .map(|m| (m % w).abs_diff(k % w).pow(2) + (m / w).abs_diff(k / w).pow(2))
                    .min();
                assert_eq!(found, best.unwrap() as f64);
            }
        }
    }
}
