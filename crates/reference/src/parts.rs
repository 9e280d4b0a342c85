//! The copies of a scene in a tree of boxes, so that thousands of them add little cost to a ray.

use super::solid::Solid;
use glam::{DMat3, DVec3};
use revmap::scene::Placement;
use std::sync::Arc;

/// A copy of an object.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub object: usize,
    pub instance: usize,
    pub solid: Arc<Solid>,
    pub placement: Placement,
}

#[derive(Debug)]
pub(super) struct Parts {
    list: Vec<Part>,
    nodes: Vec<Node>,
}

#[derive(Debug)]
struct Node {
    min: DVec3,
    max: DVec3,
    /// In a leaf: the part. Otherwise: the right child (the left one follows its parent).
    next: usize,
    leaf: bool,
}

impl Part {
    /// A ray in the object's own space; `t` has the same meaning.
    pub fn local(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        let Placement {
            position,
            rotation,
            scale,
        } = self.placement;
        let back = rotation.conjugate();
        (back * (origin - position) / scale, back * direction / scale)
    }

    /// The shape box's bounds in the world, slightly enlarged.
    fn bounds(&self) -> (DVec3, DVec3) {
        let Placement {
            position,
            rotation,
            scale,
        } = self.placement;
        let turn = DMat3::from_quat(rotation);
        let [low, high] = self.solid.faces();
        let (center, size) = (0.5 * (low + high) * scale, 0.5 * (high - low) * scale);
        let middle = position + rotation * center;
        let half =
            turn.x_axis.abs() * size.x + turn.y_axis.abs() * size.y + turn.z_axis.abs() * size.z;
        let half = half * (1.0 + 1e-6) + middle.abs() * 1e-12;
        (middle - half, middle + half)
    }
}

impl Parts {
    pub fn new(list: Vec<Part>) -> Self {
        let bounds: Vec<_> = list.iter().map(Part::bounds).collect();
        let mut order: Vec<usize> = (0..list.len()).collect();
        let mut nodes = Vec::with_capacity(2 * list.len());
        if !order.is_empty() {
            build(&mut order, &bounds, &mut nodes);
        }
        Self { list, nodes }
    }

    /// Calls `visit` for every part whose box the ray may enter before `nearest`; `visit` returns
    /// the new nearest `t`.
    pub fn along(&self, origin: DVec3, direction: DVec3, mut visit: impl FnMut(&Part) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let inverse = direction.recip();
        let mut nearest = f64::INFINITY;
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            if node.enter(origin, inverse).is_none_or(|t| t > nearest) {
                continue;
            }
            if node.leaf {
                nearest = nearest.min(visit(&self.list[node.next]));
                continue;
            }
            let near = |i: usize| {
                self.nodes[i]
                    .enter(origin, inverse)
                    .unwrap_or(f64::INFINITY)
            };
            let (left, right) = (index + 1, node.next);
            // The nearer child is on top.
            stack.extend(if near(left) <= near(right) {
                [right, left]
            } else {
                [left, right]
            });
        }
    }

    /// All parts, in the scene's order.
    pub fn list(&self) -> &[Part] {
        &self.list
    }
}

impl Node {
    /// The `t` at which a ray enters the box; 0 from within.
    fn enter(&self, origin: DVec3, inverse: DVec3) -> Option<f64> {
        let (a, b) = ((self.min - origin) * inverse, (self.max - origin) * inverse);
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            // A ray within the plane of a wall gives 0 times infinity. This sets no bound: `max`
            // and `min` ignore a NaN.
            enter = enter.max(a[axis].min(b[axis]));
            leave = leave.min(a[axis].max(b[axis]));
        }
        (enter <= leave).then_some(enter)
    }
}

fn build(order: &mut [usize], bounds: &[(DVec3, DVec3)], nodes: &mut Vec<Node>) {
    let min = order
        .iter()
        .fold(DVec3::INFINITY, |m, &k| m.min(bounds[k].0));
    let max = order
        .iter()
        .fold(DVec3::NEG_INFINITY, |m, &k| m.max(bounds[k].1));
    let place = nodes.len();
    nodes.push(Node {
        min,
        max,
        next: order[0],
        leaf: order.len() == 1,
    });
    if order.len() == 1 {
        return;
    }
    let axis = (max - min).max_position();
    let half = order.len() / 2;
    // The index breaks ties, so that one scene gives one tree.
    order.sort_by(|&p, &q| {
        let middle = |k: usize| bounds[k].0[axis] + bounds[k].1[axis];
        middle(p).total_cmp(&middle(q)).then(p.cmp(&q))
    });
    let (left, right) = order.split_at_mut(half);
    build(left, bounds, nodes);
    nodes[place].next = nodes.len();
    build(right, bounds, nodes);
}
