//! The chapters that pages of every kind share: where and how it was measured, what was drawn, all
//! rows, and what was left out.

use super::folder::excluded;
use super::glossary;
use super::machine::Machine;
use super::measure::Measured;
use super::names::number;
use super::page::Page;
use super::picture_groups;
use super::pictures::{Album, heat_key};
use super::plan::Plan;
use super::ratios::above_floor;
use super::row::{CLOCKS_APART, Row};
use super::series_style::SeriesStyles;
use super::table::Table;
use super::text;

/// The beginning of every page: where and how this was measured.
pub(super) fn begin(page: &mut Page, machine: &Machine, measured: &Measured) {
    let facts: Vec<(&str, String)> = machine
        .lines()
        .into_iter()
        .filter(|(what, _)| *what != "command")
        .collect();
    page.facts(&facts);
    page.command("Reproduced by", &machine.command);
    if measured.interrupted {
        page.note("The run was interrupted: what is missing below was not measured.");
    }
    glossary::chapter(page, measured);
}

/// Which rows are excluded, how times were taken, and what every column means: the end of every
/// page.
pub(super) fn end(page: &mut Page, plan: &Plan, measured: &Measured) {
    let out = excluded(plan, measured);
    page.chapter("Excluded rows");
    if out.records.is_empty() {
        page.text("None: every measurement could be made, and in every row the device's clock and the wall clock agree.");
    } else {
        page.text("These rows are in no summary, ratio or Pareto front. Row numbers count the records of results.csv; rows without a number could not be drawn.");
        page.table(&Table::new(EXCLUDED, out.records), &[1, 2, 3, 4]);
    }
    page.chapter("How this was measured");
    let passes = measured
        .rows
        .iter()
        .map(|r| r.passes.len())
        .max()
        .unwrap_or(0);
    let samples = measured.rows.iter().map(|r| r.frame_ms().len());
    let (least, most) = (
        samples.clone().min().unwrap_or(0),
        samples.max().unwrap_or(0),
    );
    page.text(&format!(
        "All ways of drawing one picture are drawn in turn, one frame each and there and back, so that a machine that slows down slows all of them; drivers' compilers \
         run before the first frame that counts. This is repeated in {passes} passes over all pictures, each with maps, buffers and pipelines made anew; {least} to {most} \
         frames of each row were timed in {} s. A time is the geometric mean of the passes' medians, its interval Student's over the passes, with 95 % confidence: it covers how this \
         run would have come out again on this machine, not how another machine would.",
        number(measured.took.as_secs_f64(), 3)
    ));
    page.text(&format!(
        "The device's timestamps stand around the work of one frame in one stage alone; the wall clock counts from submission to completion, without reading back. Rows in \
         which the two are more than {:.0} % apart are marked and excluded from every summary. Ratios pair frames of the same round. Frames that are timed hold colour \
         alone; errors and look-ups come from one more frame of the same search with all planes.",
        100.0 * CLOCKS_APART
    ));
    page.text(
        "Errors are against the double-precision reference on the CPU, which shares no code with the shaders.",
    );
    glossary::columns(page);
}

/// The table of pictures, with the share of each that is solid.
pub(super) fn picture_table(page: &mut Page, rows: &[Row]) {
    page.chapter("What was drawn");
    page.text(
        "In pictures with few hit pixels, fixed costs of a frame (clear, store, end of frame) dominate, and methods look more alike than they are.",
    );
    page.table(&picture_groups::pictures(rows), &[0, 1, 5]);
}

/// All rows: a table of times and look-ups, and one of errors. One of both would be too wide for
/// paper.
pub(super) fn row_table(page: &mut Page, rows: &[Row], styles: &SeriesStyles) {
    let num = |v: Option<f64>| v.map(|v| number(v, 3)).unwrap_or_else(|| "–".into());
    let named = |r: &Row| {
        let s = &r.settings;
        vec![
            r.scene.clone(),
            styles.way(s),
            s.stage.name().to_owned(),
            format!("{}x{}", s.width, s.height),
        ]
    };
    let times = |r: &Row| {
        let time = r.time();
        let steps = Some(r.steps).filter(|_| !r.settings.method.is_mesh());
        let mut record = named(r);
        record.extend([
            time.map_or("clocks disagree".into(), |t| number(t.value, 3)),
            time.map(|t| text::ends(&t)).unwrap_or_default(),
            num(above_floor(rows, r)),
            num(time.map(|t| 1e3 / t.value)),
            num(steps.map(|s| s.mean)),
            num(steps.map(|s| s.p99)),
            num(steps.map(|s| s.max)),
            if r.settings.method.may_run_out() {
                r.steps.exhausted.to_string()
            } else {
                "–".into()
            },
            number(r.map_bytes as f64 / 1e3, 3),
        ]);
        record
    };
    let errors = |r: &Row| {
        let e = &r.errors;
        let mut record = named(r);
        record.extend([
            e.missed.to_string(),
            e.ghost.to_string(),
            num(e.depth.map(|d| d.rms)),
            num(e.depth.map(|d| d.p99)),
            num(e.depth.map(|d| d.max)),
            num(e.normal.map(|n| n.rms)),
            num(Some(e.silhouette_hausdorff)),
            num(e.flip),
        ]);
        record
    };
    let all = |of: &dyn Fn(&Row) -> Vec<String>| rows.iter().map(of).collect::<Vec<_>>();
    page.heading("Times and look-ups");
    page.table(&Table::new(TIMES, all(&times)), &[0, 1, 2]);
    page.heading("Errors");
    page.table(&Table::new(ERRORS, all(&errors)), &[0, 1, 2]);
}

/// Columns of the table of excluded rows.
pub(super) const EXCLUDED: [&str; 5] = ["row", "scene", "stage", "method", "reason"];

/// Columns of the table of times.
pub(super) const TIMES: [&str; 13] = [
    "scene",
    "method",
    "stage",
    "size",
    "time (ms)",
    "95 % interval",
    "above the floor (ms)",
    "frames / s",
    "look-ups mean",
    "look-ups p99",
    "look-ups max",
    "out of steps",
    "memory (kB)",
];

/// Columns of the table of errors.
pub(super) const ERRORS: [&str; 12] = [
    "scene",
    "method",
    "stage",
    "size",
    "missed",
    "ghosts",
    "depth rms (h/512)",
    "depth p99 (h/512)",
    "depth max (h/512)",
    "normal rms (°)",
    "silhouette (px)",
    "FLIP",
];

/// The pictures' chapter.
pub(super) fn pictures(page: &mut Page, plan: &Plan, album: &Album) {
    if album.shots.is_empty() {
        return;
    }
    page.chapter("Pictures");
    page.text(&heat_key());
    for (index, view) in plan.views.iter().enumerate() {
        let shots: Vec<_> = album.shots.iter().filter(|s| s.view == index).collect();
        if shots.is_empty() {
            continue;
        }
        page.heading(&view.name);
        // The picture by itself, then pairs of heat maps in even columns.
        let (first, rest) = shots.split_at(1);
        page.shots(first);
        if !rest.is_empty() {
            page.shots(rest);
        }
    }
}
