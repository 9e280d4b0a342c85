//! Items in a tree of boxes, for searches whose cost hardly grows with their number.

use glam::DVec3;

/// A box, from its lowest corner to its highest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

/// The tree over a list that [`Tree::new`] has sorted.
#[derive(Debug)]
pub(super) struct Tree(Vec<Node>);

#[derive(Debug)]
struct Node {
    bounds: Bounds,
    /// In a leaf: the first item. Otherwise: the right child (the left one follows its parent).
    next: usize,
    /// Number of items; 0 for a node that is not a leaf.
    count: usize,
}

impl Tree {
    /// Sorts the items into the tree's order, at most `leaf` of them in a leaf.
    pub fn new<T>(items: &mut [T], leaf: usize, bounds: impl Fn(&T) -> Bounds) -> Self {
        let mut tree = Self(Vec::new());
        if !items.is_empty() {
            tree.build(items, 0, leaf, &bounds);
        }
        tree
    }

    /// `first` is the index of the slice in the whole.
    fn build<T>(
        &mut self,
        items: &mut [T],
        first: usize,
        leaf: usize,
        bounds: &impl Fn(&T) -> Bounds,
    ) {
        let both = |a: Bounds, b: Bounds| Bounds {
            min: a.min.min(b.min),
            max: a.max.max(b.max),
        };
        let empty = Bounds {
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        };
        let whole = items.iter().map(bounds).fold(empty, both);
        let (place, is_leaf) = (self.0.len(), items.len() <= leaf);
        self.0.push(Node {
            bounds: whole,
            next: first,
            count: if is_leaf { items.len() } else { 0 },
        });
        if is_leaf {
            return;
        }
        let axis = (whole.max - whole.min).max_position();
        let middle = |item: &T| {
            let Bounds { min, max } = bounds(item);
            min[axis] + max[axis]
        };
        // Stable, so that one scene gives one tree.
        items.sort_by(|p, q| middle(p).total_cmp(&middle(q)));
        let half = items.len() / 2;
        let (left, right) = items.split_at_mut(half);
        self.build(left, first, leaf, bounds);
        self.0[place].next = self.0.len();
        self.build(right, first + half, leaf, bounds);
    }

    /// Calls `visit` with the index of every item in boxes whose `least` value is not above
    /// `best`, near boxes first; `visit` returns the new best.
    pub fn search(
        &self,
        mut best: f64,
        least: impl Fn(&Bounds) -> f64,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        let Some(root) = self.0.first() else {
            return;
        };
        // Halving 2^62 items takes no more.
        let mut stack = [(0, 0.0); 64];
        stack[0].1 = least(&root.bounds);
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (index, bound) = stack[height];
            let node = &self.0[index];
            // Infinity is the value of a box without a point in question.
            if bound > best || bound == f64::INFINITY {
                continue;
            }
            if node.count > 0 {
                for item in node.next..node.next + node.count {
                    best = best.min(visit(item));
                }
                continue;
            }
            let mut children = [index + 1, node.next].map(|c| (c, least(&self.0[c].bounds)));
            // The nearer child is visited first: it goes on top.
            if children[0].1 <= children[1].1 {
                children.swap(0, 1);
            }
            stack[height..height + 2].copy_from_slice(&children);
            height += 2;
        }
    }
}
