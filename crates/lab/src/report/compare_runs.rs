//! Two folders of results held against each other: two versions of the program, or two devices.

pub mod drivers;
mod run;

use super::columns::results;
use super::names::number;
use super::stats::{self, Interval};
use super::table::Table;
use revmap::error::{Error, ErrorKind, Result};
use run::Run;
use std::collections::HashMap;
use std::path::Path;

/// How many columns tell what was measured, the first of all: rows that agree in them are the same measurement.
const KEY: usize = 14;

/// Errors may differ by this share before they count as changed.
const ERROR_CHANGE: f64 = 0.05;

/// One measurement that both folders hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// What was measured: the values of the columns that tell it.
    pub key: Vec<String>,
    /// New time over old; `None` where a clock cannot be trusted.
    pub time: Option<Interval>,
    /// The same, each time first put over that of the RBM baseline of the same picture, stage and
    /// run: what is left when one run had the slower machine. `None` where a run lacks that loop,
    /// and for the loop itself.
    pub relative: Option<Interval>,
    /// What of the errors has grown.
    pub worse: Vec<Change>,
    /// What of the errors has shrunk.
    pub better: Vec<Change>,
}

/// An error that differs: column, old, new.
pub type Change = (&'static str, f64, f64);

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
    /// What became of its time: in proportion to the RBM baseline where both runs have it.
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

/// Reads two folders that `revmap bench` or `revmap chart` wrote.
///
/// # Errors
/// [`ErrorKind::File`], naming the file: missing, damaged or of other columns;
/// [`ErrorKind::Content`] with nothing in common.
pub fn compare(old: &Path, new: &Path) -> Result<Against> {
    let (before, after) = (Run::load(old)?, Run::load(new)?);
    let key = |record: &[String]| record[..KEY].to_vec();
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
        let relative = match (
            after.over_baseline(number + 1),
            before.over_baseline(twin + 1),
        ) {
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
        return Err(Error::new(ErrorKind::Content, "has no measurement in common with the other folder; measure the same scenes, stages and searches").in_file(new));
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
fn errors(old: &[String], new: &[String]) -> (Vec<Change>, Vec<Change>) {
    let (mut worse, mut better) = (Vec::new(), Vec::new());
    for name in [
        "missed",
        "ghost",
        "depth_p99_texels",
        "normal_rms_degrees",
        "flip",
    ] {
        let Some(at) = results().position(|c| c == name) else {
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
    let columns: Vec<usize> = (0..KEY)
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
    let header = [
        "measurement",
        "new / old",
        "95 % interval",
        "over the RBM baseline",
        "95 % interval",
        "",
    ];
    let mut table = Table::new(header, Vec::new());
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
        table
            .records
            .push(vec![name(pair), a, b, c, d, verdict.to_owned()]);
    }
    out += &table.aligned();
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
        out += "the RBM baseline itself differs between the runs: one had the slower or busier machine, unless that loop was changed; verdicts are by the times over it\n";
    }
    let changes = |what: &str, of: fn(&Pair) -> &[Change]| -> String {
        let changed = against.pairs.iter().filter(|p| !of(p).is_empty());
        changed
            .map(|pair| {
                let changes: Vec<String> = of(pair)
                    .iter()
                    .map(|(c, a, b)| format!("{c} {} to {}", number(*a, 4), number(*b, 4)))
                    .collect();
                format!("{what}: {}: {}\n", name(pair), changes.join(", "))
            })
            .collect()
    };
    out += &changes("less exact", |p| &p.worse);
    out += &changes("more exact", |p| &p.better);
    out
}

#[cfg(test)]
mod tests;
