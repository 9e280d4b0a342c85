//! Chains without what 32 bits cannot tell apart, and parts of a solid that touch along a circle
//! moved apart: no edge then belongs to four triangles.

use glam::DVec2;
use revmap::surface::Chain;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Points at a smaller distance are one: positions of 32 bits do not tell them apart. Object units.
pub(super) const NEAR: f64 = 1e-7;
/// Edges that differ by less lie on each other, radians.
const NO_ANGLE: f64 = 1e-6;

/// The chains of a contour, each of at least three points. Points that are as near as [`NEAR`] to
/// the one before are left out, and those at which a chain turns back along itself.
pub(super) fn cleaned(chains: &[Chain]) -> Vec<Chain> {
    chains.iter().filter_map(clean).collect()
}

fn clean(chain: &Chain) -> Option<Chain> {
    let mut points: Vec<DVec2> = Vec::with_capacity(chain.points.len());
    for &point in &chain.points {
        while let [.., before, last] = points[..]
            && turns_back(before, last, point)
        {
            points.pop();
        }
        if points.last().is_none_or(|last| !is_near(*last, point)) {
            points.push(point);
        }
    }
    while let ([first, second, ..], [.., before, last]) = (&points[..], &points[..])
        && chain.closed
        && points.len() > 2
    {
        if is_near(*first, *last) || turns_back(*before, *last, *first) {
            points.pop();
        } else if turns_back(*last, *first, *second) {
            points.remove(0);
        } else {
            break;
        }
    }
    (points.len() > 2).then_some(Chain {
        points,
        closed: chain.closed,
    })
}

fn is_near(a: DVec2, b: DVec2) -> bool {
    a.distance_squared(b) < NEAR * NEAR
}

/// Returns true if the edges that meet in `tip` are less than [`NEAR`] apart.
fn turns_back(before: DVec2, tip: DVec2, after: DVec2) -> bool {
    let [a, b] = [before, after].map(|p| p - tip);
    a.dot(b) > 0.0 && a.perp_dot(b).abs() < NEAR * a.length().max(b.length())
}

/// A point of a chain, with its neighbours.
#[derive(Clone, Copy)]
struct Visit {
    point: DVec2,
    before: Option<usize>,
    after: Option<usize>,
}

/// A part of the solid at a point: the visit whose edge arrives with the part on its left, and the
/// one whose edge leaves.
struct Part {
    from: usize,
    to: usize,
    /// The angle between the edges, radians.
    angle: f64,
}

/// The chains of a solid whose parts touch, each part with chains of its own that are moved into it
/// by at most `by` where they touch. `None` if nothing touches off the axis.
pub(super) fn parted(chains: &[Chain], by: f64) -> Option<Vec<Chain>> {
    let old = visits(chains);
    let groups = meetings(&old);
    let mut visits = old.clone();
    for part in groups.iter().flat_map(|group| parts(&old, group)) {
        let Part { from, to, angle } = part;
        let Some([arriving, leaving]) = edges(&old, from, to) else {
            continue;
        };
        let inward = DVec2::from_angle(-0.5 * angle).rotate(arriving.normalize_or_zero());
        let room = arriving
            .length()
            .min(leaving.length())
            .min(old[from].point.x);
        visits[from].point += inward * by.min(0.25 * room);
        visits[from].after = old[to].after;
    }
    (!groups.is_empty()).then(|| cleaned(&joined(&visits)))
}

fn visits(chains: &[Chain]) -> Vec<Visit> {
    let mut visits = Vec::new();
    for chain in chains {
        let (first, count) = (visits.len(), chain.points.len());
        let at = |k: usize| first + k % count;
        visits.extend(chain.points.iter().enumerate().map(|(k, &point)| Visit {
            point,
            before: (k > 0 || chain.closed).then(|| at(k + count - 1)),
            after: (k + 1 < count || chain.closed).then(|| at(k + 1)),
        }));
    }
    visits
}

/// Visits of one place, two or more, off the axis.
fn meetings(visits: &[Visit]) -> Vec<Vec<usize>> {
    let mut cells: HashMap<[i64; 2], usize> = HashMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (v, visit) in visits.iter().enumerate() {
        if visit.before.is_none() || visit.after.is_none() {
            continue; // on the axis
        }
        let [x, y] = (visit.point / NEAR).floor().to_array().map(|c| c as i64);
        let around = (0..9).map(|k| [x + k % 3 - 1, y + k / 3 - 1]);
        let mut known = around.filter_map(|cell| cells.get(&cell)).copied();
        match known.find(|group| is_near(visits[groups[*group][0]].point, visit.point)) {
            Some(group) => groups[group].push(v),
            None => {
                cells.insert([x, y], groups.len());
                groups.push(vec![v]);
            }
        }
    }
    groups.retain(|group| group.len() > 1);
    groups
}

/// The edges from a place to where one visit comes from, and to where another goes.
fn edges(visits: &[Visit], from: usize, to: usize) -> Option<[DVec2; 2]> {
    let [arriving, leaving] = [(from, visits[from].before?), (to, visits[to].after?)]
        .map(|(v, other)| visits[other].point - visits[v].point);
    Some([arriving, leaving])
}

/// The parts of the solid at a place: clockwise from an edge that arrives is the solid, up to the
/// nearest edge that leaves. Edges that lie on each other have no solid between them, or no gap.
fn parts(visits: &[Visit], group: &[usize]) -> Vec<Part> {
    let paired = |rounding: f64| {
        let mut all: Vec<Part> = Vec::new();
        for (&from, &to) in group.iter().flat_map(|a| group.iter().map(move |b| (a, b))) {
            if let Some([arriving, leaving]) = edges(visits, from, to) {
                let angle = -arriving.angle_to(leaving) + rounding;
                let angle = angle.rem_euclid(TAU) - rounding;
                all.push(Part { from, to, angle });
            }
        }
        all.sort_by(|a, b| a.angle.total_cmp(&b.angle));
        let mut parts: Vec<Part> = Vec::new();
        for part in all {
            if parts.iter().all(|p| p.from != part.from && p.to != part.to) {
                parts.push(part);
            }
        }
        parts
    };
    let apart = paired(-NO_ANGLE);
    let sum: f64 = apart.iter().map(|part| part.angle).sum();
    if sum < TAU + NO_ANGLE {
        apart
    } else {
        paired(NO_ANGLE)
    }
}

/// The chains that visits form: those that begin on the axis, then closed ones.
fn joined(visits: &[Visit]) -> Vec<Chain> {
    let mut used = vec![false; visits.len()];
    let mut chains = Vec::new();
    for closed in [false, true] {
        for first in 0..visits.len() {
            if used[first] || (!closed && visits[first].before.is_some()) {
                continue;
            }
            let mut points = Vec::new();
            let mut next = Some(first);
            while let Some(v) = next.filter(|v| !used[*v]) {
                used[v] = true;
                points.push(visits[v].point);
                next = visits[v].after;
            }
            chains.push(Chain { points, closed });
        }
    }
    chains
}
