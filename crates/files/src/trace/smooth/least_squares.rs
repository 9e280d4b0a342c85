//! Lines and parabolas through points by least squares.

use glam::{DMat3, DVec2, DVec3};

/// A parabola at one of its points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parabola {
    pub(super) point: DVec2,
    /// The curve's direction there.
    pub(super) way: DVec2,
    /// Root mean square and largest of the residuals across the curve.
    pub(super) rms: f64,
    pub(super) most: f64,
}

/// The parabola through points `from..=to` in the arc length (`place`, up to each of the points).
/// Returns its point at `k` and the residuals' rms and largest.
pub(super) fn parabola(
    points: &[DVec2],
    place: &[f64],
    k: usize,
    from: usize,
    to: usize,
) -> Option<Parabola> {
    let scale = (place[to] - place[from]).max(1e-9);
    let at = |j: usize| (place[j] - place[k]) / scale;
    // Sums of powers, and of powers times points.
    let (mut s, mut t) = ([0.0; 5], [DVec2::ZERO; 3]);
    for j in from..=to {
        let x = at(j);
        let p = points[j] - points[k];
        let (x2, x3) = (x * x, x * x * x);
        for (sum, v) in s.iter_mut().zip([1.0, x, x2, x3, x2 * x2]) {
            *sum += v;
        }
        t[0] += p;
        t[1] += p * x;
        t[2] += p * x2;
    }
    let sums = DMat3::from_cols_array_2d(&[0, 1, 2].map(|k| [s[k], s[k + 1], s[k + 2]]));
    if sums.determinant().abs() < 1e-12 {
        return None;
    }
    let solved = |part: fn(DVec2) -> f64| sums.inverse() * DVec3::from(t.map(part));
    let (x, y) = (solved(|p| p.x), solved(|p| p.y));
    let c = [0, 1, 2].map(|k| DVec2::new(x[k], y[k]));
    let (mut sum, mut most) = (0.0, 0.0f64);
    for j in from..=to {
        let x = at(j);
        let off = points[j] - points[k] - (c[0] + c[1] * x + c[2] * (x * x));
        // Residuals count across the curve only; their component along the curve is ignored.
        let across = (c[1] + c[2] * (2.0 * x)).normalize_or_zero().perp_dot(off);
        sum += across * across;
        most = most.max(across.abs());
    }
    let rms = (sum / (to - from + 1) as f64).sqrt();
    Some(Parabola {
        point: points[k] + c[0],
        way: c[1].normalize_or_zero(),
        rms,
        most,
    })
}

/// The intersection of two lines, unless they are nearly parallel.
pub(super) fn meeting([(p, u), (q, v)]: [(DVec2, DVec2); 2]) -> Option<DVec2> {
    let cross = u.perp_dot(v);
    (cross.abs() > 0.1).then(|| p + u * ((q - p).perp_dot(v) / cross))
}

/// The line with the least squares of distances: a point, the direction from first to last, the
/// largest distance.
pub(super) fn line_through(points: &[DVec2]) -> Option<(DVec2, DVec2, f64)> {
    if points.len() < 3 {
        return None;
    }
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in points {
        let q = *p - middle;
        xx += q.x * q.x;
        xy += q.x * q.y;
        yy += q.y * q.y;
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let mut way = DVec2::from_angle(angle);
    if way.dot(points[points.len() - 1] - points[0]) < 0.0 {
        way = -way;
    }
    let most = points
        .iter()
        .fold(0.0f64, |m, p| m.max(way.perp_dot(*p - middle).abs()));
    Some((middle, way, most))
}
