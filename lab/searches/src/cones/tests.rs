#![allow(clippy::unwrap_used)]
use super::*;
use proptest::prelude::*;
use revmap::profile::{Outline, Profile};
use revmap::scene::Offset;
use revmap::surface::ContourSource;

/// The contour of a polygon, `r` and `z` of its points.
fn contour(points: &str, extend: f64) -> Contour {
    let numbers: Vec<f64> = points
        .split_whitespace()
        .map(|n| n.parse().unwrap())
        .collect();
    let profile = Profile::polygon(numbers.as_chunks().0, 0.5).unwrap();
    let offset = Offset {
        extend,
        ..Offset::default()
    };
    ContourSource::new(&profile.outline)
        .unwrap()
        .contour(&offset)
        .unwrap()
}

#[test]
fn a_double_cone_by_hand() {
    let spindle = contour("0 0  0.4 0.5  0 1", 0.0);
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
    let cones = |points: &str, extend| Cones::new(&contour(points, extend), 64);
    let error = cones("0.1 0.2  0.4 0.2  0.4 0.7  0.1 0.7", 0.0).unwrap_err();
    assert!(error.to_string().contains("z = 0.203"), "{error}");
    let cup = "0 0.1  0.3 0.1  0.3 0.9  0.25 0.9  0.25 0.2  0 0.2";
    assert!(cones(cup, 0.0).is_err());
    // A cavity that is lower than a row is missed.
    let scratched = "0 0.1  0.3 0.1  0.2 0.105  0.3 0.11  0.3 0.9  0 0.9";
    assert!(cones(scratched, 0.0).is_ok());
    // The column is single-valued with every extension.
    let column = "0 0.1  0.1 0.1  0.3 0.2  0.1 0.6  0.2 0.9  0 0.9";
    for extend in [0.0, 0.05, -0.03] {
        assert!(cones(column, extend).is_ok(), "{extend}");
    }
}

#[test]
fn level_faces_keep_their_height() {
    let drum = contour("0 0.19  0.3 0.19  0.3 0.5  0.2 0.5  0.2 0.92  0 0.92", 0.0);
    let cones = Cones::new(&drum, 10).unwrap();
    let expected = [
        [0.0, 0.0, 0.3 / 0.09, 0.0],                        // of its upper end
        [0.0, 0.3, 0.0, -(1.0 + 4096.0 * 1842.0 + 4095.0)], // 0.9 of the row
        [0.3, 0.3, 0.0, 0.0],
        [0.3, 0.3, 0.0, 0.0],
        [0.3, 0.3, 0.0, 0.0],
        [0.2, 0.2, 0.0, STEEPEST as f32], // a jump at its lower border
    ];
    for (row, wanted) in cones.rows.iter().zip(expected) {
        for (a, b) in row.iter().zip(wanted) {
            // The face's height is stored to 1 / 2047 of the row.
            let tolerance = if b < 0.0 { 0.0 } else { 1e-3 * b.max(1.0) };
            assert!((a - b).abs() <= tolerance, "{row:?} is not {wanted:?}");
        }
    }
    assert_eq!((cones.rows[9][2], cones.reach), (0.2, 0.3));
}

/// Compares every cone of every row with every part of the surface, from all over the row.
fn assert_empty(cones: &Cones) -> std::result::Result<(), TestCaseError> {
    let n = cones.rows.len() as f64;
    let mut surface = Vec::new();
    for (i, row) in cones.rows.iter().enumerate() {
        let [g, g_next, lower, flag] = row.map(f64::from);
        surface.push((g, i as f64 / n));
        if flag < 0.0 {
            let word = -flag - 1.0;
            let z = (i as f64 + (word / 4096.0).floor() / 2047.0) / n;
            let upper = word.rem_euclid(4096.0) / 4095.0 * f64::from(cones.reach);
            surface.extend([(lower, z), (upper, z)]);
        }
        surface.push((g_next, (i + 1) as f64 / n));
    }
    for (i, row) in cones.rows.iter().enumerate() {
        let [g, g_next, up, down] = row.map(f64::from);
        for part in [0.001, 0.3, 0.7, 0.999] {
            let (z, r) = ((i as f64 + part) / n, g + (g_next - g) * part);
            for &(r_j, z_j) in &surface {
                let k = if z_j > z { up } else { down };
                let bound = r + k * (z_j - z).abs() + 1e-6;
                prop_assert!(down < 0.0 || r_j <= bound, "row {} at {}, {}", i, part, z_j);
            }
        }
    }
    Ok(())
}

proptest! {
    /// A straight ray from the largest radius that has gone into the surface comes out of it again
    /// only beyond the cone.
    #[test]
    fn straight_rays_from_the_top_leave_relaxed_cones_inside(radii in proptest::collection::vec(0.0f64..0.45, 3..20)) {
        let at = |k: usize| DVec2::new(radii[k], k as f64 / radii.len() as f64);
        let points: Vec<DVec2> = (0..radii.len()).map(at).collect();
        let top = radii.iter().fold(0.0, |m: f64, r| m.max(*r));
        let height = |z: f64| {
            let place = (z * radii.len() as f64).min(radii.len() as f64 - 1.0);
            let k = (place as usize).min(radii.len() - 2);
            radii[k] + (radii[k + 1] - radii[k]) * (place - k as f64)
        };
        for (i, slope) in relaxed_slopes(&points).into_iter().enumerate() {
            for steep in 0..40 {
                let fall = 0.05 * f64::from(steep * steep);
                let mut within = false;
                for step in 1..2000 {
                    let z = points[i].y + 5e-4 * f64::from(step);
                    if z > points[points.len() - 1].y { break; }
                    let ray = top - fall * (z - points[i].y);
                    if ray < points[i].x + slope * (z - points[i].y) - 1e-9 { break; }
                    let now = ray < height(z) - 1e-9;
                    prop_assert!(now || !within, "from {i}, fall {fall}, out at {z}");
                    within = now;
                }
            }
        }
    }

    #[test]
    fn relaxed_cones_are_no_narrower(radii in proptest::collection::vec(0.0f64..0.45, 3..20)) {
        let points: Vec<DVec2> = radii.iter().enumerate().map(|(k, &r)| DVec2::new(r, k as f64)).collect();
        let pairs = relaxed_slopes(&points).into_iter().zip(slopes(&points));
        prop_assert!(pairs.clone().all(|(relaxed, safe)| relaxed <= safe), "{:?}", pairs.collect::<Vec<_>>());
    }

    #[test]
    fn cones_hold_nothing_of_the_solid(radii in proptest::collection::vec(0.02f64..0.45, 2..30), rows in 3u32..70, level in 0usize..40) {
        let steps = (radii.len() - 1) as f64;
        let mut points = vec![glam::DVec2::new(0.0, 0.1)];
        points.extend(radii.iter().enumerate().map(|(k, &r)| glam::DVec2::new(r, 0.1 + 0.8 * k as f64 / steps)));
        points.push(glam::DVec2::new(0.0, 0.9));
        // Some sides level.
        if let Some(p) = points.get(level + 1) {
            let z = p.y;
            points[level].y = z;
        }
        let outline = Outline { loops: vec![points] };
        let contour = ContourSource::new(&outline).unwrap().contour(&Offset::default()).unwrap();
        assert_empty(&Cones::new(&contour, rows).unwrap())?;
    }
}
