//! Charts as plain figures of polygons, lines and words, written as SVG for pages, as PDF for
//! papers, and as PNG for places that show neither.
//!
//! Colours are a published palette for every kind of colour vision ([`style`]). Each series has a
//! marker of its own as well, so that a print in grey still reads.

pub mod axis;
pub mod dots;
pub mod front;
mod legend;
pub mod letters;
pub mod pdf;
pub mod raster;
pub mod style;
pub mod svg;
pub mod xy;

use letters::width;
use style::Dash;

/// The side of its point on which a word is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
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

/// A part of a figure; coordinates count from the upper left corner, in CSS pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A closed, filled shape.
    Shape {
        /// Its corners.
        points: Vec<(f64, f64)>,
        /// Fill, as `#rrggbb`.
        fill: &'static str,
        /// Outline.
        stroke: Option<(&'static str, f64)>,
    },
    /// An open line.
    Line {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Colour, as `#rrggbb`.
        color: &'static str,
        /// Width.
        width: f64,
        /// How it is broken.
        dash: Dash,
    },
    /// A word.
    Word {
        /// Its point, on the base line.
        at: (f64, f64),
        /// Its text.
        text: String,
        /// Height of the letters' body.
        size: f64,
        /// The side of its point.
        anchor: Anchor,
        /// Colour, as `#rrggbb`.
        color: &'static str,
        /// True if it runs upwards.
        upwards: bool,
    },
}

/// A finished figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Pixels across.
    pub width: f64,
    /// Pixels down.
    pub height: f64,
    /// Pixels of the title, above all else.
    pub top: f64,
    /// Its title, also for those who cannot see it.
    pub title: String,
    /// Its parts, those in front last.
    pub marks: Vec<Mark>,
}

/// A rectangle: left, top, right, bottom.
pub type Bounds = [f64; 4];

impl Mark {
    /// A level word.
    pub fn word(
        at: (f64, f64),
        text: &str,
        size: f64,
        anchor: Anchor,
        color: &'static str,
    ) -> Self {
        Self::Word {
            at,
            text: text.to_owned(),
            size,
            anchor,
            color,
            upwards: false,
        }
    }

    /// The rectangle that it covers.
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Shape { points, .. } | Self::Line { points, .. } => {
                let (far, near) = (f64::INFINITY, f64::NEG_INFINITY);
                points.iter().fold([far, far, near, near], |b, p| {
                    [b[0].min(p.0), b[1].min(p.1), b[2].max(p.0), b[3].max(p.1)]
                })
            }
            Self::Word {
                at,
                text,
                size,
                anchor,
                upwards,
                ..
            } => {
                let length = width(text, *size);
                let back = anchor.back(length);
                let (up, down) = (0.76 * size, 0.24 * size);
                if *upwards {
                    [at.0 - up, at.1 + back - length, at.0 + down, at.1 + back]
                } else {
                    [at.0 - back, at.1 - up, at.0 - back + length, at.1 + down]
                }
            }
        }
    }
}

/// True if two rectangles have more than an edge in common.
pub fn overlap(a: Bounds, b: Bounds) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

impl Figure {
    /// Pairs of words that cover each other, and words that reach past the figure: none in a good
    /// figure.
    pub fn faults(&self) -> Vec<String> {
        let words = self.marks.iter().filter_map(|m| match m {
            Mark::Word { text, .. } => Some((text, m.bounds())),
            _ => None,
        });
        let words: Vec<(&String, Bounds)> = words.collect();
        let mut faults = Vec::new();
        for (i, (text, b)) in words.iter().enumerate() {
            if b[0] < 0.0 || b[1] < 0.0 || b[2] > self.width || b[3] > self.height {
                faults.push(format!("{text:?} reaches past the figure"));
            }
            for (other, o) in &words[..i] {
                if overlap(*b, *o) {
                    faults.push(format!("{text:?} covers {other:?}"));
                }
            }
        }
        faults
    }
}
