//! What a silhouette seems to be: symmetric about another axis than the middle, or the outline of
//! a shape instead of the shape.
//!
//! Both drawings and pictures are looked at, so the input is what both have: rows of solid spans,
//! and an outline.

use glam::DVec2;
use revmap::profile::{FillRule, Grid, Outline, Region, Segment, loop_area};

/// The solid parts of one row of a silhouette, `[from, to]` in ascending order. 0 is the middle of
/// the picture; the unit is free.
pub(super) type Row = Vec<[f64; 2]>;

/// Rows of a silhouette that is compared with its mirror image.
const ROWS: usize = 256;
/// Halves that differ by less than this part of the silhouette's area are alike.
const ALIKE: f64 = 0.02;
/// A silhouette is symmetric about another axis if its halves there differ by less than this part
/// of their difference about the middle.
const CLEARLY: f64 = 0.25;
/// An axis nearer to the middle than this part of the silhouette's width is the middle.
const NEAR: f64 = 0.005;
/// A wall below this part of the height is thin.
const THIN: f64 = 0.05;
/// A shape is an outline drawing if its walls are thin along this part of its border.
const EVERYWHERE: f64 = 0.9;
/// Places of the border at which the wall is measured.
const SAMPLES: usize = 256;

/// The rows of a whole silhouette that is given as an outline, `r < 0` being left of the middle.
pub(super) fn rows(whole: &Outline) -> Vec<Row> {
    let heights = (0..ROWS).map(|i| (i as f64 + 0.5) / ROWS as f64);
    let crossings = whole.crossings(heights);
    let spans = |row: Vec<f64>| row.chunks_exact(2).map(|s| [s[0], s[1]]).collect();
    crossings.into_iter().map(spans).collect()
}

/// The place about which a silhouette is symmetric, if it is not symmetric about 0.
pub(super) fn other_axis(rows: &[Row]) -> Option<f64> {
    let (mut area, mut moment) = (0.0, 0.0);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for [from, to] in rows.iter().flatten() {
        area += to - from;
        moment += 0.5 * (to * to - from * from);
        (low, high) = (low.min(*from), high.max(*to));
    }
    if area <= 0.0 {
        return None;
    }
    let of_middle = asymmetry(rows, 0.0, area);
    if of_middle < ALIKE {
        return None;
    }
    let candidates = [moment / area, 0.5 * (low + high)];
    let valued = candidates.map(|at| (asymmetry(rows, at, area), at));
    let (least, at) = if valued[0].0 <= valued[1].0 {
        valued[0]
    } else {
        valued[1]
    };
    let apart = at.abs() > NEAR * (high - low);
    (apart && least < ALIKE && least < CLEARLY * of_middle).then_some(at)
}

/// The part of a silhouette that its mirror image about `at` does not cover.
fn asymmetry(rows: &[Row], at: f64, area: f64) -> f64 {
    let common: f64 = rows.iter().map(|row| common_with_mirror(row, at)).sum();
    1.0 - common / area
}

/// Length that a row and its mirror image have in common.
fn common_with_mirror(row: &Row, at: f64) -> f64 {
    let mut mirrored = row
        .iter()
        .rev()
        .map(|[from, to]| [2.0 * at - to, 2.0 * at - from]);
    let (mut own, mut other) = (row.iter().copied(), mirrored.next());
    let (mut current, mut common) = (own.next(), 0.0);
    while let (Some(a), Some(b)) = (current, other) {
        common += (a[1].min(b[1]) - a[0].max(b[0])).max(0.0);
        if a[1] < b[1] {
            current = own.next();
        } else {
            other = mirrored.next();
        }
    }
    common
}

/// Returns true for the outline of a shape: thin walls all round a closed hollow, which is larger
/// than the walls.
pub(super) fn is_shell(half: &Outline) -> bool {
    let mirror = |p: &DVec2| DVec2::new(-p.x, p.y);
    let mirrored = half
        .loops
        .iter()
        .map(|l| l.iter().rev().map(mirror).collect());
    let loops: Vec<Vec<DVec2>> = half.loops.iter().cloned().chain(mirrored).collect();
    let reach = |m: f64, p: &DVec2| m.max(p.abs().max_element());
    let grid = Grid::for_extent(loops.iter().flatten().fold(1.0, reach));
    let whole = Region::enclosed(grid, &loops, FillRule::NonZero).outline(grid);
    let hollow: f64 = whole.loops.iter().map(|l| (-loop_area(l)).max(0.0)).sum();
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
mod tests {
    use super::*;

    fn outline(loops: &[&[[f64; 2]]]) -> Outline {
        let points = |l: &&[[f64; 2]]| l.iter().map(|&p| DVec2::from(p)).collect();
        Outline {
            loops: loops.iter().map(points).collect(),
        }
    }

    /// A bottle about `x = at`.
    fn bottle(at: f64) -> Vec<Row> {
        let row = |i| match i {
            0..40 => vec![],
            40..120 => vec![[at - 0.04, at + 0.04]],
            _ => vec![
                [at - 0.19, at - 0.17],
                [at - 0.1, at + 0.1],
                [at + 0.17, at + 0.19],
            ],
        };
        (0..256).map(row).collect()
    }

    #[test]
    fn another_axis_is_found() {
        for at in [0.12, -0.01, 0.4] {
            let found = other_axis(&bottle(at));
            assert!(
                found.is_some_and(|f| (f - at).abs() < 1e-9),
                "{at}: {found:?}"
            );
        }
        assert_eq!(other_axis(&bottle(0.0)), None);
        assert_eq!(other_axis(&bottle(1e-4)), None);
        assert_eq!(other_axis(&[]), None);
        // A knight is symmetric about nothing.
        let knight: Vec<Row> = (0..256)
            .map(|i| vec![[-0.1, 0.1 + 0.001 * f64::from(i)]])
            .collect();
        assert_eq!(other_axis(&knight), None);
    }

    #[test]
    fn rows_of_an_outline() {
        let square = outline(&[&[[-0.2, 0.0], [0.3, 0.0], [0.3, 1.0], [-0.2, 1.0]]]);
        let rows = rows(&square);
        assert!(rows.iter().all(|r| *r == [[-0.2, 0.3]]));
        assert!(other_axis(&rows).is_some_and(|at| (at - 0.05).abs() < 1e-9));
    }

    #[test]
    fn outline_drawings_are_told_from_vessels() {
        let wall = |t: f64| {
            outline(&[&[
                [0.0, 0.1],
                [0.3, 0.1],
                [0.3, 0.9],
                [0.0, 0.9],
                [0.0, 0.9 - t],
                [0.3 - t, 0.9 - t],
                [0.3 - t, 0.1 + t],
                [0.0, 0.1 + t],
            ]])
        };
        assert!(is_shell(&wall(0.003)));
        assert!(is_shell(&wall(0.03)));
        assert!(!is_shell(&wall(0.1)));
        // Open at the top: a cup.
        let cup = outline(&[&[
            [0.0, 0.1],
            [0.3, 0.1],
            [0.3, 0.9],
            [0.29, 0.9],
            [0.29, 0.11],
            [0.0, 0.11],
        ]]);
        assert!(!is_shell(&cup));
        // A ring has no hollow of its own.
        let ring = outline(&[&[[0.3, 0.4], [0.31, 0.4], [0.31, 0.5], [0.3, 0.5]]]);
        assert!(!is_shell(&ring));
        let solid = outline(&[&[[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]]]);
        assert!(!is_shell(&solid));
    }
}
