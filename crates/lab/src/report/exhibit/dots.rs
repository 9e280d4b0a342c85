//! Charts of one time a line.

use super::Chart;
use crate::method::MethodSettings;
use crate::report::chart::Figure;
use crate::report::chart::axis::Axis;
use crate::report::chart::dots::{Block, DotChart, Line};
use crate::report::columns::Context;
use crate::report::ratios::over;
use crate::report::row::Row;
use crate::report::stats::Interval;
use revmap::settings::DrawStage;

/// Lines of dots on one page.
const DOTS: usize = 44;

impl Chart {
    pub(super) fn dots(&self, context: &Context, rows: &[&Row]) -> Vec<Figure> {
        let mut lines: Vec<(String, Line)> = Vec::new();
        let mut add = |block: String, settings: &MethodSettings, value: Interval| {
            let line = Line {
                name: context.styles.way(settings),
                value,
                style: context.styles.style(settings),
                unresolved: value.relative() > context.resolved,
            };
            lines.push((block, line));
        };
        if let Some(reference) = self.over {
            let own: Vec<Row> = rows.iter().map(|r| (*r).clone()).collect();
            let ratios = over(&own, reference);
            for stage in [DrawStage::Fragment, DrawStage::Compute] {
                for ratio in ratios.iter().filter(|r| r.settings.stage == stage) {
                    add(
                        format!("{} stage", stage.name()),
                        &ratio.settings,
                        ratio.time,
                    );
                }
            }
        } else {
            for row in rows {
                let block = format!(
                    "{}, {}, {} stage",
                    row.scene,
                    row.size(),
                    row.settings.stage.name()
                );
                if let Some(time) = row.time() {
                    add(block, &row.settings, time);
                }
            }
        }
        // A picture's lines stay together.
        let picture = |line: &(String, Line)| line.0.rsplit_once(", ").map(|p| p.0.to_owned());
        let mut pages: Vec<Vec<(String, Line)>> = Vec::new();
        for group in lines.chunk_by(|a, b| picture(a) == picture(b)) {
            match pages.last_mut() {
                Some(page) if page.len() + group.len() <= DOTS => page.extend_from_slice(group),
                _ => pages.push(group.to_vec()),
            }
        }
        let axis = match self.over {
            Some(_) => format!("time / {}", context.baseline()),
            None => "time of a frame (ms)".to_owned(),
        };
        let figure = |page: Vec<(String, Line)>| {
            let mut blocks: Vec<Block> = Vec::new();
            for (name, line) in page {
                match blocks.iter_mut().find(|b| b.name == name) {
                    Some(block) => block.lines.push(line),
                    None => blocks.push(Block {
                        name,
                        lines: vec![line],
                    }),
                }
            }
            let chart = DotChart {
                title: self.title.clone(),
                axis: Axis::log(axis.as_str()),
                mark: self.over.map(|_| 1.0),
                blocks,
            };
            chart.figure()
        };
        pages.into_iter().map(figure).collect()
    }
}
