//! What a tolerance buys and what it costs: measured errors and times of ten scenes at several
//! tolerances.

mod scenes;

use super::chapters;
use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::style::{Dash, Marker, Style, color};
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::folder::{keep_figure, write_text};
use super::machine::Machine;
use super::measure::{Measured, RenderedCase};
use super::names::number;
use super::page::Page;
use super::plan::{Case, Plan, is_rbm_baseline, rbm_baseline};
use super::ratios;
use super::row::Row;
use super::series_style::SeriesStyles;
use super::stats::{self, Interval};
use super::table::Table;
use super::view::View;
use crate::compare::{PixelErrors, pixel_errors};
use crate::method::{Method, MethodSettings};
use revmap::error::Result;
use revmap::settings::{DrawStage, Planes, Tolerance};
use std::path::Path;

/// The scene of solids of 2 to 20 pixels.
///
/// # Errors
/// Of the solids that the program carries.
pub fn distant() -> Result<Option<View>> {
    Ok(scenes::scenes()?.pop())
}

/// The tolerances, pixels.
pub const TOLERANCES: [f64; 5] = [0.05, 0.1, 0.25, 0.5, 2.0];
/// Those of the floor.
const FLOORS: [Tolerance; 2] = [Tolerance::EXACT, Tolerance::DEFAULT];

/// The plan: every scene at every tolerance and exact by the default search, by the RBM baseline,
/// and by the floor, exact and at the default tolerance.
///
/// # Errors
/// Of the solids that the program carries.
pub fn plan(stages: &[DrawStage], quick: bool) -> Result<Plan> {
    let mut views = scenes::scenes()?;
    if quick {
        // One solid, and the distant ones.
        views = [views.remove(0), views.remove(views.len() - 1)].into();
    }
    let mut plan = Plan::new(views, &[]);
    for view in 0..plan.views.len() {
        for &stage in stages {
            let exact = MethodSettings {
                stage,
                planes: Planes::Color,
                ..MethodSettings::default()
            };
            plan.add(view, exact);
            for pixels in TOLERANCES {
                let tolerance = Tolerance::new(pixels)?;
                plan.add(view, MethodSettings { tolerance, ..exact });
            }
            let baseline = rbm_baseline(&plan.views[view], &exact);
            plan.add(view, baseline);
            for tolerance in FLOORS {
                plan.add_floor(view, MethodSettings { tolerance, ..exact });
            }
        }
    }
    Ok(plan)
}

/// Errors of the pictures of a plan, in pixels.
#[derive(Debug, Default)]
pub struct Errors {
    of: Vec<(Case, PixelErrors)>,
    failure: Option<revmap::Error>,
}

impl Errors {
    /// Measures a picture; the floor's has no surface to err from.
    pub fn add(&mut self, seen: &RenderedCase) {
        if seen.case.settings.method == Method::Floor {
            return;
        }
        let scene = &seen.plan.views[seen.case.view].scene;
        match pixel_errors(scene, seen.truth, seen.frame) {
            Ok(errors) => self.of.push((*seen.case, errors)),
            Err(error) => self.failure = Some(error),
        }
    }

    fn row(&self, row: &Row) -> Option<&PixelErrors> {
        let same = |case: &Case| case.view == row.view && case.settings == row.settings;
        self.of.iter().find(|(case, _)| same(case)).map(|(_, e)| e)
    }
}

/// One scene at one tolerance.
struct Line<'a> {
    row: &'a Row,
    errors: Option<&'a PixelErrors>,
    /// Time over that of the exact picture.
    exact: Option<Interval>,
    /// Time over that of the RBM baseline.
    baseline: Option<Interval>,
}

fn lines<'a>(rows: &'a [Row], errors: &'a Errors) -> Vec<Line<'a>> {
    let beside = |row: &Row, wanted: &dyn Fn(&MethodSettings) -> bool| {
        let same = |r: &&Row| r.view == row.view && r.settings.stage == row.settings.stage;
        let other = rows.iter().filter(same).find(|r| wanted(&r.settings))?;
        ratios::between(row, other)
    };
    rows.iter()
        .map(|row| Line {
            row,
            errors: errors.row(row),
            exact: beside(row, &|s| {
                s.method == Method::default() && s.tolerance == Tolerance::EXACT
            }),
            baseline: beside(row, &is_rbm_baseline),
        })
        .collect()
}

fn name(settings: &MethodSettings) -> String {
    if is_rbm_baseline(settings) {
        super::plan::RBM_BASELINE.into()
    } else if settings.method == Method::Floor {
        floor_at(settings.tolerance)
    } else {
        settings.tolerance.to_string()
    }
}

fn floor_at(tolerance: Tolerance) -> String {
    format!("{} at {tolerance}", Method::Floor)
}

fn interval(ratio: Option<Interval>) -> String {
    ratio.map_or_else(String::new, |r| super::text::interval(&r, 2))
}

/// Columns of `budget.csv`.
const COLUMNS: [&str; 11] = [
    "scene",
    "stage",
    "tolerance_px",
    "error_p999_px",
    "contour_max_px",
    "contour_pixels",
    "pixels_hit",
    "time_ms",
    "time_over_exact",
    "time_over_rbm_baseline",
    "within",
];

fn table(lines: &[Line]) -> Table {
    let record = |line: &Line| {
        let settings = &line.row.settings;
        let error = |of: &dyn Fn(&PixelErrors) -> String| line.errors.map(of).unwrap_or_default();
        let ratio = |r: Option<Interval>| r.map(|r| number(r.value, 3)).unwrap_or_default();
        let bounded = settings.tolerance > Tolerance::EXACT;
        let within = line.errors.filter(|_| bounded).map(|e| {
            let most = settings.tolerance.pixels();
            let held = e.p999 <= most && e.contour_max <= most;
            if held { "yes" } else { "no" }
        });
        vec![
            line.row.scene.clone(),
            settings.stage.name().to_owned(),
            name(settings),
            error(&|e| number(e.p999, 3)),
            error(&|e| number(e.contour_max, 3)),
            error(&|e| e.moved.to_string()),
            error(&|e| e.pixels.to_string()),
            line.row
                .time()
                .map(|t| number(t.value, 4))
                .unwrap_or_default(),
            ratio(line.exact),
            ratio(line.baseline),
            within.unwrap_or_default().to_owned(),
        ]
    };
    Table::new(COLUMNS, lines.iter().map(record).collect())
}

/// Geometric means over the scenes.
fn means(lines: &[Line]) -> Table {
    let mut records = Vec::new();
    for stage_of in [DrawStage::Fragment, DrawStage::Compute] {
        let of_stage = lines.iter().filter(|l| l.row.settings.stage == stage_of);
        let of_stage: Vec<&Line> = of_stage.collect();
        let ways = TOLERANCES.iter().map(f64::to_string);
        for way in ways.chain(FLOORS.map(floor_at)) {
            let named = |l: &&&Line| name(&l.row.settings) == way;
            let at: Vec<&Line> = of_stage.iter().filter(named).copied().collect();
            let mean = |of: &dyn Fn(&Line) -> Option<Interval>| {
                let values: Vec<f64> = at.iter().filter_map(|l| Some(of(l)?.value)).collect();
                interval(stats::geometric(&values))
            };
            let errors = at.iter().filter_map(|l| Some(l.errors?.p999));
            let worst = errors.reduce(f64::max).map(|worst| number(worst, 3));
            if !at.is_empty() {
                records.push(vec![
                    stage_of.name().to_owned(),
                    way,
                    worst.unwrap_or_default(),
                    mean(&|l| l.exact),
                    mean(&|l| l.baseline),
                ]);
            }
        }
    }
    let header = [
        "stage",
        "tolerance (pixels)",
        "largest error, p99.9 (pixels)",
        "time / exact",
        "time / RBM baseline",
    ];
    Table::new(header, records)
}

/// The means as text.
#[must_use]
pub fn as_text(rows: &[Row], errors: &Errors) -> String {
    let lines = lines(rows, errors);
    table(&lines).aligned() + "\nGeometric means over the scenes:\n" + &means(&lines).aligned()
}

/// Points of each scene in one stage, by tolerance.
fn series(lines: &[Line], of: DrawStage, value: impl Fn(&Line) -> Option<f64>) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    let searched = |l: &&Line| l.row.settings.method != Method::Floor;
    for line in (lines.iter()).filter(|l| l.row.settings.stage == of && searched(l)) {
        let x = line.row.settings.tolerance.pixels();
        let Some(y) = value(line).filter(|y| x > 0.0 && *y > 0.0) else {
            continue;
        };
        let point = Point {
            x,
            y,
            spread: None,
            label: None,
        };
        match all.iter_mut().find(|s| s.name == line.row.scene) {
            Some(known) => known.points.push(point),
            None => {
                let k = all.len();
                let paint = color::ALL[k % color::ALL.len()];
                all.push(Series {
                    name: line.row.scene.clone(),
                    style: Style::new(paint, Marker::ALL[k % Marker::ALL.len()]),
                    points: vec![point],
                    joined: true,
                });
            }
        }
    }
    all
}

fn chart(title: String, y: &str, series: Vec<Series>, guides: Vec<Guide>) -> Figure {
    XyChart {
        title,
        x: Axis::log("tolerance (pixels)").at(TOLERANCES),
        y: Axis::log(y),
        series,
        guides,
    }
    .figure()
}

/// Writes `budget.csv` and the page.
///
/// # Errors
/// When a picture could not be measured, or a file cannot be written.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    errors: &Errors,
    machine: &Machine,
) -> Result<()> {
    if let Some(failure) = &errors.failure {
        return Err(failure.clone());
    }
    let lines = lines(&measured.rows, errors);
    write_text(&folder.join("budget.csv"), &table(&lines).csv())?;
    let mut page = Page::new("revmap: what a tolerance costs");
    chapters::begin(&mut page, machine, measured);
    page.chapter("Geometric means over the scenes");
    page.table(&means(&lines), &[0]);
    for of in [DrawStage::Fragment, DrawStage::Compute] {
        let times = series(&lines, of, |l| l.exact.map(|r| r.value));
        if times.is_empty() {
            continue;
        }
        page.chapter(&format!("The {} stage", of.name()));
        let limit = Guide {
            name: "the tolerance".into(),
            points: TOLERANCES.map(|t| (t, t)).to_vec(),
            color: color::GREY,
            dash: Dash::Guide,
            width: 2.0,
        };
        let errs = series(&lines, of, |l| l.errors.map(|e| e.p999));
        for (what, label, series, guides, caption) in [
            (
                "time",
                "time / exact",
                times,
                Vec::new(),
                "Time of a frame over that of the exact picture of the same scene.",
            ),
            (
                "error",
                "error, 99.9th percentile (pixels)",
                errs,
                vec![limit],
                "Measured errors: of the depth along the ray over the size of a pixel there, and of contours that have moved.",
            ),
        ] {
            let title = format!("{} by tolerance, {} stage", capital(what), of.name());
            let figure = chart(title, label, series, guides);
            keep_figure(folder, &format!("budget-{what}-{}", of.name()), &figure)?;
            page.figure(&figure, caption);
        }
    }
    page.chapter("Every scene");
    page.text(
        "A pixel's error is that of the depth along its ray, over the size of a pixel at that depth. Where a pixel is on the wrong side of a contour (of a silhouette, or \
         of one solid before another), it is the distance by which the contour has moved. within: whether the 99.9th percentile and the farthest contour are below the tolerance.",
    );
    page.table(&table(&lines), &[0, 1, 2]);
    page.chapter("All rows");
    chapters::row_table(&mut page, &measured.rows, &SeriesStyles::of(&measured.rows));
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

fn capital(word: &str) -> String {
    let (first, rest) = word.split_at(1.min(word.len()));
    first.to_uppercase() + rest
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::report::row::tests::row;

    #[test]
    fn planted_times_and_errors_are_told() {
        let timed = |ms: f64, tolerance: f64| {
            let mut row = row(&[&[(Some(ms), ms)], &[(Some(ms), ms)]]);
            row.settings = MethodSettings {
                tolerance: Tolerance::new(tolerance).unwrap(),
                ..MethodSettings::default()
            };
            row
        };
        let rows = [timed(8.0, 0.0), timed(4.0, 0.25), timed(2.0, 2.0)];
        let error = |row: &Row, p999| {
            let case = Case {
                view: row.view,
                settings: row.settings,
            };
            let errors = PixelErrors {
                pixels: 1000,
                p999,
                ..PixelErrors::default()
            };
            (case, errors)
        };
        let errors = Errors {
            of: vec![error(&rows[1], 0.2), error(&rows[2], 2.5)],
            failure: None,
        };
        let found = table(&lines(&rows, &errors));
        let column = |name| found.column(name).unwrap();
        let at = |row: usize, name| found.records[row][column(name)].as_str();
        assert_eq!(
            [
                at(0, "time_over_exact"),
                at(1, "time_over_exact"),
                at(2, "time_over_exact")
            ],
            ["1", "0.5", "0.25"]
        );
        assert_eq!(
            [at(0, "within"), at(1, "within"), at(2, "within")],
            ["", "yes", "no"]
        );
        let means = means(&lines(&rows, &errors));
        assert_eq!(means.records.len(), 2);
        assert_eq!(means.records[1][2], "2.5");
    }
}
