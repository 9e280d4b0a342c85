//! Roughness of a traced outline: the distance by which noise of the picture moves its points.
//!
//! The measured pixels are a few pixels away from the outline, because the edge itself is not
//! noise and because JPEG compression disturbs only the blocks that hold an edge. A high-pass
//! filter that removes planes and parabolas leaves the noise (J. Immerkær, *Fast noise variance
//! estimation*, 1996). The solid and the ground are measured separately and the quieter one counts,
//! since a texture of either is not noise. The noise divided by the steepness of the edge is a
//! distance, in texels.
//!
//! The outline of a picture in black and white does not depend on greys, so it is never rough.

use super::Nodes;
use revmap::profile::Raster;

/// Distance of the measured pixels from the outline, along a row or a column.
const BESIDE: std::ops::RangeInclusive<usize> = 3..=5;
/// Half the side of the square around a measured pixel that the outline does not enter.
const CLEAR: usize = 2;
/// Weights of the high-pass filter, for rows and for columns.
const FILTER: [f64; 3] = [1.0, -2.0, 1.0];
/// Root of the sum of the squares of all products of two weights.
const GAIN: f64 = 6.0;
/// Variance of rounding to 8 bits.
const ROUNDING: f64 = 1.0 / (12.0 * 255.0 * 255.0);

/// Root mean square distance, texels, by which noise moves the outline of a picture's right half.
/// `split`: the axis is the middle of column 0.
pub(crate) fn roughness(raster: &Raster, split: bool) -> f64 {
    let nodes = Nodes::new(raster, split);
    let trails = nodes.trails();
    if !nodes.graded(&trails) {
        return 0.0;
    }
    // Each link, solid end first.
    let links: Vec<[(usize, usize); 2]> = trails
        .iter()
        .flat_map(|t| &t.links)
        .map(|&link| nodes.link(link))
        .map(|[a, b]| if nodes.solid(a) { [a, b] } else { [b, a] })
        .collect();
    let variance = |[near, far]: [usize; 2]| {
        let squares = links
            .iter()
            .flat_map(|ends| nodes.beside(ends[near], ends[far]));
        let squares: Vec<f64> = squares.collect();
        (!squares.is_empty()).then(|| squares.iter().sum::<f64>() / squares.len() as f64)
    };
    let sides = [[0, 1], [1, 0]].into_iter();
    let Some(noise) = sides.filter_map(variance).reduce(f64::min) else {
        return 0.0;
    };
    let mut steps: Vec<f64> = links
        .iter()
        .map(|[a, b]| nodes.value(a.0, a.1) - nodes.value(b.0, b.1))
        .collect();
    let middle = steps.len() / 2;
    let (_, &mut steepness, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    (noise - ROUNDING).max(0.0).sqrt() / steepness
}

impl Nodes<'_> {
    fn solid(&self, (i, j): (usize, usize)) -> bool {
        self.value(i, j) > 0.5
    }

    /// Squares of the noise at the nodes behind `near`, on the line from `far` through `near`.
    fn beside(&self, near: (usize, usize), far: (usize, usize)) -> Vec<f64> {
        let behind = |k: usize| {
            let beyond =
                |n: usize, f: usize| n.checked_add_signed((n as isize - f as isize) * k as isize);
            Some((beyond(near.0, far.0)?, beyond(near.1, far.1)?))
        };
        let side = self.solid(near);
        BESIDE
            .map_while(behind)
            .take_while(|&p| self.is_clear(p, side))
            .map(|(i, j)| {
                let weighed = |k: usize| {
                    FILTER[k / 3] * FILTER[k % 3] * self.value(i + k % 3 - 1, j + k / 3 - 1)
                };
                ((0..9).map(weighed).sum::<f64>() / GAIN).powi(2)
            })
            .collect()
    }

    /// Returns true if the square around a node is in the picture and all on one side of the
    /// outline.
    fn is_clear(&self, (i, j): (usize, usize), side: bool) -> bool {
        // The rim of empty nodes is not part of the picture.
        let (columns, rows) = (self.columns - 1, self.rows - 1);
        i >= CLEAR
            && j > CLEAR
            && i + CLEAR < columns
            && j + CLEAR < rows
            && (j - CLEAR..=j + CLEAR)
                .all(|j| (i - CLEAR..=i + CLEAR).all(|i| self.solid((i, j)) == side))
    }
}
