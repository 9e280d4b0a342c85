//! Folders of results held against each other: two versions of the program, or several devices.

mod groups;
pub mod repeat;
mod run;
mod scenes;
pub mod submission;

use crate::measure::drawn::changes;
use crate::measure::surroundings::differences;
use crate::plan::RBM_BASELINE;
use crate::plan::method::Method;
use crate::report::columns::Cell;
use groups::Group;
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::groups::grouped;
use revmap_figures::groups::one;
use revmap_figures::names::number;
use revmap_figures::stats::{self, Interval, Verdict};
use revmap_figures::table::{NO_VALUE, Table};
use run::{PICTURE, Run};
use scenes::Scenes;
use std::path::Path;

/// Columns that name a way of drawing, beside its method. Earlier versions lack the last; those
/// that all runs have count.
const WAY: [&str; 7] = [
    "stage",
    "max_steps",
    "map_rows",
    "map_source",
    "map_format",
    "tolerance_px",
    "way",
];

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
    /// The errors that have grown or shrunk.
    pub changed: Vec<Change>,
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

/// Runs side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// The measurements of two runs, in the order of the old one; none of more runs.
    pub pairs: Vec<Pair>,
    /// How many measurements only the old run has, and only the new one.
    pub alone: (usize, usize),
    /// Device and driver of each.
    pub devices: Vec<String>,
    /// Ways of drawing by technique and stage, over the pictures that all runs have.
    pub table: Table,
    /// A warning for each of scenes, settings, device, driver, processor and surroundings that differs
    /// from the first run.
    pub warnings: Vec<String>,
}

/// Reads folders that `revmap bench` or `revmap chart` wrote, two or more.
///
/// # Errors
/// [`ErrorKind::File`], naming the file: missing, damaged or of other columns;
/// [`ErrorKind::Content`] with nothing in common, naming the key of a scene that differs.
pub fn compare(folders: &[impl AsRef<Path>]) -> Result<Against> {
    let runs = folders.iter().map(|folder| Run::load(folder.as_ref()));
    let runs = runs.collect::<Result<Vec<Run>>>()?;
    let [old, others @ ..] = runs.as_slice() else {
        return Err(Error::new(ErrorKind::Usage, "give two or more folders"));
    };
    let scenes: Vec<Scenes> = runs.iter().map(|run| Scenes::of(old, run)).collect();
    let named = |columns: &[&str], run: &Run, record: &[String]| {
        let words = columns.iter().map(|column| run.at(record, column));
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    let in_all = |column: &&str| runs.iter().all(|run| run.results.column(column).is_ok());
    let way: Vec<&str> = WAY.into_iter().filter(in_all).collect();
    let by = |run: &Run, record: &[String]| {
        let mut key = vec![technique(run, record), groups::method(run, record)];
        key.extend(named(&way, run, record));
        key
    };
    let ways = groups::groups(&runs, &scenes, &by);
    let key = [&PICTURE[..], &way].concat();
    let mut pairs = Vec::new();
    if let [new] = others {
        let rows = ways.iter().flat_map(|group| {
            let twins = group.pictures.iter().filter_map(|p| p[0].zip(p[1]));
            twins.map(move |twins| (twins, &group.key[1]))
        });
        let mut rows: Vec<_> = rows.collect();
        rows.sort_unstable();
        pairs.extend(rows.into_iter().map(|((before, after), method)| {
            let mut words = named(&key, old, &old.results.records[before]);
            words.insert(1, method.clone());
            pair((old, before), (new, after), words)
        }));
        judge(&mut pairs);
    }
    for place in 1..runs.len() {
        let mut pictures = ways.iter().flat_map(|way| &way.pictures);
        if !pictures.any(|picture| picture[place].is_some()) {
            let message = match &scenes[place].told {
                Some(told) => format!("drew {told}; measure the same scenes"),
                None => "has no measurement in common with the other folder; measure the same scenes, stages and searches".to_owned(),
            };
            return Err(Error::new(ErrorKind::Content, message).in_file(folders[place].as_ref()));
        }
    }
    let count = |run: &Run| run.results.records.len().saturating_sub(pairs.len());
    let warnings = others.iter().zip(scenes.into_iter().skip(1));
    let warnings = warnings.flat_map(|(new, scenes)| {
        let (mut a, mut b) = (old.machine(), new.machine());
        a.retain(|name, _| b.contains_key(name));
        b.retain(|name, _| a.contains_key(name));
        let machines = changes(&a, &b).into_iter();
        let machines = machines.map(|c| format!("{c}; ratios of times are between machines"));
        let others = differences(&old.surroundings, &new.surroundings).into_iter();
        let others = others.map(|c| format!("{c}; times depend on it"));
        let differ = machines.chain(others);
        let differ = differ.map(|c| format!("the runs differ in {c}"));
        scenes
            .warnings
            .into_iter()
            .chain(differ)
            .collect::<Vec<_>>()
    });
    let device = |run: &Run| format!("{}, {}", run.first("device"), run.first("driver"));
    Ok(Against {
        alone: (count(old), others.last().map_or(0, count)),
        warnings: warnings.collect(),
        devices: runs.iter().map(device).collect(),
        table: table(&runs, &ways, &way),
        pairs,
    })
}

/// The technique of a record: its view's, else its offset's; whether the box cuts it.
fn technique(run: &Run, record: &[String]) -> String {
    let scene = run.at(record, "scene").trim_end_matches(":close");
    match run.at(record, "technique") {
        _ if scene.ends_with("textured") => "textured".to_owned(),
        technique if scene.ends_with("-box") => format!("{technique}, cut by the box"),
        technique => technique.to_owned(),
    }
}

/// One measurement of two runs, its verdict still open.
fn pair((old, before): (&Run, usize), (new, after): (&Run, usize), key: Vec<String>) -> Pair {
    let changed = ERRORS.into_iter().filter_map(|name| {
        let error = |run: &Run, row| run.sum(row, &[name]);
        Some((name, error(old, before)?, error(new, after)?))
    });
    let changed = changed.filter(|&(name, a, b)| grown(name, a, b) || grown(name, b, a));
    let over = |run: &Run, row: usize| {
        let record = &run.results.records[row];
        let ratios = run.over_baseline(row, run.at(record, "stage"));
        ratios.filter(|_| !run.is_baseline(record))
    };
    let relative = over(new, after).zip(over(old, before));
    Pair {
        key,
        time: stats::ratio(&new.medians(after), &old.medians(before)),
        relative: relative.and_then(|(a, b)| stats::ratio(&a, &b)),
        verdict: Verdict::Unresolved,
        changed: changed.collect(),
    }
}

/// Each way of drawing over the pictures that all runs have: of each run the time over the RBM
/// baseline in the fragment stage, with its 95 % interval (milliseconds without such a baseline),
/// the depth error (99th percentile in h/512) and the wrong pixels; of two runs new over old, too.
fn table(runs: &[Run], ways: &[Group], columns: &[&str]) -> Table {
    let relative = ways.iter().any(|way| {
        let is_baseline = way.key[1] == RBM_BASELINE;
        !is_baseline && !way.times(runs, true).values[0].is_empty()
    });
    let names: Vec<&str> = match runs {
        [_, _] => vec!["old", "new"],
        runs => runs.iter().map(|run| run.first("driver")).collect(),
    };
    let unit = ["ms", "time / RBM baseline"][usize::from(relative)];
    let names = names
        .iter()
        .map(|name| format!("{name}: {unit}; depth; wrong"));
    let header = ["technique", "method"]
        .into_iter()
        .chain(columns.iter().copied());
    let header = header.map(str::to_owned).chain(names);
    let ratio = (runs.len() == 2).then(|| "new / old".to_owned());
    let record = |way: &Group| {
        let times = way.times(runs, relative).values;
        let [depth, wrong] = [groups::DEPTH, groups::WRONG].map(|(_, columns, of_all)| {
            let errors = way.errors(runs, columns).values.into_iter();
            // The floor has no surface to err from.
            let err = |all: &[f64]| !all.is_empty() && way.key[1] != Method::Floor.name();
            let errors = errors.map(|all| of_all(&all).filter(|_| err(&all)));
            errors.collect::<Vec<_>>()
        });
        let cell = |k: usize| {
            let time = stats::over_pictures(&times[k])?;
            let errors = [&depth, &wrong].map(|of| of[k].map(|v| number(v, 3)));
            let errors = errors.into_iter().flatten().map(|v| format!("; {v}"));
            Some(Cell::Known(time).shown() + &errors.collect::<String>())
        };
        let mut record = way.key.clone();
        record.extend((0..runs.len()).map(|k| cell(k).unwrap_or(NO_VALUE.to_owned())));
        if let [old, new] = times.as_slice() {
            let [old, new] = [old, new].map(|logs| stats::pass_means(logs));
            let ratio = stats::ratio(&new, &old).map_or(Cell::Empty, Cell::Known);
            record.push(ratio.shown());
        }
        record
    };
    let mut table = Table::new(header.chain(ratio), ways.iter().map(record).collect());
    for column in columns.iter().filter(|column| **column != "stage") {
        let place = table.header.iter().position(|name| name == column);
        let value = |record: &&Vec<String>| place.and_then(|place| record.get(place).cloned());
        // A method's own bound or map tells nothing apart.
        let methods = grouped(&table.records, |record| record[1].clone());
        let mut alike = methods.iter().map(|(_, own)| one(own.iter().map(value)));
        if alike.all(|value| value.is_some()) {
            table = table.without(column);
        }
    }
    table
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

/// The comparison as text, for a terminal of this width if it is for one: the table, then what
/// became slower or faster, less or more exact.
pub fn as_text(against: &Against, width: Option<usize>) -> String {
    let pairs = &against.pairs;
    let table = against.table.within(width, "a pipe, such as `| less -S`,");
    if pairs.is_empty() {
        return table;
    }
    let differs = |c: &usize| pairs.windows(2).any(|w| w[0].key[*c] != w[1].key[*c]);
    let mut columns: Vec<usize> = (0..pairs[0].key.len()).filter(differs).collect();
    if columns.is_empty() {
        columns = vec![0, 1];
    }
    let name = |pair: &Pair| {
        let words = columns.iter().map(|&c| pair.key[c].as_str());
        let words: Vec<&str> = words.filter(|v| !v.is_empty()).collect();
        words.join(" ")
    };
    let of = |verdict: Verdict, word: &str| -> String {
        let own = pairs.iter().filter(|pair| pair.verdict == verdict);
        let line = |pair: &Pair| {
            let ratio = pair.relative.or(pair.time).map_or(Cell::Empty, Cell::Known);
            format!("{word}: {}: {}\n", name(pair), ratio.shown())
        };
        own.map(line).collect()
    };
    let changes = |what: &str, own: fn(&Change) -> bool| -> String {
        let line = |pair: &Pair| {
            let change = |(c, a, b): &Change| format!("{c} {} to {}", number(*a, 4), number(*b, 4));
            let all: Vec<String> = pair.changed.iter().filter(|c| own(c)).map(change).collect();
            let line = format!("{what}: {}: {}\n", name(pair), all.join(", "));
            (!all.is_empty()).then_some(line)
        };
        pairs.iter().filter_map(line).collect()
    };
    let slower = of(Verdict::Slower, "slower") + &of(Verdict::Faster, "faster");
    let open = of(Verdict::Unresolved, "clocks disagree");
    let worse = changes("less exact", |(_, a, b)| b > a);
    let better = changes("more exact", |(_, a, b)| b < a);
    let [old, new] = [0, 1].map(|k: usize| &against.devices[k]);
    let counts = counts(against);
    format!("old: {old}\nnew: {new}\n\n{table}{counts}{slower}{open}{worse}{better}")
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
