//! Proxy hulls as the vertex shader grows them.

use crate::maps::envelope::Envelope;
use crate::shader::generated::{FRUSTUM_VECTORS, HULL_SIDES, PATCHES_PER_CELL, SIDE_ROWS};
use crate::surface::{GpuPatch, ProxyHull, ProxyHullOptions, QuadricPatch, solid_radii};

/// Components that a hull's vertices hand to its fragments: what all have, then a cell's quadrics
/// and guards, and the box's sides.
pub(crate) const COMPONENTS: u32 = 4 * (12 + 2 * PATCHES_PER_CELL);

/// Components that these vertices put out: a position and four distances to clip by, besides.
pub(crate) const OUTPUTS: u32 = COMPONENTS + 8;

/// A hull: its frusta in the layout of `hull.vert`, then the rows of `sides.vert`.
pub(crate) struct GpuProxyHull {
    pub hull: ProxyHull,
    pub vectors: Vec<[u32; 4]>,
    /// Whether two parts of the boundary meet in a circle, where no wall between their shells can
    /// stand.
    pub touches: bool,
}

impl GpuProxyHull {
    pub fn new(patches: &[QuadricPatch]) -> Self {
        let options = ProxyHullOptions {
            sides: HULL_SIDES,
            patches_per_cell: PATCHES_PER_CELL,
            ..ProxyHullOptions::default()
        };
        let hull = ProxyHull::new(patches, &options);
        let mut vectors = pack(&hull, patches);
        vectors.extend(rows(&hull, patches));
        let touches = touches(patches);
        Self {
            hull,
            vectors,
            touches,
        }
    }

    /// The convex hull of an envelope.
    pub fn convex(envelope: &Envelope) -> Self {
        let hull = ProxyHull::convex(&envelope.convex(), HULL_SIDES);
        let vectors = pack(&hull, &[]);
        Self {
            hull,
            vectors,
            touches: false,
        }
    }
}

/// Vertices of the strips of all sides.
pub(crate) const SIDE_VERTICES: u32 = 6 * 4 * SIDE_ROWS;

/// The rows of `sides.vert`: lowest and highest `z`; the radius that shells stay within, and the
/// one within which the row and those beside it are solid.
fn rows(hull: &ProxyHull, patches: &[QuadricPatch]) -> impl Iterator<Item = [u32; 4]> {
    let solid = solid_radii(patches);
    hull.rows::<{ SIDE_ROWS as usize }>()
        .into_iter()
        .map(move |[low, high, radius]| {
            let step = high - low;
            let of = |z: f64| (z * solid.len() as f64).floor();
            let (first, last) = (of(low - step), of(high + step));
            let within = if first < 0.0 || last >= solid.len() as f64 {
                0.0
            } else {
                solid[first as usize..=last as usize]
                    .iter()
                    .fold(f64::INFINITY, |m, r| m.min(*r))
            };
            [low as f32, high as f32, radius as f32, within as f32].map(f32::to_bits)
        })
}

/// Points of an outline nearer than this are one, object units: what the union of loops rounds to.
const ONE_POINT: f64 = 1e-6;

/// Whether two patches that do not follow each other begin at one point off the axis.
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

/// A hull's frusta in the layout of `hull.vert`.
fn pack(hull: &ProxyHull, patches: &[QuadricPatch]) -> Vec<[u32; 4]> {
    let mut out = Vec::with_capacity(hull.frusta.len() * FRUSTUM_VECTORS as usize);
    // A guard that nothing passes.
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

/// How many corners the triangles of so many frusta have.
pub(crate) fn corners(frusta: u32) -> u32 {
    6 * HULL_SIDES * frusta
}

/// Corners that every frustum's triangles join, in the numbering of `hull.vert`: `2 n` vertices a
/// frustum, the rings one after the other.
pub(crate) fn indices(frusta: usize) -> Vec<u32> {
    let n = HULL_SIDES;
    (0..u32::try_from(frusta).unwrap_or(0))
        .flat_map(|frustum| {
            (0..n).flat_map(move |side| {
                let (a, b) = (frustum * 2 * n, frustum * 2 * n + n);
                let next = (side + 1) % n;
                [a + side, a + next, b + next, a + side, b + next, b + side]
            })
        })
        .collect()
}
