//! Close pictures of outlines with short edges: cells lose no pixels that lists find.

use crate::common::outlines::outline;
use crate::common::prelude::*;
use crate::common::random::Random;
use std::f64::consts::TAU;

const SIZE: (u32, u32) = (400, 300);

/// Pixels that only one of two frames hits: all, and those beside another one.
fn differing(a: &Frame, b: &Frame) -> (usize, usize) {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let differs = |x: usize, y: usize| a.hits(y * width + x) != b.hits(y * width + x);
    let (mut all, mut in_runs) = (0, 0);
    for y in 0..height {
        for x in (0..width).filter(|&x| differs(x, y)) {
            let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
            let about = rows.flat_map(|j| {
                let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
                columns.map(move |i| (i, j))
            });
            all += 1;
            in_runs += usize::from(about.filter(|&(i, j)| differs(i, j)).count() > 1);
        }
    }
    (all, in_runs)
}

/// Both stages draw the same silhouettes, in close views of corners. The environment variable
/// `OUTLINES` sets the number of outlines, each with 5 views.
#[test]
fn stages_differ_in_no_run_of_pixels() {
    let outlines = std::env::var("OUTLINES").map_or(4, |n| n.parse().unwrap());
    let (mut pictures, mut pixels, mut seed) = (0, 0, 0);
    let mut failures = Vec::new();
    while pictures < 5 * outlines {
        seed += 1;
        let mut random = Random(seed);
        let points = outline(seed % 6, &mut random);
        let Ok(profile) = Profile::polygon(&points, 0.5) else {
            continue;
        };
        for view in 0..5 {
            let corner = points[(random.next() * points.len() as f64) as usize];
            let (sin, cos) = (random.next() * TAU).sin_cos();
            let target = DVec3::new(corner[0] * cos, corner[0] * sin, corner[1]);
            let (up, flat) = ((random.next() * 2.0 - 1.0) * 1.5).sin_cos();
            let (sin, cos) = (random.next() * TAU).sin_cos();
            let eye = target + 2.2 * DVec3::new(flat * cos, flat * sin, up);
            let mut scene = scene_of(profile.clone(), eye);
            scene.camera.target = target;
            scene.camera.fov_y = 2.0 + 8.0 * random.next();
            let [a, b] = STAGES.map(|stage| {
                let settings = Settings {
                    proxy_min_pixels: 0,
                    ..drawn_by(SIZE, stage, Solver::Exact)
                };
                draw(&scene, &settings)
            });
            let (all, in_runs) = differing(&a, &b);
            pictures += 1;
            pixels += all;
            if in_runs > 0 {
                failures.push(format!(
                    "{seed}, view {view}: {in_runs} of {all}: {points:?}"
                ));
            }
        }
    }
    println!(
        "{pictures} pictures, {pixels} pixels differ, runs in {}",
        failures.len()
    );
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
