use super::*;
use crate::profile::Outline;
use proptest::prelude::*;

proptest! {
    #[test]
    fn area_and_its_inverse(angle in 0.0f64..std::f64::consts::TAU, area in 0.0f64..1.0) {
        let n = DVec2::from_angle(angle);
        let n = n / (n.x.abs() + n.y.abs());
        let alpha = alpha_for(n, area);
        prop_assert!((area_below(n, alpha) - area).abs() < 1e-12);
        // Against counting.
        let hits = (0..10_000).filter(|k| {
            let p = DVec2::new(f64::from(k % 100) + 0.5, f64::from(k / 100) + 0.5) / 100.0;
            n.dot(p) <= alpha
        }).count();
        prop_assert!((hits as f64 / 1e4 - area).abs() < 0.015);
    }

    // A straight edge comes back exactly, wherever it runs.
    #[test]
    fn straight_edges_are_found_again(angle in 0.0f64..std::f64::consts::TAU, offset in -0.3f64..0.3) {
        let n = DVec2::from_angle(angle);
        let middle = DVec2::new(0.5, 0.5) + n * offset;
        let far = n.perp() * 9.0;
        let outline = Outline { loops: vec![vec![middle - far, middle + far, middle + far - n * 9.0, middle - far - n * 9.0]] };
        prop_assume!(outline.area() > 0.0);
        let size = 24;
        let raster = clipped(&outline, size);
        let interface = Interface::of_picture(&raster);
        for (row, lines) in interface.lines.iter().enumerate() {
            for (column, line) in lines {
                let border = |k: usize| k < 2 || k + 2 >= size as usize;
                if border(row) || border(*column as usize) {
                    continue;
                }
                for p in line.clip().into_iter().flatten() {
                    let at = (p + DVec2::new(f64::from(*column), row as f64)) / f64::from(size);
                    let miss = (DVec2::new(at.x, 1.0 - at.y) - middle).dot(n) * f64::from(size);
                    prop_assert!(miss.abs() < 2e-3, "off by {miss} pixels");
                }
            }
        }
    }
}

/// Coverage by sampling, since the outline reaches to negative `r`, where the rasteriser has nothing to say.
fn clipped(outline: &Outline, size: u32) -> Raster {
    let shifted = Outline {
        loops: outline
            .loops
            .iter()
            .map(|l| l.iter().map(|p| *p + DVec2::new(64.0, 0.0)).collect())
            .collect(),
    };
    let wide = shifted.rasterize(size * 65, size);
    let coverage = wide
        .coverage
        .chunks_exact(size as usize * 65)
        .flat_map(|row| row[size as usize * 64..].to_vec())
        .collect();
    Raster {
        columns: size,
        rows: size,
        coverage,
    }
}

#[test]
fn binary_pictures_keep_their_pixel_borders() {
    let raster = Raster {
        columns: 3,
        rows: 3,
        coverage: vec![0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0],
    };
    let half = Interface::of_profile(&raster);
    assert!(half.lines.iter().all(Vec::is_empty));
    // Top 2, right 2, bottom 2 (the picture's border is one); the axis is none.
    assert_eq!(half.segments().len(), 6);
    assert_eq!(Interface::of_picture(&raster).segments().len(), 8);
}
