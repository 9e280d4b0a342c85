//! How the time of each way of drawing grows with a quantity.

use crate::measure::row::Row;
use crate::plan::method::MethodSettings;
use crate::plan::variant;
use revmap_figures::groups::grouped;
use revmap_figures::stats::{self, Interval, PowerLaw};

/// A way of drawing over a quantity.
#[derive(Clone, Debug)]
pub struct Growth {
    pub way: MethodSettings,
    /// `(quantity, ms)` of resolved times, growing.
    pub points: Vec<(f64, f64)>,
    /// How many times were measured, resolved or not.
    pub measured: usize,
    /// The law through all points; `None` of fewer than two.
    pub law: Option<PowerLaw>,
    /// Its exponent: the mean of the passes' own, with Student's interval over the passes. It tells
    /// how sure the exponent is, not how well a power law fits.
    pub exponent: Option<Interval>,
    /// The exponent between the last two points: what it comes to when fixed costs no longer count.
    pub last: Option<f64>,
}

/// A way of drawing, without the rows of its map, which may be what grows.
pub(crate) fn growing(settings: &MethodSettings) -> MethodSettings {
    MethodSettings {
        map_rows: None,
        ..variant(settings)
    }
}

/// Every way's growth with a quantity, from times whose intervals are no wider than `resolved`.
pub fn growth<'a>(
    rows: &[&'a Row],
    quantity: impl Fn(&Row) -> Option<f64>,
    resolved: f64,
) -> Vec<Growth> {
    let point = |row: &&'a Row| Some((quantity(row)?, row.time()?.value, *row));
    let known = rows.iter().filter_map(point);
    let ways = grouped(known, |(_, _, row)| growing(&row.settings)).into_iter();
    ways.map(|(way, mut own)| {
        let measured = own.len();
        own.retain(|(_, _, row)| row.resolved(resolved));
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let points: Vec<(f64, f64)> = own.iter().map(|(x, time, _)| (*x, *time)).collect();
        let passes: Vec<Vec<f64>> = own.iter().map(|(.., row)| row.pass_medians()).collect();
        let count = passes.iter().map(Vec::len).min().unwrap_or(0);
        let of_pass = |pass: usize| {
            let points = points.iter().zip(&passes);
            let points: Vec<_> = points.map(|(p, times)| (p.0, times[pass])).collect();
            PowerLaw::fit(&points).map(|law| law.exponent)
        };
        Growth {
            way,
            measured,
            law: PowerLaw::fit(&points),
            exponent: stats::mean(&(0..count).filter_map(of_pass).collect::<Vec<_>>()),
            last: match points.as_slice() {
                [.., (x0, y0), (x1, y1)] => Some((y1 / y0).ln() / (x1 / x0).ln()),
                _ => None,
            },
            points,
        }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::timed;

    #[test]
    fn planted_exponents_are_found() {
        let square = |side: u32, passes: [f64; 2]| {
            timed(&passes).set(|s| (s.width, s.height) = (side, side))
        };
        let law = |side: u32| square(side, [2.0 * f64::from(side * side).powf(0.9); 2]);
        let mut rows = [100, 200, 400, 800].map(law).to_vec();
        // Far off, and not resolved.
        rows.push(square(1600, [1.0, 900.0]));
        let rows: Vec<&Row> = rows.iter().collect();
        let pixels = |r: &Row| Some(f64::from(r.settings.width) * f64::from(r.settings.height));
        let found = growth(&rows, pixels, 0.25);
        assert_eq!(
            (found.len(), found[0].points.len(), found[0].measured),
            (1, 4, 5)
        );
        let exponent = found[0].law.unwrap().exponent;
        assert!((exponent - 0.9).abs() < 1e-9 && (found[0].last.unwrap() - 0.9).abs() < 1e-9);
        assert!(growth(&rows, |_| None, 0.25).is_empty());
    }
}
