//! The judge of claims: whether a new run repeats what a kept one says of a method over its pictures.

use super::groups::{self, Common, Group};
use super::run::Run;
use super::scenes::Scenes;
use crate::plan::RBM_BASELINE;
use crate::plan::method::Method;
use crate::report::columns::{Cell, RESOLVED};
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::names::{number, percent, range};
use revmap_figures::stats;
use std::path::Path;

/// The factor by which ratios may leave the kept interval to either side. Ratios of one method differ
/// by up to 1.3 between lavapipe 22.3.6 and 25.0.7 on one machine (`results/2026-11-24-drivers.md`:
/// `exact` in compute, 0.49 and 0.64).
const MACHINES: f64 = 1.3;
/// The share by which errors may differ. Most differ by less than 3 % between drivers.
const ERRORS: f64 = 0.1;
/// The share of the kept run's pictures that a claim needs.
const ENOUGH: f64 = 0.5;
/// The errors that are claimed, and by how much each may differ beside the share [`ERRORS`]:
/// roundings decide some pixels.
const QUANTITIES: [(groups::Error, f64); 2] = [(groups::WRONG, 3.0), (groups::DEPTH, 0.0)];

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

/// What the new run says about a claim: the claim, the new figure and the kept one.
pub type Claim = (Verdict, String);

/// The claims of these methods (as `exact`, `mesh:64x128`; `baseline` is the RBM baseline) in each
/// stage that the kept run has of them: the ratio of times, and each of the errors. Each is
/// judged by the pictures that both runs have. Behind them warnings about what the runs drew.
///
/// # Errors
/// Those of reading either run; [`ErrorKind::Content`] if the kept run lacks a method.
pub fn claims(kept: &Path, new: &Path, methods: &[String]) -> Result<(Vec<Claim>, Vec<String>)> {
    let runs = [Run::load(kept)?, Run::load(new)?];
    let scenes = runs.each_ref().map(|run| Scenes::of(&runs[0], run));
    let by = |run: &Run, record: &[String]| {
        let stage = run.at(record, "stage").to_owned();
        vec![groups::method(run, record), stage]
    };
    let all = groups::groups(&runs, &scenes, &by);
    let mut found = Vec::new();
    for method in methods {
        let name = match method.as_str() {
            "baseline" => RBM_BASELINE,
            other => other,
        };
        let stages = ["fragment", "compute"].map(|stage| [name, stage]);
        let own = stages.map(|key| all.iter().find(|group| group.key == key));
        if own.iter().all(Option::is_none) {
            let message = format!(
                "holds no {method}, so it makes no claim about it; name methods of that run"
            );
            return Err(Error::new(ErrorKind::Content, message).in_file(kept));
        }
        found.extend(
            own.into_iter()
                .flatten()
                .flat_map(|group| judge(&runs, group)),
        );
    }
    let [_, scenes] = scenes;
    Ok((found, scenes.warnings))
}

/// The claims as text, one a line.
pub fn as_text(claims: &[Claim]) -> String {
    let line = |(verdict, text): &Claim| format!("{:<12}  {text}\n", verdict.word());
    let lines: String = claims.iter().map(line).collect();
    let count = |v: Verdict| claims.iter().filter(|c| c.0 == v).count();
    let others = [Verdict::NotRepeated, Verdict::NotJudged].map(|v| (count(v), v.word()));
    let others = others.iter().filter(|(count, _)| *count > 0);
    let others: String = others.map(|(n, word)| format!(", {n} {word}")).collect();
    let (repeated, all) = (count(Verdict::Repeated), claims.len());
    format!("{lines}\n{repeated} of {all} claims repeated{others}\n")
}

/// The claims of one method in one stage.
fn judge(runs: &[Run], group: &Group) -> Vec<Claim> {
    let (method, stage) = (group.key[0].as_str(), group.key[1].as_str());
    // The baseline in the fragment stage is the unit of ratios.
    let ratio = match (method, stage) == (RBM_BASELINE, "fragment") {
        true => None,
        false => claim("times", group.times(runs, true), ratio_claim),
    };
    // The floor, whose errors mean nothing, makes no claim about them.
    let quantities = QUANTITIES.iter().filter(|_| method != Method::Floor.name());
    let errors = quantities.filter_map(|((name, columns, of_all), slack)| {
        claim(name, group.errors(runs, columns), |values, pictures| {
            let (kept, new) = of_all(&values[0]).zip(of_all(&values[1]))?;
            let most = slack + ERRORS * kept;
            let verdict = match (new - kept).abs() <= most {
                true => Verdict::Repeated,
                false => Verdict::NotRepeated,
            };
            let [new, kept, most] = [new, kept, most].map(|v| number(v, 3));
            Some((
                verdict,
                format!("{new} {name} {pictures}; kept {kept}, within {most}"),
            ))
        })
    });
    let claims = ratio.into_iter().chain(errors);
    claims
        .map(|(verdict, text)| (verdict, format!("{method}, {stage}: {text}")))
        .collect()
}

/// A claim over the pictures of both runs, which `judged` judges if they are enough; none if the
/// kept run has no value.
fn claim<T>(
    what: &str,
    common: Common<T>,
    judged: impl Fn(&[Vec<T>], &str) -> Option<Claim>,
) -> Option<Claim> {
    let (count, of) = (common.values[0].len(), common.of);
    let pictures = format!("in {count} of the kept run's {of} pictures");
    match () {
        () if of == 0 => None,
        () if (count as f64) < ENOUGH * of as f64 => {
            let text = format!("{what} {pictures}, below half of them");
            Some((Verdict::NotJudged, text))
        }
        () => judged(&common.values, &pictures),
    }
}

/// The claim of the ratio of times: the new interval reaches the kept one, widened for machines. One
/// that is wide decides nothing, unless it is somewhere else.
fn ratio_claim(logs: &[Vec<Vec<f64>>], pictures: &str) -> Option<Claim> {
    let (kept, new) = stats::over_pictures(&logs[0]).zip(stats::over_pictures(&logs[1]))?;
    let (low, high) = (kept.low / MACHINES, kept.high * MACHINES);
    let (verdict, wide) = match (new.low <= high && new.high >= low, new.relative()) {
        (false, _) => (Verdict::NotRepeated, String::new()),
        (true, wide) if wide > RESOLVED => {
            let most = percent(RESOLVED);
            let wide = format!("; its interval is wider than {most} to either side");
            (Verdict::NotJudged, wide)
        }
        (true, _) => (Verdict::Repeated, String::new()),
    };
    let [new, kept] = [new, kept].map(|i| Cell::Known(i).shown());
    let most = range((low, high));
    let text = format!(
        "takes {new} of the RBM baseline's time {pictures}; kept {kept}, on other machines {most}{wide}"
    );
    Some((verdict, text))
}

#[cfg(test)]
mod tests;
