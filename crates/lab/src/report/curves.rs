//! Charts of error against time, of error against rows of the map, and the pages that hold them.

mod measure;
mod pages;

pub use measure::Measure;
#[cfg(test)]
pub(super) use pages::FRONTS;
pub use pages::write;

use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::front::{WORTH, front, stairs};
use super::chart::style::Style;
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::map_error::MapError;
use super::plan::{RBM_BASELINE, is_rbm_baseline};
use super::ratios::Ratio;
use super::row::Row;
use super::series_style::{floor_line, of_source, style};
use super::stats::Interval;
use super::sweep::{has_budget, has_rows};
use crate::method::{Method, MethodSettings};

/// Whether settings take part in the sweep over budgets: all of the map left as drawing takes it.
fn over_budgets(s: &MethodSettings, base: &MethodSettings) -> bool {
    (s.map_rows.is_none() || has_rows(s.method))
        && s.map_source.is_none()
        && s.map_format == base.map_format
}

/// What a marker is called: its bound on steps, the rows of its table, or its tessellation.
fn budget(s: &MethodSettings) -> Option<String> {
    if let Method::Mesh { segments, rings } = s.method {
        return Some(format!("{segments}x{rings}"));
    }
    if is_rbm_baseline(s) {
        return None;
    }
    if has_rows(s.method) {
        return s.map_rows.map(|rows| rows.to_string());
    }
    let steps = s.max_steps.unwrap_or_else(|| s.method.default_steps(false));
    has_budget(s.method).then(|| steps.to_string())
}

/// Adds the point of a way of drawing to its line: of its search and stage, or of the RBM baseline.
/// Ways that take no part in the sweep over budgets have none.
fn add_swept(
    series: &mut Vec<Series>,
    s: &MethodSettings,
    base: &MethodSettings,
    time: &Interval,
    y: f64,
) {
    let (name, style) = if s.method == Method::Floor {
        return;
    } else if is_rbm_baseline(s) {
        (RBM_BASELINE, style(s))
    } else if over_budgets(s, base) {
        (s.method.name(), style(s))
    } else {
        return;
    };
    let point = Point {
        x: time.value,
        y,
        spread: time.ends(),
        label: budget(s),
    };
    add(series, name, style, true, point);
}

/// Adds a point to the series of its name and stage.
fn add(series: &mut Vec<Series>, name: &str, style: Style, joined: bool, point: Point) {
    match series
        .iter_mut()
        .find(|known| known.name == name && known.style.filled == style.filled)
    {
        Some(known) => known.points.push(point),
        None => series.push(Series {
            name: name.to_owned(),
            style,
            points: vec![point],
            joined,
        }),
    }
}

/// Error against time of every search swept over its steps, in both stages, with the front over all
/// of them.
#[must_use]
pub fn searches(title: &str, rows: &[&Row], measure: Measure, base: &MethodSettings) -> Figure {
    let mut series = Vec::new();
    for row in rows {
        if let (Some(time), Some(error)) = (row.time(), measure.of(row)) {
            add_swept(&mut series, &row.settings, base, &time, error);
        }
    }
    let floors = rows.iter().map(|row| (&row.settings, row.time()));
    against_time(
        title,
        (Axis::log(TIME), floors_of(floors)),
        measure,
        series,
        |_| false,
    )
}

/// The lines of the floors among these ways.
fn floors_of<'a>(all: impl Iterator<Item = (&'a MethodSettings, Option<Interval>)>) -> Vec<Guide> {
    all.filter(|(s, _)| s.method == Method::Floor)
        .filter_map(|(s, time)| Some(floor_line(s, time?.value)))
        .collect()
}

/// Error against time over the sources and rows of maps, one stage, every search.
#[must_use]
pub fn maps(title: &str, rows: &[&Row], measure: Measure) -> Figure {
    let mut series = Vec::new();
    for row in rows {
        let s = &row.settings;
        let (Some(source), Some(count)) = (s.map_source, s.map_rows) else {
            continue;
        };
        let (Some(time), Some(y)) = (row.time(), measure.of(row)) else {
            continue;
        };
        let point = Point {
            x: time.value,
            y,
            spread: time.ends(),
            label: Some(format!("{} {count}", s.method.name())),
        };
        let (name, style) = (source.name(), of_source(source));
        add(&mut series, name, style, false, point);
    }
    against_time(
        title,
        (Axis::log(TIME), Vec::new()),
        measure,
        series,
        |_| false,
    )
}

/// The chart that sums `views` up: error against the ratio to the RBM baseline.
#[must_use]
pub fn summed(views: &str, ratios: &[Ratio], measure: Measure, base: &MethodSettings) -> Figure {
    let mut series = Vec::new();
    for ratio in ratios {
        let error = match measure {
            Measure::Depth => ratio.depth_p99,
            Measure::Wrong => Some(100.0 * ratio.wrong),
            Measure::Normal => ratio.normal_rms,
            Measure::Flip => None,
        };
        if let Some(error) = error {
            add_swept(&mut series, &ratio.settings, base, &ratio.time, error);
        }
    }
    let title = format!("{views}: {} against time", measure.name());
    let x = Axis::log("time / time of the RBM baseline").with(1.0);
    // Of meshes there are few: each keeps its word.
    let floors = floors_of(ratios.iter().map(|r| (&r.settings, Some(r.time))));
    against_time(&title, (x, floors), measure, series, |label| {
        label.contains('x')
    })
}

/// The name of the axis of times.
const TIME: &str = "time of a frame (ms)";

/// A chart over an axis of times and the lines of floors, with the front over all points. Words are for what is on the
/// front, for both ends of each line, and for what is to `keep`; of all points the chart would
/// drown in them.
fn against_time(
    title: &str,
    (mut x, floors): (Axis, Vec<Guide>),
    measure: Measure,
    mut series: Vec<Series>,
    keep: fn(&str) -> bool,
) -> Figure {
    let points = series.iter().flat_map(|s| &s.points);
    let places: Vec<(f64, f64)> = points.map(|p| (p.x, p.y)).collect();
    let best: Vec<(f64, f64)> = front(&places, WORTH)
        .into_iter()
        .map(|i| places[i])
        .collect();
    for line in &mut series {
        let last = line.points.len().saturating_sub(1);
        let joined = line.joined;
        for (k, point) in line.points.iter_mut().enumerate() {
            let end = joined && (k == 0 || k == last);
            if !end && !best.contains(&(point.x, point.y)) {
                point.label = point.label.take().filter(|label| keep(label));
            }
        }
    }
    for place in floors.iter().filter_map(|floor| floor.points.first()) {
        x = x.with(place.0);
    }
    XyChart {
        title: title.to_owned(),
        x,
        y: measure.axis(),
        series,
        guides: std::iter::once(Guide::dashed("Pareto front", stairs(&best)))
            .chain(floors)
            .collect(),
    }
    .figure()
}

/// Error against rows of the map, by source, of one search with an ample budget; for depth also
/// what the map alone errs, found without any search.
#[must_use]
pub fn resolution(
    title: &str,
    rows: &[&Row],
    measure: Measure,
    method: Method,
    alone: &[MapError],
) -> Figure {
    let mut series = Vec::new();
    let mut point = |name: &str, style: Style, rows: u32, y: f64| {
        let point = Point {
            x: f64::from(rows),
            y,
            spread: None,
            label: None,
        };
        add(&mut series, name, style, true, point);
    };
    for row in rows
        .iter()
        .filter(|r| r.settings.method == method && !is_rbm_baseline(&r.settings))
    {
        let (Some(source), Some(count)) = (row.settings.map_source, row.settings.map_rows) else {
            continue;
        };
        if let Some(y) = measure.of(row) {
            let name = format!("{}, drawn", source.name());
            point(&name, of_source(source), count, y);
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
            let name = format!("{}, the map alone", error.source.name());
            point(&name, style, error.rows, y);
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

/// The search whose drawn pictures are nearest to the truth: what is left of its error is the
/// map's. Of those that read maps of every source.
#[must_use]
pub fn most_exact(rows: &[&Row]) -> Option<Method> {
    let worst = |method: Method| {
        rows.iter()
            .filter(|r| r.settings.method == method && r.settings.map_source.is_some())
            .filter_map(|r| Measure::Depth.of(r))
            .reduce(f64::min)
            .map(|p99| (method, p99))
    };
    Method::ALL
        .into_iter()
        .filter_map(worst)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(method, _)| method)
}
