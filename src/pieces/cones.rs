//! Cone maps of solids that are single-valued in z: `r <= f(z)`, solid all the way to the axis.
//!
//! Such a solid is a height field over the axis: `z` is the place, `r` the height. Cone step mapping (Dummer 2006) keeps, for
//! each place, the widest cone that stands on the surface there and has nothing of the solid in it; a ray above the surface may go on to
//! where it leaves that cone. Turned about the axis a cone's two flanks are cones of revolution, and where a ray leaves one is a quadratic.
//! A ray moves along the axis one way only, so each flank has a slope of its own.
//!
//! # Layout
//!
//! Row `i` of `N` is `i / N <= z <= (i + 1) / N`: `[g, g', k_up, k_down]`. `g` and `g'` are the radius at its lower and upper border, linear in
//! between. From any point of the row, `(z, g(z))`, nothing of the solid at `z' > z` lies beyond `g(z) + k_up (z' - z)`, and nothing at
//! `z' < z` beyond `g(z) + k_down (z - z')`.
//!
//! The slopes are those of the borders: with `k_j` the steepest way from border `j` to any border above it (0 if all of them lead down),
//! the row has `max(k_i, k_i+1)`. From a point between two borders the way to a third is the mediant of theirs, so it is no
//! steeper than the steeper of both.

use super::Contour;
use crate::error::{Error, Result, Stage};

/// The rows of a cone map; the [module](self) tells their layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cones {
    /// `[g, g', k_up, k_down]`.
    pub rows: Vec<[f32; 4]>,
}

impl Cones {
    /// The cone map of a contour in `rows` rows. What is thinner in z than a row may be lost, or filled.
    ///
    /// # Errors
    /// [`Stage::Profile`] where going outwards from the axis one leaves the solid more than once, or starts outside of it, at two
    /// neighbouring borders of rows.
    pub fn new(contour: &Contour, rows: u32) -> Result<Self> {
        let radii = radii(contour, rows.max(1) as usize)?;
        let mut up = slopes(&radii);
        let backwards: Vec<f32> = radii.iter().rev().copied().collect();
        let mut down = slopes(&backwards);
        down.reverse();
        // Slopes count in rows; rounded up.
        let steep = |k: f64| (k * f64::from(rows.max(1)) * (1.0 + 1e-6)) as f32;
        let pairs = |all: &mut Vec<f64>| -> Vec<f32> {
            all.windows(2).map(|w| steep(w[0].max(w[1]))).collect()
        };
        let (up, down) = (pairs(&mut up), pairs(&mut down));
        let rows = radii
            .windows(2)
            .zip(up.iter().zip(&down))
            .map(|(g, (&up, &down))| [g[0], g[1], up, down])
            .collect();
        Ok(Self { rows })
    }
}

/// `f` at each border. Where it jumps there, the larger value.
fn radii(contour: &Contour, rows: usize) -> Result<Vec<f32>> {
    let n = rows as f64;
    // Where going outwards the boundary is crossed, just above and just below each border.
    let mut crossings: Vec<[Vec<f64>; 2]> = vec![Default::default(); rows + 1];
    for chain in &contour.chains {
        let count = chain.points.len();
        let sides = if chain.closed {
            count
        } else {
            count.saturating_sub(1)
        };
        for k in 0..sides {
            let (a, b) = (chain.points[k], chain.points[(k + 1) % count]);
            let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
            if low.y == high.y {
                continue;
            }
            let from = (low.y * n).ceil().max(0.0) as usize;
            for (i, both) in crossings.iter_mut().enumerate().skip(from) {
                let z = i as f64 / n;
                if z > high.y {
                    break;
                }
                let r = low.x + (high.x - low.x) * ((z - low.y) / (high.y - low.y));
                if low.y <= z && z < high.y {
                    both[0].push(r);
                }
                if low.y < z && z <= high.y {
                    both[1].push(r);
                }
            }
        }
    }
    let odd = |both: &[Vec<f64>; 2]| both.iter().any(|c| c.len() > 1);
    if let Some(i) = crossings.windows(2).position(|w| odd(&w[0]) && odd(&w[1])) {
        return Err(Error::new(
            Stage::Profile,
            format!(
                "is not single-valued in z: at z = {:.3} the solid begins off the axis or is left twice, which cone maps cannot hold; take --solver quadric",
                i as f64 / n
            ),
        ));
    }
    let widest = |both: &[Vec<f64>; 2]| both.iter().flatten().fold(0.0f64, |m, &r| m.max(r)) as f32;
    Ok(crossings.iter().map(widest).collect())
}

/// From each point of a sequence the steepest way to a later one, per place; 0 where all lead down.
fn slopes(radii: &[f32]) -> Vec<f64> {
    let slope = |i: usize, j: usize| f64::from(radii[j] - radii[i]) / (j - i) as f64;
    let mut all = vec![0.0; radii.len()];
    // The upper hull of the points after `i`, nearest last: the steepest way leads to its first corner.
    let mut hull: Vec<usize> = Vec::new();
    for i in (0..radii.len()).rev() {
        while let [.., far, near] = hull[..]
            && slope(i, near) <= slope(i, far)
        {
            hull.pop();
        }
        if let Some(&near) = hull.last() {
            all[i] = slope(i, near).max(0.0);
        }
        hull.push(i);
    }
    all
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::pieces::ContourSource;
    use crate::profile::{Outline, Profile, Shape};
    use crate::scene::Offset;
    use proptest::prelude::*;

    fn contour(points: &[[f64; 2]], extend: f64) -> Contour {
        let profile = Profile::polygon(points, 0.5).unwrap();
        let Shape::Outline(outline) = &profile.shape else {
            unreachable!("polygons are outlines")
        };
        let offset = Offset {
            extend,
            ..Offset::default()
        };
        ContourSource::new(outline)
            .unwrap()
            .contour(&offset)
            .unwrap()
    }

    #[test]
    fn a_double_cone_by_hand() {
        let spindle = contour(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.0);
        let cones = Cones::new(&spindle, 4).unwrap();
        let expected = [
            [0.0, 0.2, 0.8, 0.0],
            [0.2, 0.4, 0.8, 0.0],
            [0.4, 0.2, 0.0, 0.8],
            [0.2, 0.0, 0.0, 0.8],
        ];
        for (row, wanted) in cones.rows.iter().zip(expected) {
            for (a, b) in row.iter().zip(wanted) {
                assert!((a - b).abs() < 1e-5, "{row:?} is not {wanted:?}");
            }
        }
    }

    #[test]
    fn what_is_not_single_valued_is_refused() {
        let ring = contour(&[[0.1, 0.2], [0.4, 0.2], [0.4, 0.7], [0.1, 0.7]], 0.0);
        let error = Cones::new(&ring, 64).unwrap_err();
        assert!(error.to_string().contains("z = 0.203"), "{error}");
        let cup = contour(
            &[
                [0.0, 0.1],
                [0.3, 0.1],
                [0.3, 0.9],
                [0.25, 0.9],
                [0.25, 0.2],
                [0.0, 0.2],
            ],
            0.0,
        );
        assert!(Cones::new(&cup, 64).is_err());
        // A cavity that is lower than a row is not seen.
        let scratched = [
            [0.0, 0.1],
            [0.3, 0.1],
            [0.2, 0.105],
            [0.3, 0.11],
            [0.3, 0.9],
            [0.0, 0.9],
        ];
        assert!(Cones::new(&contour(&scratched, 0.0), 64).is_ok());
        // However far it is extended.
        let column = [
            [0.0, 0.1],
            [0.1, 0.1],
            [0.3, 0.2],
            [0.1, 0.6],
            [0.2, 0.9],
            [0.0, 0.9],
        ];
        for extend in [0.0, 0.05, -0.03] {
            assert!(
                Cones::new(&contour(&column, extend), 64).is_ok(),
                "{extend}"
            );
        }
    }

    /// Every cone of every row against every part of the surface, from all over the row.
    fn assert_empty(cones: &Cones) -> std::result::Result<(), TestCaseError> {
        let n = cones.rows.len() as f64;
        for (i, row) in cones.rows.iter().enumerate() {
            let [g, g_next, up, down] = row.map(f64::from);
            for part in [0.0, 0.3, 0.7, 1.0] {
                let (z, r) = ((i as f64 + part) / n, g + (g_next - g) * part);
                for (j, other) in cones.rows.iter().enumerate() {
                    let (z_j, r_j) = (j as f64 / n, f64::from(other[0]));
                    let k = if z_j > z { up } else { down };
                    prop_assert!(
                        r_j <= r + k * (z_j - z).abs() + 1e-6,
                        "row {} at {}, {}",
                        i,
                        part,
                        j
                    );
                }
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn cones_hold_nothing_of_the_solid(radii in proptest::collection::vec(0.02f64..0.45, 2..30), rows in 3u32..70) {
            let steps = (radii.len() - 1) as f64;
            let mut points = vec![glam::DVec2::new(0.0, 0.1)];
            points.extend(radii.iter().enumerate().map(|(k, &r)| glam::DVec2::new(r, 0.1 + 0.8 * k as f64 / steps)));
            points.push(glam::DVec2::new(0.0, 0.9));
            let outline = Outline { loops: vec![points] };
            let contour = ContourSource::new(&outline).unwrap().contour(&Offset::default()).unwrap();
            assert_empty(&Cones::new(&contour, rows).unwrap())?;
        }
    }
}
