//! The curve that a picture was drawn from: where its coverage passes one half, as chains of points on the lines between pixels.
//!
//! Samples stand at the pixels' centres; beyond the picture lies 0, so a solid that touches the top, bottom or right border ends
//! exactly there, and left of the axis stands the mirror image. Each link between two neighbouring centres of which one is more than
//! half covered and one is not holds one point. In a binary picture it is the middle, give or take half a texel. In an anti-aliased
//! one the coverages, added up along the link's line from a full pixel to an empty one, give the mean position of the edge over the
//! pixel's width, which is its position in the middle where the edge is straight (the height function of two-phase flow); where the
//! edge runs too much along the link for that, the points of the links across are enough. What [`smooth`](super::smooth) makes of
//! that is an [`Outline`], and from there on pictures are as good as drawings.

use super::smooth::{Trail, smooth};
use crate::profile::{Outline, Raster};
use glam::DVec2;

/// An outline made from a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// The outline, object units, corners found again.
    pub outline: Outline,
    /// How well it may be known, object units: what to cut it with (as [`CutOptions::tolerance`](super::CutOptions)); finer pieces would
    /// follow the noise of the pixels.
    pub tolerance: f64,
}

/// The outline that a raster stands for, to a fraction of a texel; empty when no pixel is more than half covered.
#[must_use]
pub fn outline_of(raster: &Raster) -> Traced {
    let nodes = Nodes::new(raster);
    let trails = nodes.trails();
    let graded = nodes.graded(&trails);
    let texel = 1.0 / f64::from(raster.rows.max(1));
    let loops = trails
        .iter()
        .map(|links| smooth(&nodes.trail(links, graded), graded))
        .filter(|points| points.len() > 2)
        .map(|points| {
            let place = |p: DVec2| DVec2::new(p.x.max(0.0) * texel, 1.0 - p.y * texel);
            points.into_iter().map(place).collect()
        })
        .collect();
    Traced {
        outline: Outline { loops },
        tolerance: texel * if graded { 0.015 } else { 0.06 },
    }
}

/// The picture with a rim of one pixel: column 0 the mirror image of column 1, everything else around empty.
struct Nodes<'a> {
    raster: &'a Raster,
    columns: usize,
    rows: usize,
}

/// The centre of a node, texels.
fn place((i, j): (usize, usize)) -> DVec2 {
    DVec2::new(i as f64 - 0.5, j as f64 - 0.5)
}

/// No successor.
const NONE: u32 = u32::MAX;

impl<'a> Nodes<'a> {
    fn new(raster: &'a Raster) -> Self {
        Self {
            raster,
            columns: raster.columns as usize + 2,
            rows: raster.rows as usize + 2,
        }
    }

    fn value(&self, i: usize, j: usize) -> f64 {
        if j == 0 || i + 1 == self.columns || j + 1 == self.rows {
            return 0.0;
        }
        let index = (j - 1) * self.raster.columns as usize + i.saturating_sub(1);
        self.raster
            .coverage
            .get(index)
            .map_or(0.0, |&v| f64::from(v))
    }

    /// The two nodes of a link: even ones go right, odd ones down.
    fn link(&self, link: u32) -> [(usize, usize); 2] {
        let node = link as usize / 2;
        let (i, j) = (node % self.columns, node / self.columns);
        [
            (i, j),
            if link.is_multiple_of(2) {
                (i + 1, j)
            } else {
                (i, j + 1)
            },
        ]
    }

    /// Where the curve passes a link, in texels, y downwards from the picture's upper edge: by linear interpolation.
    fn point(&self, link: u32) -> DVec2 {
        let [a, b] = self.link(link);
        let (va, vb) = (self.value(a.0, a.1), self.value(b.0, b.1));
        place(a).lerp(place(b), (0.5 - va) / (vb - va))
    }

    /// The same from the sum of coverages along the link's line; none where the edge runs too much along it.
    fn summed(&self, link: u32) -> Option<DVec2> {
        const FULL: f64 = 0.995;
        const LONGEST: isize = 2;
        let [mut a, mut b] = self.link(link);
        if self.value(a.0, a.1) < self.value(b.0, b.1) {
            std::mem::swap(&mut a, &mut b);
        }
        let step = (b.0 as isize - a.0 as isize, b.1 as isize - a.1 as isize);
        let value = |k: isize| {
            let (i, j) = (a.0 as isize + k * step.0, a.1 as isize + k * step.1);
            let within = j >= 0 && (j as usize) < self.rows && i < self.columns as isize;
            // Left of the axis stands the mirror image: node 0 is that of node 1.
            let i = if i < 0 { -i + 1 } else { i };
            if within {
                self.value(i as usize, j as usize)
            } else {
                0.0
            }
        };
        let (mut k, mut sum) = (0, value(0));
        let mut last = sum;
        while last < FULL {
            k -= 1;
            let next = value(k);
            if k < -LONGEST || next < last {
                return None;
            }
            (last, sum) = (next, sum + next);
        }
        let first = k;
        (k, last) = (0, value(0));
        while last > 1.0 - FULL {
            k += 1;
            let next = value(k);
            if k > LONGEST + 1 || next > last {
                return None;
            }
            (last, sum) = (next, sum + next);
        }
        let way = DVec2::new(step.0 as f64, step.1 as f64);
        Some(place(a) + way * (first as f64 - 0.5 + sum))
    }

    /// All curves, solid on the left as one sees them.
    fn trails(&self) -> Vec<Links> {
        let mut next = vec![NONE; 2 * self.columns * self.rows];
        let mut firsts = Vec::new();
        for j in 0..self.rows - 1 {
            for i in 0..self.columns - 1 {
                self.cell(i, j, &mut next, &mut firsts);
            }
        }
        // Those that come from the axis first: from there on every walk ends where it began, or on the axis.
        let axis = |link: u32| link % 2 == 1 && (link as usize / 2).is_multiple_of(self.columns);
        firsts.sort_by_key(|&l| !axis(l));
        let mut trails = Vec::new();
        for first in firsts {
            let mut trail = Links {
                links: Vec::new(),
                closed: !axis(first),
            };
            let mut link = first;
            loop {
                trail.links.push(link);
                let following = std::mem::replace(&mut next[link as usize], NONE);
                if following == NONE || following == first {
                    if following == NONE && !axis(link) {
                        // This one was walked before.
                        trail.links.clear();
                    }
                    break;
                }
                link = following;
            }
            if trail.links.len() > 1 {
                trails.push(trail);
            }
        }
        trails
    }

    /// The curve's pieces within the cell whose upper left node is `(i, j)`.
    fn cell(&self, i: usize, j: usize, next: &mut [u32], firsts: &mut Vec<u32>) {
        let values = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|c| self.value(c.0, c.1));
        let solid = values.map(|v| v > 0.5);
        if solid.iter().all(|&s| s == solid[0]) {
            return;
        }
        let node = (j * self.columns + i) as u32;
        let below = node + self.columns as u32;
        // Top, right, bottom, left: sides between corners 01, 12, 23, 30.
        let links = [2 * node, 2 * (node + 1) + 1, 2 * below, 2 * node + 1];
        // Walked round the cell (clockwise, as seen), a side that goes from empty to solid is where a curve comes in: solid is on its left.
        let outs: Vec<usize> = (0..4)
            .filter(|&k| solid[k] && !solid[(k + 1) % 4])
            .collect();
        let ins: Vec<usize> = (0..4)
            .filter(|&k| !solid[k] && solid[(k + 1) % 4])
            .collect();
        let joined = values.iter().sum::<f64>() > 2.0;
        for &from in &ins {
            // The nearest way out: round the solid corner, or at a saddle that is solid round the empty one before.
            let to = if outs.len() == 1 {
                outs[0]
            } else {
                let turn = if joined { 3 } else { 1 };
                (from + turn) % 4
            };
            next[links[from] as usize] = links[to];
            firsts.push(links[from]);
        }
    }

    /// Whether the picture is anti-aliased: a quarter of the curve's links have a half covered end.
    fn graded(&self, trails: &[Links]) -> bool {
        let grey = |link: &&u32| {
            self.link(**link)
                .iter()
                .any(|&(i, j)| (0.02..0.98).contains(&self.value(i, j)))
        };
        let all: usize = trails.iter().map(|t| t.links.len()).sum();
        let partial = trails.iter().flat_map(|t| &t.links).filter(grey).count();
        4 * partial > all
    }

    /// The points of a curve.
    fn trail(&self, links: &Links, graded: bool) -> Trail {
        let last = links.links.len() - 1;
        let on_axis = |k: usize| !links.closed && (k == 0 || k == last);
        let mut points: Vec<DVec2> = Vec::with_capacity(links.links.len());
        for (k, &link) in links.links.iter().enumerate() {
            let found = if graded { self.summed(link) } else { None };
            if on_axis(k) {
                let p = found.unwrap_or_else(|| self.point(link));
                points.push(DVec2::new(0.0, p.y));
            } else if let Some(p) = found {
                points.push(p);
            } else if !graded
                || links.links.len() < 12
                || points
                    .last()
                    .is_some_and(|&q| q.distance(self.point(link)) > 1.5)
            {
                points.push(self.point(link));
            }
        }
        Trail {
            points,
            closed: links.closed,
        }
    }
}

/// A curve by the links it passes.
#[derive(Debug)]
struct Links {
    links: Vec<u32>,
    closed: bool,
}
