//! Two folders of results held against each other: two versions of the program, or two devices.

use super::csv::Table;
use super::names::number;
use super::row::COLUMNS;
use super::stats::{self, Interval};
use super::text;
use crate::error::{Error, Result, Stage};
use std::collections::HashMap;
use std::path::Path;

/// The columns that tell what was measured: rows that agree in them are the same measurement.
const KEY: &[&str] = COLUMNS.split_at(14).0;

/// Errors may differ by this share before they count as changed.
const ERROR_CHANGE: f64 = 0.05;

/// One measurement that both folders hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// What was measured: the values of the columns that tell it.
    pub key: Vec<String>,
    /// New time over old; `None` where a clock cannot be trusted.
    pub time: Option<Interval>,
    /// The same, each time first put over that of the papers' loop of the same picture, stage and run: what is left when one run had the
    /// slower machine. `None` where a run lacks that loop, and for the loop itself.
    pub relative: Option<Interval>,
    /// What of the errors has grown: column, old, new.
    pub worse: Vec<(&'static str, f64, f64)>,
    /// What of the errors has shrunk.
    pub better: Vec<(&'static str, f64, f64)>,
}

/// What became of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The interval lies above 1.
    Slower,
    /// It lies below 1.
    Faster,
    /// It holds 1.
    Same,
    /// A clock cannot be trusted.
    Unknown,
}

impl Pair {
    /// What became of its time: in proportion to the papers' loop where both runs have it.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match self.relative.or(self.time) {
            None => Verdict::Unknown,
            Some(t) if t.low > 1.0 => Verdict::Slower,
            Some(t) if t.high < 1.0 => Verdict::Faster,
            Some(_) => Verdict::Same,
        }
    }
}

/// Two runs side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// What both hold, in the order of the new run.
    pub pairs: Vec<Pair>,
    /// How many measurements only the old run has, and only the new one.
    pub alone: (usize, usize),
    /// Device and driver of each.
    pub devices: [String; 2],
}

/// A run as read.
struct Run {
    results: Table,
    /// Each row's medians by pass.
    medians: HashMap<usize, Vec<f64>>,
}

/// Columns that make a row the papers' loop, and their values.
const LOOP: [(&str, &[&str]); 4] = [
    ("solver", &["circle"]),
    ("max_steps", &["20", "25"]),
    ("map_source", &["binary"]),
    ("map_format", &["rgba8"]),
];

impl Run {
    fn load(folder: &Path) -> Result<Self> {
        let results = Table::load(&folder.join("results.csv"))?;
        if results.header != COLUMNS {
            return Err(Error::new(
                Stage::Report,
                "has other columns than this version writes; measure again",
            )
            .in_file(folder.join("results.csv")));
        }
        let raw_file = folder.join("raw.csv");
        let raw = Table::load(&raw_file)?;
        let named = |name: &str| raw.column(name).map_err(|e| e.in_file(&raw_file));
        let (row, pass, gpu, frame) = (
            named("row")?,
            named("pass")?,
            named("gpu_ms")?,
            named("frame_ms")?,
        );
        let mut samples: HashMap<usize, HashMap<usize, Vec<f64>>> = HashMap::new();
        let gpu_column = results.column("gpu_ms_median")?;
        for record in &raw.records {
            let whole = |at: usize| {
                record[at].parse::<usize>().map_err(|_| {
                    Error::new(
                        Stage::Report,
                        format!("{:?} is no number; measure again", record[at]),
                    )
                    .in_file(&raw_file)
                })
            };
            let row = whole(row)?;
            let told = results
                .records
                .get(row.wrapping_sub(1))
                .is_some_and(|r| !r[gpu_column].is_empty());
            let ms = record[if told { gpu } else { frame }].parse::<f64>();
            // A device's clock that was rejected has its wall clock in doubt as well.
            let rejected = !told && !record[gpu].is_empty();
            if let (Ok(ms), false) = (ms, rejected) {
                samples
                    .entry(row)
                    .or_default()
                    .entry(whole(pass)?)
                    .or_default()
                    .push(ms);
            }
        }
        let medians = samples.into_iter().map(|(row, passes)| {
            let mut passes: Vec<_> = passes.into_iter().collect();
            passes.sort_by_key(|(pass, _)| *pass);
            (
                row,
                passes
                    .iter()
                    .filter_map(|(_, times)| stats::median(times))
                    .collect(),
            )
        });
        Ok(Self {
            results,
            medians: medians.collect(),
        })
    }

    /// The passes' medians of a row (counted from 1), each over that of the papers' loop which shows the same picture in the same stage.
    fn over_loop(&self, row: usize) -> Option<Vec<f64>> {
        let at = |name: &str| COLUMNS.iter().position(|c| *c == name);
        let record = self.results.records.get(row.checked_sub(1)?)?;
        let is_loop = |r: &[String]| {
            LOOP.iter()
                .all(|(c, values)| at(c).is_some_and(|k| values.contains(&r[k].as_str())))
        };
        if is_loop(record) {
            return None;
        }
        let picture = [
            "scene",
            "technique",
            "extend",
            "bevel",
            "chamfer",
            "stage",
            "width",
            "height",
            "objects",
        ];
        let same = |r: &[String]| {
            picture
                .iter()
                .all(|c| at(c).is_some_and(|k| r[k] == record[k]))
        };
        let rival = self
            .results
            .records
            .iter()
            .position(|r| is_loop(r) && same(r))?
            + 1;
        let (own, rival) = (self.medians.get(&row)?, self.medians.get(&rival)?);
        Some(own.iter().zip(rival).map(|(a, b)| a / b).collect())
    }

    fn device(&self) -> String {
        let Some(record) = self.results.records.first() else {
            return String::new();
        };
        record[COLUMNS.len() - 2..].join(", ")
    }
}

/// Reads two folders that `revmap bench` or `revmap chart` wrote.
///
/// # Errors
/// [`Stage::Report`], naming the file: missing, damaged, of other columns, or with nothing in common.
pub fn compare(old: &Path, new: &Path) -> Result<Against> {
    let (before, after) = (Run::load(old)?, Run::load(new)?);
    let key = |record: &[String]| record[..KEY.len()].to_vec();
    let mut known: HashMap<Vec<String>, usize> = HashMap::new();
    for (number, record) in before.results.records.iter().enumerate() {
        known.entry(key(record)).or_insert(number);
    }
    let mut pairs = Vec::new();
    for (number, record) in after.results.records.iter().enumerate() {
        let Some(&twin) = known.get(&key(record)) else {
            continue;
        };
        let (worse, better) = errors(&before.results.records[twin], record);
        let time = match (
            after.medians.get(&(number + 1)),
            before.medians.get(&(twin + 1)),
        ) {
            (Some(a), Some(b)) => stats::ratio(a, b),
            _ => None,
        };
        let relative = match (after.over_loop(number + 1), before.over_loop(twin + 1)) {
            (Some(a), Some(b)) => stats::ratio(&a, &b),
            _ => None,
        };
        pairs.push(Pair {
            key: key(record),
            time,
            relative,
            worse,
            better,
        });
    }
    if pairs.is_empty() {
        return Err(Error::new(Stage::Report, "has no measurement in common with the other folder; measure the same scenes, stages and searches").in_file(new));
    }
    Ok(Against {
        alone: (
            before.results.records.len().saturating_sub(pairs.len()),
            after.results.records.len().saturating_sub(pairs.len()),
        ),
        devices: [before.device(), after.device()],
        pairs,
    })
}

/// The errors that have grown and those that have shrunk.
#[allow(clippy::type_complexity)]
fn errors(
    old: &[String],
    new: &[String],
) -> (Vec<(&'static str, f64, f64)>, Vec<(&'static str, f64, f64)>) {
    let (mut worse, mut better) = (Vec::new(), Vec::new());
    for name in [
        "missed",
        "ghost",
        "depth_p99_texels",
        "normal_rms_degrees",
        "flip",
    ] {
        let Some(at) = COLUMNS.iter().position(|c| *c == name) else {
            continue;
        };
        let (Ok(a), Ok(b)) = (old[at].parse::<f64>(), new[at].parse::<f64>()) else {
            continue;
        };
        // Pixels that a rounding decides come and go one by one.
        let slack = if matches!(name, "missed" | "ghost") {
            3.0
        } else {
            0.0
        };
        if b > a * (1.0 + ERROR_CHANGE) + slack {
            worse.push((name, a, b));
        } else if a > b * (1.0 + ERROR_CHANGE) + slack {
            better.push((name, a, b));
        }
    }
    (worse, better)
}

/// The comparison as text: all ratios, then what became slower, then what became less exact.
#[must_use]
pub fn as_text(against: &Against) -> String {
    let mut out = format!(
        "old: {}\nnew: {}\n\n",
        against.devices[0], against.devices[1]
    );
    let columns: Vec<usize> = (0..KEY.len())
        .filter(|&c| against.pairs.windows(2).any(|w| w[0].key[c] != w[1].key[c]))
        .collect();
    let columns = if columns.is_empty() {
        vec![0, 5, 6]
    } else {
        columns
    };
    let name = |pair: &Pair| {
        columns
            .iter()
            .map(|&c| pair.key[c].as_str())
            .filter(|v| !v.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let mut table = vec![
        [
            "measurement",
            "new / old",
            "95 % interval",
            "over the papers' loop",
            "95 % interval",
            "",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let told = |i: Option<Interval>| match i {
        Some(t) if t.high.is_finite() => [
            number(t.value, 3),
            format!("{} to {}", number(t.low, 3), number(t.high, 3)),
        ],
        Some(t) => [number(t.value, 3), "unknown".to_owned()],
        None => [String::new(), String::new()],
    };
    for pair in &against.pairs {
        let verdict = match pair.verdict() {
            Verdict::Slower => "slower",
            Verdict::Faster => "faster",
            Verdict::Same => "",
            Verdict::Unknown => "clocks disagree",
        };
        let [a, b] = told(pair.time);
        let [c, d] = told(pair.relative);
        table.push(vec![name(pair), a, b, c, d, verdict.to_owned()]);
    }
    out += &text::table(&table);
    let count = |v: Verdict| against.pairs.iter().filter(|p| p.verdict() == v).count();
    let ratios: Vec<f64> = against
        .pairs
        .iter()
        .filter_map(|p| p.time)
        .map(|t| t.value)
        .collect();
    let mean = stats::geometric(&ratios)
        .map(|i| number(i.value, 3))
        .unwrap_or_default();
    out += &format!(
        "\n{} in common: {} slower, {} faster, {} within their intervals; geometric mean of new / old: {mean}; {} only in the old run, {} only in the new one\n",
        against.pairs.len(),
        count(Verdict::Slower),
        count(Verdict::Faster),
        count(Verdict::Same),
        against.alone.0,
        against.alone.1
    );
    let loops: Vec<Interval> = against
        .pairs
        .iter()
        .filter(|p| p.relative.is_none())
        .filter_map(|p| p.time)
        .collect();
    if loops.iter().any(|t| t.low > 1.0 || t.high < 1.0)
        && against.pairs.iter().any(|p| p.relative.is_some())
    {
        out += "the papers' loop itself differs between the runs: one had the slower or busier machine, unless that loop was changed; verdicts are by the times over it\n";
    }
    for (what, of) in [
        (
            "less exact",
            (|p: &Pair| p.worse.clone()) as fn(&Pair) -> Vec<_>,
        ),
        ("more exact", |p| p.better.clone()),
    ] {
        for pair in against.pairs.iter().filter(|p| !of(p).is_empty()) {
            let changes: Vec<String> = of(pair)
                .iter()
                .map(|(c, a, b)| format!("{c} {} to {}", number(*a, 4), number(*b, 4)))
                .collect();
            out += &format!("{what}: {}: {}\n", name(pair), changes.join(", "));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::folder::{raw, results, write_text};
    use super::super::machine::Machine;
    use super::super::row::Row;
    use super::super::row::tests::row;
    use super::*;
    use crate::settings::DrawStage;

    fn run(rows: &[Row]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let machine = Machine::here("device, with a comma", "cpu", "driver", "revmap bench");
        write_text(
            &folder.path().join("results.csv"),
            &results(rows, &machine).text(),
        )
        .unwrap();
        write_text(&folder.path().join("raw.csv"), &raw(rows).text()).unwrap();
        folder
    }

    fn timed(times: [f64; 4], stage: DrawStage) -> Row {
        let passes = times.map(|t| {
            [
                (Some(t * 0.99), t),
                (Some(t), t * 1.01),
                (Some(t * 0.98), t),
            ]
        });
        let mut row = row(&passes.iter().map(|p| p.as_slice()).collect::<Vec<_>>());
        row.settings.stage = stage;
        row
    }

    #[test]
    fn planted_changes_are_found() {
        let old = run(&[
            timed([10.0, 10.2, 9.9, 10.1], DrawStage::Fragment),
            timed([20.0, 21.0, 19.0, 20.5], DrawStage::Compute),
        ]);
        let mut slow = timed([12.0, 12.2, 11.9, 12.1], DrawStage::Fragment);
        slow.errors.missed = 40;
        let new = run(&[slow, timed([20.4, 20.0, 21.0, 19.5], DrawStage::Compute)]);
        let found = compare(old.path(), new.path()).unwrap();
        assert_eq!(
            found.pairs.iter().map(Pair::verdict).collect::<Vec<_>>(),
            [Verdict::Slower, Verdict::Same]
        );
        assert!((found.pairs[0].time.unwrap().value - 1.2).abs() < 0.01);
        assert_eq!(found.pairs[0].worse, [("missed", 0.0, 40.0)]);
        let text = as_text(&found);
        assert!(
            text.contains("1 slower, 0 faster, 1 within")
                && text.contains("less exact: fragment: missed 0 to 40"),
            "{text}"
        );
        let back = compare(new.path(), old.path()).unwrap();
        assert_eq!(back.pairs[0].verdict(), Verdict::Faster);
        assert_eq!(back.pairs[0].better.len(), 1);
    }

    /// One run had a machine of half the speed: the papers' loop, in both, tells so, and nothing counts as slower but what is.
    #[test]
    fn a_slower_machine_is_told_from_a_slower_search() {
        let papers = |times| {
            let mut row = timed(times, DrawStage::Fragment);
            row.settings = crate::report::plan::papers_loop(
                &crate::report::view::tests::spindle(),
                &row.settings,
            );
            row.source = row.settings.map_source;
            row
        };
        let search = |times, steps| {
            let mut row = timed(times, DrawStage::Fragment);
            row.settings.max_steps = Some(steps);
            row
        };
        let old = run(&[
            papers([10.0, 10.2, 9.9, 10.1]),
            search([5.0, 5.1, 4.9, 5.0], 30),
            search([5.0, 5.1, 4.9, 5.0], 40),
        ]);
        let new = run(&[
            papers([20.0, 20.4, 19.8, 20.2]),
            search([10.0, 10.2, 9.8, 10.0], 30),
            search([15.0, 15.2, 14.8, 15.0], 40),
        ]);
        let found = compare(old.path(), new.path()).unwrap();
        assert_eq!(
            found.pairs.iter().map(Pair::verdict).collect::<Vec<_>>(),
            [Verdict::Slower, Verdict::Same, Verdict::Slower]
        );
        assert!((found.pairs[2].relative.unwrap().value - 1.5).abs() < 0.02);
        assert!(as_text(&found).contains("the papers' loop itself differs"));
    }

    #[test]
    fn a_rejected_clock_gives_no_verdict() {
        let fine = run(&[timed([10.0; 4], DrawStage::Fragment)]);
        let mut lies = timed([10.0; 4], DrawStage::Fragment);
        lies.passes
            .iter_mut()
            .flatten()
            .for_each(|s| s.gpu_ms = Some(0.036));
        let lies = run(&[lies]);
        let found = compare(fine.path(), lies.path()).unwrap();
        assert_eq!(found.pairs[0].verdict(), Verdict::Unknown);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let a = run(&[timed([10.0; 4], DrawStage::Fragment)]);
        let b = run(&[timed([10.0; 4], DrawStage::Compute)]);
        assert!(
            compare(a.path(), b.path())
                .unwrap_err()
                .to_string()
                .contains("in common")
        );
        let empty = tempfile::tempdir().unwrap();
        let error = compare(a.path(), empty.path()).unwrap_err();
        assert!(error.file.unwrap().ends_with("results.csv"));
        std::fs::write(b.path().join("results.csv"), "scene,solver\nx,y\n").unwrap();
        assert!(
            compare(a.path(), b.path())
                .unwrap_err()
                .to_string()
                .contains("other columns")
        );
        assert_eq!(KEY.last(), Some(&"objects"));
    }
}
