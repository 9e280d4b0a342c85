//! The division of patches into cells.

use super::QuadricPatch;
use super::frusta::ProxyHullOptions;
use glam::DVec2;
use std::f64::consts::PI;
use std::ops::Range;

/// Time of the test of a patch, over that of all else in a fragment: lights, the ray's set-up, stores.
/// This and the next two were fitted on lavapipe 22 to eight upright and three flat solids; a profile
/// gives 0.07 for it, and the geometry of rings 0.055 for [`WALL`].
const TEST: f64 = 0.05;
/// Time of a cell's triangles, as a part of the chain's area whose fragments test nothing.
const CELL: f64 = 0.02;
/// Mean area of a wall at the end of an upright patch, over the square of the joint's radius: it
/// reaches from the corners of a ring to its circle.
const WALL: f64 = 0.08;
/// Mean area by which the corners of a level patch stand out, in the same unit.
const CORNERS: f64 = 0.018;

/// Least length of a cell's surface, object units, so that the margins of its shell stay small beside
/// it. A shorter patch shares the cell of a neighbour.
const SHORTEST: f64 = 0.0005;
/// More than any time: what a short cell costs.
const NEVER: f64 = 1e12;

/// Cells of consecutive patches of a chain, of the least estimated time.
///
/// A fragment tests all patches of its cell, in pipelines for one patch or for the most. So a patch
/// of a large area makes a cell of its own, and many small ones share a cell.
pub(super) fn divide(patches: &[QuadricPatch], options: &ProxyHullOptions) -> Vec<Range<usize>> {
    let most = options.patches_per_cell.clamp(1, 255) as usize;
    let mut cells = Vec::new();
    let mut first = 0;
    for chain in patches.chunk_by(|a, b| a.chain == b.chain) {
        // Of the patches before each: the least time, and where their last cell begins.
        let mut best = vec![(0.0, 0)];
        let area_of =
            |p: &QuadricPatch| 0.25 * PI * (p.start.x + p.end.x) * p.start.distance(p.end);
        let triangles = CELL * chain.iter().map(area_of).sum::<f64>();
        let wall = |patch: &QuadricPatch, joint: DVec2| {
            let way = (patch.end - patch.start).normalize_or_zero().abs();
            joint.x * joint.x * way.dot(DVec2::new(CORNERS, WALL))
        };
        for end in 1..=chain.len() {
            let (mut area, mut length) = (0.0, 0.0);
            let mut least = (f64::INFINITY, 0);
            for begin in (end.saturating_sub(most)..end).rev() {
                let (patch, last) = (&chain[begin], &chain[end - 1]);
                area += area_of(patch);
                length += patch.start.distance(patch.end);
                let tests = if end - begin == 1 { 1 } else { most };
                let drawn = area + wall(patch, patch.start) + wall(last, last.end);
                let fixed = triangles + if length < SHORTEST { NEVER } else { 0.0 };
                let time = best[begin].0 + fixed + drawn * (1.0 + TEST * tests as f64);
                if time < least.0 {
                    least = (time, begin);
                }
            }
            best.push(least);
        }
        let mut end = chain.len();
        let at = cells.len();
        while end > 0 {
            let begin = best[end].1;
            cells.push(first + begin..first + end);
            end = begin;
        }
        cells[at..].reverse();
        first += chain.len();
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Outline;
    use crate::scene::Offset;
    use crate::surface::{ContourSource, FitOptions, fit_patches};

    /// A rounded bottom of many small patches under a tall wall.
    fn patches() -> Vec<QuadricPatch> {
        let arc = (0..=60).map(|k| f64::from(k) * 0.5 * PI / 60.0);
        let mut points: Vec<DVec2> = arc
            .map(|a| DVec2::new(0.3 + 0.05 * a.sin(), 0.05 - 0.05 * a.cos()))
            .collect();
        points.extend([(0.3, 1.0), (0.0, 1.0), (0.0, 0.0)].map(DVec2::from));
        let outline = Outline {
            loops: vec![points],
        };
        let source = ContourSource::new(&outline).unwrap();
        let contour = source.contour(&Offset::default()).unwrap();
        fit_patches(&contour, &FitOptions::default())
    }

    #[test]
    fn cells_hold_each_patch_once_and_large_ones_have_their_own() {
        let patches = patches();
        let options = ProxyHullOptions::default();
        let cells = divide(&patches, &options);
        let all: Vec<usize> = cells.iter().cloned().flatten().collect();
        assert_eq!(all, (0..patches.len()).collect::<Vec<_>>());
        let most = options.patches_per_cell as usize;
        assert!(cells.iter().all(|c| (1..=most).contains(&c.len())));
        // The wall has a cell of its own; the small patches have cells of many.
        for (cell, range) in cells.iter().flat_map(|c| c.clone().map(move |k| (k, c))) {
            let length = patches[cell].start.distance(patches[cell].end);
            assert!(length < 0.5 || range.len() == 1, "{range:?}");
        }
        assert!(cells.iter().any(|c| c.len() > 4));
        assert!(
            cells.len() < patches.len() / 3,
            "{} of {}",
            cells.len(),
            patches.len()
        );
    }
}
