//! A ray in the half-plane, and its intersections with the curves on which `F` may vanish.

use super::roots;
use glam::{DVec2, DVec3};

/// A curve of the half-plane on which `F` may vanish.
#[derive(Clone, Copy, Debug)]
pub(super) enum Curve {
    /// `alpha r + beta z = gamma`.
    Line { alpha: f64, beta: f64, gamma: f64 },
    /// The points whose distance to `corner` is `|start + slope z|`.
    Conic {
        corner: DVec2,
        start: f64,
        slope: f64,
    },
}

impl Curve {
    /// A normal of the turned curve at a point relative to the axis; its sign is undetermined.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        let r = p.truncate().length();
        let out = if r > 1e-12 {
            p.truncate() / r
        } else {
            DVec2::ZERO
        };
        match *self {
            Self::Line { alpha, beta, .. } => (out * alpha).extend(beta),
            Self::Conic {
                corner,
                start,
                slope,
            } => (out * (r - corner.x)).extend(p.z - corner.y - (start + slope * p.z) * slope),
        }
    }
}

/// A ray in the half-plane: `r^2 = a s^2 + 2 b s + c`, `z = z + s v`.
pub(super) struct Path {
    start: DVec3,
    direction: DVec3,
    length: f64,
    a: f64,
    b: f64,
    c: f64,
}

impl Path {
    pub fn new(start: DVec3, direction: DVec3, length: f64) -> Self {
        let (p, v) = (start.truncate(), direction.truncate());
        Self {
            start,
            direction,
            length,
            a: v.dot(v),
            b: p.dot(v),
            c: p.dot(p),
        }
    }

    pub fn point(&self, s: f64) -> DVec3 {
        self.start + self.direction * s
    }

    pub fn at(&self, s: f64) -> DVec2 {
        let p = self.point(s);
        DVec2::new(p.truncate().length(), p.z)
    }

    /// `r` and its slope along the ray.
    fn radius(&self, s: f64) -> (f64, f64) {
        let r = self.point(s).truncate().length();
        (r, (self.a * s + self.b) / r)
    }

    /// Every `s` at which the ray may meet the curve.
    pub fn meet(&self, curve: Curve) -> Box<dyn Iterator<Item = f64> + '_> {
        let (z, v) = (self.start.z, self.direction.z);
        let reach = 1e-3 * self.length;
        match curve {
            Curve::Line { alpha, beta, gamma } => {
                // alpha r = g0 - g1 s, squared.
                let (g0, g1) = (gamma - beta * z, beta * v);
                let k = alpha * alpha;
                let found = roots::quadratic(
                    k * self.a - g1 * g1,
                    k * self.b + g0 * g1,
                    k * self.c - g0 * g0,
                );
                Box::new(found.map(move |s| {
                    // Squaring made the roots of flat cones nearly double; they are single roots of
                    // the cone itself.
                    roots::polish(s, reach, |s| {
                        let (r, slope) = self.radius(s);
                        (alpha * r - g0 + g1 * s, alpha * slope + g1)
                    })
                }))
            }
            Curve::Conic {
                corner,
                start,
                slope,
            } => {
                if start == 0.0 && slope == 0.0 {
                    return Box::new(std::iter::empty());
                }
                // p(s) = r^2 + pr^2 + (z - pz)^2 - w^2 equals 2 pr r; in s = length x.
                let n = self.length;
                let (dz, w) = (z - corner.y, start + slope * z);
                let (w1, v1) = (slope * v, v);
                let p = [
                    self.c + corner.x * corner.x + dz * dz - w * w,
                    2.0 * (self.b + dz * v1 - w * w1) * n,
                    (self.a + v1 * v1 - w1 * w1) * n * n,
                ];
                if corner.x == 0.0 {
                    return Box::new(roots::quadratic(p[2], 0.5 * p[1], p[0]).map(move |x| x * n));
                }
                let k = 4.0 * corner.x * corner.x;
                let quartic = [
                    p[0] * p[0] - k * self.c,
                    2.0 * p[0] * p[1] - k * 2.0 * self.b * n,
                    2.0 * p[0] * p[2] + p[1] * p[1] - k * self.a * n * n,
                    2.0 * p[1] * p[2],
                    p[2] * p[2],
                ];
                let found = roots::in_unit_interval(&quartic).into_iter();
                Box::new(found.map(move |x| {
                    roots::polish(x * n, reach, |s| {
                        let (r, slope_r) = self.radius(s);
                        let x = s / n;
                        let value = p[0] + x * (p[1] + x * p[2]) - 2.0 * corner.x * r;
                        (
                            value,
                            (p[1] + 2.0 * x * p[2]) / n - 2.0 * corner.x * slope_r,
                        )
                    })
                }))
            }
        }
    }
}
