//! The report of a benchmark: tables and charts of rows, as a page.

use super::chapters;
use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::dots::{Block, DotChart, Line};
use super::chart::front::{WORTH, front, stairs};
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::curves::Measure;
use super::folder::{keep_figure, write_text};
use super::machine::Machine;
use super::measure::Measured;
use super::names::safe;
use super::page::Page;
use super::picture_groups::pictures_of;
use super::pictures::Album;
use super::plan::Plan;
use super::row::Row;
use super::series_style::{SeriesStyles, floor_line};
use super::stats::Interval;
use super::summary;
use crate::method::Method;
use revmap::error::Result;
use std::path::Path;

/// The chart of times, a block for each picture and stage.
#[must_use]
pub fn time_chart(rows: &[&Row], styles: &SeriesStyles) -> Figure {
    let mut blocks: Vec<Block> = Vec::new();
    for row in rows {
        let Some(value) = row.time() else { continue };
        let s = &row.settings;
        let name = format!(
            "{}, {}x{}, {} stage",
            row.scene,
            s.width,
            s.height,
            s.stage.name()
        );
        let line = Line {
            name: styles.way(s),
            value,
            style: styles.style(s),
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
pub fn error_chart(title: &str, rows: &[&Row], styles: &SeriesStyles) -> Figure {
    let points: Vec<(&Row, Interval, f64)> = rows
        .iter()
        .filter_map(|r| Some((*r, r.time()?, r.errors.depth?.p99)))
        .collect();
    let (floors, points): (Vec<_>, Vec<_>) = points
        .into_iter()
        .partition(|(row, ..)| row.settings.method == Method::Floor);
    let point = |time: &Interval, y: f64, label: Option<String>| Point {
        x: time.value,
        y,
        spread: time.ends(),
        label,
    };
    let mut series: Vec<Series> = Vec::new();
    let mut meshes: Vec<(&Row, Interval, f64)> = Vec::new();
    for &(row, time, y) in &points {
        let s = &row.settings;
        if s.method.is_mesh() {
            meshes.push((row, time, y));
            continue;
        }
        series.push(Series {
            name: styles.way(s),
            style: styles.style(s),
            points: vec![point(&time, y, None)],
            joined: false,
        });
    }
    // Meshes differ by fineness alone: one line, each marker with its segments and rings.
    meshes.sort_by_key(|(row, ..)| row.settings.method.quads());
    if let Some((coarsest, ..)) = meshes.first() {
        let fineness = |row: &Row| {
            let way = styles.way(&row.settings);
            way.strip_prefix("mesh:").map(str::to_owned)
        };
        series.push(Series {
            name: "mesh, segments x rings".into(),
            style: styles.style(&coarsest.settings),
            points: meshes
                .iter()
                .map(|(row, time, y)| point(time, *y, fineness(row)))
                .collect(),
            joined: true,
        });
    }
    let places: Vec<(f64, f64)> = points.iter().map(|(_, time, y)| (time.value, *y)).collect();
    let best: Vec<_> = front(&places, WORTH)
        .into_iter()
        .map(|i| places[i])
        .collect();
    XyChart {
        title: title.to_owned(),
        x: floors
            .iter()
            .fold(Axis::log("time of a frame (ms)"), |axis, (_, time, _)| {
                axis.with(time.value)
            }),
        y: Measure::Depth.axis(),
        series,
        guides: std::iter::once(Guide::dashed("Pareto front", stairs(&best)))
            .chain(
                floors
                    .iter()
                    .map(|(row, time, _)| floor_line(&row.settings, time.value)),
            )
            .collect(),
    }
    .figure()
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
    let styles = SeriesStyles::of(rows);
    let mut page = Page::new("revmap: frame rates, look-ups and errors");
    chapters::begin(&mut page, machine, measured);

    summary::chapters(&mut page, folder, rows, &styles)?;

    page.chapter("Speed and error");
    let all: Vec<&Row> = rows.iter().collect();
    summary::speed_and_error(&mut page, folder, rows)?;
    for group in pictures_of(&all) {
        let Some(first) = group.first() else { continue };
        let size = format!("{}x{}", first.settings.width, first.settings.height);
        let figure = error_chart(
            &format!("{}, {size}: depth error against time", first.scene),
            &group,
            &styles,
        );
        keep_figure(
            folder,
            &format!("error-{}-{size}", safe(&first.scene)),
            &figure,
        )?;
        page.figure(
            &figure,
            "Each marker is a search, filled in the fragment stage and hollow in the compute stage, or a mesh; lower is more exact, further left is faster, and bars are 95 % intervals of \
             times. No method is better in both than one on the dashed line, the Pareto front; upright lines are the floor, a frame without a search. Depth errors are the 99th percentile over the pixels hit, in h/512, 1/512 of the solid's height.",
        );
    }
    page.chapter("Times");
    for chunk in pages(&pictures_of(&all)) {
        let Some(first) = chunk.first() else { continue };
        let figure = time_chart(&chunk, &styles);
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
    chapters::picture_table(&mut page, rows);
    page.chapter("All rows");
    chapters::row_table(&mut page, rows, &styles);
    chapters::pictures(&mut page, plan, album);
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

#[cfg(test)]
mod tests {
    use super::super::chart::svg::svg;
    use super::super::plan::{ALL_MESHES, rbm_baseline};
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;
    use crate::compare::Spread;
    use crate::method::{Method, MethodSettings};
    use revmap::settings::DrawStage;
    use revmap_searches::CIRCLE;

    /// As much as one picture can hold: every search in both stages, five meshes, the RBM baseline.
    fn crowded() -> Vec<Row> {
        let mut rows = Vec::new();
        let meshes = ALL_MESHES.map(|(segments, rings)| Method::Mesh { segments, rings });
        for (k, method) in Method::ALL.into_iter().chain(meshes).enumerate() {
            for stage in [DrawStage::Fragment, DrawStage::Compute] {
                let ms = 5.0 * 1.2f64.powi(k as i32) + f64::from(stage == DrawStage::Compute);
                let mut one = row(&[&[(None, ms)], &[(None, 1.02 * ms)]]);
                one.settings = MethodSettings {
                    method,
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
                if method == CIRCLE {
                    one.settings = rbm_baseline(&spindle(), &one.settings);
                    rows.push(one);
                }
            }
        }
        rows.retain(|r| !r.settings.method.is_mesh() || r.settings.stage == DrawStage::Fragment);
        rows
    }

    #[test]
    fn no_words_cover_each_other_in_the_fullest_charts() {
        let rows = crowded();
        let ways: Vec<MethodSettings> = rows.iter().map(|r| r.settings).collect();
        let styles = SeriesStyles::new(&ways);
        let all: Vec<&Row> = rows.iter().collect();
        for figure in [
            error_chart("king@25:close, 1366x706", &all, &styles),
            time_chart(&all, &styles),
        ] {
            assert_eq!(figure.faults(), Vec::<String>::new(), "{}", figure.title);
        }
        // Meshes are one line with a word at each, not an entry each in the legend.
        let said = svg(&error_chart("t", &all, &styles));
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
