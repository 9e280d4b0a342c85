//! Fairs a curve whose points err, as those of a photograph do: bumps go, corners stay.
//!
//! The faired curve `c` of points `p` has the least `sum w |c - p|^2 + reach^4 sum b |c''|^2`, which
//! is a smoothing spline (E. Whittaker, *On a new method of graduation*, 1923). The weights are
//! renewed a few times: `w` falls where a point is farther away than noise moves it, and `b` where
//! the curve bends so sharply that it has a corner. Lengths are distances of neighbouring points.

use glam::DVec2;

/// Rounds of new weights.
const ROUNDS: usize = 8;
/// A point this many times as far away as the noise counts by one half.
const OUTLYING: f64 = 6.0;
/// A bend of this many radians from point to point counts by one half.
const SHARP: f64 = 0.06;
/// Weight of both ends, which stay.
const FIXED: f64 = 1e6;

/// The faired curve. Bumps shorter than about six times `reach` go.
pub(super) fn fair(points: &[DVec2], reach: f64, noise: f64) -> Vec<DVec2> {
    let count = points.len();
    if count < 3 {
        return points.to_vec();
    }
    let half = |of: f64| 1.0 / (1.0 + of * of);
    let mut weights = vec![1.0; count];
    let mut bends = vec![reach.powi(4); count - 2];
    let mut curve = Vec::new();
    for _ in 0..ROUNDS {
        (weights[0], weights[count - 1]) = (FIXED, FIXED);
        curve = solved(points, &weights, &bends);
        for ((weight, c), p) in weights.iter_mut().zip(&curve).zip(points) {
            *weight = half(c.distance(*p) / (OUTLYING * noise));
        }
        for (bend, c) in bends.iter_mut().zip(curve.windows(3)) {
            *bend = reach.powi(4) * half((c[0] - 2.0 * c[1] + c[2]).length() / SHARP);
        }
    }
    curve
}

/// The curve of least squares, by elimination in a symmetric matrix of five diagonals.
fn solved(points: &[DVec2], weights: &[f64], bends: &[f64]) -> Vec<DVec2> {
    let count = points.len();
    let (mut own, mut next) = (weights.to_vec(), vec![0.0; count + 1]);
    let mut second = vec![0.0; count];
    own.extend([1.0; 2]);
    for (i, b) in bends.iter().enumerate() {
        own[i] += b;
        own[i + 1] += 4.0 * b;
        own[i + 2] += b;
        next[i] -= 2.0 * b;
        next[i + 1] -= 2.0 * b;
        second[i] = *b;
    }
    let mut curve: Vec<DVec2> = points.iter().zip(weights).map(|(p, w)| *p * *w).collect();
    curve.extend([DVec2::ZERO; 2]);
    for i in 0..count {
        let (first, other) = (next[i] / own[i], second[i] / own[i]);
        own[i + 1] -= first * next[i];
        next[i + 1] -= first * second[i];
        own[i + 2] -= other * second[i];
        let at = curve[i];
        curve[i + 1] -= first * at;
        curve[i + 2] -= other * at;
    }
    for i in (0..count).rev() {
        curve[i] = (curve[i] - next[i] * curve[i + 1] - second[i] * curve[i + 2]) / own[i];
    }
    curve.truncate(count);
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bumps_go_and_corners_stay() {
        // A roof of slope 1 and its bumps: one pixel high, and one of 4 pixels at a point.
        let clean = |k: usize| DVec2::new(k as f64, (100.0 - k as f64).abs());
        let bumps = |k: usize| [0.1, -0.12, 0.03, -0.07, 0.09, 0.02][k * k % 6];
        let mut points: Vec<DVec2> = (0..=200)
            .map(|k| clean(k) + DVec2::new(0.0, bumps(k)))
            .collect();
        points[60].y += 4.0;
        let curve = fair(&points, 4.0, 0.1);
        assert_eq!(curve.len(), points.len());
        for (k, c) in curve.iter().enumerate() {
            assert!(c.distance(clean(k)) < 0.35, "{k}: {c}");
        }
        for (k, c) in curve
            .windows(2)
            .enumerate()
            .filter(|(k, _)| k.abs_diff(99) > 6)
        {
            let slope = (c[1].y - c[0].y) / (c[1].x - c[0].x);
            assert!((slope.abs() - 1.0).abs() < 0.035, "{k}: {slope}");
        }
    }
}
