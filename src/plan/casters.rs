//! A hierarchy of boxes around copies, which rays towards lights walk. The shader walks it without
//! a stack: nodes are in depth-first order, and inner ones hold the index of the node after their subtree
//! (Smits 1998). Splits are binned by the surface area heuristic (Wald 2007).

use super::tiles::Cylinder;
use crate::scene::Placement;
use crate::shader::CasterNode;
use crate::shader::generated::INNER_NODE;
use glam::{DMat3, DVec3, Vec3};

/// A copy and its box in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub instance: u32,
    /// Index of its shape map.
    pub map: u32,
    pub low: DVec3,
    pub high: DVec3,
}

/// The nodes, and the point of the world from which they are measured.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hierarchy {
    pub origin: DVec3,
    pub nodes: Vec<CasterNode>,
}

/// Number of leaves from which subtrees are built in parallel.
const PARALLEL: usize = 2048;
/// Number of bins in which leaves are counted for a split.
const BINS: usize = 16;
/// Relative margin of boxes: more than the roundings of 32 bits.
const SLACK: f32 = 1e-6;

impl Leaf {
    /// The box around a copy of a solid. `map`: index of its shape map.
    pub fn new(instance: u32, map: u32, placement: &Placement, solid: &Cylinder) -> Self {
        let turn = DMat3::from_quat(placement.rotation.normalize());
        let scale = placement.scale;
        let middle = solid.axis.extend(0.5 * (solid.low + solid.high));
        let middle = placement.position + turn * (scale * middle);
        let [x, y] = [turn.x_axis * scale.x, turn.y_axis * scale.y].map(|way| way * solid.radius);
        let disc = DVec3::new(x.x.hypot(y.x), x.y.hypot(y.y), x.z.hypot(y.z));
        let half = disc + (turn.z_axis * scale.z).abs() * (0.5 * (solid.high - solid.low));
        Self {
            instance,
            map,
            low: middle - half,
            high: middle + half,
        }
    }

    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }
}

impl Hierarchy {
    /// The root of a hierarchy without copies, whose box no ray meets.
    pub const EMPTY: CasterNode = CasterNode {
        middle: [0.0; 3],
        next: 1,
        half_size: [-1e30; 3],
        instance: INNER_NODE,
    };

    /// Builds the hierarchy over copies, whose order changes.
    pub fn new(leaves: &mut [Leaf]) -> Self {
        if leaves.is_empty() {
            return Self::default();
        }
        let (low, high) = bounds(leaves);
        let origin = 0.5 * (low + high);
        let mut nodes = vec![CasterNode::default(); 2 * leaves.len() - 1];
        fill(leaves, &mut nodes, 0, origin);
        Self { origin, nodes }
    }
}

/// Writes the nodes of a subtree. `first`: index of its root.
fn fill(leaves: &mut [Leaf], nodes: &mut [CasterNode], first: u32, origin: DVec3) {
    let next = first + nodes.len() as u32;
    let (low, high) = bounds(leaves);
    if let [leaf] = leaves {
        nodes[0] = node(low - origin, high - origin, leaf.map, leaf.instance);
        return;
    }
    nodes[0] = node(low - origin, high - origin, next, INNER_NODE);
    let count = split(leaves);
    let (left, right) = leaves.split_at_mut(count);
    let (before, after) = nodes[1..].split_at_mut(2 * count - 1);
    let second = first + 2 * count as u32;
    if left.len() + right.len() < PARALLEL {
        fill(left, before, first + 1, origin);
        fill(right, after, second, origin);
    } else {
        rayon::join(
            || fill(left, before, first + 1, origin),
            || fill(right, after, second, origin),
        );
    }
}

/// Orders leaves so that the first ones form one subtree and the others the second. Returns the
/// number of the first.
fn split(leaves: &mut [Leaf]) -> usize {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = leaves.iter().fold(none, |(low, high), leaf| {
        (low.min(leaf.middle()), high.max(leaf.middle()))
    });
    let size = high - low;
    let axis = (0..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
    let half = leaves.len() / 2;
    let count = if size[axis] > 0.0 {
        cheapest(leaves, axis, low[axis], size[axis]).unwrap_or(half)
    } else {
        half
    };
    let order = |a: &Leaf, b: &Leaf| {
        let by_place = a.middle()[axis].total_cmp(&b.middle()[axis]);
        by_place.then(a.instance.cmp(&b.instance))
    };
    leaves.select_nth_unstable_by(count, order);
    count
}

/// The number of leaves before the cheapest border between two bins. Returns none if all leaves are
/// in one bin.
fn cheapest(leaves: &[Leaf], axis: usize, low: f64, size: f64) -> Option<usize> {
    let empty = (0usize, DVec3::INFINITY, DVec3::NEG_INFINITY);
    let add = |a: (usize, DVec3, DVec3), b: (usize, DVec3, DVec3)| {
        (a.0 + b.0, a.1.min(b.1), a.2.max(b.2))
    };
    let mut bins = [empty; BINS];
    for leaf in leaves {
        let part = (leaf.middle()[axis] - low) / size * BINS as f64;
        let bin = &mut bins[(part as usize).min(BINS - 1)];
        *bin = add(*bin, (1, leaf.low, leaf.high));
    }
    let cost = |(count, low, high): (usize, DVec3, DVec3)| {
        let s = high - low;
        count as f64 * (s.x * s.y + s.y * s.z + s.z * s.x)
    };
    let mut behind = [empty; BINS];
    for k in (0..BINS - 1).rev() {
        behind[k] = add(behind[k + 1], bins[k + 1]);
    }
    let mut before = empty;
    let mut best = (f64::INFINITY, None);
    for k in 0..BINS - 1 {
        before = add(before, bins[k]);
        if before.0 == 0 || behind[k].0 == 0 {
            continue;
        }
        let both = cost(before) + cost(behind[k]);
        if both < best.0 {
            best = (both, Some(before.0));
        }
    }
    best.1
}

fn bounds(leaves: &[Leaf]) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    leaves.iter().fold(none, |(low, high), leaf| {
        (low.min(leaf.low), high.max(leaf.high))
    })
}

/// A node whose box contains the one from `low` to `high` in spite of roundings.
fn node(low: DVec3, high: DVec3, next: u32, instance: u32) -> CasterNode {
    let middle = (0.5 * (low + high)).as_vec3();
    let away = (high - middle.as_dvec3()).max(middle.as_dvec3() - low);
    let margin = Vec3::splat(SLACK * (middle.length() + away.as_vec3().length()));
    CasterNode {
        middle: middle.to_array(),
        next,
        half_size: (away.as_vec3() + margin).to_array(),
        instance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec2};

    fn field(count: u32) -> Vec<(Placement, Cylinder)> {
        let part = |k: u32, step: f64| (f64::from(k) * step).fract();
        let of = |k| {
            let size = if k % 97 == 0 { 300.0 } else { 1.0 };
            let placement = Placement {
                position: 100.0 * DVec3::new(part(k, 0.754_877), part(k, 0.569_840), 0.1),
                rotation: DQuat::from_rotation_x(f64::from(k)) * DQuat::from_rotation_z(1.0),
                scale: size * DVec3::new(0.5, 0.7, 0.5 + part(k, 0.41)),
            };
            let solid = Cylinder {
                axis: DVec2::new(0.1, -0.2),
                radius: 0.3,
                low: 0.1,
                high: 0.9,
            };
            (placement, solid)
        };
        (0..count).map(of).collect()
    }

    fn leaves(field: &[(Placement, Cylinder)]) -> Vec<Leaf> {
        let of = |(n, (placement, solid)): (u32, &(Placement, Cylinder))| {
            Leaf::new(n, 0, placement, solid)
        };
        (0..).zip(field).map(of).collect()
    }

    /// The copies whose boxes a walk that skips nodes without `p` meets, and the visited nodes.
    fn walk(all: &Hierarchy, p: DVec3) -> (Vec<u32>, usize) {
        let p = (p - all.origin).as_vec3();
        let (mut met, mut visited, mut k) = (Vec::new(), 0, 0);
        while let Some(node) = all.nodes.get(k) {
            visited += 1;
            let [middle, half] = [node.middle, node.half_size].map(Vec3::from);
            let meets = (p - middle).abs().cmple(half).all();
            if meets && node.instance != INNER_NODE {
                met.push(node.instance);
            }
            let leaf = node.instance != INNER_NODE;
            k = if meets || leaf {
                k + 1
            } else {
                node.next as usize
            };
        }
        (met, visited)
    }

    /// A walk to a point of a copy's surface finds that copy, and skips most others.
    #[test]
    fn a_walk_finds_every_copy_and_skips_most() {
        for count in [1, 2, 3, 100, 5000] {
            let field = field(count);
            let all = Hierarchy::new(&mut leaves(&field));
            assert_eq!(all.nodes.len() as u32, 2 * count - 1);
            let mut instances: Vec<u32> = all.nodes.iter().map(|node| node.instance).collect();
            instances.retain(|k| *k != INNER_NODE);
            instances.sort_unstable();
            assert!(instances.into_iter().eq(0..count));
            let mut work = 0;
            for (n, (copy, solid)) in (0..).zip(&field) {
                let way = DVec2::from_angle(f64::from(n)) * solid.radius + solid.axis;
                let z = if n % 2 == 0 { solid.low } else { solid.high };
                let p = copy.position + copy.rotation * (copy.scale * way.extend(z));
                let (met, visited) = walk(&all, p);
                assert!(met.contains(&n), "{n} of {count}");
                work += visited;
            }
            assert!(count < 5000 || work / 5000 < 500, "{work}");
        }
    }

    /// Copies at one place split into halves.
    #[test]
    fn coinciding_copies_form_a_balanced_tree() {
        let same = vec![field(1)[0]; 1000];
        let all = Hierarchy::new(&mut leaves(&same));
        assert_eq!(all.nodes[1].next, 1 + 2 * 500 - 1);
        assert!(Hierarchy::new(&mut []).nodes.is_empty());
    }
}
