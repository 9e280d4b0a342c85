//! Charts as plain figures of polygons, lines and words, written as SVG. Colours serve every kind of
//! colour vision, and each series has a marker of its own: a print in grey still reads.

pub mod axis;
pub mod dots;
pub mod front;
mod legend;
mod letters;
#[allow(missing_docs)] // names say it
pub mod style;
pub(crate) mod svg;
pub mod xy;

use letters::width;
use style::Dash;

/// The side of its point on which a word is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The right.
    Start,
    /// Centred on it.
    Middle,
    /// The left.
    End,
}

impl Anchor {
    /// How far before its point a word of this length begins.
    fn back(self, length: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5 * length,
            Self::End => length,
        }
    }
}

/// A place in CSS pixels from the upper left corner.
pub(crate) type Place = (f64, f64);

/// A part of a figure; colours are `#rrggbb`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mark {
    /// A closed shape: its corners, fill, and the colour and width of its outline.
    Shape(Vec<Place>, &'static str, (&'static str, f64)),
    /// An open line: its points, colour, width, and how it is broken.
    Line(Vec<Place>, &'static str, f64, Dash),
    Word(Word),
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Word {
    /// Its point, on the base line.
    pub(crate) at: Place,
    pub(crate) text: String,
    /// Height of the letters' body.
    pub(crate) size: f64,
    pub(crate) anchor: Anchor,
    pub(crate) color: &'static str,
    /// True if it runs upwards.
    pub(crate) upwards: bool,
}

/// A finished figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Pixels across.
    pub(crate) width: f64,
    /// Pixels down.
    pub(crate) height: f64,
    /// Its title, also for those who cannot see it.
    pub(crate) title: String,
    /// Its parts, those in front last.
    pub(crate) marks: Vec<Mark>,
}

/// A rectangle: left, top, right, bottom.
pub type Bounds = [f64; 4];

impl Mark {
    /// A level word.
    pub(crate) fn word(
        at: Place,
        text: &str,
        size: f64,
        anchor: Anchor,
        color: &'static str,
    ) -> Self {
        Self::Word(Word {
            at,
            text: text.to_owned(),
            size,
            anchor,
            color,
            upwards: false,
        })
    }

    /// The rectangle that it covers.
    pub(crate) fn bounds(&self) -> Bounds {
        let word = match self {
            Self::Shape(points, ..) | Self::Line(points, ..) => {
                let (far, near) = (f64::INFINITY, f64::NEG_INFINITY);
                return points.iter().fold([far, far, near, near], |b, p| {
                    [b[0].min(p.0), b[1].min(p.1), b[2].max(p.0), b[3].max(p.1)]
                });
            }
            Self::Word(word) => word,
        };
        let ((x, y), length) = (word.at, width(&word.text, word.size));
        let back = word.anchor.back(length);
        let (up, down) = (0.76 * word.size, 0.24 * word.size);
        match word.upwards {
            true => [x - up, y + back - length, x + down, y + back],
            false => [x - back, y - up, x - back + length, y + down],
        }
    }
}

/// True if two rectangles have more than an edge in common.
fn overlap(a: Bounds, b: Bounds) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

impl Figure {
    /// The rectangles of its shapes: of markers, those of the plot before those of the legend.
    pub fn shapes(&self) -> Vec<Bounds> {
        let shape = |m: &&Mark| matches!(m, Mark::Shape(..));
        let shapes = self.marks.iter().filter(shape);
        shapes.map(Mark::bounds).collect()
    }

    /// Its words and the rectangles that they cover.
    pub fn words(&self) -> Vec<(&str, Bounds)> {
        let words = self.marks.iter().filter_map(|m| match m {
            Mark::Word(word) => Some((word.text.as_str(), m.bounds())),
            _ => None,
        });
        words.collect()
    }

    /// Words that cover each other or reach past the figure: none in a good figure.
    pub fn faults(&self) -> Vec<String> {
        let words = self.words();
        let mut faults = Vec::new();
        for (i, (text, b)) in words.iter().enumerate() {
            if b[0] < 0.0 || b[1] < 0.0 || b[2] > self.width || b[3] > self.height {
                faults.push(format!("{text:?} reaches past the figure"));
            }
            let covered = words[..i].iter().filter(|(_, other)| overlap(*b, *other));
            faults.extend(covered.map(|(other, _)| format!("{text:?} covers {other:?}")));
        }
        faults
    }
}
