//! Tables of the searches that read no map, as vectors of 16 bytes for a shader. A table may be
//! stored anywhere in a buffer.

use crate::search::SearchTable;
use crate::shader::generated::{LISTED_PATCHES, PATCH_ROWS};
use crate::surface::{Contour, FitOptions, GpuPatch, QuadricPatch, Tables, fit_patches};

impl SearchTable {
    /// The library's own patches of a solid with its offset, exact, in the layout of
    /// `core/patch_tables.glsl`. GLSL searches them with `search/quadric.glsl`.
    pub fn of_patches(contour: &Contour) -> Self {
        Self::new(&fit_patches(contour, &FitOptions::default()), contour)
    }

    /// Patches of a contour in the layout of `patch_tables.glsl`.
    pub(crate) fn new(patches: &[QuadricPatch], contour: &Contour) -> Self {
        let tables = Tables::new(patches, PATCH_ROWS);
        let unit = unit(contour);
        let nodes = tables.nodes.iter().map(|node| node_word(node, unit));
        let words: Vec<u32> = nodes.chain(tables.rows.iter().copied()).collect();
        let ranges = |pair: &[GpuPatch]| {
            let range = |k: usize| {
                pair.get(k)
                    .map_or([0; 2], |r| [r.range[0], r.range[1]].map(f32::to_bits))
            };
            let [[a, b], [c, d]] = [range(0), range(1)];
            [a, b, c, d]
        };
        let records = tables.records.len();
        let mut vectors = Vec::with_capacity(records.div_ceil(2) + words.len() / 4 + 2 * records);
        vectors.extend(tables.records.chunks(2).rev().map(ranges));
        let before = index(vectors.len());
        vectors.extend(words.as_chunks().0);
        for record in &tables.records {
            vectors.extend([record.quadric, record.guard].map(|v| v.map(f32::to_bits)));
        }
        Self {
            vectors,
            before,
            facts: [0, 0, unit.to_bits()],
        }
    }
}

/// `e` in `e sqrt(q) h^2 / r`, by which roundings of 32 bits may move hits of lists along the axis, in halves of the
/// tolerance of the exact level (`is_imprecise` of `beam.glsl` derives it).
const ROUNDING: f64 = 4.0 / 16_777_216.0 / (0.5 * 0.0035 / 512.0);

/// Patches for lists, in the layout of `patch_runs.glsl`; empty if there are none, or too many.
pub(crate) fn listed(patches: &[QuadricPatch]) -> Vec<[u32; 4]> {
    if patches.is_empty() || patches.len() > LISTED_PATCHES as usize {
        return Vec::new();
    }
    let unit = patches.iter().fold(1e-6, |m: f64, p| m.max(p.r[1])) / 65535.0;
    // Ranges are rounded outwards. A beam is wider than this rounding.
    let levels = |p: &QuadricPatch| {
        let [low, high] = p.z.map(|z| (z * 32767.0).clamp(0.0, 32767.0));
        let sense = (p.quadric[0] + 1.0) as u32;
        low.floor() as u32 | (high.ceil() as u32) << 15 | sense << 30
    };
    let radii = |p: &QuadricPatch| {
        let [low, high] = p.r.map(|r| (r / unit).clamp(0.0, 65535.0));
        low.floor() as u32 | (high.ceil() as u32) << 16
    };
    let record = |(k, p): (usize, &QuadricPatch)| {
        let GpuPatch { quadric, guard, .. } = GpuPatch::new(p, k);
        let [_, _, linear, constant] = p.quadric.map(|v| (v as f32).to_bits());
        let extents = [levels(p), radii(p), linear, constant];
        [quadric.map(f32::to_bits), guard.map(f32::to_bits), extents]
    };
    // A guard that no point passes.
    let none = [[0.0; 4], [0.0, 0.0, 1.0, 0.0], [0.0; 4]].map(|v| v.map(f32::to_bits));
    // On a cone r^2 = q h^2 that begins at radius r, seen from within a height of 1.
    let may_err = |p: &QuadricPatch| {
        let steepness = -p.quadric[0] * p.quadric[3];
        ROUNDING * ROUNDING * steepness > p.r[0] * p.r[0]
    };
    let first = patches
        .iter()
        .position(may_err)
        .unwrap_or(LISTED_PATCHES as usize);
    let last = patches.iter().rposition(may_err).unwrap_or(0);
    let range = index(first) | index(last) << 16;
    let rounding = (ROUNDING as f32).to_bits();
    std::iter::once([
        index(patches.len()),
        (unit as f32).to_bits(),
        rounding,
        range,
    ])
    .chain(patches.iter().enumerate().flat_map(record))
    .chain(none)
    .collect()
}

/// The largest distance of a level from its contour, object units; an upper bound.
pub(crate) const LEVELS_BULGE: f64 = 1.0 / 32.0;

/// The unit of `r^2` in the tables of all levels of a contour.
fn unit(contour: &Contour) -> f32 {
    let points = contour.chains.iter().flat_map(|chain| &chain.points);
    let largest = points.fold(0.0, |m: f64, p| m.max(p.x)) + LEVELS_BULGE;
    (largest * largest / 65535.0) as f32
}

/// Least and largest `r^2` of a node in two 16-bit halves of a word, rounded outwards.
fn node_word([low, high]: &[f32; 2], unit: f32) -> u32 {
    let [low, high] = [low, high].map(|square| (square / unit).clamp(0.0, 65535.0));
    // Integers truncate.
    let [floor, below] = [low as u32, high as u32];
    floor | (below + u32::from((below as f32) < high)) << 16
}

fn index(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
