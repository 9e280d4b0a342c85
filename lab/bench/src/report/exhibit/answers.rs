//! Questions that a report answers in one sentence: fragment or compute, and whether another search
//! than the default is faster.

use super::losses::{Pair, to_meshes, worst};
use crate::measure::ratios::{Over, Ratio, between, over};
use crate::measure::row::Row;
use crate::plan::is_rbm_baseline;
use crate::plan::method::Method;
use crate::report::columns::{Cell, Context};
use revmap::settings::DrawStage;
use revmap_figures::groups::grouped;
use revmap_figures::names::{count, number, range};
use revmap_figures::stats::Verdict;

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
            Self::Tolerances => super::crossing::answers(context, rows),
        }
    }
}

/// The sentences at the top of a report: a reader wants them first.
pub(crate) fn findings(context: &Context) -> Vec<String> {
    let mut all = Question::Stages.answers(context, context.rows);
    let opponent = format!("{}, the mesh of that silhouette", Method::OPPONENT);
    let mesh = "the coarsest mesh that errs no more in depth";
    for (reference, name) in [
        (Over::Opponent, opponent),
        (Over::Mesh, mesh.to_owned()),
        (Over::Baseline, context.baseline()),
    ] {
        let mut ratios = over(context.rows.iter().copied(), reference);
        ratios.retain(|r| r.settings.method == Method::DEFAULT && r.mesh.is_none());
        let told = ratios.iter().map(|r| {
            let (way, stage) = (context.styles.way(&r.settings), r.settings.stage.name());
            let time = Cell::Known(r.time).shown();
            let verdict = r.time.verdict(context.resolved).word("faster", "slower");
            let over = context.over_pictures(r.pairs.len());
            format!("{way}, {stage} stage: {time}{over}, {verdict}")
        });
        let told = told.collect::<Vec<_>>().join("; ");
        if !told.is_empty() {
            all.push(format!(
                "Speed: the default takes this part of the time of {name} (95 % interval): {told}."
            ));
        }
    }
    all.extend(exactness(context));
    let loses: Vec<_> = rivals(context, context.rows)
        .into_iter()
        .chain(to_meshes(context))
        .collect();
    if !loses.is_empty() {
        all.push(format!("Where it loses, if anywhere: {}", loses.join(" ")));
    }
    all
}

/// The worst errors of the default, of the RBM baseline and of each mesh.
fn exactness(context: &Context) -> Option<String> {
    let mut all: Vec<(String, [f64; 4])> = Vec::new();
    for row in context.rows {
        let settings = &row.settings;
        let is_mesh = settings.method.is_mesh();
        let way = match settings.method {
            _ if is_rbm_baseline(settings) => context.baseline(),
            method if is_mesh || method == Method::DEFAULT => context.styles.way(settings),
            _ => continue,
        };
        let errors = &row.errors;
        let view = errors.view.unwrap_or_default();
        let depth = errors.depth.map_or(0.0, |depth| depth.p99);
        let wrong = 100.0 * errors.wrong();
        let own = [view.silhouette_max, view.depth_p99, depth, wrong];
        match all.iter_mut().find(|known| known.0 == way) {
            Some((_, known)) => *known = [0, 1, 2, 3].map(|k| known[k].max(own[k])),
            None => all.push((way, own)),
        }
    }
    let told = all.iter().map(|(way, worst)| {
        let [silhouette, pixels, depth, wrong] = worst.map(|v| number(v, 2));
        format!("{way} {silhouette} pixels, {pixels} pixels ({depth} h/512), {wrong} %")
    });
    let told = told.collect::<Vec<_>>().join("; ");
    (!told.is_empty()).then(|| {
        format!("Exactness, in the worst picture: silhouettes are within, 99 % of depths are within, and wrong pixels of the pixels hit are: {told}.")
    })
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

fn pairs<'a>(context: &Context<'a>, rows: &[&'a Row]) -> Vec<Pair<'a>> {
    let pair = |row: &&'a Row| {
        let other = Over::Rival.of(context.rows, row)?;
        Some((*row, other, between(row, other)?))
    };
    rows.iter().filter_map(pair).collect()
}

fn rivals(context: &Context, rows: &[&Row]) -> Option<String> {
    let all = pairs(context, rows);
    if all.is_empty() {
        return None;
    }
    let of = |verdict| {
        let verdicts = all.iter().map(|p| p.2.verdict(context.resolved));
        verdicts.filter(|v| *v == verdict).count()
    };
    let pictures = grouped(rows, |r| r.picture()).len();
    let Some((row, other, time)) = worst(context, all.iter()) else {
        return Some("No ratio to another search is resolved.".to_owned());
    };
    Some(format!(
        "The default search takes at most {} of the time of the fastest other search: {} at {} in the {} stage, against `{}`. It is faster in {} of {} measurements ({}), another search in {}; in {} no difference is resolved, and {} are not resolved.",
        Cell::Known(*time).shown(),
        row.scene,
        row.size(),
        row.settings.stage.name(),
        other.settings.method,
        of(Verdict::Faster),
        all.len(),
        count(pictures, "picture"),
        of(Verdict::Slower),
        of(Verdict::Even),
        of(Verdict::Unresolved),
    ))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::row::tests::drawn;
    use crate::report::columns::tests::with_context;
    use revmap::settings::Solver;

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
        let wanted = "Where it loses, if anywhere: Against the fastest mesh of the picture it takes at most 4 (4 to 4) of the time: scene0 at 800x600 in the fragment stage, against `mesh:4px`";
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
        let wanted = "The default search takes at most 1.2 (1.2 to 1.2) of the time of the fastest other search: scene0 at 800x600 in the compute stage, against `quadric`. It is faster in 1 of 3 measurements (2 pictures), another search in 1; in 0 no difference is resolved, and 1 are not resolved.";
        assert_eq!(answers, [wanted]);
        // The fragment stage's mean is not resolved, as one picture of two is not.
        let wanted = ["compute", "1.2 (1.2 to 1.2)", "–", "1"];
        assert!(
            records[0][1].ends_with("not resolved") && records[1] == wanted,
            "{records:?}"
        );
    }
}
