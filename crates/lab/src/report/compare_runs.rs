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

/// Number of columns that name the measurement, the first of all: rows that agree in them are the same measurement.
const KEY: usize = 14;

/// Errors may differ by this share before they count as changed.
const ERROR_CHANGE: f64 = 0.05;

/// One measurement that both folders hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The measurement: the values of the columns that name it.
    pub key: Vec<String>,
    /// New time over old; `None` where a clock cannot be trusted.
    pub time: Option<Interval>,
    /// The same, each time first put over that of the RBM baseline of the same picture, stage and
    /// run: what is left when one run had the slower machine. `None` where a run lacks that loop,
    /// and for the loop itself.
    pub relative: Option<Interval>,
    /// The errors that have grown.
    pub worse: Vec<Change>,
    /// The errors that have shrunk.
    pub better: Vec<Change>,
}

/// An error that differs: column, old, new.
pub type Change = (&'static str, f64, f64);

/// The change of a time.
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
    /// The change of its time: in proportion to the RBM baseline where both runs have it.
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
    /// The measurements of both, in the order of the new run.
    pub pairs: Vec<Pair>,
    /// How many measurements only the old run has, and only the new one.
    pub alone: (usize, usize),
    /// Device and driver of each.
    pub devices: [String; 2],
    /// A warning for each of device, driver and processor that differs.
    pub warnings: Vec<String>,
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
    let (old, new) = (before.machine(), after.machine());
    Ok(Against {
        alone: (
            before.results.records.len().saturating_sub(pairs.len()),
            after.results.records.len().saturating_sub(pairs.len()),
        ),
        warnings: (old.iter().zip(&new))
            .filter(|((_, a), (_, b))| a != b && !a.is_empty() && !b.is_empty())
            .map(|((name, a), (_, b))| {
                format!("the runs differ in {name}: old {a:?}, new {b:?}; ratios of times are between machines")
            })
            .collect(),
        devices: [&old, &new].map(|[(_, device), (_, driver), _]| format!("{device}, {driver}")),
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
    let pairs = &against.pairs;
    let differs = |c: &usize| pairs.windows(2).any(|w| w[0].key[*c] != w[1].key[*c]);
    let mut columns: Vec<usize> = (0..KEY).filter(differs).collect();
    if columns.is_empty() {
        columns = vec![0, 5, 6];
    }
    let name = |pair: &Pair| {
        let words = columns.iter().map(|&c| pair.key[c].as_str());
        words
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
    let fields = |i: Option<Interval>| match i.map(|t| (t.value, t.ends())) {
        Some((value, Some((low, high)))) => [
            number(value, 3),
            format!("{} to {}", number(low, 3), number(high, 3)),
        ],
        Some((value, None)) => [number(value, 3), "unknown".to_owned()],
        None => [String::new(), String::new()],
    };
    let record = |pair: &Pair| {
        let verdict = match pair.verdict() {
            Verdict::Slower => "slower",
            Verdict::Faster => "faster",
            Verdict::Same => "",
            Verdict::Unknown => "clocks disagree",
        };
        let ([a, b], [c, d]) = (fields(pair.time), fields(pair.relative));
        vec![name(pair), a, b, c, d, verdict.to_owned()]
    };
    let table = Table::new(header, pairs.iter().map(record).collect());
    let changes = |what: &str, of: fn(&Pair) -> &[Change]| -> String {
        let changed = pairs.iter().filter(|p| !of(p).is_empty());
        let line = |pair: &Pair| {
            let change = |(c, a, b): &Change| format!("{c} {} to {}", number(*a, 4), number(*b, 4));
            let all: Vec<String> = of(pair).iter().map(change).collect();
            format!("{what}: {}: {}\n", name(pair), all.join(", "))
        };
        changed.map(line).collect()
    };
    let [old, new] = &against.devices;
    format!(
        "old: {old}\nnew: {new}\n\n{}{}{}{}",
        table.aligned(),
        counts(against),
        changes("less exact", |p| &p.worse),
        changes("more exact", |p| &p.better)
    )
}

/// How many became slower and faster, and whether the machine did.
fn counts(against: &Against) -> String {
    let pairs = &against.pairs;
    let count = |v: Verdict| pairs.iter().filter(|p| p.verdict() == v).count();
    let ratios: Vec<f64> = pairs.iter().filter_map(|p| Some(p.time?.value)).collect();
    let mean = stats::geometric(&ratios).map(|i| number(i.value, 3));
    let mut out = format!(
        "\n{} in common: {} slower, {} faster, {} within their intervals; geometric mean of new / old: {}; {} only in the old run, {} only in the new one\n",
        pairs.len(),
        count(Verdict::Slower),
        count(Verdict::Faster),
        count(Verdict::Same),
        mean.unwrap_or_default(),
        against.alone.0,
        against.alone.1
    );
    let mut loops = pairs
        .iter()
        .filter(|p| p.relative.is_none())
        .filter_map(|p| p.time);
    let compared = pairs.iter().any(|p| p.relative.is_some());
    if compared && loops.any(|t| t.low > 1.0 || t.high < 1.0) {
        out += "the RBM baseline itself differs between the runs: one had the slower or busier machine, unless that loop was changed; verdicts are by the times over it\n";
    }
    out
}

#[cfg(test)]
mod tests;
