//! The pages of a chart run: one for each view, and one that sums up.

use super::{Measure, maps, most_exact, resolution, searches, summed};
use crate::method::{Method, MethodSettings};
use crate::report::chapters;
use crate::report::chart::front::{WORTH, front};
use crate::report::folder::{keep_figure, write_text};
use crate::report::machine::Machine;
use crate::report::map_error::MapError;
use crate::report::measure::Measured;
use crate::report::names::{number, percent, safe};
use crate::report::page::Page;
use crate::report::picture_groups::{parts, pictures_of};
use crate::report::pictures::Album;
use crate::report::plan::{Labels, Plan, variant};
use crate::report::ratios::over_rbm_baseline;
use crate::report::row::Row;
use crate::report::series_style::SeriesStyles;
use crate::report::table::Table;
use revmap::error::Result;
use std::path::Path;

/// Writes the pages of a chart run: `report.html` that sums up, and one page for each view.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    machine: &Machine,
    album: &Album,
    alone: &[MapError],
) -> Result<()> {
    let base = MethodSettings::default();
    let all: Vec<&Row> = measured.rows.iter().collect();
    let mut pages = Vec::new();
    for group in pictures_of(&all) {
        let Some(first) = group.first() else { continue };
        let size = format!("{}x{}", first.settings.width, first.settings.height);
        let name = format!("{}-{size}", safe(&first.scene));
        let mut page = Page::new(format!("{}, {size}: error against time", first.scene));
        chapters::begin(&mut page, machine, measured);
        page.chapter("Searches");
        for measure in Measure::ALL {
            let figure = searches(
                &format!("{}: {} against time", first.scene, measure.name()),
                &group,
                measure,
                &base,
            );
            keep_figure(
                folder,
                &format!("{name}-{}", measure.name().replace(' ', "-")),
                &figure,
            )?;
            page.figure(
                &figure,
                "Each line is a search in one stage (filled markers: fragment, hollow: compute), its bound on steps (of `cone`, the rows of its table) growing from marker to marker (numbers: at both ends, and on the front), or the mesh, growing finer; bars are 95 % intervals of times. No \
                 method is better in both time and error than one on the dashed line, the Pareto front; upright lines are the floor, a frame without a search.",
            );
        }
        page.chapter("Maps");
        let figure = maps(
            &format!(
                "{}: depth error against time, by source of distances",
                first.scene
            ),
            &group,
            Measure::Depth,
        );
        keep_figure(folder, &format!("{name}-maps"), &figure)?;
        page.figure(&figure, "Each marker is a search with ample steps on a map of one source and one number of rows; those on the front are named.");
        if let Some(method) = most_exact(&group) {
            let own: Vec<MapError> = alone
                .iter()
                .filter(|e| e.view == first.view)
                .cloned()
                .collect();
            let title = format!("{}: depth error against the map's rows", first.scene);
            let figure = resolution(&title, &group, Measure::Depth, method, &own);
            keep_figure(folder, &format!("{name}-rows-depth"), &figure)?;
            page.figure(
                &figure,
                &format!(
                    "Hollow markers are the error of the map's own surface, found without any search; filled ones what `{}` draws from it: the gap between the two is the search's share."
                    , method.name()
                ),
            );
            let title = format!("{}: error of normals against the map's rows", first.scene);
            let figure = resolution(&title, &group, Measure::Normal, method, &[]);
            keep_figure(folder, &format!("{name}-rows-normals"), &figure)?;
            page.figure(&figure, "Normals as drawn: more rows mend them where distances are exact or from coverage, and do not where they come from a binary image.");
        }
        page.chapter("Rows");
        let rows: Vec<Row> = group.iter().map(|r| (*r).clone()).collect();
        chapters::row_table(&mut page, &rows, &SeriesStyles::of(&rows));
        let file = format!("{name}.html");
        write_text(&folder.join(&file), &page.html())?;
        pages.push((file, format!("{}, {size}", first.scene)));
    }
    summary(folder, plan, measured, machine, album, &pages, &base)
}

fn summary(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    machine: &Machine,
    album: &Album,
    pages: &[(String, String)],
    base: &MethodSettings,
) -> Result<()> {
    let mut page = Page::new("revmap: speed against accuracy");
    chapters::begin(&mut page, machine, measured);
    page.chapter("All views together");
    page.text(
        "Times are ratios to the RBM baseline in the same stage, as geometric means over all views; errors are those of all views together, the worst view's for depth and \
         normals. A search that is fast because it misses the surface stands at the top.",
    );
    let parts = parts(&measured.rows);
    for part in &parts {
        let ratios = over_rbm_baseline(&part.rows);
        page.heading(&part.heading());
        for measure in [Measure::Depth, Measure::Wrong, Measure::Normal] {
            let figure = summed(part.views(), &ratios, measure, base);
            let name = format!("summary-{}", measure.name().replace(' ', "-"));
            keep_figure(folder, &format!("{name}{}", part.ending(&parts)), &figure)?;
            page.figure(
                &figure,
                "Each line is a search in one stage (filled markers: fragment, hollow: compute) over its bound on steps, or the mesh over its segments x rings (numbers: at meshes, at both ends, and on the front), its time over that of the RBM baseline in the same stage; bars are 95 % intervals. No \
                 method is better in both than one on the dashed line, the Pareto front; upright lines are the floor, a frame without a search.",
            );
        }
    }
    page.chapter("Pareto fronts");
    page.text("Ways of drawing that are on the front of depth error against time of at least one view, best first.");
    page.table(&fronts(&measured.rows), &[0, 1]);
    page.chapter("Views");
    page.links(pages);
    chapters::picture_table(&mut page, &measured.rows);
    chapters::pictures(&mut page, plan, album);
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

/// Columns of the table of Pareto fronts.
pub(in crate::report) const FRONTS: [&str; 5] = [
    "method",
    "stage",
    "on the front of",
    "worst depth p99 (h/512)",
    "worst wrong pixels",
];

/// Which ways are on fronts: header and records, the most frequent first.
fn fronts(rows: &[Row]) -> Table {
    let all: Vec<&Row> = rows.iter().collect();
    let groups = pictures_of(&all);
    let labels = Labels::new(rows.iter().map(|r| &r.settings));
    let mut counts: Vec<(MethodSettings, usize, f64, f64)> = Vec::new();
    for group in &groups {
        let points: Vec<(f64, f64)> = group
            .iter()
            .map(|r| {
                (
                    r.time()
                        .filter(|_| r.settings.method != Method::Floor)
                        .map_or(f64::NAN, |t| t.value),
                    Measure::Depth.of(r).unwrap_or(f64::NAN),
                )
            })
            .collect();
        for i in front(&points, WORTH) {
            let way = variant(&group[i].settings);
            let (depth, wrong) = (points[i].1, group[i].errors.wrong());
            match counts.iter_mut().find(|c| c.0 == way) {
                Some(c) => *c = (way, c.1 + 1, c.2.max(depth), c.3.max(wrong)),
                None => counts.push((way, 1, depth, wrong)),
            }
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then(a.2.total_cmp(&b.2)));
    let records = counts
        .iter()
        .map(|(way, count, depth, wrong)| {
            vec![
                labels.way(way),
                way.stage.name().to_owned(),
                format!("{count} of {}", groups.len()),
                number(*depth, 3),
                percent(*wrong),
            ]
        })
        .collect();
    Table::new(FRONTS, records)
}
