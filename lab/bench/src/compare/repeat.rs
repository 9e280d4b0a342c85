//! The judge of claims: whether a new run repeats what a kept one says of a method over its pictures.

use super::run::Run;
use super::scenes::Scenes;
use crate::measure::stats::{self, Interval};
use crate::plan::RBM_BASELINE;
use crate::plan::method::Method;
use crate::plan::names::{number, percent, range};
use revmap::error::{Error, ErrorKind, Result};
use std::path::Path;

/// The factor by which ratios may leave the kept interval to either side. Ratios of one method differ
/// by up to 1.3 between lavapipe 22.3.6 and 25.0.7 on one machine (`results/2026-11-24-drivers.md`:
/// `exact` in compute, 0.49 and 0.64).
const MACHINES: f64 = 1.3;
/// Half the width of a new interval, relative, above which a ratio decides nothing.
const RESOLVED: f64 = 0.25;
/// The share by which errors may differ. Most differ by less than 3 % between drivers.
const ERRORS: f64 = 0.1;
/// The share of the kept run's pictures that a claim needs.
const ENOUGH: f64 = 0.5;
/// The stages of claims.
const STAGES: [&str; 2] = ["fragment", "compute"];

/// An error that is claimed of each method in each stage; the ratio of times is claimed beside it.
struct Quantity {
    /// Its name, behind the figure.
    name: &'static str,
    /// The columns whose sum is the error of a picture.
    columns: &'static [&'static str],
    /// The figure of several pictures.
    of_all: fn(&[f64]) -> Option<f64>,
    /// By how much it may differ beside the share [`ERRORS`].
    slack: f64,
}

/// The errors that are claimed.
const QUANTITIES: [Quantity; 2] = [
    Quantity {
        name: "wrong pixels",
        columns: &["missed", "ghost"],
        of_all: |all| Some(all.iter().sum()),
        slack: 3.0, // roundings decide some pixels
    },
    Quantity {
        name: "h/512 of depth error",
        columns: &["depth_p99_texels"],
        of_all: |all| {
            let above: Vec<f64> = all.iter().map(|d| d.max(1e-4)).collect();
            stats::geometric(&above).map(|mean| mean.value)
        },
        slack: 0.0,
    },
];

/// What a new run says about a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has the same figure, within what machines differ by.
    Repeated,
    /// It has another figure.
    NotRepeated,
    /// It has too few pictures of the claim, or times that are not resolved.
    NotJudged,
}

impl Verdict {
    /// How lines begin.
    fn word(self) -> &'static str {
        match self {
            Self::Repeated => "repeated",
            Self::NotRepeated => "NOT repeated",
            Self::NotJudged => "not judged",
        }
    }
}

/// One claim, and what the new run says about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Whether it is repeated.
    pub verdict: Verdict,
    /// The claim, the new figure and the kept one.
    pub text: String,
}

/// A row (counted from 0) of the kept run, and that of the same picture in the new one.
type Pair = (usize, Option<usize>);

/// The claims of these methods (as `exact`, `mesh:64x128`; `baseline` is the RBM baseline) in each
/// stage that the kept run has of them: the ratio of times, and each of the errors. Each is
/// judged by the pictures that both runs have. Behind them warnings about what the runs drew.
///
/// # Errors
/// Those of reading either run; [`ErrorKind::Content`] if the kept run lacks a method.
pub fn claims(kept: &Path, new: &Path, methods: &[String]) -> Result<(Vec<Claim>, Vec<String>)> {
    let runs = [Run::load(kept)?, Run::load(new)?];
    let [kept_run, new_run] = &runs;
    let scenes = Scenes::of(kept_run, new_run);
    let same = |row: usize, twin: usize| {
        let (a, b) = (
            &kept_run.results.records[row],
            &new_run.results.records[twin],
        );
        kept_run.same_picture(a, (new_run, b)) && !scenes.differ(kept_run.at(a, "scene"))
    };
    let mut all = Vec::new();
    for method in methods {
        let before = all.len();
        for stage in STAGES {
            let [old, new] = runs.each_ref().map(|run| rows(run, method, stage));
            let twin = |&row: &usize| {
                let mut new = new.iter().copied();
                (row, new.find(|&n| same(row, n)))
            };
            let pairs: Vec<Pair> = old.iter().map(twin).collect();
            all.extend(judge(&runs, &pairs, method, stage));
        }
        if all.len() == before {
            let message = format!(
                "holds no {method}, so it makes no claim about it; name methods of that run"
            );
            return Err(Error::new(ErrorKind::Content, message).in_file(kept));
        }
    }
    Ok((all, scenes.warnings))
}

/// The claims as text, one a line.
pub fn as_text(claims: &[Claim]) -> String {
    let line = |claim: &Claim| format!("{:<12}  {}\n", claim.verdict.word(), claim.text);
    let lines: String = claims.iter().map(line).collect();
    let count = |v: Verdict| claims.iter().filter(|c| c.verdict == v).count();
    let others = [Verdict::NotRepeated, Verdict::NotJudged].map(|v| (count(v), v.word()));
    let others = others.iter().filter(|(count, _)| *count > 0);
    let others: String = others.map(|(n, word)| format!(", {n} {word}")).collect();
    format!(
        "{lines}\n{} of {} claims repeated{others}\n",
        count(Verdict::Repeated),
        claims.len(),
    )
}

/// The rows (counted from 0) of a method in a stage.
fn rows(run: &Run, method: &str, stage: &str) -> Vec<usize> {
    let named = |record: &[String]| match method {
        "baseline" => run.is_baseline(record),
        // The baseline's search by itself is another method.
        _ => run.at(record, "solver") == method && !run.is_baseline(record),
    };
    let records = run.results.records.iter().enumerate();
    let own = records.filter(|(_, r)| run.at(r, "stage") == stage && named(r));
    own.map(|(row, _)| row).collect()
}

/// The claims of one method in one stage; none if the kept run has no row of it.
fn judge(runs: &[Run; 2], pairs: &[Pair], method: &str, stage: &str) -> Vec<Claim> {
    let method = match method {
        "baseline" => RBM_BASELINE,
        other => other,
    };
    // The floor, whose errors mean nothing, makes no claim about them.
    let quantities = QUANTITIES.iter().filter(|_| method != Method::Floor.name());
    let errors = quantities.map(|quantity| error_claim(runs, pairs, quantity));
    // The baseline in the fragment stage is the unit of ratios.
    let is_unit = (method, stage) == (RBM_BASELINE, STAGES[0]);
    let ratio = (!is_unit).then(|| ratio_claim(runs, pairs));
    let claims = ratio.into_iter().chain(errors).flatten();
    let named = claims.map(|claim| Claim {
        text: format!("{method}, {stage}: {}", claim.text),
        ..claim
    });
    named.collect()
}

/// The values of the pictures that both runs have, those of the kept run first, and how many
/// pictures these are; none if the kept run has no value.
fn common<T>(
    runs: &[Run; 2],
    pairs: &[Pair],
    value: impl Fn(&Run, usize) -> Option<T>,
) -> Option<([Vec<T>; 2], Pictures)> {
    let [old, new] = runs;
    let kept = pairs
        .iter()
        .filter_map(|&(row, twin)| Some((value(old, row)?, twin)));
    let kept: Vec<(T, Option<usize>)> = kept.collect();
    let of = kept.len();
    let both = kept
        .into_iter()
        .filter_map(|(a, twin)| Some((a, value(new, twin?)?)));
    let (a, b): (Vec<T>, Vec<T>) = both.unzip();
    let pictures = Pictures { count: a.len(), of };
    (of > 0).then_some(([a, b], pictures))
}

/// How many of the kept run's pictures both runs have.
struct Pictures {
    count: usize,
    of: usize,
}

impl Pictures {
    fn words(&self) -> String {
        format!("in {} of the kept run's {} pictures", self.count, self.of)
    }

    /// What is said of a claim that lacks pictures, if it does.
    fn too_few(&self, what: &str) -> Option<Claim> {
        let few = (self.count as f64) < ENOUGH * self.of as f64;
        few.then(|| Claim {
            verdict: Verdict::NotJudged,
            text: format!("{what} {}, below half of them", self.words()),
        })
    }
}

/// The claim of an error.
fn error_claim(runs: &[Run; 2], pairs: &[Pair], quantity: &Quantity) -> Option<Claim> {
    let value = |run: &Run, row: usize| {
        let record = run.results.records.get(row)?;
        let columns = quantity.columns.iter();
        columns.map(|c| run.at(record, c).parse::<f64>().ok()).sum()
    };
    let (values, pictures) = common(runs, pairs, value)?;
    let lacking = pictures.too_few(quantity.name);
    lacking.or_else(|| {
        let [kept, new] = values.map(|values| (quantity.of_all)(&values));
        let (kept, new) = kept.zip(new)?;
        let most = quantity.slack + ERRORS * kept;
        let verdict = match (new - kept).abs() <= most {
            true => Verdict::Repeated,
            false => Verdict::NotRepeated,
        };
        let [new, kept, most] = [new, kept, most].map(|v| number(v, 3));
        let (name, pictures) = (quantity.name, pictures.words());
        let text = format!("{new} {name} {pictures}; kept {kept}, within {most}");
        Some(Claim { verdict, text })
    })
}

/// The claim of the ratio of times: the new interval reaches the kept one, widened for machines. One
/// that is wide decides nothing, unless it is somewhere else.
fn ratio_claim(runs: &[Run; 2], pairs: &[Pair]) -> Option<Claim> {
    let logs = |run: &Run, row: usize| {
        let ratios = run.over_baseline(row, STAGES[0])?;
        Some(ratios.into_iter().map(f64::ln).collect())
    };
    let (logs, pictures): ([Vec<Vec<f64>>; 2], _) = common(runs, pairs, logs)?;
    let lacking = pictures.too_few("times");
    lacking.or_else(|| {
        let [kept, new] = logs.map(|logs| stats::over_pictures(&logs));
        let (kept, new) = kept.zip(new)?;
        let (low, high) = (kept.low / MACHINES, kept.high * MACHINES);
        let (verdict, wide) = match (new.low <= high && new.high >= low, new.relative()) {
            (false, _) => (Verdict::NotRepeated, None),
            (true, wide) if wide > RESOLVED => (Verdict::NotJudged, Some(RESOLVED)),
            (true, _) => (Verdict::Repeated, None),
        };
        let shown = |i: Interval| {
            let ends = i.ends().map_or("no interval".to_owned(), range);
            format!("{} ({ends})", number(i.value, 3))
        };
        let wide = wide.map(|most| {
            format!(
                "; its interval is wider than {} to either side",
                percent(most)
            )
        });
        let text = format!(
            "takes {} of the RBM baseline's time {}; kept {}, on other machines {}{}",
            shown(new),
            pictures.words(),
            shown(kept),
            range((low, high)),
            wide.unwrap_or_default()
        );
        Some(Claim { verdict, text })
    })
}

#[cfg(test)]
mod tests;
