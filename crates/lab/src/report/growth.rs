//! How the time of each way of drawing grows with a quantity.

use super::plan::variant;
use super::row::Row;
use super::stats::{self, Interval, PowerLaw};
use crate::method::MethodSettings;

/// A way of drawing over a quantity.
#[derive(Clone, Debug)]
pub struct Growth {
    /// The way, without what is varied.
    pub way: MethodSettings,
    /// `(quantity, ms)` of resolved times, growing.
    pub points: Vec<(f64, f64)>,
    /// How many times were measured, resolved or not.
    pub measured: usize,
    /// The medians of each pass, point by point.
    passes: Vec<Vec<f64>>,
    /// The law through all points; `None` of fewer than two.
    pub law: Option<PowerLaw>,
    /// Its exponent: the mean of the passes' own, with Student's interval over the passes. It tells
    /// how sure the exponent is, not how well a power law fits.
    pub exponent: Option<Interval>,
    /// The exponent between the last two points: what it comes to when fixed costs no longer count.
    pub last: Option<f64>,
}

/// A way of drawing, without the rows of its map, which may be what grows.
pub(super) fn growing(settings: &MethodSettings) -> MethodSettings {
    MethodSettings {
        map_rows: None,
        ..variant(settings)
    }
}

/// Every way's growth with a quantity, from times whose intervals are no wider than `resolved`.
#[must_use]
pub fn growth(rows: &[&Row], quantity: impl Fn(&Row) -> Option<f64>, resolved: f64) -> Vec<Growth> {
    let mut all: Vec<Growth> = Vec::new();
    for row in rows {
        let (Some(x), Some(time)) = (quantity(row), row.time()) else {
            continue;
        };
        let way = growing(&row.settings);
        let index = all.iter().position(|g| g.way == way).unwrap_or_else(|| {
            all.push(Growth {
                way,
                points: Vec::new(),
                measured: 0,
                passes: Vec::new(),
                law: None,
                exponent: None,
                last: None,
            });
            all.len() - 1
        });
        all[index].measured += 1;
        if !row.resolved(resolved) {
            continue;
        }
        let place = all[index].points.partition_point(|p| p.0 < x);
        all[index].points.insert(place, (x, time.value));
        all[index].passes.insert(place, row.pass_medians());
    }
    for one in &mut all {
        one.law = PowerLaw::fit(&one.points);
        let count = one.passes.iter().map(Vec::len).min().unwrap_or(0);
        let of_pass = |pass: usize| {
            let points = one.points.iter().zip(&one.passes);
            let points: Vec<_> = points.map(|(p, times)| (p.0, times[pass])).collect();
            PowerLaw::fit(&points).map(|law| law.exponent.value)
        };
        one.exponent = stats::mean(&(0..count).filter_map(of_pass).collect::<Vec<_>>());
        one.last = match one.points.as_slice() {
            [.., (x0, y0), (x1, y1)] => Some((y1 / y0).ln() / (x1 / x0).ln()),
            _ => None,
        };
    }
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::row::tests::row;
    use super::*;

    #[test]
    fn planted_exponents_are_found() {
        let mut rows = Vec::new();
        for (w, h) in [(100, 100), (200, 200), (400, 400), (800, 800)] {
            let ms = 2.0 * (f64::from(w * h)).powf(0.9);
            let mut r = row(&[&[(None, ms)], &[(None, ms)]]);
            (r.settings.width, r.settings.height) = (w, h);
            rows.push(r);
        }
        // Far off, and not resolved.
        let mut noisy = row(&[&[(None, 1.0)], &[(None, 900.0)]]);
        (noisy.settings.width, noisy.settings.height) = (1600, 1600);
        rows.push(noisy);
        let rows: Vec<&Row> = rows.iter().collect();
        let pixels = |r: &Row| Some(f64::from(r.settings.width) * f64::from(r.settings.height));
        let found = growth(&rows, pixels, 0.25);
        assert_eq!(
            (found.len(), found[0].points.len(), found[0].measured),
            (1, 4, 5)
        );
        let exponent = found[0].law.unwrap().exponent.value;
        assert!((exponent - 0.9).abs() < 1e-9 && (found[0].last.unwrap() - 0.9).abs() < 1e-9);
        assert!(growth(&rows, |_| None, 0.25).is_empty());
    }
}
