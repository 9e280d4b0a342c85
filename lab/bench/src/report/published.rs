//! The tables of frame rates that were published (article of 2022, tables 1 to 3), beside our own.

use crate::measure::ratios::between;
use crate::measure::row::Row;
use crate::plan::variant;
use crate::report::columns::Context;
use revmap_figures::groups::grouped;
use revmap_figures::names::number;
use revmap_figures::stats::{Interval, Verdict};
use revmap_figures::table::Table;

/// A published table, measured by its authors on a Core i7-3612QM with a GeForce GT 630M.
pub struct Printed {
    letter: char,
    /// The parameter's values: `e` and `b` as fractions of the largest distance in the map.
    values: [f64; 3],
    /// Frames per second at each of [`SIZES`].
    rates: [[f64; 3]; 2],
    /// The article's claim: how speed changes as the parameter grows.
    claim: &'static str,
}

/// Sizes of the published pictures.
const SIZES: [&str; 2] = ["800x600", "1366x706"];

const FALLS: &str = "falls";
const RISES: &str = "rises";

/// The published table of this number.
pub fn table(number: &str) -> Option<Printed> {
    let (letter, last, claim) = match number {
        "1" => ('e', 0.8, FALLS),
        "2" => ('b', 0.8, RISES),
        "3" => ('c', 0.7, RISES),
        _ => return None,
    };
    let rates = match letter {
        'e' => [[180.0, 170.0, 160.0], [150.0, 145.0, 130.0]],
        'b' => [[200.0, 210.0, 230.0], [190.0, 195.0, 200.0]],
        _ => [[195.0, 209.0, 216.0], [174.0, 176.0, 182.0]],
    };
    let values = [0.25, 0.5, last];
    Some(Printed {
        letter,
        values,
        rates,
        claim,
    })
}

impl Printed {
    /// The published line at a size: the parameter and the rate, over the first if `over_first`.
    pub fn line(&self, size: &str, over_first: bool) -> Vec<(f64, f64)> {
        let Some(place) = SIZES.iter().position(|s| *s == size) else {
            return Vec::new();
        };
        let rates = self.rates[place];
        let unit = if over_first { rates[0] } else { 1.0 };
        let rates = rates.map(|r| r / unit);
        self.values.into_iter().zip(rates).collect()
    }
}

/// How the speed goes from a table's first value to its last, with the ratio of the rates.
fn trend(first: &Row, last: &Row, resolved: f64) -> Option<(&'static str, Interval)> {
    // Rates are one over times.
    let ratio = between(first, last)?;
    let word = match ratio.verdict(resolved) {
        Verdict::Slower => RISES,
        Verdict::Faster => FALLS,
        Verdict::Even => "no clear change",
        Verdict::Unresolved => "not resolved",
    };
    Some((word, ratio))
}

/// A published table, the published figures above ours at each size.
pub(crate) fn published(context: &Context, rows: &[&Row], number_of: &str) -> Table {
    let Some(printed) = table(number_of) else {
        return Table::default();
    };
    let [a, b, c] = (printed.values).map(|v| format!("{} = {}", printed.letter, number(v, 3)));
    let names = ["size", "method", "stage", &a, &b, &c];
    let header = names.into_iter().chain(["last rate / first", "trend"]);
    let mut out = Table::new(header, Vec::new());
    let place = |row: &Row| printed.values.iter().position(|v| Some(*v) == row.value);
    let own = rows.iter().copied().filter(|row| place(row).is_some());
    let mut sizes = grouped(own, |r| (r.settings.width, r.settings.height));
    sizes.sort_by_key(|(size, _)| *size);
    for ((width, height), own) in sizes {
        let size = format!("{width}x{height}");
        // At sizes of the reader's own nothing was published, and the rest stands by itself.
        let rates = printed.line(&size, false);
        if let [(_, first), .., (_, last)] = rates.as_slice() {
            let mut record = vec![size.clone(), "published, GT 630M".into(), "fragment".into()];
            record.extend(rates.iter().map(|r| number(r.1, 4)));
            record.extend([number(last / first, 3), printed.claim.to_owned()]);
            out.records.push(record);
        }
        for (way, own) in grouped(own, |r| variant(&r.settings)) {
            let cells = [0, 1, 2].map(|k| own.iter().rfind(|r| place(r) == Some(k)));
            let none = || "–".to_owned();
            // In brackets: not resolved.
            let rate = |row: Option<&&Row>| match row.and_then(|r| Some((r, r.time()?.value))) {
                Some((row, ms)) if row.resolved(context.resolved) => number(1e3 / ms, 3),
                Some((_, ms)) => format!("({})", number(1e3 / ms, 3)),
                None => none(),
            };
            let ends = cells[0].zip(cells[2]);
            let found = ends.and_then(|(first, last)| trend(first, last, context.resolved));
            let ratio = found.map(|(_, ratio)| context.known(Some(ratio)).shown());
            let stage = way.stage.name().to_owned();
            let mut record = vec![size.clone(), context.styles.way(&way), stage];
            record.extend(cells.map(rate));
            record.push(ratio.unwrap_or_else(none));
            record.push(found.map_or_else(none, |f| f.0.to_owned()));
            out.records.push(record);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::timed;
    use crate::report::columns::tests::with_context;

    #[test]
    fn trends_are_told_only_when_they_are_sure() {
        let slow = timed(&[20.0, 20.4, 19.8, 20.1]);
        let fast = timed(&[10.0, 10.1, 9.9, 10.2]);
        let noisy = timed(&[14.0, 30.0, 20.0, 24.0]);
        assert_eq!(trend(&slow, &fast, 0.25).unwrap().0, RISES);
        assert_eq!(trend(&fast, &slow, 0.25).unwrap().0, FALLS);
        assert_eq!(trend(&slow, &noisy, 1.0).unwrap().0, "no clear change");
        assert_eq!(trend(&slow, &noisy, 0.25).unwrap().0, "not resolved");
    }

    #[test]
    fn a_line_holds_its_three_values() {
        let of = |(value, ms, size)| Row {
            value: Some(value),
            ..timed(&[ms, ms]).set(|s| (s.width, s.height) = size)
        };
        let (size, other) = ((800, 600), (1000, 600));
        let rows: Vec<Row> = [(0.25, 10.0, size), (0.5, 8.0, size), (0.8, 5.0, size)]
            .into_iter()
            .chain([(0.3, 1.0, size)])
            .chain([0.25, 0.5, 0.8].map(|value| (value, 4.0, other)))
            .map(of)
            .collect();
        let records = with_context(&rows, |context| {
            published(context, context.rows, "2").records
        });
        // Published figures stand above what was measured at their size, and nowhere else.
        assert_eq!(records.len(), 3);
        assert_eq!(records[2][..3], ["1000x600", "circle", "fragment"]);
        assert_eq!(records[2][3..6], ["250", "250", "250"]);
        assert_eq!(records[0][3..], ["200", "210", "230", "1.15", "rises"]);
        assert_eq!(records[1][3..7], ["100", "125", "200", "2 (2 to 2)"]);
    }
}
