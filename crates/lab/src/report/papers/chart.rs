//! A table of frame rates as a chart, the published line among those measured.

use super::{Printed, SIZES, lines};
use crate::report::chart::Figure;
use crate::report::chart::axis::Axis;
use crate::report::chart::xy::{Guide, Point, Series, XyChart};
use crate::report::row::Row;
use crate::report::series_style::SeriesStyles;

/// How a chart of a table shows rates.
#[derive(Clone, Copy)]
pub(super) enum Scaled {
    /// As frames per second, beside the published ones.
    Rate,
    /// Over the first of each line: what can be compared with what was published.
    Trend,
}

impl Scaled {
    /// Its name in files.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Rate => "rates",
            Self::Trend => "trend",
        }
    }

    /// What stands below it.
    pub(super) fn caption(self, letter: char) -> String {
        match self {
            Self::Rate => format!(
                "Frames per second as {letter} grows; each line is a method in one stage, filled markers for fragment and hollow ones for compute. The dashed line was published for a GeForce GT 630M and a solid \
                 that is not named: its height against ours tells of device and picture, not of methods."
            ),
            Self::Trend => format!(
                "The same rates, each over its own at the smallest {letter}: lines that rise get faster. This can be compared with the published figures, the dashed line."
            ),
        }
    }
}

/// A table as a chart; `None` where nothing of it was measured at this size.
pub(super) fn chart(
    table: &Printed,
    index: usize,
    rows: &[Row],
    size: (u32, u32),
    styles: &SeriesStyles,
    scale: Scaled,
) -> Option<Figure> {
    let over = |rates: [Option<f64>; 3]| -> Option<Vec<(f64, f64)>> {
        let unit = match scale {
            Scaled::Rate => 1.0,
            Scaled::Trend => rates[0]?,
        };
        let points = table.values.iter().zip(rates);
        Some(
            points
                .filter_map(|(x, rate)| Some((*x, rate? / unit)))
                .collect(),
        )
    };
    let mut series = Vec::new();
    for line in lines(rows, index).iter().filter(|l| l.size == size) {
        let rates = line
            .rows
            .map(|row| Some(1e3 / row.and_then(|r| r.time())?.value));
        let Some(points) = over(rates).filter(|p| !p.is_empty()) else {
            continue;
        };
        let point = |(x, y)| Point {
            x,
            y,
            spread: None,
            label: None,
        };
        series.push(Series {
            name: styles.way(&line.way),
            style: styles.style(&line.way),
            points: points.into_iter().map(point).collect(),
            joined: true,
        });
    }
    let place = SIZES.iter().position(|s| *s == size)?;
    if series.is_empty() {
        return None;
    }
    let published = over(table.rates[place].map(Some))?;
    let y = match scale {
        // The published line has to be in sight.
        Scaled::Rate => table.rates[place]
            .iter()
            .fold(Axis::log("frames per second"), |axis, rate| {
                axis.with(*rate)
            }),
        Scaled::Trend => published
            .iter()
            .fold(Axis::linear("rate / rate at the first value"), |a, p| {
                a.with(p.1)
            }),
    };
    let unit = match table.letter {
        'c' => "share of the depth",
        _ => "of the largest distance",
    };
    let figure = XyChart {
        title: format!(
            "Table {}: {}, {}x{}",
            table.number, table.title, size.0, size.1
        ),
        x: Axis::linear(format!("{} ({unit})", table.letter)).at(table.values),
        y,
        series,
        guides: vec![Guide::dashed("published, GeForce GT 630M", published)],
    };
    Some(figure.figure())
}
