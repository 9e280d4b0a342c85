//! Charts of errors over the rows of maps.

use super::{Chart, Extra};
use crate::method::Method;
use crate::report::chart::Figure;
use crate::report::chart::axis::Axis;
use crate::report::chart::style::Style;
use crate::report::chart::xy::{Point, Series, XyChart};
use crate::report::columns::{self, Context};
use crate::report::plan::is_rbm_baseline;
use crate::report::row::Row;
use crate::report::series_style::of_source;
use revmap::error::Result;

impl Chart {
    /// The errors of maps alone beside what the most exact search draws from them.
    pub(super) fn map_rows(
        &self,
        context: &Context,
        rows: &[&Row],
        extra: &Extra,
    ) -> Result<Option<Figure>> {
        let column = columns::named(&self.y)?;
        let Some(method) = most_exact(rows) else {
            return Ok(None);
        };
        let mut series: Vec<Series> = Vec::new();
        let mut add = |name: String, style: Style, x: f64, y: f64| {
            let point = Point {
                x,
                y,
                ..Point::default()
            };
            match series.iter_mut().find(|s| s.name == name) {
                Some(known) => known.points.push(point),
                None => series.push(Series {
                    name,
                    style,
                    points: vec![point],
                    joined: true,
                }),
            }
        };
        let own = rows
            .iter()
            .filter(|r| r.settings.method == method && !is_rbm_baseline(&r.settings));
        for row in own {
            let (Some(source), Some(count)) = (row.settings.map_source, row.settings.map_rows)
            else {
                continue;
            };
            if let Some(y) = (column.cell)(context, row).value() {
                add(
                    format!("{}, drawn", source.name),
                    of_source(source),
                    count.into(),
                    y,
                );
            }
        }
        let views: Vec<usize> = rows.iter().map(|r| r.view).collect();
        for error in extra.maps.iter().filter(|e| views.contains(&e.view)) {
            // Colours and normals of maps are not compared.
            let y = error.errors.depth.filter(|_| self.y == "depth_p99_texels");
            if let Some(depth) = y {
                let style = Style {
                    filled: false,
                    ..of_source(error.source)
                };
                let name = format!("{}, the map by itself", error.source.name);
                add(name, style, error.rows.into(), depth.p99);
            }
        }
        for line in &mut series {
            line.points.sort_by(|a, b| a.x.total_cmp(&b.x));
        }
        if series.is_empty() {
            return Ok(None);
        }
        let counts: Vec<f64> = series.iter().flat_map(|s| &s.points).map(|p| p.x).collect();
        let chart = XyChart {
            title: self.title.clone(),
            x: Axis::log("rows of the map").at(counts),
            y: Axis::log(column.heading).from(column.floor),
            series,
            guides: Vec::new(),
        };
        Ok(Some(chart.figure()))
    }
}

/// The search whose drawn pictures are nearest to the truth: what is left of its error is the
/// map's. Of those that read maps of every source.
fn most_exact(rows: &[&Row]) -> Option<Method> {
    let best = |method: Method| {
        let own = rows
            .iter()
            .filter(|r| r.settings.method == method && r.settings.map_source.is_some());
        let own = own.filter(|r| !is_rbm_baseline(&r.settings));
        let least = own
            .filter_map(|r| Some(r.errors.depth?.p99))
            .reduce(f64::min);
        least.map(|p99| (method, p99))
    };
    let all = Method::ALL.into_iter().filter_map(best);
    all.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(method, _)| method)
}
