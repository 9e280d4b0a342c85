//! Finds the first zero of a function with a known Lipschitz constant, without stepping over one.
//!
//! Let `|f(s) - f(t)| <= L |s - t|`. A sample `f(t)` proves that no zero is nearer to `t` than
//! `|f(t)| / L`. Two samples of one sign at distance `h` prove that the interval between them has
//! no zero if `|f(t)| + |f(t + h)| >= L h`. All steps are of these two kinds, down to values of
//! [`NEAR`]. Below that value, steps double from a tenth of it until the sign changes. The bracket
//! is then narrowed by the Illinois form of the false position, with halvings as a safeguard.

/// Steps are no longer proven below this value of the function: features thinner than this may be
/// missed.
pub(super) const NEAR: f64 = 1e-9;
/// A minimum below this value without a change of sign marks the ray as grazing.
pub(super) const GRAZE: f64 = 1e-7;
/// Steps after which a ray along a surface takes larger steps and is marked as grazing.
const PATIENCE: u32 = 100_000;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Search {
    pub zero: Option<f64>,
    /// True if a change of the last digits could make another zero the first one.
    pub grazes: bool,
}

/// The first zero of `f` in `[a, b]`, with `fa = f(a)`. A value of exactly 0 counts as negative.
pub(super) fn first_zero(
    f: &mut impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    fa: f64,
    lipschitz: f64,
) -> Search {
    let sign = if fa <= 0.0 { -1.0 } else { 1.0 };
    let crossed = |g: f64| g < 0.0 || (g == 0.0 && sign > 0.0);
    let (mut t, mut g) = (a, fa.abs());
    let mut creep = 0.0;
    let mut falling = false;
    let mut grazes = false;
    let mut steps = 0;
    while t < b {
        let free = g / lipschitz;
        let mut stretched = false;
        let mut step = if g > NEAR {
            creep = 0.1 * NEAR / lipschitz;
            // The next sample's own interval usually covers the rest away from a surface.
            stretched = !falling;
            if stretched { 1.9 * free } else { free }
        } else {
            creep *= 2.0;
            creep = creep.max(0.1 * NEAR / lipschitz);
            grazes |= creep * lipschitz > GRAZE;
            creep
        };
        steps += 1;
        if steps > PATIENCE {
            grazes = true;
            stretched = false;
            step = step.max((b - a) * 1e-4);
        }
        let mut next = (t + step).min(b);
        let mut value = sign * f(next);
        if stretched && (crossed(value) || g + value < lipschitz * (next - t)) {
            next = (t + free).min(b);
            value = sign * f(next);
        }
        if crossed(value) {
            let zero = narrow(f, sign, (t, g), (next, value), lipschitz);
            // A sliver: the sign changes back at once.
            let beyond = (zero + GRAZE / lipschitz).min(b);
            grazes |= !crossed(sign * f(beyond)) && beyond < b;
            return Search {
                zero: Some(zero),
                grazes,
            };
        }
        grazes |= falling && value > g && g < GRAZE;
        falling = value < g;
        if next <= t {
            // Steps below the resolution of t count as contact.
            grazes = true;
            next = t + (b - a) * 1e-12;
        }
        (t, g) = (next, value);
    }
    Search { zero: None, grazes }
}

/// The zero between `low`, where `sign * f` is positive, and `high`, where it is not.
fn narrow(
    f: &mut impl FnMut(f64) -> f64,
    sign: f64,
    mut low: (f64, f64),
    mut high: (f64, f64),
    lipschitz: f64,
) -> f64 {
    let tolerance = |t: f64| (1e-15 / lipschitz).max(2.0 * f64::EPSILON * t.abs());
    let mut kept = 0;
    for round in 0..200 {
        let width = high.0 - low.0;
        if width <= tolerance(high.0) {
            break;
        }
        // Every third round halves, for any values.
        let share = if round % 3 == 2 {
            0.5
        } else {
            (low.1 / (low.1 - high.1)).clamp(0.0, 1.0)
        };
        let margin = 0.25 * tolerance(high.0);
        let t = (low.0 + share * width).clamp(low.0 + margin, high.0 - margin);
        let g = sign * f(t);
        if g > 0.0 {
            low = (t, g);
            if kept == 1 {
                high.1 *= 0.5;
            }
            kept = 1;
        } else {
            high = (t, g);
            if kept == -1 {
                low.1 *= 0.5;
            }
            kept = -1;
        }
    }
    0.5 * (low.0 + high.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(mut f: impl FnMut(f64) -> f64, lipschitz: f64) -> Search {
        let fa = f(0.0);
        first_zero(&mut f, 0.0, 4.0, fa, lipschitz)
    }

    #[test]
    fn the_first_of_many_zeros_is_found_exactly() {
        // sin(20 t) + 0.99: dips just below zero, twenty times.
        let expected = (std::f64::consts::PI + 0.99f64.asin()) / 20.0;
        let found = find(|t| (20.0 * t).sin() + 0.99, 20.0);
        assert!((found.zero.unwrap_or(9.0) - expected).abs() < 1e-14);
        assert!(!found.grazes);
        // The function with the opposite sign.
        let found = find(|t| -(20.0 * t).sin() - 0.99, 20.0);
        assert!((found.zero.unwrap_or(9.0) - expected).abs() < 1e-14);
    }

    #[test]
    fn thin_walls_are_not_stepped_over() {
        for thickness in [1e-2, 1e-4, 1e-6, 1e-8] {
            let found = find(|t| (t - 3.0f64).abs() - thickness, 1.0);
            assert!(
                (found.zero.unwrap_or(9.0) - (3.0 - thickness)).abs() < 1e-14,
                "{thickness}"
            );
            assert_eq!(found.grazes, thickness < 0.4 * GRAZE);
        }
    }

    #[test]
    fn near_misses_are_marked() {
        for (clearance, marked) in [(1e-3, false), (1e-6, false), (1e-8, true), (0.0, true)] {
            let found = find(|t| (t - 2.0) * (t - 2.0) + clearance, 4.0);
            assert_eq!(found.grazes, marked, "{clearance}");
            assert!(found.zero.is_none() || clearance == 0.0);
        }
    }

    #[test]
    fn gliding_along_a_surface_ends() {
        for height in [0.0, 1e-12, 1e-9, 3e-9, 1e-8] {
            let mut count = 0;
            let found = find(
                |_| {
                    count += 1;
                    height
                },
                1.0,
            );
            assert!(found.grazes, "{height}");
            assert!(count < 200_000, "{height}: {count}");
        }
    }
}
