//! Charts of one value a line, each a marker on its interval: times and ratios side by side.

use super::Figure;
use super::axis::Axis;
use super::style::Style;
use super::xy::{Guide, Point, Series, XyChart};
use crate::groups::grouped;
use crate::names::number;
use crate::stats::Interval;

/// Lines on one page.
const MOST: usize = 44;

/// One line of a chart.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // names say it
pub struct Line {
    pub name: String,
    pub value: Interval,
    pub style: Style,
    /// True if its interval is too wide: it is struck through, and its number in brackets.
    pub unresolved: bool,
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
        let (mut names, mut series) = (Vec::new(), Vec::new());
        for (heading, own) in grouped(page, |line| line.0.0.clone()) {
            names.extend(Some(heading).filter(|heading| !heading.is_empty()));
            for (_, line) in own {
                series.push(line.series(names.len()));
                names.push(line.named());
            }
        }
        let ends = [0.5, -(names.len() as f64)];
        let guide = |x: f64| Guide::dashed("", ends.map(|y| (x, y)).to_vec());
        let mut x = Axis::log(axis);
        x.include.extend(mark);
        let chart = XyChart {
            title: title.to_owned(),
            x,
            y: Axis::names(names),
            series,
            guides: mark.map(guide).into_iter().collect(),
        };
        chart.figure()
    };
    pages.into_iter().map(figure).collect()
}

impl Line {
    /// Its name and its value, in brackets if that is not resolved.
    fn named(&self) -> String {
        let (name, value) = (&self.name, number(self.value.value, 3));
        match self.unresolved {
            true => format!("{name}: ({value})"),
            false => format!("{name}: {value}"),
        }
    }

    /// Its dot in the line of a number.
    fn series(&self, place: usize) -> Series {
        let point = Point {
            spread: self.value.ends(),
            unresolved: self.unresolved,
            ..Point::at(self.value.value, -(place as f64))
        };
        Series {
            name: String::new(),
            style: self.style,
            points: vec![point],
            joined: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(values: &[f64]) -> Figure {
        let line = |heading: &str, (k, v): (usize, &f64)| {
            let value = Interval::new(*v, v * 0.9, if k == 1 { f64::INFINITY } else { v * 1.2 });
            let line = Line {
                name: format!("search {k}, of several words"),
                value,
                style: Style::numbered(k),
                unresolved: k == 1,
            };
            ((heading.to_owned(), String::new()), line)
        };
        let blocks = ["fragment", ""].map(|b| values.iter().enumerate().map(move |l| line(b, l)));
        let lines: Vec<Placed> = blocks.into_iter().flatten().collect();
        let title = "Time over that of the RBM baseline";
        pages(title, "time / time of the RBM baseline", Some(1.0), &lines).remove(0)
    }

    #[test]
    fn no_words_cover_each_other_and_slower_stands_further_right() {
        let many = [0.2, 0.5, 1.0, 1.4];
        for values in [&many[..], &[1.0], &[1e-3, 1e3], &[20.0, 21.0, 22.0]] {
            assert_eq!(figure(values).faults(), [""; 0], "{values:?}");
        }
        let drawn = figure(&[0.2, 0.5, 1.4]);
        // Every line has its name, those of the second block, too.
        assert_eq!(
            crate::chart::svg::svg(&drawn)
                .matches("of several words")
                .count(),
            6
        );
        let dots = drawn.shapes();
        assert!(dots[0][0] < dots[1][0] && dots[1][0] < dots[2][0]);
        assert!((dots[0][0] - dots[3][0]).abs() < 1e-9);
    }
}
