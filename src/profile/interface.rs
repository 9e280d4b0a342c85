//! The edge that an anti-aliased picture was drawn from, found again: one line per edge pixel.
//!
//! A pixel on the edge knows how much of it is covered; its neighbours tell which way the edge runs. The line through the
//! pixel with that direction and exactly that covered area is the edge up to second order in the pixel's size: the
//! piecewise linear interface calculation of two-phase flow (Scardovelli & Zaleski 2000 give the area of a cut cell and its
//! inverse; Pilliod & Puckett 2004 the choice of the slope, which reproduces straight edges exactly). Edges that coincide
//! with pixel borders, as in binary pictures, are kept as those borders.

use super::Raster;
use super::outline::Segment;
use glam::DVec2;
use rayon::prelude::*;

/// Coverages closer than this to 0 or 1 are as good as 0 or 1: half a step of 8 bits.
const SLACK: f32 = 1.0 / 512.0;

/// A straight edge through a pixel: solid is where `n . p <= alpha`, `p` in `[0, 1]^2`, x to the right, y **down**.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// Towards what is empty; `|n.x| + |n.y| = 1`.
    n: DVec2,
    alpha: f64,
    /// [`Line::misfit`] of the window it was found in.
    error: f64,
}

/// The edges of a raster, pixel by pixel.
#[derive(Clone, Debug)]
pub(crate) struct Interface {
    /// For each row, the lines of its edge pixels by ascending column.
    lines: Vec<Vec<(u32, Line)>>,
    /// Borders between full and empty pixels, from (x, y) to (x, y) in pixels, y down, in no particular order.
    borders: Vec<[DVec2; 2]>,
    side: f64,
}

/// Whether an edge may run through a pixel of this coverage.
fn is_partial(coverage: f32) -> bool {
    (SLACK..=1.0 - SLACK).contains(&coverage)
}

/// Sum of squared area errors over 3 x 3 pixels above which a line does not explain its neighbours. Edges with a radius of two pixels
/// stay below; corners and blurred edges do not.
const POOR_FIT: f64 = 0.05;

/// Coverages closer than this to 0 or 1 may be noise.
const NOISE: f32 = 0.1;

/// What lies left of column 0.
#[derive(Clone, Copy, PartialEq)]
enum LeftEdge {
    /// The mirrored half: the picture's left edge is the axis.
    Mirror,
    /// Nothing: the picture is a whole silhouette.
    Empty,
}

/// A raster with what lies around it.
struct View<'a> {
    raster: &'a Raster,
    left: LeftEdge,
}

impl View<'_> {
    fn at(&self, column: i64, row: i64) -> f32 {
        let (columns, rows) = (i64::from(self.raster.columns), i64::from(self.raster.rows));
        let column = if column < 0 && self.left == LeftEdge::Mirror {
            -1 - column
        } else {
            column
        };
        if (0..columns).contains(&column) && (0..rows).contains(&row) {
            self.raster.coverage[(row * columns + column) as usize]
        } else {
            0.0
        }
    }

    /// The line of a pixel, if the edge runs through it.
    fn line(&self, column: i64, row: i64) -> Option<Line> {
        let own = self.at(column, row);
        if !is_partial(own) {
            return None;
        }
        let solid = own > 0.5;
        let crosses = [(-1, 0), (1, 0), (0, -1), (0, 1)]
            .iter()
            .any(|&(dx, dy)| (self.at(column + dx, row + dy) > 0.5) != solid);
        if !crosses {
            return None;
        }
        let mut window = [[0.0; 3]; 3];
        for (dy, line) in (-1..).zip(&mut window) {
            for (dx, value) in (-1..).zip(line) {
                *value = f64::from(self.at(column + dx, row + dy));
            }
        }
        Line::through(&window)
    }
}

impl Interface {
    /// The edges of a half profile: the axis at the left is no edge.
    pub fn of_profile(raster: &Raster) -> Self {
        Self::new(&View {
            raster,
            left: LeftEdge::Mirror,
        })
    }

    /// The edges of a whole picture.
    pub fn of_picture(raster: &Raster) -> Self {
        Self::new(&View {
            raster,
            left: LeftEdge::Empty,
        })
    }

    fn new(view: &View) -> Self {
        let (columns, rows) = (i64::from(view.raster.columns), i64::from(view.raster.rows));
        let lines: Vec<Vec<(u32, Line)>> = (0..rows)
            .into_par_iter()
            .map(|row| {
                (0..columns)
                    .filter_map(|c| view.line(c, row).map(|l| (c as u32, l)))
                    .collect()
            })
            .collect();
        let mut this = Self {
            lines,
            borders: Vec::new(),
            side: f64::from(view.raster.rows),
        };
        this.lines = this
            .lines
            .par_iter()
            .enumerate()
            .map(|(j, row)| {
                let trusted =
                    |(c, l): &&(u32, Line)| !this.is_noise(view, i64::from(*c), j as i64, l);
                row.iter().filter(trusted).copied().collect()
            })
            .collect();
        let borders = (0..=rows)
            .into_par_iter()
            .flat_map_iter(|row| this.borders_of_row(view, row))
            .collect();
        Self { borders, ..this }
    }

    /// Whether a line is that of an almost full or almost empty pixel next to the real edge, made partial by noise (JPEG): it explains
    /// nothing around it, while a neighbour on the other side of one half has a line that does.
    fn is_noise(&self, view: &View, column: i64, row: i64, line: &Line) -> bool {
        let own = view.at(column, row);
        if line.error <= POOR_FIT || (NOISE..=1.0 - NOISE).contains(&own) {
            return false;
        }
        [(-1, 0), (1, 0), (0, -1), (0, 1)].iter().any(|&(dx, dy)| {
            let (c, r) = (column + dx, row + dy);
            let other = (view.at(c, r) > 0.5) != (own > 0.5);
            let line = (c >= 0 && r >= 0)
                .then(|| self.line_at(c as usize, r as usize))
                .flatten();
            other && line.is_some_and(|l| l.error <= POOR_FIT)
        })
    }

    /// Borders between a pixel of this row (or, one row too far, of the picture's lower edge) and its left and upper neighbours,
    /// where one is solid and one is not and neither has a line.
    fn borders_of_row(&self, view: &View, row: i64) -> Vec<[DVec2; 2]> {
        let columns = i64::from(view.raster.columns);
        let solid = |c: i64, r: i64| view.at(c, r) > 0.5;
        let lined =
            |c: i64, r: i64| c >= 0 && r >= 0 && self.line_at(c as usize, r as usize).is_some();
        let corner = |x: i64, y: i64| DVec2::new(x as f64, y as f64);
        let mut found = Vec::new();
        // Left of column 0 of a half profile stands the pixel's own mirror image.
        let mut left = solid(-1, row);
        for c in 0..=columns {
            let own = solid(c, row);
            let across = own != left && !lined(c, row) && !lined(c - 1, row);
            if across {
                found.push([corner(c, row), corner(c, row + 1)]);
            }
            if own != solid(c, row - 1) && !lined(c, row) && !lined(c, row - 1) {
                found.push([corner(c, row), corner(c + 1, row)]);
            }
            left = own;
        }
        found
    }

    fn line_at(&self, column: usize, row: usize) -> Option<Line> {
        let lines = self.lines.get(row)?;
        let k = lines.binary_search_by_key(&(column as u32), |l| l.0).ok()?;
        Some(lines[k].1)
    }

    /// Whether edges are sharp: half of the lines or more, or all there is as pixel borders, explain their neighbours' coverages. Edges
    /// that were blurred over several pixels are not areas cut by lines, and the lines mean nothing.
    pub fn is_sharp(&self) -> bool {
        let lines = || self.lines.iter().flatten();
        let poor = lines().filter(|(_, line)| line.error > POOR_FIT).count();
        2 * poor <= lines().count() + self.borders.len()
    }

    /// All edges as segments of the half-plane, object units; their direction means nothing.
    pub fn segments(&self) -> Vec<Segment> {
        let place = |p: DVec2| DVec2::new(p.x / self.side, 1.0 - p.y / self.side);
        let cuts = self.lines.iter().enumerate().flat_map(|(row, lines)| {
            lines.iter().filter_map(move |(column, line)| {
                let corner = DVec2::new(f64::from(*column), row as f64);
                line.clip().map(|ends| ends.map(|p| corner + p))
            })
        });
        cuts.chain(self.borders.iter().copied())
            .map(|[a, b]| Segment {
                a: place(a),
                b: place(b),
            })
            .collect()
    }

    /// Whether the point `(r, z)` is solid: by the line of its pixel, else by the pixel's coverage.
    pub fn contains(&self, raster: &Raster, p: DVec2) -> bool {
        let (x, y) = (p.x * self.side, (1.0 - p.y) * self.side);
        if x < 0.0 || y < 0.0 || x >= f64::from(raster.columns) || y >= f64::from(raster.rows) {
            return false;
        }
        let (column, row) = (x as usize, y as usize);
        let covered = raster.coverage[row * raster.columns as usize + column];
        // Most pixels are full or empty, and have no line to look for.
        let line = if is_partial(covered) {
            self.line_at(column, row)
        } else {
            None
        };
        line.map_or(covered > 0.5, |l| {
            l.n.dot(DVec2::new(x - column as f64, y - row as f64)) <= l.alpha
        })
    }

    /// The right half of a picture of odd width on a grid twice as fine: `columns` of half pixels from the middle on.
    pub fn split_right_half(&self, picture: &Raster) -> Raster {
        let (columns, rows) = (picture.columns as usize, picture.rows as usize * 2);
        let coverage = (0..rows)
            .into_par_iter()
            .flat_map_iter(|row| {
                (columns..2 * columns).map(move |x| match self.line_at(x / 2, row / 2) {
                    Some(line) => line.quarter(x % 2, row % 2) as f32,
                    None => picture.coverage[row / 2 * columns + x / 2],
                })
            })
            .collect();
        Raster {
            columns: picture.columns,
            rows: picture.rows * 2,
            coverage,
        }
    }
}

impl Line {
    /// The line through the middle pixel of a window of coverages (`window[row][column]`, row 0 on top) that keeps its area
    /// and, of six slopes, misses the others' areas least. `None` where the neighbours show no direction.
    fn through(window: &[[f64; 3]; 3]) -> Option<Self> {
        let column = |i: usize| window.iter().map(|row| row[i]).sum::<f64>();
        let row = |j: usize| window[j].iter().sum::<f64>();
        let (c, r) = ([column(0), column(1), column(2)], [row(0), row(1), row(2)]);
        // Which way the solid thins out.
        let across = if c[0] >= c[2] { 1.0 } else { -1.0 };
        let down = if r[0] >= r[2] { 1.0 } else { -1.0 };
        let slopes = |s: &[f64; 3]| [s[1] - s[0], 0.5 * (s[2] - s[0]), s[2] - s[1]];
        let mut best: Option<Self> = None;
        let normals = slopes(&c)
            .map(|m| DVec2::new(-m, down))
            .into_iter()
            .chain(slopes(&r).map(|m| DVec2::new(across, -m)));
        for n in normals {
            let n = n / (n.x.abs() + n.y.abs());
            let mut line = Self {
                n,
                alpha: alpha_for(n, window[1][1]),
                error: 0.0,
            };
            line.error = line.misfit(window);
            if best.is_none_or(|b| line.error < b.error) {
                best = Some(line);
            }
        }
        best
    }

    /// Sum of squared differences between the areas that the line cuts from the window's pixels and theirs.
    fn misfit(&self, window: &[[f64; 3]; 3]) -> f64 {
        let mut sum = 0.0;
        for (y, row) in (-1..).zip(window) {
            for (x, value) in (-1..).zip(row) {
                let offset = DVec2::new(f64::from(x), f64::from(y));
                let cut = area_below(self.n, self.alpha - self.n.dot(offset));
                sum += (cut - value) * (cut - value);
            }
        }
        sum
    }

    /// Solid part of the quarter pixel in column `x` and row `y` of the pixel's 2 x 2.
    fn quarter(&self, x: usize, y: usize) -> f64 {
        let corner = 0.5 * DVec2::new(x as f64, y as f64);
        area_below(self.n, (self.alpha - self.n.dot(corner)) * 2.0)
    }

    /// The piece of the line inside the pixel.
    fn clip(&self) -> Option<[DVec2; 2]> {
        let mut ends = [DVec2::ZERO; 4];
        let mut count = 0;
        let mut push = |p: DVec2| {
            if count < 4 {
                ends[count] = p;
                count += 1;
            }
        };
        for side in [0.0, 1.0] {
            if self.n.y != 0.0 {
                let y = (self.alpha - self.n.x * side) / self.n.y;
                if (0.0..=1.0).contains(&y) {
                    push(DVec2::new(side, y));
                }
            }
            if self.n.x != 0.0 {
                let x = (self.alpha - self.n.y * side) / self.n.x;
                if (0.0..=1.0).contains(&x) {
                    push(DVec2::new(x, side));
                }
            }
        }
        // A line through a corner meets two sides there: take the pair that is farthest apart.
        let ends = &ends[..count];
        let mut best = None;
        let mut length = 0.0;
        for (i, &a) in ends.iter().enumerate() {
            for &b in &ends[i + 1..] {
                if a.distance_squared(b) > length {
                    length = a.distance_squared(b);
                    best = Some([a, b]);
                }
            }
        }
        best
    }
}

/// Area of `{ p in [0, 1]^2 : n . p <= alpha }` for `|n.x| + |n.y| = 1` (Scardovelli & Zaleski 2000, section 2).
fn area_below(n: DVec2, alpha: f64) -> f64 {
    // Mirrored so that both components are positive.
    let alpha = alpha - n.x.min(0.0) - n.y.min(0.0);
    let n = n.abs();
    let (small, large) = (n.min_element(), n.max_element());
    if alpha <= 0.0 {
        0.0
    } else if alpha >= 1.0 {
        1.0
    } else if alpha < small {
        alpha * alpha / (2.0 * small * large)
    } else if alpha <= large {
        (alpha - 0.5 * small) / large
    } else {
        1.0 - (1.0 - alpha) * (1.0 - alpha) / (2.0 * small * large)
    }
}

/// The `alpha` at which [`area_below`] is `area`.
fn alpha_for(n: DVec2, area: f64) -> f64 {
    let (small, large) = (n.abs().min_element(), n.abs().max_element());
    let corner = small / (2.0 * large);
    let alpha = if area < corner {
        (2.0 * small * large * area).sqrt()
    } else if area <= 1.0 - corner {
        large * area + 0.5 * small
    } else {
        1.0 - (2.0 * small * large * (1.0 - area)).sqrt()
    };
    alpha + n.x.min(0.0) + n.y.min(0.0)
}

#[cfg(test)]
mod tests;
