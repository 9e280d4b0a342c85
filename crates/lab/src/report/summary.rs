//! The chapters that sum a benchmark up: times over those of the RBM baseline and of meshes, of all
//! pictures and of each framing.

use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::dots::{Block, DotChart, Line};
use super::curves::{self, Measure};
use super::folder::keep_figure;
use super::page::Page;
use super::picture_groups::{Part, parts};
use super::ratios::{Ratio, over_rbm_baseline};
use super::row::Row;
use super::series_style::SeriesStyles;
use super::text;
use crate::method::MethodSettings;
use revmap::error::Result;
use revmap::settings::DrawStage;
use std::path::Path;

/// The chapters on ratios.
///
/// # Errors
/// When a chart cannot be written.
pub fn chapters(page: &mut Page, folder: &Path, rows: &[Row], styles: &SeriesStyles) -> Result<()> {
    let parts = parts(rows);
    if !over_rbm_baseline(rows).is_empty() {
        page.chapter("Against the RBM baseline");
        page.text(
            "Each method's time of a frame over that of the RBM baseline in the same stage: geometric means over all pictures. Below 1 the method is faster.",
        );
        for part in &parts {
            let ratios = over_rbm_baseline(&part.rows);
            if ratios.is_empty() {
                continue;
            }
            page.heading(&part.heading());
            let figure = ratio_chart(part.views(), &ratios, styles);
            keep_figure(folder, &format!("ratios{}", part.ending(&parts)), &figure)?;
            page.figure(&figure, "Time of each method over that of the RBM baseline in the same stage, with its 95 % interval; the numbers at the right are the values. Further left is faster.");
            page.table(&text::ratio_table(&ratios, styles.labels()), &[0, 1]);
        }
    }
    mesh_tables(page, &parts);
    Ok(())
}

/// The charts of error against the ratio, of all pictures and of each framing.
///
/// # Errors
/// When a chart cannot be written.
pub fn speed_and_error(page: &mut Page, folder: &Path, rows: &[Row]) -> Result<()> {
    let parts = parts(rows);
    for part in &parts {
        let ratios = over_rbm_baseline(&part.rows);
        if ratios.is_empty() {
            continue;
        }
        let figure = curves::summed(
            part.views(),
            &ratios,
            Measure::Depth,
            &MethodSettings::default(),
        );
        keep_figure(folder, &format!("summary{}", part.ending(&parts)), &figure)?;
        page.figure(
            &figure,
            &format!(
                "{}: time of each method over that of the RBM baseline in the same stage, and its depth error (geometric means over the pictures). Filled markers: fragment \
                 stage; hollow markers: compute stage; bars: 95 % intervals. Lower is more exact, further left is faster. No method is better in both than one on the \
                 dashed line, the Pareto front; upright lines are the floor, a frame without a search.",
                part.heading()
            ),
        );
    }
    Ok(())
}

/// The chart of ratios to the RBM baseline over `views`.
#[must_use]
pub fn ratio_chart(views: &str, ratios: &[Ratio], styles: &SeriesStyles) -> Figure {
    let mut blocks = Vec::new();
    for which in [DrawStage::Fragment, DrawStage::Compute] {
        let lines: Vec<Line> = ratios
            .iter()
            .filter(|r| r.settings.stage == which)
            .map(|r| Line {
                name: styles.way(&r.settings),
                value: r.time,
                style: styles.style(&r.settings),
            })
            .collect();
        if !lines.is_empty() {
            blocks.push(Block {
                name: format!("{} stage", which.name()),
                lines,
            });
        }
    }
    DotChart {
        title: format!("{views}: time of a frame, the RBM baseline in the same stage being 1"),
        axis: Axis::log("time / time of the RBM baseline (left is faster)"),
        mark: Some(1.0),
        blocks,
        legend: Vec::new(),
    }
    .figure()
}

/// The default search against meshes, where both were measured.
pub fn mesh_tables(page: &mut Page, parts: &[Part]) {
    let tables: Vec<_> = parts
        .iter()
        .map(|part| (part, text::against_meshes(&part.rows)))
        .filter(|(_, table)| !table.records.is_empty())
        .collect();
    if tables.is_empty() {
        return;
    }
    page.chapter("Against meshes");
    page.text(
        "The same solid as triangles, rasterised by the same device with the same shading. Times are those of the default search over those of the mesh in the fragment stage, geometric means over \
         all pictures; below 1 the search is faster. Times compare like with like only in pictures in which the mesh is at least as accurate in depth (99th percentile); the last column counts these. \
         \"Coarsest as accurate\" takes, in each picture, the coarsest measured mesh that is at least as accurate, and excludes pictures without one.",
    );
    for (part, table) in tables {
        page.heading(&part.heading());
        page.table(&table, &[0, 1]);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::plan::rbm_baseline;
    use super::super::row::tests::row;
    use super::super::view::Framing;
    use super::super::view::tests::spindle;
    use super::*;
    use crate::method::Method;
    use crate::method::MethodSettings;
    use revmap::settings::Solver;

    /// A view drawn by the RBM baseline and in half its time by the default, as the clocks tell it.
    fn drawn(view: usize, framing: Framing, gpu_over_frame: f64) -> [Row; 2] {
        let timed = |ms: f64, settings| {
            let row = row(&[&[(Some(gpu_over_frame * ms), ms)]]);
            Row {
                view,
                framing,
                settings,
                ..row
            }
        };
        let ours = MethodSettings {
            method: Method::Search(Solver::Exact),
            ..MethodSettings::default()
        };
        [
            timed(5.0, ours),
            timed(10.0, rbm_baseline(&spindle(), &ours)),
        ]
    }

    fn charts(rows: &[Row]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let mut page = Page::new("sums");
        chapters(
            &mut page,
            folder.path(),
            rows,
            &SeriesStyles::new(rows.iter().map(|r| &r.settings)),
        )
        .unwrap();
        speed_and_error(&mut page, folder.path(), rows).unwrap();
        let mut names: Vec<String> = std::fs::read_dir(folder.path().join("charts"))
            .unwrap()
            .map(|file| file.unwrap().file_name().into_string().unwrap())
            .collect();
        names.retain(|name| name.ends_with(".png"));
        names.sort_unstable();
        names
    }

    #[test]
    fn each_framing_has_its_charts() {
        let whole = drawn(0, Framing::Whole, 1.0);
        let close = drawn(1, Framing::Close, 1.0);
        assert_eq!(charts(&whole), ["ratios.png", "summary.png"]);
        assert_eq!(
            charts(&[whole.clone(), close].concat()),
            [
                "ratios-close.png",
                "ratios-whole.png",
                "ratios.png",
                "summary-close.png",
                "summary-whole.png",
                "summary.png"
            ]
        );
        // What no clock tells is in no chart.
        let untold = drawn(1, Framing::Close, 0.5);
        assert_eq!(
            charts(&[whole, untold].concat()),
            [
                "ratios-whole.png",
                "ratios.png",
                "summary-whole.png",
                "summary.png"
            ]
        );
    }
}
