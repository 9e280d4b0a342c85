//! Hierarchies of boxes around copies, which rays from the eye and towards lights walk. Nothing
//! here depends on the view.
//!
//! A hierarchy is a heap: the children of node `k` are `2 k` and `2 k + 1`, and all copies are on
//! one level, so a walk needs no stack. Boxes have 16 bits per coordinate, in steps of one grid
//! around all copies.

use super::projector::Cylinder;
use super::{Conditions, PlanObject};
use crate::scene::{Placement, ends};
use crate::shader::WalkNode;
use crate::shader::generated::INNER_NODE;
use glam::{DMat3, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// Steps of the grid along each axis.
const STEPS: f64 = 65535.0;
/// Least extent of the grid along an axis, as a part of the largest one.
const FLATTEST: f64 = 1e-6;
/// Number of leaves from which subtrees are filled in parallel.
const PARALLEL: usize = 2048;
/// Extent of a large copy, as a part of the extent of all. Boxes of nodes above a large copy
/// contain little more than it, so large copies are in a subtree of their own.
const LARGE: f64 = 0.25;
/// Numbers of leaves of which large ones are told from others. The heap has up to twice as many
/// nodes then.
const MANY: Range<u32> = 64..1 << 17;

#[derive(Clone, Copy, Debug)]
struct Leaf {
    instance: u32,
    low: DVec3,
    high: DVec3,
}

/// The grid of the boxes of hierarchies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Grid {
    pub low: DVec3,
    /// Length of a step along each axis.
    pub unit: DVec3,
}

/// Objects that share a pipeline, a set of textures and a hierarchy of their copies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    pub objects: Vec<u32>,
    /// Index of the hierarchy's first node in [`Walks::nodes`].
    pub root: u32,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Walks {
    pub grid: Grid,
    pub nodes: Vec<WalkNode>,
    /// Index of the first node of the copies that cast shadows; `None` if nothing is shaded in
    /// shadow.
    pub casters: Option<u32>,
    /// Objects whose path is [`DrawPath::Walk`](super::DrawPath::Walk).
    pub(super) layers: Vec<Layer>,
}

impl Layer {
    pub fn copies(&self, objects: &[PlanObject]) -> usize {
        let placements = |n: &u32| objects[*n as usize].object.placements().len();
        self.objects.iter().map(placements).sum()
    }
}

impl Leaf {
    fn new(instance: u32, placement: &Placement, solid: &Cylinder) -> Self {
        let turn = DMat3::from_quat(placement.rotation.normalize());
        let scale = placement.scale;
        let middle = solid.axis.extend(0.5 * (solid.low + solid.high));
        let middle = placement.position + turn * (scale * middle);
        let [x, y] = [turn.x_axis * scale.x, turn.y_axis * scale.y].map(|way| way * solid.radius);
        let disc = DVec3::new(x.x.hypot(y.x), x.y.hypot(y.y), x.z.hypot(y.z));
        let half = disc + (turn.z_axis * scale.z).abs() * (0.5 * (solid.high - solid.low));
        Self {
            instance,
            low: middle - half,
            high: middle + half,
        }
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }
}

impl Grid {
    fn around(leaves: impl Iterator<Item = Leaf>) -> Self {
        let (low, high) = ends(leaves.flat_map(|leaf| [leaf.low, leaf.high]));
        // Steps far below those of other axes have no digits in 32 bits, where the eye counts them.
        let size = high - low;
        let size = size.max(DVec3::splat(FLATTEST * size.max_element()));
        Self {
            low,
            unit: size / STEPS,
        }
    }

    /// The node of a copy, whose box contains the copy's.
    fn node(&self, leaf: &Leaf) -> WalkNode {
        let steps = |p: DVec3| (p - self.low) / self.unit;
        let low = steps(leaf.low)
            .floor()
            .clamp(DVec3::ZERO, DVec3::splat(STEPS));
        let high = steps(leaf.high)
            .ceil()
            .clamp(DVec3::ZERO, DVec3::splat(STEPS));
        WalkNode {
            bounds: std::array::from_fn(|axis| low[axis] as u32 | (high[axis] as u32) << 16),
            index: leaf.instance,
        }
    }
}

fn around(a: &WalkNode, b: &WalkNode) -> WalkNode {
    let join = |a: u32, b: u32| (a & 0xffff).min(b & 0xffff) | (a >> 16).max(b >> 16) << 16;
    WalkNode {
        bounds: std::array::from_fn(|axis| join(a.bounds[axis], b.bounds[axis])),
        index: INNER_NODE,
    }
}

/// Fills the last level of a subtree, which has room for all leaves. Their order changes.
fn fill(leaves: &mut [Leaf], level: &mut [WalkNode], grid: &Grid) {
    let (half, room) = (leaves.len().div_ceil(2), level.len() / 2);
    if let [leaf] = leaves {
        // Nodes without a copy have a corner of its box, which few rays meet.
        let node = grid.node(leaf);
        level.fill(WalkNode {
            bounds: node.bounds.map(|ends| (ends & 0xffff) * 0x1_0001),
            index: INNER_NODE,
        });
        level[0] = node;
        return;
    }
    let (low, high) = ends(leaves.iter().map(Leaf::middle));
    let axis = (high - low).max_position();
    leaves.select_nth_unstable_by(half, |a, b| {
        let by_place = a.middle()[axis].total_cmp(&b.middle()[axis]);
        by_place.then(a.instance.cmp(&b.instance))
    });
    let parallel = leaves.len() >= PARALLEL;
    let ((left, right), (near, far)) = (leaves.split_at_mut(half), level.split_at_mut(room));
    if parallel {
        rayon::join(|| fill(left, near, grid), || fill(right, far, grid));
    } else {
        fill(left, near, grid);
        fill(right, far, grid);
    }
}

/// Orders leaves so that large ones come first. Returns their number, or 0 if all are alike.
fn large_first(leaves: &mut [Leaf], grid: &Grid) -> usize {
    let least = LARGE * STEPS * grid.unit.max_element();
    let is_large = |leaf: &Leaf| (leaf.high - leaf.low).max_element() > least;
    let count = leaves.iter().filter(|leaf| is_large(leaf)).count();
    if !MANY.contains(&(leaves.len() as u32)) || [0, leaves.len()].contains(&count) {
        return 0;
    }
    leaves.sort_unstable_by_key(|leaf| !is_large(leaf));
    count
}

/// Adds a hierarchy over copies, whose order changes. Returns the index of its first node.
fn add(nodes: &mut Vec<WalkNode>, leaves: &mut [Leaf], grid: &Grid) -> u32 {
    let root = nodes.len();
    let count = large_first(leaves, grid);
    let (large, small) = leaves.split_at_mut(count);
    let half = large.len().max(small.len()).next_power_of_two();
    let divides = !large.is_empty() && !small.is_empty();
    let width = if divides { 2 * half } else { half };
    nodes.resize(root + 2 * width, WalkNode::default());
    let all = &mut nodes[root..];
    all[0].index = width as u32;
    let (first, second) = all[width..].split_at_mut(width - half);
    for (leaves, level) in [(large, first), (small, second)] {
        if !leaves.is_empty() {
            fill(leaves, level, grid);
        }
    }
    let mut level = width / 2;
    while level > 0 {
        let (parents, children) = all[level..].split_at_mut(level);
        let pairs = children.as_chunks::<2>().0;
        let parents = parents.par_iter_mut().with_min_len(PARALLEL);
        parents
            .zip(pairs)
            .for_each(|(to, [a, b])| *to = around(a, b));
        level /= 2;
    }
    root as u32
}

impl Walks {
    /// The hierarchies of the objects that rays from the eye walk, and of all objects if rays
    /// towards lights do.
    pub fn new(objects: &[PlanObject], with: &Conditions, shadowed: bool) -> Self {
        let mut layers: Vec<Layer> = Vec::new();
        let mut numbers = HashMap::new();
        for (n, of) in (0..).zip(objects).filter(|(_, of)| with.walks_to(of)) {
            let next = layers.len();
            let layer = *numbers.entry((of.technique, of.textures)).or_insert(next);
            if layer == next {
                let objects = Vec::new();
                layers.push(Layer { objects, root: 0 });
            }
            layers[layer].objects.push(n);
        }
        let mut sets: Vec<Vec<Leaf>> = Vec::new();
        sets.extend(layers.iter().map(|layer| leaves(objects, &layer.objects)));
        // A layer of all objects is the hierarchy of those that cast shadows, too.
        let is_all = layers.len() == 1 && layers[0].objects.len() == objects.len();
        if shadowed && !is_all && !objects.is_empty() {
            let all: Vec<u32> = (0..objects.len() as u32).collect();
            sets.push(leaves(objects, &all));
        }
        if sets.is_empty() {
            return Self::default();
        }
        let grid = Grid::around(sets.iter().flatten().copied());
        let mut nodes = Vec::new();
        let mut roots = sets.iter_mut().map(|set| add(&mut nodes, set, &grid));
        for layer in &mut layers {
            layer.root = roots.next().unwrap_or_default();
        }
        let casters = match shadowed {
            true if is_all => Some(layers[0].root),
            true => roots.next(),
            false => None,
        };
        drop(roots);
        // A walk reads the node after the last one.
        nodes.push(WalkNode::default());
        Self {
            grid,
            nodes,
            casters,
            layers,
        }
    }

    /// The ends of the box of a layer's copies.
    pub(super) fn bounds(&self, layer: &Layer) -> [DVec3; 2] {
        let ends = self.nodes[layer.root as usize + 1].bounds;
        [0, 16].map(|shift| {
            let steps = ends.map(|ends| f64::from(ends >> shift & 0xffff));
            self.grid.low + self.grid.unit * DVec3::from(steps)
        })
    }
}

fn leaves(objects: &[PlanObject], numbers: &[u32]) -> Vec<Leaf> {
    let mut all = Vec::new();
    for &n in numbers {
        let of = &objects[n as usize];
        let copies = of.object.placements().par_iter().enumerate();
        all.par_extend(copies.map(|(copy, placement)| {
            Leaf::new(of.first_instance + copy as u32, placement, &of.shape)
        }));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaf(n: u32) -> Leaf {
        let part = |step: f64| (f64::from(n) * step).fract();
        let middle = DVec3::new(part(0.754_877), part(0.569_840), 0.1 * part(0.41)) * 100.0;
        // Copies far larger than others, and many at one place.
        let size = if n.is_multiple_of(97) {
            30.0
        } else {
            0.2 + part(0.3)
        };
        let middle = if n.is_multiple_of(5) {
            DVec3::splat(7.0)
        } else {
            middle
        };
        let half = DVec3::new(size, size, 0.5 * size);
        Leaf {
            instance: n,
            low: middle - half,
            high: middle + half,
        }
    }

    fn steps(bounds: [u32; 3]) -> [[u32; 3]; 2] {
        [bounds.map(|b| b & 0xffff), bounds.map(|b| b >> 16)]
    }

    /// Copies in one plane, of almost no height, have a grid that 32 bits hold, also from afar.
    #[test]
    fn flat_crowds_have_a_grid() {
        let flat = |n: u32| {
            let middle = DVec3::new(f64::from(n), f64::from(n % 7), 5.0);
            let half = DVec3::new(0.4, 0.4, 1e-200);
            let (low, high) = (middle - half, middle + half);
            let leaf = leaf(n);
            Leaf { low, high, ..leaf }
        };
        let grid = Grid::around((0..100).map(flat));
        let eye = DVec3::splat(1e9) / grid.unit;
        assert!(grid.unit.as_vec3().min_element() > 0.0 && eye.as_vec3().is_finite());
    }

    /// Each copy is once in the heap, within its node's box and those of all nodes above.
    #[test]
    fn a_heap_holds_every_copy_once_and_within_its_boxes() {
        for count in [1, 2, 3, 64, 65, 100, 5000] {
            let mut leaves: Vec<Leaf> = (0..count).map(leaf).collect();
            let grid = Grid::around(leaves.iter().copied());
            let mut nodes = vec![WalkNode::default(); 3];
            let root = add(&mut nodes, &mut leaves, &grid) as usize;
            assert_eq!(root, 3);
            let heap = &nodes[root..];
            let width = heap[0].index as usize;
            let most = if count < MANY.start { 2 } else { 4 };
            assert!(heap.len() == 2 * width && width < most * count as usize);
            let mut seen = vec![0; count as usize];
            for (k, node) in heap.iter().enumerate().skip(width) {
                if node.index == INNER_NODE {
                    continue;
                }
                seen[node.index as usize] += 1;
                let copy = leaf(node.index);
                let [low, high] = steps(node.bounds)
                    .map(|end| grid.low + grid.unit * DVec3::from(end.map(f64::from)));
                // One copy of 97 is large; these are in a half of their own.
                let is_large = node.index.is_multiple_of(97) && count >= MANY.start;
                assert_eq!(is_large, count >= MANY.start && k < width + width / 2);
                let slack = 1e-9;
                assert!(
                    (low - copy.low).max_element() < slack,
                    "{count}, {}",
                    node.index
                );
                assert!(
                    (copy.high - high).max_element() < slack,
                    "{count}, {}",
                    node.index
                );
                let mut above = k / 2;
                while above > 0 {
                    let ([a, b], [c, d]) = (steps(heap[above].bounds), steps(node.bounds));
                    let holds = |axis: usize| a[axis] <= c[axis] && d[axis] <= b[axis];
                    assert!(
                        (0..3).all(holds) && heap[above].index == INNER_NODE,
                        "{above}"
                    );
                    above /= 2;
                }
            }
            assert!(seen.iter().all(|n| *n == 1), "{count}");
        }
    }
}
