//! Charts of one value a line, each a marker on its interval: times and ratios side by side.

use super::axis::{Axis, Scale};
use super::legend::{EDGE, Sheet, TEXT, UNRESOLVED, WIDTH, dot, strike};
use super::letters::width;
use super::style::{Dash, INK, PALE, Style};
use super::{Anchor, Figure};
use crate::measure::stats::Interval;
use crate::plan::grouped;
use crate::plan::names::number;

/// Lines on one page.
const MOST: usize = 44;

/// One line of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub name: String,
    pub value: Interval,
    pub style: Style,
    /// True if its interval is too wide: it is struck through, and its number in brackets.
    pub unresolved: bool,
}

impl Line {
    fn number(&self) -> String {
        let value = number(self.value.value, 3);
        match self.unresolved {
            true => format!("({value})"),
            false => value,
        }
    }
}

/// A line, the heading above it, and what it belongs to: lines of one thing stay on one page.
pub type Placed = ((String, String), Line);

/// Charts of these lines, as many as they need; `mark`: a value to which all are compared.
pub fn pages(title: &str, axis: &str, mark: Option<f64>, lines: &[Placed]) -> Vec<Figure> {
    let mut pages: Vec<Vec<Placed>> = Vec::new();
    for group in lines.chunk_by(|a, b| a.0.1 == b.0.1) {
        match pages.last_mut() {
            Some(page) if page.len() + group.len() <= MOST => page.extend_from_slice(group),
            _ => pages.push(group.to_vec()),
        }
    }
    let figure = |page: Vec<Placed>| {
        let blocks = grouped(page, |line| line.0.0.clone()).into_iter();
        let block = |(name, lines): (_, Vec<Placed>)| {
            (name, lines.into_iter().map(|line| line.1).collect())
        };
        let chart = DotChart {
            title: title.to_owned(),
            axis: Axis::log(axis),
            mark,
            blocks: blocks.map(block).collect(),
        };
        chart.figure()
    };
    pages.into_iter().map(figure).collect()
}

/// A chart of values with intervals.
struct DotChart {
    title: String,
    axis: Axis,
    mark: Option<f64>,
    /// Lines below their headings, which may be empty.
    blocks: Vec<(String, Vec<Line>)>,
}

const STEP: f64 = 22.0;

impl DotChart {
    fn figure(&self) -> Figure {
        let lines = || self.blocks.iter().flat_map(|b| &b.1);
        // An interval without an end or too wide must not stretch the axis.
        let ends = lines().flat_map(|l| {
            let ends = l.value.ends().filter(|_| !l.unresolved);
            let (low, high) = ends.unwrap_or((l.value.value, l.value.value));
            [low, l.value.value, high]
        });
        let scale = Scale::new(&self.axis, ends.chain(self.mark));
        let mut sheet = Sheet::default();
        let top = sheet.title(&self.title) + 6.0;
        let widest = |of: &dyn Fn(&Line) -> f64| lines().map(of).fold(0.0, f64::max);
        let names = widest(&|l| width(&l.name, TEXT));
        let values = widest(&|l| width(&l.number(), TEXT));
        let left = (EDGE + names + 12.0).min(WIDTH * 0.55);
        let right = WIDTH - EDGE - values - 14.0;
        let at = |v: f64| Some((left + scale.place(v)? * (right - left)).clamp(left, right));
        let heads = self.blocks.iter().filter(|b| !b.0.is_empty()).count();
        let bottom = top + STEP * (heads + lines().count()) as f64 + 6.0;
        let mut end = f64::NEG_INFINITY;
        for (value, text) in &scale.ticks {
            if let Some(x) = at(*value) {
                sheet.tick(x, (top, bottom), text, &mut end);
            }
        }
        if let Some(x) = self.mark.and_then(at) {
            sheet.line([(x, top), (x, bottom)], PALE, 1.5, Dash::GUIDE);
        }
        sheet.line([(left, bottom), (right, bottom)], INK, 1.0, Dash::SOLID);
        self.lines(&mut sheet, (top, left), at);
        sheet.axis((left, right), bottom, &self.axis.label);
        let mut end = bottom + 2.0 * TEXT + 16.0;
        if lines().any(|l| l.unresolved) {
            let (name, key) = UNRESOLVED;
            end = sheet.legend(end + TEXT, &[(name.to_owned(), vec![key])]);
        }
        Figure {
            width: WIDTH,
            height: end + EDGE,
            title: self.title.clone(),
            marks: sheet.0,
        }
    }

    /// The lines below `top`, each with its name before `left`, its dot and its number.
    fn lines(&self, sheet: &mut Sheet, (top, left): (f64, f64), at: impl Fn(f64) -> Option<f64>) {
        let mut y = top;
        for (name, lines) in &self.blocks {
            if !name.is_empty() {
                y += STEP;
                sheet.word((EDGE, y - 5.0), name, Anchor::Start, PALE);
            }
            for line in lines {
                y += STEP;
                let level = y - STEP / 2.0 + 2.0;
                let base = level + 0.35 * TEXT;
                sheet.word((left - 10.0, base), &line.name, Anchor::End, INK);
                sheet.word((WIDTH - EDGE, base), &line.number(), Anchor::End, INK);
                let ends = line.value.ends();
                if let Some((Some(a), Some(b))) = ends.map(|(low, high)| (at(low), at(high))) {
                    let width = if line.style.heavy { 3.0 } else { 2.0 };
                    let ends = [(a, level), (b, level)];
                    sheet.line(ends, line.style.color, width, Dash::SOLID);
                }
                if let Some(x) = at(line.value.value) {
                    sheet.0.push(dot(line.style, (x, level)));
                    if line.unresolved {
                        sheet.0.push(strike((x, level)));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::style::{Marker, color};
    use super::*;

    fn chart(values: &[f64]) -> DotChart {
        let line = |(k, v): (usize, &f64)| Line {
            name: format!("search {k}, of several words"),
            value: Interval::new(*v, v * 0.9, if k == 1 { f64::INFINITY } else { v * 1.2 }),
            style: Style {
                filled: k % 2 == 0,
                ..Style::new(color::ALL[k], Marker::ALL[k])
            },
            unresolved: k == 1,
        };
        let block = |name: &str| {
            let lines = values.iter().enumerate().map(line);
            (name.to_owned(), lines.collect())
        };
        DotChart {
            title: "Time over that of the RBM baseline".into(),
            axis: Axis::log("time / time of the RBM baseline"),
            mark: Some(1.0),
            blocks: ["fragment", ""].map(block).to_vec(),
        }
    }

    #[test]
    fn no_words_cover_each_other() {
        let many = [0.2, 0.5, 1.0, 1.4];
        for values in [&many[..], &[1.0], &[1e-3, 1e3], &[20.0, 21.0, 22.0]] {
            let faults = chart(values).figure().faults();
            assert_eq!(faults, [""; 0], "{values:?}");
        }
    }

    #[test]
    fn slower_stands_further_right() {
        let figure = chart(&[0.2, 0.5, 1.4]).figure();
        let dots = figure.shapes();
        assert!(dots[0][0] < dots[1][0] && dots[1][0] < dots[2][0]);
        assert!((dots[0][0] - dots[3][0]).abs() < 1e-9);
    }
}
