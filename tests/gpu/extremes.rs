//! Plates, and distances, outside the range of 32-bit world coordinates. `revmap stability` has the
//! other extremes.

use crate::common::prelude::*;

fn settings(stage: DrawStage) -> Settings {
    drawn_by((160, 121), stage, Solver::DEFAULT)
}

/// Rays begin far away in the space of a box that is thin across the axis. Their entry into the
/// cylinder about the solid must not be computed from there: that cylinder is the solid's wall.
#[test]
fn thin_plates_have_no_holes() {
    let cylinder = [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.1, 0.9], [0.0, 0.9]];
    let eye = DVec3::new(0.8, 1.4, 0.9);
    for thin in [0.1, 0.01, 0.003, 0.001] {
        let mut scene = scene_of(Profile::polygon(&cylinder, 0.4).unwrap(), eye);
        scene.objects[0].placement.scale.y = thin;
        let truth = reference(&scene, &settings(STAGES[0]));
        for stage in STAGES {
            let frame = draw(&scene, &settings(stage));
            let what = format!("{thin} across, {stage:?}");
            assert_sound(&frame, &what);
            let found = errors(&truth, &frame, 512);
            assert!(found.hits > 1000, "{what}: {} hits", found.hits);
            let near = found.depth.unwrap().p99 <= 0.005;
            assert!(found.missed + found.ghost <= 3 && near, "{what}: {found}");
        }
    }
}

#[test]
fn far_solids_do_not_shade_themselves() {
    let mut scene: Scene = scene_of(shapes::sphere(), eye(25.0, 1e6));
    scene.camera.fov_y = 2.0 * (0.7f64 / 1e6).atan().to_degrees();
    scene.shadow = Shadow::Hard;
    scene.lights = vec![Light {
        direction: DVec3::new(-1.0, -0.1, -0.2),
        color: [1.0; 3],
        ..Light::default()
    }];
    let truth = reference(&scene, &settings(STAGES[0]));
    for stage in STAGES {
        let frame = draw(&scene, &settings(stage));
        let unlike = |k: &usize| (frame.color[*k][1] - truth.color[*k][1]).abs() > 0.05;
        let both = (0..truth.pixels()).filter(|&k| truth.hits(k) && frame.hits(k));
        let off = both.filter(unlike).count();
        assert!(off <= 3, "{stage:?}: {off} pixels lit otherwise");
    }
}

/// A plate of 1000:1 takes the same path as an upright solid, and is as exact.
#[test]
fn flat_solids_are_drawn_by_cells() {
    let width = 1000.0;
    let mut scene = scene_of(shapes::vase(), DVec3::new(1.5, 0.6, 0.6) * width);
    scene.objects[0].placement.scale = DVec3::new(width, width, 1.0);
    let offscreen = Offscreen::new(device(), &scene, &sized(800, 600)).unwrap();
    assert_eq!(offscreen.renderer().draw_paths()[0], DrawPath::Cells);
    for stage in STAGES {
        let settings = drawn_by((400, 300), stage, Solver::DEFAULT);
        let truth = reference(&scene, &settings);
        let frame = draw(&scene, &settings);
        let found = errors(&truth, &frame, 512);
        let (off, p99) = (found.missed + found.ghost, found.depth.unwrap().p99);
        assert!(off <= 3 && p99 <= 1.0, "{stage:?}: {found}");
    }
}
