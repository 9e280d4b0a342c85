//! Traces the curve at which a picture's coverage passes one half, as chains of points on the links
//! between pixels.
//!
//! Samples are at the pixels' centres. Coverage is 0 beyond the picture, so a solid that touches
//! the top, bottom or right border ends exactly there. The picture continues left of the axis with
//! its mirror image. A **link** joins the centres of two neighbours. A link holds one point if one
//! end is more than half covered and the other is not:
//!
//! * A binary picture gives the link's middle, accurate to half a texel.
//! * An anti-aliased picture gives the edge's mean position over the pixel's width: the sum of
//!   coverages along the link's line, from a full pixel to an empty one. For a straight edge, this
//!   is its position in the middle (the height function of two-phase flow). If the edge runs too
//!   much along the link, the points of the links across are enough.
//! * If there are no full pixels, as in grey or blurred solids, the point is where linear
//!   interpolation passes one half.
//!
//! [`smooth`] turns the chains into an [`Outline`]. Chains that cross afterwards are
//! cut at their crossings.

mod roughness;
mod smooth;

pub(crate) use roughness::roughness;

use crate::content_fault;
use crate::faults::empty_fault;
use glam::DVec2;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::profile::{FillRule, Outline, Profile, Raster};
use smooth::{Trail, smooth};
use std::collections::HashMap;

/// A profile from the right half of a picture, `R` = columns / rows.
///
/// The outline is the curve at which coverage passes one half. Pixel noise is removed and corners
/// are restored. The outline stays within the picture. Everything beyond the picture's upper, lower
/// and right border is empty.
///
/// # Errors
/// [`ErrorKind::Content`](revmap::error::ErrorKind::Content): no pixel is more than half covered,
/// or the list of coverages has not `columns * rows` values.
pub fn trace(raster: Raster) -> Result<Profile> {
    trace_split(raster, false)
}

/// The profile of a picture's right half. `split`: the axis is the middle of column 0, else its
/// left edge.
pub(crate) fn trace_split(raster: Raster, split: bool) -> Result<Profile> {
    let (columns, rows) = (raster.columns as usize, raster.rows as usize);
    if raster.coverage.len() != columns * rows {
        return Err(content_fault(format!(
            "{} coverages are no {columns} x {rows} pixels; give one for each",
            raster.coverage.len()
        )));
    }
    let nodes = Nodes::new(&raster, split);
    let outline = nodes.outline();
    if outline.loops.is_empty() {
        return Err(empty_fault("image"));
    }
    Ok(Profile {
        radius: nodes.size().x / f64::from(raster.rows),
        raster: (!split).then_some(raster),
        outline,
        warnings: Vec::new(),
        notes: Vec::new(),
    })
}

/// The outline of [`trace`]; empty if no pixel is more than half covered.
pub(crate) fn outline(raster: &Raster) -> Outline {
    Nodes::new(raster, false).outline()
}

/// The picture with a rim of one empty pixel above, below and at the right. If the axis is the left
/// edge of the picture, column 0 is the mirror image of column 1.
struct Nodes<'a> {
    raster: &'a Raster,
    columns: usize,
    rows: usize,
    /// 1 if column 0 is a mirror image, 0 if it is on the axis.
    mirrored: usize,
}

impl<'a> Nodes<'a> {
    fn new(raster: &'a Raster, split: bool) -> Self {
        let mirrored = usize::from(!split);
        Self {
            raster,
            columns: raster.columns as usize + 1 + mirrored,
            rows: raster.rows as usize + 2,
            mirrored,
        }
    }

    /// The box of the picture, texels.
    fn size(&self) -> DVec2 {
        self.place((self.columns - 1, self.rows - 1)) - DVec2::splat(0.5)
    }

    fn outline(&self) -> Outline {
        let trails = self.trails();
        let graded = self.graded(&trails);
        let rows = f64::from(self.raster.rows);
        let size = self.size();
        let place = |p: DVec2| {
            let p = p.clamp(DVec2::ZERO, size);
            DVec2::new(p.x / rows, 1.0 - p.y / rows)
        };
        let loops: Vec<Vec<DVec2>> = trails
            .iter()
            .map(|links| smooth(self.trail(links, graded), graded))
            .map(|points| points.into_iter().map(place).collect())
            .collect();
        let mut outline = Outline::enclosed(&loops, FillRule::Positive);
        // Rounding may have moved a crossing out of the box.
        for p in outline.loops.iter_mut().flatten() {
            p.x = p.x.min(size.x / rows);
        }
        outline
    }

    /// The centre of a node, texels, y downwards from the picture's upper edge.
    fn place(&self, (i, j): (usize, usize)) -> DVec2 {
        DVec2::new(i as f64 - 0.5 * self.mirrored as f64, j as f64 - 0.5)
    }

    fn value(&self, i: usize, j: usize) -> f64 {
        if j == 0 || i + 1 == self.columns || j + 1 == self.rows {
            return 0.0;
        }
        let index = (j - 1) * self.raster.columns as usize + i.saturating_sub(self.mirrored);
        f64::from(self.raster.coverage[index])
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

    /// The middle of a link.
    fn middle(&self, link: u32) -> DVec2 {
        let [a, b] = self.link(link);
        self.place(a).midpoint(self.place(b))
    }

    /// The point at which the curve passes a link, by linear interpolation.
    fn point(&self, link: u32) -> DVec2 {
        let [a, b] = self.link(link);
        let (va, vb) = (self.value(a.0, a.1), self.value(b.0, b.1));
        self.place(a).lerp(self.place(b), (0.5 - va) / (vb - va))
    }

    /// The point from the sum of coverages along the link's line; `None` if the edge runs too much
    /// along it.
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
            // The picture is mirrored left of the axis.
            let i = if i < 0 { self.mirrored as isize - i } else { i };
            if within {
                self.value(i as usize, j as usize)
            } else {
                0.0
            }
        };
        // The pixels from the edge to the first one that is full, and to the first that is empty.
        let mut sum = value(0);
        let mut run = |way: isize, most: isize, ends: fn(f64) -> bool| {
            let (mut k, mut last) = (0, value(0));
            while !ends(last) {
                k += way;
                let next = value(k);
                if k * way > most || (next - last) * way as f64 > 0.0 {
                    return None;
                }
                (last, sum) = (next, sum + next);
            }
            Some(k)
        };
        let first = run(-1, LONGEST, |v| v >= FULL)?;
        run(1, LONGEST + 1, |v| v <= 1.0 - FULL)?;
        let way = DVec2::new(step.0 as f64, step.1 as f64);
        Some(self.place(a) + way * (first as f64 - 0.5 + sum))
    }

    /// All curves, with the solid on the left as seen in the picture.
    fn trails(&self) -> Vec<Links> {
        let pairs: Vec<[u32; 2]> = (0..self.rows - 1)
            .into_par_iter()
            .flat_map_iter(|j| (0..self.columns - 1).flat_map(move |i| self.cell(i, j)))
            .collect();
        let mut next: HashMap<u32, u32> = pairs.iter().map(|&[from, to]| (from, to)).collect();
        let mut firsts: Vec<u32> = pairs.iter().map(|p| p[0]).collect();
        // Curves that start on the axis come first: every later walk ends where it began, or on the
        // axis.
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
                match next.remove(&link) {
                    Some(following) if following == first => break,
                    Some(following) => link = following,
                    None => {
                        if !axis(link) {
                            // The curve was walked before.
                            trail.links.clear();
                        }
                        break;
                    }
                }
            }
            if trail.links.len() > 1 {
                trails.push(trail);
            }
        }
        trails
    }

    /// The curve's pieces within the cell whose upper left node is `(i, j)`, each from link to
    /// link.
    fn cell(&self, i: usize, j: usize) -> Vec<[u32; 2]> {
        let values = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|c| self.value(c.0, c.1));
        let solid = values.map(|v| v > 0.5);
        if solid.iter().all(|&s| s == solid[0]) {
            return Vec::new();
        }
        let node = (j * self.columns + i) as u32;
        let below = node + self.columns as u32;
        // Top, right, bottom, left: sides between corners 01, 12, 23, 30.
        let links = [2 * node, 2 * (node + 1) + 1, 2 * below, 2 * node + 1];
        // The sides are visited clockwise, as seen. A curve comes in at a side that goes from empty
        // to solid: the solid is on its left.
        let comes_in = |&k: &usize| !solid[k] && solid[(k + 1) % 4];
        let goes_out = |&k: &usize| solid[k] && !solid[(k + 1) % 4];
        // The way out is the next one round the solid corner. At a saddle that is solid it is the
        // one before, round the empty corner.
        let joined = values.iter().sum::<f64>() > 2.0;
        let turn = |k: usize| if joined { 4 - k } else { k };
        (0..4)
            .filter(comes_in)
            .filter_map(|from| {
                let to = (1..4).map(|k| (from + turn(k)) % 4).find(goes_out)?;
                Some([links[from], links[to]])
            })
            .collect()
    }

    /// Returns true for an anti-aliased picture: at more than a quarter of the curve's links one
    /// end is neither as light nor as dark as the nodes around it.
    fn graded(&self, trails: &[Links]) -> bool {
        let grey = |&(i, j): &(usize, usize)| {
            let (mut low, mut high) = (1.0f64, 0.0f64);
            for j in j.saturating_sub(1)..(j + 2).min(self.rows) {
                for i in i.saturating_sub(1)..(i + 2).min(self.columns) {
                    let v = self.value(i, j);
                    (low, high) = (low.min(v), high.max(v));
                }
            }
            let above = (self.value(i, j) - low) / (high - low).max(0.1);
            (0.1..0.9).contains(&above)
        };
        let links = || trails.iter().flat_map(|t| &t.links);
        let partial = links().filter(|l| self.link(**l).iter().any(grey)).count();
        4 * partial > links().count()
    }

    /// The points of a curve.
    fn trail(&self, Links { links, closed }: &Links, graded: bool) -> Trail {
        let known = |&link: &u32| {
            if graded {
                self.summed(link)
            } else {
                Some(self.middle(link))
            }
        };
        let found: Vec<Option<DVec2>> = links.iter().map(known).collect();
        // Sums that exist for few links leave out too much of a curve.
        let few = links.len() < 12 || 4 * found.iter().flatten().count() < links.len();
        let mut points: Vec<DVec2> = Vec::with_capacity(links.len());
        for (k, (&link, found)) in links.iter().zip(found).enumerate() {
            let own = found.unwrap_or_else(|| self.point(link));
            if !closed && (k == 0 || k + 1 == links.len()) {
                points.push(DVec2::new(0.0, own.y));
            } else if few || found.is_some() || points.last().is_some_and(|q| q.distance(own) > 1.5)
            {
                points.push(own);
            }
        }
        Trail {
            points,
            closed: *closed,
        }
    }
}

/// A curve as the list of links that it passes.
#[derive(Debug)]
struct Links {
    links: Vec<u32>,
    closed: bool,
}

#[cfg(test)]
mod tests;
