//! Charts of one time a line.

use super::Chart;
use crate::method::MethodSettings;
use crate::report::chart::Figure;
use crate::report::chart::axis::Axis;
use crate::report::chart::dots::{Block, DotChart, Line};
use crate::report::columns::Context;
use crate::report::plan::grouped;
use crate::report::ratios::over;
use crate::report::row::Row;
use crate::report::stats::Interval;

/// Lines of dots on one page.
const DOTS: usize = 44;

/// A line with its picture and the heading of its stage there.
type Placed = ((String, String), Line);

impl Chart {
    pub(super) fn dots(&self, context: &Context, rows: &[&Row]) -> Vec<Figure> {
        let line = |settings: &MethodSettings, value: Interval| Line {
            name: context.styles.way(settings),
            value,
            style: context.styles.style(settings),
            unresolved: value.relative() > context.resolved,
        };
        let (lines, axis): (Vec<Placed>, String) = match self.over {
            Some(reference) => {
                let block =
                    |s: &MethodSettings| (String::new(), format!("{} stage", s.stage.name()));
                let ratios = over(rows.iter().copied(), reference).into_iter();
                let lines = ratios.map(|r| (block(&r.settings), line(&r.settings, r.time)));
                (lines.collect(), format!("time / {}", context.baseline()))
            }
            None => {
                let block = |row: &Row| {
                    let picture = format!("{}, {}", row.scene, row.size());
                    let name = format!("{picture}, {} stage", row.settings.stage.name());
                    (picture, name)
                };
                let placed = |row: &&Row| Some((block(row), line(&row.settings, row.time()?)));
                let lines = rows.iter().filter_map(placed);
                (lines.collect(), "time of a frame (ms)".to_owned())
            }
        };
        // A picture's lines stay together.
        let mut pages: Vec<Vec<Placed>> = Vec::new();
        for group in lines.chunk_by(|a, b| a.0.0 == b.0.0) {
            match pages.last_mut() {
                Some(page) if page.len() + group.len() <= DOTS => page.extend_from_slice(group),
                _ => pages.push(group.to_vec()),
            }
        }
        let figure = |page: Vec<Placed>| {
            let blocks = grouped(page, |line| line.0.1.clone()).into_iter();
            let block = |(name, lines): (_, Vec<(_, Line)>)| Block {
                name,
                lines: lines.into_iter().map(|line| line.1).collect(),
            };
            let chart = DotChart {
                title: self.title.clone(),
                axis: Axis::log(axis.as_str()),
                mark: self.over.map(|_| 1.0),
                blocks: blocks.map(block).collect(),
            };
            chart.figure()
        };
        pages.into_iter().map(figure).collect()
    }
}
