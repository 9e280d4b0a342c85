//! Charts of one value a line, each a marker on its interval: times and ratios side by side.

use super::axis::{Axis, Scale};
use super::legend::{TEXT, WIDTH, dot, title, word};
use super::letters::width;
use super::style::{Dash, GRID, INK, PALE, Style};
use super::{Anchor, Figure, Mark};
use crate::report::names::number;
use crate::report::stats::Interval;

/// One line of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is.
    pub name: String,
    /// Its value.
    pub value: Interval,
    /// How its marker looks.
    pub style: Style,
}

/// Lines under a common heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The heading; may be empty.
    pub name: String,
    /// The lines.
    pub lines: Vec<Line>,
}

/// A chart of values with intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct DotChart {
    /// What it shows.
    pub title: String,
    /// The axis across.
    pub axis: Axis,
    /// A value to which all are compared.
    pub mark: Option<f64>,
    /// The lines.
    pub blocks: Vec<Block>,
}

const EDGE: f64 = 14.0;
const STEP: f64 = 22.0;

impl DotChart {
    /// Lays the chart out.
    #[must_use]
    pub fn figure(&self) -> Figure {
        let lines = || self.blocks.iter().flat_map(|b| &b.lines);
        // An interval without an end says nothing and must not stretch the axis.
        let ends = lines().flat_map(|l| {
            let i = l.value;
            if i.high.is_finite() {
                [i.low, i.value, i.high]
            } else {
                [i.value; 3]
            }
        });
        let scale = Scale::new(&self.axis, ends.chain(self.mark));
        let mut marks = Vec::new();
        let top = title(&mut marks, &self.title) + 6.0;
        let names = lines().map(|l| width(&l.name, TEXT)).fold(0.0, f64::max);
        let values = lines()
            .map(|l| width(&number(l.value.value, 3), TEXT))
            .fold(0.0, f64::max);
        let left = (EDGE + names + 12.0).min(WIDTH * 0.55);
        let right = WIDTH - EDGE - values - 14.0;
        let at = |v: f64| Some(left + scale.place(v)? * (right - left));
        let count = self
            .blocks
            .iter()
            .map(|b| b.lines.len() + usize::from(!b.name.is_empty()))
            .sum::<usize>();
        let bottom = top + STEP * count as f64 + 6.0;
        let straight = |points, color, width, dash| Mark::Line {
            points,
            color,
            width,
            dash,
        };

        let mut end = f64::NEG_INFINITY;
        for (value, text) in &scale.ticks {
            let Some(x) = at(*value) else { continue };
            marks.push(straight(
                vec![(x, top), (x, bottom)],
                GRID,
                1.0,
                Dash::Solid,
            ));
            let half = width(text, TEXT) / 2.0;
            if x - half > end + 6.0 {
                marks.push(word(
                    (x, bottom + TEXT + 4.0),
                    text,
                    TEXT,
                    Anchor::Middle,
                    INK,
                ));
                end = x + half;
            }
        }
        if let Some(x) = self.mark.and_then(at) {
            marks.push(straight(
                vec![(x, top), (x, bottom)],
                PALE,
                1.5,
                Dash::Guide,
            ));
        }
        marks.push(straight(
            vec![(left, bottom), (right, bottom)],
            INK,
            1.0,
            Dash::Solid,
        ));
        let mut y = top;
        for block in &self.blocks {
            if !block.name.is_empty() {
                y += STEP;
                marks.push(word(
                    (EDGE, y - 5.0),
                    &block.name,
                    TEXT,
                    Anchor::Start,
                    PALE,
                ));
            }
            for line in &block.lines {
                y += STEP;
                let level = y - STEP / 2.0 + 2.0;
                marks.push(word(
                    (left - 10.0, level + 0.35 * TEXT),
                    &line.name,
                    TEXT,
                    Anchor::End,
                    INK,
                ));
                marks.push(word(
                    (WIDTH - EDGE, level + 0.35 * TEXT),
                    &number(line.value.value, 3),
                    TEXT,
                    Anchor::End,
                    INK,
                ));
                let i = line.value;
                if let (true, Some(a), Some(b)) = (i.high.is_finite(), at(i.low), at(i.high)) {
                    marks.push(straight(
                        vec![(a, level), (b, level)],
                        line.style.color,
                        if line.style.heavy { 3.0 } else { 2.0 },
                        Dash::Solid,
                    ));
                }
                if let Some(x) = at(i.value) {
                    marks.push(dot(line.style, (x, level)));
                }
            }
        }
        let half = width(&self.axis.label, TEXT) / 2.0;
        let middle = ((left + right) / 2.0)
            .min(WIDTH - EDGE - half)
            .max(EDGE + half);
        marks.push(word(
            (middle, bottom + 2.0 * TEXT + 10.0),
            &self.axis.label,
            TEXT,
            Anchor::Middle,
            INK,
        ));
        Figure {
            width: WIDTH,
            height: bottom + 2.0 * TEXT + 14.0 + EDGE,
            top: top - 6.0,
            title: self.title.clone(),
            marks,
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
            value: Interval {
                value: *v,
                low: v * 0.9,
                high: if k == 1 { f64::INFINITY } else { v * 1.2 },
            },
            style: Style {
                filled: k % 2 == 0,
                ..Style::new(color::ALL[k], Marker::ALL[k])
            },
        };
        DotChart {
            title: "Time over that of the RBM baseline".into(),
            axis: Axis::log("time / time of the RBM baseline"),
            mark: Some(1.0),
            blocks: vec![
                Block {
                    name: "fragment".into(),
                    lines: values.iter().enumerate().map(line).collect(),
                },
                Block {
                    name: String::new(),
                    lines: values.iter().enumerate().map(line).collect(),
                },
            ],
        }
    }

    #[test]
    fn no_words_cover_each_other() {
        for values in [
            &[0.2, 0.5, 1.0, 1.4][..],
            &[1.0],
            &[1e-3, 1e3],
            &[20.0, 21.0, 22.0],
        ] {
            assert_eq!(
                chart(values).figure().faults(),
                Vec::<String>::new(),
                "{values:?}"
            );
        }
    }

    #[test]
    fn slower_stands_further_right() {
        let figure = chart(&[0.2, 0.5, 1.4]).figure();
        let dots: Vec<f64> = figure
            .marks
            .iter()
            .filter(|m| matches!(m, Mark::Shape { .. }))
            .map(|m| m.bounds()[0])
            .collect();
        assert!(dots[0] < dots[1] && dots[1] < dots[2] && (dots[0] - dots[3]).abs() < 1e-9);
    }
}
