//! Charts of points over two axes: series joined by lines, fronts, fitted laws.

use super::axis::{Axis, Scale};
use super::legend::{EDGE, Key, PLOT, SMALL, TEXT, WIDTH, dot, legend, title, word};
use super::letters::width;
use super::style::{Dash, GRID, INK, PALE, Style};
use super::{Anchor, Bounds, Figure, Mark, overlap};

/// A point of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Across.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// The ends of its interval across, where they are known.
    pub spread: Option<(f64, f64)>,
    /// A word beside it, where there is room.
    pub label: Option<String>,
}

/// Points of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; empty: not listed. Series of one name share an entry there.
    pub name: String,
    /// How it looks.
    pub style: Style,
    /// Its points, in the order in which a line joins them.
    pub points: Vec<Point>,
    /// Whether a line joins them.
    pub joined: bool,
}

/// A line without markers.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Its name in the legend; empty: not listed.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Colour.
    pub color: &'static str,
    /// How it is broken.
    pub dash: Dash,
    /// Width, pixels.
    pub width: f64,
}

impl Guide {
    /// A pale, dashed line, to compare points with.
    pub(crate) fn dashed(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.to_owned(),
            points,
            color: PALE,
            dash: Dash::Guide,
            width: 1.8,
        }
    }
}

/// A chart of points.
#[derive(Clone, Debug, PartialEq)]
pub struct XyChart {
    /// What it shows.
    pub title: String,
    /// Across.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// The points.
    pub series: Vec<Series>,
    /// Lines below them.
    pub guides: Vec<Guide>,
}

impl XyChart {
    /// Lays the chart out.
    #[must_use]
    pub fn figure(&self) -> Figure {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let x = Scale::new(&self.x, points().map(|p| p.x));
        let y = Scale::new(&self.y, points().map(|p| p.y));
        let mut marks = Vec::new();
        let top = title(&mut marks, &self.title) + 8.0;
        let widest = y
            .ticks
            .iter()
            .map(|(_, w)| width(w, TEXT))
            .fold(0.0, f64::max);
        let left = EDGE + TEXT + 10.0 + widest + 8.0;
        let plot = [left, top, WIDTH - EDGE, top + PLOT];
        let at = |px: f64, py: f64| -> Option<(f64, f64)> {
            Some((
                plot[0] + x.place(px)? * (plot[2] - plot[0]),
                plot[3] - y.place(py)? * (plot[3] - plot[1]),
            ))
        };
        axes(&mut marks, plot, (&self.x.label, &x), (&self.y.label, &y));

        // Words keep off markers, each other, and level or upright lines.
        let mut taken: Vec<Bounds> = Vec::new();
        for guide in &self.guides {
            let points: Vec<_> = guide.points.iter().filter_map(|p| at(p.0, p.1)).collect();
            let straight = points
                .windows(2)
                .filter(|w| w[0].0 == w[1].0 || w[0].1 == w[1].1);
            taken.extend(straight.map(|w| {
                [
                    w[0].0.min(w[1].0) - 1.0,
                    w[0].1.min(w[1].1) - 1.0,
                    w[0].0.max(w[1].0) + 1.0,
                    w[0].1.max(w[1].1) + 1.0,
                ]
            }));
            for points in clip(&points, plot) {
                marks.push(Mark::Line {
                    points,
                    color: guide.color,
                    width: guide.width,
                    dash: guide.dash,
                });
            }
        }
        let mut labels = Vec::new();
        let mut dots = Vec::new();
        for series in &self.series {
            let places: Vec<_> = series
                .points
                .iter()
                .filter_map(|p| Some((at(p.x, p.y)?, p)))
                .collect();
            if series.joined && places.len() > 1 {
                let points = places.iter().map(|(place, _)| *place).collect();
                marks.push(Mark::Line {
                    points,
                    color: series.style.color,
                    width: series.style.line(),
                    dash: series.style.dash,
                });
            }
            for (place, point) in places {
                let ends = point.spread.and_then(|(a, b)| {
                    let level = |x: f64| Some((at(x, point.y)?.0.clamp(plot[0], plot[2]), place.1));
                    Some(vec![level(a)?, level(b)?])
                });
                if let Some(points) = ends {
                    taken.push([points[0].0, place.1 - 1.0, points[1].0, place.1 + 1.0]);
                    marks.push(Mark::Line {
                        points,
                        color: series.style.color,
                        width: 1.2,
                        dash: Dash::Solid,
                    });
                }
                let dot = dot(series.style, place);
                taken.push(dot.bounds());
                dots.push(((series.style.filled, !series.style.heavy), dot));
                if let Some(label) = &point.label {
                    labels.push((place, label));
                }
            }
        }
        // Hollow ones below filled ones and larger ones below smaller ones, or they would hide what
        // is near.
        dots.sort_by_key(|(order, _)| *order);
        marks.extend(dots.into_iter().map(|(_, dot)| dot));
        for (place, label) in labels {
            if let Some(word) = beside(place, label, plot, &taken) {
                taken.push(word.bounds());
                marks.push(word);
            }
        }
        // What lies outside of the plot is not drawn, and not told.
        let drawn = |g: &Guide| {
            let points: Vec<_> = g.points.iter().filter_map(|p| at(p.0, p.1)).collect();
            !clip(&points, plot).is_empty()
        };
        let entries = self.legend(drawn);
        let bottom = legend(&mut marks, plot[3] + 2.0 * TEXT + 32.0, &entries);
        Figure {
            width: WIDTH,
            height: bottom + EDGE,
            top: top - 8.0,
            title: self.title.clone(),
            marks,
        }
    }

    fn legend(&self, drawn: impl Fn(&Guide) -> bool) -> Vec<(String, Vec<Key>)> {
        let series = self.series.iter().map(|s| {
            (
                s.name.clone(),
                Key::Dot(s.style, s.joined && s.points.len() > 1),
            )
        });
        let guides = self
            .guides
            .iter()
            .filter(|g| drawn(g))
            .map(|g| (g.name.clone(), Key::Line(g.color, g.dash)));
        let mut all: Vec<(String, Vec<Key>)> = Vec::new();
        for (name, key) in series.chain(guides).filter(|(name, _)| !name.is_empty()) {
            match all.iter_mut().find(|(known, _)| *known == name) {
                Some((_, keys)) if keys.contains(&key) => {}
                Some((_, keys)) => keys.push(key),
                None => all.push((name, vec![key])),
            }
        }
        all
    }
}

/// Grid, frame, ticks and names of both axes.
fn axes(
    marks: &mut Vec<Mark>,
    plot: Bounds,
    (x_label, x): (&str, &Scale),
    (y_label, y): (&str, &Scale),
) {
    let line = |points, color| Mark::Line {
        points,
        color,
        width: 1.0,
        dash: Dash::Solid,
    };
    let mut end = f64::NEG_INFINITY;
    for (value, text) in &x.ticks {
        let Some(place) = x.place(*value) else {
            continue;
        };
        let px = plot[0] + place * (plot[2] - plot[0]);
        marks.push(line(vec![(px, plot[1]), (px, plot[3])], GRID));
        // A word that would touch the last one, or leave the figure, is left out; its line stays.
        let half = width(text, TEXT) / 2.0;
        if px - half > end + 6.0 && px + half < WIDTH {
            marks.push(word(
                (px, plot[3] + TEXT + 5.0),
                text,
                TEXT,
                Anchor::Middle,
                INK,
            ));
            end = px + half;
        }
    }
    let mut end = f64::INFINITY;
    for (value, text) in &y.ticks {
        let Some(place) = y.place(*value) else {
            continue;
        };
        let py = plot[3] - place * (plot[3] - plot[1]);
        marks.push(line(vec![(plot[0], py), (plot[2], py)], GRID));
        if py + TEXT * 0.6 < end {
            marks.push(word(
                (plot[0] - 7.0, py + TEXT * 0.35),
                text,
                TEXT,
                Anchor::End,
                INK,
            ));
            end = py - TEXT * 0.6;
        }
    }
    marks.push(line(
        vec![(plot[0], plot[1]), (plot[0], plot[3]), (plot[2], plot[3])],
        INK,
    ));
    let middle = (plot[0] + plot[2]) / 2.0;
    // A long name is moved so that it stays within the figure.
    let half = width(x_label, TEXT) / 2.0;
    let at = middle.min(WIDTH - EDGE - half).max(EDGE + half);
    marks.push(word(
        (at, plot[3] + 2.0 * TEXT + 12.0),
        x_label,
        TEXT,
        Anchor::Middle,
        INK,
    ));
    marks.push(Mark::Word {
        at: (EDGE + TEXT * 0.8, (plot[1] + plot[3]) / 2.0),
        text: y_label.to_owned(),
        size: TEXT,
        anchor: Anchor::Middle,
        color: INK,
        upwards: true,
    });
}

/// A word beside a point, in the first of eight places that is free; none where all are taken.
fn beside((x, y): (f64, f64), text: &str, plot: Bounds, taken: &[Bounds]) -> Option<Mark> {
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
    places
        .into_iter()
        .map(|(dx, dy, anchor)| word((x + dx, y + dy), text, SMALL, anchor, PALE))
        .find(|mark| {
            let b = mark.bounds();
            b[0] > plot[0]
                && b[1] > plot[1]
                && b[2] < plot[2]
                && b[3] < plot[3]
                // Two numbers side by side must not read as one.
                && !taken.iter().any(|t| overlap(*t, [b[0] - 4.0, b[1], b[2] + 4.0, b[3]]))
        })
}

/// The parts of a line within a rectangle (Liang and Barsky, segment by segment).
fn clip(points: &[(f64, f64)], plot: Bounds) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    for pair in points.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let (dx, dy) = (q.0 - p.0, q.1 - p.1);
        let (mut from, mut to) = (0.0f64, 1.0f64);
        let mut inside = true;
        for (step, room) in [
            (-dx, p.0 - plot[0]),
            (dx, plot[2] - p.0),
            (-dy, p.1 - plot[1]),
            (dy, plot[3] - p.1),
        ] {
            if step == 0.0 {
                inside &= room >= 0.0;
            } else if step < 0.0 {
                from = from.max(room / step);
            } else {
                to = to.min(room / step);
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
