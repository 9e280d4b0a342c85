//! Two folders of results held against each other: two versions of the program, or two devices.

pub mod drivers;
pub mod repeat;
mod run;
mod scenes;
pub mod submission;

use crate::measure::stats::{self, Interval, Verdict};
use crate::measure::surroundings::differences;
use crate::plan::names::{number, range};
use crate::report::table::{Table, columns};
use revmap::error::{Error, ErrorKind, Result};
use run::Run;
use scenes::Scenes;
use std::collections::BTreeSet;
use std::path::Path;

/// How many of the first columns of `results.csv` name a measurement in text.
const NAMES: usize = 14;
/// Columns that tell measurements of one such name apart. Earlier versions lack the last.
const MORE: [&str; 2] = ["tolerance_px", "way"];

/// The columns that name a measurement: rows that agree in them are the same one.
fn key() -> Vec<&'static str> {
    columns::results().take(NAMES).chain(MORE).collect()
}

/// Errors may differ by this share before they count as changed.
const ERROR_CHANGE: f64 = 0.05;

/// One measurement that both folders hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The measurement: the values of the columns that name it.
    pub key: Vec<String>,
    /// New time over old; `None` where a clock cannot be trusted.
    pub time: Option<Interval>,
    /// The same, each time first put over the RBM baseline's of the same picture, stage and run.
    /// `None` where a run lacks that loop, and for the loop itself.
    pub relative: Option<Interval>,
    /// The change of its time: in proportion to the RBM baseline where both runs have it. The loop
    /// itself, with others over it, has none.
    pub verdict: Verdict,
    /// The errors that have grown.
    pub worse: Vec<Change>,
    /// The errors that have shrunk.
    pub better: Vec<Change>,
}

/// An error that differs: column, old, new.
pub type Change = (&'static str, f64, f64);

/// Least standard deviation of the logarithm of a ratio of times between two runs of one program,
/// beside that of the passes within each.
const BETWEEN_RUNS: f64 = 0.03;
/// The quantile of the normal distribution for 95 %.
const NORMAL: f64 = 1.96;

/// Gives verdicts such that a run against itself has none in 19 of 20 comparisons, whatever the
/// number of measurements: intervals are wider the more there are (Bonferroni's quantile, within
/// 3 % up to 1000), and by what differs between runs: by as much as the ratios of the published loop
/// do, which changes with no search.
fn judge(pairs: &mut [Pair]) {
    let over_baseline = pairs.iter().any(|pair| pair.relative.is_some());
    let wider = (1.0 + 0.47 * (pairs.len() as f64).ln()).sqrt();
    let loops = pairs.iter().filter(|pair| pair.relative.is_none());
    let loops: Vec<f64> = loops.filter_map(|p| Some(p.time?.value.ln())).collect();
    let apart = Some(&loops).filter(|_| over_baseline && loops.len() > 1);
    let between = apart
        .map_or(0.0, |loops| stats::deviation(loops))
        .max(BETWEEN_RUNS);
    for pair in pairs {
        pair.verdict = match (pair.time, pair.relative) {
            (None, _) => Verdict::Unresolved,
            (Some(_), None) if over_baseline => Verdict::Even,
            (Some(time), relative) => {
                let ratio = relative.unwrap_or(time);
                let within = 0.5 * (ratio.high / ratio.low).ln();
                let reach = (wider * within.hypot(NORMAL * between)).exp();
                let value = ratio.value;
                Interval::new(value, value / reach, value * reach).verdict(f64::INFINITY)
            }
        };
    }
}

/// What only one of two runs has among the values of a column, as a warning.
fn other_methods(old: &Run, new: &Run) -> Option<String> {
    let all = |run: &Run| -> BTreeSet<String> {
        let records = run.results.records.iter();
        records.map(|r| run.at(r, "solver").to_owned()).collect()
    };
    let (old, new) = (all(old), all(new));
    let only = |a: &BTreeSet<String>, b: &BTreeSet<String>, name: &str| {
        let names: Vec<&str> = a.difference(b).map(String::as_str).collect();
        (!names.is_empty()).then(|| format!("only the {name} one has {}", names.join(", ")))
    };
    let found = [only(&old, &new, "old"), only(&new, &old, "new")];
    let found: Vec<String> = found.into_iter().flatten().collect();
    (!found.is_empty()).then(|| {
        format!(
            "the runs are of other methods: {}; methods measured in turn change each other's times, so measure the same ones",
            found.join(", ")
        )
    })
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
    /// A warning for each of scenes, settings, device, driver, processor, surroundings and methods that
    /// differs.
    pub warnings: Vec<String>,
}

/// Reads two folders that `revmap bench` or `revmap chart` wrote.
///
/// # Errors
/// [`ErrorKind::File`], naming the file: missing, damaged or of other columns;
/// [`ErrorKind::Content`] with nothing in common, naming the key of a scene that differs.
pub fn compare(old: &Path, new: &Path) -> Result<Against> {
    let (before, after) = (Run::load(old)?, Run::load(new)?);
    let scenes = Scenes::of(&before, &after);
    let key = key();
    let pair = |(number, record): (usize, &Vec<String>)| {
        let mut known = before.results.records.iter();
        let twin = known.position(|r| before.agree(r, (&after, record), &key))?;
        if scenes.differ(after.at(record, "scene")) {
            return None;
        }
        let old = &before.results.records[twin];
        let errors = |name| {
            let value = |run: &Run, record| run.at(record, name).parse::<f64>().ok();
            Some((name, value(&before, old)?, value(&after, record)?))
        };
        let changed = ERRORS.into_iter().filter_map(errors);
        let (worse, better): (Vec<Change>, Vec<Change>) = changed
            .filter(|&(name, a, b)| grown(name, a, b) || grown(name, b, a))
            .partition(|&(_, a, b)| b > a);
        let over = |run: &Run, row: usize| {
            let record = &run.results.records[row];
            let ratios = run.over_baseline(row, run.at(record, "stage"));
            ratios.filter(|_| !run.is_baseline(record))
        };
        let relative = over(&after, number).zip(over(&before, twin));
        Some(Pair {
            key: (key.iter().map(|column| after.at(record, column).to_owned())).collect(),
            time: stats::ratio(&after.medians(number), &before.medians(twin)),
            relative: relative.and_then(|(a, b)| stats::ratio(&a, &b)),
            verdict: Verdict::Unresolved,
            worse,
            better,
        })
    };
    let records = after.results.records.iter().enumerate();
    let mut pairs: Vec<Pair> = records.filter_map(pair).collect();
    judge(&mut pairs);
    if pairs.is_empty() {
        let message = match &scenes.told {
            Some(told) => format!("drew {told}; measure the same scenes"),
            None => "has no measurement in common with the other folder; measure the same scenes, stages and searches".to_owned(),
        };
        return Err(Error::new(ErrorKind::Content, message).in_file(new));
    }
    let alone = |run: &Run| run.results.records.len().saturating_sub(pairs.len());
    let (old, new) = (before.machine(), after.machine());
    let differs = |((name, a), (_, b)): ((&str, &str), (&str, &str))| {
        let warning = || {
            format!(
                "the runs differ in {name}: old {a:?}, new {b:?}; ratios of times are between machines"
            )
        };
        (a != b && !a.is_empty() && !b.is_empty()).then(warning)
    };
    let machines = old.into_iter().zip(new).filter_map(differs);
    let others = differences(&before.surroundings, &after.surroundings);
    Ok(Against {
        alone: (alone(&before), alone(&after)),
        warnings: (scenes.warnings.into_iter())
            .chain(machines)
            .chain(others)
            .chain(other_methods(&before, &after))
            .collect(),
        devices: [old, new].map(|[(_, device), (_, driver), _]| format!("{device}, {driver}")),
        pairs,
    })
}

/// The columns of errors.
const ERRORS: [&str; 5] = [
    "missed",
    "ghost",
    "depth_p99_texels",
    "normal_rms_degrees",
    "flip",
];

/// True if an error of `a` that became `b` has grown.
fn grown(name: &str, a: f64, b: f64) -> bool {
    // Pixels that a rounding decides come and go one by one.
    let pixels = matches!(name, "missed" | "ghost");
    let slack = if pixels { 3.0 } else { 0.0 };
    b > a * (1.0 + ERROR_CHANGE) + slack
}

/// The comparison as text, for a terminal of this width if it is for one: all ratios, then what
/// became slower, then what became less exact.
pub fn as_text(against: &Against, width: Option<usize>) -> String {
    let pairs = &against.pairs;
    let differs = |c: &usize| pairs.windows(2).any(|w| w[0].key[*c] != w[1].key[*c]);
    let mut columns: Vec<usize> = (0..NAMES).filter(differs).collect();
    if columns.is_empty() {
        columns = vec![0, 5, 6];
    }
    let named = pairs
        .iter()
        .map(|p| &p.key[..NAMES])
        .collect::<BTreeSet<_>>();
    if named.len() < pairs.len() {
        columns.extend((NAMES..NAMES + MORE.len()).filter(differs));
    }
    let name = |pair: &Pair| {
        let words = columns.iter().map(|&c| pair.key[c].as_str());
        let words: Vec<&str> = words.filter(|v| !v.is_empty()).collect();
        words.join(" ")
    };
    let value = |i: Option<Interval>| i.map_or(String::new(), |t| number(t.value, 3));
    let ends = |i: Option<Interval>| {
        let ends = i.map(|t| t.ends().map_or("unknown".to_owned(), range));
        ends.unwrap_or_default()
    };
    let verdict = |pair: &Pair| match pair.verdict {
        Verdict::Slower => "slower",
        Verdict::Faster => "faster",
        Verdict::Even => "",
        Verdict::Unresolved => "clocks disagree",
    };
    let table = Table::of(
        pairs,
        &[
            ("measurement", &name),
            ("verdict", &|p| verdict(p).to_owned()),
            ("new / old", &|p| value(p.time)),
            ("95 % interval", &|p| ends(p.time)),
            ("over the RBM baseline", &|p| value(p.relative)),
            ("95 % interval", &|p| ends(p.relative)),
        ],
    );
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
    let table = table.within(width, "a pipe, such as `| less -S`,");
    let counts = counts(against);
    let worse = changes("less exact", |p| &p.worse);
    let better = changes("more exact", |p| &p.better);
    format!("old: {old}\nnew: {new}\n\n{table}{counts}{worse}{better}")
}

/// How many became slower and faster, and whether the machine did.
fn counts(against: &Against) -> String {
    let pairs = &against.pairs;
    let count = |v: Verdict| pairs.iter().filter(|p| p.verdict == v).count();
    let ratios: Vec<f64> = pairs.iter().filter_map(|p| Some(p.time?.value)).collect();
    let mean = stats::geometric(&ratios).map(|i| number(i.value, 3));
    let mut out = format!(
        "\n{} in common: {} slower, {} faster, {} within what two runs of one program differ by; geometric mean of new / old: {}; {} only in the old run, {} only in the new one\n",
        pairs.len(),
        count(Verdict::Slower),
        count(Verdict::Faster),
        count(Verdict::Even),
        mean.unwrap_or_default(),
        against.alone.0,
        against.alone.1
    );
    let loops = pairs.iter().filter(|p| p.relative.is_none());
    let mut loops = loops.filter_map(|p| p.time);
    let compared = pairs.iter().any(|p| p.relative.is_some());
    if compared && loops.any(|t| t.low > 1.0 || t.high < 1.0) {
        out += "the RBM baseline itself differs between the runs: one had the slower or busier machine, unless that loop was changed; verdicts are by the times over it\n";
    }
    out
}

#[cfg(test)]
mod tests;
