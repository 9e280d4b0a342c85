//! What charts of every kind share: sizes, titles, words, markers, legends.

use super::letters::{width, wrap};
use super::style::{Dash, INK, PAPER, Style};
use super::{Anchor, Mark};

/// Width of every chart, pixels: read well on a phone, where it is shown at four fifths of that.
pub(super) const WIDTH: f64 = 460.0;
pub(super) const PLOT: f64 = 330.0;
pub(super) const EDGE: f64 = 14.0;
/// Sizes of words.
pub(super) const TITLE: f64 = 16.0;
/// Of axes and legends.
pub(super) const TEXT: f64 = 14.0;
/// Beside points.
pub(super) const SMALL: f64 = 12.0;
pub(super) const MARKER: f64 = 9.5;

/// What stands before a name in a legend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// A marker, with or without its line.
    Dot(Style, bool),
    /// A line.
    Line(&'static str, Dash),
}

impl Key {
    fn width(self) -> f64 {
        match self {
            Self::Dot(_, false) => 18.0,
            Self::Dot(_, true) | Self::Line(..) => 30.0,
        }
    }
}

/// The title, wrapped; gives the place below it.
pub(super) fn title(marks: &mut Vec<Mark>, text: &str) -> f64 {
    let mut bottom = EDGE;
    for line in wrap(text, TITLE, WIDTH - 2.0 * EDGE) {
        bottom += TITLE;
        marks.push(word((EDGE, bottom), &line, TITLE, Anchor::Start, INK));
        bottom += 5.0;
    }
    bottom
}

pub(super) fn word(
    at: (f64, f64),
    text: &str,
    size: f64,
    anchor: Anchor,
    color: &'static str,
) -> Mark {
    Mark::Word {
        at,
        text: text.to_owned(),
        size,
        anchor,
        color,
        upwards: false,
    }
}

pub(super) fn dot(style: Style, (x, y): (f64, f64)) -> Mark {
    let (fill, stroke) = if style.filled {
        (style.color, (PAPER, 0.8))
    } else {
        (PAPER, (style.color, 1.8))
    };
    Mark::Shape {
        points: style.corners(x, y, MARKER),
        fill,
        stroke: Some(stroke),
    }
}

/// Names in lines as wide as the figure, each after its signs; gives the place below.
pub(super) fn legend(marks: &mut Vec<Mark>, top: f64, entries: &[(String, Vec<Key>)]) -> f64 {
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
            let line = |color, width, dash| Mark::Line {
                points: vec![(left, level), (right - 2.0, level)],
                color,
                width,
                dash,
            };
            match key {
                Key::Dot(style, joined) => {
                    if *joined {
                        marks.push(line(style.color, style.line(), style.dash));
                    }
                    marks.push(dot(*style, ((left + right) / 2.0 - 1.0, level)));
                }
                Key::Line(color, dash) => marks.push(line(color, 1.6, *dash)),
            }
            left = right;
        }
        marks.push(word(
            (left + 4.0, y + TEXT * 0.45),
            name,
            TEXT,
            Anchor::Start,
            INK,
        ));
        x += needed;
    }
    if entries.is_empty() {
        top - TEXT
    } else {
        y + TEXT * 0.7
    }
}
