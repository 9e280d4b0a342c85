//! The division of patches into cells.

use super::QuadricPatch;
use super::frusta::ProxyHullOptions;
use std::f64::consts::PI;
use std::ops::Range;

/// Time of the test of a patch, over that of all else in a fragment: lights, the ray's set-up, stores.
/// On lavapipe 22 values of half and twice this, and of the next two, change frames by 2 % and less.
const TEST: f64 = 0.07;
/// Time of a cell's triangles, as an area whose fragments test nothing, object units squared.
const CELL: f64 = 0.004;
/// Width of the walls at a joint over its radius: corners of rings stand out.
const WALL: f64 = 0.07;

/// Cells of consecutive patches of a chain, of the least estimated time.
///
/// A fragment tests all patches of its cell, in pipelines for few patches or for the most. So patches
/// of a large area make cells of few, and many small ones share a cell.
pub(super) fn divide(patches: &[QuadricPatch], options: &ProxyHullOptions) -> Vec<Range<usize>> {
    let most = options.patches_per_cell.clamp(1, 255) as usize;
    let few = options.few.clamp(1, options.patches_per_cell.max(1)) as usize;
    let mut cells = Vec::new();
    let mut first = 0;
    for chain in patches.chunk_by(|a, b| a.chain == b.chain) {
        // Of the patches before each: the least time, and where their last cell begins.
        let mut best = vec![(0.0, 0)];
        for end in 1..=chain.len() {
            let mut area = 0.0;
            let mut least = (f64::INFINITY, 0);
            for begin in (end.saturating_sub(most)..end).rev() {
                let patch = &chain[begin];
                area += 0.25 * PI * (patch.start.x + patch.end.x) * patch.start.distance(patch.end);
                let tests = if end - begin <= few { few } else { most };
                let rings = patch.start.x * patch.start.x + chain[end - 1].end.x.powi(2);
                let drawn = area + 0.5 * PI * WALL * rings;
                let time = best[begin].0 + CELL + drawn * (1.0 + TEST * tests as f64);
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
    use glam::DVec2;

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
    fn cells_hold_each_patch_once_and_large_ones_have_few() {
        let patches = patches();
        let options = ProxyHullOptions::default();
        let cells = divide(&patches, &options);
        let all: Vec<usize> = cells.iter().cloned().flatten().collect();
        assert_eq!(all, (0..patches.len()).collect::<Vec<_>>());
        let most = options.patches_per_cell as usize;
        assert!(cells.iter().all(|c| (1..=most).contains(&c.len())));
        // The wall has two tests; the small patches have cells of many.
        for (cell, range) in cells.iter().flat_map(|c| c.clone().map(move |k| (k, c))) {
            let length = patches[cell].start.distance(patches[cell].end);
            assert!(
                length < 0.5 || range.len() <= options.few as usize,
                "{range:?}"
            );
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
