//! Charts of error against time: one page for each view, and one that sums up.

use super::chapters;
use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::front::{WORTH, front, stairs};
use super::chart::style::Style;
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::covered::{parts, pictures_of};
use super::folder::{keep_figure, write_text};
use super::looks::{Looks, of_line, of_source, style};
use super::machine::Machine;
use super::map_error::MapError;
use super::measure::Measured;
use super::names::{self, number, safe, stage};
use super::page::Page;
use super::pictures::Album;
use super::plan::{Labels, PAPERS_LOOP, Plan, is_papers_loop, variant};
use super::ratios::{LEAST_DEPTH, Ratio, over_papers_loop};
use super::row::Row;
use super::sweep::{has_budget, has_rows};
use super::text::percent;
use crate::error::Result;
use crate::settings::{Settings, Solver};
use std::path::Path;

/// An error that a chart can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// 99th percentile of the depth error, texels.
    Depth,
    /// Missed and ghost pixels, percent of the pixels hit.
    Wrong,
    /// Root mean square of the normals' angle, degrees.
    Normal,
    /// Mean of FLIP.
    Flip,
}

impl Measure {
    /// All, in the order of a page.
    pub const ALL: [Self; 4] = [Self::Depth, Self::Wrong, Self::Normal, Self::Flip];

    /// Of a row; `None` where nothing was hit in both pictures.
    #[must_use]
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            Self::Depth => row.errors.depth.map(|d| d.p99),
            Self::Wrong => Some(100.0 * row.errors.wrong()),
            Self::Normal => row.errors.normal.map(|n| n.rms),
            Self::Flip => Some(row.errors.flip),
        }
    }

    /// Its axis. What lies below the floor is of no use to tell apart.
    #[must_use]
    pub fn axis(self) -> Axis {
        match self {
            Self::Depth => Axis::log("depth error, p99 (texels of 512 rows)").from(LEAST_DEPTH),
            Self::Wrong => Axis::log("wrong pixels (% of pixels hit)").from(1e-4),
            Self::Normal => Axis::log("error of normals, rms (degrees)").from(1e-3),
            Self::Flip => Axis::log("FLIP, mean over the picture").from(1e-6),
        }
    }

    /// Its name in titles and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth error",
            Self::Wrong => "wrong pixels",
            Self::Normal => "error of normals",
            Self::Flip => "FLIP",
        }
    }
}

/// Whether settings take part in the sweep over budgets: all of the map left as drawing takes it.
fn over_budgets(s: &Settings, base: &Settings) -> bool {
    (s.map_rows.is_none() || has_rows(s.solver))
        && s.map_source.is_none()
        && s.map_format == base.map_format
}

/// What a marker is called: its bound on steps, the rows of its table, or its tessellation.
fn budget(s: &Settings) -> Option<String> {
    if let Solver::Mesh { segments, rings } = s.solver {
        return Some(format!("{segments}x{rings}"));
    }
    if is_papers_loop(s) {
        return None;
    }
    if has_rows(s.solver) {
        return s.map_rows.map(|rows| rows.to_string());
    }
    let steps = s.max_steps.unwrap_or_else(|| s.solver.default_steps(false));
    has_budget(s.solver).then(|| steps.to_string())
}

/// Error against time of every search swept over its steps, in both stages, with the front over all of them.
#[must_use]
pub fn searches(title: &str, rows: &[&Row], measure: Measure, base: &Settings) -> Figure {
    let mut series: Vec<Series> = Vec::new();
    let mut places = Vec::new();
    for row in rows {
        let papers = is_papers_loop(&row.settings);
        if !(papers || over_budgets(&row.settings, base)) {
            continue;
        }
        let (Some(time), Some(error)) = (row.time(), measure.of(row)) else {
            continue;
        };
        places.push((time.value, error));
        let s = &row.settings;
        let (name, style) = if papers {
            (PAPERS_LOOP.to_owned(), style(s))
        } else {
            (s.solver.name().to_owned(), of_line(s))
        };
        let label = budget(s);
        let point = Point {
            x: time.value,
            y: error,
            label,
        };
        match series
            .iter_mut()
            .find(|known| (&known.name, known.style.filled) == (&name, style.filled))
        {
            Some(known) => known.points.push(point),
            None => series.push(Series {
                name,
                style,
                points: vec![point],
                joined: true,
            }),
        }
    }
    // Only what is on the front is worth a word, or the chart drowns in them.
    let best = front(&places, WORTH);
    let on_front = |p: &Point| best.iter().any(|&i| places[i] == (p.x, p.y));
    for point in series.iter_mut().flat_map(|s| &mut s.points) {
        if !on_front(point) {
            point.label = None;
        }
    }
    chart(
        title,
        measure,
        series,
        &best.into_iter().map(|i| places[i]).collect::<Vec<_>>(),
    )
}

/// Error against time over the sources and rows of maps, one stage, every search.
#[must_use]
pub fn maps(title: &str, rows: &[&Row], measure: Measure) -> Figure {
    let mut series: Vec<Series> = Vec::new();
    let mut places = Vec::new();
    for row in rows {
        let s = &row.settings;
        let (Some(source), Some(_)) = (s.map_source, s.map_rows) else {
            continue;
        };
        let (Some(time), Some(error)) = (row.time(), measure.of(row)) else {
            continue;
        };
        places.push((time.value, error));
        let name = names::source(source).to_owned();
        let label = s.map_rows.map(|rows| format!("{} {rows}", s.solver.name()));
        let point = Point {
            x: time.value,
            y: error,
            label,
        };
        match series.iter_mut().find(|known| known.name == name) {
            Some(known) => known.points.push(point),
            None => series.push(Series {
                name,
                style: of_source(source),
                points: vec![point],
                joined: false,
            }),
        }
    }
    let best = front(&places, WORTH);
    for point in series.iter_mut().flat_map(|s| &mut s.points) {
        if !best.iter().any(|&i| places[i] == (point.x, point.y)) {
            point.label = None;
        }
    }
    chart(
        title,
        measure,
        series,
        &best.into_iter().map(|i| places[i]).collect::<Vec<_>>(),
    )
}

fn chart(title: &str, measure: Measure, series: Vec<Series>, best: &[(f64, f64)]) -> Figure {
    XyChart {
        title: title.to_owned(),
        x: Axis::log("time of a frame (ms)"),
        y: measure.axis(),
        series,
        guides: vec![Guide::dashed("Pareto front", stairs(best))],
    }
    .figure()
}

/// Error against rows of the map, by source, of one search with an ample budget; for depth also what the map alone errs, found
/// without any search.
#[must_use]
pub fn resolution(
    title: &str,
    rows: &[&Row],
    measure: Measure,
    solver: Solver,
    alone: &[MapError],
) -> Figure {
    let mut series: Vec<Series> = Vec::new();
    let mut add =
        |name: String, style: Style, point: Point| match series.iter_mut().find(|s| s.name == name)
        {
            Some(known) => known.points.push(point),
            None => series.push(Series {
                name,
                style,
                points: vec![point],
                joined: true,
            }),
        };
    for row in rows
        .iter()
        .filter(|r| r.settings.solver == solver && !is_papers_loop(&r.settings))
    {
        let (Some(source), Some(count)) = (row.settings.map_source, row.settings.map_rows) else {
            continue;
        };
        if let Some(y) = measure.of(row) {
            add(
                format!("{}, drawn", names::source(source)),
                of_source(source),
                Point {
                    x: f64::from(count),
                    y,
                    label: None,
                },
            );
        }
    }
    for error in alone {
        let value = match measure {
            Measure::Depth => error.errors.depth.map(|d| d.p99),
            Measure::Wrong => Some(100.0 * error.errors.wrong()),
            Measure::Normal | Measure::Flip => None,
        };
        if let Some(y) = value {
            let style = Style {
                filled: false,
                ..of_source(error.source)
            };
            add(
                format!("{}, the map alone", names::source(error.source)),
                style,
                Point {
                    x: f64::from(error.rows),
                    y,
                    label: None,
                },
            );
        }
    }
    for s in &mut series {
        s.points.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    let counts: Vec<f64> = series.iter().flat_map(|s| &s.points).map(|p| p.x).collect();
    XyChart {
        title: title.to_owned(),
        x: Axis::log("rows of the map").at(counts),
        y: measure.axis(),
        series,
        guides: Vec::new(),
    }
    .figure()
}

/// The search whose drawn pictures are nearest to the truth: what is left of its error is the map's. Of those that read maps of every
/// source.
#[must_use]
pub fn most_exact(rows: &[&Row]) -> Option<Solver> {
    let worst = |solver: Solver| {
        rows.iter()
            .filter(|r| r.settings.solver == solver && r.settings.map_source.is_some())
            .filter_map(|r| Measure::Depth.of(r))
            .reduce(f64::min)
            .map(|p99| (solver, p99))
    };
    Solver::ALL
        .into_iter()
        .filter_map(worst)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(solver, _)| solver)
}

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
    let base = Settings::default();
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
                "Each line is a search in one stage (filled markers: fragment, hollow: compute), its bound on steps (of `cone`, the rows of its table) growing from marker to marker (numbers on the front), or the mesh, growing finer; nothing beats what lies on the dashed line \
                 in both time and error.",
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
        if let Some(solver) = most_exact(&group) {
            let own: Vec<MapError> = alone
                .iter()
                .filter(|e| e.view == first.view)
                .cloned()
                .collect();
            let title = format!("{}: depth error against the map's rows", first.scene);
            let figure = resolution(&title, &group, Measure::Depth, solver, &own);
            keep_figure(folder, &format!("{name}-rows-depth"), &figure)?;
            page.figure(
                &figure,
                &format!(
                    "Hollow markers are the error of the map's own surface, found without any search; filled ones what `{}` draws from it: the gap between the two is the search's share."
                    , solver.name()
                ),
            );
            let title = format!("{}: error of normals against the map's rows", first.scene);
            let figure = resolution(&title, &group, Measure::Normal, solver, &[]);
            keep_figure(folder, &format!("{name}-rows-normals"), &figure)?;
            page.figure(&figure, "Normals as drawn: more rows mend them where distances are exact or from coverage, and do not where they come from a binary image.");
        }
        page.chapter("Rows");
        let ways: Vec<Settings> = group.iter().map(|r| variant(&r.settings)).collect();
        let rows: Vec<Row> = group.iter().map(|r| (*r).clone()).collect();
        chapters::row_table(&mut page, &rows, &Looks::new(&ways));
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
    base: &Settings,
) -> Result<()> {
    let mut page = Page::new("revmap: speed against accuracy");
    chapters::begin(&mut page, machine, measured);
    page.chapter("All views together");
    page.text(
        "Times are ratios to the papers' loop in the same stage, as geometric means over all views; errors are those of all views together, the worst view's for depth and \
         normals. A search that is fast because it misses the surface stands at the top.",
    );
    let parts = parts(&measured.rows);
    for part in &parts {
        let ratios = over_papers_loop(&part.rows);
        page.heading(&part.heading());
        for measure in [Measure::Depth, Measure::Wrong, Measure::Normal] {
            let figure = summed(part.views(), &ratios, measure, base);
            let name = format!("summary-{}", measure.name().replace(' ', "-"));
            keep_figure(folder, &format!("{name}{}", part.ending(&parts)), &figure)?;
            page.figure(
                &figure,
                "Each line is a search in one stage (filled markers: fragment, hollow: compute) over its bound on steps, or the mesh over its segments x rings (numbers: at meshes, and on the front), its time put in proportion to the papers' loop of the same stage; nothing beats what lies on the dashed line \
                 in both.",
            );
        }
    }
    page.chapter("Fronts");
    page.text("Ways of drawing that are on the front of depth error against time of at least one view, best first.");
    let (header, records) = fronts(&measured.rows);
    page.table(&header, &records, &[0, 1]);
    page.chapter("Views");
    page.links(pages);
    chapters::picture_table(&mut page, &measured.rows);
    chapters::pictures(&mut page, plan, album);
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

/// The chart that sums `views` up: error against the ratio to the papers' loop.
#[must_use]
pub fn summed(views: &str, ratios: &[Ratio], measure: Measure, base: &Settings) -> Figure {
    let mut series: Vec<Series> = Vec::new();
    let mut places = Vec::new();
    for ratio in ratios {
        let s = &ratio.settings;
        let papers = is_papers_loop(s);
        let plain = over_budgets(s, base);
        let error = match measure {
            Measure::Depth => ratio.depth_p99,
            Measure::Wrong => Some(100.0 * ratio.wrong),
            Measure::Normal => ratio.normal_rms,
            Measure::Flip => None,
        };
        let (true, Some(y)) = (papers || plain, error) else {
            continue;
        };
        let x = ratio.time.value;
        places.push((x, y));
        let (name, style) = if papers {
            (PAPERS_LOOP.to_owned(), style(s))
        } else {
            (s.solver.name().to_owned(), of_line(s))
        };
        let label = budget(s);
        let point = Point { x, y, label };
        match series
            .iter_mut()
            .find(|known| (&known.name, known.style.filled) == (&name, style.filled))
        {
            Some(known) => known.points.push(point),
            None => series.push(Series {
                name,
                style,
                points: vec![point],
                joined: true,
            }),
        }
    }
    let best = front(&places, WORTH);
    for point in series.iter_mut().flat_map(|s| &mut s.points) {
        let mesh = point.label.as_ref().is_some_and(|l| l.contains('x'));
        if !(mesh || best.iter().any(|&i| places[i] == (point.x, point.y))) {
            point.label = None;
        }
    }
    XyChart {
        title: format!("{views}: {} against time", measure.name()),
        x: Axis::log("time / time of the papers' loop").with(1.0),
        y: measure.axis(),
        series,
        guides: vec![Guide::dashed(
            "Pareto front",
            stairs(&best.into_iter().map(|i| places[i]).collect::<Vec<_>>()),
        )],
    }
    .figure()
}

/// Which ways are on fronts: header and records, the most frequent first.
fn fronts(rows: &[Row]) -> ([&'static str; 5], Vec<Vec<String>>) {
    let all: Vec<&Row> = rows.iter().collect();
    let groups = pictures_of(&all);
    let labels = Labels::new(rows.iter().map(|r| &r.settings));
    let mut counts: Vec<(Settings, usize, f64, f64)> = Vec::new();
    for group in &groups {
        let points: Vec<(f64, f64)> = group
            .iter()
            .map(|r| {
                (
                    r.time().map_or(f64::NAN, |t| t.value),
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
                stage(way.stage).to_owned(),
                format!("{count} of {}", groups.len()),
                number(*depth, 3),
                percent(*wrong),
            ]
        })
        .collect();
    (
        [
            "search",
            "stage",
            "on the front of",
            "worst depth p99 (texels)",
            "worst wrong pixels",
        ],
        records,
    )
}
