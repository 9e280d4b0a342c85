//! The chapters that sum a benchmark up: times over those of the papers' loop and of meshes, of all pictures and of each framing.

use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::dots::{Block, DotChart, Line};
use super::covered::{Part, parts};
use super::curves::{self, Measure};
use super::folder::keep_figure;
use super::looks::Looks;
use super::names::{number, stage};
use super::page::Page;
use super::ratios::{Ratio, over_papers_loop};
use super::row::Row;
use super::text::{self, percent};
use crate::method::MethodSettings;
use revmap::error::Result;
use revmap::settings::DrawStage;
use std::path::Path;

/// The chapters on ratios.
///
/// # Errors
/// When a chart cannot be written.
pub fn chapters(page: &mut Page, folder: &Path, rows: &[Row], looks: &Looks) -> Result<()> {
    let parts = parts(rows);
    if !over_papers_loop(rows).is_empty() {
        page.chapter("Against the papers' loop");
        page.text(
            "Times over that of the papers' loop in the same stage. Ratios are geometric means \
             over all pictures, below 1 is faster; single pictures: the least and the greatest ratio of one of them. Wrong pixels are those of all pictures together; depth p99 is the geometric mean over the pictures of each one's 99th percentile, with that of the worst beside it; errors of normals are the root mean square of the \
             worst picture.",
        );
        for part in &parts {
            let ratios = over_papers_loop(&part.rows);
            if ratios.is_empty() {
                continue;
            }
            page.heading(&part.heading());
            let figure = ratio_chart(part.views(), &ratios, looks);
            keep_figure(folder, &format!("ratios{}", part.ending(&parts)), &figure)?;
            page.figure(&figure, "Each marker is a search's time over that of the papers' loop in the same stage, with its 95 % interval, and its number at the right; further left is faster.");
            ratio_table(page, &ratios, looks);
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
        let ratios = over_papers_loop(&part.rows);
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
                "{}: the time of each search over that of the papers' loop in the same stage, and its depth error (the geometric mean over the pictures). Filled in the fragment stage, hollow in the \
                 compute stage; lower is more exact, further left is faster, and what lies on the dashed line is beaten by nothing in both.",
                part.heading()
            ),
        );
    }
    Ok(())
}

/// The chart of ratios to the papers' loop over `views`.
#[must_use]
pub fn ratio_chart(views: &str, ratios: &[Ratio], looks: &Looks) -> Figure {
    let mut blocks = Vec::new();
    for which in [DrawStage::Fragment, DrawStage::Compute] {
        let lines: Vec<Line> = ratios
            .iter()
            .filter(|r| r.settings.stage == which)
            .map(|r| Line {
                name: looks.way(&r.settings),
                value: r.time,
                style: looks.style(&r.settings),
            })
            .collect();
        if !lines.is_empty() {
            blocks.push(Block {
                name: format!("{} stage", stage(which)),
                lines,
            });
        }
    }
    DotChart {
        title: format!("{views}: time of a frame, the papers' loop in the same stage being 1"),
        axis: Axis::log("time / time of the papers' loop (left is faster)"),
        mark: Some(1.0),
        blocks,
        legend: Vec::new(),
    }
    .figure()
}

/// The table of ratios.
pub fn ratio_table(page: &mut Page, ratios: &[Ratio], looks: &Looks) {
    let records: Vec<Vec<String>> = ratios
        .iter()
        .map(|r| {
            vec![
                looks.way(&r.settings),
                stage(r.settings.stage).into(),
                number(r.time.value, 3),
                text::ends(&r.time),
                format!("{} to {}", number(r.range.0, 3), number(r.range.1, 3)),
                r.pictures.to_string(),
                percent(r.wrong),
                r.depth_p99.map(|v| number(v, 3)).unwrap_or_default(),
                r.depth_worst.map(|v| number(v, 3)).unwrap_or_default(),
                r.normal_rms.map(|v| number(v, 3)).unwrap_or_default(),
            ]
        })
        .collect();
    page.table(
        &[
            "search",
            "stage",
            "time / papers' loop",
            "95 % interval",
            "single pictures",
            "pictures",
            "wrong pixels",
            "depth p99 (texels)",
            "worst (texels)",
            "normals (degrees)",
        ],
        &records,
        &[0, 1],
    );
}

/// The default search against meshes, where both were measured.
pub fn mesh_tables(page: &mut Page, parts: &[Part]) {
    let tables: Vec<_> = parts
        .iter()
        .map(|part| (part, text::against_meshes(&part.rows)))
        .filter(|(_, records)| !records.is_empty())
        .collect();
    if tables.is_empty() {
        return;
    }
    page.chapter("Against meshes");
    page.text(
        "The same solid as triangles, rasterised by the same device with the same shading. Times are those of the default search over those of the mesh in the fragment \
         stage, geometric means over all pictures; below 1 the search is faster. A ratio is one of equals in the pictures in which the mesh's depth error \
         (99th percentile) is no worse; the last column counts them. Depths (99th percentile) are geometric means over the pictures, of the search and of the mesh. \"Coarsest no worse\" takes in each picture the coarsest of the meshes measured for which that holds, and leaves out \
         pictures without one.",
    );
    for (part, records) in tables {
        page.heading(&part.heading());
        page.table(&text::AGAINST_MESHES, &records, &[0, 1]);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::framing::Framing;
    use super::super::plan::papers_loop;
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;
    use crate::method::Method;
    use crate::method::MethodSettings;
    use revmap::settings::Solver;

    /// A view drawn by the papers' loop and in half its time by the default, as the clocks tell it.
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
            method: Method::Search(Solver::Hull),
            ..MethodSettings::default()
        };
        [
            timed(5.0, ours),
            timed(10.0, papers_loop(&spindle(), &ours)),
        ]
    }

    fn charts(rows: &[Row]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let mut page = Page::new("sums");
        chapters(
            &mut page,
            folder.path(),
            rows,
            &Looks::new(rows.iter().map(|r| &r.settings)),
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
