//! The report of a benchmark: tables and charts of rows, as a page.

use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::dots::{Block, DotChart, Line};
use super::chart::front::{WORTH, front};
use super::chart::raster::raster;
use super::chart::style::{Dash, PALE};
use super::chart::svg::svg;
use super::chart::xy::{Guide, Point, Series, XyChart, stairs};
use super::covered;
use super::folder::{left_out, make, write_bytes, write_text};
use super::looks::Looks;
use super::machine::Machine;
use super::measure::Measured;
use super::names::{number, stage};
use super::page::Page;
use super::pictures::{Album, heat_key, png};
use super::plan::{Plan, variant};
use super::row::{CLOCKS_APART, Row};
use super::summary;
use super::text::interval;
use crate::error::Result;
use crate::settings::Settings;
use std::path::Path;

/// Errors below this many texels are drawn as this many: no eye and no other use tells them apart.
pub const LEAST_DEPTH: f64 = 1e-4;

/// Writes a figure as SVG and as PNG of twice its size into `folder/charts`.
///
/// # Errors
/// When a file cannot be written.
pub fn keep_figure(folder: &Path, name: &str, figure: &Figure) -> Result<()> {
    let charts = folder.join("charts");
    make(&charts)?;
    write_text(&charts.join(format!("{name}.svg")), &svg(figure))?;
    write_bytes(
        &charts.join(format!("{name}.png")),
        &png(&raster(figure, 2.0)?)?,
    )
}

/// The chart of times, a block for each picture.
#[must_use]
pub fn time_chart(rows: &[&Row], looks: &Looks) -> Figure {
    let mut blocks: Vec<Block> = Vec::new();
    for row in rows {
        let Some(value) = row.time() else { continue };
        let name = format!(
            "{}, {}x{}",
            row.scene, row.settings.width, row.settings.height
        );
        let line = Line {
            name: looks.name(&row.settings),
            value,
            style: looks.style(&row.settings),
        };
        match blocks.iter_mut().find(|b| b.name == name) {
            Some(block) => block.lines.push(line),
            None => blocks.push(Block {
                name,
                lines: vec![line],
            }),
        }
    }
    DotChart {
        title: "Time of a frame".into(),
        axis: Axis::log("time of a frame (ms)"),
        mark: None,
        blocks,
        legend: Vec::new(),
    }
    .figure()
}

/// The chart of depth error against time of rows that show one picture, with its Pareto front.
#[must_use]
pub fn error_chart(title: &str, rows: &[&Row], looks: &Looks) -> Figure {
    let points: Vec<(&Row, f64, f64)> = rows
        .iter()
        .filter_map(|r| Some((*r, r.time()?.value, r.errors.depth?.p99)))
        .collect();
    let series = points
        .iter()
        .map(|(row, x, y)| Series {
            name: looks.name(&row.settings),
            style: looks.style(&row.settings),
            points: vec![Point {
                x: *x,
                y: *y,
                label: None,
            }],
            joined: false,
        })
        .collect();
    let places: Vec<(f64, f64)> = points.iter().map(|(_, x, y)| (*x, *y)).collect();
    let best: Vec<_> = front(&places, WORTH)
        .into_iter()
        .map(|i| places[i])
        .collect();
    XyChart {
        title: title.to_owned(),
        x: Axis::log("time of a frame (ms)"),
        y: Axis::log("depth error, p99 (texels of 512 rows)").from(LEAST_DEPTH),
        series,
        guides: vec![Guide {
            name: "Pareto front".into(),
            points: stairs(&best),
            color: PALE,
            dash: Dash::Guide,
            width: 1.8,
        }],
    }
    .figure()
}

/// The beginning of every page: where and how this was measured.
pub fn begin(page: &mut Page, machine: &Machine, measured: &Measured) {
    let facts: Vec<(&str, String)> = machine
        .lines()
        .into_iter()
        .filter(|(what, _)| *what != "command")
        .collect();
    page.facts(&facts);
    page.command("Made again by", &machine.command);
    if measured.interrupted {
        page.note("The run was ended early: what is missing below was not measured.");
    }
}

/// What was left out and how times were taken: the end of every page.
pub fn end(page: &mut Page, plan: &Plan, measured: &Measured) {
    let out = left_out(plan, measured);
    page.chapter("Left out");
    if out.records.is_empty() {
        page.text("Nothing: every measurement could be made, and in every row the device's clock and the wall clock agree.");
    } else {
        page.text("These rows are in no summary, ratio or front. A row number points into results.csv; without one nothing was drawn.");
        page.table(
            &["row", "scene", "stage", "search", "reason"],
            &out.records,
            &[1, 2, 3, 4],
        );
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
         which the two are more than {:.0} % apart are marked and left out of every summary. Ratios pair frames of the same round. Frames that are timed hold colour \
         alone; errors and look-ups come from one more frame of the same search with all planes.",
        100.0 * CLOCKS_APART
    ));
    page.text(
        "The truth is the double-precision reference on the CPU, which shares no code with the shaders. Wrong pixels are missed (the reference hits, the frame does not) and \
         ghosts (the reverse), over the pixels that the reference hits. Depth errors are along the ray, in texels of a map of 512 rows whatever map was used, \
         so that all rows compare; look-ups are counted over the pixels in which there was at least one.",
    );
}

/// The table of pictures, with the share of each that is solid.
pub fn picture_table(page: &mut Page, rows: &[Row]) {
    page.chapter("What was drawn");
    page.text(
        "Each picture, with the share of its pixels in which the reference hits a solid. Where that is small, what a frame costs anyhow (clearing, storing, ending it) \
         weighs much in its time, and searches look more alike than they are.",
    );
    page.table(&covered::PICTURES, &covered::pictures(rows), &[0, 1, 4]);
}

/// The table of all rows.
pub fn row_table(page: &mut Page, rows: &[Row], looks: &Looks) {
    let records: Vec<Vec<String>> = rows
        .iter()
        .map(|r| {
            let e = &r.errors;
            let num = |v: Option<f64>| v.map(|v| number(v, 3)).unwrap_or_else(|| "–".into());
            let time = r.time();
            let steps = Some(r.steps).filter(|_| !r.settings.solver.is_mesh());
            vec![
                r.scene.clone(),
                looks.way(&r.settings),
                stage(r.settings.stage).into(),
                format!("{}x{}", r.settings.width, r.settings.height),
                time.map(|t| interval(&t, 3))
                    .unwrap_or_else(|| "clocks disagree".into()),
                num(time.map(|t| 1e3 / t.value)),
                num(steps.map(|s| s.mean)),
                num(steps.map(|s| s.p99)),
                num(steps.map(|s| s.max)),
                if r.settings.solver.may_run_out() {
                    r.steps.exhausted.to_string()
                } else {
                    "–".into()
                },
                e.missed.to_string(),
                e.ghost.to_string(),
                num(e.depth.map(|d| d.rms)),
                num(e.depth.map(|d| d.p99)),
                num(e.depth.map(|d| d.max)),
                num(e.normal.map(|n| n.rms)),
                num(Some(e.silhouette_hausdorff)),
                num(Some(e.flip)),
                format!("{} kB", number(r.map_bytes as f64 / 1e3, 3)),
            ]
        })
        .collect();
    page.table(
        &[
            "scene",
            "search",
            "stage",
            "size",
            "ms (95 % interval)",
            "frames / s",
            "steps mean",
            "p99",
            "max",
            "out of steps",
            "missed",
            "ghost",
            "depth rms (texels)",
            "p99",
            "max",
            "normal rms (°)",
            "silhouette (px)",
            "FLIP",
            "maps, mesh",
        ],
        &records,
        &[0, 1, 2],
    );
}

/// The pictures' chapter.
pub fn pictures(page: &mut Page, plan: &Plan, album: &Album) {
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

/// Writes the page `report.html` and the charts of a benchmark into its folder.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    machine: &Machine,
    album: &Album,
) -> Result<()> {
    let rows = &measured.rows;
    let ways: Vec<Settings> = rows.iter().map(|r| variant(&r.settings)).collect();
    let looks = Looks::new(&ways);
    let mut page = Page::new("revmap: frame rates, look-ups and errors");
    begin(&mut page, machine, measured);

    summary::chapters(&mut page, folder, rows, &looks)?;

    page.chapter("Speed and error");
    let all: Vec<&Row> = rows.iter().collect();
    summary::speed_and_error(&mut page, folder, rows)?;
    for group in pictures_of(&all) {
        let Some(first) = group.first() else { continue };
        let size = format!("{}x{}", first.settings.width, first.settings.height);
        let figure = error_chart(
            &format!("{}, {size}: depth error against time", first.scene),
            &group,
            &looks,
        );
        keep_figure(
            folder,
            &format!("error-{}-{size}", safe(&first.scene)),
            &figure,
        )?;
        page.figure(
            &figure,
            "Each marker is a search, filled in the fragment stage and hollow in the compute stage; lower is more exact, further left is faster, and what lies on the dashed \
             line is beaten by nothing in both. Depth errors are the 99th percentile over the pixels hit, in texels of a map of 512 rows.",
        );
    }
    page.chapter("Times");
    for chunk in pictures_of(&all).chunks(6) {
        let chunk: Vec<&Row> = chunk.concat();
        let Some(first) = chunk.first() else { continue };
        let figure = time_chart(&chunk, &looks);
        keep_figure(
            folder,
            &format!(
                "times-{}-{}x{}",
                safe(&first.scene),
                first.settings.width,
                first.settings.height
            ),
            &figure,
        )?;
        page.figure(&figure, "Each marker is the time of a frame with its 95 % interval, by the device's clock where it has one; further left is faster.");
    }
    picture_table(&mut page, rows);
    page.chapter("All rows");
    row_table(&mut page, rows, &looks);
    pictures(&mut page, plan, album);
    end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

/// Rows put together by the picture they show.
#[must_use]
pub fn pictures_of<'a>(rows: &[&'a Row]) -> Vec<Vec<&'a Row>> {
    let mut groups: Vec<Vec<&Row>> = Vec::new();
    for row in rows {
        let key = |r: &Row| (r.view, r.settings.width, r.settings.height);
        match groups
            .iter_mut()
            .find(|g| g.first().is_some_and(|f| key(f) == key(row)))
        {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups
}

/// A name that may be part of a file's name.
#[must_use]
pub fn safe(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_@.".contains(c) {
                c
            } else {
                '-'
            }
        })
        .collect()
}
