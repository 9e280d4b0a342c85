//! Lines and conics that can carry an offset contour, and the intersections of two of them.

use super::{Candidate, Layer};
use glam::DVec2;
use std::f64::consts::TAU;

/// A curve that can carry part of the contour.
#[derive(Clone, Copy, Debug)]
pub(super) enum Curve {
    /// From `a` to `b`; the parameter is from 0 to 1.
    Line { a: DVec2, b: DVec2 },
    /// `focus + size / (1 - beta sin x) (cos x, sin x)`, `x` the parameter.
    Conic {
        focus: DVec2,
        size: f64,
        from: f64,
        to: f64,
    },
}

impl Curve {
    pub(super) fn range(&self) -> [f64; 2] {
        match *self {
            Self::Line { .. } => [0.0, 1.0],
            Self::Conic { from, to, .. } => [from, to],
        }
    }

    pub(super) fn point(&self, beta: f64, x: f64) -> DVec2 {
        match *self {
            Self::Line { a, b } => a.lerp(b, x),
            Self::Conic { focus, size, .. } => {
                let (sin, cos) = x.sin_cos();
                focus + DVec2::new(cos, sin) * (size / (1.0 - beta * sin))
            }
        }
    }

    /// Its ends; exactly on the borders of layer and half-plane if they are there.
    pub(super) fn ends(&self, layer: &Layer) -> [DVec2; 2] {
        match *self {
            Self::Line { a, b } => [a, b],
            Self::Conic { from, to, .. } => {
                [from, to].map(|x| layer.snapped(self.point(layer.beta, x)))
            }
        }
    }

    /// Parameters at which a conic meets the line `normal . q = offset`, each once and not yet
    /// reduced to its range: `A cos x + B sin x = C`.
    pub(super) fn meets_line(
        &self,
        beta: f64,
        normal: DVec2,
        offset: f64,
    ) -> impl Iterator<Item = f64> + use<> {
        let mut found = [None, None];
        if let Self::Conic { focus, size, .. } = *self {
            let c = offset - normal.dot(focus);
            let (a, b) = (size * normal.x, size * normal.y + beta * c);
            let cosine = c / a.hypot(b);
            if cosine.abs() <= 1.0 {
                let (middle, half) = (b.atan2(a), cosine.acos());
                found = [Some(middle - half), Some(middle + half)];
            }
        }
        found.into_iter().flatten()
    }
}

/// An angle, shifted by full turns to be between two others if possible (within rounding).
pub(super) fn within(x: f64, from: f64, to: f64) -> Option<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let turned = x + ((low - 1e-9 - x) / TAU).ceil() * TAU;
    (turned <= high + 1e-9).then(|| turned.clamp(low, high))
}

/// Finds the intersections of two curves: parameter on the first, on the second, point.
pub(super) fn meet(
    beta: f64,
    first: &Candidate,
    second: &Candidate,
    mut found: impl FnMut(f64, f64, DVec2),
) {
    const END: f64 = 1e-9;
    match (first.curve, second.curve) {
        (Curve::Line { a, b }, Curve::Line { a: c, b: d }) => {
            let (u, v) = (b - a, d - c);
            let cross = u.perp_dot(v);
            // Parallel lines do not meet, or they coincide.
            if cross.abs() <= 1e-14 * u.length() * v.length() {
                return;
            }
            let x = (c - a).perp_dot(v) / cross;
            let y = (c - a).perp_dot(u) / cross;
            let (ex, ey) = (END / u.length(), END / v.length());
            if x > -ex && x < 1.0 + ex && y > -ey && y < 1.0 + ey {
                found(x.clamp(0.0, 1.0), y.clamp(0.0, 1.0), a + u * x);
            }
        }
        (Curve::Line { a, b }, conic) => {
            if first.feature.abs_diff(second.feature) > 1 {
                line_and_conic(beta, a, b, &conic, found);
            }
        }
        (conic, Curve::Line { a, b }) => {
            if first.feature.abs_diff(second.feature) > 1 {
                line_and_conic(beta, a, b, &conic, |x, y, p| found(y, x, p));
            }
        }
        (
            Curve::Conic { focus: f, size, .. },
            Curve::Conic {
                focus: g, from, to, ..
            },
        ) => {
            if first.feature == second.feature || f == g {
                return;
            }
            let [low, high] = first.curve.range();
            let normal = g - f;
            let offset = 0.5 * normal.dot(f + g);
            for x in first.curve.meets_line(beta, normal, offset) {
                let Some(x) = within(x, low, high) else {
                    continue;
                };
                let p = first.curve.point(beta, x);
                // Both conics have the same offset there, so the point is on the same side of the
                // surface for both.
                let away = (p - g) * (size / (1.0 - beta * x.sin())).signum();
                let y = away.y.atan2(away.x);
                if let Some(y) = within(y, from, to) {
                    found(x, y, p);
                }
            }
        }
    }
}

fn line_and_conic(
    beta: f64,
    a: DVec2,
    b: DVec2,
    conic: &Curve,
    mut found: impl FnMut(f64, f64, DVec2),
) {
    let along = b - a;
    let normal = along.perp();
    let [from, to] = conic.range();
    let slack = 1e-9 / along.length();
    for x in conic.meets_line(beta, normal, normal.dot(a)) {
        let Some(x) = within(x, from, to) else {
            continue;
        };
        let p = conic.point(beta, x);
        let y = (p - a).dot(along) / along.length_squared();
        if y > -slack && y < 1.0 + slack {
            found(y.clamp(0.0, 1.0), x, p);
        }
    }
}
