//! Real roots of polynomials; every root with a sign change is found.

/// Candidates for the roots of `a x^2 + 2 b x + c`: the roots, or the vertex if a root is missed by
/// no more than rounding.
pub(super) fn quadratic(a: f64, b: f64, c: f64) -> impl Iterator<Item = f64> {
    let mut square = b * b - a * c;
    if square < 0.0 && square > -1e-10 * (b * b + (a * c).abs()) {
        square = 0.0;
    }
    // The two terms have the same sign, so nothing cancels. If `a = 0`, the second quotient is the
    // remaining root.
    let q = -(b + square.sqrt().copysign(b));
    [q / a, c / q].into_iter().filter(|x| x.is_finite())
}

/// Candidates for the roots of a polynomial in `[0, 1]`: every root with a change of sign, exact to
/// rounding, and every turning point (which may hide a pair of roots). Coefficients from the
/// constant upwards.
pub(super) fn in_unit_interval(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len().saturating_sub(1);
    if degree == 0 {
        return Vec::new();
    }
    let derivative: Vec<f64> = (1..=degree).map(|k| coefficients[k] * k as f64).collect();
    let mut stops = in_unit_interval(&derivative);
    let mut roots = stops.clone();
    stops.push(1.0);
    stops.sort_by(f64::total_cmp);
    let value = |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let mut low = 0.0;
    for high in stops {
        // The polynomial is monotonic between turning points: one root at most.
        if (value(low) < 0.0) != (value(high) < 0.0) {
            roots.push(bisect(&value, low, high));
        }
        low = high;
    }
    roots
}

fn bisect(value: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let below = value(low) < 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if (value(middle) < 0.0) == below {
            low = middle
        } else {
            high = middle
        }
    }
}

/// A few Newton steps on the function itself, given as `(value, slope)`. Each step must reduce the
/// value, and the result must stay near the start.
pub(super) fn polish(start: f64, reach: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = start;
    let (mut value, mut slope) = f(x);
    for _ in 0..6 {
        let next = x - value / slope;
        let (v, s) = f(next);
        if v.is_nan() || v.abs() >= value.abs() || (next - start).abs() > reach {
            break;
        }
        (x, value, slope) = (next, v, s);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn expand(roots: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for r in roots {
            let mut next = vec![0.0; c.len() + 1];
            for (k, v) in c.iter().enumerate() {
                next[k + 1] += v;
                next[k] -= r * v;
            }
            c = next;
        }
        c
    }

    proptest! {
        #[test]
        fn planted_roots_are_found(roots in proptest::collection::vec(0.01..0.99f64, 1..5)) {
            let mut sorted = roots.clone();
            sorted.sort_by(f64::total_cmp);
            prop_assume!(sorted.windows(2).all(|p| p[1] - p[0] > 0.02));
            let found = in_unit_interval(&expand(&roots));
            for r in &roots {
                prop_assert!(found.iter().any(|f| (f - r).abs() < 1e-9), "{r} of {roots:?} not in {found:?}");
            }
        }

        #[test]
        fn quadratics_keep_their_small_roots(p in -1.0..1.0f64, scale in -8..8i32, factor in 0.1..10.0f64) {
            // The roots are p and 10^scale: the textbook formula loses one of them.
            let q = 10f64.powi(scale);
            prop_assume!(p.abs() > 1e-3 && (p - q).abs() > 0.1 * q.abs().max(p.abs()));
            let found: Vec<f64> = quadratic(factor, -factor * (p + q) / 2.0, factor * p * q).collect();
            for r in [p, q] {
                prop_assert!(found.iter().any(|f| (f / r - 1.0).abs() < 1e-12), "{r} not in {found:?}");
            }
        }
    }

    #[test]
    fn degenerate_quadratics() {
        assert_eq!(quadratic(0.0, 1.0, -6.0).collect::<Vec<_>>(), [3.0]);
        assert_eq!(quadratic(0.0, 0.0, 1.0).count(), 0);
        assert_eq!(quadratic(1.0, 0.0, 1.0).count(), 0);
        assert!(quadratic(1.0, -2.0, 4.0).all(|x| (x - 2.0).abs() < 1e-12));
    }
}
