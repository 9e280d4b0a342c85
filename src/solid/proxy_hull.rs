//! Proxy hulls in the form that the vertex shader expands.

use crate::shader::generated::{FRUSTUM_VECTORS, PATCHES_PER_CELL, RING_CORNERS};
use crate::surface::{GpuPatch, ProxyHull, ProxyHullOptions, QuadricPatch};

/// Components that a hull's vertices pass to its fragments: the common ones, then a cell's quadrics
/// and guards, and the frustum's number.
pub(crate) const COMPONENTS: u32 = 4 * (12 + 2 * PATCHES_PER_CELL);

/// All output components of these vertices: a position is added.
pub(crate) const OUTPUTS: u32 = COMPONENTS + 4;

/// A hull, and its frusta in the layout of `proxy_cells.vert`.
pub(crate) struct GpuProxyHull {
    pub hull: ProxyHull,
    pub vectors: Vec<[u32; 4]>,
    /// True if two parts of the boundary meet in a circle, which leaves no room for a wall between
    /// their shells.
    pub touches: bool,
}

impl GpuProxyHull {
    pub fn new(patches: &[QuadricPatch]) -> Self {
        let options = ProxyHullOptions {
            sides: RING_CORNERS,
            patches_per_cell: PATCHES_PER_CELL,
            ..ProxyHullOptions::default()
        };
        let hull = ProxyHull::new(patches, &options);
        Self {
            vectors: pack(&hull, patches),
            touches: touches(patches),
            hull,
        }
    }
}

/// Points of an outline at a smaller distance count as one, object units. The union of loops rounds
/// to this.
const ONE_POINT: f64 = 1e-6;

/// True if two patches that do not follow each other begin at one point off the axis.
fn touches(patches: &[QuadricPatch]) -> bool {
    let mut order: Vec<usize> = (0..patches.len()).collect();
    let start = |k: usize| patches[k].start;
    order.sort_unstable_by(|&a, &b| start(a).y.total_cmp(&start(b).y));
    let follow = |a: usize, b: usize| {
        let next = |k: usize| patches[k].next.map(|n| n as usize);
        next(a) == Some(b) || next(b) == Some(a)
    };
    order.iter().enumerate().any(|(n, &a)| {
        let level = |b: &&usize| start(**b).y - start(a).y <= ONE_POINT;
        let near = |&b: &usize| start(a).distance(start(b)) <= ONE_POINT;
        let others = order[n + 1..].iter().take_while(level);
        let mut apart = others.filter(|&&b| !follow(a, b));
        start(a).x > ONE_POINT && apart.any(near)
    })
}

fn pack(hull: &ProxyHull, patches: &[QuadricPatch]) -> Vec<[u32; 4]> {
    let mut out = Vec::with_capacity(hull.frusta.len() * FRUSTUM_VECTORS as usize);
    // A guard that no point passes.
    let none = [[0.0; 4], [0.0, 0.0, 1.0, 0.0]];
    for frustum in &hull.frusta {
        let [from, to] = [frustum.from, frustum.to];
        out.push([from[0], from[1], to[0], to[1]].map(f32::to_bits));
        let first = frustum.first as usize;
        for k in 0..PATCHES_PER_CELL as usize {
            let record = patches
                .get(first + k)
                .filter(|_| k < frustum.count as usize);
            let vectors = record.map(|p| GpuPatch::new(p, first + k));
            let vectors = vectors.map_or(none, |r| [r.quadric, r.guard]);
            out.extend(vectors.map(|v| v.map(f32::to_bits)));
        }
    }
    debug_assert_eq!(out.len(), hull.frusta.len() * FRUSTUM_VECTORS as usize);
    out
}

/// Number of vertices of a shape box, as a strip.
const BOX_VERTICES: u32 = 14;

/// Indices that all proxies share: those of the box, then of this many frusta of two rings of
/// vertices each.
pub(crate) fn indices(frusta: u32) -> Vec<u32> {
    // Every second triangle of a strip has the reverse winding.
    let boxes = (0..BOX_VERTICES - 2).flat_map(|k| match k % 2 {
        0 => [k, k + 1, k + 2],
        _ => [k + 1, k, k + 2],
    });
    let n = RING_CORNERS;
    let frusta = (0..frusta).flat_map(move |frustum| {
        (0..n).flat_map(move |side| {
            let (a, b) = (frustum * 2 * n, frustum * 2 * n + n);
            let next = (side + 1) % n;
            [a + side, a + next, b + next, a + side, b + next, b + side]
        })
    });
    boxes.chain(frusta).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::generated::BOX_INDICES;

    /// Draws begin at the indices of the plan.
    #[test]
    fn indices_of_frusta_follow_those_of_boxes() {
        let all = indices(3);
        let (boxes, frusta) = all.split_at(BOX_INDICES as usize);
        assert!(boxes.iter().all(|v| *v < BOX_VERTICES));
        assert_eq!(frusta.len() as u32, 3 * 6 * RING_CORNERS);
        assert_eq!(frusta.iter().max(), Some(&(3 * 2 * RING_CORNERS - 1)));
    }
}
