//! Outlines as drawings of a few curves, which can be changed by hand and read again.

use crate::profile::FLATNESS;
use crate::{ProfileAxis, profile_from_bytes, write_bytes};
use glam::DVec2;
use kurbo::PathEl;
use revmap::error::{Error, ErrorKind, Result};
use revmap::profile::{FillRule, Grid, Outline, Profile, Region, Segment};
use std::fmt::Write as _;
use std::path::Path;

/// Units of the drawing for one object unit.
const UNIT: f64 = 1000.0;
/// Least tolerance, object units: coordinates are written to 1e-9.
const FINEST: f64 = 1e-7;
/// Rounds of better parameters for a curve.
const ROUNDS: usize = 8;

/// A drawing that [`write_outline`] has written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrittenOutline {
    /// Number of straight lines.
    pub lines: usize,
    /// Number of cubic curves.
    pub curves: usize,
    /// The area that is solid in one of profile and drawing alone, as a part of the profile's. It is
    /// large if parts of the profile are thinner than the tolerance.
    pub changed: f64,
}

/// Writes the outline of a profile as an SVG drawing of lines and cubic curves. Read again, it is
/// nowhere farther than `tolerance` object units from the profile's. The right half is one path. The
/// left half refers to it, so that only one is changed.
///
/// It is read with [`ProfileAxis::Center`](crate::ProfileAxis::Center).
///
/// # Errors
/// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) for a tolerance below 1e-7, or one that
/// leaves no drawing that can be read,
/// [`ErrorKind::File`](revmap::error::ErrorKind::File) if the file cannot be written.
pub fn write_outline(
    profile: &Profile,
    path: impl AsRef<Path>,
    tolerance: f64,
) -> Result<WrittenOutline> {
    let path = path.as_ref();
    let refused = |message| Err(Error::new(ErrorKind::Usage, message).at_key("tolerance"));
    if tolerance.is_nan() || tolerance < FINEST {
        return refused(format!(
            "is {tolerance}; give {FINEST} object units or more"
        ));
    }
    let pieces = profile
        .outline
        .loops
        .iter()
        .map(|points| pieces(points, tolerance));
    let pieces: Vec<Vec<Piece>> = pieces.filter(|pieces| !pieces.is_empty()).collect();
    let is_curve = |piece: &&Piece| piece.handles.is_some();
    let curves = pieces.iter().flatten().filter(is_curve).count();
    let lines = pieces.iter().flatten().count() - curves;
    let text = text(profile, &pieces);
    let again = match profile_from_bytes(text.as_bytes(), ProfileAxis::Center) {
        Ok(again) => again,
        Err(_) => {
            return refused(format!(
                "is {tolerance}, which leaves no shape; give a smaller one"
            ));
        }
    };
    write_bytes(path, text.as_bytes())?;
    Ok(WrittenOutline {
        lines,
        curves,
        changed: difference(&profile.outline, &again.outline) / profile.outline.area(),
    })
}

/// The area that is within one of two outlines.
fn difference(a: &Outline, b: &Outline) -> f64 {
    let points = [a, b].map(|outline| outline.loops.iter().flatten());
    let reach = points.into_iter().flatten();
    let reach = reach.fold(1.0, |m: f64, p| m.max(p.abs().max_element()));
    let grid = Grid::for_extent(reach);
    let [a, b] = [a, b].map(|o| Region::enclosed(grid, &o.loops, FillRule::NonZero));
    [a.difference(&b), b.difference(&a)]
        .iter()
        .map(|part| part.outline(grid).area())
        .sum()
}

/// A line or a cubic curve to `end`.
struct Piece {
    handles: Option<[DVec2; 2]>,
    end: DVec2,
}

fn text(profile: &Profile, loops: &[Vec<Piece>]) -> String {
    let middle = profile.radius * UNIT;
    let place = |p: DVec2| {
        let short = |v: f64| {
            let text = format!("{v:.6}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        format!("{},{}", short(p.x * UNIT), short((1.0 - p.y) * UNIT))
    };
    let mut data = String::new();
    for pieces in loops {
        let start = pieces.last().map_or(DVec2::ZERO, |piece| piece.end);
        let _ = write!(data, "M{}", place(start));
        for piece in pieces {
            let _ = match piece.handles {
                Some([a, b]) => write!(data, "\n C{} {} {}", place(a), place(b), place(piece.end)),
                None => write!(data, "\n L{}", place(piece.end)),
            };
        }
        data.push_str("\n Z");
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 {} {UNIT}\">\n\
         <!-- The axis is the middle. Change the path, the right half; the left half is its mirror image. -->\n\
         <g transform=\"translate({middle},0)\">\n\
         <path id=\"profile\" d=\"{data}\"/>\n\
         <use xlink:href=\"#profile\" transform=\"scale(-1,1)\"/>\n</g>\n</svg>\n",
        2.0 * middle
    )
}

/// A closed chain in pieces, each as long as the tolerance allows, from its sharpest corner on.
fn pieces(points: &[DVec2], tolerance: f64) -> Vec<Piece> {
    let count = points.len();
    let turn = |k: usize| {
        let [before, at, after] = [k + count - 1, k, k + 1].map(|k| points[k % count]);
        (at - before).angle_to(after - at).abs()
    };
    let sharpest = (0..count).max_by(|a, b| turn(*a).total_cmp(&turn(*b)));
    let Some(first) = sharpest.filter(|_| count >= 3) else {
        return Vec::new();
    };
    let around: Vec<DVec2> = (0..=count).map(|k| points[(first + k) % count]).collect();
    let (mut pieces, mut from) = (Vec::new(), 0);
    while from < count {
        let (end, piece) = longest(&around, from, tolerance);
        pieces.push(piece);
        from = end;
    }
    pieces
}

/// The longest piece from a point on, and the point where it ends.
fn longest(points: &[DVec2], from: usize, tolerance: f64) -> (usize, Piece) {
    let last = points.len() - 1;
    let line = Piece {
        handles: None,
        end: points[from + 1],
    };
    let mut found = (from + 1, line);
    let (mut low, mut high, mut step) = (from + 1, None, 1);
    loop {
        // Doubles while pieces fit, then halves between what fits and what does not.
        let end = match high {
            None => (low + step).min(last),
            Some(high) => low.midpoint(high),
        };
        if end == low {
            return found;
        }
        match piece(&points[from..=end], tolerance) {
            Some(piece) => {
                found = (end, piece);
                (low, step) = (end, 2 * step);
            }
            None => high = Some(end),
        }
    }
}

/// A line along points, else a curve, if there is one within the tolerance.
fn piece(points: &[DVec2], tolerance: f64) -> Option<Piece> {
    let [start, end] = [points[0], points[points.len() - 1]];
    let inner = &points[1..points.len() - 1];
    let near = |p: &DVec2| distance(*p, start, end) <= tolerance;
    if inner.iter().all(near) {
        return Some(Piece { handles: None, end });
    }
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let all = lengths[lengths.len() - 1];
    let mut at: Vec<f64> = lengths.iter().map(|length| length / all).collect();
    for _ in 0..ROUNDS {
        let curve = fitted(points, &at)?;
        if is_near(&curve, points, tolerance) {
            let handles = Some([curve[1], curve[2]]);
            return Some(Piece { handles, end });
        }
        for (t, p) in at.iter_mut().zip(points) {
            *t = nearer(&curve, *p, *t);
        }
        if at.windows(2).any(|t| t[0] >= t[1]) {
            return None;
        }
    }
    None
}

type Curve = [DVec2; 4];

fn point(curve: &Curve, t: f64) -> DVec2 {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    curve.iter().zip(weights).map(|(p, w)| *p * w).sum()
}

/// The curve from the first point to the last that is nearest to those between at their
/// parameters, by least squares.
fn fitted(points: &[DVec2], at: &[f64]) -> Option<Curve> {
    let [start, end] = [points[0], points[points.len() - 1]];
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    let (mut a, mut b) = (DVec2::ZERO, DVec2::ZERO);
    for (p, &t) in points.iter().zip(at) {
        let s = 1.0 - t;
        let [wa, wb] = [3.0 * s * s * t, 3.0 * s * t * t];
        let rest = p - start * (s * s * s) - end * (t * t * t);
        (aa, ab, bb) = (aa + wa * wa, ab + wa * wb, bb + wb * wb);
        (a, b) = (a + rest * wa, b + rest * wb);
    }
    let determinant = aa * bb - ab * ab;
    let solved = [a * bb - b * ab, b * aa - a * ab].map(|v| v / determinant);
    if let [_, p, _] = points {
        // One point between gives one equation: a parabola passes through it.
        let (s, t) = (1.0 - at[1], at[1]);
        let middle = (p - start * (s * s) - end * (t * t)) / (2.0 * s * t);
        return Some([
            start,
            start.lerp(middle, 2.0 / 3.0),
            end.lerp(middle, 2.0 / 3.0),
            end,
        ]);
    }
    let fine = determinant > 1e-12 && solved.iter().all(|p| p.is_finite());
    fine.then_some([start, solved[0], solved[1], end])
}

/// A step of Newton's method towards the parameter of the point of the curve that is nearest.
fn nearer(curve: &Curve, p: DVec2, t: f64) -> f64 {
    let s = 1.0 - t;
    let d = [1, 2, 3].map(|k| 3.0 * (curve[k] - curve[k - 1]));
    let slope = d[0] * (s * s) + d[1] * (2.0 * s * t) + d[2] * (t * t);
    let bend = 2.0 * ((d[1] - d[0]) * s + (d[2] - d[1]) * t);
    let off = point(curve, t) - p;
    let change = slope.length_squared() + off.dot(bend);
    let next = t - off.dot(slope) / change;
    if change > 0.0 {
        next.clamp(0.0, 1.0)
    } else {
        t
    }
}

/// Returns true if the curve, in lines as a drawing's reader makes them, is within the tolerance of
/// the points' lines, and these of it.
fn is_near(curve: &Curve, points: &[DVec2], tolerance: f64) -> bool {
    let [start, a, b, end] = curve.map(|p| kurbo::Point::new(p.x, p.y));
    let path = [PathEl::MoveTo(start), PathEl::CurveTo(a, b, end)];
    let mut lines = Vec::new();
    kurbo::flatten(path, FLATNESS, |element| {
        lines.extend(element.end_point().map(|p| DVec2::new(p.x, p.y)));
    });
    let all_near = |from: &[DVec2], to: &[DVec2]| {
        let mut ends = from.windows(2).flat_map(|p| [p[0], p[0].midpoint(p[1])]);
        ends.all(|p| to.windows(2).any(|q| distance(p, q[0], q[1]) <= tolerance))
    };
    all_near(points, &lines) && all_near(&lines, points)
}

/// Distance of a point from the line between two others.
fn distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    Segment { a, b }.nearest(p).0.distance(p)
}
