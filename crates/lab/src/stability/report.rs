//! What a run of the catalogue writes: the table, `results.csv`, `report.html`.

use super::case::Case;
use super::judge::Judged;
use super::run::{Glance, Outcome, Sheet, Trial, Verdict};
use crate::method::{Method, MethodSettings};
use crate::report::chart::Figure;
use crate::report::chart::axis::Axis;
use crate::report::chart::xy::{Guide, Point, Series, XyChart};
use crate::report::folder::png;
use crate::report::folder::{keep_figure, make, write_bytes, write_text};
use crate::report::machine::Machine;
use crate::report::names::number;
use crate::report::page::Page;
use crate::report::pictures::Shot;
use crate::report::series_style;
use crate::report::table::Table;
use revmap::error::Result;
use revmap::settings::Solver;
use revmap_files::Picture;
use std::path::Path;

/// What shares of faults are drawn at where there are none, percent.
const FLOOR: f64 = 1e-3;

/// Trials of a case by a search, in both stages.
fn of(outcome: &Outcome, case: usize, solver: Solver) -> impl Iterator<Item = &Trial> {
    let own = move |t: &&Trial| t.case == case && t.solver == solver;
    outcome.trials.iter().filter(own)
}

/// The worst of some trials: most faults first, then what its verdict says.
fn worst<'a>(trials: impl Iterator<Item = &'a Trial>) -> Option<&'a Trial> {
    let rank = |t: &Trial| {
        let verdict = match t.verdict {
            Verdict::Failed => 4.0,
            Verdict::Known => 3.0,
            Verdict::Healed => 2.0,
            Verdict::Refused => 1.0,
            Verdict::Passed => 0.0,
        };
        verdict * 1e3 + t.judged.as_ref().map_or(0.0, |j| j.share())
    };
    trials.max_by(|a, b| rank(a).total_cmp(&rank(b)))
}

/// A share of faults with its verdict.
fn cell(trial: Option<&Trial>) -> String {
    let Some(trial) = trial else {
        return String::new();
    };
    match &trial.judged {
        Err(_) => trial.verdict.name().to_owned(),
        Ok(judged) => {
            let mark = match trial.verdict {
                Verdict::Passed => "",
                Verdict::Failed => " FAILED",
                Verdict::Known => " known",
                Verdict::Healed => " healed",
                Verdict::Refused => " refused",
            };
            format!("{} %{mark}", number(100.0 * judged.share(), 2))
        }
    }
}

/// The table of cases and searches: the worst share of faults in each, and the verdict.
#[must_use]
pub fn table(cases: &[Case], solvers: &[Solver], outcome: &Outcome) -> Table {
    let names = solvers.iter().map(|s| s.name());
    let drawn = |k: &usize| outcome.trials.iter().any(|t| t.case == *k);
    let record = |k: usize| {
        let cells = solvers.iter().map(|&s| cell(worst(of(outcome, k, s))));
        let named = [cases[k].name.to_owned(), cases[k].parameter.to_owned()];
        named.into_iter().chain(cells).collect()
    };
    Table::new(
        ["case", "swept over"].into_iter().chain(names),
        (0..cases.len()).filter(drawn).map(record).collect(),
    )
}

/// The table of flicker: of each motion and search the worst share of pixels that flicker from one
/// frame to the next, percent of the hit pixels. None where no motion was drawn.
#[must_use]
pub fn flicker(cases: &[Case], solvers: &[Solver], outcome: &Outcome) -> Option<Table> {
    let names = solvers.iter().map(|s| s.name());
    let share = |k: usize, solver: Solver| {
        let judged = of(outcome, k, solver).filter_map(|t| t.judged.as_ref().ok());
        judged.filter_map(Judged::flicker_share).reduce(f64::max)
    };
    let record = |k: usize| {
        let shares = solvers.iter().map(|&s| share(k, s));
        let cells =
            shares.map(|s| s.map_or(String::new(), |s| format!("{} %", number(100.0 * s, 2))));
        std::iter::once(cases[k].name.to_owned())
            .chain(cells)
            .collect()
    };
    let drawn = |k: &usize| cases[*k].motion && outcome.trials.iter().any(|t| t.case == *k);
    let records: Vec<_> = (0..cases.len()).filter(drawn).map(record).collect();
    let header = std::iter::once("flicker").chain(names);
    (!records.is_empty()).then(|| Table::new(header, records))
}

/// What the default fails, a line for each.
#[must_use]
pub fn failures(cases: &[Case], outcome: &Outcome) -> Vec<String> {
    let told = |t: &&Trial| t.solver == Solver::DEFAULT && t.verdict == Verdict::Failed;
    let line = |t: &Trial| {
        let case = &cases[t.case];
        let what = match &t.judged {
            Err(message) => message.clone(),
            Ok(j) => format!(
                "{} wrong, {} with a NaN, {} out of steps, {} of another colour, {} unlike the other stage, {} that flicker, of {} hit",
                j.wrong,
                j.not_finite,
                j.exhausted,
                j.color,
                j.stages,
                j.flicker.unwrap_or(0),
                j.hits
            ),
        };
        format!(
            "{} at {}, {}: {what}",
            case.name,
            number(case.steps[t.step].value, 6),
            t.stage.name()
        )
    };
    outcome.trials.iter().filter(told).map(line).collect()
}

/// `results.csv`: a record for each trial.
#[must_use]
pub fn results(cases: &[Case], outcome: &Outcome, machine: &Machine) -> Table {
    let header = [
        "case",
        "parameter",
        "value",
        "solver",
        "stage",
        "verdict",
        "hits",
        "missed",
        "ghost",
        "wrong",
        "depth_p99_texels",
        "normal_rms_degrees",
        "not_finite",
        "exhausted",
        "color_faults",
        "stage_faults",
        "flicker",
        "limit",
        "ms",
        "error",
        "device",
        "driver",
    ];
    let mut table = Table::new(header, Vec::new());
    for trial in &outcome.trials {
        let case = &cases[trial.case];
        let mut record = vec![
            case.name.to_owned(),
            case.parameter.to_owned(),
            number(case.steps[trial.step].value, 6),
            trial.solver.name().to_owned(),
            trial.stage.name().to_owned(),
            trial.verdict.name().to_owned(),
        ];
        let optional = |v: Option<f64>| v.map(|v| number(v, 5)).unwrap_or_default();
        match &trial.judged {
            Ok(j) => record.extend([
                j.hits.to_string(),
                j.missed.to_string(),
                j.ghost.to_string(),
                j.wrong.to_string(),
                optional(j.depth_p99),
                optional(j.normal_rms),
                j.not_finite.to_string(),
                j.exhausted.to_string(),
                j.color.to_string(),
                j.stages.to_string(),
                optional(j.flicker_share()),
            ]),
            Err(_) => record.extend(std::iter::repeat_n(String::new(), 11)),
        }
        record.extend([
            trial.limits.faults.to_string(),
            number(trial.ms, 4),
            trial.judged.as_ref().err().cloned().unwrap_or_default(),
            machine.device.clone(),
            machine.driver.clone(),
        ]);
        table.records.push(record);
    }
    table
}

/// Share of faults over the case's parameter, a line for each search and stage.
fn chart(case: &Case, number_of: usize, solvers: &[Solver], outcome: &Outcome) -> Figure {
    let mut series = Vec::new();
    let values = || case.steps.iter().map(|s| s.value);
    let log = values().all(|v| v > 0.0)
        && values().fold(0.0, f64::max) > 20.0 * values().fold(f64::INFINITY, f64::min);
    for &solver in solvers {
        for each in super::run::STAGES {
            let settings = MethodSettings {
                method: Method::Search(solver),
                stage: each,
                ..MethodSettings::default()
            };
            let points: Vec<Point> = of(outcome, number_of, solver)
                .filter(|t| t.stage == each)
                .filter_map(|t| {
                    let judged = t.judged.as_ref().ok()?;
                    Some(Point {
                        x: case.steps[t.step].value,
                        y: (100.0 * judged.share()).max(FLOOR),
                        ..Point::default()
                    })
                })
                .collect();
            if !points.is_empty() {
                series.push(Series {
                    name: solver.name().to_owned(),
                    style: series_style::style(&settings),
                    points,
                    joined: true,
                });
            }
        }
    }
    let x = if log {
        Axis::log(case.parameter)
    } else {
        Axis::linear(case.parameter)
    };
    XyChart {
        title: case.name.to_owned(),
        x,
        y: Axis::log("faults (% of hit pixels)").from(FLOOR).with(1.0),
        series,
        guides: Vec::<Guide>::new(),
    }
    .figure()
}

fn shot(case: usize, picture: &Picture, caption: String) -> Result<Shot> {
    Ok(Shot {
        view: case,
        caption,
        small: png(picture)?,
        size: (picture.width, picture.height),
    })
}

/// Which search drew a picture, and of which scene.
fn told(glance: &Glance) -> String {
    let (solver, each) = glance.method;
    let nothing = if glance.seen == 0 {
        ", nothing is seen"
    } else {
        ""
    };
    format!(
        "{solver}, {}, at {}{nothing}",
        each.name(),
        number(glance.value, 6)
    )
}

fn shots(sheet: &Sheet) -> Result<Vec<Shot>> {
    let [drawn, truth, heat] = &sheet.own;
    let default = Solver::DEFAULT.name();
    let mut all = vec![
        shot(sheet.case, truth, "the reference".to_owned())?,
        shot(
            sheet.case,
            drawn,
            format!("{default}, {}", sheet.stage.name()),
        )?,
        shot(sheet.case, heat, format!("{default}: difference"))?,
    ];
    if let Some((solver, [drawn, heat])) = &sheet.other {
        all.push(shot(sheet.case, drawn, solver.name().to_owned())?);
        all.push(shot(sheet.case, heat, format!("{solver}: difference"))?);
    }
    Ok(all)
}

/// Writes `results.csv`, `report.html`, the charts and the pictures.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    cases: &[Case],
    solvers: &[Solver],
    outcome: &Outcome,
    machine: &Machine,
) -> Result<()> {
    write_text(
        &folder.join("results.csv"),
        &results(cases, outcome, machine).csv(),
    )?;
    let mut page = Page::new("revmap: stability");
    page.facts(&machine.lines());
    page.text(
        "Each case is a scene in which methods break, swept over the parameter that decides. A fault is a pixel that no solid within the tolerance could have given, a \
         number that is none, a ray out of steps, a colour that the reference does not have there, or a pixel in which both stages differ. The table has the worst \
         share of faults in each case.",
    );
    page.chapter("All cases");
    page.table(&table(cases, solvers, outcome), &[0, 1]);
    if let Some(flicker) = flicker(cases, solvers, outcome) {
        page.text(
            "Pixels that flicker from one frame of a motion to the next: their fault in the one is none in the other, or errs by another distance. A pixel that is right in \
             both changes as the reference does.",
        );
        page.table(&flicker, &[0]);
    }
    let pictures = folder.join("pictures");
    make(&pictures)?;
    let mut captions = Table::new(["case", "picture"], Vec::new());
    let drawn = |k: usize| outcome.trials.iter().any(|t| t.case == k);
    for (k, case) in cases.iter().enumerate().filter(|(k, _)| drawn(*k)) {
        page.chapter(case.name);
        page.text(case.why);
        page.text(&format!("Cure: {}", case.cure));
        for known in &case.known {
            page.note(&format!("The default fails here: {}", known.reason));
        }
        if let Some(sheet) = outcome.sheets.iter().find(|s| s.case == k) {
            page.text(&format!("At {}:", number(sheet.value, 6)));
            let all = shots(sheet)?;
            page.shots(&all.iter().collect::<Vec<_>>());
        }
        if let Some(glance) = outcome.glances.iter().find(|g| g.case == k) {
            let caption = told(glance);
            page.text("Where the failure is seen best: the whole picture, and a part of it as drawn, as the reference has it, and the difference.");
            page.shots(&[&shot(k, &glance.strip, caption.clone())?]);
            let file = pictures.join(format!("{}.png", case.name));
            write_bytes(&file, &png(&glance.strip)?)?;
            captions.records.push(vec![case.name.to_owned(), caption]);
        }
        let figure = chart(case, k, solvers, outcome);
        keep_figure(folder, case.name, &figure)?;
        page.figure(&figure, &format!("Faults against the {}. Filled markers: fragment, hollow: compute. No faults are drawn at {FLOOR} %.", case.parameter));
        page.command(
            "One of its scenes:",
            &format!(
                "revmap render scenes/{}-{}.toml -o frame.png",
                case.name,
                case.steps.last().map_or(0.0, |s| s.value)
            ),
        );
    }
    write_text(&pictures.join("captions.csv"), &captions.csv())?;
    write_text(&folder.join("report.html"), &page.html())
}
