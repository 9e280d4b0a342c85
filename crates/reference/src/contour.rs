//! The outline that an image stands for: where its coverage passes one half.

use glam::DVec2;
use revmap::profile::{Outline, Raster};
use std::collections::BTreeMap;

/// The contour at 1/2 of the bilinear interpolation of a raster's coverage, by marching squares.
///
/// Samples stand at the pixels' centres `((i + 1/2) h, 1 - (j + 1/2) h)`, `h = 1 / rows`. Beyond the image lies 0, so a solid that
/// touches its top, bottom or right border ends exactly there; the axis mirrors column 0, so nothing ends there. Crossings
/// of the grid's lines are exact, and joined by straight segments. In a cell whose diagonals disagree the value at the saddle of
/// the bilinear patch decides; exactly 1/2 there, as everywhere, is empty. Loops run with the solid on the left and are closed
/// along the axis. A raster whose list is too short reads 0 beyond its end.
#[must_use]
pub fn contour(raster: &Raster) -> Outline {
    let grid = Grid {
        raster,
        h: 1.0 / f64::from(raster.rows.max(1)),
    };
    let mut next = BTreeMap::new();
    for j in 0..=raster.rows {
        axis_side(&grid, j, &mut next);
        for i in 0..=raster.columns {
            cell(&grid, i, j, &mut next);
        }
    }
    let mut loops = Vec::new();
    while let Some((first, mut key)) = next.pop_first() {
        let mut points = vec![grid.point(first)];
        while key != first {
            points.push(grid.point(key));
            match next.remove(&key) {
                Some(following) => key = following,
                None => break,
            }
        }
        simplify(&mut points);
        if points.len() > 2 {
            loops.push(points);
        }
    }
    Outline { loops }
}

/// A point of the contour: on the line to the right of a node, on the line below it, or a node of the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Right(u32, u32),
    Below(u32, u32),
    Node(u32, u32),
}

/// The nodes: column 0 is the axis, column `i` pixel `i - 1`; row 0 lies above the image, row `j` is pixel row `j - 1`.
struct Grid<'a> {
    raster: &'a Raster,
    h: f64,
}

impl Grid<'_> {
    fn value(&self, i: u32, j: u32) -> f64 {
        let Raster {
            columns,
            rows,
            coverage,
        } = self.raster;
        if i > *columns || j == 0 || j > *rows {
            return 0.0;
        }
        let index = (j - 1) as usize * *columns as usize + i.saturating_sub(1) as usize;
        coverage.get(index).map_or(0.0, |&v| f64::from(v))
    }

    fn solid(&self, i: u32, j: u32) -> bool {
        self.value(i, j) > 0.5
    }

    fn node(&self, i: u32, j: u32) -> DVec2 {
        let r = if i == 0 {
            0.0
        } else {
            (f64::from(i) - 0.5) * self.h
        };
        DVec2::new(r, 1.0 - (f64::from(j) - 0.5) * self.h)
    }

    fn point(&self, place: Place) -> DVec2 {
        let (a, b) = match place {
            Place::Right(i, j) => ((i, j), (i + 1, j)),
            Place::Below(i, j) => ((i, j), (i, j + 1)),
            Place::Node(i, j) => return self.node(i, j),
        };
        let (va, vb) = (self.value(a.0, a.1), self.value(b.0, b.1));
        self.node(a.0, a.1)
            .lerp(self.node(b.0, b.1), (0.5 - va) / (vb - va))
    }
}

/// The part of the axis between two rows that is solid, walked downwards.
fn axis_side(grid: &Grid, j: u32, next: &mut BTreeMap<Place, Place>) {
    let (top, cut, low) = (Place::Node(0, j), Place::Below(0, j), Place::Node(0, j + 1));
    match (grid.solid(0, j), grid.solid(0, j + 1)) {
        (true, true) => next.insert(top, low),
        (true, false) => next.insert(top, cut),
        (false, true) => next.insert(cut, low),
        (false, false) => None,
    };
}

/// The segments within the cell whose upper left node is `(i, j)`, solid on their left.
fn cell(grid: &Grid, i: u32, j: u32, next: &mut BTreeMap<Place, Place>) {
    let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
    let case = corners
        .iter()
        .enumerate()
        .fold(0, |m, (k, c)| m | (usize::from(grid.solid(c.0, c.1)) << k));
    let (top, right) = (Place::Right(i, j), Place::Below(i + 1, j));
    let (low, left) = (Place::Right(i, j + 1), Place::Below(i, j));
    // Bits: upper left 1, upper right 2, lower right 4, lower left 8.
    let pairs: &[(Place, Place)] = match case {
        1 => &[(left, top)],
        2 => &[(top, right)],
        4 => &[(right, low)],
        8 => &[(low, left)],
        3 => &[(left, right)],
        6 => &[(top, low)],
        12 => &[(right, left)],
        9 => &[(low, top)],
        14 => &[(top, left)],
        13 => &[(right, top)],
        11 => &[(low, right)],
        7 => &[(left, low)],
        5 | 10 => {
            let [a, b, c, d] = corners.map(|c| grid.value(c.0, c.1));
            let joined = (a * c - b * d) / (a + c - b - d) > 0.5;
            match (case, joined) {
                (5, false) => &[(left, top), (right, low)],
                (5, true) => &[(left, low), (right, top)],
                (_, false) => &[(top, right), (low, left)],
                (_, true) => &[(top, left), (low, right)],
            }
        }
        _ => &[],
    };
    next.extend(pairs.iter().copied());
}

/// Drops points that repeat the last one or lie on a straight run.
fn simplify(points: &mut Vec<DVec2>) {
    points.dedup();
    let n = points.len();
    if n < 3 {
        return;
    }
    let straight = |k: usize| {
        let (a, b, c) = (points[(k + n - 1) % n], points[k], points[(k + 1) % n]);
        (b - a).perp_dot(c - b) == 0.0 && (b - a).dot(c - b) > 0.0
    };
    let keep: Vec<bool> = (0..n).map(|k| !straight(k)).collect();
    let mut keep = keep.into_iter();
    points.retain(|_| keep.next().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::field::Field;
    use super::*;

    fn raster(columns: u32, rows: u32, f: impl Fn(f64, f64) -> f64) -> Raster {
        let h = 1.0 / f64::from(rows);
        let coverage = (0..columns * rows)
            .map(|k| {
                f(
                    (f64::from(k % columns) + 0.5) * h,
                    1.0 - (f64::from(k / columns) + 0.5) * h,
                ) as f32
            })
            .collect();
        Raster {
            columns,
            rows,
            coverage,
        }
    }

    fn area(outline: &Outline) -> f64 {
        let sum = |l: &Vec<DVec2>| {
            (0..l.len())
                .map(|k| l[k].perp_dot(l[(k + 1) % l.len()]))
                .sum::<f64>()
        };
        outline.loops.iter().map(sum).sum::<f64>() * 0.5
    }

    #[test]
    fn a_full_image_ends_at_its_borders() {
        let outline = contour(&raster(8, 16, |_, _| 1.0));
        assert_eq!(outline.loops.len(), 1);
        let field = Field::new(&outline).unwrap();
        // Right border at 1/2, top at 1, bottom at 0; no surface at the axis.
        for (r, z, d) in [
            (0.0, 0.5, -0.5),
            (0.6, 0.5, 0.1),
            (0.2, 1.25, 0.25),
            (0.2, -0.5, 0.5),
            (0.2, 0.9, -0.1),
        ] {
            assert!(
                (field.distance(DVec2::new(r, z), &mut 0) - d).abs() < 1e-12,
                "{r} {z}"
            );
        }
        // Only the corners are cut, by half a pixel.
        assert_eq!(outline.loops[0].len(), 6);
        assert!((area(&outline) - (0.5 - 0.125 / 256.0 * 2.0)).abs() < 1e-12);
    }

    #[test]
    fn a_blurred_disc_keeps_its_radius() {
        // Coverage of a half plane at distance s is linear over a pixel: the contour is where s = 0.
        let (r0, rows) = (0.31, 64);
        let outline = contour(&raster(32, rows, |r, z| {
            let s = (r0 - (r).hypot(z - 0.5)) * f64::from(rows);
            (s + 0.5).clamp(0.0, 1.0)
        }));
        let n: usize = outline.loops.iter().map(Vec::len).sum();
        assert!(n > 80, "{n}");
        for p in outline.loops.iter().flatten().filter(|p| p.x > 0.0) {
            assert!(
                (p.distance(DVec2::new(0.0, 0.5)) - r0).abs() < 0.1 / f64::from(rows),
                "{p}"
            );
        }
        assert!((area(&outline) / (std::f64::consts::PI * r0 * r0 / 2.0) - 1.0).abs() < 2e-3);
    }

    #[test]
    fn holes_and_islands_are_loops_of_their_own() {
        let inside = |r: f64, z: f64, a: f64, b: f64| {
            f64::from(u8::from(r > a && r < b && (z - 0.5).abs() < b - a))
        };
        let image = raster(64, 64, |r, z| {
            inside(r, z, 0.2, 0.6) - inside(r, z, 0.3, 0.5) + inside(r, z, 0.7, 0.8)
        });
        let outline = contour(&image);
        assert_eq!(outline.loops.len(), 3);
        let field = Field::new(&outline).unwrap();
        for (r, solid) in [
            (0.1, false),
            (0.25, true),
            (0.4, false),
            (0.55, true),
            (0.65, false),
            (0.75, true),
        ] {
            assert_eq!(field.inside(DVec2::new(r, 0.5)), solid, "{r}");
        }
        // Two loops counter-clockwise, the hole clockwise.
        let turns = outline
            .loops
            .iter()
            .filter(|l| {
                area(&Outline {
                    loops: vec![(*l).clone()],
                }) > 0.0
            })
            .count();
        assert_eq!(turns, 2);
    }

    #[test]
    fn every_pattern_of_pixels_gives_closed_loops_that_tell_solid_from_empty() {
        // All images of 3 x 3 pixels, in two greys: 2^9.
        for bits in 0u32..512 {
            let coverage = (0..9)
                .map(|k| if bits >> k & 1 == 1 { 0.9 } else { 0.2 })
                .collect();
            let image = Raster {
                columns: 3,
                rows: 3,
                coverage,
            };
            let outline = contour(&image);
            let Some(field) = Field::new(&outline) else {
                assert_eq!(bits, 0);
                continue;
            };
            for k in 0..9u32 {
                let q = DVec2::new(
                    (f64::from(k % 3) + 0.5) / 3.0,
                    1.0 - (f64::from(k / 3) + 0.5) / 3.0,
                );
                assert_eq!(field.inside(q), bits >> k & 1 == 1, "{bits:09b} pixel {k}");
            }
            // Solid on the left everywhere: the area is positive.
            assert!(area(&outline) > 0.0, "{bits:09b}");
        }
    }

    #[test]
    fn exactly_one_half_is_empty() {
        assert!(contour(&raster(4, 4, |_, _| 0.5)).loops.is_empty());
        assert!(contour(&raster(4, 4, |_, _| 0.0)).loops.is_empty());
        assert!(
            contour(&Raster {
                columns: 4,
                rows: 4,
                coverage: vec![]
            })
            .loops
            .is_empty()
        );
    }
}
