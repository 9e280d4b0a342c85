//! Charts of a report.

use super::tables::{Record, heading, records};
use crate::measure::growth::growing;
use crate::measure::ratios::{Over, over};
use crate::measure::row::Row;
use crate::plan::is_rbm_baseline;
use crate::plan::method::{Method, MethodSettings};
use crate::report::columns::{Cell, Context};
use crate::report::series_style::{self, floor_line, of_source};
use revmap::error::Result;
use revmap::settings::DrawStage;
use revmap_figures::chart::Figure;
use revmap_figures::chart::dots::{Line, Placed, pages};
use revmap_figures::chart::front::{WORTH, front, stairs};
use revmap_figures::chart::style::{Dash, Style};
use revmap_figures::chart::xy::{Guide, Point, Series, XyChart};
use revmap_figures::groups::grouped;
use revmap_figures::stats::Interval;

/// A chart.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    /// Its file's name; `{scene}`, `{size}`, `{stage}` and `{part}` stand for what it is of.
    pub file: String,
    /// Its title, with the same words, and `{views}`.
    pub title: String,
    /// The caption.
    pub caption: String,
    /// The kind of its marks.
    #[serde(default)]
    pub kind: Kind,
    /// The column across.
    #[serde(default)]
    pub x: String,
    /// The column up; of ways of drawing as in tables of ways.
    #[serde(default)]
    pub y: String,
    /// Points are ways of drawing, their times put over these rows; else points are rows.
    pub over: Option<Over>,
    /// The rows that share a line.
    #[serde(default)]
    pub series: SeriesBy,
    /// True if only rows count of the search that is nearest to the truth, of those that read maps:
    /// what it errs is the map's error.
    #[serde(default)]
    pub most_exact: bool,
    /// True if it has the Pareto front.
    #[serde(default)]
    pub front: bool,
    /// True if power laws are fitted.
    #[serde(default)]
    pub law: bool,
    /// True if ticks are at the values across, and nowhere else.
    #[serde(default)]
    pub ticks: bool,
    /// A line to compare points with: `equal`, or `published N` of a published table.
    #[serde(default)]
    pub guide: String,
    /// True for an even axis, not a logarithmic one: across, up.
    #[serde(default)]
    pub linear: [bool; 2],
}

/// Kinds of charts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Points over two axes.
    #[default]
    Points,
    /// A line for each row or way of drawing, its time as a dot.
    Dots,
}

/// The rows that share a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SeriesBy {
    /// A method in a stage.
    #[default]
    Method,
    /// A way of drawing, whatever rows its map has.
    Way,
    /// A scene.
    Scene,
    /// A source of distances.
    Source,
}

/// A point before it is part of a line.
struct Item {
    name: String,
    style: Style,
    point: Point,
    joined: bool,
    stage: DrawStage,
}

impl Chart {
    pub(super) fn check(&self) -> Result<()> {
        if self.kind == Kind::Points {
            heading(&self.y, self.over)?;
            if self.over.is_none() || self.over_column() {
                heading(&self.x, None)?;
            }
        }
        Ok(())
    }

    /// True if points are ways of drawing over their tolerance or another column, not over time.
    pub(super) fn over_column(&self) -> bool {
        self.over.is_some() && !self.x.is_empty()
    }

    /// Draws the chart over these rows: none where there is nothing to show, several where one
    /// would be longer than a page.
    pub fn figures(&self, context: &Context, rows: &[&Row]) -> Result<Vec<Figure>> {
        if self.kind == Kind::Dots {
            return Ok(self.dots(context, rows));
        }
        let mut rows = rows.to_vec();
        if self.most_exact {
            let best = most_exact(&rows);
            rows.retain(|r| Some(r.settings.method) == best && !is_rbm_baseline(&r.settings));
        }
        // Meshes from coarse to fine.
        rows.sort_by_key(|r| r.settings.method.order());
        let rows = rows.as_slice();
        let (items, floors) = self.items(context, rows)?;
        if items.is_empty() {
            return Ok(Vec::new());
        }
        let fronts = match self.front {
            true => fronts(&items),
            false => Vec::new(),
        };
        let lines = grouped(items, |i| (i.name.clone(), i.style.filled)).into_iter();
        let mut series: Vec<Series> = lines
            .map(|((name, _), own)| Series {
                name,
                style: own[0].style,
                joined: own[0].joined,
                points: own.into_iter().map(|i| i.point).collect(),
            })
            .collect();
        self.thin_labels(&mut series, &fronts);
        let (x, y) = self.axes(context, &series, &floors)?;
        let front = |(stage, best): &(DrawStage, Vec<(f64, f64)>)| Guide {
            dash: match stage {
                DrawStage::Fragment => Dash::GUIDE,
                DrawStage::Compute => Dash::DASH_DOT,
            },
            ..Guide::dashed(&format!("Pareto front, {}", stage.name()), stairs(best))
        };
        let mut guides: Vec<Guide> = fronts.iter().map(front).collect();
        if self.front {
            guides.extend(floors);
        }
        guides.extend(self.guides(context, rows, &series)?);
        let chart = XyChart {
            title: self.title.clone(),
            x,
            y,
            series,
            guides,
        };
        Ok(vec![chart.figure()])
    }

    /// A line for each row, or for each way of drawing over others.
    fn dots(&self, context: &Context, rows: &[&Row]) -> Vec<Figure> {
        let line = |settings: &MethodSettings, value: Interval| Line {
            name: context.styles.way(settings),
            value,
            style: context.styles.style(settings),
            unresolved: value.relative() > context.resolved,
        };
        let stage = |s: &MethodSettings| format!("{} stage", s.stage.name());
        if let Some(reference) = self.over {
            let ratios = over(rows.iter().copied(), reference).into_iter();
            let placed =
                |settings, time| ((stage(&settings), String::new()), line(&settings, time));
            let lines: Vec<Placed> = ratios.map(|r| placed(r.settings, r.time)).collect();
            let axis = format!("time / {}", context.baseline());
            return pages(&self.title, &axis, Some(1.0), &lines);
        }
        let placed = |row: &&Row| -> Option<Placed> {
            let picture = format!("{}, {}", row.scene, row.size());
            let heading = format!("{picture}, {}", stage(&row.settings));
            Some(((heading, picture), line(&row.settings, row.time()?)))
        };
        let lines: Vec<Placed> = rows.iter().filter_map(placed).collect();
        pages(&self.title, "time of a frame (ms)", None, &lines)
    }

    /// Points that are rows or ways of drawing, and the lines of floors.
    fn items(&self, context: &Context, rows: &[&Row]) -> Result<(Vec<Item>, Vec<Guide>)> {
        let (mut items, mut floors) = (Vec::new(), Vec::new());
        let lowest = self.floor();
        for record in records(rows, self.over) {
            let s = record.settings();
            if s.method == Method::Floor {
                floors.extend(record.time().map(|time| floor_line(s, time.value)));
                continue;
            }
            let across = match self.over.is_some() && !self.over_column() {
                true => context.known(record.time()),
                false => record.cell(context, rows, &self.x)?,
            };
            let up = record.cell(context, rows, &self.y)?;
            let (Some(x), Some(y)) = (across.value(), up.value()) else {
                continue;
            };
            let Some((name, style, joined)) = self.line(context, &record) else {
                continue;
            };
            // Zero has no place on a logarithmic axis without a floor.
            let [even_x, even_y] = self.linear;
            if (x <= 0.0 && !even_x) || (y <= 0.0 && !even_y && lowest == 0.0) {
                continue;
            }
            let label = match self.series {
                SeriesBy::Scene => None,
                SeriesBy::Source if self.most_exact => None,
                SeriesBy::Source => {
                    Some(format!("{} {}", s.method.name(), s.map_rows.unwrap_or(0)))
                }
                SeriesBy::Method => label(context, s),
                SeriesBy::Way => label(context, s).filter(|_| s.method.is_mesh()),
            };
            let sure = record
                .time()
                .is_some_and(|t| t.relative() <= context.resolved);
            let wide = |name: &str, cell: &Cell| match cell {
                Cell::Known(_) => false,
                Cell::Unresolved(_) => true,
                _ => !sure && (self.over.is_some() || is_timed(name)),
            };
            let unresolved = wide(&self.x, &across) || wide(&self.y, &up);
            items.push(Item {
                name,
                style,
                joined,
                stage: s.stage,
                point: Point {
                    x,
                    y,
                    spread: ends(&self.x, &across, &record),
                    rise: ends(&self.y, &up, &record),
                    unresolved,
                    label: label.filter(|_| !unresolved),
                },
            });
        }
        Ok((items, floors))
    }

    /// The name and look of a record's line, and whether its points are joined.
    fn line(&self, context: &Context, record: &Record) -> Option<(String, Style, bool)> {
        let s = record.settings();
        Some(match (self.series, record) {
            (SeriesBy::Method, _) => (context.line(s), series_style::style(s), true),
            (SeriesBy::Way, _) => {
                let way = growing(s);
                let (name, style) = (context.styles.way(&way), context.styles.style(&way));
                (name, style, !self.law)
            }
            (SeriesBy::Source, _) => {
                let source = s.map_source?;
                (source.name.to_owned(), of_source(source), self.most_exact)
            }
            (SeriesBy::Scene, Record::Row(row)) => {
                let scenes = grouped(context.rows, |r| &r.scene);
                let k = scenes.iter().position(|s| *s.0 == row.scene)?;
                (row.scene.clone(), Style::numbered(k), true)
            }
            (SeriesBy::Scene, Record::Way(..)) => return None,
        })
    }

    /// Keeps words at both ends of each line, on the front, and at meshes of a summary.
    fn thin_labels(&self, series: &mut [Series], fronts: &[(DrawStage, Vec<(f64, f64)>)]) {
        for line in series {
            let last = line.points.len().saturating_sub(1);
            let joined = line.joined;
            for (k, point) in line.points.iter_mut().enumerate() {
                let end = match self.series {
                    SeriesBy::Way => k == last,
                    _ => joined && (k == 0 || k == last),
                };
                let mut best = fronts.iter().flat_map(|f| &f.1);
                let on_front = best.any(|p| *p == (point.x, point.y));
                let kept = |label: &String| self.over.is_some() && label.contains('x');
                if !end && !on_front {
                    point.label = point.label.take().filter(kept);
                }
            }
        }
    }
}

/// The search nearest to the truth, of those that read maps.
fn most_exact(rows: &[&Row]) -> Option<Method> {
    let own = rows.iter().filter(|r| r.settings.map_source.is_some());
    let own = own.filter(|r| !is_rbm_baseline(&r.settings));
    let errors = own.filter_map(|r| Some((r.settings.method, r.errors.depth?.p99)));
    errors.min_by(|a, b| a.1.total_cmp(&b.1)).map(|e| e.0)
}

/// The resolved points of each stage that no other of it beats, where there are any.
fn fronts(items: &[Item]) -> Vec<(DrawStage, Vec<(f64, f64)>)> {
    let of = |stage: DrawStage| {
        let own = items.iter().filter(|i| i.stage == stage);
        let known = own.map(|i| &i.point).filter(|p| !p.unresolved);
        let places: Vec<(f64, f64)> = known.map(|p| (p.x, p.y)).collect();
        let best = front(&places, WORTH).into_iter().map(|i| places[i]);
        (stage, best.collect::<Vec<_>>())
    };
    let stages = [DrawStage::Fragment, DrawStage::Compute].map(of);
    stages.into_iter().filter(|f| !f.1.is_empty()).collect()
}

/// True for columns that are as sure as the time of their row.
fn is_timed(name: &str) -> bool {
    name.starts_with("time") || name.starts_with("rate")
}

/// The ends of the interval of a cell, where they are known.
fn ends(name: &str, cell: &Cell, record: &Record) -> Option<(f64, f64)> {
    let time = || record.time()?.ends();
    match name {
        "time_ms" => time(),
        "rate" => time().map(|(low, high)| (1e3 / high, 1e3 / low)),
        _ => cell.interval()?.ends(),
    }
}

/// The word beside a marker: a mesh's tessellation, or what tells ways of one method apart.
fn label(context: &Context, s: &MethodSettings) -> Option<String> {
    if is_rbm_baseline(s) {
        return None;
    }
    let name = context.styles.way(s);
    let rest = match s.method {
        mesh if mesh.is_mesh() => name.strip_prefix("mesh:"),
        method => name.strip_prefix(method.name()),
    }?;
    let rest = rest.trim_start_matches([' ', ',']);
    let rest = rest.trim_end_matches(" steps").trim_end_matches(" rows");
    (!rest.is_empty()).then(|| rest.to_owned())
}

#[cfg(test)]
mod tests;
