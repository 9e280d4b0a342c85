//! A tree of rectangles that tests if any segment is nearer to a point than a given distance.

use crate::profile::Segment;
use glam::DVec2;

const LEAF: usize = 4;

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec2,
    high: DVec2,
    /// In a leaf, its first segment. Otherwise its right child; the left child follows the node.
    next: u32,
    /// Number of segments of a leaf; 0 if the node is not a leaf.
    count: u32,
}

#[derive(Clone, Copy, Debug)]
struct Line {
    a: DVec2,
    unit: DVec2,
    length: f64,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    lines: Vec<Line>,
    nodes: Vec<Node>,
}

impl Tree {
    pub fn new(segments: &[Segment]) -> Self {
        let mut sorted: Vec<Segment> = segments.to_vec();
        let mut nodes = Vec::new();
        if !sorted.is_empty() {
            build(&mut sorted, 0, &mut nodes);
        }
        let lines = sorted
            .iter()
            .map(|s| Line {
                a: s.a,
                unit: (s.b - s.a).normalize_or_zero(),
                length: s.a.distance(s.b),
            })
            .collect();
        Self { lines, nodes }
    }

    /// True if a segment is nearer to `p` than `distance`. False if `distance` is not positive.
    pub fn any_nearer(&self, p: DVec2, distance: f64) -> bool {
        if distance <= 0.0 || self.nodes.is_empty() {
            return false;
        }
        let square = distance * distance;
        let mut stack = [0u32; 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let index = stack[height];
            let node = &self.nodes[index as usize];
            let away = (node.low - p).max(p - node.high).max(DVec2::ZERO);
            if away.length_squared() >= square {
                continue;
            }
            if node.count > 0 {
                let lines = &self.lines[node.next as usize..][..node.count as usize];
                if lines.iter().any(|l| l.nearer(p, distance, square)) {
                    return true;
                }
            } else if height + 2 <= stack.len() {
                stack[height] = node.next;
                stack[height + 1] = index + 1;
                height += 2;
            }
        }
        false
    }
}

impl Line {
    fn nearer(&self, p: DVec2, distance: f64, square: f64) -> bool {
        let from_a = p - self.a;
        let place = from_a.dot(self.unit);
        if place <= 0.0 {
            from_a.length_squared() < square
        } else if place >= self.length {
            from_a.distance_squared(self.unit * self.length) < square
        } else {
            // The distance along the normal is exact to the last bits.
            from_a.perp_dot(self.unit).abs() < distance
        }
    }
}

fn build(segments: &mut [Segment], first: u32, nodes: &mut Vec<Node>) {
    let bound = |f: fn(DVec2, DVec2) -> DVec2, start: DVec2| {
        segments.iter().fold(start, |m, s| f(m, f(s.a, s.b)))
    };
    let (low, high) = (
        bound(DVec2::min, DVec2::INFINITY),
        bound(DVec2::max, DVec2::NEG_INFINITY),
    );
    let place = nodes.len();
    let leaf = segments.len() <= LEAF;
    nodes.push(Node {
        low,
        high,
        next: first,
        count: if leaf { segments.len() as u32 } else { 0 },
    });
    if leaf {
        return;
    }
    let axis = usize::from(high.y - low.y > high.x - low.x);
    let half = segments.len() / 2;
    segments.select_nth_unstable_by(half, |p, q| {
        (p.a[axis] + p.b[axis]).total_cmp(&(q.a[axis] + q.b[axis]))
    });
    let (left, right) = segments.split_at_mut(half);
    build(left, first, nodes);
    nodes[place].next = nodes.len() as u32;
    build(right, first + half as u32, nodes);
}
