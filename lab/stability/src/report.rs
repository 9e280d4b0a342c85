//! What a run of the catalogue writes: the table, `results.csv`, `report.html`.

use super::case::Case;
use super::judge::Judged;
use super::run::{Outcome, STAGES, TOO_LARGE, Trial, Verdict};
use revmap::error::Result;
use revmap::settings::{DrawStage, Solver};
use revmap_bench::measure::machine::Machine;
use revmap_bench::plan::method::MethodSettings;
use revmap_bench::report::series_style;
use revmap_figures::chart::Figure;
use revmap_figures::chart::axis::Axis;
use revmap_figures::chart::xy::{Point, Series, XyChart};
use revmap_figures::files::{keep_figure, make, png, write_bytes, write_text};
use revmap_figures::names::number;
use revmap_figures::page::Page;
use revmap_figures::table::Table;
use revmap_searches::folder;
use std::iter::once;
use std::path::Path;

/// What shares of faults are drawn at where there are none, percent.
const FLOOR: f64 = 1e-3;

/// The line above the table on a terminal.
pub const HEADLINE: &str = "worst share of wrong pixels over hit pixels; published searches fail most cases; the exit code is that of the default";

/// Trials of a case by a search, in both stages.
fn of(outcome: &Outcome, case: usize, solver: Solver) -> impl Iterator<Item = &Trial> {
    let own = move |t: &&Trial| t.case == case && t.solver == solver;
    outcome.trials.iter().filter(own)
}

/// The worst of some trials: by what its verdict says, then by its faults.
fn worst<'a>(trials: impl Iterator<Item = &'a Trial>) -> Option<&'a Trial> {
    let share = |t: &Trial| t.judged.as_ref().map_or(0.0, Judged::share);
    trials.max_by(|a, b| {
        let verdicts = a.verdict.cmp(&b.verdict);
        verdicts.then(share(a).total_cmp(&share(b)))
    })
}

/// A share of faults with its verdict.
fn cell(trial: &Trial) -> String {
    let Ok(judged) = &trial.judged else {
        return trial.verdict.name().to_owned();
    };
    let share = number(100.0 * judged.share(), 2);
    match trial.verdict {
        Verdict::Passed => format!("{share} %"),
        Verdict::Failed => format!("{share} % FAILED"),
        other => format!("{share} % {}", other.name()),
    }
}

fn drawn(cases: &[Case], outcome: &Outcome) -> Vec<usize> {
    let is_drawn = |k: &usize| outcome.trials.iter().any(|t| t.case == *k);
    (0..cases.len()).filter(is_drawn).collect()
}

/// The table of cases and searches: the worst share of faults in each, and the verdict.
pub fn table(cases: &[Case], solvers: &[Solver], outcome: &Outcome) -> Table {
    let record = |k: usize| {
        let worst = |&s: &Solver| worst(of(outcome, k, s)).map(cell).unwrap_or_default();
        let (name, swept) = (cases[k].name.clone(), cases[k].parameter.clone());
        let worst = solvers.iter().map(worst);
        once(name).chain(worst).chain(once(swept)).collect()
    };
    let records = drawn(cases, outcome).into_iter().map(record);
    let header = once("case").chain(solvers.iter().map(|s| s.name()));
    Table::new(header.chain(once("swept over")), records.collect())
}

/// The table of flicker: of each motion and search the worst share of pixels that flicker from one
/// frame to the next, percent of the hit pixels. None where no motion was drawn.
pub fn flicker(cases: &[Case], solvers: &[Solver], outcome: &Outcome) -> Option<Table> {
    let share = |k: usize, solver: Solver| {
        let judged = of(outcome, k, solver).filter_map(|t| t.judged.as_ref().ok());
        let share = judged.filter_map(Judged::flicker_share).reduce(f64::max);
        share.map_or(String::new(), |s| format!("{} %", number(100.0 * s, 2)))
    };
    let record = |k: usize| {
        let name = once(cases[k].name.clone());
        name.chain(solvers.iter().map(|&s| share(k, s))).collect()
    };
    let motions = drawn(cases, outcome).into_iter();
    let records: Vec<_> = (motions.filter(|k| cases[*k].motion).map(record)).collect();
    let header = once("flicker").chain(solvers.iter().map(|s| s.name()));
    (!records.is_empty()).then(|| Table::new(header, records))
}

/// What the default fails, a line for each.
pub fn failures(cases: &[Case], outcome: &Outcome) -> Vec<String> {
    let is_failure = |t: &&Trial| t.solver == Solver::DEFAULT && t.verdict == Verdict::Failed;
    let line = |t: &Trial| {
        let (name, value) = (&cases[t.case].name, number(t.value, 6));
        let judged = t.judged.as_ref();
        let what = judged.map_or_else(Clone::clone, Judged::to_string);
        format!("{name} at {value}, {}: {what}", t.stage.name())
    };
    outcome.trials.iter().filter(is_failure).map(line).collect()
}

/// The errors of searches of other people's folders, each once. A map that is too large, or of
/// a format that the search does not read, is no fault of the search: the case is named.
pub fn errors(cases: &[Case], outcome: &Outcome) -> Vec<String> {
    let mut all = Vec::new();
    for trial in &outcome.trials {
        if let (Err(error), Some(_)) = (&trial.judged, folder::of(trial.solver)) {
            let solver = trial.solver;
            let (case, value) = (&cases[trial.case].name, number(trial.value, 6));
            let refused = error.starts_with(TOO_LARGE)
                || error.starts_with("map_format: ")
                || error.contains(&format!("which {solver} does not draw"));
            let line = match refused {
                true => format!("{case} at {value} is not drawn by {solver}: {error}"),
                false => format!("{solver} failed: {error}"),
            };
            if !all.contains(&line) {
                all.push(line);
            }
        }
    }
    all
}

/// `results.csv`: a record for each trial.
pub fn results(cases: &[Case], outcome: &Outcome, machine: &Machine) -> Table {
    let judged =
        |of: fn(&Judged) -> String| move |t: &Trial| t.judged.as_ref().map(of).unwrap_or_default();
    let optional = |value: Option<f64>| value.map(|v| number(v, 5)).unwrap_or_default();
    let share = |of: fn(&Judged) -> Option<f64>| {
        move |t: &Trial| optional(t.judged.as_ref().ok().and_then(of))
    };
    Table::of(
        &outcome.trials,
        &[
            ("case", &|t| cases[t.case].name.clone()),
            ("parameter", &|t| cases[t.case].parameter.clone()),
            ("value", &|t| number(t.value, 6)),
            ("solver", &|t| t.solver.name().to_owned()),
            ("stage", &|t| t.stage.name().to_owned()),
            ("verdict", &|t| t.verdict.name().to_owned()),
            ("hits", &judged(|j| j.hits.to_string())),
            ("missed", &judged(|j| j.missed.to_string())),
            ("ghost", &judged(|j| j.ghost.to_string())),
            ("wrong", &judged(|j| j.wrong.to_string())),
            ("depth_p99_texels", &share(|j| j.depth_p99)),
            ("normal_rms_degrees", &share(|j| j.normal_rms)),
            ("not_finite", &judged(|j| j.not_finite.to_string())),
            ("exhausted", &judged(|j| j.exhausted.to_string())),
            ("color_faults", &judged(|j| j.color.to_string())),
            ("stage_faults", &judged(|j| j.stages.to_string())),
            ("flicker", &share(Judged::flicker_share)),
            ("limit", &|t| t.limit.to_string()),
            ("ms", &|t| number(t.ms, 4)),
            ("error", &|t| t.judged.clone().err().unwrap_or_default()),
            ("device", &|_| machine.device.clone()),
            ("driver", &|_| machine.driver.clone()),
        ],
    )
}

/// Share of faults over the case's parameter, a line for each search and stage.
fn chart(case: &Case, number_of: usize, solvers: &[Solver], outcome: &Outcome) -> Figure {
    let least = case.values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = case.values.iter().copied().fold(0.0, f64::max);
    let x = if least > 0.0 && most > 20.0 * least {
        Axis::log(&case.parameter)
    } else {
        Axis::linear(&case.parameter)
    };
    let line = |(solver, stage): (Solver, DrawStage)| {
        let settings = MethodSettings::default().by(solver).in_stage(stage);
        let share = |t: &Trial| Some(100.0 * t.judged.as_ref().ok()?.share());
        let point = |t: &Trial| Some(Point::at(t.value, share(t)?.max(FLOOR)));
        let own = of(outcome, number_of, solver).filter(|t| t.stage == stage);
        Series {
            name: solver.name().to_owned(),
            style: series_style::style(&settings),
            points: own.filter_map(point).collect(),
            joined: true,
        }
    };
    let ways = solvers.iter().flat_map(|&s| STAGES.map(|stage| (s, stage)));
    XyChart {
        title: case.name.clone(),
        x,
        y: Axis::log("faults (% of hit pixels)").from(FLOOR).with(1.0),
        series: ways.map(line).filter(|s| !s.points.is_empty()).collect(),
        guides: Vec::new(),
    }
    .figure()
}

/// Writes `results.csv`, `report.html`, the charts and the pictures.
pub fn write(
    folder: &Path,
    cases: &[Case],
    solvers: &[Solver],
    outcome: &Outcome,
    machine: &Machine,
) -> Result<()> {
    let csv = results(cases, outcome, machine).csv();
    write_text(&folder.join("results.csv"), &csv)?;
    let mut page = Page::new("revmap: stability");
    errors(cases, outcome)
        .iter()
        .for_each(|line| page.note(line));
    page.text(
        "Each case is a scene in which methods break, swept over the parameter that decides. A fault is a pixel that no solid within the tolerance could have given, a \
         number that is none, a ray out of steps, a colour that the reference does not have there, or a pixel in which both stages differ. The table has the worst \
         share of faults in each case, over the pixels that the reference hits: a fault beside the solid can make it more than 100 %. Published searches fail most cases.",
    );
    page.chapter("All cases");
    page.table(&table(cases, solvers, outcome));
    if let Some(flicker) = flicker(cases, solvers, outcome) {
        page.text(
            "Pixels that flicker from one frame of a motion to the next: their fault in the one is none in the other, or errs by another distance. A pixel that is right in \
             both changes as the reference does.",
        );
        page.table(&flicker);
    }
    let pictures = folder.join("pictures");
    make(&pictures)?;
    let mut captions = Table::new(["case", "picture"], Vec::new());
    for k in drawn(cases, outcome) {
        let case = &cases[k];
        page.chapter(&case.name);
        page.text(&case.why);
        page.text(&format!("Cure: {}", case.cure));
        for known in &case.known {
            page.note(&format!("The default fails here: {}", known.reason));
        }
        if let Some(glance) = outcome.glances.iter().find(|g| g.case == k) {
            page.text("Where the failure is seen best: the whole picture, and a part of it as drawn, as the reference has it, and the difference.");
            page.shots(std::slice::from_ref(&glance.shot))?;
            let (strip, caption) = &glance.shot;
            let file = pictures.join(format!("{}.png", case.name));
            write_bytes(&file, &png(strip)?)?;
            let record = vec![case.name.clone(), caption.clone()];
            captions.records.push(record);
        }
        let figure = chart(case, k, solvers, outcome);
        keep_figure(folder, &case.name, &figure)?;
        page.figure(&figure, &format!("Faults against the {}. Filled markers: fragment, hollow: compute. No faults are drawn at {FLOOR} %.", case.parameter));
        let last = case.values.last().copied().unwrap_or_default();
        page.text(&format!(
            "One of its scenes: `revmap render scenes/{}-{last}.toml -o frame.png`",
            case.name
        ));
    }
    page.chapter("How this was measured");
    page.facts(&machine.lines);
    write_text(&pictures.join("captions.csv"), &captions.csv())?;
    write_text(&folder.join("report.html"), &page.html())
}
