//! Hulls of patches and their beams, the default: crowds in one depth buffer, copies, slivers,
//! faces of the box.

use super::hulls::{EXACT, settings};
use crate::common::prelude::*;
use crate::common::ways::{WALKED, WRAPPED, draw_by};

/// Several intersecting objects, some copied, in one depth buffer: hulls beside boxes.
#[test]
fn a_crowd_in_one_depth_buffer() {
    let mut crowd = circle_of_shapes(shapes::all());
    let mut ways = [Vec::new(), Vec::new()];
    for (n, object) in crowd.objects.iter_mut().enumerate() {
        let turn = n as f64 * 0.8;
        if n % 3 == 1 {
            let copy = placement([0.3, 0.2, 0.2], [turn, 0.0, 0.4], [0.5, 0.5, 0.9]);
            object.instances = vec![object.placement, copy].into();
        }
        // Copies too small for tiles of their own.
        if n == 4 {
            object.instances = (0..7)
                .map(|k| {
                    let turn = 0.9 * f64::from(k);
                    let at = [0.7 * turn.cos(), 0.7 * turn.sin(), 0.5];
                    placement(at, [0.0; 3], [0.1; 3])
                })
                .collect();
        }
        if n % 3 == 2 {
            object.repeat = [2, 1, 1];
        }
        ways[0].push([DrawPath::Cells, DrawPath::Cells, DrawPath::Box][n % 3]);
        ways[1].push(DrawPath::Walk);
    }
    EXACT.assert_same("crowd", &crowd, ways.each_ref().map(Vec::as_slice));
}

/// Copies of a scene's only object hide one another, too. Rays walk to
/// more than 64.
#[test]
fn copies_of_a_lone_object() {
    let copies = |count: usize, size: f64| {
        let mut scene = scene_of(shapes::torus(), eye(35.0, 2.6));
        scene.objects[0].instances = (0..count)
            .map(|k| {
                let turn = 2.1 * k as f64;
                let place = [0.25 * turn.cos(), 0.25 * turn.sin(), 0.15 * turn % 0.5];
                placement(place, [0.3 * turn, 0.2, turn], [size; 3])
            })
            .collect();
        scene
    };
    let few = copies(3, 1.0);
    EXACT.assert_same("three", &few, WRAPPED);
    EXACT.assert_same("64", &copies(64, 0.7), WRAPPED);
    let crowd: [&[DrawPath]; 2] = [&[DrawPath::Walk], &[DrawPath::Walk]];
    EXACT.assert_same("65", &copies(65, 0.7), crowd);
    let mut beside = few.clone();
    beside.objects[0].instances[0].position = DVec3::new(-3.7, 9.3, 0.0);
    EXACT.assert_same("one beside the picture", &beside, WRAPPED);
}

/// A sliver of a solid, with almost nothing for a hull to wrap.
#[test]
fn slivers() {
    let sliver = Profile::polygon(&[[0.0, 0.5], [0.45, 0.501], [0.0, 0.502]], 0.5).unwrap();
    let scene = scene_of(sliver, eye(35.0, 2.0));
    EXACT.assert_same("sliver", &scene, WRAPPED);
}

/// Level faces in the box's own faces, from afar and flattened: the start of a ray is least precise
/// here. Measured: at most 1 wrong pixel. A tree walk without slack for this misses 423 of 36,056
/// pixels; a hull without hits below the floor misses 276 of 15,044.
#[test]
fn faces_of_the_box_itself() {
    for (distance, flat) in [(5.0, 1.0), (100.0, 1.0), (20.0, 0.05), (100.0, 0.05)] {
        let mut scene = scene_of(shapes::column_of(0.4), eye(45.0, distance));
        scene.camera.fov_y = 2.0 * (0.6f64 / distance).atan().to_degrees();
        scene.camera.target = DVec3::new(0.0, 0.0, 0.5 * flat);
        scene.objects[0].placement.scale = DVec3::new(1.0, 1.0, flat);
        let truth = reference(&scene, &settings(Solver::Quadric, DrawStage::Fragment));
        for (solver, stage) in [
            (Solver::Quadric, DrawStage::Fragment),
            (Solver::Exact, DrawStage::Fragment),
            (Solver::Exact, DrawStage::Compute),
        ] {
            let settings = settings(solver, stage);
            let name = format!("{distance} away, scale {flat}: {solver}");
            let ways = match solver {
                Solver::Exact => WRAPPED,
                _ => WALKED,
            };
            let frame = draw_by(&name, &scene, &settings, ways);
            let found = errors(&truth, &frame, 512);
            let wrong = found.missed + found.ghost;
            assert!(found.hits > 5000, "only {} pixels are hit", found.hits);
            assert!(wrong <= found.hits / 500, "{name}, {stage:?}: {found}");
        }
    }
}
