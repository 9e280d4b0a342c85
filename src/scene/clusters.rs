//! Groups copies that are near each other, so that many can be skipped at once.

use super::Placement;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Copies of one object, cluster by cluster.
pub(crate) struct Clusters {
    /// Copies by their index among all copies; each cluster is a range of these.
    order: Vec<u32>,
    /// Placements in the order of `order`, since neighbours are read together.
    placements: Vec<Placement>,
    all: Vec<Cluster>,
}

#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    pub range: Range<u32>,
    /// A box that contains their positions.
    pub low: DVec3,
    pub high: DVec3,
    /// Largest factors of scale.
    pub most_scale: DVec3,
}

const SIZE: usize = 64;
/// Bits of a position along each axis.
const BITS: u32 = 21;

impl Clusters {
    pub fn new(placements: &[Placement]) -> Self {
        let (low, high) = ends(placements.iter().map(|p| p.position));
        let cell = ((high - low).max_element() / f64::from(1u32 << BITS)).max(f64::MIN_POSITIVE);
        let mut keyed: Vec<(u64, u32)> = (placements.par_iter().enumerate())
            .map(|(n, p)| (along_curve((p.position - low) / cell), n as u32))
            .collect();
        keyed.par_sort_unstable();
        let order: Vec<u32> = keyed.into_par_iter().map(|(_, n)| n).collect();
        let placements: Vec<Placement> = order
            .par_iter()
            .map(|&copy| placements[copy as usize])
            .collect();
        let all = (placements.par_chunks(SIZE).enumerate())
            .map(|(n, copies)| Cluster::of((n * SIZE) as u32, copies))
            .collect();
        Self {
            order,
            placements,
            all,
        }
    }

    pub fn all(&self) -> &[Cluster] {
        &self.all
    }

    /// The copy of this rank in the order of the clusters: its index among all copies, and its
    /// placement.
    pub fn at(&self, rank: u32) -> (u32, &Placement) {
        (self.order[rank as usize], &self.placements[rank as usize])
    }

    /// The least `value` of any copy. `bound` must not exceed the `value` of any copy in a cluster.
    pub fn least(&self, bound: impl Fn(&Cluster) -> f64, value: impl Fn(&Placement) -> f64) -> f64 {
        let mut bounds: Vec<(f64, &Cluster)> = self.all.iter().map(|c| (bound(c), c)).collect();
        let mut least = f64::INFINITY;
        // The clusters with the least bounds usually decide.
        bounds.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        for (bound, cluster) in bounds {
            if bound >= least {
                break;
            }
            let copies = cluster.range.start as usize..cluster.range.end as usize;
            least = self.placements[copies]
                .iter()
                .map(&value)
                .fold(least, f64::min);
        }
        least
    }
}

impl Cluster {
    /// The bounds of these copies, whose first has this rank.
    pub fn of(first: u32, copies: &[Placement]) -> Self {
        let (low, high) = ends(copies.iter().map(|p| p.position));
        let (_, most_scale) = ends(copies.iter().map(|p| p.scale));
        Self {
            range: first..first + copies.len() as u32,
            low,
            high,
            most_scale,
        }
    }

    /// Bounds for all points of the cluster's copies within `beside` of the axis of their box and
    /// within `along` of its lower face, both in object units.
    pub fn around(&self, eye: DVec3, [beside, along]: [f64; 2]) -> Around {
        let [x, y, z] = self.most_scale.to_array();
        let middle = 0.5 * (self.low + self.high);
        // The length of rotations may differ from 1 by some millionths.
        let reach = (x.max(y) * beside).hypot(z * along) * (1.0 + 1e-5);
        Around {
            middle: middle - eye,
            half: 0.5 * (self.high - self.low),
            reach: reach + 1e-12 * (middle.length() + eye.length()),
        }
    }
}

/// The points within `reach` of a box.
pub(crate) struct Around {
    /// The box's middle relative to the eye.
    pub middle: DVec3,
    half: DVec3,
    reach: f64,
}

impl Around {
    /// Smallest and largest product of its points with a vector.
    pub fn along(&self, way: DVec3) -> [f64; 2] {
        let middle = self.middle.dot(way);
        let wide = self.half.dot(way.abs()) + self.reach * way.length();
        [middle - wide, middle + wide]
    }
}

/// The corners of the box around points.
pub(crate) fn ends(all: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    all.fold(none, |(low, high), p| (low.min(p), high.max(p)))
}

/// The position of a cell on a curve through all of them, along which neighbours are near (Morton
/// 1966).
fn along_curve(cell: DVec3) -> u64 {
    let most = (1u64 << BITS) - 1;
    // Inserts two zeros before each bit.
    let spread = |v: f64| {
        let mut x = (v as u64).min(most);
        for (shift, mask) in [
            (32, 0x001f_0000_0000_ffff),
            (16, 0x001f_0000_ff00_00ff),
            (8, 0x100f_00f0_0f00_f00f),
            (4, 0x10c3_0c30_c30c_30c3),
            (2, 0x1249_2492_4924_9249),
        ] {
            x = (x | x << shift) & mask;
        }
        x
    };
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(count: u32) -> Vec<Placement> {
        let part = |k: u32, step: f64| (f64::from(k) * step).fract();
        let of = |k| Placement {
            position: DVec3::new(part(k, 0.754_877), part(k, 0.569_840), 0.1 * part(k, 0.618)),
            scale: DVec3::splat(0.5 + part(k, 0.41)),
            ..Placement::default()
        };
        (0..count).map(of).collect()
    }

    #[test]
    fn every_copy_is_in_one_small_cluster() {
        for count in [1, 63, 64, 65, 10_000] {
            let placements = field(count);
            let clusters = Clusters::new(&placements);
            let mut found: Vec<u32> = Vec::new();
            let mut area = 0.0;
            for cluster in clusters.all() {
                let sides = cluster.high - cluster.low;
                area += sides.x * sides.y;
                for rank in cluster.range.clone() {
                    let (copy, placement) = clusters.at(rank);
                    found.push(copy);
                    assert_eq!(*placement, placements[copy as usize]);
                    let (position, scale) = (placement.position, placement.scale);
                    assert_eq!(position.clamp(cluster.low, cluster.high), position);
                    assert!(scale.cmple(cluster.most_scale).all());
                }
            }
            found.sort_unstable();
            assert!(found.into_iter().eq(0..count));
            assert!(area < 5.0, "{area}");
        }
    }

    #[test]
    fn the_least_value_is_that_of_all_copies() {
        let placements = field(5000);
        let clusters = Clusters::new(&placements);
        for way in [DVec3::X, DVec3::new(-0.3, 0.4, 2.0), DVec3::ZERO] {
            let bound = |c: &Cluster| c.around(DVec3::ZERO, [0.0; 2]).along(way)[0];
            let all = placements.iter().map(|p| p.position.dot(way));
            let looked_at = std::cell::Cell::new(0);
            let least = clusters.least(bound, |p| {
                looked_at.set(looked_at.get() + 1);
                p.position.dot(way)
            });
            assert_eq!(least, all.fold(f64::INFINITY, f64::min));
            assert!(way == DVec3::ZERO || looked_at.get() < 500);
        }
    }
}
