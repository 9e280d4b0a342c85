//! Axes of charts, lines to compare points with, and fitted laws.

use super::{Chart, tables};
use crate::measure::growth::growth;
use crate::measure::row::Row;
use crate::report::columns::{self, Context};
use crate::report::published;
use revmap::error::Result;
use revmap_figures::chart::axis::Axis;
use revmap_figures::chart::xy::{Guide, Series};

impl Chart {
    pub(super) fn axes(
        &self,
        context: &Context,
        series: &[Series],
        floors: &[Guide],
    ) -> Result<(Axis, Axis)> {
        let mut x = match self.over.filter(|_| !self.over_column()) {
            Some(_) => Axis::log(format!("time / {}", context.baseline())).with(1.0),
            None => Axis::log(columns::named(&self.x)?.heading),
        };
        let mut y = Axis::log(tables::heading(&self.y, self.over)?);
        (x.log, y.log) = (!self.linear[0], !self.linear[1]);
        y.floor = Some(self.floor()).filter(|floor| *floor > 0.0);
        if self.front {
            let places = floors.iter().filter_map(|floor| floor.points.first());
            x.include.extend(places.map(|place| place.0));
        }
        if self.ticks {
            x = x.at(series.iter().flat_map(|s| &s.points).map(|p| p.x));
        }
        y.include.extend(self.published().iter().map(|p| p.1));
        Ok((x, y))
    }

    /// Where the column up begins; 0 for none.
    pub(super) fn floor(&self) -> f64 {
        let parts = self.y.split_once(' ');
        let name = parts.map_or(&*self.y, |(_, column)| column);
        columns::named(name).map_or(0.0, |column| column.floor)
    }

    /// The published line, in charts that have one.
    fn published(&self) -> Vec<(f64, f64)> {
        let mut words = self.guide.split(' ');
        let table = match (words.next(), words.next()) {
            (Some("published"), Some(number)) => published::table(number),
            _ => None,
        };
        let size = words.next().unwrap_or("");
        table.map_or(Vec::new(), |t| t.line(size, self.y == "rate_over_first"))
    }

    /// Lines to compare points with, and fitted laws.
    pub(super) fn guides(
        &self,
        context: &Context,
        rows: &[&Row],
        series: &[Series],
    ) -> Result<Vec<Guide>> {
        let mut all = Vec::new();
        if self.guide == "equal" {
            let values = series.iter().flat_map(|s| &s.points).map(|p| p.x);
            let mut values: Vec<f64> = values.filter(|v| *v > 0.0).collect();
            values.sort_by(f64::total_cmp);
            let points = values.into_iter().map(|v| (v, v)).collect();
            all.push(Guide::dashed("the tolerance", points));
        }
        let line = self.published();
        if !line.is_empty() {
            all.push(Guide::dashed("published, GeForce GT 630M", line));
        }
        if self.law {
            let column = columns::named(&self.x)?;
            let x = |row: &Row| (column.cell)(context, row).value();
            for g in growth(rows, x, context.resolved) {
                let (Some(law), [first, .., last]) = (g.law, g.points.as_slice()) else {
                    continue;
                };
                let style = context.styles.style(&g.way);
                all.push(Guide {
                    name: String::new(),
                    points: [first, last].map(|p| (p.0, law.at(p.0))).to_vec(),
                    color: style.color,
                    dash: style.dash,
                    width: style.line(),
                });
            }
        }
        Ok(all)
    }
}
