//! Parts that charts of every kind share: sizes, a sheet to draw on, titles, legends.

use super::letters::{width, wrap};
use super::style::color::GREY;
use super::style::{Dash, GRID, INK, Marker, PAPER, Style};
use super::{Anchor, Mark, Place};

/// Width of every chart, pixels: read well on a phone, where it is shown at four fifths of that.
pub(super) const WIDTH: f64 = 460.0;
pub(super) const PLOT: f64 = 330.0;
pub(super) const EDGE: f64 = 14.0;
const TITLE: f64 = 16.0;
/// Size of words at axes and in legends.
pub(super) const TEXT: f64 = 14.0;
const MARKER: f64 = 9.5;

/// The sign before a name in a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// A marker, with or without its line.
    Dot(Style, bool),
    Line(&'static str, Dash),
    /// The stroke through what is not resolved.
    Struck,
}

impl Key {
    fn width(self) -> f64 {
        match self {
            Self::Dot(_, false) | Self::Struck => 18.0,
            Self::Dot(_, true) | Self::Line(..) => 30.0,
        }
    }
}

/// The marker of a style at a place.
pub(super) fn dot(style: Style, place: Place) -> Mark {
    let (fill, stroke) = match style.filled {
        true => (style.color, (PAPER, 0.8)),
        false => (PAPER, (style.color, 1.8)),
    };
    Mark::Shape(style.corners(place, MARKER), fill, stroke)
}

/// The entry of a legend that explains the strokes.
pub(super) const UNRESOLVED: (&str, Key) = ("not resolved", Key::Struck);

/// The stroke through the marker of what is not resolved.
pub(super) fn strike((x, y): Place) -> Mark {
    let reach = 0.75 * MARKER;
    let points = vec![(x - reach, y + reach), (x + reach, y - reach)];
    Mark::Line(points, INK, 1.2, Dash::SOLID)
}

/// Marks in the making.
#[derive(Default)]
pub(super) struct Sheet(pub(super) Vec<Mark>);

impl Sheet {
    pub(super) fn line(
        &mut self,
        points: impl Into<Vec<Place>>,
        color: &'static str,
        width: f64,
        dash: Dash,
    ) {
        self.0.push(Mark::Line(points.into(), color, width, dash));
    }

    pub(super) fn word(&mut self, at: Place, text: &str, anchor: Anchor, color: &'static str) {
        self.0.push(Mark::word(at, text, TEXT, anchor, color));
    }

    /// A line of the grid, and its value below if that touches neither the one before nor the edge.
    pub(super) fn tick(&mut self, x: f64, (top, bottom): (f64, f64), text: &str, end: &mut f64) {
        self.line([(x, top), (x, bottom)], GRID, 1.0, Dash::SOLID);
        let half = width(text, TEXT) / 2.0;
        if x - half > *end + 6.0 && x + half < WIDTH {
            self.word((x, bottom + TEXT + 5.0), text, Anchor::Middle, INK);
            *end = x + half;
        }
    }

    /// The name of the axis across, below the middle of a plot, moved to stay within the figure.
    pub(super) fn axis(&mut self, (left, right): (f64, f64), bottom: f64, label: &str) {
        let half = width(label, TEXT) / 2.0;
        let middle = (left + right) / 2.0;
        let x = middle.min(WIDTH - EDGE - half).max(EDGE + half);
        self.word((x, bottom + 2.0 * TEXT + 12.0), label, Anchor::Middle, INK);
    }

    /// The title, wrapped; gives the place below it.
    pub(super) fn title(&mut self, text: &str) -> f64 {
        let mut bottom = EDGE;
        for line in wrap(text, TITLE, WIDTH - 2.0 * EDGE) {
            bottom += TITLE;
            let word = Mark::word((EDGE, bottom), &line, TITLE, Anchor::Start, INK);
            self.0.push(word);
            bottom += 5.0;
        }
        bottom
    }

    /// Names in lines as wide as the figure, each after its signs; gives the place below.
    pub(super) fn legend(&mut self, top: f64, entries: &[(String, Vec<Key>)]) -> f64 {
        let (mut x, mut y) = (EDGE, top);
        for (i, (name, keys)) in entries.iter().enumerate() {
            let signs: f64 = keys.iter().map(|key| key.width()).sum();
            let needed = signs + 4.0 + width(name, TEXT) + 14.0;
            if i > 0 && x + needed > WIDTH {
                x = EDGE;
                y += TEXT + 8.0;
            }
            let level = y + TEXT * 0.1;
            let mut left = x;
            for key in keys {
                let right = left + key.width();
                let ends = [(left, level), (right - 2.0, level)];
                match *key {
                    Key::Dot(style, joined) => {
                        if joined {
                            self.line(ends, style.color, style.line(), style.dash);
                        }
                        self.0.push(dot(style, ((left + right) / 2.0 - 1.0, level)));
                    }
                    Key::Struck => {
                        let middle = ((left + right) / 2.0 - 1.0, level);
                        self.0.push(dot(Style::new(GREY, Marker::DISK), middle));
                        self.0.push(strike(middle));
                    }
                    Key::Line(color, dash) => self.line(ends, color, 1.6, dash),
                }
                left = right;
            }
            self.word((left + 4.0, y + TEXT * 0.45), name, Anchor::Start, INK);
            x += needed;
        }
        let none = entries.is_empty();
        if none { top - TEXT } else { y + TEXT * 0.7 }
    }
}
