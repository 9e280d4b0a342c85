//! What a silhouette seems to be: a light shape, an outline, half a profile, or a solid that is
//! beside the axis, tilted or uneven.
//!
//! Drawings and pictures share these rules. Both give rows of solid spans and the outline of the
//! half right of the axis.

mod ends;
pub(crate) mod gaps;
pub(crate) mod marks;

use super::ProfileAxis;
use super::advice::SET_AXIS;
use ends::{ALIKE, Edge, Ends, Row};
use glam::DVec2;
use revmap::profile::{FillRule, Outline, Segment, loop_area};

/// Most rows that are looked at.
const ROWS: usize = 512;
/// Pixels in the height of a drawing.
pub(super) const DRAWING: f64 = 1024.0;
/// Fewer rows than this show no form.
const LEAST_ROWS: usize = 8;
/// Fewer solid pixels side by side are noise.
const RUN: usize = 3;
/// A solid lower than this part of the picture may be a ring beside the axis.
const LOW: f64 = 0.5;
/// A solid of which more than this part of the width is on one side may be half a profile.
const ONE_SIDED: f64 = 0.4;
/// The same for a solid on the page's left border, which is the usual axis of half a profile.
const ONE_SIDED_AT_BORDER: f64 = 0.2;
/// A half that is this many times wider than high may be on its side.
const FLAT: f64 = 1.5;
/// A wall below this part of the height is thin.
const THIN: f64 = 0.08;
/// A shape is an outline drawing if its walls are thin along this part of its border.
const EVERYWHERE: f64 = 0.9;
/// Closed hollows of less than this part of the solid's area are decoration.
const HOLLOW: f64 = 0.2;
/// Places of the border at which the wall is measured.
const SAMPLES: usize = 256;
/// This many thin pieces are the dashes of a line.
const DASHES: usize = 8;

/// A silhouette, pixels.
pub(super) struct Silhouette<'a> {
    /// Rows from the top, `step` pixels apart.
    rows: Vec<Row>,
    step: f64,
    ends: Ends,
    width: f64,
    /// The axis, from the left edge.
    axis: f64,
    /// The kind of file, in messages.
    what: &'static str,
    /// The name of a place across the file.
    place: &'a dyn Fn(f64) -> String,
}

impl<'a> Silhouette<'a> {
    /// The silhouette of a picture: solid pixels, `width` to a row.
    pub(super) fn of_pixels(solid: &[bool], width: usize, axis: f64) -> Self {
        let height = solid.len() / width.max(1);
        let step = height.div_ceil(ROWS).max(1);
        let rows = solid.chunks_exact(width.max(1)).step_by(step);
        let (rows, step): (Vec<Row>, _) = (rows.map(runs).collect(), step as f64);
        Self {
            ends: Ends::of(&rows, step),
            rows,
            step,
            width: width as f64,
            axis,
            what: "picture",
            place: &|x| format!("{x:.1} pixels"),
        }
    }

    /// The silhouette of a drawing's outline. `left`: the axis from the left edge, `width`: of the
    /// page, both in heights. `place` names a radius.
    pub(super) fn of_outline(
        outline: &Outline,
        [left, width]: [f64; 2],
        place: &'a dyn Fn(f64) -> String,
    ) -> Self {
        let heights = (0..ROWS).map(|i| 1.0 - (i as f64 + 0.5) / ROWS as f64);
        let at = |r: f64| DRAWING * (r + left);
        let spans = |row: Vec<f64>| row.chunks_exact(2).map(|s| [at(s[0]), at(s[1])]).collect();
        let rows: Vec<Row> = outline.crossings(heights).into_iter().map(spans).collect();
        let step = DRAWING / ROWS as f64;
        Self {
            ends: Ends::of(&rows, step),
            rows,
            step,
            width: DRAWING * width,
            axis: DRAWING * left,
            what: "drawing",
            place,
        }
    }

    /// Returns true if the ground is dark and the middle is light.
    pub(super) fn is_light_on_dark(&self) -> bool {
        let count = |is: &dyn Fn(&Row) -> bool| {
            let found = self.rows.iter().filter(|row| is(row)).count();
            found as f64 / self.rows.len().max(1) as f64
        };
        let reaches = |x: f64| move |row: &Row| row.iter().any(|[a, b]| *a <= x && x < *b);
        let right =
            |[a, b]: &[f64; 2]| (b.max(self.axis) - a.max(self.axis)) / (self.width - self.axis);
        let top: f64 = self.rows.iter().take(1).flatten().map(right).sum();
        count(&reaches(self.width - 1.0)) >= 0.95 && top >= 0.6 && count(&reaches(self.axis)) <= 0.7
    }

    /// Warnings about the form. `half` is the outline right of the axis, heights. `pale` names paint
    /// that makes an outline of the drawing.
    pub(super) fn hints(
        &self,
        half: &Outline,
        axis: ProfileAxis,
        pale: impl FnOnce() -> Option<String>,
    ) -> Vec<String> {
        if let Some(aside) = self.aside(axis) {
            return vec![aside];
        }
        if is_shell(half) {
            return vec![pale().unwrap_or_else(|| format!(
                "the {} is an outline: the solid is a thin shell about a hollow; fill the shape if it is meant to be solid",
                self.what
            ))];
        }
        let hollow = || hollow(half).filter(|_| !self.is_low());
        let found = self.placed(axis).or_else(hollow);
        // The right part of half a profile has no meaning, nor have its gaps.
        let gaps = match found.iter().any(|hint| hint.contains("half a profile")) {
            true => Vec::new(),
            false => gaps::hints(half),
        };
        found.into_iter().chain(gaps).collect()
    }

    /// A warning about the place of the solid about the axis.
    pub(super) fn placed(&self, axis: ProfileAxis) -> Option<String> {
        match axis {
            _ if self.is_low() => None,
            ProfileAxis::Left => self.whole_as_half().or_else(|| self.half_in_the_page()),
            ProfileAxis::Center | ProfileAxis::At(_) => self.beside_the_axis(),
        }
    }

    /// Returns true if too few rows are solid to show a form.
    fn is_low(&self) -> bool {
        self.ends.rows.len() < LEAST_ROWS
    }

    /// What [`Self::placed`] says of the axis, for a solid with lines beside it. They go before a tilt.
    pub(super) fn axis_hint(&self, axis: ProfileAxis) -> Option<String> {
        self.placed(axis)
            .filter(|hint| hint.contains("profile_axis"))
    }

    /// A solid that is even about a line well beside the axis. Its half has no meaning.
    pub(super) fn aside(&self, axis: ProfileAxis) -> Option<String> {
        let ends = &self.ends;
        if axis == ProfileAxis::Left || self.is_low() {
            return None;
        }
        let line = ends.middle_line();
        let is_half = ends.is_straight(Ends::left) || ends.is_straight(Ends::right);
        let is_even = line.residual <= ends.slack() && ends.one_sided(|row| line.at(row)) <= ALIKE;
        (is_even && !is_half)
            .then(|| self.beside_the_axis())
            .flatten()
    }

    /// Why nothing is right of the axis: the solid is even about another line, or it is half a
    /// profile.
    pub(super) fn elsewhere(&self, axis: ProfileAxis) -> Option<String> {
        let half = || {
            let is_other = axis != ProfileAxis::Left && !self.is_low();
            let edge = || self.ends.edge().or_else(|| self.ends.long_edge());
            Some(self.half(is_other.then(edge).flatten()?))
        };
        self.aside(axis).or_else(half)
    }

    /// What to do with half a profile whose axis is `edge`.
    fn half(&self, edge: Edge) -> String {
        let what = self.what;
        let (name, at, mirror) = match edge {
            Edge::Left(at) => ("left", at, ""),
            Edge::Right(at) => ("right", self.width - at, "mirror it, and "),
        };
        let remedy = match self.set_axis(at) {
            Some(set) => format!("{mirror}{set}"),
            None => "move it into the page".to_owned(),
        };
        format!(
            "the {what} looks like half a profile, whose straight {name} edge is the axis; {remedy}{}",
            self.ends.or_turn_it()
        )
    }

    /// Half a profile, read with the left border as the axis: its edge is the right border, or it
    /// is in the middle of the page.
    fn half_in_the_page(&self) -> Option<String> {
        let ends = &self.ends;
        let [low, high] = ends.reach();
        let is_central = low > 1.0 && (low + high - self.width).abs() <= 2.0 * ends.slack();
        if is_central && let Some(lying) = self.lying_half(false) {
            return Some(lying);
        }
        let edge = ends.edge()?;
        let at_border = matches!(edge, Edge::Right(at) if at >= self.width - 1.0);
        (is_central || at_border).then(|| self.half(edge))
    }

    /// A solid wider than high with one straight edge along it is half a profile on its side. Even
    /// ones may be domes, unless the edge alone is on the border.
    fn lying_half(&self, is_even: bool) -> Option<String> {
        let columns = Ends::of_columns(&self.rows, self.step);
        let height = columns.rows.iter().map(|c| c[2] - c[1]).fold(0.0, f64::max);
        let edge = columns
            .edge()
            .filter(|_| columns.height() >= FLAT * height)?;
        let page = self.rows.len() as f64 * self.step;
        let [low, high] = self.ends.reach();
        let (free, below) = match edge {
            Edge::Left(at) => (at, columns.reach()[1]),
            Edge::Right(at) => (page - at, page - columns.reach()[0]),
        };
        let is_on_border =
            free <= self.step && below < page - self.step && low > 1.0 && high < self.width - 1.0;
        if is_even && !is_on_border {
            return None;
        }
        let (what, name) = match edge {
            Edge::Left(_) => (self.what, "upper"),
            Edge::Right(_) => (self.what, "lower"),
        };
        Some(format!(
            "the {what} looks like half a profile on its side, whose straight {name} edge is the axis; turn it upright, so that this edge is at the left, and set profile_axis = \"left\""
        ))
    }

    /// A solid about the middle of the page that leaves the left edge free is a whole one.
    fn whole_as_half(&self) -> Option<String> {
        let ends = &self.ends;
        let line = ends.middle_line();
        let is_free = ends.rows.iter().all(|[_, left, _]| *left > 1.0);
        let is_central = (line.middle - 0.5 * self.width).abs() <= ends.slack();
        let is_even = line.residual <= ends.slack() && line.drift.abs() <= ends.slack();
        let is_ring =
            ends.is_straight(Ends::left) || (ends.rows.len() as f64) < LOW * self.rows.len() as f64;
        (is_free && is_central && is_even && !is_ring).then(|| {
            format!(
                "the {} looks like a whole silhouette, its axis in the middle; set profile_axis = \"center\" if it is",
                self.what
            )
        })
    }

    /// Half a profile with another axis, or the middle of the rows is beside the axis, or tilted, or
    /// the halves are uneven.
    fn beside_the_axis(&self) -> Option<String> {
        let ends = &self.ends;
        let is_here = |at: f64| (at - self.axis).abs() <= ends.slack();
        let is_half = ends.is_straight(Ends::left) && is_here(ends.median(Ends::left));
        if is_half || matches!(ends.long_edge(), Some(Edge::Left(at)) if is_here(at)) {
            return None;
        }
        let line = ends.middle_line();
        let is_even = line.residual <= ends.slack();
        let is_tilted = is_even && line.drift.abs() > (1.5 * ends.slack()).max(2.0);
        let [low, high] = ends.reach();
        let least = match low.abs() <= 1.0 && high < self.width - ends.slack() {
            true => ONE_SIDED_AT_BORDER,
            false => ONE_SIDED,
        };
        let may_be_half = (is_tilted || !is_even) && ends.one_sided(|_| self.axis) > least;
        let hollow_edge = || ends.long_edge().filter(|_| may_be_half);
        if let Some(edge) = ends.edge().or_else(hollow_edge) {
            return Some(self.half(edge));
        }
        if is_tilted {
            let angle = (line.drift / ends.height()).atan().to_degrees().abs();
            let what = self.what;
            return Some(format!(
                "the solid looks tilted by {angle:.1} degrees; turn the {what} upright"
            ));
        }
        if is_even && (line.middle - self.axis).abs() > ends.slack() {
            let what = self.what;
            let remedy = match self.set_axis(line.middle) {
                Some(set) => format!("{set}, or crop the {what}"),
                None => "move it into the page".to_owned(),
            };
            return Some(format!(
                "the middle of the solid is beside the axis, at {} in place of {}; {remedy}{}",
                (self.place)(line.middle),
                (self.place)(self.axis),
                ends.or_turn_it()
            ));
        }
        let axis = |row: f64| if is_even { line.at(row) } else { self.axis };
        let part = ends.one_sided(axis);
        let lying = self.lying_half(part <= ALIKE);
        let uneven = || {
            format!(
                "the halves of the solid differ by {:.0} % of its width, and the right one is taken; set profile_axis, or remove what is on one side alone{}",
                100.0 * part,
                ends.or_turn_it()
            )
        };
        lying.or_else(|| (part > ALIKE).then(uneven))
    }

    /// The key that moves the axis; `None` beside the page.
    fn set_axis(&self, at: f64) -> Option<String> {
        let fraction = (1e4 * at / self.width).round() / 1e4;
        let value = match at.abs() <= 1.0 {
            true => Some("\"left\"".to_owned()),
            false => (0.0..1.0).contains(&fraction).then(|| fraction.to_string()),
        };
        value.map(|value| format!("{SET_AXIS}{value}"))
    }
}

/// The runs of solid pixels of a row.
fn runs(line: &[bool]) -> Row {
    let mut from = 0;
    let parts = line.chunk_by(|a, b| a == b).map(|part| {
        from += part.len();
        (part[0] && part.len() >= RUN).then(|| [(from - part.len()) as f64, from as f64])
    });
    parts.flatten().collect()
}

/// Returns true for the outline of a shape: thin walls all round a closed hollow, which is larger
/// than the walls, or thin dashes. A gap at the axis counts as closed.
pub(super) fn is_shell(half: &Outline) -> bool {
    if half.loops.len() >= DASHES && half.loops.iter().all(|l| is_thin(l)) {
        return true;
    }
    let (whole, hollow) = whole(half);
    if hollow < whole.area() {
        return false;
    }
    let segments: Vec<Segment> = whole.segments().collect();
    let length: f64 = segments.iter().map(|s| s.a.distance(s.b)).sum();
    let step = length / SAMPLES as f64;
    let (mut next, mut thin, mut all) = (0.5 * step, 0, 0);
    for s in &segments {
        let own = s.a.distance(s.b);
        while next < own {
            all += 1;
            thin += usize::from(wall(s, next / own, &segments) < THIN);
            next += step;
        }
        next -= own;
    }
    f64::from(thin as u32) >= EVERYWHERE * f64::from(all as u32)
}

/// A warning about a closed hollow, which nobody sees. More hollow than solid is a line drawing.
fn hollow(half: &Outline) -> Option<String> {
    let (whole, hollow) = whole(half);
    (HOLLOW * whole.area()..whole.area()).contains(&hollow).then(|| {
        "a closed hollow inside the solid does not show, and an inset opens it; remove the light shape (a label, a highlight) if none is meant".to_owned()
    })
}

/// Both halves, and the area of the hollows that they enclose.
fn whole(half: &Outline) -> (Outline, f64) {
    let closed = |p: &DVec2| DVec2::new(if p.x < gaps::BORE { 0.0 } else { p.x }, p.y);
    let mirror = |p: DVec2| DVec2::new(-p.x, p.y);
    let right = || half.loops.iter().map(|l| l.iter().map(closed));
    let left = right().map(|l| l.rev().map(mirror).collect());
    let loops: Vec<Vec<DVec2>> = right().map(Iterator::collect).chain(left).collect();
    let whole = Outline::enclosed(&loops, FillRule::NonZero);
    let hollow: f64 = whole.loops.iter().map(|l| (-loop_area(l)).max(0.0)).sum();
    (whole, hollow)
}

/// Returns true for a piece of a thin line: its area is small for its length.
fn is_thin(points: &[DVec2]) -> bool {
    2.0 * loop_area(points).abs() < 0.25 * THIN * loop_length(points)
}

/// Length of a closed loop of points.
pub(super) fn loop_length(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
}

/// Thickness of the solid behind a place of a segment, perpendicular to it.
fn wall(segment: &Segment, part: f64, segments: &[Segment]) -> f64 {
    let from = segment.a.lerp(segment.b, part);
    // The solid is on the left.
    let inward = (segment.b - segment.a).perp().normalize_or_zero();
    let crossing = |s: &Segment| {
        let (a, b) = (inward.perp_dot(s.a - from), inward.perp_dot(s.b - from));
        let at = s.a.lerp(s.b, a / (a - b));
        ((a < 0.0) != (b < 0.0)).then(|| inward.dot(at - from))
    };
    let ahead = segments
        .iter()
        .filter(|s| *s != segment)
        .filter_map(crossing);
    ahead.filter(|d| *d > 1e-9).fold(f64::INFINITY, f64::min)
}
