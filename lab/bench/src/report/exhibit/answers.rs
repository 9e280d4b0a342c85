//! Questions that a report answers in one sentence: fragment or compute, whether another search or a
//! mesh is faster than the default, and at which tolerance the default and meshes of equal silhouettes
//! take the same time.

use crate::measure::ratios::{Over, Ratio, between, over};
use crate::measure::row::Row;
use crate::plan::is_rbm_baseline;
use crate::plan::method::Method;
use crate::report::columns::{Cell, Context};
use revmap::settings::DrawStage;
use revmap_figures::groups::grouped;
use revmap_figures::names::{count, number, range};
use revmap_figures::stats::{Interval, Verdict};

/// A question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Question {
    /// Which stage draws the default search faster?
    Stages,
    /// Where is another search faster than the default?
    Rivals,
    /// From which tolerance on is the mesh of equal silhouettes faster than the default?
    Tolerances,
}

impl Question {
    /// The answers from these rows, a sentence or two each; none where the rows do not tell.
    pub fn answers(self, context: &Context, rows: &[&Row]) -> Vec<String> {
        match self {
            Self::Stages => stages(context, rows),
            Self::Rivals => rivals(context, rows).into_iter().collect(),
            Self::Tolerances => crossings(context, rows),
        }
    }
}

/// The sentences at the top of a report: a reader wants them first.
pub(crate) fn findings(context: &Context) -> Vec<String> {
    let mut all = Question::Stages.answers(context, context.rows);
    let loses: Vec<_> = rivals(context, context.rows)
        .into_iter()
        .chain(to_meshes(context))
        .collect();
    if !loses.is_empty() {
        all.push(format!("Where it loses, if anywhere: {}", loses.join(" ")));
    }
    all
}

/// How many times are not resolved, if any is not.
pub(crate) fn unresolved(context: &Context) -> Option<String> {
    let wide = |r: &&&Row| r.time().is_some() && !r.resolved(context.resolved);
    let number = context.rows.iter().filter(wide).count();
    (number > 0).then(|| {
        format!(
            "{number} of {} are not resolved: their 95 % intervals reach more than {:.0} % to either side. They are marked, and are on no front and in no verdict. Measure longer on a quiet machine (--passes, --max-seconds).",
            count(context.rows.len(), "time"),
            100.0 * context.resolved
        )
    })
}

/// The answer for each way of the default search, or of others where the plan lacks it.
fn stages(context: &Context, rows: &[&Row]) -> Vec<String> {
    let mut ratios = over(rows.iter().copied(), Over::Fragment);
    let default = |r: &Ratio| r.settings.method == Method::DEFAULT;
    let both = DrawStage::NAMES.iter().all(|(_, stage)| {
        let own = |r: &&Row| (r.settings.method, r.settings.stage) == (Method::DEFAULT, *stage);
        rows.iter().any(own)
    });
    if both && !ratios.iter().any(default) {
        return vec![format!(
            "On {} the stages cannot be compared for `{}`: in no picture do the clocks agree in both.",
            context.device,
            Method::DEFAULT.name()
        )];
    }
    let other = |r: &Ratio| r.settings.method != Method::Floor && !is_rbm_baseline(&r.settings);
    ratios.retain(|r| if both { default(r) } else { other(r) });
    let sentence = |r: &Ratio| {
        let pictures = r.pairs.len();
        let spread = match pictures {
            1 => String::new(),
            _ => format!(", {} in single pictures", range(r.range)),
        };
        let verdict = match r.time.verdict(context.resolved) {
            Verdict::Faster => "compute is faster".to_owned(),
            Verdict::Slower => "the fragment stage is faster".to_owned(),
            Verdict::Even => "no difference is resolved".to_owned(),
            Verdict::Unresolved => format!(
                "no difference is resolved, since the interval is wider than {:.0} % to either side",
                100.0 * context.resolved
            ),
        };
        format!(
            "On {} compute takes {} of the fragment stage's time for `{}` ({}){}{spread}: {verdict}.",
            context.device,
            number(r.time.value, 3),
            context.styles.way(&r.settings),
            r.time.ends().map_or("interval unknown".to_owned(), range),
            context.over_pictures(pictures),
        )
    };
    ratios.iter().map(sentence).collect()
}

/// A row of the default search, the fastest other way, and the ratio of their times.
type Pair<'a> = (&'a Row, &'a Row, Interval);

/// The rows that have another by whose time theirs can be divided.
fn pairs<'a>(rows: &[&'a Row], other: impl Fn(&'a Row) -> Option<&'a Row>) -> Vec<Pair<'a>> {
    let pair = |row: &&'a Row| {
        let other = other(row)?;
        Some((*row, other, between(row, other)?))
    };
    rows.iter().filter_map(pair).collect()
}

/// The largest resolved ratio in words, and the row that its time is over.
fn worst<'a>(context: &Context, pairs: &[Pair<'a>]) -> Option<(String, &'a Row)> {
    let known = pairs.iter();
    let known = known.filter(|p| p.2.verdict(context.resolved) != Verdict::Unresolved);
    let (row, other, time) = known.max_by(|a, b| a.2.value.total_cmp(&b.2.value))?;
    let (time, stage) = (Cell::Known(*time).shown(), row.settings.stage.name());
    let what = match other.settings.method.is_mesh() {
        true => "mesh of the picture",
        false => "other search",
    };
    let told = format!(
        "`exact` takes at most {time} of the time of the fastest {what}: {} at {} in the {stage} stage, against `{}`",
        row.scene,
        row.size(),
        other.settings.method
    );
    Some((told, other))
}

fn rivals(context: &Context, rows: &[&Row]) -> Option<String> {
    let all = pairs(rows, |row| Over::Rival.of(context.rows, row));
    if all.is_empty() {
        return None;
    }
    let of = |verdict| {
        let verdicts = all.iter().map(|p| p.2.verdict(context.resolved));
        verdicts.filter(|v| *v == verdict).count()
    };
    let pictures = grouped(rows, |r| r.picture()).len();
    let Some((told, _)) = worst(context, &all) else {
        return Some("No ratio to another search is resolved.".to_owned());
    };
    Some(format!(
        "{told}. It is faster in {} of {} measurements ({}), another search in {}; in {} no difference is resolved, and {} are not resolved.",
        of(Verdict::Faster),
        all.len(),
        count(pictures, "picture"),
        of(Verdict::Slower),
        of(Verdict::Even),
        of(Verdict::Unresolved),
    ))
}

/// The largest time of the default over that of the fastest mesh of the same picture, and the mesh's
/// name and error.
fn to_meshes(context: &Context) -> Option<String> {
    let timed = |r: &Row| r.time().map_or(f64::INFINITY, |t| t.value);
    let mut rows = context.rows.to_vec();
    rows.retain(|r| r.settings.method == Method::DEFAULT);
    let all = pairs(&rows, |row| {
        let same = |r: &&Row| r.settings.method.is_mesh() && r.picture() == row.picture();
        let meshes = context.rows.iter().copied().filter(same);
        meshes.min_by(|a, b| timed(a).total_cmp(&timed(b)))
    });
    let Some((told, mesh)) = worst(context, &all) else {
        let fastest = all.first()?.1.settings.method;
        return Some(format!(
            "No ratio to a mesh is resolved; the fastest is `{fastest}`."
        ));
    };
    let within = mesh.errors.view.map_or_else(String::new, |view| {
        let error = number(view.silhouette_max, 2);
        format!(", whose silhouettes are within {error} pixels")
    });
    Some(format!("{told}{within}."))
}

/// A sentence for each stage of the default: its time over the mesh's at each tolerance, and where
/// the two cross.
fn crossings(context: &Context, rows: &[&Row]) -> Vec<String> {
    let mut ratios = over(rows.iter().copied(), Over::Equal);
    ratios.retain(|r| r.settings.method == Method::DEFAULT);
    let stages = grouped(ratios, |r| r.settings.stage).into_iter();
    let sentence = |(stage, all): (DrawStage, Vec<Ratio>)| {
        let at = |r: &Ratio| Some((r.pairs.first()?.0.tolerance_px()?, r.time));
        let mut points: Vec<_> = all.iter().filter_map(at).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let told = points.iter().map(|(pixels, time)| {
            let open = ["", " (not resolved)"][usize::from(time.relative() > context.resolved)];
            format!("{}{open} at {pixels} pixels", number(time.value, 3))
        });
        let told = told.collect::<Vec<_>>().join(", ");
        let known = points.iter().filter(|p| p.1.relative() <= context.resolved);
        let known: Vec<(f64, f64)> = known.map(|(x, time)| (*x, time.value)).collect();
        let pictures = all.iter().map(|r| r.pairs.len()).max().unwrap_or(0);
        format!(
            "{} stage: the default takes this part of the time of the mesh of equal silhouettes{}: {told}. {}",
            stage.name(),
            context.over_pictures(pictures),
            crossing(&known)
        )
    };
    stages.map(sentence).collect()
}

/// Where a ratio that is known at some tolerances crosses 1.
fn crossing(points: &[(f64, f64)]) -> String {
    let crosses = |pair: &&[(f64, f64)]| (pair[0].1 < 1.0) != (pair[1].1 < 1.0);
    let place = |pair: &[(f64, f64)]| {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        // Times change with a power of the tolerance.
        let part = -y0.ln() / (y1.ln() - y0.ln());
        number((x0.ln() + part * (x1.ln() - x0.ln())).exp(), 2)
    };
    let found: Vec<String> = points.windows(2).filter(crosses).map(place).collect();
    match (points, found.as_slice()) {
        ([], _) => "No ratio is resolved.".to_owned(),
        ([first, ..], []) if first.1 < 1.0 => "The default is faster at each of them.".to_owned(),
        (_, []) => "The mesh is faster at each of them.".to_owned(),
        (_, found) => format!("They take the same time at {} pixels.", found.join(" and ")),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::{drawn, timed as passed};
    use crate::plan::method::MethodSettings;
    use crate::report::columns::tests::with_context;
    use revmap::settings::{Solver, Tolerance};

    /// A row of a search in a stage of a picture; its passes take these times.
    fn timed(method: Method, stage: DrawStage, view: usize, passes: &[f64]) -> Row {
        Row {
            view,
            scene: format!("scene{view}"),
            ..drawn(method, stage, passes, 0.01)
        }
    }

    /// The answers of the question of an exhibit, and the records of its first table.
    fn told(name: &str, rows: &[Row]) -> (Vec<String>, Vec<Vec<String>>) {
        let all = crate::report::exhibit::all(&[]).unwrap();
        let exhibit = all.iter().find(|e| e.name == name).unwrap();
        with_context(rows, |context| {
            let table = exhibit.table[0].shown(context, context.rows).unwrap();
            (exhibit.answers(context, context.rows), table.records)
        })
    }

    fn stages_of(rows: &[Row]) -> (Vec<String>, Vec<Vec<String>>) {
        told("stages", rows)
    }

    /// Compute takes half the fragment stage's time, while the machine slows down between passes.
    #[test]
    fn a_planted_ratio_of_stages_is_answered_in_one_sentence() {
        use DrawStage::{Compute, Fragment};
        let rows = [
            timed(Method::DEFAULT, Fragment, 0, &[8.0, 8.8, 8.1]),
            timed(Method::DEFAULT, Compute, 0, &[4.0, 4.4, 4.05]),
            timed(Method::DEFAULT, Fragment, 1, &[16.0, 17.6, 16.2]),
            timed(Method::DEFAULT, Compute, 1, &[8.0, 8.8, 8.1]),
            timed(Solver::Live.into(), Fragment, 0, &[10.0, 10.0, 10.0]),
        ];
        let (answers, records) = stages_of(&rows);
        let wanted = "On dev compute takes 0.5 of the fragment stage's time for `exact` (0.5 to 0.5) over 2 pictures, 0.5 to 0.5 in single pictures: compute is faster.";
        assert_eq!(answers, [wanted]);
        assert_eq!(records.len(), 1, "live was drawn in one stage");
        let [fragment, compute] = [&records[0][3], &records[0][4]];
        assert!(fragment.starts_with("11.7 (") && compute.starts_with("5.86 ("));
        assert_eq!(records[0][1..3], ["0.5 (0.5 to 0.5)", "compute"]);
    }

    #[test]
    fn an_interval_that_holds_1_or_is_too_wide_has_no_winner() {
        use DrawStage::{Compute, Fragment};
        let steady = timed(Method::DEFAULT, Fragment, 0, &[10.0, 10.0, 10.0]);
        for (compute, wanted, faster) in [
            (
                [9.9, 10.2, 10.1],
                "): no difference is resolved.",
                "no difference resolved",
            ),
            (
                [2.0, 10.0, 5.0],
                "the interval is wider than 25 % to either side.",
                "not resolved",
            ),
            (
                [15.0, 15.1, 15.0],
                ": the fragment stage is faster.",
                "fragment",
            ),
        ] {
            let compute = timed(Method::DEFAULT, Compute, 0, &compute);
            let (answers, records) = stages_of(&[steady.clone(), compute]);
            assert!(answers[0].ends_with(wanted), "{answers:?}");
            assert_eq!(records[0][2], faster);
            let marked = records[0][4].ends_with(", not resolved");
            assert_eq!(marked, faster == "not resolved", "{records:?}");
        }
        let rows = [
            timed(Method::DEFAULT, Fragment, 0, &[10.0, 10.0]),
            timed(Solver::Live.into(), Fragment, 0, &[10.0, 10.0]),
            timed(Solver::Live.into(), Compute, 0, &[5.0, 5.0]),
        ];
        assert!(stages_of(&rows).0[0].contains("0.5 of the fragment stage's time for `live`"));
        let mut lies = rows[0].clone();
        lies.settings.stage = Compute;
        lies.passes[0][0].gpu_ms = Some(0.1);
        let (answers, _) = stages_of(&[rows.to_vec(), vec![lies]].concat());
        assert_eq!(answers.len(), 1);
        assert!(answers[0].ends_with("in no picture do the clocks agree in both."));
    }

    /// The fastest mesh is named, however much it errs, and one picture is not counted.
    #[test]
    fn the_mesh_that_is_faster_is_named() {
        let mesh = |method, passes: &[f64]| timed(method, DrawStage::Fragment, 0, passes);
        let coarse = Method::mesh_within(4.0).unwrap();
        let rows = [
            mesh(Method::DEFAULT, &[10.0, 10.2, 10.0]),
            mesh(Method::OPPONENT, &[5.0, 5.1, 5.0]),
            drawn(coarse, DrawStage::Fragment, &[2.5, 2.55, 2.5], 9.0),
        ];
        let told = with_context(&rows, findings).join(" ");
        let wanted = "Where it loses, if anywhere: `exact` takes at most 4 (4 to 4) of the time of the fastest mesh of the picture: scene0 at 800x600 in the fragment stage, against `mesh:4px`";
        assert!(told.contains(wanted), "{told}");
        assert!(!told.contains("1 picture"), "{told}");
        // Times that are not resolved still have a fastest mesh.
        let rows = [
            mesh(Method::DEFAULT, &[10.0, 90.0, 30.0]),
            mesh(coarse, &[2.5, 2.55, 2.5]),
        ];
        let told = with_context(&rows, findings).join(" ");
        let wanted = "No ratio to a mesh is resolved; the fastest is `mesh:4px`.";
        assert!(told.contains(wanted), "{told}");
    }

    /// The quadric search is faster in one picture; a wider interval with a larger ratio does not
    /// count, and neither does a search that errs by more than a texel.
    #[test]
    fn the_worst_resolved_ratio_to_another_search_is_named() {
        use DrawStage::{Compute, Fragment};
        let quadric = Method::Search(Solver::Quadric);
        let live = Method::Search(Solver::Live);
        let rows = [
            timed(Method::DEFAULT, Fragment, 0, &[5.0, 5.1, 5.0]),
            timed(quadric, Fragment, 0, &[10.0, 10.2, 10.0]),
            drawn(live, Fragment, &[1.0, 1.0, 1.0], 1.5),
            timed(Method::DEFAULT, Compute, 0, &[6.0, 6.0, 6.0]),
            timed(quadric, Compute, 0, &[5.0, 5.0, 5.0]),
            timed(Method::DEFAULT, Fragment, 1, &[9.0, 40.0, 20.0]),
            timed(quadric, Fragment, 1, &[5.0, 5.0, 5.0]),
        ];
        let (answers, records) = told("rivals", &rows);
        let wanted = "`exact` takes at most 1.2 (1.2 to 1.2) of the time of the fastest other search: scene0 at 800x600 in the compute stage, against `quadric`. It is faster in 1 of 3 measurements (2 pictures), another search in 1; in 0 no difference is resolved, and 1 are not resolved.";
        assert_eq!(answers, [wanted]);
        // The fragment stage's mean is not resolved, as one picture of two is not.
        let wanted = ["compute", "1.2 (1.2 to 1.2)", "–", "1"];
        assert!(
            records[0][1].ends_with("not resolved") && records[1] == wanted,
            "{records:?}"
        );
    }

    /// The default takes 2 ms at any tolerance, meshes take less the more they may err: 4 ms at 0.1
    /// pixels, 1 ms at 1.6. They meet at 0.4, halfway of the factor.
    #[test]
    fn a_planted_crossing_is_found() {
        let mut rows = Vec::new();
        for (pixels, ms) in [(0.1, 4.0), (1.6, 1.0)] {
            let mesh = Method::mesh_within(pixels).unwrap();
            for (method, ms) in [(Method::DEFAULT, 2.0), (mesh, ms)] {
                let mut row = passed(&[ms, 1.001 * ms]);
                row.settings = MethodSettings::default().by(method);
                if method == Method::DEFAULT {
                    row.settings.tolerance = Tolerance::new(pixels).unwrap();
                }
                rows.push(row);
            }
        }
        let told = with_context(&rows, |context| crossings(context, context.rows));
        let wanted = "fragment stage: the default takes this part of the time of the mesh of equal silhouettes: 0.5 at 0.1 pixels, 2 at 1.6 pixels. They take the same time at 0.4 pixels.";
        assert_eq!(told, [wanted]);
        assert_eq!(
            crossing(&[(0.1, 1.2), (0.2, 1.3)]),
            "The mesh is faster at each of them."
        );
        assert_eq!(
            crossing(&[(0.1, 0.2)]),
            "The default is faster at each of them."
        );
    }
}
