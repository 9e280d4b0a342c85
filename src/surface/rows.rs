//! The tables of the search: patches distributed to rows of equal height, and a tree of the rows'
//! extents.
//!
//! # Layout
//!
//! `N` rows: row `i` is `i / N <= z <= (i + 1) / N`.
//!
//! * `records`: the patches, each as 12 floats `[a, k0, k1, k2] [cz, cr, low, high] [z0, z1, patch,
//!   0]`. A record holds the quadric, the guard, and the values that only tests off the main path
//!   read: the patch's range of `z`, and its number. Records are sorted by row, so that a row's
//!   patches are one run. A patch that touches several rows is repeated, unless these rows hold the
//!   same patches and share a run.
//! * `rows[i] = first << 12 | count`: that run.
//! * `nodes`: `[min r^2, max r^2]` of the boundary, first of each row (level 0), then of each 4
//!   rows (level 1), of each 16, and so on. `levels[l]` is the start of level `l`. An empty node is
//!   `[+inf, -inf]`. The topmost level has at most 4 nodes.
//!
//! All extents are rounded outwards, by a millionth. `include/search/quadric.glsl` performs the walk.

use super::QuadricPatch;
use bytemuck::{Pod, Zeroable};
use std::ops::{Range, RangeInclusive};

/// Distance by which rows and extents exceed their contents, object units (`r^2`: the order of its
/// square root): roundings of 32 bits.
pub(super) const MARGIN: f64 = 1e-6;

/// A patch, as shaders read it: three vectors of four 32-bit floats.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GpuPatch {
    /// `[a, k0, k1, k2]` of `G = a r^2 + k0 + k1 h + k2 h^2`, where `h = z - anchor`.
    pub quadric: [f32; 4],
    /// `[anchor, cr, low, high]`: a point counts if `low <= |a| h + cr r^2 <= high`.
    pub guard: [f32; 4],
    /// `[z0, z1, patch, 0]`: the range of `z`, and the patch's number (exact up to 2^24).
    pub range: [f32; 4],
}

impl GpuPatch {
    /// The record of patch number `index`.
    pub fn new(patch: &QuadricPatch, index: usize) -> Self {
        let (anchor, quadric) = patch.about_anchor(|z| f64::from(z as f32));
        let [cz, cr, low, high] = patch.guard;
        debug_assert!(cz == patch.quadric[0].abs());
        let guard = [anchor, cr, low - cz * anchor, high - cz * anchor];
        Self {
            quadric: quadric.map(|v| v as f32),
            guard: guard.map(|v| v as f32),
            range: [patch.z[0] as f32, patch.z[1] as f32, index as f32, 0.0],
        }
    }
}

/// The tables of one solid, in the layout of the [module](self).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tables {
    /// Runs of records: `first << 12 | count` for each row.
    pub rows: Vec<u32>,
    /// `[min r^2, max r^2]`, level by level.
    pub nodes: Vec<[f32; 2]>,
    /// Start of each level of `nodes`; the length is the number of levels.
    pub levels: Vec<u32>,
    /// Patches, row by row.
    pub records: Vec<GpuPatch>,
    /// Largest `r` of the boundary. The box cuts the solid if this radius exceeds the reach of the
    /// box's sides.
    pub reach: f32,
}

/// Number of rows for drawing: a power of 4, which fills the tree. Fewer rows take less time to
/// make.
pub const ROWS: u32 = 256;

impl Tables {
    /// Distributes patches to `rows` rows (at least 1, at most 4096).
    pub fn new(patches: &[QuadricPatch], rows: u32) -> Self {
        let rows = rows.clamp(1, 4096) as usize;
        let mut nodes = extents(patches, rows);
        let (starts, records) = runs(patches, &Members::new(patches, rows));
        let mut levels = vec![0];
        let mut from = 0;
        while nodes.len() - from > 4 {
            let to = nodes.len();
            for first in (from..to).step_by(4) {
                let four = nodes[first..to.min(first + 4)].iter();
                let join = |m: [f32; 2], node: &[f32; 2]| [m[0].min(node[0]), m[1].max(node[1])];
                nodes.push(four.fold(EMPTY, join));
            }
            levels.push(to as u32);
            from = to;
        }
        Self {
            rows: starts,
            nodes,
            levels,
            records,
            reach: patches.iter().fold(0.0f64, |m, p| m.max(p.r[1])) as f32,
        }
    }
}

const MOST: usize = (1 << 12) - 1;
const EMPTY: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

/// Rows that a patch touches. `rows`: number of all rows.
pub(crate) fn touched(patch: &QuadricPatch, rows: usize) -> RangeInclusive<usize> {
    // Integers truncate, and none is below 0.
    let row = |z: f64| ((z * rows as f64) as usize).min(rows - 1);
    row(patch.z[0] - MARGIN)..=row(patch.z[1] + MARGIN)
}

/// `[min r^2, max r^2]` of the boundary in each of `rows` rows; `[+inf, -inf]` for an empty row.
pub(crate) fn extents(patches: &[QuadricPatch], rows: usize) -> Vec<[f32; 2]> {
    let height = |row: usize| f64::from(row as u32) / rows as f64;
    // With room for the tree above the rows.
    let mut nodes = Vec::with_capacity(rows + rows / 2);
    nodes.resize(rows, EMPTY);
    for patch in patches {
        let met = touched(patch, rows);
        let squares = squares(patch);
        let mut from = height(*met.start());
        for (i, node) in met.clone().zip(&mut nodes[met]) {
            let to = height(i + 1);
            let [low, high] = squares(from, to);
            *node = [least(node[0], low), most(node[1], high)];
            from = to;
        }
    }
    nodes
}

/// The patches of each row: one allocation for all rows.
struct Members {
    patches: Vec<u32>,
    ends: Vec<usize>,
}

impl Members {
    fn new(patches: &[QuadricPatch], rows: usize) -> Self {
        let mut ends = vec![0; rows];
        for patch in patches {
            for row in touched(patch, rows) {
                ends[row] += usize::from(ends[row] < MOST);
            }
        }
        let mut end = 0;
        for row in &mut ends {
            end += *row;
            *row = end;
        }
        let mut members = Self {
            patches: vec![0; end],
            ends,
        };
        let begin = |row| members.of(row).start;
        let mut next: Vec<usize> = (0..rows).map(begin).collect();
        for (index, patch) in patches.iter().enumerate() {
            for row in touched(patch, rows) {
                if next[row] < members.ends[row] {
                    members.patches[next[row]] = index as u32;
                    next[row] += 1;
                }
            }
        }
        members
    }

    fn of(&self, row: usize) -> Range<usize> {
        row.checked_sub(1).map_or(0, |before| self.ends[before])..self.ends[row]
    }
}

/// The run of each row, and the records of all runs.
fn runs(patches: &[QuadricPatch], members: &Members) -> (Vec<u32>, Vec<GpuPatch>) {
    let rows = members.ends.len();
    let list = |row| &members.patches[members.of(row)];
    let mut starts: Vec<u32> = Vec::with_capacity(rows);
    let mut records: Vec<GpuPatch> = Vec::with_capacity(2 * patches.len());
    for i in 0..rows {
        let (list, before) = (list(i), list(i.saturating_sub(1)));
        if i > 0 && list == before {
            starts.push(starts[i - 1]);
            continue;
        }
        // The last stored records may equal the first records of this row.
        let shared = (0..=list.len().min(records.len()))
            .rev()
            .find(|&k| {
                let tail = &records[records.len() - k..];
                tail.iter().zip(list).all(|(r, &m)| r.range[2] == m as f32)
            })
            .unwrap_or(0);
        let first = records.len() - shared;
        starts.push((first as u32) << 12 | list.len() as u32);
        records.extend(
            list[shared..]
                .iter()
                .map(|&m| GpuPatch::new(&patches[m as usize], m as usize)),
        );
    }
    (starts, records)
}

/// A function for the least and largest `r^2` of a patch between two heights, widened.
fn squares(patch: &QuadricPatch) -> impl Fn(f64, f64) -> [f32; 2] {
    let [bottom, top] = patch.z;
    let extremes = patch.r.map(|r| r * r);
    let [_, _, k1, k2] = patch.quadric;
    let turn = -0.5 * k1 / k2;
    let square_at_turn = patch.square_at(turn);
    move |from, to| {
        let [mut low, mut high] = extremes;
        if !patch.is_plane() {
            let ends = [from - MARGIN, to + MARGIN].map(|z| least(most(z, bottom), top));
            let [a, b] = ends.map(|z| patch.square_at(z));
            let (mut lower, mut higher) = (least(a, b), most(a, b));
            if ends[0] < turn && turn < ends[1] {
                lower = least(lower, square_at_turn);
                higher = most(higher, square_at_turn);
            }
            // The values at the ends are more accurate than those of the quadric.
            (low, high) = (most(low, lower), least(high, higher));
        }
        // Radii may be off by the margin: (r + m)^2 - r^2.
        let slack = MARGIN * (1.0 + 2.0 * most(high, 0.0).sqrt());
        [(low - slack) as f32, (high + slack) as f32]
    }
}

/// The lesser of two numbers: one instruction, where that of the standard library has to pass over
/// NaN.
fn least<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

fn most<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}
