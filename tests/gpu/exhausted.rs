//! Rays that run out of steps are counted, in both stages alike.

use crate::common::{draw, eye, placement, scene_of, shapes};
use revmap::scene::{Object, Scene};
use revmap::settings::{DrawStage, Planes, Settings, Solver};
use std::sync::Arc;

/// Solids one behind another, copies, and replicas.
fn crowd() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(15.0, 2.6));
    let mut several = Object::new("several", Arc::new(shapes::discs()));
    several.repeat = [2, 2, 1];
    several.placement.position.x = -0.6;
    let mut copies = Object::new("copies", Arc::new(shapes::jewel()));
    copies.instances = [-0.5, 0.1, 0.7]
        .map(|y| placement([0.4, y, 0.0], [0.0; 3], [0.5; 3]))
        .to_vec()
        .into();
    scene.objects.extend([several, copies]);
    scene
}

#[test]
fn rays_out_of_steps_are_counted_alike_in_both_stages() {
    let scene = crowd();
    let count = |solver, max_steps, planes| {
        let counts = [DrawStage::Fragment, DrawStage::Compute].map(|stage| {
            let settings = Settings {
                width: 240,
                height: 180,
                stage,
                solver,
                max_steps: Some(max_steps),
                planes,
                proxy_min_pixels: u32::MAX, // or rays would begin elsewhere in each stage
                ..Settings::exact()
            };
            let frame = draw(&scene, &settings);
            // The bit that tells is no step.
            assert!(frame.steps.iter().all(|&s| s < 1e5));
            let hits = (0..frame.pixels()).filter(|&i| frame.hits(i)).count();
            (frame.exhausted, hits)
        });
        assert_eq!(counts[0].0, counts[1].0, "{solver:?}, {max_steps} steps");
        counts[0]
    };
    for solver in [Solver::Live, Solver::Circle] {
        let (few, _) = count(solver, 3, Planes::All);
        let (more, _) = count(solver, 20, Planes::All);
        let (enough, hits) = count(solver, 512, Planes::All);
        println!("{solver:?}: {few} with 3 steps, {more} with 20, {enough} with 512; {hits} hits");
        assert!(few > hits / 2 && more < few, "{solver:?}: {few}, {more}");
        assert!(hits > 5000 && enough == 0, "{solver:?}: {enough} of {hits}");
    }
    // What has no budget cannot use it up; what is not counted is not told.
    for solver in [Solver::Quadric, Solver::Linear, Solver::Secant] {
        assert_eq!(count(solver, 3, Planes::All).0, 0, "{solver:?}");
    }
    assert_eq!(count(Solver::Live, 3, Planes::Color).0, 0);
}
