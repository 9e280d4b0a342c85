//! Rays that run out of steps are counted, in both stages alike.

use crate::common::prelude::*;
use revmap_searches::{LINEAR, SECANT};

/// A solid, replicas, and copies beside each other: only fragments search hidden surfaces.
fn scenes() -> [Scene; 3] {
    let scene = scene_of(shapes::vase(), eye(15.0, 2.6));
    let mut several = Object::new("several", Arc::new(shapes::discs()));
    several.repeat = [2, 2, 1];
    several.placement.position.x = -0.6;
    let mut copies = Object::new("copies", Arc::new(shapes::jewel()));
    copies.instances = [-0.5, 0.1, 0.7]
        .map(|y| placement([0.4, y, 0.0], [0.0; 3], [0.5; 3]))
        .to_vec()
        .into();
    let of = |object| scene.clone().with(|s| s.objects = vec![object]);
    [of(scene.objects[0].clone()), of(several), of(copies)]
}

#[test]
fn rays_out_of_steps_are_counted_alike_in_both_stages() {
    let scenes = scenes();
    let count = |solver, max_steps, planes| {
        let counts: [(usize, usize); 2] = STAGES.map(|stage| {
            let settings = from_boxes(Settings {
                max_steps: Some(max_steps),
                planes,
                ..drawn_by((240, 180), stage, solver)
            });
            let frames = scenes.each_ref().map(|scene| draw(scene, &settings));
            // The bit that marks an exhausted ray is not counted as a step.
            assert!(frames.iter().all(|f| f.steps.iter().all(|&s| s < 1e5)));
            let exhausted = frames.iter().map(|f| f.exhausted);
            (exhausted.sum(), frames.iter().map(hits).sum::<usize>())
        });
        assert_eq!(counts[0].0, counts[1].0, "{solver:?}, {max_steps} steps");
        counts[0]
    };
    for solver in [Solver::Live, CIRCLE] {
        let (few, _) = count(solver, 3, Planes::All);
        let (more, _) = count(solver, 20, Planes::All);
        let (enough, hits) = count(solver, 512, Planes::All);
        println!("{solver:?}: {few} with 3 steps, {more} with 20, {enough} with 512; {hits} hits");
        assert!(few > hits / 2 && more < few, "{solver:?}: {few}, {more}");
        assert!(hits > 5000 && enough == 0, "{solver:?}: {enough} of {hits}");
    }
    // A search without a budget cannot exhaust it; a picture without counts reports none.
    for solver in [Solver::Quadric, LINEAR, SECANT] {
        assert_eq!(count(solver, 3, Planes::All).0, 0, "{solver:?}");
    }
    assert_eq!(count(Solver::Live, 3, Planes::Color).0, 0);
}
