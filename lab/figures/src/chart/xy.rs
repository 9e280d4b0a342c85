//! Charts of points over two axes: series joined by lines, fronts, fitted laws.

use super::axis::{Axis, Scale};
use super::legend::{EDGE, Key, PLOT, Sheet, TEXT, UNRESOLVED, WIDTH, dot, strike};
use super::letters::width;
use super::style::{Dash, GRID, INK, PALE, Style};
use super::{Anchor, Bounds, Figure, Mark, Place, Word, overlap};
use crate::groups::grouped;

/// Size of words beside points.
const SMALL: f64 = 12.0;
/// From one named line to the next.
const STEP: f64 = 22.0;

/// A point of a series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Across.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// The ends of its interval across, where they are known.
    pub spread: Option<(f64, f64)>,
    /// The ends of its interval up, where they are known.
    pub rise: Option<(f64, f64)>,
    /// True if its interval is too wide: it is struck through, and has no bars.
    pub unresolved: bool,
    /// A word beside it, where there is room.
    pub label: Option<String>,
}

impl Point {
    /// A point without an interval.
    pub fn at(x: f64, y: f64) -> Self {
        Self {
            x,
            y,
            ..Self::default()
        }
    }
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty: not listed. Series of one name share an entry there.
    pub name: String,
    /// Colour, marker and line.
    pub style: Style,
    /// Its points, in the order in which a line joins them.
    pub points: Vec<Point>,
    /// True if a line joins its points.
    pub joined: bool,
}

/// A line without markers.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Its name in the legend; empty: not listed.
    pub name: String,
    /// Its ends and bends, across and up.
    pub points: Vec<(f64, f64)>,
    /// As CSS has it.
    pub color: &'static str,
    /// Its pattern.
    pub dash: Dash,
    /// Its width, units of the figure.
    pub width: f64,
}

impl Guide {
    /// A pale, dashed line, to compare points with.
    pub fn dashed(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.to_owned(),
            points,
            color: PALE,
            dash: Dash::GUIDE,
            width: 1.8,
        }
    }
}

/// A chart of points.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // names say it
pub struct XyChart {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
    pub guides: Vec<Guide>,
}

/// The marks so far, and the places that words keep off.
#[derive(Default)]
struct Drawing {
    sheet: Sheet,
    taken: Vec<Bounds>,
}

struct Plot {
    bounds: Bounds,
    x: Scale,
    y: Scale,
}

impl Plot {
    fn at(&self, x: f64, y: f64) -> Option<Place> {
        let [left, top, right, bottom] = self.bounds;
        let (x, y) = (self.x.place(x)?, self.y.place(y)?);
        Some((left + x * (right - left), bottom - y * (bottom - top)))
    }

    /// The parts of a guide within the plot.
    fn parts(&self, guide: &Guide) -> Vec<Vec<Place>> {
        let points = guide.points.iter().filter_map(|p| self.at(p.0, p.1));
        clip(&points.collect::<Vec<_>>(), self.bounds)
    }
}

impl XyChart {
    /// Lays the chart out.
    pub fn figure(&self) -> Figure {
        let points = || self.series.iter().flat_map(|s| &s.points);
        // Intervals that are too wide must not stretch an axis.
        let ends = |p: &Point, ends: Option<(f64, f64)>| {
            let own = ends.filter(|e| !p.unresolved && e.0 > 0.0);
            own.map_or(Vec::new(), |(low, high)| vec![low, high])
        };
        let across = points().flat_map(|p| ends(p, p.spread));
        let up = points().flat_map(|p| ends(p, p.rise));
        let x = Scale::new(&self.x, points().map(|p| p.x).chain(across));
        let y = Scale::new(&self.y, points().map(|p| p.y).chain(up));
        let mut drawing = Drawing::default();
        let top = drawing.sheet.title(&self.title) + 8.0;
        let words = y.ticks.iter().map(|(_, w)| width(w, TEXT));
        let left = EDGE + TEXT + 10.0 + words.fold(0.0, f64::max) + 8.0;
        let height = match self.y.names.len() {
            0 => PLOT,
            lines => STEP * lines as f64,
        };
        let bounds = [left, top, WIDTH - EDGE, top + height];
        let plot = Plot { bounds, x, y };
        axes(&mut drawing.sheet, &plot, &self.x.label, &self.y.label);
        for guide in &self.guides {
            drawing.guide(&plot, guide);
        }
        drawing.series(&plot, &self.series);
        // A guide outside of the plot is not drawn, and not in the legend.
        let entries = self.legend(|guide| !plot.parts(guide).is_empty());
        let mut sheet = drawing.sheet;
        let bottom = sheet.legend(bounds[3] + 2.0 * TEXT + 32.0, &entries);
        Figure {
            width: WIDTH,
            height: bottom + EDGE,
            title: self.title.clone(),
            marks: sheet.0,
        }
    }

    fn legend(&self, drawn: impl Fn(&Guide) -> bool) -> Vec<(String, Vec<Key>)> {
        let line = |s: &Series| s.joined && s.points.len() > 1;
        let dot = |s: &Series| Key::Dot(s.style, line(s));
        let series = self.series.iter().map(|s| (&*s.name, dot(s)));
        let guides = self.guides.iter().filter(|g| drawn(g));
        let guides = guides.map(|g| (&*g.name, Key::Line(g.color, g.dash)));
        let mut points = self.series.iter().flat_map(|s| &s.points);
        let struck = points.any(|p| p.unresolved).then_some(UNRESOLVED);
        let all = series.chain(guides).chain(struck);
        let named = grouped(all.filter(|(name, _)| !name.is_empty()), |(name, _)| *name);
        let entry = |(name, keys): (&str, Vec<(&str, Key)>)| {
            let keys = grouped(keys, |(_, key)| *key).into_iter();
            (name.to_owned(), keys.map(|(key, _)| key).collect())
        };
        named.into_iter().map(entry).collect()
    }
}

impl Drawing {
    /// Words keep off level and upright lines.
    fn guide(&mut self, plot: &Plot, guide: &Guide) {
        for points in plot.parts(guide) {
            for w in points.windows(2) {
                let ([a, b], [upper, lower]) = ([w[0].0, w[1].0], [w[0].1, w[1].1]);
                if a == b || upper == lower {
                    let (left, top) = (a.min(b), upper.min(lower));
                    let (right, bottom) = (a.max(b), upper.max(lower));
                    let around = [left - 1.0, top - 1.0, right + 1.0, bottom + 1.0];
                    self.taken.push(around);
                }
            }
            let Guide { color, width, .. } = *guide;
            self.sheet.line(points, color, width, guide.dash);
        }
    }

    /// The intervals of a point at `(x, y)`.
    fn bars(&mut self, plot: &Plot, point: &Point, (x, y): (f64, f64), color: &'static str) {
        let [left, top, right, bottom] = plot.bounds;
        let across = |x: f64| Some((plot.at(x, point.y)?.0.clamp(left, right), y));
        let up = |y: f64| Some((x, plot.at(point.x, y)?.1.clamp(top, bottom)));
        let across = point.spread.map(|(a, b)| (across(a), across(b)));
        let up = point.rise.map(|(a, b)| (up(b), up(a)));
        for ends in [across, up] {
            let Some((Some(a), Some(b))) = ends else {
                continue;
            };
            let around = [a.0 - 1.0, a.1 - 1.0, b.0 + 1.0, b.1 + 1.0];
            self.taken.push(around);
            self.sheet.line([a, b], color, 1.2, Dash::SOLID);
        }
    }

    fn series(&mut self, plot: &Plot, all: &[Series]) {
        let (mut labels, mut dots, mut struck) = (Vec::new(), Vec::new(), Vec::new());
        for series in all {
            let style = series.style;
            let points = series.points.iter();
            let places = points.filter_map(|p| Some((plot.at(p.x, p.y)?, p)));
            let places: Vec<_> = places.collect();
            if series.joined && places.len() > 1 {
                let points: Vec<_> = places.iter().map(|(place, _)| *place).collect();
                let width = style.line();
                self.sheet.line(points, style.color, width, style.dash);
            }
            for ((x, y), point) in places {
                match point.unresolved {
                    true => struck.push(strike((x, y))),
                    false => self.bars(plot, point, (x, y), style.color),
                }
                let dot = dot(style, (x, y));
                self.taken.push(dot.bounds());
                dots.push(((style.filled, !style.heavy), dot));
                labels.extend(point.label.as_ref().map(|label| ((x, y), label)));
            }
        }
        // Hollow ones and larger ones lie below, or they would hide what is near.
        dots.sort_by_key(|(order, _)| *order);
        self.sheet.0.extend(dots.into_iter().map(|(_, dot)| dot));
        self.sheet.0.extend(struck);
        for (place, label) in labels {
            if let Some(word) = beside(place, label, plot.bounds, &self.taken) {
                self.taken.push(word.bounds());
                self.sheet.0.push(word);
            }
        }
    }
}

/// Grid, frame, ticks and names of both axes.
fn axes(sheet: &mut Sheet, plot: &Plot, x_label: &str, y_label: &str) {
    let [left, top, right, bottom] = plot.bounds;
    let mut end = f64::NEG_INFINITY;
    for (value, text) in &plot.x.ticks {
        if let Some(place) = plot.x.place(*value) {
            sheet.tick(left + place * (right - left), (top, bottom), text, &mut end);
        }
    }
    // Ticks may go up or down.
    let mut last: Option<f64> = None;
    for (value, text) in &plot.y.ticks {
        let Some(place) = plot.y.place(*value) else {
            continue;
        };
        let y = bottom - place * (bottom - top);
        sheet.line([(left, y), (right, y)], GRID, 1.0, Dash::SOLID);
        if last.is_none_or(|last| (y - last).abs() > TEXT * 1.2) {
            sheet.word((left - 7.0, y + TEXT * 0.35), text, Anchor::End, INK);
            last = Some(y);
        }
    }
    let frame = [(left, top), (left, bottom), (right, bottom)];
    sheet.line(frame, INK, 1.0, Dash::SOLID);
    sheet.axis((left, right), bottom, x_label);
    if y_label.is_empty() {
        return;
    }
    sheet.0.push(Mark::Word(Word {
        at: (EDGE + TEXT * 0.8, (top + bottom) / 2.0),
        text: y_label.to_owned(),
        size: TEXT,
        anchor: Anchor::Middle,
        color: INK,
        upwards: true,
    }));
}

/// A word beside a point, in the first of eight places that is free; none where all are taken.
fn beside((x, y): Place, text: &str, plot: Bounds, taken: &[Bounds]) -> Option<Mark> {
    let (near, up, down) = (8.0, -8.0, 8.0 + 0.76 * SMALL);
    let level = 0.35 * SMALL;
    let places = [
        (near, level, Anchor::Start),
        (0.0, up, Anchor::Middle),
        (0.0, down, Anchor::Middle),
        (-near, level, Anchor::End),
        (6.0, up, Anchor::Start),
        (6.0, down, Anchor::Start),
        (-6.0, up, Anchor::End),
        (-6.0, down, Anchor::End),
    ];
    let word = |(dx, dy, anchor)| Mark::word((x + dx, y + dy), text, SMALL, anchor, PALE);
    places.into_iter().map(word).find(|mark| {
        let b = mark.bounds();
        let inside = b[0] > plot[0] && b[1] > plot[1] && b[2] < plot[2] && b[3] < plot[3];
        // Two numbers side by side must not read as one.
        let wider = [b[0] - 4.0, b[1], b[2] + 4.0, b[3]];
        inside && !taken.iter().any(|t| overlap(*t, wider))
    })
}

/// The parts of a line within a rectangle (Liang and Barsky, segment by segment).
fn clip(points: &[Place], plot: Bounds) -> Vec<Vec<Place>> {
    let mut parts: Vec<Vec<Place>> = Vec::new();
    for pair in points.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let (dx, dy) = (q.0 - p.0, q.1 - p.1);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        let mut inside = true;
        let rooms = [p.0 - plot[0], plot[2] - p.0, p.1 - plot[1], plot[3] - p.1];
        for (step, room) in [-dx, dx, -dy, dy].into_iter().zip(rooms) {
            match step {
                0.0 => inside &= room >= 0.0,
                ..0.0 => from = from.max(room / step),
                _ => to = to.min(room / step),
            }
        }
        if !inside || from > to {
            continue;
        }
        let at = |t: f64| (p.0 + t * dx, p.1 + t * dy);
        match parts.last_mut() {
            Some(part) if from == 0.0 && part.last() == Some(&p) => part.push(at(to)),
            _ => parts.push(vec![at(from), at(to)]),
        }
    }
    parts
}

#[cfg(test)]
mod tests;
