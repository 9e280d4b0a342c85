//! What a silhouette seems to be: a light shape, an outline, half a profile, or a solid that is
//! beside the axis, tilted or uneven.
//!
//! Drawings and pictures share these rules. Both give rows of solid spans and the outline of the
//! half right of the axis.

use super::{ProfileAxis, gaps};
use glam::DVec2;
use revmap::profile::{FillRule, Grid, Outline, Region, Segment, loop_area};

/// The solid parts of one row, `[from, to]` in ascending order, pixels from the left edge.
type Row = Vec<[f64; 2]>;

/// Most rows that are looked at.
const ROWS: usize = 512;
/// Pixels in the height of a drawing.
pub(super) const DRAWING: f64 = 1024.0;
/// Fewer rows than this show no form.
const LEAST_ROWS: usize = 8;
/// Fewer solid pixels side by side are noise.
const RUN: usize = 3;
/// The part of the rows that an edge must follow to be straight.
const MOST: f64 = 0.8;
/// Distances below this part of the solid's half width are left over from drawing and scanning.
const SLACK: f64 = 0.02;
/// Halves that differ by less than this part of the solid's width are alike.
const ALIKE: f64 = 0.05;
/// Bands of rows whose halves are compared.
const BANDS: usize = 16;
/// A solid lower than this part of the picture may be a ring beside the axis.
const LOW: f64 = 0.5;
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
        Self {
            rows: rows.map(runs).collect(),
            step: step as f64,
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
        Self {
            rows: outline.crossings(heights).into_iter().map(spans).collect(),
            step: DRAWING / ROWS as f64,
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
        let ends = Ends::of(self);
        if ends.rows.len() < LEAST_ROWS {
            return gaps::hints(half);
        }
        let found = match axis {
            ProfileAxis::Left => self
                .whole_as_half(&ends)
                .or_else(|| self.mirrored_half(&ends)),
            ProfileAxis::Center | ProfileAxis::At(_) => self
                .half_as_whole(&ends)
                .or_else(|| self.beside_the_axis(&ends)),
        };
        let found = found.or_else(|| hollow(half));
        found.into_iter().chain(gaps::hints(half)).collect()
    }

    /// A solid that is even about a line well beside the axis. Its half has no meaning.
    pub(super) fn aside(&self, axis: ProfileAxis) -> Option<String> {
        let ends = Ends::of(self);
        if axis == ProfileAxis::Left || ends.rows.len() < LEAST_ROWS {
            return None;
        }
        let line = ends.middle_line();
        let is_half = ends.is_straight(Ends::left) || ends.is_straight(Ends::right);
        let is_even = line.residual <= ends.slack() && ends.one_sided(|row| line.at(row)) <= ALIKE;
        (is_even && !is_half)
            .then(|| self.beside_the_axis(&ends))
            .flatten()
    }

    /// A straight end on one side and a form on the other are half a profile.
    fn half_as_whole(&self, ends: &Ends) -> Option<String> {
        let [at, end] = [ends.median(Ends::left), ends.median(Ends::right)];
        match (ends.is_straight(Ends::left), ends.is_straight(Ends::right)) {
            (true, false) if (at - self.axis).abs() > ends.slack() => {
                let axis = match at {
                    ..=1.0 => "\"left\"".to_owned(),
                    _ => self.fraction(at),
                };
                Some(format!(
                    "the {} looks like half a profile, whose straight left edge is the axis; set profile_axis = {axis}{}",
                    self.what,
                    ends.or_turn_it()
                ))
            }
            (false, true) if (end - self.axis).abs() > ends.slack() => Some(format!(
                "{}, and set profile_axis = \"left\"{}",
                self.mirror_it(),
                ends.or_turn_it()
            )),
            _ => None,
        }
    }

    /// A straight end at the right border and a form on the left are half a profile, mirrored.
    fn mirrored_half(&self, ends: &Ends) -> Option<String> {
        let at_border = ends.median(Ends::right) >= self.width - 1.0;
        let is_half = ends.is_straight(Ends::right) && !ends.is_straight(Ends::left);
        (at_border && is_half).then(|| self.mirror_it())
    }

    fn mirror_it(&self) -> String {
        let what = self.what;
        format!(
            "the {what} looks like half a profile, whose straight right edge is the axis; mirror it"
        )
    }

    /// A solid about the middle of the page that leaves the left edge free is a whole one.
    fn whole_as_half(&self, ends: &Ends) -> Option<String> {
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

    /// The middle of the rows is beside the axis, or tilted, or the halves are uneven.
    fn beside_the_axis(&self, ends: &Ends) -> Option<String> {
        let line = ends.middle_line();
        let is_even = line.residual <= ends.slack();
        if is_even && line.drift.abs() > (1.5 * ends.slack()).max(2.0) {
            let angle = (line.drift / ends.height()).atan().to_degrees().abs();
            let what = self.what;
            return Some(format!(
                "the solid looks tilted by {angle:.1} degrees; turn the {what} upright"
            ));
        }
        if is_even && (line.middle - self.axis).abs() > ends.slack() {
            return Some(format!(
                "the middle of the solid is beside the axis, at {} in place of {}; set profile_axis = {}, or crop the {}{}",
                (self.place)(line.middle),
                (self.place)(self.axis),
                self.fraction(line.middle),
                self.what,
                ends.or_turn_it()
            ));
        }
        let axis = |row: f64| if is_even { line.at(row) } else { self.axis };
        let part = ends.one_sided(axis);
        (part > ALIKE).then(|| {
            format!(
                "the halves of the solid differ by {:.0} % of its width, and the right one is taken; set profile_axis, or remove what is on one side alone{}",
                100.0 * part,
                ends.or_turn_it()
            )
        })
    }

    /// A part of the width.
    fn fraction(&self, at: f64) -> String {
        format!("{}", (1e4 * at / self.width).round() / 1e4)
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

/// The outer ends of the rows.
struct Ends {
    /// Place of the row from the top, left end and right end, of each row with some solid.
    rows: Vec<[f64; 3]>,
    step: f64,
}

impl Ends {
    fn of(form: &Silhouette) -> Self {
        let ends =
            |(i, row): (usize, &Row)| Some([i as f64 * form.step, row.first()?[0], row.last()?[1]]);
        Self {
            rows: form.rows.iter().enumerate().filter_map(ends).collect(),
            step: form.step,
        }
    }

    fn left(row: &[f64; 3]) -> f64 {
        row[1]
    }

    fn right(row: &[f64; 3]) -> f64 {
        row[2]
    }

    fn height(&self) -> f64 {
        self.step * self.rows.len() as f64
    }

    fn median(&self, value: impl Fn(&[f64; 3]) -> f64) -> f64 {
        median(self.rows.iter().map(value).collect())
    }

    /// A length that cannot be told from none: a part of the half width of the widest row.
    fn slack(&self) -> f64 {
        let halves = self
            .rows
            .iter()
            .map(|[_, left, right]| 0.5 * (right - left));
        (SLACK * halves.fold(0.0, f64::max)).max(1.0)
    }

    /// Returns true if an end is at its median in most rows.
    fn is_straight(&self, end: impl Fn(&[f64; 3]) -> f64) -> bool {
        let at = self.median(&end);
        let near = self.rows.iter().filter(|row| (end(row) - at).abs() <= 1.0);
        near.count() as f64 >= MOST * self.rows.len() as f64
    }

    /// The part of the width that has no mirror image about `axis`. Within a band of rows, noise
    /// evens out.
    fn one_sided(&self, axis: impl Fn(f64) -> f64) -> f64 {
        let bands = self.rows.chunks(self.rows.len().div_ceil(BANDS));
        let beside = |rows: &[[f64; 3]]| {
            let aside = rows
                .iter()
                .map(|[row, left, right]| right + left - 2.0 * axis(*row));
            let width: f64 = rows.iter().map(|[_, left, right]| right - left).sum();
            (rows.len() as f64 * median(aside.collect()))
                .abs()
                .min(width)
        };
        bands.map(beside).sum::<f64>() / self.area()
    }

    fn area(&self) -> f64 {
        let widths = self.rows.iter().map(|[_, left, right]| right - left);
        widths.sum::<f64>().max(1.0)
    }

    /// Advice for a solid whose upper and lower half are alike.
    fn or_turn_it(&self) -> &'static str {
        let pairs = self.rows.iter().zip(self.rows.iter().rev());
        let apart = pairs.map(|(a, b)| 0.5 * ((a[1] - b[1]).abs() + (a[2] - b[2]).abs()));
        match apart.sum::<f64>() / self.area() {
            ..ALIKE => "; if the solid lies on its side, turn it upright",
            _ => "",
        }
    }

    /// The line that the middles of most rows follow: medians, since handles and shadows bring rows
    /// of their own.
    fn middle_line(&self) -> MiddleLine {
        let middle = |s: &[f64; 3]| 0.5 * (s[1] + s[2]);
        let third = self.rows.len() / 3;
        let of = |rows: &[[f64; 3]], value: &dyn Fn(&[f64; 3]) -> f64| {
            median(rows.iter().map(value).collect())
        };
        let (top, bottom) = (&self.rows[..third], &self.rows[self.rows.len() - third..]);
        let rise = of(bottom, &middle) - of(top, &middle);
        let run = of(bottom, &|s| s[0]) - of(top, &|s| s[0]);
        let slope = rise / run.max(1.0);
        let straightened = |s: &[f64; 3]| middle(s) - slope * s[0];
        let from = self.median(straightened);
        MiddleLine {
            from,
            slope,
            middle: from + slope * self.median(|s| s[0]),
            drift: slope * self.height(),
            residual: self.median(|s| (straightened(s) - from).abs()),
        }
    }
}

/// A line through the middles of the rows, pixels.
struct MiddleLine {
    /// Its place at the top of the page.
    from: f64,
    slope: f64,
    /// Its place half way down.
    middle: f64,
    /// Its way aside from the first row to the last.
    drift: f64,
    /// The median distance of a middle from it.
    residual: f64,
}

impl MiddleLine {
    fn at(&self, row: f64) -> f64 {
        self.from + self.slope * row
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
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
    let reach = |m: f64, p: &DVec2| m.max(p.abs().max_element());
    let grid = Grid::for_extent(loops.iter().flatten().fold(1.0, reach));
    let whole = Region::enclosed(grid, &loops, FillRule::NonZero).outline(grid);
    let hollow: f64 = whole.loops.iter().map(|l| (-loop_area(l)).max(0.0)).sum();
    (whole, hollow)
}

/// Returns true for a piece of a thin line: its area is small for its length.
fn is_thin(points: &[DVec2]) -> bool {
    let next = points.iter().cycle().skip(1);
    let length: f64 = points.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
    2.0 * loop_area(points).abs() < 0.25 * THIN * length
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

#[cfg(test)]
mod tests;
