//! Rings and segments for a solid that is turned in steps, by what both err together.

use super::meridian::{Line, Strand, lines};
use super::parted::cleaned;
use glam::DVec2;
use revmap::profile::Segment;
use revmap::surface::Contour;
use std::f64::consts::PI;

/// Strands, and the number of equal steps in which they are turned about the axis.
#[derive(Clone, Debug, Default)]
pub struct Turned {
    /// The chains of the contour, thinned.
    pub strands: Vec<Strand>,
    /// Steps around the axis, at least 3.
    pub segments: u32,
}

/// Above this tolerance, object units, details of an outline may be left out.
const DETAILS: f64 = 1e-3;
/// The first factor on the tolerance of chords. They are laid to both sides, so that an even curve
/// errs by half of it.
const FIRST: f64 = 1.9;
/// From one factor to the next where chords do not keep the tolerance.
const NEXT: f64 = 0.85;
/// The share of the tolerance that chords keep: the rest is for rounding.
const MARGIN: f64 = 0.98;

/// A contour as few rings and segments whose solid is nowhere farther than `tolerance` from the
/// contour's own, object units.
///
/// A polygon of `n` sides that is laid to both sides of its circle of radius `r` errs by `e r`, with
/// `e = (1 - cos(pi / n)) / (1 + cos(pi / n))`. Where its corner meets a ring, the error `c` of the
/// chord is added. Quads are fewest if `c` and `e r` are equal at the largest radius, because rings
/// follow `1 / sqrt(c)` and segments `1 / sqrt(e)`. So chords may err by half of the tolerance
/// there, and by more nearer the axis. They leave `e` as the least of `(tolerance - c) / r`.
#[must_use]
pub fn turned_within(contour: &Contour, tolerance: f64) -> Turned {
    let lines = lines(&cleaned(&contour.chains));
    let points = || lines.iter().flat_map(|line| &line.points);
    let widest = points().fold(f64::MIN_POSITIVE, |most, p| p.x.max(most));
    let share = |p: &DVec2| tolerance * (1.0 - 0.5 * p.x / widest);
    let turned = |corners: bool| {
        let mut all = Turned::default();
        let mut spread = f64::INFINITY;
        for line in &lines {
            let (kept, strand) = kept(line, corners, &share);
            for (chord, ends) in strand.rings.windows(2).zip(kept.windows(2)) {
                let [a, b] = [chord[0].point, chord[1].point];
                let left = tolerance - error(line, ends, [a, b]);
                spread = spread.min(left / a.x.max(b.x).max(f64::MIN_POSITIVE));
            }
            all.strands.push(strand);
        }
        all.segments = segments(spread);
        all
    };
    let all = turned(true);
    if tolerance < DETAILS {
        return all;
    }
    let fewer = turned(false);
    if quads(&fewer) < quads(&all) {
        fewer
    } else {
        all
    }
}

/// The least number of segments whose polygon errs by at most `spread` of its radius.
fn segments(spread: f64) -> u32 {
    let spread = spread.clamp(1e-9, 1.0);
    let half_step = ((1.0 - spread) / (1.0 + spread)).acos();
    ((PI / half_step).ceil() as u32).max(3)
}

fn quads(turned: &Turned) -> usize {
    let rings = turned.strands.iter().map(|s| s.rings.len() - 1);
    rings.sum::<usize>() * turned.segments as usize
}

/// The points of a line that become rings: between fixed points the longest chords that, laid to
/// both sides, keep `share`, and their strand. Without `corners` only the line's ends are fixed.
fn kept(line: &Line, corners: bool, share: &dyn Fn(&DVec2) -> f64) -> (Vec<usize>, Strand) {
    let mut tolerances: Vec<f64> = line.points.iter().map(|p| FIRST * share(p)).collect();
    loop {
        let kept = line.thinned(corners, &|k| tolerances[k]);
        let strand = line.strand_of(&kept);
        let mut done = true;
        for (ends, chord) in kept.windows(2).zip(strand.rings.windows(2)) {
            let points = ends[0]..=ends[1];
            let allowed = line.points[points.clone()].iter().map(share);
            let allowed = MARGIN * allowed.fold(f64::INFINITY, f64::min);
            // As tolerances fall chords become the line itself.
            let places = [chord[0].point, chord[1].point];
            if ends[1] > ends[0] + 1 && error(line, ends, places) > allowed {
                tolerances[points].iter_mut().for_each(|t| *t *= NEXT);
                done = false;
            }
        }
        if done {
            return (kept, strand);
        }
    }
}

/// The largest distance between a chord and the points of the line that it stands for.
fn error(line: &Line, ends: &[usize], [a, b]: [DVec2; 2]) -> f64 {
    let points = &line.points[ends[0]..=ends[1]];
    let from_chord = |p: &DVec2| p.distance(Segment { a, b }.nearest(*p).0);
    let moved = a
        .distance(line.points[ends[0]])
        .max(b.distance(line.points[ends[1]]));
    points.iter().map(from_chord).fold(moved, f64::max)
}
