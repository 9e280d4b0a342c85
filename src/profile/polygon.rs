//! Profiles from a list of `[r, z]` points.

use super::{AXIS_SLACK, FillRule, Outline, Profile};
use crate::error::{Result, content};
use glam::DVec2;

/// See [`Profile::polygon`].
pub(super) fn profile(points: &[[f64; 2]], radius: f64) -> Result<Profile> {
    let fault = |message: String| content("polygon", message);
    if !(radius.is_finite() && radius > 0.0) {
        let message = format!("{radius} is no radius; give a positive number");
        return content("radius", message);
    }
    if points.len() < 3 {
        return fault(format!(
            "{} points enclose nothing; give at least 3 points [r, z]",
            points.len()
        ));
    }
    let widest = points.iter().fold(0.0f64, |m, p| m.max(p[0].abs()));
    let slack = AXIS_SLACK * widest.min(1.0);
    let mut clean = Vec::with_capacity(points.len());
    for (i, &[r, z]) in points.iter().enumerate() {
        if !(r.is_finite() && z.is_finite()) {
            return fault(format!(
                "point {i} [{r}, {z}] is not finite; give two numbers"
            ));
        }
        if r < -slack {
            return fault(format!(
                "point {i} [{r}, {z}] crosses the axis; keep r >= 0 and give one half of the silhouette"
            ));
        }
        if r > Profile::EXTENT || z.abs() > Profile::EXTENT {
            return fault(format!(
                "point {i} [{r}, {z}] is too far out; one object unit is the height of the box"
            ));
        }
        clean.push(DVec2::new(if r < slack { 0.0 } else { r }, z));
    }
    let outline = Outline::enclosed(&[clean], FillRule::NonZero);
    if outline.area() <= 1e-12 * widest.min(1.0).powi(2) {
        return fault("the polygon has no area; give corners that enclose some".into());
    }
    Ok(Profile::new(outline, radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(points: &[[f64; 2]]) -> Outline {
        profile(points, 0.5).unwrap().outline
    }

    fn message(points: &[[f64; 2]]) -> String {
        profile(points, 0.5).unwrap_err().to_string()
    }

    #[test]
    fn corners_survive_exactly_and_run_counter_clockwise() {
        let odd = [
            [0.0, 0.1],
            [0.0, 0.9],
            [1.0 / 3.0, 0.7],
            [0.123_456_789_012_3, 0.3],
        ];
        let o = outline(&odd);
        assert_eq!(o.loops.len(), 1);
        for p in odd {
            assert!(o.loops[0].contains(&DVec2::from(p)), "{p:?} lost");
        }
        assert!(o.area() > 0.0);
    }

    #[test]
    fn overlap_with_itself_is_solid() {
        // A pentagram: its middle is wound round twice.
        let star: Vec<[f64; 2]> = (0..5)
            .map(|i| {
                let a = f64::from(i) * 4.0 * std::f64::consts::PI / 5.0;
                [0.5 + 0.4 * a.cos(), 0.5 + 0.4 * a.sin()]
            })
            .collect();
        let o = outline(&star);
        assert!(o.contains(DVec2::new(0.5, 0.5)));
        assert_eq!(o.loops.len(), 1);
        assert_eq!(o.loops[0].len(), 10);
    }

    #[test]
    fn a_bow_tie_becomes_two_triangles() {
        let o = outline(&[[0.1, 0.1], [0.5, 0.5], [0.5, 0.1], [0.1, 0.5]]);
        assert!((o.area() - 2.0 * 0.5 * 0.4 * 0.2).abs() < 1e-8);
    }

    #[test]
    fn rounding_on_the_axis_is_no_surface() {
        let o = outline(&[
            [0.0, 0.0],
            [0.4, 0.5],
            [0.4 * std::f64::consts::PI.sin(), 1.0],
        ]);
        assert_eq!(o.surface_segments().count(), 2);
        // A gap of rounding is no bore, on either side.
        for gap in [1e-8, -1e-8, 3e-7, 3e-5] {
            let o = outline(&[[gap, 0.0], [0.4, 0.0], [0.4, 1.0], [gap, 1.0]]);
            assert_eq!(o.surface_segments().count(), 3, "{gap}");
            let loops = vec![
                [[gap, 0.0], [0.4, 0.0], [gap, 1.0]]
                    .map(DVec2::from)
                    .to_vec(),
            ];
            let known = Profile::new(Outline { loops }, 0.5).outline;
            assert_eq!(known.surface_segments().count(), 2, "{gap}");
        }
        assert!(o.signed_distance(DVec2::new(1e-6, 0.5)) < -0.2);
    }

    #[test]
    fn faults_are_named() {
        let ok = [[0.1, 0.1], [0.3, 0.1], [0.3, 0.5]];
        assert!(message(&ok[..2]).contains("2 points"));
        assert!(message(&[ok[0], ok[1], [f64::NAN, 0.0]]).contains("point 2"));
        assert!(message(&[ok[0], ok[1], [f64::INFINITY, 0.0]]).contains("not finite"));
        assert!(message(&[ok[0], ok[1], [-0.1, 0.4]]).contains("crosses the axis"));
        assert!(message(&[ok[0], ok[1], ok[0]]).contains("no area"));
        assert!(message(&[[0.0, 0.0], [0.1, 0.1], [0.2, 0.2]]).contains("no area"));
        assert!(message(&[[0.0, 0.0], [0.0, 0.5], [0.0, 1.0]]).contains("no area"));
        assert!(message(&[ok[0], ok[1], [1e9, 0.4]]).contains("too far"));
        assert!(
            profile(&ok, 0.0)
                .unwrap_err()
                .to_string()
                .contains("radius")
        );
        assert!(profile(&ok, f64::NAN).is_err());
        for text in [message(&ok[..2]), message(&[ok[0], ok[1], ok[0]])] {
            assert!(text.starts_with("polygon: ") && !text.contains('\n'));
        }
    }
}
