//! The report of a benchmark: tables and charts of rows, as a page.

use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::dots::{Block, DotChart, Line};
use super::chart::front::{WORTH, front, stairs};
use super::chart::raster::raster;
use super::chart::svg::svg;
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::covered;
use super::folder::{left_out, make, write_bytes, write_text};
use super::glossary;
use super::looks::{Looks, of_line};
use super::machine::Machine;
use super::measure::Measured;
use super::names::{number, stage};
use super::page::Page;
use super::pictures::{Album, heat_key, png};
use super::plan::{Plan, variant};
use super::row::{CLOCKS_APART, Row};
use super::summary;
use super::text;
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

/// The chart of times, a block for each picture and stage.
#[must_use]
pub fn time_chart(rows: &[&Row], looks: &Looks) -> Figure {
    let mut blocks: Vec<Block> = Vec::new();
    for row in rows {
        let Some(value) = row.time() else { continue };
        let s = &row.settings;
        let name = format!(
            "{}, {}x{}, {} stage",
            row.scene,
            s.width,
            s.height,
            stage(s.stage)
        );
        let line = Line {
            name: looks.way(s),
            value,
            style: looks.style(s),
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

/// Pictures put together so that a chart of their times is no longer than a page.
fn pages<'a>(pictures: &[Vec<&'a Row>]) -> Vec<Vec<&'a Row>> {
    const LINES: usize = 44;
    let mut pages: Vec<Vec<&Row>> = Vec::new();
    for picture in pictures {
        match pages.last_mut() {
            Some(page) if page.len() + picture.len() <= LINES => page.extend(picture),
            _ => pages.push(picture.clone()),
        }
    }
    pages
}

/// The chart of depth error against time of rows that show one picture, with its Pareto front.
#[must_use]
pub fn error_chart(title: &str, rows: &[&Row], looks: &Looks) -> Figure {
    let points: Vec<(&Row, f64, f64)> = rows
        .iter()
        .filter_map(|r| Some((*r, r.time()?.value, r.errors.depth?.p99)))
        .collect();
    let mut series: Vec<Series> = Vec::new();
    let mut meshes: Vec<(&Row, f64, f64)> = Vec::new();
    for &(row, x, y) in &points {
        let s = &row.settings;
        if s.solver.is_mesh() {
            meshes.push((row, x, y));
            continue;
        }
        series.push(Series {
            name: looks.way(s),
            style: looks.style(s),
            points: vec![Point { x, y, label: None }],
            joined: false,
        });
    }
    // Meshes differ by fineness alone: one line, each marker with its segments and rings.
    meshes.sort_by_key(|(row, ..)| row.settings.solver.quads());
    if let Some((coarsest, ..)) = meshes.first() {
        let point = |&(row, x, y): &(&Row, f64, f64)| Point {
            x,
            y,
            label: looks
                .way(&row.settings)
                .strip_prefix("mesh:")
                .map(str::to_owned),
        };
        series.push(Series {
            name: "mesh, segments x rings".into(),
            style: of_line(&coarsest.settings),
            points: meshes.iter().map(point).collect(),
            joined: true,
        });
    }
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
        guides: vec![Guide::dashed("Pareto front", stairs(&best))],
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
    glossary::chapter(page, measured);
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
    page.table(&covered::PICTURES, &covered::pictures(rows), &[0, 1, 5]);
}

/// All rows: a table of times and look-ups, and one of errors. One of both would be too wide for paper.
pub fn row_table(page: &mut Page, rows: &[Row], looks: &Looks) {
    let num = |v: Option<f64>| v.map(|v| number(v, 3)).unwrap_or_else(|| "–".into());
    let named = |r: &Row| {
        let s = &r.settings;
        vec![
            r.scene.clone(),
            looks.way(s),
            stage(s.stage).to_owned(),
            format!("{}x{}", s.width, s.height),
        ]
    };
    let times = |r: &Row| {
        let time = r.time();
        let steps = Some(r.steps).filter(|_| !r.settings.solver.is_mesh());
        let mut record = named(r);
        record.extend([
            time.map_or("clocks disagree".into(), |t| number(t.value, 3)),
            time.map(|t| text::ends(&t)).unwrap_or_default(),
            num(time.map(|t| 1e3 / t.value)),
            num(steps.map(|s| s.mean)),
            num(steps.map(|s| s.p99)),
            num(steps.map(|s| s.max)),
            if r.settings.solver.may_run_out() {
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
            num(Some(e.flip)),
        ]);
        record
    };
    let all = |of: &dyn Fn(&Row) -> Vec<String>| rows.iter().map(of).collect::<Vec<_>>();
    page.heading("Times and look-ups");
    page.text(
        "Milliseconds of a frame with their 95 % interval; look-ups a pixel, over the pixels in which there were any (mean, 99th percentile, most), and the pixels in which a \
         search ran out of steps; kilobytes of maps and tables, or of the mesh, on the device.",
    );
    page.table(&TIMES, &all(&times), &[0, 1, 2]);
    page.heading("Errors");
    page.text(
        "Pixels missed and ghosts; errors of depth in texels of a map of 512 rows; of normals in degrees; the Hausdorff distance of the silhouettes in pixels; FLIP, 0 (equal) to 1, \
         its mean over the picture.",
    );
    page.table(&ERRORS, &all(&errors), &[0, 1, 2]);
}

const TIMES: [&str; 12] = [
    "scene",
    "search",
    "stage",
    "size",
    "ms",
    "95 % interval",
    "frames / s",
    "look-ups, mean",
    "p99",
    "most",
    "out of steps",
    "maps, mesh (kB)",
];

const ERRORS: [&str; 12] = [
    "scene",
    "search",
    "stage",
    "size",
    "missed",
    "ghosts",
    "depth rms (texels)",
    "p99",
    "most",
    "normals rms (°)",
    "silhouette (px)",
    "FLIP",
];

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
            "Each marker is a search, filled in the fragment stage and hollow in the compute stage, or a mesh; lower is more exact, further left is faster, and what lies on the dashed \
             line is beaten by nothing in both. Depth errors are the 99th percentile over the pixels hit, in texels of a map of 512 rows.",
        );
    }
    page.chapter("Times");
    for chunk in pages(&pictures_of(&all)) {
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
        page.figure(&figure, "Each marker is the time of a frame with its 95 % interval, by the device's clock where it has one, and its number in ms at the right; further left is faster.");
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

#[cfg(test)]
mod tests {
    use super::super::plan::{ALL_MESHES, papers_loop};
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;
    use crate::frame::Spread;
    use crate::settings::{DrawStage, Solver};

    /// As much as one picture can hold: every search in both stages, five meshes, the papers' loop.
    fn crowded() -> Vec<Row> {
        let mut rows = Vec::new();
        let meshes = ALL_MESHES.map(|(segments, rings)| Solver::Mesh { segments, rings });
        for (k, solver) in Solver::ALL.into_iter().chain(meshes).enumerate() {
            for stage in [DrawStage::Fragment, DrawStage::Compute] {
                let ms = 5.0 * 1.2f64.powi(k as i32) + f64::from(stage == DrawStage::Compute);
                let mut one = row(&[&[(None, ms)], &[(None, 1.02 * ms)]]);
                one.settings = Settings {
                    solver,
                    stage,
                    ..one.settings
                };
                let p99 = 4.0 * 0.5f64.powi(k as i32);
                one.errors.depth = Some(Spread {
                    rms: p99,
                    p99,
                    max: p99,
                });
                rows.push(one.clone());
                if solver == Solver::Circle {
                    one.settings = papers_loop(&spindle(), &one.settings);
                    rows.push(one);
                }
            }
        }
        rows.retain(|r| !r.settings.solver.is_mesh() || r.settings.stage == DrawStage::Fragment);
        rows
    }

    #[test]
    fn no_words_cover_each_other_in_the_fullest_charts() {
        let rows = crowded();
        let ways: Vec<Settings> = rows.iter().map(|r| r.settings).collect();
        let looks = Looks::new(&ways);
        let all: Vec<&Row> = rows.iter().collect();
        for figure in [
            error_chart("king@25:close, 1366x706", &all, &looks),
            time_chart(&all, &looks),
        ] {
            assert_eq!(figure.faults(), Vec::<String>::new(), "{}", figure.title);
        }
        // Meshes are one line with a word at each, not an entry each in the legend.
        let said = svg(&error_chart("t", &all, &looks));
        assert_eq!(said.matches(">mesh").count(), 1);
        assert!(said.contains(">512x1024<") || said.contains(">128x256<"));
    }

    #[test]
    fn a_page_of_times_is_no_longer_than_paper() {
        let rows = crowded();
        let picture: Vec<&Row> = rows.iter().take(15).collect();
        let pages = pages(&vec![picture; 5]);
        let lengths: Vec<usize> = pages.iter().map(Vec::len).collect();
        assert_eq!(lengths, [30, 30, 15]);
    }
}
