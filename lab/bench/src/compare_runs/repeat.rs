//! Whether a new run repeats a kept one: the ratio and the errors of each method over all pictures.

use super::run::Run;
use crate::method::Method;
use crate::names::{number, percent, range};
use crate::plan::RBM_BASELINE;
use crate::stats::{self, Interval};
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
/// Wrong pixels that may come and go beside that share: roundings decide them.
const PIXELS: f64 = 3.0;

/// The share of pictures that must have times. A picture without changes a mean by a few percent.
const TIMED: f64 = 0.75;

/// One claim, and whether the new run repeats it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// True if it does.
    pub repeated: bool,
    /// The claim, the new figure and the kept one.
    pub text: String,
}

/// A method in one stage over all pictures of a run.
struct Way {
    pictures: usize,
    /// Time over that of the RBM baseline in the fragment stage.
    ratio: Option<Interval>,
    /// Missed and ghost pixels.
    wrong: f64,
    /// Geometric mean of the depth errors, h/512.
    depth: Option<f64>,
}

/// The claims of these methods (as `exact`, `mesh:64x128`; `baseline` is the RBM baseline) in each
/// stage that the kept run has of them: the ratio of times, the wrong pixels, the depth error.
///
/// # Errors
/// Those of reading either run; [`ErrorKind::Content`] if the kept run lacks a method.
pub fn claims(kept: &Path, new: &Path, methods: &[String]) -> Result<Vec<Claim>> {
    let (old, run) = (Run::load(kept)?, Run::load(new)?);
    let mut all = Vec::new();
    for method in methods {
        let before = all.len();
        for stage in ["fragment", "compute"] {
            if let Some(old) = way(&old, method, stage) {
                let name = match method.as_str() {
                    "baseline" => RBM_BASELINE,
                    other => other,
                };
                all.extend(judge(
                    &format!("{name}, {stage}"),
                    &old,
                    way(&run, method, stage),
                ));
            }
        }
        if all.len() == before {
            let message = format!(
                "holds no {method}, so it makes no claim about it; name methods of that run"
            );
            return Err(Error::new(ErrorKind::Content, message).in_file(kept));
        }
    }
    Ok(all)
}

/// The claims as text, one a line.
pub fn as_text(claims: &[Claim]) -> String {
    let line = |claim: &Claim| {
        let verdict = if claim.repeated {
            "repeated"
        } else {
            "NOT repeated"
        };
        format!("{verdict:<12}  {}\n", claim.text)
    };
    let failed = claims.iter().filter(|c| !c.repeated).count();
    let lines: String = claims.iter().map(line).collect();
    format!(
        "{lines}\n{} of {} claims repeated\n",
        claims.len() - failed,
        claims.len()
    )
}

/// The rows of a method in a stage, put together; none if the run has none.
fn way(run: &Run, method: &str, stage: &str) -> Option<Way> {
    let named = |record: &[String]| match method {
        "baseline" => run.is_baseline(record),
        // The baseline's search by itself is another method.
        _ => run.at(record, "solver") == method && !run.is_baseline(record),
    };
    let records = run.results.records.iter().enumerate();
    let own: Vec<(usize, &Vec<String>)> = records
        .filter(|(_, r)| run.at(r, "stage") == stage && named(r))
        .collect();
    if own.is_empty() {
        return None;
    }
    let value = |record: &[String], name: &str| run.at(record, name).parse::<f64>().ok();
    let logs: Option<Vec<Vec<f64>>> = own.iter().map(|(row, r)| logs(run, *row, r)).collect();
    let mut logs = logs?;
    // A busy machine has a few times that its wall clock rejects.
    logs.retain(|passes| !passes.is_empty());
    let timed = logs.len() as f64 >= TIMED * own.len() as f64;
    let passes = logs.iter().map(Vec::len).min().filter(|_| timed);
    let passes = passes.unwrap_or(0);
    let in_pass = |pass: usize| logs.iter().map(|l| l[pass]).sum::<f64>() / logs.len() as f64;
    let ratios: Vec<f64> = (0..passes).map(|pass| in_pass(pass).exp()).collect();
    let depths: Vec<f64> = (own.iter())
        .filter_map(|(_, r)| value(r, "depth_p99_texels"))
        .map(|d| d.max(1e-4))
        .collect();
    let wrong = own
        .iter()
        .map(|(_, r)| value(r, "missed").unwrap_or(0.0) + value(r, "ghost").unwrap_or(0.0));
    Some(Way {
        pictures: own.len(),
        ratio: stats::geometric(&ratios),
        wrong: wrong.sum(),
        depth: stats::geometric(&depths).map(|d| d.value),
    })
}

/// Logarithms of a row's ratios to the RBM baseline in the fragment stage, one for each pass: medians
/// over the rounds. Empty if a clock was rejected, and `None` without such a baseline.
fn logs(run: &Run, row: usize, record: &[String]) -> Option<Vec<f64>> {
    let rival = run.baseline_of(record, "fragment")?;
    let passes = run.times(row).zip(run.times(rival));
    let log = |(a, b): (&[f64], &[f64])| {
        let logs: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a / b).ln()).collect();
        stats::median(&logs)
    };
    Some(passes.filter_map(log).collect())
}

/// The claims of one method in one stage.
fn judge(name: &str, old: &Way, new: Option<Way>) -> Vec<Claim> {
    let Some(new) = new.filter(|new| new.pictures == old.pictures) else {
        let text = format!(
            "{name}: the new run lacks some of its {} pictures",
            old.pictures
        );
        return vec![Claim {
            repeated: false,
            text,
        }];
    };
    let is_unit = name == format!("{RBM_BASELINE}, fragment");
    let ratio = (old.ratio.filter(|_| !is_unit)).map(|kept| ratio_claim(name, kept, new.ratio));
    let most = PIXELS + ERRORS * old.wrong;
    let wrong = Claim {
        repeated: (new.wrong - old.wrong).abs() <= most,
        text: format!(
            "{name}: {} wrong pixels in {} pictures; kept {}, within {}",
            new.wrong,
            new.pictures,
            old.wrong,
            number(most, 3)
        ),
    };
    let depth = old.depth.map(|kept| Claim {
        repeated: new.depth.is_some_and(|d| (d / kept - 1.0).abs() <= ERRORS),
        text: format!(
            "{name}: depth errors of {} h/512; kept {}, within {}",
            new.depth.map_or("unknown".to_owned(), |d| number(d, 3)),
            number(kept, 3),
            percent(ERRORS)
        ),
    });
    let errors = [Some(wrong), depth].into_iter().flatten();
    // The floor, whose errors mean nothing, makes no claim about them.
    let errors = errors.filter(|_| !name.starts_with(Method::Floor.name()));
    ratio.into_iter().chain(errors).collect()
}

/// The claim of a ratio: the new interval reaches the kept one, widened for machines, and is narrow.
fn ratio_claim(name: &str, kept: Interval, new: Option<Interval>) -> Claim {
    let (low, high) = (kept.low / MACHINES, kept.high * MACHINES);
    let reaches = |i: Interval| i.relative() <= RESOLVED && i.low <= high && i.high >= low;
    let shown = |i: Interval| {
        let ends = i.ends().map_or("no interval".to_owned(), range);
        format!("{} ({ends})", number(i.value, 3))
    };
    Claim {
        repeated: new.is_some_and(reaches),
        text: format!(
            "{name}: takes {} of the RBM baseline's time; kept {}, on other machines {}",
            new.map_or("an unknown part".to_owned(), shown),
            shown(kept),
            range((low, high))
        ),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::tests::folder_of;
    use super::*;
    use crate::plan::rbm_baseline;
    use crate::ratios::{Over, over};
    use crate::row::Row;
    use crate::row::tests::row;
    use crate::view::tests::spindle;

    /// Two pictures by the default search, which takes `part` of the baseline's time, and by the
    /// baseline; with so many wrong pixels of the search.
    fn rows(part: f64, wrong: usize) -> Vec<Row> {
        let drift = [1.0, 1.3, 0.9];
        let of = |ms: f64, bent: f64| {
            let passes =
                drift.map(|d| [(None, ms * d), (None, ms * d * bent), (None, ms * d / bent)]);
            row(&passes.each_ref().map(|p| p.as_slice()))
        };
        let pictures = ["vase", "pawn"].into_iter().enumerate();
        let both = pictures.flat_map(|(view, scene)| {
            let ms = 10.0 * (view + 1) as f64;
            let (mut ours, mut papers) = (of(part * ms, 1.01), of(ms, 1.02));
            ours.settings.method = Method::DEFAULT;
            ours.errors.missed = wrong;
            papers.settings = rbm_baseline(&spindle(), &papers.settings);
            papers.source = papers.settings.map_source;
            [ours, papers].map(|row| Row {
                view,
                scene: scene.to_owned(),
                ..row
            })
        });
        both.collect()
    }

    fn failed(kept: &[Row], new: &[Row]) -> Vec<String> {
        let (kept, new) = (folder_of(kept, "dev", "drv"), folder_of(new, "dev", "drv"));
        let methods = ["exact", "baseline"].map(str::to_owned);
        let claims = claims(kept.path(), new.path(), &methods).unwrap();
        let failed = claims.iter().filter(|c| !c.repeated);
        failed.map(|c| c.text.clone()).collect()
    }

    /// Figures as the table of a report has them, from the files alone.
    #[test]
    fn ratios_are_those_of_the_report() {
        let rows = rows(0.5, 0);
        let folder = folder_of(&rows, "dev", "drv");
        let run = Run::load(folder.path()).unwrap();
        let found = way(&run, "exact", "fragment").unwrap();
        let wanted = over(&rows, Over::Baseline);
        let (a, b) = (found.ratio.unwrap(), wanted[0].time);
        for (a, b) in [(a.value, b.value), (a.low, b.low), (a.high, b.high)] {
            assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
        }
        assert_eq!(found.pictures, 2);
        assert!(way(&run, "live", "fragment").is_none());
    }

    #[test]
    fn a_changed_figure_is_not_repeated() {
        let kept = rows(0.5, 100);
        assert_eq!(failed(&kept, &kept), [""; 0]);
        // Another machine, within what machines differ by.
        assert_eq!(failed(&kept, &rows(0.6, 105)), [""; 0]);
        for (new, wanted) in [
            (rows(0.7, 100), "exact, fragment: takes 0.7"),
            (rows(0.35, 100), "exact, fragment: takes 0.35"),
            (
                rows(0.5, 130),
                "exact, fragment: 260 wrong pixels in 2 pictures; kept 200",
            ),
            (rows(0.5, 70), "exact, fragment: 140 wrong pixels"),
        ] {
            let failed = failed(&kept, &new);
            assert_eq!(failed.len(), 1, "{failed:?}");
            assert!(failed[0].starts_with(wanted), "{failed:?}");
        }
        let fewer = failed(&kept, &kept[..2]);
        assert!(
            fewer
                .iter()
                .all(|f| f.contains("lacks some of its 2 pictures")),
            "{fewer:?}"
        );
        // A clock that is rejected in one of two pictures leaves too few; in one of four it does not.
        let lies = |rows: &mut Vec<Row>| {
            let samples = rows[0].passes.iter_mut().flatten();
            samples.for_each(|s| s.gpu_ms = Some(0.001));
        };
        let mut half = rows(0.5, 100);
        lies(&mut half);
        let unknown = failed(&kept, &half);
        assert!(unknown[0].contains("takes an unknown part"), "{unknown:?}");
        let more = |wanted: f64| {
            let mut more = rows(wanted, 100);
            let others = rows(wanted, 100).into_iter();
            more.extend(others.map(|row| Row {
                scene: format!("{}:close", row.scene),
                ..row
            }));
            more
        };
        let mut most = more(0.5);
        lies(&mut most);
        assert_eq!(failed(&more(0.5), &most), [""; 0]);
        // An interval that holds everything repeats nothing.
        let mut vague = rows(0.5, 100);
        for (pass, factor) in vague[0].passes.iter_mut().zip([0.3, 1.0, 3.0]) {
            pass.iter_mut().for_each(|s| s.frame_ms *= factor);
        }
        assert_eq!(failed(&kept, &vague).len(), 1);
    }

    #[test]
    fn what_the_kept_run_lacks_is_no_claim() {
        let kept = folder_of(&rows(0.5, 0), "dev", "drv");
        let error = claims(kept.path(), kept.path(), &["live".to_owned()]).unwrap_err();
        assert!(error.to_string().contains("holds no live"), "{error}");
    }
}
