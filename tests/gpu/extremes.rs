//! Places, distances and sizes outside the range of 32-bit world coordinates; outlines and boxes
//! that hulls do not support.

use crate::common::ways::STAGES;
use crate::common::{
    assert_sound, device, draw, drawn_by, errors, eye, placement, reference, scene_of, shapes,
    sized,
};
use glam::DVec3;
use revmap::frame::Frame;
use revmap::gpu::DrawPath;
use revmap::profile::Profile;
use revmap::scene::{Light, Scene, Shadow};
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_offscreen::Offscreen;

fn settings(stage: DrawStage, solver: Solver) -> Settings {
    drawn_by((160, 121), stage, solver)
}

/// Asserts that at most `most` pixels are hit in only one of the frames, and that the 99th
/// percentile of the depth error is at most `p99` texels of 512 rows.
fn check(truth: &Frame, frame: &Frame, (most, p99): (usize, f64), what: &str) {
    assert_sound(frame, what);
    let found = errors(truth, frame, 512);
    let depth = found.depth.unwrap().p99;
    let off = found.missed + found.ghost;
    println!("{what}: {found}");
    assert!(found.hits > 1000, "{what}: {} hits", found.hits);
    assert!(off <= most && depth <= p99, "{what}: {found}");
}

fn in_both_stages(scene: &Scene, limits: (usize, f64), what: &str) {
    let truth = reference(scene, &settings(STAGES[0], Solver::DEFAULT));
    for stage in STAGES {
        let frame = draw(scene, &settings(stage, Solver::DEFAULT));
        check(&truth, &frame, limits, &format!("{what}, {stage:?}"));
    }
}

/// Moves a whole scene.
fn moved(mut scene: Scene, by: DVec3) -> Scene {
    scene.camera.eye += by;
    scene.camera.target += by;
    for object in &mut scene.objects {
        object.placement.position += by;
    }
    scene
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
        in_both_stages(&scene, (3, 0.005), &format!("{thin} across"));
    }
}

#[test]
fn the_distance_from_the_origin_does_not_matter() {
    for far in [1e4, 1e6] {
        let by = DVec3::new(far, -far, 0.3 * far);
        let scene = moved(scene_of(shapes::vase(), eye(25.0, 1.8)), by);
        in_both_stages(&scene, (3, 0.05), &format!("{far} units from the origin"));
    }
}

#[test]
fn small_solids_far_from_the_origin_are_drawn() {
    let size = 6e-6;
    let mut scene = scene_of(shapes::vase(), eye(25.0, 1.8) * size);
    scene.camera.target *= size;
    scene.objects[0].placement = placement([0.0; 3], [0.0; 3], [size; 3]);
    let scene = moved(scene, DVec3::new(1e3, 0.0, 0.0));
    // Distances scale with the solid's size, too: its texel is 1.2e-8.
    in_both_stages(&scene, (3, 0.05 * size), "6e-6 large");
}

#[test]
fn far_eyes_through_long_lenses_see_what_near_ones_do() {
    for far in [3e4, 1e6] {
        let mut scene = scene_of(shapes::vase(), eye(25.0, far));
        scene.camera.fov_y = 2.0 * (0.7 / far).atan().to_degrees();
        // Distances are stored in 32 bits.
        let rounding = far * 512.0 / 8_388_608.0;
        in_both_stages(&scene, (3, 2.0 * rounding), &format!("from {far} units"));
    }
}

#[test]
fn far_solids_do_not_shade_themselves() {
    let mut scene = scene_of(shapes::sphere(), eye(25.0, 1e6));
    scene.camera.fov_y = 2.0 * (0.7f64 / 1e6).atan().to_degrees();
    scene.shadow = Shadow::Hard;
    scene.lights = vec![Light {
        direction: DVec3::new(-1.0, -0.1, -0.2),
        color: [1.0; 3],
        ..Light::default()
    }];
    let truth = reference(&scene, &settings(STAGES[0], Solver::DEFAULT));
    for stage in STAGES {
        let frame = draw(&scene, &settings(stage, Solver::DEFAULT));
        let unlike = |k: &usize| (frame.color[*k][1] - truth.color[*k][1]).abs() > 0.05;
        let both = (0..truth.pixels()).filter(|&k| truth.hits(k) && frame.hits(k));
        let off = both.filter(unlike).count();
        assert!(off <= 3, "{stage:?}: {off} pixels lit otherwise");
    }
}

/// The ray of the middle pixel hits the tip to the last bit.
#[test]
fn a_tip_has_a_normal() {
    let cone = || Profile::polygon(&[[0.0, 0.25], [0.25, 0.25], [0.0, 0.75]], 0.5).unwrap();
    let mut level = scene_of(cone(), DVec3::new(2.0, 0.0, 0.75));
    level.camera.target.z = 0.75;
    let mut above = scene_of(cone(), DVec3::new(0.0, 0.0, 2.75));
    above.camera.up = DVec3::Y;
    for (name, scene) in [("level", level), ("above", above)] {
        for stage in STAGES {
            for solver in [Solver::Exact, Solver::Quadric] {
                let frame = draw(&scene, &drawn_by((161, 121), stage, solver));
                assert_sound(&frame, &format!("{name}, {stage:?}, {solver}"));
            }
        }
    }
}

/// The draw path of the first object in the fragment stage.
fn path(scene: &Scene) -> DrawPath {
    let offscreen = Offscreen::new(device(), scene, &sized(800, 600)).unwrap();
    offscreen.renderer().draw_paths()[0]
}

#[test]
fn outlines_that_cross_themselves_have_no_slivers() {
    let points = [[0.02, 0.23], [0.35, 0.1], [0.19, 0.14], [0.12, 0.36]];
    let crossing = || Profile::polygon(&points, 0.5).unwrap();
    for elevation in [10.0, 25.0, 60.0] {
        let mut scene = scene_of(crossing(), eye(elevation, 1.6));
        scene.camera.target.z = 0.25;
        scene.camera.fov_y = 30.0;
        assert_eq!(path(&scene), DrawPath::Tiles);
        let settings = |stage| drawn_by((400, 300), stage, Solver::DEFAULT);
        let truth = reference(&scene, &settings(STAGES[0]));
        for stage in STAGES {
            let frame = draw(&scene, &settings(stage));
            let what = format!("{elevation}, {stage:?}");
            check(&truth, &frame, (3, 0.05), &what);
        }
    }
}

#[test]
fn flat_solids_are_drawn_by_cells() {
    for width in [1.0, 100.0, 1000.0] {
        let mut scene = scene_of(shapes::vase(), DVec3::new(1.5, 0.6, 0.6) * width);
        scene.objects[0].placement.scale = DVec3::new(width, width, 1.0);
        assert_eq!(path(&scene), DrawPath::Cells, "{width}");
        in_both_stages(&scene, (3, 0.2 * width), &format!("{width}:1"));
        let r = width;
        let polygon = [[0.0, 0.1], [0.8 * r, 0.1], [0.6 * r, 0.9], [0.0, 0.9]];
        let profile = Profile::polygon(&polygon, r).unwrap();
        let scene = scene_of(profile, DVec3::new(1.5, 0.6, 0.6) * width + DVec3::Z);
        in_both_stages(&scene, (3, 0.2 * width), &format!("radius {width}"));
    }
}

/// A solid that is small in its box is as exact as a large one: units do not matter. Measured on
/// lavapipe 22.3.6: normals within 0.07 degrees, rms.
#[test]
fn small_outlines_are_as_exact_as_large_ones() {
    let corners = [[0.0, 0.1], [0.3, 0.12], [0.2, 0.5], [0.33, 0.7], [0.0, 0.9]];
    for scale in [0.1, 1e-3, 1e-5, 1e-6] {
        let of = |scale: f64| {
            let polygon = corners.map(|p| p.map(|x| scale * x));
            let eye = scale * eye(25.0, 1.9);
            let mut scene = scene_of(Profile::polygon(&polygon, 0.5).unwrap(), eye);
            scene.camera.target = scale * DVec3::new(0.0, 0.0, 0.5);
            scene.objects[0].offset.extend = 0.02 * scale;
            scene
        };
        let truth = reference(&of(1.0), &settings(STAGES[0], Solver::DEFAULT));
        for stage in STAGES {
            let mut frame = draw(&of(scale), &settings(stage, Solver::DEFAULT));
            for distance in &mut frame.distance {
                *distance = (f64::from(*distance) / scale) as f32;
            }
            check(&truth, &frame, (0, 0.02), &format!("{scale}, {stage:?}"));
            let normal = errors(&truth, &frame, 512).normal.unwrap();
            assert!(normal.rms < 0.1, "{scale}, {stage:?}: {}", normal.rms);
        }
    }
}
